"""Search for the settings of a form with the largest share of seeds (theory.md 18).

A share over seeds cannot be differentiated, and its largest value is not where the covariance is least. The
covariance along the run chooses among many settings spread over the ranges; a few generations around the best
ones are then judged by runs, each on the same seeds, at a coarser step than the scenario's. None of these
seeds is among those that judge what was found. Over several scenarios, the share of the one that counts.
"""

from collections.abc import Callable, Sequence

import numpy as np

from navcore.design.forms import Form
from navcore.design.measures import Setting, read_objective
from navcore.design.search import Search
from navcore.design.shares import shares_of, smooth_share
from navcore.design.ship import Ship
from navcore.design.spread import NO_SPREAD, Spread
from navcore.design.vary import Varied, present, read_varied
from navcore.engine.ensemble import SEARCHED, outcomes
from navcore.engine.load import estimated_seconds
from navcore.foundation.errors import InputError
from navcore.foundation.units import HOUR
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario

_FIRST_SEED = SEARCHED + 10_000
_SEEDS, _FEWEST_SPREAD, _FEWEST_SEEDS = 64, 16, 8
"""Of all scenarios together; of each of several; and of each where runs take long."""
_SPREAD = 16
"""Settings by the covariance, a parameter."""
_CHOSEN, _AS_SPREAD = 8, 24
"""Settings of the first generation: the best of these, and the first ones as they are spread."""
_WIDTHS = 0.25, 0.15, 0.08, 0.04
"""Standard deviation of the steps of each further generation, as a part of the range."""
_PARENTS, _CHILDREN = 5, 4
_APART = 0.12
"""Distance, as a part of the ranges, between the parents of a generation: several hills are climbed."""
_STEPS, _LONGEST_STEP_S = 8640, 10.0
_LONGEST_S = 12.0
"""Processor time of a search by runs, about."""
_KEPT = 6
_INTERVALS = 96
_BEYOND = 0.06
"""Part of a range beyond each end that is spread over too: those places stand at the end."""


def best_settings(
    form: Form,
    starts: Sequence[Method],
    judge: Callable[[Method], float],
    cancelled: Callable[[], bool] | None = None,
    spread: Spread = NO_SPREAD,
) -> list[Method]:
    """Settings of a form with the largest shares, best first.

    Parameters
    ----------
    form : Form
        With at least one field that may vary.
    starts : sequence of Method
        Settings to begin with.
    judge : callable
        Size of the largest quantity over its limit by the covariance: what to look at first.
    cancelled : callable, optional
        When it says True, the best so far are given.
    spread : Spread
        Scenarios beside that of the form in which a setting has to hold too.
    """
    space, stopped = _Space(form, spread), cancelled or (lambda: False)
    generator = np.random.default_rng(1)
    sown = _sown(len(space.varied), _SPREAD * len(space.varied))
    ranked = sorted(sown.tolist(), key=lambda place: _judged(space, place, judge, stopped))
    first = [*map(space.place, starts), *ranked[:_CHOSEN], *sown[:_AS_SPREAD].tolist()]
    seen: dict[Method, tuple[float, float]] = {}
    places: dict[Method, np.ndarray] = {}
    generation = first
    for width in (*_WIDTHS, None):
        fresh = {}
        for place in generation:
            method = space.method(np.clip(place, 0.0, 1.0))
            if method is not None and method not in seen:
                fresh[method] = np.clip(place, 0.0, 1.0)
        if fresh and not stopped():
            seen |= zip(fresh, space.orders([*fresh], stopped), strict=True)
            places |= fresh
        if width is None or not seen:
            break
        parents = _apart([places[one] for one in sorted(seen, key=lambda one: seen[one])], _APART, _PARENTS)
        generation = [
            parent + generator.normal(0.0, width, len(parent)) for parent in parents for _ in range(_CHILDREN)
        ]
        generation.append(np.mean(parents[:2], axis=0))
    best = sorted(seen, key=lambda one: seen[one])
    kept = {tuple(place) for place in _apart([places[one] for one in best], 0.5 * _APART, _KEPT)}
    return [one for one in best if tuple(places[one]) in kept]


def _apart(places: Sequence[np.ndarray], least: float, most: int) -> list[np.ndarray]:
    """The first of some places that are so far apart."""
    chosen: list[np.ndarray] = []
    for place in places:
        if len(chosen) < most and all(np.abs(place - other).max() >= least for other in chosen):
            chosen.append(place)
    return chosen


def _judged(
    space: "_Space", place: list[float], judge: Callable[[Method], float], stopped: Callable[[], bool]
) -> float:
    method = None if stopped() else space.method(np.array(place))
    return np.inf if method is None else judge(method)


def _sown(dimensions: int, count: int) -> np.ndarray:
    """Places spread evenly over the ranges and on their ends, shape (count, dimensions); always the same."""
    from scipy.stats import qmc

    places = qmc.Sobol(dimensions, rng=1).random_base2(max(int(np.ceil(np.log2(count))), 1))[:count]
    return np.clip((1.0 + 2.0 * _BEYOND) * places - _BEYOND, 0.0, 1.0)


class _Space:
    """Settings of a form by the places of its parameters, and their shares."""

    def __init__(self, form: Form, spread: Spread = NO_SPREAD) -> None:
        self._form, self._spread = form, spread
        self.varied: tuple[Varied, ...] = read_varied(
            form.scenario, [f"method.0.{field}" for field in form.fields]
        )
        self._search = Search(
            [Ship(form.scenario, True, _INTERVALS, drawn=True)], self.varied, read_objective("tilt_rms"), ()
        )
        others = (one.model_copy(update={"method": form.scenario.method}) for one in spread.scenarios)
        self._ships = [Ship(coarse(one), True, _INTERVALS, drawn=True) for one in (form.scenario, *others)]
        runs = (_CHOSEN + _AS_SPREAD) + len(_WIDTHS) * (_PARENTS * _CHILDREN + 1)
        each_s = runs * sum(estimated_seconds(ship.given) for ship in self._ships)
        most = max(_FEWEST_SPREAD, _SEEDS // len(self._ships))
        self._seeds = max(_FEWEST_SEEDS, min(most, int(_LONGEST_S / max(each_s, 1e-9))))

    def method(self, place: np.ndarray) -> Method | None:
        """Method at a place; None where there is none."""
        try:
            (setting,) = self._search.settings(place)
        except InputError:
            return None
        other = self._form.scenario.model_copy(update={"method": (setting.method,)})
        return None if [*other.faults()] else setting.method

    def place(self, method: Method) -> np.ndarray:
        """Place of a setting; the middle of the range of a parameter that has no value.

        One that is not given has the value that follows from the others.
        """
        other = self._form.scenario.model_copy(update={"method": (method,)})
        follows = method.network.values(other.omega_s)
        places = []
        for one, given in zip(self.varied, present(other, self.varied).tolist(), strict=True):
            value = given if np.isfinite(given) else follows.get(one.path[-1], np.nan)
            places.append(one.place(float(value)) if np.isfinite(value) else 0.5)
        return np.array(places)

    def orders(self, methods: Sequence[Method], stopped: Callable[[], bool]) -> list[tuple[float, float]]:
        """Keys by which methods are ordered, best first: smooth share, largest median over its limit.

        Once ``stopped`` says True, no order is known any more.
        """
        numbers = range(_FIRST_SEED, _FIRST_SEED + self._seeds)
        near: list[list[float]] = [[] for _ in methods]
        ratios: list[list[float]] = [[] for _ in methods]
        for ship in self._ships:
            if stopped():
                return [(0.0, np.inf)] * len(methods)
            found = outcomes(ship.given, methods, numbers)
            shares = shares_of(ship, methods, found)
            for k, (method, share) in enumerate(zip(methods, shares, strict=True)):
                near[k].append(smooth_share(Setting(ship, method), [one[k] for one in found]))
                ratios[k].append(share.order[1])
        counts = zip(map(self._spread.of_shares, near), map(self._spread.of_ratios, ratios), strict=True)
        return [(-share, ratio) for share, ratio in counts]


def coarse(scenario: Scenario) -> Scenario:
    """Scenario on the linear error model with a coarser step; itself where its motion allows none."""
    run = scenario.run
    step_s = max(run.step_s, min(_LONGEST_STEP_S, run.duration_h * HOUR / _STEPS))
    fidelity = "error_model" if scenario.strapdown else run.fidelity
    changed = run.model_copy(update={"step_s": step_s, "fidelity": fidelity})
    plain = type(scenario.alignment)()
    other = scenario.model_copy(update={"run": changed, "alignment": plain})
    try:
        other.motion.truth(1, 0.5 * step_s, other.site.site(), other.earth)
    except InputError:
        return scenario
    return other
