"""Coefficients of polynomials, and their roots, exact where a formula gives them."""

import math
from collections.abc import Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

_T = TypeVar("_T", bound=np.generic)


def sorted_roots(roots: np.ndarray) -> NDArray[np.complex128]:
    """Return the roots as complex numbers, slowest first."""
    values = np.asarray(roots, dtype=np.complex128)
    return values[np.lexsort((values.imag, np.abs(values)))]


def quadratic_roots(b: float, c: float) -> list[complex]:
    """Roots of p^2 + b p + c without cancellation; complex ones as an exact conjugate pair."""
    discriminant = 0.25 * b * b - c
    if discriminant < 0.0:
        imag = math.sqrt(-discriminant)
        return [complex(-0.5 * b, -imag), complex(-0.5 * b, imag)]
    large = -0.5 * b - math.copysign(math.sqrt(discriminant), b)
    return [complex(large), complex(c / large if large != 0.0 else 0.0)]


def pair(damping: float, frequency: float) -> list[complex]:
    """Roots of p^2 + 2 damping frequency p + frequency^2, exact for damping = 1 too."""
    real = -damping * frequency
    if damping < 1.0:
        imag = frequency * math.sqrt((1.0 - damping) * (1.0 + damping))
        return [complex(real, -imag), complex(real, imag)]
    large = real - frequency * math.sqrt((damping - 1.0) * (damping + 1.0))
    return [complex(large), complex(frequency * frequency / large)]


def leading(coefficients: Sequence[float] | np.ndarray) -> np.ndarray:
    """Coefficients from the first that is not zero; `numpy.trim_zeros` takes twenty times as long."""
    array = np.asarray(coefficients, dtype=float)
    return array[np.logical_or.accumulate(array != 0.0)]


def fixed(array: NDArray[_T]) -> NDArray[_T]:
    """Return the array, contiguous and read-only."""
    array = np.ascontiguousarray(array)
    array.setflags(write=False)
    return array
