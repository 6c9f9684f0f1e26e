"""The best setting of each network under a scenario's requirements, for `navcore.design.designs`.

A share over seeds is too slow to search by. Each network is searched by the covariance along the run: the
largest of the quantities that it foretells, each over its limit. Of the settings that come out best, of the
network's defaults and of the scenario's own methods the one with the largest share on seeds of the search is
taken.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from navcore.design.measures import Setting, measure, read_objective
from navcore.design.pareto import LEFT_OUT
from navcore.design.search import REFUSED, Effort, Search
from navcore.design.shares import share_of
from navcore.design.ship import Ship
from navcore.design.vary import read_varied
from navcore.engine.ensemble import SEARCHED, outcomes
from navcore.engine.measures import begins_s
from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from navcore.networks import NETWORKS
from navcore.quantities import HEADING, POSITION, QUANTITIES, TILT, VELOCITY, Quantity, limit_unit
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.requirement import OF_THE_SETTING, Requirement

SEARCH_SEEDS = 16
_CANDIDATES = 3
_INTERVALS = 96
"""Of a run: coarse, for what a search sees is only a guide."""
_EFFORT = Effort(5, 5, 40)
_PEAK = 1.6
"""Largest length of a vector over the root of its largest mean square, about, in the middle of the seeds."""
_SIGNED = {"growth_per_s": 1.0 / 86400.0, "h_slope_s": 100.0}
"""Size of an excess that counts like the limit itself, where a value may be negative."""
_AXES = {TILT: (0, 1), VELOCITY: (3, 4), HEADING: (2,), POSITION: (5, 6)}
"""Components of each kind among `navcore.quantities.COMPONENTS`."""


def kalman(scenario: Scenario) -> tuple[Method, ...]:
    """Give the Kalman filter as a method, if the scenario can carry one out."""
    method = Method(name="kalman", damping="kalman")
    return (method,) if not [*scenario.model_copy(update={"method": (method,)}).faults()] else ()


def tuned_methods(
    scenario: Scenario,
    progress: Callable[[float], None],
    cancelled: Callable[[], bool] | None,
) -> tuple[list[Method], list[tuple[str, str]]]:
    """Tune every network of the catalogue; also say for which there is no method, and why."""
    ids = [name for name in NETWORKS if name not in LEFT_OUT]
    candidates: list[tuple[str, list[Method]]] = []
    left_out: list[tuple[str, str]] = []
    for k, name in enumerate(ids):
        if cancelled is not None and cancelled():
            left_out += [(other, Text("the search was stopped before it")) for other in ids[k:]]
            break
        found, reason = _candidates(scenario, name, cancelled)
        if found:
            candidates.append((name, found))
        else:
            left_out.append((name, reason))
        progress(0.7 * (k + 1) / len(ids))
    methods = [method for _, found in candidates for method in found]
    numbers = range(SEARCHED, SEARCHED + SEARCH_SEEDS)
    results = outcomes(scenario, methods, numbers, lambda f: progress(0.7 + 0.3 * f), cancelled)
    if not results:
        return [found[0] for _, found in candidates], left_out
    ship, at = Ship(scenario, True, _INTERVALS), 0
    best = []
    for _, found in candidates:
        ranked = [
            share_of(Setting(ship, method), [one[at + i] for one in results])
            for i, method in enumerate(found)
        ]
        best.append(min(ranked, key=lambda share: share.order).method)
        at += len(found)
    return best, left_out


def _candidates(
    scenario: Scenario, name: str, cancelled: Callable[[], bool] | None
) -> tuple[list[Method], str]:
    """Settings of a network worth a run, the most promising one first; else why there is none."""
    damping = "external" if scenario.reference.kind != "none" else "internal"
    own = [m for m in scenario.method if not m.undamped and m.network.id == name and m.damping == damping]
    try:
        default = Method.model_validate({"name": name, "damping": damping, "network": {"id": name}})
        other = scenario.model_copy(update={"method": (default,)}).with_sensors()
        faults = list(other.faults())
        if faults:
            raise InputError(faults)
    except InputError as error:
        return [], "; ".join(fault.allowed for fault in error.faults)
    except ValueError as error:
        return [], str(error)
    default = other.method[0]
    present = [default, *(default.model_copy(update={"network": one.network}) for one in own)]
    fields = default.network.design_fields()
    if fields:
        present += _searched(other, fields, cancelled)
    ship = Ship(other, True, _INTERVALS)
    stable = {method.network: method for method in present if not Setting(ship, method).instability}
    if not stable:
        return [], Setting(ship, default).instability
    ranked = sorted(stable.values(), key=lambda method: _largest_ratio(Setting(ship, method)))
    return ranked[:_CANDIDATES], ""


def _searched(
    scenario: Scenario, fields: Sequence[str], cancelled: Callable[[], bool] | None
) -> Iterator[Method]:
    varied = read_varied(scenario, [f"method.0.network.{field}" for field in fields])
    search = _ByLimits(scenario, varied)
    search.cancelled = cancelled
    search.run(_EFFORT, None)
    if search.best is not None and search.best[0] < REFUSED:
        yield search.settings(search.best[1])[0].method


class _ByLimits(Search):
    """Search for the least of the largest quantity over its limit."""

    def __init__(self, scenario: Scenario, varied: Sequence[Any]) -> None:
        super().__init__([Ship(scenario, True, _INTERVALS)], varied, read_objective("tilt_rms"), ())

    def value(self, settings: Sequence[Setting]) -> float:
        return _largest_ratio(settings[0])


def _largest_ratio(setting: Setting) -> float:
    """Largest quantity over its limit, by the covariance along the run; infinite where there is none."""
    requirements = setting.ship.scenario.requirement
    series = None
    ratios = []
    for one in requirements:
        quantity = QUANTITIES[one.quantity]
        if one.quantity in OF_THE_SETTING:
            ratios.append(_over(measure(setting, one.quantity), one))
            continue
        if series is None:
            if not setting.loop.stable:
                return math.inf
            variances = setting.ship.along(setting.method)
            series = variances.t_s, variances.total
        ratios.append(_over(foretold(quantity, *series, begins_s(one)), one))
    return max(ratios)


def _over(value: float, one: Requirement) -> float:
    """Value over the limit; where that may be negative, 1 at the limit and more beyond."""
    unit = limit_unit(one.quantity)
    if QUANTITIES[one.quantity].signed:
        return 1.0 + (value / unit - one.limit) / _SIGNED.get(one.quantity, 1.0)
    return one.times(value / unit)


def foretold(quantity: Quantity, t_s: np.ndarray, variance: np.ndarray, from_s: float) -> float:
    """Value of a quantity of errors, SI, by variances along the run of shape (m, 7)."""
    assert quantity.kind is not None
    axes = _AXES[quantity.kind]
    square = variance[t_s >= from_s - 1e-6][:, axes].sum(axis=1)
    if quantity.statistic == "final":
        return math.sqrt(square[-1])
    if quantity.statistic == "max_abs":
        return _PEAK * math.sqrt(square.max())
    return math.sqrt(square.mean() * (0.5 if quantity.axes == "per_axis" else 1.0))
