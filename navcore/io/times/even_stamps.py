"""Stamps of samples that an instrument takes evenly: their interval, what is lost, and how uneven they are.

A host that stamps what arrives is late by more or less: 2 and 8 ms in turn at 200 Hz. No sample is missing
there. A gap is where fewer samples stand than the time needs: from there on *all* stamps are later.
"""

from typing import NamedTuple

import numpy as np

_GAP = 1.5
"""Sample intervals; a longer step may be a gap."""
_NEAR = 0.1
"""Steps within this share of the median are alike."""
_MOST_ALIKE = 0.8
"""... and when so many are, the median is the interval."""
_BLOCK = 100
"""Steps over which the interval of uneven stamps is a mean."""
_WINDOW_S = 1.0
_FEWEST = 8


class Evenness(NamedTuple):
    """Times that stamps give.

    Attributes
    ----------
    interval_s : float
        Between samples, s.
    gaps : ndarray of int, shape (g,)
        Number of the sample before each gap.
    longest_s : float
        Longest step at a gap, s; 0 without one.
    jitter_s : float
        Largest distance of a step from the interval, s, gaps apart.
    """

    interval_s: float
    gaps: np.ndarray
    longest_s: float
    jitter_s: float


def evenness(time_s: np.ndarray) -> Evenness:
    """Interval, gaps and jitter of increasing stamps, shape (n,), n > 1."""
    steps = np.diff(time_s)
    interval = _interval(time_s, steps)
    long = np.flatnonzero(steps > _GAP * interval)
    gaps = _gaps(time_s, interval, long) if long.size else long
    kept = np.delete(steps, gaps)
    jitter = float(np.abs(kept - interval).max(initial=0.0))
    if gaps.size == 0 and jitter < _NEAR * interval:
        interval = float((time_s[-1] - time_s[0]) / steps.size)
    elif gaps.size == 0:
        interval = _slope(time_s)
    return Evenness(interval, gaps, float(steps[gaps].max(initial=0.0)), jitter)


def _interval(time_s: np.ndarray, steps: np.ndarray) -> float:
    middle = float(np.median(steps))
    if np.mean(np.abs(steps - middle) < _NEAR * middle) >= _MOST_ALIKE:
        return middle
    block = min(_BLOCK, steps.size)
    return float(np.median(time_s[block:] - time_s[:-block])) / block


def _slope(time_s: np.ndarray) -> float:
    """Interval of the line through all stamps, by least squares: the ends alone are as uneven as the rest."""
    place = np.arange(time_s.size) - 0.5 * (time_s.size - 1)
    return float(place @ (time_s - time_s.mean()) / (place @ place))


def _gaps(time_s: np.ndarray, interval: float, at: np.ndarray) -> np.ndarray:
    """Those of the samples ``at`` behind which samples are lost: the earliest stamps of a second move."""
    from scipy.ndimage import minimum_filter1d

    late = time_s - interval * np.arange(time_s.size)
    window = int(np.clip(_WINDOW_S / interval, _FEWEST, 1000))
    # With these origins a window ends at, or begins with, its sample.
    before = minimum_filter1d(late, window, mode="nearest", origin=(window - 1) // 2)
    after = minimum_filter1d(late, window, mode="nearest", origin=-(window // 2))
    gaps: list[int] = []
    for place in at[np.rint((after[at + 1] - before[at]) / interval) >= 1]:
        begin = max(place - window + 1, gaps[-1] + 1 if gaps else 0)
        if np.rint((after[place + 1] - late[begin : place + 1].min()) / interval) >= 1:
            gaps.append(int(place))
    return np.array(gaps, dtype=int)
