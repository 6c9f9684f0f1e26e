"""How far two runs of a method lie apart, held against the method's own level and against the limits.

The peak of a curve is that of its start: a difference of a fifth of what a method settles at stands far below
it. So the difference is taken over the second half, as a root mean square, and over several seeds.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from navcore.engine.measures import judged
from navcore.engine.run import MethodRun
from navcore.foundation.text import Text
from navcore.quantities import ERRORS, NAMES, QUANTITIES, RecordedError
from navcore.scenario.requirement import Requirement

OF_LEVEL = 0.05
"""Part of a method's own level from which a difference is reported."""
Pair = tuple[MethodRun, MethodRun]
"""The strapdown run and the linear one."""


@dataclass(frozen=True)
class Level:
    """Difference of one quantity over the second half of the run.

    Attributes
    ----------
    rms : float
        Root mean square of the difference, SI.
    share : float or None
        The same over that of the strapdown curve; None where that is zero.
    low, high : float or None
        Of the share, 95 % interval over the seeds (Student); None with one seed.
    seeds : int
        Of which it is the mean.
    """

    rms: float
    share: float | None
    low: float | None = None
    high: float | None = None
    seeds: int = 1


def levels(pairs: Sequence[Pair]) -> dict[str, Level]:
    """Difference of a method in each quantity of `navcore.quantities.NAMES`, over its runs of several seeds.

    Parameters
    ----------
    pairs : sequence of Pair
        One a seed. Those of which one run has no two rows in its second half are left out.
    """
    squares = [found for pair in pairs if (found := _squares(*pair)) is not None]
    if not squares:
        return {}
    apart, own = np.array(squares).swapaxes(0, 1)
    return {name: _level(apart[:, i], own[:, i]) for i, name in enumerate(NAMES)}


def _squares(full: MethodRun, simple: MethodRun) -> tuple[np.ndarray, np.ndarray] | None:
    rows = min(len(full.t_s), len(simple.t_s))
    later = slice(rows // 2, rows)
    if rows < 4:
        return None
    columns = slice(0, len(NAMES))
    apart = full.rows[later, columns] - simple.rows[later, columns]
    return np.mean(apart**2, axis=0), np.mean(full.rows[later, columns] ** 2, axis=0)


def _level(apart: np.ndarray, own: np.ndarray) -> Level:
    rms, seeds = math.sqrt(float(np.mean(apart))), len(apart)
    if not np.all(own > 0.0):
        return Level(rms, None, seeds=seeds)
    share = math.sqrt(float(np.sum(apart) / np.sum(own)))
    if seeds < 2:
        return Level(rms, share)
    from scipy.stats import t

    each = np.sqrt(apart / own)
    half = float(t.ppf(0.975, seeds - 1) * np.std(each, ddof=1) / math.sqrt(seeds))
    middle = float(np.mean(each))
    return Level(rms, share, max(0.0, middle - half), middle + half, seeds)


def worst(found: dict[str, Level], smallest: dict[str, float]) -> tuple[RecordedError, Level] | None:
    """Quantity that differs most of its own level, if by more than `OF_LEVEL` and by what can be seen.

    Parameters
    ----------
    found : dict of Level
        Of `levels`.
    smallest : dict of float
        Difference that is nobody's concern, by dimension, SI.
    """
    shares = {
        error: level.share
        for error in ERRORS
        if (level := found.get(error.name)) is not None
        and level.share is not None
        and level.rms > smallest[error.kind.dimension]
    }
    error = max(shares, key=shares.__getitem__, default=None)
    return None if error is None or shares[error] <= OF_LEVEL else (error, found[error.name])


def level_text(error: RecordedError, level: Level) -> str:
    """Say by how much a quantity differs in the second half."""
    share = 100.0 * (level.share or 0.0)
    if level.low is None or level.high is None:
        return Text(
            "{label} differs by {share:.3g} % RMS of its own level in the second half.",
            label=error.label,
            share=share,
        )
    return Text(
        "{label} differs by {share:.3g} % RMS of its own level in the second half "
        "({low:.2g} to {high:.2g} % over {seeds} seeds).",
        label=error.label,
        share=share,
        low=100.0 * level.low,
        high=100.0 * level.high,
        seeds=level.seeds,
    )


def limit_texts(requirements: Sequence[Requirement], pair: Pair) -> Iterator[str]:
    """Yield a sentence for each limit that one of both runs meets and the other one misses."""
    for one in requirements:
        (value, met), (simple, simple_met) = (judged(one, run) for run in pair)
        if met is simple_met or value is None or simple is None:
            continue
        words = (
            Text("the linear model meets the limit and the strapdown run misses it")
            if simple_met
            else Text("the strapdown run meets the limit and the linear model misses it")
        )
        yield Text(
            "{label}: {words} ({simple:.4g} and {value:.4g}, limit {limit:g}).",
            label=QUANTITIES[one.quantity].label,
            words=words,
            simple=simple,
            value=value,
            limit=one.limit,
        )
