"""Settling and settle point of a gyrocompass by its readings, as IMO A.821(19), 2 and 4.1, prescribes."""

import math
from collections.abc import Sequence

import numpy as np

from navcore.foundation.units import DEG, MINUTE

BAND = 0.7 * DEG
"""Of three readings at intervals of 30 min, when the compass has settled, rad."""
_SETTLES, _POINTS = (3, 30.0 * MINUTE), (10, 20.0 * MINUTE)
"""Number of readings and their interval, s: for settling, and for the settle point."""


def settled_s(readings: Sequence[tuple[float, float]], reading_s: float) -> float:
    """Time of the third of the first three readings at 30 min that lie within 0.7 deg, s; infinite for none.

    Parameters
    ----------
    readings : sequence of (float, float)
        Heading error, and the same times cos L, from t = 0 on, rad.
    reading_s : float
        Their interval, s.
    """
    count, every = _SETTLES[0], _apart(_SETTLES[1], reading_s)
    errors = np.array([plain for plain, _ in readings])
    for first in range(len(errors) - (count - 1) * every):
        three = errors[first : first + (count - 1) * every + 1 : every]
        if float(np.ptp(three)) <= BAND:
            return (first + (count - 1) * every) * reading_s
    return math.inf


def settle_point(readings: Sequence[tuple[float, float]], reading_s: float) -> tuple[float, float]:
    """Mean of ten readings at 20 min after settling, and the RMS of their differences to it, rad.

    Both times cos L; infinite where the compass does not settle, or the readings end before the tenth.

    Parameters
    ----------
    readings, reading_s
        As of `settled_s`.
    """
    settled = settled_s(readings, reading_s)
    if math.isinf(settled):
        return math.inf, math.inf
    count, every = _POINTS[0], _apart(_POINTS[1], reading_s)
    ten = np.array([level for _, level in readings])[round(settled / reading_s) :: every][:count]
    if len(ten) < count:
        return math.inf, math.inf
    mean = float(np.mean(ten))
    return mean, float(np.sqrt(np.mean((ten - mean) ** 2)))


def _apart(interval_s: float, reading_s: float) -> int:
    return max(1, round(interval_s / reading_s)) if reading_s else 1
