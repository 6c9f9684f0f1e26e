"""The vehicle's true state on a uniform time grid: its columns, and where it starts."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

# Columns of Truth.values.
LAT, LON, HEIGHT, VE, VN, VU, AE, AN, AU, PITCH, ROLL, HEADING, PITCH_RATE, ROLL_RATE, HEADING_RATE = range(
    15
)
COLUMNS = 15


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
    def mean_velocity(self) -> tuple[float, float]:
        """Mean east and north velocity, m/s."""
        return float(np.mean(self.column(VE))), float(np.mean(self.column(VN)))

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
