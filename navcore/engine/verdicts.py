"""Three verdicts: a limit is met, missed, or open, and then how many more seeds would decide.

Whatever judges a limit over seeds takes its verdict from here. A share has the interval of Wilson. Median and
percentile meet a limit exactly where the share of the seeds below it reaches a half or 95 %: one rule judges
them all. A root mean square has the interval of Student.
"""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.quantities import QUANTITIES, Quantity, value_unit
from navcore.quantities.quantity import Over
from navcore.scenario.requirement import Requirement

Verdict = Literal["met", "missed", "open"]
WORDS: dict[str, str] = {"met": Text("met"), "missed": Text("missed"), "open": Text("open")}
"""Verdicts in words."""
_Z = 1.96
"""Quantile of the 95 % interval."""
_MOST_SEEDS = 10**7
_PERCENTILES: dict[Over, float] = {"median": 0.5, "p95": 0.95}


@dataclass(frozen=True)
class Judgement:
    """What seeds say of one limit.

    Attributes
    ----------
    seeds : int
        Runs, those that diverged too.
    met : float
        Share of them that meet the limit.
    low, high : float
        Wilson interval of it, 95 %.
    value : float
        Statistic over the seeds, in the unit of the quantity's name: that of the quantity, else the median.
        Infinite where there is none.
    value_low, value_high : float
        95 % interval of a quantity over the seeds; else the value twice.
    verdict : {"met", "missed", "open"} or None
        None where neither a share nor a quantity over the seeds is asked: the run itself judges that limit.
    more : int or None
        Of an open verdict: further seeds after which it would be decided, if they come out alike; None where
        none would.
    """

    seeds: int
    met: float
    low: float
    high: float
    value: float
    value_low: float
    value_high: float
    verdict: Verdict | None
    more: int | None = None

    def as_dict(self) -> dict[str, Any]:
        """Return the share as a document."""
        return {"seeds": self.seeds, "met": self.met, "low": self.low, "high": self.high}


def wilson(met: float, count: float) -> tuple[float, float]:
    """Wilson interval of a share, 95 %, without continuity term.

    Examples
    --------
    >>> [round(end, 4) for end in wilson(150, 200)]
    [0.6857, 0.8049]
    """
    share, square = met / count, _Z * _Z
    middle = share + square / (2.0 * count)
    width = _Z * math.sqrt(share * (1.0 - share) / count + square / (4.0 * count * count))
    below = 1.0 + square / count
    low, high = max(0.0, (middle - width) / below), min(1.0, (middle + width) / below)
    return min(low, share), max(high, share)  # rounding must not leave the share itself outside


def share_verdict(met: int, count: int, share: float) -> tuple[Verdict, int | None]:
    """Judge a share that is asked, and say how many more seeds would decide.

    Parameters
    ----------
    met, count : int
        Seeds that meet the limit, and all.
    share : float
        Asked.

    Examples
    --------
    >>> share_verdict(200, 200, 0.95), share_verdict(100, 200, 0.95), share_verdict(24, 24, 0.95)
    (('met', None), ('missed', None), ('open', 49))
    """

    def decides(seeds: int) -> Verdict | None:
        low, high = wilson(met * seeds / count, seeds)
        return "met" if low >= share else "missed" if high < share else None

    now = decides(count)
    return (now, None) if now else ("open", _more(count, lambda seeds: decides(seeds) is not None))


def judge(one: Requirement, values: np.ndarray, ended: np.ndarray, end_h: float) -> Judgement:
    """Judge a limit by its values on all seeds.

    Parameters
    ----------
    one : Requirement
        The limit.
    values : ndarray, shape (seeds,)
        In the unit of the quantity's name; infinite for a seed without a value.
    ended : ndarray of bool, shape (seeds,)
        Seeds that did not diverge: no other one meets a limit.
    end_h : float
        End of the run, h: no longer is a bound known to hold.
    """
    row, count = QUANTITIES[one.quantity], len(values)
    kept = int(np.count_nonzero(np.array([one.met(value) for value in values.tolist()]) & ended))
    value, low, high = _statistic(row, one, values, end_h)
    verdict, more = None, None
    of_share = one.share if one.share is not None else _PERCENTILES.get(row.over)
    if row.kind is None:  # of the setting: all seeds or none
        verdict = None if one.share is None else "met" if kept else "missed"
    elif of_share is not None:
        verdict, more = share_verdict(kept, count, of_share)
    elif row.over:
        verdict = "met" if high <= one.limit else "missed" if low > one.limit else "open"
        more = _more_for_mean(value, high, one.limit, count) if verdict == "open" else None
    return Judgement(count, kept / count, *wilson(kept, count), value, low, high, verdict, more)


def together(verdicts: Iterable[Verdict]) -> Verdict:
    """Verdict on all limits: missed where one is, else open where one is."""
    found = {*verdicts}
    return "missed" if "missed" in found else "open" if "open" in found else "met"


def _statistic(
    row: Quantity, one: Requirement, values: np.ndarray, end_h: float
) -> tuple[float, float, float]:
    """Value over the seeds in the unit of its name, and its 95 % interval where there is one."""
    if row.over in _PERCENTILES:
        return _percentile(np.sort(values), _PERCENTILES[row.over])
    if row.over == "repeat":
        value = float(np.max(np.abs(np.diff(values)))) if len(values) > 1 else math.inf
        value = math.inf if math.isnan(value) else value
        return value, value, value
    if row.over:
        factor = 2.0 if row.over == "2drms" else 1.0
        value, low, high = (factor * x for x in _root_mean_square(values))
        return value, low, high
    if row.statistic == "held":  # reached in the share of the seeds, by the whole seeds
        reaching = math.ceil((0.5 if one.share is None else one.share) * len(values) - 1e-9)
        value = float(np.sort(values)[len(values) - max(1, reaching)])
        value = min(value, end_h * HOUR / value_unit(row.key))
    else:
        value = float(np.median(values))
    return value, value, value


def _percentile(ordered: np.ndarray, part: float) -> tuple[float, float, float]:
    """Percentile and its interval: the values at which the share of seeds below them decides on the part."""
    count, at = len(ordered), part * (len(ordered) - 1)
    below, above = ordered[math.floor(at)], ordered[math.ceil(at)]
    value = float(below if below == above else below + (at - math.floor(at)) * (above - below))
    below_all = [wilson(k, count) for k in range(count + 1)]
    least = next(k for k, (_, high) in enumerate(below_all) if high >= part)
    most = next((k for k, (low, _) in enumerate(below_all) if low >= part), None)
    low = 0.0 if least == 0 else float(ordered[least - 1])
    return value, low, math.inf if most is None else float(ordered[most - 1])


def _root_mean_square(values: np.ndarray) -> tuple[float, float, float]:
    """Root of the mean square and its interval, by Student of the squares."""
    squares = values * values
    mean = float(np.mean(squares))
    if not math.isfinite(mean) or len(values) < 2:
        return math.sqrt(mean), 0.0, math.inf
    from scipy.stats import t

    half = float(t.ppf(0.975, len(values) - 1) * np.std(squares, ddof=1) / math.sqrt(len(values)))
    return math.sqrt(mean), math.sqrt(max(0.0, mean - half)), math.sqrt(mean + half)


def _more_for_mean(value: float, high: float, limit: float, count: int) -> int | None:
    """Seeds that make the interval of a root mean square too narrow to hold the limit."""
    mean, half = value * value, high * high - value * value
    apart = abs(limit * limit - mean)
    if not (math.isfinite(half) and math.isfinite(mean)) or apart == 0.0:
        return None
    return _more(count, lambda seeds: half * math.sqrt(count / seeds) < apart)


def _more(count: int, decided: Callable[[int], bool]) -> int | None:
    """Least number of further seeds after which something is decided; None beyond `_MOST_SEEDS`."""
    most = 2 * count
    while not decided(most):
        if (most := 2 * most) > _MOST_SEEDS:
            return None
    least = max(count, most // 2)
    while most - least > 1:
        middle = (least + most) // 2
        least, most = (least, middle) if decided(middle) else (middle, most)
    return most - count
