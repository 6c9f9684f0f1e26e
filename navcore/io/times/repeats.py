"""Rows that are there twice: equal in every cell, their time among them."""

import numpy as np


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


def ids_of(columns: np.ndarray) -> np.ndarray:
    """Numbers of the rows of an array, shape (n, k): equal for equal rows; NaN is equal to NaN."""
    _, ids = np.unique(np.nan_to_num(columns, nan=-1.7e308), axis=0, return_inverse=True)
    return ids.ravel()
