"""Settings around an optimum: what each limit costs, what it can reach alone, how flat the optimum is."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from navcore.design.measures import Requirement, Setting, in_words, measure
from navcore.design.search import BOUNDLESS, MISSED, Effort, Search
from navcore.foundation.errors import Fault
from navcore.foundation.text import Text

_FLAT = 1.05


def without_limits(
    search: Search, rest: Sequence[Requirement], effort: Effort, start: np.ndarray | None
) -> float:
    """Objective that could be reached with fewer requirements."""
    other = Search(search.ships, search.varied, search.objective, rest, None, search.cancelled)
    other.reference, other.scale = search.reference, search.scale
    other.run(effort, start)
    if other.best is None or other.best[0] >= MISSED:  # stopped at once, or nothing meets the rest
        return math.inf
    return other.best[0] * other.scale


def flat_ranges(search: Search, places: np.ndarray, objective: float) -> dict[str, tuple[float, float]]:
    """Range of each field in which the objective stays within 5 % of the best, the others held."""
    quiet = Search(search.ships, search.varied, search.objective, search.requirements)
    quiet.reference, quiet.scale = search.reference, search.scale
    limit = _FLAT * objective / search.scale
    ranges = {}
    for i, one in enumerate(search.varied):
        ends = []
        for end in (0.0, 1.0):
            inside, outside = float(places[i]), end
            trial = places.copy()
            trial[i] = end
            if quiet.cost(trial) <= limit:
                ends.append(one.value(end))
                continue
            for _ in range(9):
                trial[i] = 0.5 * (inside + outside)
                if quiet.cost(trial) <= limit:
                    inside = float(trial[i])
                else:
                    outside = float(trial[i])
            ends.append(one.value(inside))
        ranges[one.field] = (ends[0], ends[1])
    return ranges


def nothing_meets(search: Search, effort: Effort, start: np.ndarray | None) -> Iterator[Fault]:
    """Yield a fault for each requirement: what is the best of it alone, and what it costs."""
    for one in search.requirements:
        reach = _reach(search, one, effort, start)
        rest = [other for other in search.requirements if other is not one]
        without = without_limits(search, rest, effort, start)
        if math.isfinite(without):
            least = in_words(search.objective.text, without)
            left = Text("without it {text} comes to {least}", text=search.objective.text, least=least)
        else:
            left = Text("without it the others are not met either")
        reason = Text(
            "nothing within these ranges meets all requirements: alone {name} comes to", name=one.name
        )
        yield Fault(
            "",
            "--require",
            one.text,
            Text("{reason} {in_words}; {left}", reason=reason, in_words=in_words(one.name, reach), left=left),
        )


def _reach(search: Search, one: Requirement, effort: Effort, start: np.ndarray | None) -> float:
    """Least value of a measure alone, or the largest where a requirement asks for at least something."""
    sign = 1.0 if one.sense == "<=" else -1.0

    class _Alone(Search):
        def value(self, settings: Sequence[Setting]) -> float:
            return max(sign * measure(setting, one.name) for setting in settings)

    alone = _Alone(search.ships, search.varied, search.objective, ())
    alone.run(effort, start)
    assert alone.best is not None
    return sign * alone.best[0] if alone.best[0] < BOUNDLESS else math.inf
