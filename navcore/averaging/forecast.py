"""Forecast of the IMU: the mean of the alignment record without small motions of the base (Zhao 18-27).

The fit is of order 0: a line through 600 s of gyro noise extrapolates to degrees per hour after 12 h
(theory.md section 5). Zhao's (26) shifts every segment onto the last one's mean, so that a fit of order 0
would be the last segment's mean alone; here each earlier segment is *turned* into the attitude of the next by
the gyros themselves, so that all of them count.
"""

from dataclasses import dataclass

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text

THRESHOLD_SIGMA = 5.0
"""An increment further than this off the median belongs to a motion (theory.md section 5)."""
GUARD = 2
"""Increments on either side of a motion that are not used either."""
FINEST_SIGMA = 1e-6
"""Least noise assumed of an angle increment, rad: a turned base feels another part of the Earth rate."""
COARSEST_SIGMA = 1e-4
"""Most noise of an angle increment at rest, rad: 0.3 deg/sqrt(h); beyond, the base swings all along."""
FEWEST_STILL = 10
"""Increments at rest that a forecast needs."""
_MAD_TO_SIGMA = 1.4826


@dataclass(frozen=True)
class Forecast:
    """Forecast IMU signals, constant in time.

    Attributes
    ----------
    gyro : ndarray, shape (3,)
        Angular rate in body axes of t = 0, rad/s.
    accel : ndarray, shape (3,)
        Specific force in body axes of t = 0, m/s^2.
    segments : tuple of (int, int)
        First and one after the last increment of each part of the record that was used.
    """

    gyro: np.ndarray
    accel: np.ndarray
    segments: tuple[tuple[int, int], ...]


def base_motion(angles: np.ndarray) -> np.ndarray:
    """Find the small motions of the base in the integrated gyro output.

    Parameters
    ----------
    angles : ndarray, shape (n, 3)
        Angle increments over a second each, rad.

    Returns
    -------
    ndarray of bool, shape (n,)
        True where an increment of any axis is more than five sigma off the median, and two on either side.
        Sigma is robust: 1.4826 times the median deviation. True everywhere when sigma is that of a swing.
    """
    off = np.abs(angles - np.median(angles, axis=0))
    sigma = np.maximum(_MAD_TO_SIGMA * np.median(off, axis=0), FINEST_SIGMA)
    if sigma.max() > COARSEST_SIGMA:
        return np.ones(len(angles), bool)
    moving = (off > THRESHOLD_SIGMA * sigma).any(axis=1)
    near = np.convolve(moving, np.ones(2 * GUARD + 1))[GUARD : GUARD + len(angles)]
    return np.asarray(near > 0.5)


def still_segments(moving: np.ndarray) -> tuple[tuple[int, int], ...]:
    """First and one after the last index of each run of False."""
    edges = np.flatnonzero(np.diff(np.concatenate([[True], moving, [True]]).astype(np.int8)))
    return tuple((int(first), int(last)) for first, last in edges.reshape(-1, 2))


def forecast_from(increments: np.ndarray, step_s: float = 1.0) -> Forecast:
    """Forecast from an alignment record.

    Parameters
    ----------
    increments : ndarray, shape (n, 6)
        Angles (rad) and velocities (m/s) in body axes over intervals of about a second, the last one ending
        at t = 0.
    step_s : float
        Interval, s.

    Raises
    ------
    InputError
        The base hardly ever stands still.
    """
    segments = still_segments(base_motion(increments[:, :3]))
    still = sum(last - first for first, last in segments)
    if still < FEWEST_STILL:
        raise InputError(
            Fault(
                "",
                "alignment.duration_s",
                None,
                Text(
                    "the base stands still for {still:g} s of the alignment record: half-period "
                    "averaging needs {fewest_still:g} s or more to forecast from",
                    still=still * step_s,
                    fewest_still=FEWEST_STILL * step_s,
                ),
            )
        )
    means = [increments[first:last].mean(axis=0) for first, last in segments]
    total, weight = np.zeros(6), 0
    for i, (first, last) in enumerate(segments):
        if i > 0:
            gap = slice(segments[i - 1][1], first)
            # The Earth's rate goes on during the motion and is no part of it.
            turned = (increments[gap, :3] - means[i][:3]).sum(axis=0)
            total = _turned_axes(total, turned)
        total += (last - first) * means[i]
        weight += last - first
    last_gap = increments[segments[-1][1] :, :3]
    mean = total / weight
    if len(last_gap):
        mean = _turned_axes(mean, (last_gap - mean[:3]).sum(axis=0))
    return Forecast(mean[:3] / step_s, mean[3:] / step_s, segments)


def _turned_axes(signals: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """Two vectors, shape (6,), in the axes of a body that has turned by a rotation vector since."""
    angle = float(np.linalg.norm(turn))
    if angle == 0.0:
        return signals.copy()
    axis, c, s = turn / angle, np.cos(angle), np.sin(angle)
    out = np.empty(6)
    for part in (slice(0, 3), slice(3, 6)):
        v = signals[part]
        out[part] = c * v - s * np.cross(axis, v) + (1.0 - c) * (axis @ v) * axis
    return out
