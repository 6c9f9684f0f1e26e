"""Times of lines that give none, from those of the lines around them.

A log without stamps has its clock from the sentences that give a time. What stands behind such a sentence was
sent at about its time; several lines of one kind before the next time share the time between.
"""

import numpy as np

_LONGEST = 2.0
"""Usual distances of a kind; a group that would lie wider apart has the usual distance: lines are missing
there."""
_LONGEST_STEP_S, _STEPS = 10.0, 5.0
"""A time of doubt follows a sure one within this many s, or usual steps."""


_FEWEST_DOUBLED, _DOUBLED = 6, 0.4
"""Lines that give a time, and the share of them that repeat the one before."""


def trusted(time_s: np.ndarray, doubtful: np.ndarray) -> np.ndarray:
    """Which times of a log are its clock's.

    Parameters
    ----------
    time_s : ndarray, shape (n,)
        In the order of the lines; NaN where a line gives none.
    doubtful : ndarray of bool, shape (n,)
        Of a receiver without a fix, whose clock may not be set.

    Returns
    -------
    ndarray of bool, shape (n,)
        A doubtful time counts between the sure ones before and behind it, with which its run begins or ends;
        where no time is sure, all count.
    """
    given = ~np.isnan(time_s)
    sure = given & ~doubtful
    if not sure.any() or not (given & doubtful).any():
        return given
    places = np.flatnonzero(given)
    times, is_sure = time_s[places], sure[places]
    sure_times = times[is_sure]
    reach = (
        max(_LONGEST_STEP_S, _STEPS * float(np.median(np.diff(sure_times))))
        if sure_times.size > 1
        else _LONGEST_STEP_S
    )
    kept = is_sure.copy()
    edges = np.flatnonzero(np.diff(np.concatenate([[False], ~is_sure, [False]])))
    for begin, end in edges.reshape(-1, 2).tolist():
        run = times[begin:end]
        before = times[begin - 1] if begin else -np.inf
        after = times[end] if end < times.size else np.inf
        joined = run[0] - before <= reach or after - run[-1] <= reach
        kept[begin:end] = joined & (run >= before) & (run <= after)
    found = np.zeros(time_s.size, bool)
    found[places[kept]] = True
    return found


def by_kind(kinds: np.ndarray) -> np.ndarray:
    """Places of lines sorted by kind, each in its order, shape (n,); short numbers sort faster."""
    few = kinds.size and kinds.max() < np.iinfo(np.int16).max
    return np.argsort(kinds.astype(np.int16) if few else kinds, kind="stable")


def coarse(time_s: np.ndarray, kinds: np.ndarray, ids: np.ndarray) -> np.ndarray:
    """Which lines bear a stamp that is coarser than their kind: the same as the line of their kind before.

    Parameters
    ----------
    time_s : ndarray, shape (n,)
        Stamps in the order of the lines; NaN where there is none.
    kinds, ids : ndarray of int, shape (n,)
        Kinds, negative where they say nothing; equal for lines that are the same.

    Returns
    -------
    ndarray of bool, shape (n,)
        None of a kind whose lines with one stamp are all the same: these are there twice.
    """
    found = np.zeros(time_s.size, bool)
    rows = np.flatnonzero(~np.isnan(time_s) & (kinds >= 0))
    rows = rows[by_kind(kinds[rows])]
    again = (np.diff(kinds[rows]) == 0) & (np.diff(time_s[rows]) == 0.0)
    differing = again & (np.diff(ids[rows]) != 0)
    coarse_kinds = np.unique(kinds[rows[1:]][differing])
    found[rows[1:][again & np.isin(kinds[rows[1:]], coarse_kinds)]] = True
    return found


def are_doubled(time_s: np.ndarray, kinds: np.ndarray, ids: np.ndarray) -> bool:
    """Whether most lines that give a time are there twice, as after two loggers were joined; shapes (n,)."""
    rows = np.flatnonzero(~np.isnan(time_s) & (kinds >= 0))
    rows = rows[by_kind(kinds[rows])]
    if rows.size < _FEWEST_DOUBLED:
        return False
    same = (np.diff(kinds[rows]) == 0) & (np.diff(time_s[rows]) == 0.0) & (np.diff(ids[rows]) == 0)
    return bool(np.mean(same) >= _DOUBLED)


def filled(time_s: np.ndarray, kinds: np.ndarray) -> tuple[np.ndarray, int]:
    """Times of all lines, of which some give one.

    Parameters
    ----------
    time_s : ndarray, shape (n,)
        In the order of the lines; NaN where a line gives none.
    kinds : ndarray of int, shape (n,)
        Lines of one number are sent evenly; negative where that is not known.

    Returns
    -------
    time_s : ndarray, shape (n,)
        NaN before the first time.
    spread : int
        Lines that share the time between two others with more of their kind.
    """
    given = ~np.isnan(time_s)
    last = np.maximum.accumulate(np.where(given, np.arange(time_s.size), -1))
    found = np.where(last >= 0, time_s[last], np.nan)
    waiting = np.flatnonzero(~given & (last >= 0) & (kinds >= 0))
    if waiting.size == 0:
        return found, 0
    known = time_s[given]
    turns = np.concatenate([[0], np.cumsum(np.diff(known) != 0.0)])
    starts = known[np.concatenate([[0], np.flatnonzero(np.diff(turns)) + 1])]
    turn_of = np.zeros(time_s.size, int)
    turn_of[given] = turns
    steps = np.append(np.diff(starts), np.nan)
    waiting = waiting[by_kind(kinds[waiting])]
    kind, turn = kinds[waiting], turn_of[last[waiting]]
    first = np.concatenate([[True], (np.diff(kind) != 0) | (np.diff(turn) != 0)])
    group = np.cumsum(first) - 1
    # A line that gives the time itself is the first of its kind.
    size = int(turn_of.max()) + 1
    own = np.isin(kind[first] * size + turn[first], kinds[given] * size + turns).astype(int)
    counts = np.bincount(group) + own
    if counts.max() == 1:
        return found, 0
    places = np.arange(waiting.size) - np.flatnonzero(first)[group] + own[group]
    each = np.where(steps[turn[first]] > 0.0, steps[turn[first]], np.nan) / counts
    usual = {one: _median(each[kind[first] == one]) for one in np.unique(kind).tolist()}
    ordinary = np.array([usual[one] for one in kind[first].tolist()])
    with np.errstate(invalid="ignore"):
        each = np.where(each <= _LONGEST * ordinary, each, ordinary)
    later = np.nan_to_num(each[group] * places)
    found[waiting] += later
    return found, int(np.count_nonzero(later))


def _median(values: np.ndarray) -> float:
    known = values[~np.isnan(values)]
    return float(np.median(known)) if known.size else np.nan
