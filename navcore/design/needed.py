"""Figures that would have to be better where no method meets the limits (design.md, from limits to designs).

The covariance along the run gives the parts of each limited quantity by source: a figure that is k times
better leaves 1 / k of the errors that follow from it. Runs with the better figures correct k, for a largest
value is not the same multiple of the deviation whether noise or a bias makes it.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
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
from navcore.engine.measures import begins_s
from navcore.quantities import QUANTITIES
from navcore.scenario.model import Scenario
from navcore.scenario.requirement import OF_THE_SETTING

MOST = 1000.0
"""Largest factor that is looked for."""
_RUNS, _ROUNDS, _CLOSE = 48, 3, 0.02
"""Seeds of a correction, corrections, and the distance of the median from its limit that is close enough."""
_SINGLE = 2
"""Figures by themselves that are named for one limit of several."""


@dataclass(frozen=True)
class Needed:
    """Figures of which all are better by one factor, and the method that then meets the limits soonest.

    Attributes
    ----------
    quantity : str or None
        Limit that is then met; None: all of them.
    figures : tuple of str
        Fields of the scenario.
    factor : float
        By which each of them has to be smaller for the median over the seeds to meet it.
    method : str
        Its setting stays as it is: tuned for the better figures it may need less.
    """

    quantity: str | None
    figures: tuple[str, ...]
    factor: float
    method: str

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
        Methods with their medians. Those that diverge, miss a limit of the setting, or have no covariance by
        source are passed over.
    cancelled : callable, optional
        When it says True, what was corrected by runs so far is given.

    Returns
    -------
    tuple of Needed
        For all limits together: each figure by itself, each sensor with all its figures, and all figures.
        For each limit that is missed, where there are several: the figures that are enough by themselves.
        Least factor first; a figure is left out where no factor up to `MOST` is enough.
    """
    ship, fields = Ship(scenario, drawn=True), fields_of_sources(scenario)
    best: dict[tuple[str | None, tuple[str, ...]], tuple[float, _Parts]] = {}
    for share in shares:
        for parts in _parts(ship, share, fields):
            factor, key = parts.factor(), (parts.quantity, parts.figures)
            if factor <= MOST and (key not in best or factor < best[key][0]):
                best[key] = factor, parts
    ordered = sorted(best.values(), key=lambda one: (one[0], len(one[1].figures)))
    found: list[Needed] = []
    for factor, parts in ordered:
        alike = sum(one.quantity == parts.quantity for one in found)
        if alike >= _SINGLE and len(parts.figures) == 1 and parts.quantity is not None:
            continue
        corrected = _corrected(ship, parts, factor, cancelled)
        if corrected <= MOST:
            name = parts.share.method.label()
            found.append(Needed(parts.quantity, parts.figures, corrected, name))
    return tuple(sorted(found, key=lambda one: (one.quantity or "", one.factor, len(one.figures))))


@dataclass(eq=False)
class _Parts:
    """Share of one group of figures in the limited quantities of one method.

    `ratios` are medians over their limits with the figures as they are, later those that runs correct.
    """

    quantity: str | None
    figures: tuple[str, ...]
    share: Share
    limits: Sequence[Limit]
    along: Along
    sources: tuple[str, ...]
    ratios: list[float]

    def foretold(self, limit: Limit, factor: float) -> float:
        """Value of a quantity, SI, by the covariance with better figures."""
        left = self.along.scaled(dict.fromkeys(self.sources, 1.0 / factor))
        return foretold(
            QUANTITIES[limit.requirement.quantity], self.along.t_s, left, begins_s(limit.requirement)
        )

    def correct(self, factor: float, ratios: Sequence[float]) -> None:
        """Take over medians over their limits of runs with figures that are better by a factor."""
        pairs = zip(self.limits, ratios, strict=True)
        self.ratios = [
            ratio * self.foretold(limit, 1.0) / (self.foretold(limit, factor) or 1.0)
            for limit, ratio in pairs
        ]

    def factor(self) -> float:
        """Factor by which the figures have to be smaller; infinite where that is not enough."""
        return max(self._factor(limit, ratio) for limit, ratio in zip(self.limits, self.ratios, strict=True))

    def _factor(self, limit: Limit, ratio: float) -> float:
        now = self.foretold(limit, 1.0)
        if ratio <= 1.0 or not now:
            return 1.0
        if ratio * self.foretold(limit, MOST) > now:
            return math.inf
        low, high = 1.0, MOST
        while high > 1.001 * low:
            middle = math.sqrt(low * high)
            enough = ratio * self.foretold(limit, middle) <= now
            low, high = (low, middle) if enough else (middle, high)
        return high


def _parts(ship: Ship, share: Share, fields: Mapping[str, str]) -> Iterator[_Parts]:
    """Yield groups of figures of one method, for all limits and for each that is missed."""
    of_runs = [limit for limit in share.limits if limit.requirement.quantity not in OF_THE_SETTING]
    others = [limit for limit in share.limits if limit not in of_runs]
    if any(limit.median is None for limit in share.limits) or any(limit.ratio > 1.0 for limit in others):
        return
    if no_covariance(ship.scenario, share.method):
        return
    along = ship.along(share.method)
    sources = [source for source in along.variance if source in fields and along.variance[source].any()]
    sensors = dict.fromkeys(source.split("_")[0] for source in sources)
    single = [(source,) for source in sources]
    groups = [tuple(one for one in sources if one.startswith(f"{sensor}_")) for sensor in sensors]
    missed = [limit for limit in of_runs if limit.ratio > 1.0] if len(of_runs) > 1 else []
    wanted = [(None, of_runs, (*single, *groups, tuple(sources)))]
    wanted += [(limit.requirement.quantity, [limit], single) for limit in missed]
    for quantity, limits, ways in wanted:
        for group in dict.fromkeys(ways):
            names = tuple(dict.fromkeys(fields[source] for source in group))
            ratios = [limit.ratio for limit in limits]
            yield _Parts(quantity, names, share, limits, along, group, ratios)


def _corrected(ship: Ship, parts: _Parts, factor: float, cancelled: Callable[[], bool] | None) -> float:
    """Factor after runs with the better figures."""
    for _ in range(_ROUNDS):
        better = with_better(ship.scenario, parts.figures, factor)
        found = outcomes(better, (parts.share.method,), range(_RUNS), cancelled=cancelled)
        if len(found) < _RUNS:
            break
        setting = Setting(ship, parts.share.method)
        limits = share_of(setting, [one[0] for one in found]).limits
        ratios = [
            one.ratio for one in limits if one.requirement in [other.requirement for other in parts.limits]
        ]
        if abs(max(ratios) - 1.0) <= _CLOSE:
            break
        parts.correct(factor, ratios)
        factor = parts.factor()
        if factor > MOST:
            break
    return factor


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
