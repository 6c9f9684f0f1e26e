"""simulate(scenario) -> Run: truth and sensors once, then every method on them, with progress and cancel."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from navcore.control.law import Law, prepare_law, realisation_of
from navcore.environment import Environment, environment
from navcore.loop import analyse
from navcore.mechanization.error_model import ErrorModelRun
from navcore.mechanization.recorder import make_recorder
from navcore.motion.base import COLUMNS
from navcore.network.base import LinearNetwork
from navcore.network.undamped import UndampedNetwork
from navcore.run import MethodRun, Run, Status, plot_series, statistics
from navcore.scenario import Method, Scenario
from navcore.sensors.base import ReferenceErrors
from navcore.sensors.reference import event_velocity
from navcore.units import HOUR

Progress = Callable[[float], None]
Cancelled = Callable[[], bool]

CHUNK = 50_000
"""Steps between two looks at the cancel flag, some 10 ms."""


def simulate(scenario: Scenario, progress: Progress | None = None, cancelled: Cancelled | None = None) -> Run:
    """Run every method of a scenario on identical truth, sensor errors and log.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.
    progress : callable, optional
        Called with the fraction done, 0..1, from any thread.
    cancelled : callable, optional
        Asked between chunks; when it says True the run stops and what was computed is kept (status
        "stopped").

    Raises
    ------
    InputError
        The motion or a recording cannot serve the scenario.
    """
    began = time.perf_counter()
    env = environment(scenario)
    done = [0.0] * len(scenario.method)

    def advance(index: int) -> MethodRun:
        def report(fraction: float) -> None:
            done[index] = fraction
            if progress is not None:
                progress(sum(done) / len(done))

        return _run_method(scenario, scenario.method[index], env, report, cancelled)

    if len(scenario.method) > 1:
        with ThreadPoolExecutor(2) as pool:
            methods = tuple(pool.map(advance, range(len(scenario.method))))
    else:
        methods = (advance(0),)
    steps = make_recorder(env.steps, scenario.run.step_s, scenario.run.output_step_s).row_steps
    return Run(
        scenario=scenario,
        methods=methods,
        t_s=steps * scenario.run.step_s,
        truth=_truth_rows(env, steps),
        warnings=env.warnings,
        elapsed_s=time.perf_counter() - began,
    )


def _truth_rows(env: Environment, steps: np.ndarray) -> np.ndarray:
    values = env.truth_half.values
    return np.broadcast_to(values, (len(steps), COLUMNS)) if env.truth_half.constant else values[2 * steps]


def _run_method(
    scenario: Scenario, method: Method, env: Environment, report: Progress, cancelled: Cancelled | None
) -> MethodRun:
    network = (UndampedNetwork() if method.damping == "free" else method.network).transfer(scenario.omega_s)
    law = _law(scenario, method, network)
    recorder = make_recorder(env.steps, scenario.run.step_s, scenario.run.output_step_s)
    run = ErrorModelRun(
        step_s=scenario.run.step_s,
        steps=env.steps,
        coefficients=env.coefficients,
        sensors=env.sensors,
        reference=_seen_by(method, env.reference),
        law=law,
        x=np.array(scenario.initial_error.state()),
        recorder=recorder,
    )
    status: Status = "ok"
    while not run.advance(CHUNK):
        report(run.position / max(env.steps, 1))
        if cancelled is not None and cancelled():
            status = "stopped"
            break
    reached_s = run.position * scenario.run.step_s
    reason = "stopped by the user" if status == "stopped" else ""
    if run.diverged:
        status = "diverged"
        reason = "the error left the range of the linear model (tilt 1 rad, velocity 1e5 m/s)"
    if reason:
        reason = f"{reason} at {reached_s:.0f} s = {reached_s / HOUR:.3g} h"
    report(1.0)
    written = int(recorder.cursor[0])
    loop = analyse(network)
    return MethodRun(
        method=method,
        network=network,
        loop=loop,
        status=status,
        reason=reason,
        warnings=_warnings(method, network, loop.warnings, reason),
        t_s=recorder.row_steps[:written] * scenario.run.step_s,
        rows=recorder.rows[:written],
        errors=statistics(recorder),
        plot=plot_series(recorder, scenario.run.step_s),
    )


def _law(scenario: Scenario, method: Method, network: LinearNetwork) -> Law:
    return prepare_law(
        method.damping, method.network, network, method.policy, method.switching, scenario.run.step_s
    )


def _seen_by(method: Method, reference: ReferenceErrors) -> ReferenceErrors:
    """Add the log events that only this method sees."""
    if not method.event:
        return reference
    extra = event_velocity(method.event, reference.time_s)
    return ReferenceErrors(
        reference.time_s, reference.error + extra, reference.valid, reference.body_frame, reference.hold_s
    )


def _warnings(method: Method, network: LinearNetwork, loop: tuple[str, ...], reason: str) -> tuple[str, ...]:
    found = list(dict.fromkeys((*network.warnings, *loop)))
    if method.damping == "free" and method.network.id != "none":
        found.append('damping = "free": the network is not used')
    if method.damping == "internal" and realisation_of("external", method.network) != "network":
        found.append("internal damping uses the network form; the feedback realisation needs a reference")
    return (*found, reason) if reason else tuple(found)
