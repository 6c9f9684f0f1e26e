"""The steady error budget: one level channel at rest, every method by source (theory.md 15, 16)."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from navcore.analysis.transfers import RADIUS
from navcore.analysis.whole_system import duration
from navcore.damping.base import Covering
from navcore.design.figures import Entry, Figures, total_of
from navcore.design.floor import Floor, steady_floor
from navcore.design.form import law_form
from navcore.design.level import Level, constant_part, decays, level, line_part, steady_parts
from navcore.design.modelled import Modelled
from navcore.design.result import Budget, MethodBudget, with_floor
from navcore.design.sampled import SampledLevel, sampled_level, sampled_parts, timing_of
from navcore.design.unmodelled import unmodelled_warnings
from navcore.foundation.text import Text
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.stochastic import RANDOM_SOURCES, StochasticModel


def steady_budget(scenario: Scenario, model: StochasticModel, recordings: Modelled | None = None) -> Budget:
    """Steady state of one level channel at rest; ``model`` may differ from that of the scenario.

    ``recordings`` says what the recordings count as; None where there are none.
    """
    told = Modelled(scenario) if recordings is None else recordings
    least = Floor(None, None, told.no_floor) if told.no_floor else steady_floor(model, scenario.omega_s)
    unmodelled = (*told.notes, *unmodelled_warnings(scenario, steady=True))
    methods = []
    for method in scenario.method:
        found = _STEADY[method.kind.covering](scenario, method, model, least, unmodelled)
        methods.append(replace(found, reads_log=method.reads_log))
    floor = Entry(Figures(least.tilt_rad, least.velocity_mps))
    return with_floor(True, floor, least.reason, None, tuple(methods))


def _steady_loop(
    scenario: Scenario, method: Method, model: StochasticModel, floor: Floor, unmodelled: tuple[str, ...]
) -> MethodBudget:
    """Steady state of the channel that the method's network closes."""
    channel, sampled = loops_of(scenario, method, model)
    unstable = instability(sampled)
    if unstable:
        return MethodBudget(
            method.name, "steady", Entry(Figures()), {}, warnings=(unstable, *unmodelled), diverged=True
        )
    parts = random_parts(channel, sampled)
    if model.tide.any():
        amplitude = float(np.sqrt(np.mean(model.tide**2)))
        parts["log_tide"] = line_part(channel, amplitude, 2.0 * math.pi / model.tide_period_s)
    warnings = [*unmodelled]
    if method.kind.uses_network and method.policy.id not in ("constant", "schedule"):
        warnings.append(
            Text('policy "{id}" looks at the data: shown is the loop while it is damped', id=method.policy.id)
        )
    if method.kind.azimuth(method, scenario.omega_s) is not None:
        warnings.append(
            Text(
                "the steady state is that of one level channel by its network; what acts in the azimuth "
                "channel is in the budget along the run"
            )
        )
    missing = [name for name, part in parts.items() if None in (part.rms.tilt_rad, part.rms.velocity_mps)]
    if missing:
        warnings.append(
            Text("no steady state: {missing} drive a mode without decay", missing=", ".join(missing))
        )
    sources = parts | constant_parts(channel, model)
    total, random = Entry(total_of(sources.values())), total_of(parts.values())
    return MethodBudget(method.name, "steady", total, sources, random, warnings=tuple(warnings))


def _no_steady_state(
    scenario: Scenario, method: Method, model: StochasticModel, floor: Floor, unmodelled: tuple[str, ...]
) -> MethodBudget:
    del scenario, model, floor, unmodelled
    warning = Text("{reason}: it has no steady state of one channel", reason=method.kind.no_covariance)
    return MethodBudget(method.name, "none", Entry(Figures()), {}, warnings=(warning,))


def _steady_filter(
    scenario: Scenario, method: Method, model: StochasticModel, floor: Floor, unmodelled: tuple[str, ...]
) -> MethodBudget:
    """Steady state of the Kalman filter: the floor itself, and what biases leave."""
    del unmodelled
    if floor.tilt_rad is None:
        return MethodBudget(method.name, "none", Entry(Figures()), {}, warnings=(floor.reason,))
    sources = {name: Entry(Figures(*floor.sources.get(name, (0.0, 0.0)))) for name in RANDOM_SOURCES}
    warnings = [Text("the steady state of the Kalman filter is the floor itself, and what biases leave")]
    if model.tide.any():
        warnings.append(Text("the filter is not told of the tide, which is not in these figures"))
    random = Figures(floor.tilt_rad, floor.velocity_mps)
    sources |= _left_by_filter(model, scenario.omega_s)
    total = Entry(total_of(sources.values()))
    return MethodBudget(method.name, "steady", total, sources, random, warnings=tuple(warnings))


def _left_by_filter(model: StochasticModel, omega_s: float) -> dict[str, Entry]:
    """Errors that remain of the biases of which the filter is told.

    It sees the velocity R eps of a gyro's bias with the log's bias on top, and parts the two by their
    standard deviations; the tilt nabla / g of an accelerometer it cannot see.
    """
    gyro, accel, log = (
        float(np.sqrt(np.mean(values**2)))
        for values in (model.gyro_bias[:2], model.accel_bias[:2], model.log_bias)
    )
    speed = RADIUS * gyro
    share = speed**2 / (speed**2 + log**2) if speed or log else 0.0
    return {
        "gyro_bias": Entry(Figures(0.0, (1.0 - share) * speed)),
        "accel_bias": Entry(Figures(accel / (omega_s**2 * RADIUS), 0.0)),
        "log_bias": Entry(Figures(0.0, share * log)),
    }


_STEADY: dict[
    Covering, Callable[[Scenario, Method, StochasticModel, Floor, tuple[str, ...]], MethodBudget]
] = {"covariance": _steady_loop, "seeds": _no_steady_state, "filter": _steady_filter}
"""Steady state of a method, by where its budget comes from."""


def loops_of(scenario: Scenario, method: Method, model: StochasticModel) -> tuple[Level, SampledLevel]:
    """Level channel of a method in continuous time, and as its law is sampled."""
    form, omega_s = law_form(method, scenario.omega_s), scenario.omega_s
    return level(form, model, omega_s), sampled_level(form, model, omega_s, timing_of(scenario))


def random_parts(channel: Level, sampled: SampledLevel) -> dict[str, Entry]:
    """Standard deviations that each random source leaves; of a loop with a mode that stands, what grows."""
    return sampled_parts(sampled, channel) if decays(channel) else steady_parts(channel)


def constant_parts(channel: Level, model: StochasticModel) -> dict[str, Entry]:
    """Standard deviations that biases and rounding leave; root mean square of the axes of each sensor."""
    biases = {"gyro": model.gyro_bias[:2], "accel": model.accel_bias[:2], "log": model.log_bias}
    parts = {
        f"{name}_bias": constant_part(channel, name, float(np.sqrt(np.mean(values**2))))
        for name, values in biases.items()
    }
    if model.rounding > 0.0:
        parts["log_resolution"] = constant_part(channel, "log", model.rounding)
    return parts


def instability(sampled: SampledLevel) -> str:
    """Say how fast the loop of a channel grows as it is sampled; empty where it does not."""
    if not sampled.grows:
        return ""
    every = duration(1.0 / sampled.growth_per_s())
    return Text("the loop is unstable as it is sampled: its errors grow by e every {every}", every=every)
