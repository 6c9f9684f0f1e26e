"""Stamps coarser than the data: several rows in order that bear the same second are spread over it.

So are rows that a host stamped as they arrived, many at once.
"""

import numpy as np

_FEWEST_STAMPS = 3
_OF_A_BURST, _SHORT, _ALL = 3, 0.1, 0.9
"""Rows at least; share of the mean interval between them at most; share of the rows that are in bursts."""


def spread(time_s: np.ndarray) -> tuple[np.ndarray, int]:
    """Times with the rows of one stamp spread evenly over its interval, and how many rows bear one stamp.

    Parameters
    ----------
    time_s : ndarray, shape (n,)
        Never decreasing; else, and when most stamps stand once, it is returned as it is, with a count of 1.

    Returns
    -------
    times : ndarray, shape (n,)
        A first stamp with fewer rows than the median has those of its interval's end.
    rows : int
        Median number of rows of a stamp.
    """
    steps = np.diff(time_s)
    if time_s.size < _FEWEST_STAMPS or not np.all(steps >= 0.0) or np.all(steps > 0.0):
        return time_s, 1
    stamps, counts = np.unique(time_s, return_counts=True)
    each = int(np.median(counts))
    if stamps.size < _FEWEST_STAMPS or each < 2 or counts.max() > 2 * each:
        return time_s, 1
    interval = float(np.median(np.diff(stamps)))
    shared = np.maximum(counts, each)
    places = np.arange(time_s.size) - np.repeat(np.cumsum(counts) - counts, counts)
    late = max(each - int(counts[0]), 0)
    places[: counts[0]] += late
    return np.repeat(stamps, counts) + interval * places / np.repeat(shared, counts), each


def spread_bursts(time_s: np.ndarray) -> tuple[np.ndarray, int]:
    """Times with the rows of one arrival spread evenly over the time since the one before.

    Parameters
    ----------
    time_s : ndarray, shape (n,)
        Increasing; returned as it is, with a count of 1, where the rows do not come in bursts of one size.

    Returns
    -------
    times : ndarray, shape (n,)
        The last row of a burst was measured when it arrived, the others before.
    rows : int
        Median number of rows of a burst.
    """
    steps = np.diff(time_s)
    if time_s.size < _FEWEST_STAMPS * _OF_A_BURST or not np.all(steps > 0.0):
        return time_s, 1
    together = steps < _SHORT * float(np.ptp(time_s)) / steps.size
    burst = np.concatenate([[0], np.cumsum(~together)])
    counts = np.bincount(burst)
    each = int(np.median(counts))
    if each < _OF_A_BURST or np.count_nonzero(counts[burst] >= _OF_A_BURST) < _ALL * time_s.size:
        return time_s, 1
    arrivals = time_s[np.cumsum(counts) - 1]
    spread_s, rows = spread(-arrivals[burst][::-1])
    return (time_s, 1) if rows == 1 else (-spread_s[::-1], rows)
