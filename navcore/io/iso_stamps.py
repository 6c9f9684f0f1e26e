"""ISO 8601 stamps beside all lines of a text at once, in the form that most loggers write."""

import numpy as np

_SHAPE = np.frombuffer("0000-00-00T00:00:00.000000000".encode("utf-32-le"), np.uint32)
_DIGIT = _SHAPE == ord("0")
_TENS = np.array([0, 2, 5, 8, 11, 14, 17])
"""Places of the first of two digits: century, year, month, day, hour, minute, second."""
_MOST = np.array([21, 99, 12, 31, 23, 59, 59])
_LEAST = np.array([20, 0, 1, 1, 0, 0, 0])


def iso_seconds(letters: np.ndarray, begins: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """UTC of stamps such as ``2018-12-06T00:00:00.6208Z``, behind which a blank may stand.

    Parameters
    ----------
    letters : ndarray of uint32
        Characters of the text.
    begins, ends : ndarray of int, shape (n,)
        Places in it.

    Returns
    -------
    ndarray, shape (n,)
        s since 1970; NaN where there is no stamp or one of another form.
    """
    seconds = np.full(begins.size, np.nan)
    last = ends - 1
    last = last - np.isin(letters.take(last, mode="clip"), (ord(" "), ord("\t")))
    size = last - begins
    formed = (size == 19) | ((size > 20) & (size <= _SHAPE.size))
    rows = np.flatnonzero(formed & (letters.take(last, mode="clip") == ord("Z")))
    stamps = letters.take(begins[rows, None] + np.arange(_SHAPE.size), mode="clip")
    behind = np.arange(_SHAPE.size) >= size[rows, None]
    digits = np.where(behind, 0, stamps - np.uint32(ord("0"))).astype(int)
    pairs = 10 * digits[:, _TENS] + digits[:, _TENS + 1]
    right = (behind | np.where(_DIGIT, digits < 10, stamps == _SHAPE)).all(axis=1)
    right &= ((pairs >= _LEAST) & (pairs <= _MOST)).all(axis=1)
    rows, digits = rows[right], digits[right]
    century, year, month, day, hour, minute, second = pairs[right].T
    months = (12 * (100 * century + year - 1970) + month - 1).astype("M8[M]")
    first, beyond = ((months + k).astype("M8[D]").astype(int) for k in (0, 1))
    days = first + day - 1
    microseconds = digits[:, 20:26] @ (10 ** np.arange(5, -1, -1))
    microseconds += 10**6 * (86400 * days + 3600 * hour + 60 * minute + second)
    seconds[rows] = np.where(days < beyond, microseconds / 1e6, np.nan)
    return seconds
