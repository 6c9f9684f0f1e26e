"""Figures that would have to be better where no method meets the limits (design.md, from limits to designs).

A figure that is k times better leaves 1 / k of the errors that follow from it. How much of a limited
quantity these are is known from the covariance along the run by source, or, for a method that has none (the
Kalman filter, a policy), from runs in which the figure is `MOST` times better. Runs with the better figures
correct k, for a largest value is not the same multiple of the deviation whether noise or a bias makes it.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from navcore.design.along import Along
from navcore.design.measures import Setting
from navcore.design.seeds import no_covariance
from navcore.design.shares import Limit, Share, share_of
from navcore.design.ship import Ship
from navcore.design.stated import fields_of_sources
from navcore.design.tuned_designs import foretold
from navcore.engine.ensemble import outcomes
from navcore.quantities import QUANTITIES
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.requirement import OF_THE_SETTING

MOST = 1000.0
"""Largest factor that is looked for."""
_RUNS, _ROUNDS, _CLOSE = 48, 3, 0.02
"""Seeds of a correction, corrections, and the distance of the median from its limit that is close enough."""
_ENOUGH = 1.1
"""Largest median over its limit that a correction may leave: what stays above it was not enough."""
_SINGLE, _METHODS = 2, 3
"""Figures by themselves that are named for one limit of several, and methods that are asked, best first."""


@dataclass(frozen=True)
class Needed:
    """Figures of which all are better by one factor, and what a method then makes of a limit.

    Attributes
    ----------
    quantity : str or None
        The limit; None: all of them.
    figures : tuple of str
        Fields of the scenario; empty where no single figure is enough.
    factor : float or None
        By which each of them has to be smaller for the median over the seeds to meet it.
    method : str
        Its setting stays as it is: tuned for the better figures it may need less.
    before, after : float or None
        Share of seeds that meet the limit with the figures as they are, and with the better ones; None where
        no single figure is enough, or no run has said so.
    """

    quantity: str | None
    figures: tuple[str, ...]
    factor: float | None
    method: str
    before: float
    after: float | None = None

    def as_dict(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        return dict(vars(self), figures=list(self.figures))


def needed(
    scenario: Scenario, shares: Sequence[Share], cancelled: Callable[[], bool] | None = None
) -> tuple[Needed, ...]:
    """Say which figures would have to be how much better for the median over the seeds to meet each limit.

    Parameters
    ----------
    scenario : Scenario
        With requirements.
    shares : sequence of Share
        Methods with their medians, best first. Another one than the best is asked only for what no single
        figure of the better ones is enough for. Those that diverge are passed over.
    cancelled : callable, optional
        When it says True, what was corrected by runs so far is given.

    Returns
    -------
    tuple of Needed
        For all limits together, and for each one that the best method misses where there are several: each
        figure by itself, least factor first, or one entry without figures. For all limits also each sensor
        with all its figures, and all figures together. A figure is left out where no factor up to `MOST` is
        enough.
    """
    runs = _Runs(scenario, cancelled)
    found: list[Needed] = []
    for share in [one for one in shares if one.diverged < runs.seeds][:_METHODS]:
        single = {one.quantity for one in found if len(one.figures) == 1}
        seen = {one.quantity for one in found}
        wanted = [(None, share.limits), *_missed(share)]
        wanted = [(quantity, limits) for quantity, limits in wanted if quantity not in single]
        if not found or any(quantity in seen for quantity, _ in wanted):
            found += _of_method(runs, share, wanted, groups=not found)
    best, quantities = shares[0], dict.fromkeys((None, *(name for name, _ in _missed(shares[0]))))
    for quantity in quantities:
        if not any(one.quantity == quantity and len(one.figures) == 1 for one in found):
            found.append(Needed(quantity, (), None, best.method.label(), _met(best, quantity)))
    return tuple(
        sorted(
            found, key=lambda one: (one.quantity or "", len(one.figures), one.factor or math.inf, one.method)
        )
    )


def _missed(share: Share) -> list[tuple[str | None, tuple[Limit, ...]]]:
    """Limits that a method misses on half of the seeds, each by itself; none where it is the only one."""
    if len(share.limits) < 2:
        return []
    return [(one.requirement.quantity, (one,)) for one in share.limits if one.ratio > 1.0]


def _met(share: Share, quantity: str | None) -> float:
    """Share of seeds that meet a limit, or all of them."""
    if quantity is None:
        return share.met
    return min(one.met for one in share.limits if one.requirement.quantity == quantity)


def _of_method(
    runs: "_Runs",
    share: Share,
    wanted: Sequence[tuple[str | None, Sequence[Limit]]],
    *,
    groups: bool,
) -> Iterator[Needed]:
    """Yield what is enough for each limit by one method, first each figure by itself."""
    if any(limit.median is None for limit in share.limits):
        return
    covered = not no_covariance(runs.scenario, share.method)
    sources = runs.sources(share.method) if covered else runs.figures
    sensors = dict.fromkeys(source.split("_")[0] for source in sources)
    ways = [(source,) for source in sources]
    if groups:
        ways += [tuple(one for one in sources if one.startswith(f"{sensor}_")) for sensor in sensors]
        ways.append(tuple(sources))
    for quantity, limits in wanted:
        setting = [one for one in limits if one.requirement.quantity in OF_THE_SETTING]
        of_runs = [one for one in limits if one not in setting]
        if any(one.ratio > 1.0 for one in setting):
            continue
        begun: list[tuple[float, _Parts]] = []
        for group in dict.fromkeys(ways if quantity is None else [way for way in ways if len(way) == 1]):
            names = tuple(dict.fromkeys(runs.fields[source] for source in group))
            left = runs.left(share, of_runs, group, names)
            if left is not None:
                parts = _Parts(quantity, names, share, of_runs, left, [one.ratio for one in of_runs])
                begun.append((parts.factor(), parts))
        single = 0
        for factor, parts in sorted(begun, key=lambda one: (one[0], len(one[1].figures))):
            alone = len(parts.figures) == 1
            if factor > MOST or (alone and quantity is not None and single >= _SINGLE):
                continue
            corrected, after = _corrected(runs, parts, factor)
            if corrected <= MOST:
                single += alone
                before = _met(share, quantity)
                yield Needed(quantity, parts.figures, corrected, share.method.label(), before, after)


@dataclass(eq=False)
class _Parts:
    """Share of one group of figures in the limited quantities of one method.

    `left` gives the value of a limited quantity with better figures over that of the figures as they are;
    `ratios` are medians over their limits with the figures as they are, later those that runs correct.
    """

    quantity: str | None
    figures: tuple[str, ...]
    share: Share
    limits: Sequence[Limit]
    left: Callable[[Limit, float], float]
    ratios: list[float]

    def correct(self, factor: float, ratios: Sequence[float]) -> None:
        """Take over medians over their limits of runs with figures that are better by a factor."""
        pairs = zip(self.limits, ratios, strict=True)
        self.ratios = [ratio / (self.left(limit, factor) or 1.0) for limit, ratio in pairs]

    def factor(self) -> float:
        """Factor by which the figures have to be smaller; infinite where that is not enough."""
        pairs = zip(self.limits, self.ratios, strict=True)
        return max((self._factor(limit, ratio) for limit, ratio in pairs), default=1.0)

    def _factor(self, limit: Limit, ratio: float) -> float:
        if ratio <= 1.0:
            return 1.0
        if ratio * self.left(limit, MOST) > 1.0:
            return math.inf
        low, high = 1.0, MOST
        while high > 1.001 * low:
            middle = math.sqrt(low * high)
            enough = ratio * self.left(limit, middle) <= 1.0
            low, high = (low, middle) if enough else (middle, high)
        return high


class _Runs:
    """Runs with better figures, and what covariances and runs say of the figures' parts.

    Parameters
    ----------
    scenario : Scenario
        With requirements.
    cancelled : callable or None
        Says whether to stop.
    """

    seeds = _RUNS

    def __init__(self, scenario: Scenario, cancelled: Callable[[], bool] | None) -> None:
        self.scenario, self.cancelled = scenario, cancelled
        self.ship, self.fields = Ship(scenario, drawn=True), fields_of_sources(scenario)
        self._along: dict[str, Along] = {}
        self._judged: dict[tuple[str, tuple[str, ...], float], Share | None] = {}

    @property
    def figures(self) -> list[str]:
        """Sources whose figure is a number other than 0."""
        return [source for source, field in self.fields.items() if _number(self.scenario, field)]

    def along(self, method: Method) -> Along:
        """Errors of a method along the run by source."""
        key = method.label()
        if key not in self._along:
            self._along[key] = self.ship.along(method)
        return self._along[key]

    def sources(self, method: Method) -> list[str]:
        """Sources that act on a method."""
        variance = self.along(method).variance
        return [one for one in variance if one in self.figures and variance[one].any()]

    def left(
        self, share: Share, limits: Sequence[Limit], sources: Sequence[str], figures: tuple[str, ...]
    ) -> Callable[[Limit, float], float] | None:
        """Value of a limited quantity with better figures over the present one; None where it was stopped."""
        if not no_covariance(self.scenario, share.method):
            one = self.along(share.method)

            def by_covariance(limit: Limit, factor: float) -> float:
                what = QUANTITIES[limit.requirement.quantity], one.t_s
                now = foretold(*what, one.total, limit.requirement)
                better = one.scaled(dict.fromkeys(sources, 1.0 / factor))
                return foretold(*what, better, limit.requirement) / now if now else 1.0

            return by_covariance
        best, now = self.judged(share.method, figures, MOST), self.judged(share.method, figures, 1.0)
        if best is None or now is None:
            return None
        rest = {
            limit.requirement: min(1.0, (_median(best, limit) / _median(now, limit)) ** 2) for limit in limits
        }

        def by_runs(limit: Limit, factor: float) -> float:
            part = rest[limit.requirement]
            return math.sqrt(part + (1.0 - part) / factor**2)

        return by_runs

    def judged(self, method: Method, figures: tuple[str, ...], factor: float) -> Share | None:
        """Judge a method with better figures; None where it was stopped."""
        key = method.label(), figures if factor > 1.0 else (), factor
        if key not in self._judged:
            better = with_better(self.scenario, figures, factor)
            found = outcomes(better, (method,), range(_RUNS), cancelled=self.cancelled)
            done = len(found) == _RUNS
            self._judged[key] = (
                share_of(Setting(self.ship, method), [one[0] for one in found]) if done else None
            )
        return self._judged[key]


def _median(share: Share, limit: Limit) -> float:
    """Median of a limited quantity; infinite where there is none."""
    (value,) = (one.median for one in share.limits if one.requirement == limit.requirement)
    return math.inf if value is None else value or 1e-300


def _number(scenario: Scenario, field: str) -> bool:
    """Whether a field holds numbers that are not all 0."""
    block, name = field.split(".")
    value = getattr(getattr(scenario, block), name)
    values = value if isinstance(value, tuple) else (value,)
    return all(isinstance(one, float | int) for one in values) and any(values)


def _corrected(runs: _Runs, parts: _Parts, factor: float) -> tuple[float, float | None]:
    """Factor after runs with the better figures, and the share of seeds that then meet the limit."""
    after: float | None = None
    wanted = [limit.requirement for limit in parts.limits]
    for _ in range(_ROUNDS):
        judged = runs.judged(parts.share.method, parts.figures, factor)
        if judged is None:
            break
        after = _met(judged, parts.quantity)
        ratios = [one.ratio for one in judged.limits if one.requirement in wanted]
        if abs(max(ratios) - 1.0) <= _CLOSE:
            break
        parts.correct(factor, ratios)
        better = parts.factor()
        if better > MOST:
            return better, None
        factor = better
    judged = runs.judged(parts.share.method, parts.figures, factor)
    if judged is None:
        return factor, after
    short = max(one.ratio for one in judged.limits if one.requirement in wanted) > _ENOUGH
    return math.inf if short else factor, _met(judged, parts.quantity)


def with_better(scenario: Scenario, figures: Sequence[str], factor: float) -> Scenario:
    """Return the scenario with some of its figures smaller by a factor; its methods stay as they are."""
    blocks: dict[str, dict[str, Any]] = {}
    for figure in figures:
        block, field = figure.split(".")
        value = getattr(getattr(scenario, block), field)
        smaller = tuple(x / factor for x in value) if isinstance(value, tuple) else value / factor
        blocks.setdefault(block, {})[field] = smaller
    update = {name: getattr(scenario, name).model_copy(update=fields) for name, fields in blocks.items()}
    return scenario.model_copy(update=update)
