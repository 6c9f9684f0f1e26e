"""Steps that every fidelity takes alike for a method: its network and law, the log it sees, its result."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from navcore.analysis import Loop, analyse
from navcore.analysis.filter_loop import filter_loop
from navcore.analysis.heading_settling import heading_settling
from navcore.analysis.held_log import Stretch, growth_along, held_log
from navcore.analysis.whole_system import WholeSystem, duration, whole_system
from navcore.engine.run import MethodRun, Status, plot_series, statistics
from navcore.engine.spans import spans
from navcore.foundation.text import Text
from navcore.foundation.units import DEG, HOUR
from navcore.law.law import Law, prepare_law
from navcore.mechanization.recorder import DAMPED_COLUMN, LAW_COLUMNS, XI_COLUMN, Recorder, spans_from
from navcore.motion.truth import Stretches, Truth
from navcore.networks.azimuth_loop import AzimuthChannel
from navcore.networks.base import LinearNetwork
from navcore.networks.known import transfer_at
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.sensors.base import ReferenceErrors
from navcore.sensors.log_errors.events import event_velocity

Progress = Callable[[float], None]
Cancelled = Callable[[], bool]
STOPPED = Text("stopped by the user")


def network_of(scenario: Scenario, method: Method) -> LinearNetwork:
    """Return H(s) of a method at the site, as its policy runs it; 1 when it is free."""
    return transfer_at(method.kind.network(method), scenario.omega_s)


def law_of(method: Method, network: LinearNetwork, law_step_s: float) -> Law:
    """Damping law of a method, asked every ``law_step_s`` seconds."""
    kind = method.kind
    azimuth = kind.azimuth(method, network.omega_s)
    return prepare_law(
        kind.law, method.network, network, method.policy, method.switching, law_step_s, azimuth
    )


def requirement_spans(scenario: Scenario, step_s: float) -> np.ndarray:
    """Make empty spans (`navcore.mechanization.recorder.SPAN`): one for what each requirement watches."""
    return spans_from((math.ceil(begin / step_s - 1e-9), bound) for begin, bound in watches(scenario))


def watches(scenario: Scenario) -> Iterator[tuple[float, float]]:
    """Yield the time (s) from which each requirement watches a run, and the position error (m) it bounds."""
    for one in scenario.requirement:
        if math.isfinite(one.begins_s):
            yield one.begins_s, one.bound_m


def seen_by(method: Method, reference: ReferenceErrors) -> ReferenceErrors:
    """Add the log events that only this method sees; to logs side by side alike."""
    if not method.event:
        return reference
    extra = event_velocity(method.event, reference.time_s)
    extra = extra[:, :, None] if reference.error.ndim > 2 else extra
    if reference.moored.size:
        extra[reference.moored] = 0.0
    return replace(reference, error=reference.error + extra)


_MORE, _LEAST_GROWTH = 1.5, 1e-9
"""Growth along a motion is warned of from so many times that at rest, and from so much, 1/s."""


@dataclass(frozen=True)
class Stability:
    """Verdict of the analysis on a method before it runs.

    Attributes
    ----------
    loop : Loop
        One level channel in continuous time.
    whole : WholeSystem
        Both channels, heading and latitude at the site.
    warnings : tuple of str
        Of the channel, of the whole system, and of the law as it is sampled.
    growth_per_s : float or None
        Of the whole system along the motion; None where no closed loop stands for the method.
    heading_settling_s : float
        `navcore.analysis.heading_settling`; infinite where nothing holds the heading.
    """

    loop: Loop
    whole: WholeSystem
    warnings: tuple[str, ...]
    growth_per_s: float | None = None
    heading_settling_s: float = math.inf


def stability_of(
    scenario: Scenario,
    method: Method,
    law_step_s: float,
    log: ReferenceErrors,
    truth: Truth,
    network: LinearNetwork,
) -> Stability:
    """Analyse a method at the site.

    Parameters
    ----------
    scenario : Scenario
        The `channel` fidelity couples nothing: the whole system stands in its metrics, not in its warnings.
    method : Method
        As configured.
    law_step_s : float
        Time between two calls of the law, s.
    log : ReferenceErrors
        Gives the log's period, and whether the computed heading turns it.
    truth : Truth
        The motion.
    network : LinearNetwork
        H(s) to be judged.
    """
    kind, lat = method.kind, scenario.site.lat_deg * DEG
    acting = kind.acting(network)
    azimuth = kind.azimuth(method, network.omega_s)
    loop = analyse(network)
    whole = whole_system(acting, lat, scenario.earth, scenario.site.height_m, azimuth)
    if kind.no_loop:
        own = filter_loop(scenario.figures(), scenario.omega_s) if kind.covering == "filter" else None
        return Stability(own or loop, whole, (), None if own is None else float(np.max(own.poles.real)))
    warnings = loop.warnings if scenario.run.fidelity == "channel" else (*loop.warnings, *whole.warnings)
    growth = 0.0
    if kind.uses_network:
        period_s = _log_period_s(scenario, log, law_step_s) if kind.referenced else law_step_s
        coupled = scenario.run.fidelity != "channel"
        sampled = held_log(acting, period_s, law_step_s, lat, scenario.earth, coupled, azimuth)
        warnings, growth = (*warnings, *sampled.warnings), sampled.growth_per_s
        if coupled:
            at_rest, turned = growth, kind.referenced and log.body_frame
            timing_s = period_s, law_step_s
            growth = growth_under_way(scenario, acting, truth.stretches, timing_s, azimuth, turned)
            if growth > max(_MORE * at_rest, _LEAST_GROWTH):
                warnings += (_under_way(truth, turned, growth),)
    place = lat, scenario.earth, scenario.site.height_m
    return Stability(loop, whole, warnings, growth, heading_settling(acting, *place, azimuth))


def growth_under_way(
    scenario: Scenario,
    acting: LinearNetwork,
    stretches: Stretches,
    timing_s: tuple[float, float],
    azimuth: AzimuthChannel | None,
    turned: bool,
) -> float:
    """Growth of the whole system along the motion as the law is sampled, 1/s (theory.md 10).

    Parameters
    ----------
    scenario : Scenario
        Gives the Earth.
    acting : LinearNetwork
        H(s) as it acts.
    stretches : tuple
        Parts of the motion.
    timing_s : (float, float)
        Time between two epochs of what the law reads, and between two calls of the law, s.
    azimuth : LinearNetwork or AzimuthGains or None
        What acts in the azimuth channel.
    turned : bool
        The law reads a log that the computed heading turns.
    """
    parts = tuple(Stretch(*one) for one in stretches)
    return growth_along(acting, *timing_s, parts, scenario.earth, azimuth, turned)


def _under_way(truth: Truth, turned: bool, growth: float) -> str:
    """Warn of a growth (1/s) that the motion gives the whole system."""
    every = duration(1.0 / growth)
    (_, v_e, v_n, _), *others = truth.stretches
    text = Text(
        "whole system under way: along the motion the errors grow, e-folding time {growth}", growth=every
    )
    if not others:
        text = Text(
            "whole system under way: at the mean velocity, {speed:.3g} m/s on course {course:.0f}°, the "
            "errors grow, e-folding time {growth}",
            speed=math.hypot(v_e, v_n),
            course=math.degrees(math.atan2(v_e, v_n)) % 360.0,
            growth=every,
        )
    why = Text("a log in the ship's axes is turned by the computed heading, and moves it")
    return Text.joined("; ", (text, why)) if turned else text


def _log_period_s(scenario: Scenario, log: ReferenceErrors, law_step_s: float) -> float:
    """Time between two epochs of the log, s; of a recorded one the usual one."""
    if scenario.reference.kind == "log":
        return 1.0 / scenario.reference.rate_hz
    return float(np.median(np.diff(log.time_s))) if len(log.time_s) > 1 else law_step_s


def network_on_average(method: Method, network: LinearNetwork, rows: np.ndarray) -> LinearNetwork:
    """Network at the mean coefficient in force, where the policy re-tunes it; else the network itself.

    Parameters
    ----------
    method, network : Method, LinearNetwork
        As configured, and its H(s).
    rows : ndarray, shape (m, 12)
        Output rows.
    """
    damped = rows[:, DAMPED_COLUMN] > 0.5
    if method.undamped or not method.policy.tunes or not np.any(damped):
        return network
    parameters = method.policy.network_in_force(method.network)
    mean_xi = float(np.mean(rows[damped, XI_COLUMN]))
    return transfer_at(parameters.with_damping(mean_xi), network.omega_s)


def method_run(
    method: Method,
    network: LinearNetwork,
    judge: Callable[[LinearNetwork], Stability],
    recorder: Recorder,
    step_s: float,
    status: Status,
    reason: str,
    reached_s: float,
    navigation: np.ndarray | None = None,
    notices: tuple[str, ...] = (),
    sigma: np.ndarray | None = None,
) -> MethodRun:
    """Make the result of one method from what was recorded.

    Parameters
    ----------
    method, network : Method, LinearNetwork
        As configured, and its H(s).
    judge : callable
        `stability_of` for this method: what the loop's figures come from. Where the policy re-tunes the
        network, they are those at the mean coefficient in force.
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
    sigma : ndarray, shape (rows, 7), optional
        Standard deviations that a Kalman filter gives itself at the output rows.
    """
    written = int(recorder.cursor["row"])
    network = network_on_average(method, network, recorder.rows[:written])
    stability = judge(network)
    ending = (
        Text(
            "{reason} at {reached_s:.0f} s = {reached_s_2:.3g} h",
            reason=reason,
            reached_s=reached_s,
            reached_s_2=reached_s / HOUR,
        )
        if reason
        else ""
    )
    return MethodRun(
        method=method,
        network=network,
        loop=stability.loop,
        whole=stability.whole,
        growth_per_s=stability.growth_per_s,
        heading_settling_s=stability.heading_settling_s,
        spans=spans(recorder.spans, step_s, recorder.readings),
        status=status,
        reason=ending,
        warnings=_warnings(method, network, (*stability.warnings, *notices), ending),
        t_s=recorder.row_steps[:written] * step_s,
        rows=recorder.rows[:written, : XI_COLUMN + 1],
        errors=statistics(recorder),
        plot=plot_series(recorder, step_s),
        law_series=recorder.rows[:written, LAW_COLUMNS],
        navigation=None if navigation is None else navigation[:written],
        sigma=None if sigma is None else sigma[:written],
    )


def _warnings(
    method: Method, network: LinearNetwork, further: tuple[str, ...], reason: str
) -> tuple[str, ...]:
    all_warnings = [*dict.fromkeys((*network.warnings, *further)), *method.kind.notices(method)]
    return (*all_warnings, reason) if reason else tuple(all_warnings)
