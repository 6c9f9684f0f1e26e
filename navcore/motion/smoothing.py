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
    from scipy.interpolate import CubicSpline, make_smoothing_spline

    elapsed = time_s - time_s[0]
    if smoothing_s == 0.0 or elapsed.size < FEWEST_FIXES:
        spline = CubicSpline(elapsed, values, bc_type="natural")
    else:
        penalty = smoothing_s**4 / float(np.median(np.diff(elapsed)))
        spline = make_smoothing_spline(elapsed, values, lam=penalty)
    starts = elapsed[:-1]
    coefficients = np.stack(
        [spline(starts, 3) / 6.0, spline(starts, 2) / 2.0, spline(starts, 1), spline(starts)]
    )
    return Spline(time_s[0], elapsed, coefficients)
