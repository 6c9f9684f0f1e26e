"""What every fidelity does alike for a method: its network and law, the log it sees, its result."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from navcore.control.combination import combination_warnings, network_in_force
from navcore.control.law import Law, prepare_law, realisation_of
from navcore.loop import analyse
from navcore.mechanization.recorder import LAW_COLUMNS, XI_COLUMN, Recorder
from navcore.motion.base import COLUMNS
from navcore.network.base import LinearNetwork
from navcore.run import MethodRun, Status, plot_series, statistics
from navcore.scenario import Method, Scenario
from navcore.sensors.base import ReferenceErrors
from navcore.sensors.reference import event_velocity
from navcore.units import HOUR

Progress = Callable[[float], None]
Cancelled = Callable[[], bool]
STOPPED = "stopped by the user"


def network_of(scenario: Scenario, method: Method) -> LinearNetwork:
    """Return H(s) of a method at the site, as its policy runs it; 1 when it is free."""
    damping = "free" if method.undamped else method.damping
    return network_in_force(damping, method.network, method.policy).transfer(scenario.omega_s)


def law_of(method: Method, network: LinearNetwork, law_step_s: float) -> Law:
    """Damping law of a method, asked every ``law_step_s`` seconds."""
    damping = "free" if method.undamped else method.damping
    return prepare_law(damping, method.network, network, method.policy, method.switching, law_step_s)


def seen_by(method: Method, reference: ReferenceErrors) -> ReferenceErrors:
    """Add the log events that only this method sees."""
    if not method.event:
        return reference
    extra = event_velocity(method.event, reference.time_s)
    return ReferenceErrors(
        reference.time_s, reference.error + extra, reference.valid, reference.body_frame, reference.hold_s
    )


def truth_at(values: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Rows of truth; a single row stands for all times."""
    return np.broadcast_to(values, (len(rows), COLUMNS)) if values.shape[0] == 1 else values[rows]


def method_run(
    method: Method,
    network: LinearNetwork,
    recorder: Recorder,
    step_s: float,
    status: Status,
    reason: str,
    reached_s: float,
    navigation: np.ndarray | None = None,
    notices: tuple[str, ...] = (),
) -> MethodRun:
    """Make the result of one method from what was recorded.

    Parameters
    ----------
    method, network : Method, LinearNetwork
        As configured, and its H(s).
    recorder : Recorder
        Filled as far as the method came.
    step_s : float
        Time between two recorded states, s.
    status : {"ok", "diverged", "stopped"}
        How it ended.
    reason : str
        Why, without the time; empty when ok.
    reached_s : float
        Time it reached, s.
    navigation : ndarray, shape (rows, 11), optional
        Navigation solution at the output rows (strapdown).
    notices : tuple of str
        Further warnings.
    """
    written = int(recorder.cursor[0])
    loop = analyse(network)
    told = f"{reason} at {reached_s:.0f} s = {reached_s / HOUR:.3g} h" if reason else ""
    return MethodRun(
        method=method,
        network=network,
        loop=loop,
        status=status,
        reason=told,
        warnings=_warnings(method, network, (*loop.warnings, *notices), told),
        t_s=recorder.row_steps[:written] * step_s,
        rows=recorder.rows[:written, : XI_COLUMN + 1],
        errors=statistics(recorder),
        plot=plot_series(recorder, step_s),
        law_series=recorder.rows[:written, LAW_COLUMNS],
        navigation=None if navigation is None else navigation[:written],
    )


def _warnings(method: Method, network: LinearNetwork, loop: tuple[str, ...], reason: str) -> tuple[str, ...]:
    found = list(dict.fromkeys((*network.warnings, *loop)))
    if method.undamped and method.network.id != "none":
        found.append(f'damping = "{method.damping}": the network is not used')
    if method.damping == "internal" and realisation_of("external", method.network) != "network":
        found.append("internal damping uses the network form; the feedback realisation needs a reference")
    if not method.undamped:
        found += combination_warnings(method.damping, method.network, method.policy, method.switching)
    return (*found, reason) if reason else tuple(found)
