"""Designs that hold over a study's spreads, and what that costs in the scenario itself (theory.md 18)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from navcore.design.forms import default_method
from navcore.design.judged import left_out_lines
from navcore.design.measures import TUNING_INTERVALS
from navcore.design.shares import Share, require_limits, shares_of
from navcore.design.ship import Ship
from navcore.design.spread import Spread
from navcore.design.stated import assumed_zero
from navcore.design.tuned_designs import INTERVALS, held_as_set, kalman, ratio_at, tuned_methods
from navcore.engine.ensemble import outcomes
from navcore.engine.verdicts import wilson
from navcore.foundation.answers import Answer, Column, Table, number
from navcore.foundation.errors import Fault, InputError, StoppedError
from navcore.foundation.progress import part_of
from navcore.foundation.text import Text
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.study.model import Study
from navcore.study.plan import Plan, Setting

SEEDS = 40
MOST_POINTS = 400
_SEARCHED = 6
"""Points beside the scenario for which a network is tuned: from the easiest to the hardest."""
_TUNING_SHARE = 0.6
"""Of the time that a design takes."""
_LEFT_ALONE = ("method", "requirement", "run.seed")


@dataclass(frozen=True)
class RobustShare:
    """One method over all points.

    Attributes
    ----------
    method : Method
    met, low, high : float
        Share of all runs that meet all limits, and its Wilson interval, 95 %.
    counted : float
        Share of seeds of the point that the quantile names: of the worst one with 0.
    nominal : Share
        In the scenario itself.
    worst : Share
        Where the smallest share of seeds meets all limits.
    where : dict
        Values of the factors there.
    """

    method: Method
    met: float
    low: float
    high: float
    counted: float
    nominal: Share
    worst: Share
    where: dict[str, Any]

    @property
    def order(self) -> tuple[float, float, float]:
        """Key by which methods are ordered, best first."""
        return -self.counted, -self.met, self.worst.order[1]

    def as_dict(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        nominal = self.nominal.as_dict()
        worst = {key: self.worst.as_dict()[key] for key in ("met", "diverged", "limits")}
        return {
            **{key: nominal[key] for key in ("name", "network", "azimuth")},
            "met": self.met,
            "low": self.low,
            "high": self.high,
            "counted": self.counted,
            "nominal": {key: nominal[key] for key in ("met", "low", "high", "limits")},
            "worst": {"factors": self.where, **worst},
        }


@dataclass(frozen=True)
class Robust(Answer):
    """Methods by the share of seeds on which they meet all limits over a study's points.

    Attributes
    ----------
    points, seeds : int
        Points, and runs of each method at each of them.
    quantile : float
        Which point counts, by its share: 0 the worst.
    methods : tuple of RobustShare
        Best first.
    left_out : tuple of (str, str)
        Networks for which there is no method, and why.
    assumed_zero : tuple of str
        Standard deviations that the scenario states in no way: 0 is assumed.
    """

    points: int
    seeds: int
    quantile: float
    methods: tuple[RobustShare, ...]
    left_out: tuple[tuple[str, str], ...] = ()
    assumed_zero: tuple[str, ...] = ()

    @property
    def price(self) -> float:
        """Share of seeds, in the scenario itself, that the most robust method gives up to the best one."""
        return max(one.nominal.met for one in self.methods) - self.methods[0].nominal.met

    def rows(self) -> Iterator[Table | str]:
        """Give a row a method: its share in the scenario, over all points, and where it is worst."""
        yield Text(
            "{points} points, {seeds} seeds each with its own noise and constants",
            points=self.points,
            seeds=self.seeds,
        )
        which = (
            Text("worst point %")
            if self.quantile == 0.0
            else Text("{quantile:g} % point %", quantile=100.0 * self.quantile)
        )
        heads = Text("method"), Text("as it stands %"), Text("all points %"), which
        rows = []
        for one in self.methods:
            missed = min(one.worst.limits, key=lambda limit: limit.met)
            words = f"{missed.requirement.quantity} {number(missed.median)}" if missed.met < 1.0 else "-"
            shares = (one.nominal.met, one.met, one.counted)
            rows.append((one.method.label(), *(number(100.0 * share, 3) for share in shares), words))
        yield Table(tuple(map(Column, (*heads, Text("missed most often there")))), tuple(rows))
        best = self.methods[0]
        shown = {name: f"{v:.4g}" if isinstance(v, float) else v for name, v in best.where.items()}
        where = ", ".join(f"{name} = {value}" for name, value in shown.items())
        yield ""
        yield Text("{name} is worst with {where}", name=best.method.label(), where=where)
        if self.price > 0.0:
            price = number(100.0 * self.price, 3)
            yield Text(
                "price of robustness: {price} % of the seeds of the scenario as it stands", price=price
            )
        yield ""
        for one in self.methods:
            yield Text("{name}: {setting}", name=one.method.label(), setting=one.nominal.setting)
        yield from left_out_lines(self.left_out)

    def document(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        return {
            "points": self.points,
            "seeds": self.seeds,
            "quantile": self.quantile,
            "methods": [one.as_dict() for one in self.methods],
            "price": self.price,
            "left_out": dict(self.left_out),
            "assumed_zero": list(self.assumed_zero),
        }


def robust_designs(
    scenario: Scenario,
    study: Study,
    seeds: int = SEEDS,
    *,
    quantile: float = 0.0,
    as_set: bool = False,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Robust:
    """Judge methods over every point of a study's factors, laid over a scenario.

    Parameters
    ----------
    scenario : Scenario
        With requirements; the study's own scenario, seeds and outputs do not count.
    study : Study
        Its factors and sample say what may differ: sensors, sea, latitude, the log's errors.
    seeds : int
        Runs of each method at each point, with noise and constants as of `navcore.design.designs`.
    quantile : float
        Which point counts, by the share of seeds that meet all limits there: 0 the worst, 0.1 the one that a
        tenth of the points falls short of.
    as_set : bool
        Judge the scenario's methods as they stand; else each network of the catalogue, tuned for the largest
        share that counts over the scenario and several points, and a Kalman filter.
    progress, cancelled : callable, optional
        Told the fraction done, 0..1; when ``cancelled`` says True, the command ends without a result.

    Raises
    ------
    InputError
        There is no requirement, no factor, a factor that changes methods or requirements, or too many points.
    StoppedError
        It was cancelled.
    """
    require_limits(scenario)
    plan, places, points = points_of(scenario, study, seeds, quantile)
    share, left_out = 0.0 if as_set else _TUNING_SHARE, ()
    methods: tuple[Method, ...] = scenario.method
    if not as_set:
        spread = Spread(tuple(_searched(scenario, points)), quantile)
        found, left = tuned_methods(scenario, part_of(progress, 0.0, share), cancelled, spread)
        methods, left_out = (*found, *held_as_set(scenario), *kalman(scenario)), tuple(left)
    if not methods:
        raise InputError([Fault("", "method", name, reason) for name, reason in left_out])
    rows: list[tuple[Share, ...]] = []
    for k, one in enumerate((scenario, *points)):
        span = (1.0 - share) / (len(points) + 1)
        part = part_of(progress, share + k * span, share + (k + 1) * span)
        results = outcomes(one, methods, range(seeds), part, cancelled)
        if len(results) < seeds:
            raise StoppedError(Fault("", "--over", study.title, Text("stopped before all points were run")))
        rows.append(shares_of(Ship(one, True, TUNING_INTERVALS, drawn=True), methods, results))
    shares = (
        _robust(k, rows, seeds, Spread(quantile=quantile), lambda at: plan.values(places[at]))
        for k in range(len(methods))
    )
    ordered = tuple(sorted(shares, key=lambda one: one.order))
    return Robust(len(points), seeds, quantile, ordered, left_out, assumed_zero(scenario))


def points_of(
    scenario: Scenario, study: Study, seeds: int = 1, quantile: float = 0.0
) -> tuple[Plan, list[Setting], list[Scenario]]:
    """Lay a study's factors over a scenario: the plan, the setting of each point and its scenario."""
    plan = _laid_over(scenario, study, seeds, quantile)
    places = [plan.at(number)[0] for number in range(plan.runs)]
    return plan, places, [plan.scenario_of(place) for place in places]


def _laid_over(scenario: Scenario, study: Study, seeds: int, quantile: float) -> Plan:
    """Number the points, each of which is one run of the plan."""
    faults = []
    if seeds < 1:
        faults.append(Fault("", "--seeds", seeds, Text("must be >= 1")))
    if not 0.0 <= quantile < 1.0:
        faults.append(Fault("", "--quantile", quantile, Text("must be >= 0 and < 1")))
    if not study.factor:
        faults.append(Fault("", "factor", None, Text("is needed: what may differ")))
    for i, factor in enumerate(study.factor):
        for field in factor.fields:
            if any(f"{field}.".startswith(f"{block}.") for block in _LEFT_ALONE):
                allowed = Text("must not be a method, a requirement or the seed: these are what is judged")
                faults.append(Fault("", f"factor.{i}.field", field, allowed))
    if faults:
        raise InputError(faults)
    given = scenario.canonical()
    plan = Plan(study.model_copy(update={"scenario": given, "set": (), "fidelity": None, "seeds": 1}))
    if plan.runs > MOST_POINTS:
        allowed = Text("are {points} points; at most {most} are judged", points=plan.runs, most=MOST_POINTS)
        raise InputError(Fault("", "factor", None, allowed))
    return plan


def _searched(scenario: Scenario, points: Sequence[Scenario]) -> Iterator[Scenario]:
    """A few points from the easiest to the hardest, by what a common network makes of the limits there."""
    common = default_method(scenario, "classic2")
    ordered = sorted(points, key=lambda point: ratio_at(Ship(point, True, INTERVALS, drawn=True), common))
    for place in np.unique(np.linspace(0, len(ordered) - 1, _SEARCHED).round().astype(int)):
        yield ordered[place]


def _robust(
    number: int,
    rows: Sequence[Sequence[Share]],
    seeds: int,
    spread: Spread,
    where: Callable[[int], dict[str, Any]],
) -> RobustShare:
    nominal, *points = (row[number] for row in rows)
    runs = seeds * len(points)
    met = round(sum(one.met for one in points) * seeds)
    worst = min(range(len(points)), key=lambda at: points[at].met)
    counted = spread.of_shares([one.met for one in points])
    return RobustShare(
        nominal.method, met / runs, *wilson(met, runs), counted, nominal, points[worst], where(worst)
    )
