"""The vehicle's true state on a uniform time grid: its columns, and where it starts."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

# Columns of Truth.values.
LAT, LON, HEIGHT, VE, VN, VU, AE, AN, AU, PITCH, ROLL, HEADING, PITCH_RATE, ROLL_RATE, HEADING_RATE = range(
    15
)
COLUMNS = 15

_STRETCHES, _STRETCH_S = 12, 7200.0
"""Parts at most that a motion is divided into for the verdict on its stability, and their least length, s."""
_ALIKE = np.array([2e-3, 0.1, 0.1])
"""Difference of mean latitude (rad) and velocity (m/s) below which two parts are alike."""

Stretches = tuple[tuple[float, float, float, float], ...]
"""Latitude (rad), east and north velocity (m/s), on average, and duration (s) of parts of a motion."""


@dataclass(frozen=True)
class Site:
    """Where the motion starts: latitude and longitude in rad, height in m."""

    lat: float
    lon: float
    height: float


@dataclass(frozen=True, eq=False)
class Truth:
    """True trajectory and attitude at t = k * step_s.

    Attributes
    ----------
    step_s : float
        Grid step, s.
    values : ndarray, shape (n, 15), or (1, 15) when nothing changes
        Columns: latitude, longitude (rad), height (m), velocity E, N, U (m/s), its time derivative (m/s^2),
        pitch, roll, heading (rad, heading not wrapped) and their rates (rad/s).
    """

    step_s: float
    values: np.ndarray
    _last: list[np.ndarray] = field(default_factory=list, init=False, repr=False)

    @cached_property
    def stretches(self) -> Stretches:
        """Latitude (rad), east and north velocity (m/s), on average, and duration (s) of parts of the motion.

        Parts that follow each other and are alike are one; one for a vehicle at rest or on a straight course.
        """
        if self.constant:
            row = self.values[0]
            return ((float(row[LAT]), float(row[VE]), float(row[VN]), self.step_s),)
        spans_s = (len(self.values) - 1) * self.step_s
        count = max(1, min(_STRETCHES, int(spans_s / _STRETCH_S)))
        found: list[tuple[np.ndarray, float]] = []
        for part in np.array_split(self.values[:, [LAT, VE, VN]], count):
            mean, duration_s = part.mean(axis=0), len(part) * self.step_s
            if found and np.all(np.abs(mean - found[-1][0]) < _ALIKE):
                before, before_s = found.pop()
                whole_s = before_s + duration_s
                mean, duration_s = (before * before_s + mean * duration_s) / whole_s, whole_s
            found.append((mean, duration_s))
        return tuple((float(m[0]), float(m[1]), float(m[2]), duration_s) for m, duration_s in found)

    def at(self, rows: np.ndarray) -> np.ndarray:
        """Rows of `values`, shape (m, 15), not to be written to; a single row stands for all times.

        The last answer is kept: every run along this truth asks for the same rows.

        Parameters
        ----------
        rows : ndarray of int, shape (m,)
            Places on the grid.
        """
        if self.constant:
            return np.broadcast_to(self.values, (len(rows), COLUMNS))
        last = tuple(self._last)
        if not (last and np.array_equal(last[0], rows)):
            last = rows, self.values[rows]
            last[1].setflags(write=False)
            self._last[:] = last
        return last[1]

    @property
    def constant(self) -> bool:
        """True when one row stands for all times."""
        return self.values.shape[0] == 1

    def column(self, index: int) -> np.ndarray:
        """One column as a view, shape (n,) or (1,)."""
        return self.values[:, index]
