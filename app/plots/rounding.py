"""Round numbers: 1, 2 or 5 times a power of ten."""

from __future__ import annotations

import math


def round_down(value: float, mantissas: tuple[float, ...] = (1.0, 2.0, 5.0)) -> float:
    """Largest number of the form mantissa x 10^k that is not above ``value`` (> 0)."""
    power = 10.0 ** math.floor(math.log10(value))
    scaled = value / power * (1.0 + 1e-12)
    return max(m for m in mantissas if m <= scaled) * power


def round_up(value: float, mantissas: tuple[float, ...] = (1.0, 2.0, 5.0)) -> float:
    """Smallest number of the form mantissa x 10^k that is not below ``value`` (> 0)."""
    power = 10.0 ** math.floor(math.log10(value))
    scaled = value / power * (1.0 - 1e-12)
    return next((m for m in mantissas if m >= scaled), 10.0 * mantissas[0]) * power
