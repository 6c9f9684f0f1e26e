"""Stamps of an even record: coarse or jittering ones are even all the same, and a missing sample is a gap."""

import numpy as np

from navcore.foundation.text import Text

_GAP = 1.5
"""Sample intervals between two stamps from which a missing sample is looked for."""
_AROUND = 10
"""Samples before and after a long interval whose stamps are compared."""
_MISSING = 0.5
"""Part of an interval by which the stamps after a missing sample are late."""
_LARGEST_JITTER = 2.0
_COARSE = 0.1
"""Part of the stamps that equal the one before from which they are coarse, not repeated by mistake."""


def interval_of(time_s: np.ndarray) -> tuple[float, float]:
    """Sample interval of an even record and the largest distance of a stamp from it, s.

    Parameters
    ----------
    time_s : ndarray, shape (n,)
        Stamps, n >= 2.

    Raises
    ------
    ValueError
        In words: time runs backwards, or samples are missing, and where.
    """
    steps = np.diff(time_s)
    back = np.flatnonzero(steps < 0.0)
    interval = float(time_s[-1] - time_s[0]) / (len(time_s) - 1)
    late = time_s - time_s[0] - interval * np.arange(len(time_s))
    alike = np.count_nonzero(steps == 0.0)
    coarse = alike > max(_COARSE * len(steps), _AROUND) and np.ptp(late) <= 2.0 * _LARGEST_JITTER * interval
    still = interval <= 0.0 or (alike > 0 and not coarse)
    if back.size or still:
        first = back[0] if back.size else np.flatnonzero(steps <= 0.0)[0]
        raise ValueError(
            Text("time stands still or runs backwards at t = {time_s:g} s", time_s=time_s[first + 1])
        )
    usual = float(np.median(steps)) or interval
    long = np.flatnonzero(steps > _GAP * min(usual, interval))
    gaps = long[_late_by(time_s, long, usual if np.ptp(steps) < 0.2 * usual else interval) > _MISSING]
    if gaps.size:
        raise ValueError(
            Text(
                "{size} gaps, the first at t = {time_s:g} s, the longest {longest:g} s: a strapdown run "
                "needs every sample",
                size=gaps.size,
                time_s=time_s[gaps[0]],
                longest=float(steps[gaps].max()),
            )
        )
    return interval, float(np.max(np.abs(late)))


def _late_by(time_s: np.ndarray, places: np.ndarray, interval: float) -> np.ndarray:
    """By how many intervals the stamps after each place are later than those before it would have them."""
    off = (time_s - time_s[0]) / interval - np.arange(len(time_s))
    sums = np.concatenate([[0.0], np.cumsum(off)])
    middle = places + 1
    first, last = np.maximum(0, middle - _AROUND), np.minimum(len(time_s), middle + _AROUND)
    before, after = sums[middle] - sums[first], sums[last] - sums[middle]
    return after / (last - middle) - before / (middle - first)
