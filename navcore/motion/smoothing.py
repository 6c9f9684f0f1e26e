"""Smoothing splines of recorded columns as functions of time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from scipy.interpolate import PPoly

FEWEST_FIXES = 5
"""Of a column that is smoothed; fewer are joined."""
Polynomials = tuple[np.ndarray, np.ndarray]
"""Breakpoints (n + 1,) and coefficients (4, n), highest power first."""


class Spline:
    """Cubic spline in time from its first knot, which keeps UTC's large numbers out of the polynomials."""

    def __init__(self, start_s: float, breaks: np.ndarray, coefficients: np.ndarray) -> None:
        self._start_s, self._breaks, self._coefficients = start_s, breaks, coefficients

    def column(self, j: int, start_s: float) -> Polynomials:
        """Breakpoints since ``start_s`` and coefficients of column j."""
        return self._breaks + (self._start_s - start_s), self._coefficients[:, :, j]

    def _polynomials(self) -> PPoly:
        from scipy.interpolate import PPoly

        return PPoly(self._coefficients, self._breaks)

    def at(self, time_s: np.ndarray) -> np.ndarray:
        """Columns at UTC times, shape (m, k)."""
        return self._polynomials()(time_s - self._start_s)

    def rate(self, time_s: np.ndarray) -> np.ndarray:
        """Derivatives of the columns at UTC times, shape (m, k)."""
        return self._polynomials()(time_s - self._start_s, 1)

    def integral(self, time_s: np.ndarray) -> np.ndarray:
        """Integrals of the columns from the first of the UTC times, shape (m, k)."""
        whole = self._polynomials().antiderivative()(time_s - self._start_s)
        return whole - whole[0]


def clamped(time_s: np.ndarray, values: np.ndarray, ends: np.ndarray) -> Spline:
    """Spline through the values, with these derivatives at the first and last time."""
    from scipy.interpolate import CubicSpline

    elapsed = time_s - time_s[0]
    derivatives: Any = ((1, ends[0]), (1, ends[1]))  # scipy types it as a text
    spline = CubicSpline(elapsed, values, bc_type=derivatives)
    return Spline(time_s[0], elapsed, spline.c)


def smoothed_columns(time_s: np.ndarray, values: np.ndarray, smoothing_s: float) -> Spline:
    """Smoothing spline of the columns; the penalty makes its cut-off 1 / smoothing_s at the median rate."""
    elapsed = time_s - time_s[0]
    if smoothing_s == 0.0 or elapsed.size < FEWEST_FIXES:
        from scipy.interpolate import CubicSpline

        return Spline(time_s[0], elapsed, CubicSpline(elapsed, values, bc_type="natural").c)
    penalty = smoothing_s**4 / float(np.median(np.diff(elapsed)))
    return Spline(time_s[0], elapsed, _smoothing_spline(elapsed, values, penalty))


def _smoothing_spline(x: np.ndarray, y: np.ndarray, penalty: float) -> np.ndarray:
    """Natural cubic spline g that makes sum (y - g)^2 + penalty times the integral of g''^2 least.

    scipy's `make_smoothing_spline` finds the same in a loop over the points: 35 us for each of a million.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Increasing.
    y : ndarray, shape (n, k)
    penalty : float

    Returns
    -------
    ndarray, shape (4, n - 1, k)
        Coefficients of each piece, highest power first.

    References
    ----------
    .. [1] C. H. Reinsch, "Smoothing by spline functions", Numerische Mathematik 10, 1967, eq. 7 to 9.
    """
    from scipy.linalg import solveh_banded

    h = np.diff(x)
    left, right = 1.0 / h[:-1], 1.0 / h[1:]  # of the second differences, which are the rows of Q'
    middle = -left - right
    bands = np.zeros((3, x.size - 2))  # of R + penalty Q'Q, the diagonal first
    bands[0] = (h[:-1] + h[1:]) / 3.0 + penalty * (left * left + middle * middle + right * right)
    bands[1, :-1] = h[1:-1] / 6.0 + penalty * (middle[:-1] * left[1:] + right[:-1] * middle[1:])
    bands[2, :-2] = penalty * right[:-2] * left[2:]
    slopes = np.diff(y, axis=0) / h[:, None]
    bend = np.zeros_like(y)  # second derivative at each point, 0 at the ends
    bend[1:-1] = solveh_banded(bands, np.diff(slopes, axis=0), lower=True, overwrite_ab=True)
    push = np.diff(bend, axis=0) / h[:, None]
    smooth = y.astype(float)
    smooth[1:-1] -= penalty * np.diff(push, axis=0)
    smooth[0] -= penalty * push[0]
    smooth[-1] += penalty * push[-1]
    slopes = np.diff(smooth, axis=0) / h[:, None]
    linear = slopes - h[:, None] * (2.0 * bend[:-1] + bend[1:]) / 6.0
    return np.stack([push / 6.0, bend[:-1] / 2.0, linear, smooth[:-1]])
