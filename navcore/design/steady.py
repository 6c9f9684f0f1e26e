"""The steady error budget: one level channel at rest, every method by source (theory.md 15, 16)."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from navcore.damping.base import Covering
from navcore.design.figures import Entry, Figures, total_of
from navcore.design.floor import Floor, steady_floor
from navcore.design.form import law_form
from navcore.design.level import Level, constant_part, level, line_part, steady_parts
from navcore.design.result import Budget, MethodBudget, with_floor
from navcore.design.unmodelled import unmodelled_warnings
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.stochastic import RANDOM_SOURCES, StochasticModel

_MARGINAL = 1e-9
"""Growth over omega_s above which a loop counts as unstable."""


def steady_budget(scenario: Scenario, model: StochasticModel) -> Budget:
    """Steady state of one level channel at rest; ``model`` may differ from that of the scenario."""
    least, unmodelled = steady_floor(model, scenario.omega_s), unmodelled_warnings(scenario, steady=True)
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
    channel = level(law_form(method, scenario.omega_s), model, scenario.omega_s)
    parts = steady_parts(channel)
    if model.tide.any():
        amplitude = float(np.sqrt(np.mean(model.tide**2)))
        parts["log_tide"] = line_part(channel, amplitude, 2.0 * math.pi / model.tide_period_s)
    warnings = [*unmodelled]
    if method.kind.uses_network and method.policy.id not in ("constant", "schedule"):
        warnings.append(
            Text('policy "{id}" looks at the data: shown is the loop while it is damped', id=method.policy.id)
        )
    missing = [name for name, part in parts.items() if None in (part.rms.tilt_rad, part.rms.velocity_mps)]
    unstable = instability(channel)
    if missing and unstable:
        warnings.append(Text("{unstable}: no source has a steady state", unstable=unstable))
    elif missing:
        warnings.append(
            Text("no steady state: {missing} drive a mode without decay", missing=", ".join(missing))
        )
    sizes = {"gyro_bias": model.gyro_bias[:2], "accel_bias": model.accel_bias[:2], "log_bias": model.log_bias}
    constants = {}
    for name, values in sizes.items():
        constants[name] = constant_part(channel, name.split("_")[0], float(np.sqrt(np.mean(values**2))))
    total = Entry(total_of(parts.values()))
    return MethodBudget(method.name, "steady", total, parts, constants, tuple(warnings))


def _no_steady_state(
    scenario: Scenario, method: Method, model: StochasticModel, floor: Floor, unmodelled: tuple[str, ...]
) -> MethodBudget:
    del scenario, model, floor, unmodelled
    warning = Text("{reason}: it has no steady state of one channel", reason=method.kind.no_covariance)
    return MethodBudget(method.name, "none", Entry(Figures()), {}, warnings=(warning,))


def _steady_filter(
    scenario: Scenario, method: Method, model: StochasticModel, floor: Floor, unmodelled: tuple[str, ...]
) -> MethodBudget:
    """Steady state of the Kalman filter: the floor itself."""
    del scenario, unmodelled
    if floor.tilt_rad is None:
        return MethodBudget(method.name, "none", Entry(Figures()), {}, warnings=(floor.reason,))
    sources = {name: Entry(Figures(*floor.sources.get(name, (0.0, 0.0)))) for name in RANDOM_SOURCES}
    warnings = ["the steady state of the Kalman filter is the floor itself"]
    if model.tide.any():
        warnings.append("the filter is not told of the tide, which is not in these figures")
    total = Entry(Figures(floor.tilt_rad, floor.velocity_mps))
    return MethodBudget(method.name, "steady", total, sources, warnings=tuple(warnings))


_STEADY: dict[
    Covering, Callable[[Scenario, Method, StochasticModel, Floor, tuple[str, ...]], MethodBudget]
] = {"covariance": _steady_loop, "seeds": _no_steady_state, "filter": _steady_filter}
"""Steady state of a method, by where its budget comes from."""


def instability(channel: Level) -> str:
    """Say how fast the loop of a channel grows; empty where it does not."""
    growth = channel.growth_per_s()
    if growth <= _MARGINAL * channel.omega_s:
        return ""
    return Text("the loop is unstable (e-folding {growth:.3g} days)", growth=1.0 / growth / (24.0 * HOUR))
