"""Pareto fronts of two objectives, one for every network of the catalogue (theory.md 18)."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from navcore.design.fronts import Pareto, Point
from navcore.design.measures import (
    TUNING_INTERVALS,
    Setting,
    Ship,
    measure,
    over_run,
    read_objective,
)
from navcore.design.search import MISSED, Effort, Search
from navcore.design.vary import network_not_in_force, read_varied
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.networks import NETWORKS
from navcore.quantities import QUANTITIES, WEIGHED
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario

LEFT_OUT = ("none", "custom")
"""Networks without parameters of a design of their own."""
_LEAST = 1e-12
"""Value that stands for 0 where ratios are compared."""
_WEIGHTS, _WEIGHTS_ALONG = np.linspace(0.0, 1.0, 7), np.linspace(0.0, 1.0, 3)
_EFFORT = Effort(6, 8, 40)
_EFFORT_ALONG = Effort(8, 6, 30)
_POINTS = 24
_WEIGHED_PART = 0.7
"""Part of a network's search that weighs the objectives; the rest mends ends and gaps."""
_END, _END_ALONG = 150, 50
"""Evaluations of a search on from an end of the front."""
_GAP, _GAP_ALONG, _GAPS = 60, 25, 12
"""Evaluations of a search in a gap, and how many gaps are searched at most."""
_NARROW = 0.01
"""A gap in which no setting can be better by more than this part is left."""
_ALSO = 1e-3
"""Weight of the objective that does not matter."""
Seen = tuple[tuple[float, float], dict[str, Any]]
"""Objectives and network block of a setting."""


class _Weighed(Search):
    """Search for w log a + (1 - w) log b that remembers every setting it saw.

    With a ``gap`` it looks between two neighbours of the front for what is least in the larger of the two
    distances from the corner where both would have their better value: weighing finds no hollow of a front.
    """

    def __init__(self, ship: Ship, varied: Sequence[Any], names: tuple[str, str]) -> None:
        super().__init__([ship], varied, read_objective(names[0]), ())
        self.names, self.weight = names, 0.5
        self.gap: tuple[Point, Point] | None = None
        self.seen: list[Seen] = []

    def value(self, settings: Sequence[Setting]) -> float:
        both = _both(settings[0], self.names)
        if both is None:
            return math.inf
        self.seen.append((both, settings[0].method.network.model_dump(mode="json", exclude_none=True)))
        # above zero, or the clipping of missed requirements would take it
        if self.gap is not None:
            left, right = self.gap
            across = math.log(_ratio(both[0], left.values[0])) / _step(left, right, 0)
            up = math.log(_ratio(both[1], right.values[1])) / _step(right, left, 1)
            return 100.0 + max(across, up) + _ALSO * (across + up)
        first, second = (math.log(max(value, _LEAST)) for value in both)
        return 100.0 + self.weight * first + (1.0 - self.weight) * second

    def place(self, point: Point) -> np.ndarray:
        """Place of a point within the ranges."""
        return np.array([one.place(point.network[one.path[-1]]) for one in self.varied])


def pareto(
    scenario: Scenario,
    objectives: tuple[str, str] = ("tilt_rms", "velocity_rms"),
    method: int = 0,
    *,
    networks: Sequence[str] | None = None,
    along: bool = False,
    whole: bool = False,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Pareto:
    """Pareto fronts of two objectives for every network in place of a method's own.

    Parameters
    ----------
    scenario : Scenario
        With the method.
    objectives : (str, str)
        Two of `navcore.quantities.WEIGHED`.
    method : int
        Index of the method; its damping, policy and switching stay.
    networks : sequence of str, optional
        Ids; default: all that have parameters or fixed coefficients of their own.
    along : bool
        Over the scenario's run, else in the steady state at rest.
    whole : bool
        Search all that the fields allow, not only what their sliders reach.
    progress, cancelled : callable, optional
        Told the fraction done; asked before each evaluation.

    Raises
    ------
    InputError
        An objective or method is not known, or its network is not in force: it is not damped, or its policy
        sets parameters of the network.
    """
    ids = _checked(objectives, networks)
    if not 0 <= method < len(scenario.method):
        raise InputError(
            Fault("", "method", method, Text("must be 0 to {method}", method=len(scenario.method) - 1))
        )
    reason = network_not_in_force(scenario.method[method])
    if reason:
        raise InputError(Fault("", f"method.{method}", None, Text("has no fronts: {reason}", reason=reason)))
    along = along or over_run(objectives)
    ship = Ship(scenario, along, TUNING_INTERVALS)
    if ship.model.silent and not along:
        reason = Text(
            "imu and reference have no random error, so every setting gives 0: ask for the run (along)"
        )
        raise InputError(Fault("", "objectives", objectives[0], reason))
    fronts: dict[str, tuple[Point, ...]] = {}
    stopped = False
    for k, name in enumerate(ids):

        def report(fraction: float, done: int = k) -> None:
            if progress is not None:
                progress((done + fraction) / len(ids))

        seen, stopped = _front(scenario, method, name, objectives, along, whole, report, cancelled)
        fronts[name] = tuple(
            _judged(point, Setting(ship, _with_network(scenario.method[method], point.network)))
            for point in _best(seen)
        )
        report(1.0)
        if stopped:
            break
    least = ship.floor(scenario.method[method])
    kinds = [QUANTITIES[name].kind for name in objectives]
    floors = [None if kind is None else getattr(least, kind.figure) for kind in kinds]
    return Pareto(
        objectives=objectives,
        fronts={name: points for name, points in fronts.items() if points},
        present=measured(scenario, objectives, method, along=along),
        floor=(floors[0], floors[1]),
        stopped=stopped,
    )


def measured(
    scenario: Scenario, objectives: tuple[str, str], method: int = 0, *, along: bool = False
) -> tuple[float, float] | None:
    """Both objectives of a method as it is, SI; None where they are not finite and above 0.

    None, too, for a method whose network is not in force: no front is of it.

    Parameters
    ----------
    scenario, objectives, method, along
        As of `pareto`.
    """
    if network_not_in_force(scenario.method[method]):
        return None
    ship = Ship(scenario, along or over_run(objectives), TUNING_INTERVALS)
    return _both(Setting(ship, scenario.method[method]), objectives)


def _checked(objectives: tuple[str, str], networks: Sequence[str] | None) -> list[str]:
    """Ids of the networks to search; raises InputError for a word that is not known."""
    for name in objectives:
        if name not in WEIGHED:
            allowed = Text("must be one of {known}", known=", ".join(WEIGHED))
            raise InputError(Fault("", "objectives", name, allowed))
    if objectives[0] == objectives[1]:
        raise InputError(Fault("", "objectives", objectives[1], Text("must be two different ones")))
    ids = [name for name in NETWORKS if name not in LEFT_OUT]
    for name in networks or ():
        if name not in ids:
            raise InputError(Fault("", "networks", name, Text("must be one of {ids}", ids=", ".join(ids))))
    return ids if networks is None else list(dict.fromkeys(networks))


def _judged(point: Point, setting: Setting) -> Point:
    return replace(point, earth_growth=setting.whole.earth_growth, growth_per_s=setting.growth_per_s)


def _with_network(method: Method, network: dict[str, Any]) -> Method:
    dumped = method.model_dump(mode="json", by_alias=True, exclude_none=True)
    return Method.model_validate(dumped | {"network": network})


def _both(setting: Setting, names: tuple[str, str]) -> tuple[float, float] | None:
    if setting.instability:
        return None
    try:
        first, second = (measure(setting, name) for name in names)
    except (InputError, np.linalg.LinAlgError):
        return None
    return (first, second) if all(math.isfinite(v) and v >= 0.0 for v in (first, second)) else None


def _front(
    scenario: Scenario,
    index: int,
    network: str,
    names: tuple[str, str],
    along: bool,
    whole: bool,
    report: Callable[[float], None],
    cancelled: Callable[[], bool] | None,
) -> tuple[list[Seen], bool]:
    """Every setting of a network that a few weighted searches saw, and whether they were stopped."""
    method = scenario.method[index]
    with_network = scenario.designed(_with_network(method, {"id": network}))
    methods = tuple(with_network if i == index else m for i, m in enumerate(scenario.method))
    other = scenario.model_copy(update={"method": methods})
    ship = Ship(other, along, TUNING_INTERVALS)
    own = _both(Setting(ship, with_network), names)
    dumped = with_network.network.model_dump(mode="json", exclude_none=True)
    seen = [] if own is None else [(own, dumped)]
    fields = with_network.network.design_fields()
    if not fields:
        return seen, False
    varied = read_varied(other, [f"method.{index}.network.{field}" for field in fields], whole)
    search = _Weighed(ship, varied, names)
    search.cancelled = cancelled
    weights = _WEIGHTS_ALONG if along else _WEIGHTS
    for k, weight in enumerate(weights):
        report(_WEIGHED_PART * k / len(weights))
        search.weight = float(weight)
        start = None if search.best is None else search.best[1]
        if search.run(_EFFORT_ALONG if along else _EFFORT, start):
            return seen + search.seen, True
        assert search.best is not None and search.best[0] > -MISSED
    report(_WEIGHED_PART)
    stopped = _ends(search, _END_ALONG if along else _END) or _gaps(search, _GAP_ALONG if along else _GAP)
    return seen + search.seen, stopped


def _ends(search: _Weighed, evaluations: int) -> bool:
    """Search on from both ends of the front; return whether that was stopped.

    The other objective counts a little: along a flat end much of it may be lost for nothing.
    """
    for weight, at in ((1.0 - _ALSO, 0), (_ALSO, -1)):
        for _ in range(2):  # again from where it stood: a flat valley shrinks the simplex
            points = _undominated(search.seen)
            if not points:
                return False
            search.weight = weight
            if search.near(search.place(points[at]), evaluations):
                return True
    return False


def _gaps(search: _Weighed, evaluations: int) -> bool:
    """Search in the widest gaps of the front; return whether that was stopped."""
    tried = set()
    for _ in range(_GAPS):
        points = _undominated(search.seen)
        pairs = [pair for pair in pairwise(points) if (pair[0].values, pair[1].values) not in tried]
        widest = max(pairs, key=_width, default=None)
        if widest is None or _width(widest) < _NARROW:
            break
        search.gap = widest
        tried.add((widest[0].values, widest[1].values))
        middle = 0.5 * (search.place(widest[0]) + search.place(widest[1]))
        if search.near(middle, evaluations):
            return True
    return False


def _ratio(first: float, second: float) -> float:
    return max(first, _LEAST) / max(second, _LEAST)


def _step(less: Point, more: Point, axis: int) -> float:
    """Logarithm of the ratio of two neighbours' objectives."""
    return math.log(_ratio(more.values[axis], less.values[axis]))


def _width(pair: tuple[Point, Point]) -> float:
    """By how much at most a setting between two neighbours beats the nearer one, as a logarithm."""
    left, right = pair
    return min(_step(left, right, 0), _step(right, left, 1))


def _undominated(seen: Sequence[Seen]) -> list[Point]:
    """Points that no other beats in both objectives, in order of the first."""
    front: list[Point] = []
    lowest = math.inf
    for values, network in sorted(seen, key=lambda one: one[0]):
        if values[1] < lowest:
            lowest = values[1]
            front.append(Point(values, network))
    return front


def _best(seen: Sequence[Seen]) -> tuple[Point, ...]:
    """Points that no other beats in both objectives, thinned out to equal ratios."""
    front = _undominated(seen)
    if len(front) <= _POINTS:
        return tuple(front)
    places = np.log(np.maximum([p.values for p in front], _LEAST))
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1))])
    chosen = np.unique(np.searchsorted(way, np.linspace(0.0, way[-1], _POINTS)))
    return tuple(front[i] for i in np.minimum(chosen, len(front) - 1))
