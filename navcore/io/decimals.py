"""Decimal numbers at many places of a text at once."""

import numpy as np

MOST_LETTERS = 15
"""Of a number: a `float` holds that many digits, and their power of ten, without any loss."""
_POWERS = 10.0 ** np.arange(MOST_LETTERS + 1)


def decimals(letters: np.ndarray, begins: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Numbers that consist of digits, a point among them or none, behind a minus or none.

    Parameters
    ----------
    letters : ndarray of uint32
        Characters of the text.
    begins, ends : ndarray of int, shape (n,)
        Where the numbers stand.

    Returns
    -------
    ndarray, shape (n,)
        What `float` makes of them; NaN for all that is longer or written otherwise.
    """
    negative = letters.take(begins, mode="clip") == ord("-")
    size = ends - begins - negative
    width = min(max(size.max(initial=1), 1), MOST_LETTERS)
    behind = np.arange(width - 1, -1, -1)
    cells = letters.take(ends[:, None] - 1 - behind, mode="clip")
    inside = behind < size[:, None]
    digits = cells - np.uint32(ord("0"))
    point, digit = inside & (cells == ord(".")), inside & (digits < 10)
    fraction = point @ behind
    pointed = point.any(axis=1)
    plain = (digit | point | ~inside).all(axis=1) & (size <= width) & digit.any(axis=1)
    plain &= np.count_nonzero(point, axis=1) <= 1
    written = np.where(digit, digits, 0) @ _POWERS[behind]
    scale = _POWERS[np.where(pointed & plain, fraction, 0)]
    below = written % scale
    numbers = np.where(pointed, (written - below) / 10.0 + below, written) / scale
    return np.where(plain, np.where(negative, -numbers, numbers), np.nan)
