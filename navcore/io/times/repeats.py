"""Rows that are there twice: equal in every cell, their time among them."""

from collections.abc import Callable

import numpy as np

_MOST_RUNS = 1000
"""More steps back in time are no file that was appended to itself."""


def first_of_equals(ids: np.ndarray, time_s: np.ndarray) -> np.ndarray:
    """Which rows to keep of a table in which equal rows have equal numbers.

    Parameters
    ----------
    ids : ndarray of int, shape (n,)
        Equal for rows that are equal in every cell.
    time_s : ndarray, shape (n,)
        Of the rows, in their order.

    Returns
    -------
    ndarray of bool, shape (n,)
        The first of equal rows, where that leaves one row for each time, or where every row is there as
        often as the others; else all: rows of one coarse stamp may be equal by chance.
    """
    _, first, counts = np.unique(ids, return_index=True, return_counts=True)
    kept = np.zeros(ids.size, bool)
    kept[first] = True
    alike = bool(counts.min() == counts.max() > 1)
    if alike or bool(np.all(np.diff(time_s[kept]) > 0.0)):
        return kept
    return np.ones(ids.size, bool)


def there_again(
    time_s: np.ndarray, own: np.ndarray, ids: np.ndarray, changes: Callable[[], np.ndarray]
) -> np.ndarray:
    """Which lines stand in a run that is there before, as in a log that was appended to itself.

    Parameters
    ----------
    time_s : ndarray, shape (n,)
        That each line gives, NaN where it gives none.
    own : ndarray of bool, shape (n,)
        Whether it is in the line's own sentence: such a line is the same as another by more than chance.
    ids : ndarray of int, shape (n,)
        Equal for lines that are the same.
    changes : callable
        Which lines have another reading than the one of their kind before, shape (n,). A run without any is
        that of a ship at her berth, whose clock may have been set back.

    Returns
    -------
    ndarray of bool, shape (n,)
        Lines from one at which time runs backwards to the last that follows its like as it did before.
    """
    again = np.zeros(time_s.size, bool)
    clocks = np.flatnonzero(own & ~np.isnan(time_s))
    backward = clocks[1:][np.diff(time_s[clocks]) < 0.0]
    if backward.size == 0:
        return again
    end, changed = 0, None
    for place in backward.tolist()[:_MOST_RUNS]:
        if place < end:
            continue
        before = clocks[: np.searchsorted(clocks, place)]
        like = before[(ids[before] == ids[place]) & (time_s[before] == time_s[place])]
        if like.size == 0:
            continue
        same = ids[like[0] : like[0] + ids.size - place] == ids[place:]
        stop = place + (int(same.argmin()) if not same.all() else same.size)
        if changed is None:
            changed = changes()
        if changed[like[0] + 1 : like[0] + stop - place].any():
            end = stop
            again[place:end] = True
    return again


def ids_of(columns: np.ndarray) -> np.ndarray:
    """Numbers of the rows of an array, shape (n, k): equal for equal rows; NaN is equal to NaN."""
    _, ids = np.unique(np.nan_to_num(columns, nan=-1.7e308), axis=0, return_inverse=True)
    return ids.ravel()
