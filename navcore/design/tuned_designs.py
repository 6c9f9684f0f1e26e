"""The best setting of each network under a scenario's requirements, for `navcore.design.designs`.

Each network is tried in its forms (`navcore.design.forms`): level, in each realisation; whole, with the
scenario's azimuth networks or one of the catalogue; with the scenario's gyrocompasses. Of the settings that a
search by shares finds (`navcore.design.share_search`), of the defaults and of the scenario's own methods the
one with the largest share on other seeds is taken; over several scenarios, in the one that a quantile names.
"""

import math
from collections.abc import Callable, Sequence

import numpy as np

from navcore.damping.kalman import KalmanSettings
from navcore.design.forms import Form, forms_of, offered
from navcore.design.measures import Setting, measure
from navcore.design.share_search import best_settings, coarse
from navcore.design.shares import shares_of, smooth_share
from navcore.design.ship import Ship
from navcore.design.spread import NO_SPREAD, Spread
from navcore.engine.ensemble import SEARCHED, outcomes
from navcore.engine.load import estimated_seconds
from navcore.engine.readings import BAND
from navcore.foundation.errors import InputError
from navcore.foundation.progress import part_of
from navcore.foundation.text import Text
from navcore.quantities import HEADING, POSITION, QUANTITIES, TILT, VELOCITY, Quantity, value_unit
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.requirement import OF_THE_SETTING, Requirement
from navcore.sensors.reference import Reference

SEARCH_SEEDS, FEW_SEEDS = 400, 16
"""Of the choice among the settings that a search has found: most of all scenarios, and fewest of each."""
_CHOICE_S = 30.0
"""Processor time of that choice, about."""
_STEADY_S = 1e6
"""Correlation time that a filter is told of a current that does not change."""
INTERVALS = 96
"""Of a run: coarse, for what a search sees is only a guide."""
_PEAK = 1.6
"""Largest length of a vector over the root of its largest mean square, about, in the middle of the seeds."""
_OF_RMS = {"median": math.sqrt(math.log(2.0)), "p95": math.sqrt(math.log(20.0)), "2drms": 2.0}
"""Statistics of the length of a vector over its root mean square, where its axes are alike and normal."""
_SIGNED = {"growth_per_s": 1.0 / 86400.0, "h_slope_s": 100.0}
"""Size of an excess that counts like the limit itself, where a value may be negative."""
_AXES = {TILT: (0, 1), VELOCITY: (3, 4), HEADING: (2,), POSITION: (5, 6)}
"""Components of each kind among `navcore.quantities.COMPONENTS`."""


def kalman(scenario: Scenario) -> tuple[Method, ...]:
    """Give the Kalman filter as a method, if the scenario can carry one out.

    Where the water moves or the log has a scale error, also one that is told how large these may be.
    """
    told = KalmanSettings(**_sizes(scenario.reference))
    methods = [Method(name="kalman", damping="kalman")]
    if told.further:
        methods.append(
            Method.model_validate(
                {"name": "kalman, of the water too", "damping": "kalman", "kalman": told.model_dump()}
            )
        )
    faults = ([*scenario.model_copy(update={"method": (method,)}).faults()] for method in methods)
    return tuple(method for method, found in zip(methods, faults, strict=True) if not found)


def _sizes(reference: Reference) -> dict[str, float]:
    """Sizes, without the values, of the velocity of the water and of the scale error of the log."""
    currents = [reference.current_mps, *(one.current_mps for one in reference.current)]
    steady = max(math.hypot(*one) for one in currents) / math.sqrt(2.0)
    changes = math.hypot(*reference.tide_mps) / 2.0
    sizes = {"current_std_mps": math.hypot(steady, changes), "scale_std_ppm": abs(reference.scale_ppm)}
    if not changes and not reference.current:
        sizes["current_tau_s"] = _STEADY_S
    return sizes


def held_as_set(scenario: Scenario) -> tuple[Method, ...]:
    """Give the scenario's own methods with an azimuth network or a gyrocompass, as they stand."""
    held = (one for one in scenario.method if one.azimuth.id != "none" or one.gyrocompass is not None)
    return tuple(held)


def tuned_methods(
    scenario: Scenario,
    progress: Callable[[float], None],
    cancelled: Callable[[], bool] | None,
    spread: Spread = NO_SPREAD,
    ids: Sequence[str] | None = None,
) -> tuple[list[Method], list[tuple[str, str]]]:
    """Tune every network of the catalogue; also say for which there is no method, and why.

    Parameters
    ----------
    scenario : Scenario
        With limits.
    progress, cancelled : callable
        Told the fraction done, 0..1; asked often.
    spread : Spread
        With one the share that counts is that of all its scenarios and of the scenario itself.
    ids : sequence of str
        Networks that are tuned; by default all that are offered.
    """
    candidates: dict[str, list[Method]] = {}
    left_out: list[tuple[str, str]] = []
    ids = offered() if ids is None else ids
    for k, name in enumerate(ids):
        if cancelled is not None and cancelled():
            left_out += [(other, Text("the search was stopped before it")) for other in ids[k:]]
            break
        reason = Text("unstable as it is sampled")
        try:
            forms = forms_of(scenario, name)
        except InputError as error:
            forms, reason = [], "; ".join(fault.allowed for fault in error.faults)
        except ValueError as error:
            forms, reason = [], str(error)
        for j, form in enumerate(forms):
            found = _candidates(form, cancelled, spread)
            if found:
                candidates.setdefault(form.name, []).extend(found)
            elif not j:
                ship = Ship(form.scenario, True, INTERVALS, drawn=True)
                reason = Setting(ship, form.method).instability or reason
            progress(0.7 * (k + (j + 1) / len(forms)) / len(ids))
        if name not in candidates:
            left_out.append((name, reason))
    methods = [method for found in candidates.values() for method in found]
    everywhere = [coarse(one) for one in (scenario, *spread.scenarios)]
    numbers = range(SEARCHED, SEARCHED + _seeds(everywhere, methods))
    shares: list[list[tuple[float, float]]] = []
    for k, one in enumerate(everywhere):
        span = 0.3 / len(everywhere)
        part = part_of(progress, 0.7 + k * span, 0.7 + (k + 1) * span)
        results = outcomes(one, methods, numbers, part, cancelled)
        if not results:
            return [found[0] for found in candidates.values()], left_out
        ship = Ship(one, True, INTERVALS, drawn=True)
        met = (share.met for share in shares_of(ship, methods, results))
        by_method = zip(*results, strict=True)
        near = (smooth_share(Setting(ship, m), own) for m, own in zip(methods, by_method, strict=True))
        shares.append([*zip(met, near, strict=True)])
    best, at = [], 0
    for found in candidates.values():
        own = [row[at : at + len(found)] for row in shares]
        best.append(found[_best_of(spread, own, len(numbers))])
        at += len(found)
    return best, left_out


def _seeds(everywhere: Sequence[Scenario], methods: Sequence[Method]) -> int:
    """Seeds of the choice in each scenario: fewer where their runs take long."""
    if not methods:
        return FEW_SEEDS
    judged = (one.model_copy(update={"method": tuple(methods)}) for one in everywhere)
    each_s = sum(map(estimated_seconds, judged))
    return max(FEW_SEEDS, min(SEARCH_SEEDS // len(everywhere), int(_CHOICE_S / max(each_s, 1e-9))))


def _best_of(spread: Spread, shares: Sequence[Sequence[tuple[float, float]]], seeds: int) -> int:
    """Place of the method with the largest smooth share, of those whose share may be the largest.

    The largest of several shares on so few seeds is partly luck; within a standard deviation of it, the
    smooth share tells more.

    Parameters
    ----------
    spread : Spread
        Which of the scenarios counts.
    shares : sequence of sequences of (float, float)
        Share and smooth share, of each scenario and method.
    seeds : int
        Behind each share.
    """
    met, near = (
        np.array([spread.of_shares([row[k][which] for row in shares]) for k in range(len(shares[0]))])
        for which in (0, 1)
    )
    largest = met.max()
    luck = math.sqrt(largest * (1.0 - largest) / seeds)
    return int(np.argmax(np.where(met >= largest - luck, near, -math.inf)))


def _candidates(form: Form, cancelled: Callable[[], bool] | None, spread: Spread = NO_SPREAD) -> list[Method]:
    """Settings of a form worth a run, the most promising one first; none where all are unstable."""
    ships = [Ship(one, True, INTERVALS, drawn=True) for one in (form.scenario, *spread.scenarios)]

    def ratio(method: Method) -> float:
        return spread.of_ratios([ratio_at(ship, method) for ship in ships])

    present = [form.method, *form.own]
    if form.fields:
        present += best_settings(form, present, ratio, cancelled, spread)
    stable = [one for one in dict.fromkeys(present) if not Setting(ships[0], one).instability]
    return sorted(stable, key=ratio)


def ratio_at(ship: Ship, method: Method) -> float:
    """Largest quantity of a method over its limit, by the covariance; infinite where it grows."""
    setting = Setting(ship, method)
    return math.inf if setting.instability else _largest_ratio(setting)


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
        ratios.append(_over(foretold(quantity, *series, one), one))
    return max(ratios)


def _over(value: float, one: Requirement) -> float:
    """Value over the limit; where that may be negative, 1 at the limit and more beyond."""
    unit = value_unit(one.quantity)
    if QUANTITIES[one.quantity].signed:
        return 1.0 + (value / unit - one.limit) / _SIGNED.get(one.quantity, 1.0)
    return one.times(value / unit)


def foretold(quantity: Quantity, t_s: np.ndarray, variance: np.ndarray, one: Requirement) -> float:
    """Value of a quantity of errors, SI, by variances along the run of shape (m, 7).

    A vector whose axes are alike has a Rayleigh distribution: its percentiles stand to the root of its mean
    square as `_OF_RMS`.
    """
    assert quantity.kind is not None
    axes = _AXES[quantity.kind]
    counts = t_s >= (0.0 if math.isinf(one.begins_s) else one.begins_s) - 1e-6
    square = variance[counts][:, axes].sum(axis=1)
    part = _OF_RMS.get(quantity.over, 1.0)
    if quantity.statistic == "held":
        beyond = np.flatnonzero(_OF_RMS["p95"] * np.sqrt(square) > one.bound_m)
        return float(t_s[beyond[0]]) if len(beyond) else math.inf
    if quantity.statistic == "settled":
        beyond = np.flatnonzero(np.sqrt(square) > 0.5 * BAND)
        return float(t_s[beyond[-1]]) if len(beyond) else 0.0
    if quantity.statistic == "rate":
        return part * math.sqrt(square[-1]) / max(float(t_s[-1]), 1.0)
    if quantity.statistic in ("at", "final"):
        return part * math.sqrt(square[-1 if math.isinf(one.begins_s) else 0])
    if quantity.axes in ("roll", "pitch"):
        square = 0.5 * square
    if quantity.statistic == "max_abs":
        return _PEAK * math.sqrt(square.max())
    return math.sqrt(square.mean() * (0.5 if quantity.axes == "per_axis" else 1.0))
