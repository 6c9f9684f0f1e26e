"""Steps of a recorded position that its own velocity does not account for: fixes, and receivers that jump."""

from dataclasses import dataclass

import numpy as np

from navcore.foundation.earth import WGS84
from navcore.foundation.text import Text
from navcore.io.series import Series, utc_text

JUMP_M = 20.0
"""Smallest step of the position that is a jump, m."""
JUMP_MPS = 0.5
"""Smallest step of the velocity that is one, m/s, beside what `_ACCELERATION` gives."""
_ACCELERATION = 0.3
"""Ships accelerate by less, m/s^2."""
_TURN = 2.5
"""... and their positions leave the line of the velocities by less than half of this times the square of the
interval, m/s^2."""
_TIMES_USUAL = 12.0
"""A jump is so many times the median of what is left."""
_RETURNS = 0.2
"""Share of a step that is left after the next one where a single fix was an outlier."""


@dataclass(frozen=True)
class Jump:
    """Step between two readings.

    Attributes
    ----------
    at : int
        Number of the first position after it.
    time_s : float
        Time of that position, UTC, s.
    angles : tuple of float
        Latitude and longitude by which the position steps, rad.
    size_m : float
        Its length, m.
    velocity_mps : float
        Step of the velocity at the same place, m/s; 0 where it does not step.
    """

    at: int
    time_s: float
    angles: tuple[float, float]
    size_m: float
    velocity_mps: float = 0.0

    @property
    def text(self) -> str:
        """Size and time, in words."""
        when = utc_text(self.time_s)
        if self.velocity_mps:
            return Text(
                "{size:.0f} m, with {velocity:.2f} m/s of the velocity, at {when}",
                size=self.size_m,
                velocity=self.velocity_mps,
                when=when,
            )
        return Text("{size:.0f} m at {when}", size=self.size_m, when=when)


def jumps_of(position: Series, velocity: Series | None = None) -> tuple[Jump, ...]:
    """Find where a position steps by more than its motion accounts for, in the order of time.

    Parameters
    ----------
    position : Series
        Latitude, longitude (rad), height.
    velocity : Series, optional
        East and north, m/s. Without it the displacements beside a step say what the motion is.
    """
    time_s, step_s = position.time_s, np.diff(position.time_s)
    if step_s.size < 3:
        return ()
    lat, lon = position.values[:, 0], np.unwrap(position.values[:, 1])
    meridian, prime_vertical = WGS84.radii(float(np.median(lat)))
    angles = np.column_stack([np.diff(lat), np.diff(lon)])
    across = prime_vertical * np.cos(0.5 * (lat[1:] + lat[:-1]))
    moved = np.column_stack([angles[:, 1] * across, angles[:, 0] * meridian])
    at_fixes = None if velocity is None else _at(velocity, time_s)
    rate = _beside(moved / step_s[:, None]) if at_fixes is None else 0.5 * (at_fixes[1:] + at_fixes[:-1])
    left = moved - rate * step_s[:, None]
    size = np.hypot(*left.T)
    least = np.maximum(JUMP_M, np.maximum(0.5 * _TURN * step_s**2, _TIMES_USUAL * np.median(size)))
    found = {int(k): float(size[k]) for k in np.flatnonzero(size > least) if not _returns(left, int(k))}
    steps = {} if at_fixes is None else _velocity_steps(at_fixes, step_s)
    return tuple(
        Jump(
            k + 1,
            float(time_s[k + 1]),
            (float(left[k, 1] / meridian), float(left[k, 0] / across[k])),
            float(size[k]),
            steps.get(k, 0.0),
        )
        for k in sorted(found | steps)
    )


def _at(velocity: Series, time_s: np.ndarray) -> np.ndarray | None:
    """East and north velocity at the positions; None where it is too coarse or too short for them."""
    kept = velocity.valid
    known = velocity.time_s[kept]
    usual = float(np.median(np.diff(time_s)))
    if known.size < 2 or velocity.interval_s > 1.5 * usual or known[0] > time_s[1] or known[-1] < time_s[-2]:
        return None
    return np.column_stack([np.interp(time_s, known, velocity.values[kept, j]) for j in range(2)])


def _beside(rate: np.ndarray) -> np.ndarray:
    """Median of the rates of the two steps before and the two after each."""
    padded = np.pad(rate, ((2, 2), (0, 0)), mode="edge")
    beside = np.stack([padded[:-4], padded[1:-3], padded[3:-1], padded[4:]])
    return np.median(beside, axis=0)


def _returns(left: np.ndarray, k: int) -> bool:
    """Whether the step is one way of an outlier: the one before or after it takes it back."""
    size = float(np.hypot(*left[k]))
    return any(
        0 <= other < len(left) and float(np.hypot(*(left[k] + left[other]))) < _RETURNS * size
        for other in (k - 1, k + 1)
    )


def _velocity_steps(velocity: np.ndarray, step_s: np.ndarray) -> dict[int, float]:
    """Steps of the velocity that no ship makes, by the number of the interval, m/s."""
    size = np.hypot(*np.diff(velocity, axis=0).T)
    least = np.maximum(JUMP_MPS + _ACCELERATION * step_s, _TIMES_USUAL * np.median(size))
    return {int(k): float(size[k]) for k in np.flatnonzero(size > least)}
