"""Forecast of the IMU: a fit of the alignment record without small motions of the base (Zhao 18-27).

By default it is of order 0: a line through 600 s of gyro noise extrapolates to degrees per hour after 12 h
(theory.md section 5). Zhao's (26) shifts every segment onto the last one's fit, so that a fit of the same
order to all of them is the last segment's alone; here each earlier segment is *turned* into the attitude of
the next by the gyros themselves, so that all of them count. (26) as printed is a setting.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.polynomial.polynomial import polyder, polyfit, polyval

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
    """Forecast IMU signals: polynomials in the time from t = 0 on.

    Attributes
    ----------
    gyro : ndarray, shape (3,)
        Angular rate in body axes of t = 0, at t = 0, rad/s.
    accel : ndarray, shape (3,)
        Specific force in body axes of t = 0, at t = 0, m/s^2.
    segments : tuple of (int, int)
        First and one after the last increment of each part of the record that was used.
    growth : ndarray, shape (order, 6)
        Factors of t, t^2, ... of rate and specific force, SI; empty where the forecast is constant.
    """

    gyro: np.ndarray
    accel: np.ndarray
    segments: tuple[tuple[int, int], ...]
    growth: np.ndarray = field(default_factory=lambda: np.zeros((0, 6)))

    @property
    def factors(self) -> np.ndarray:
        """Factors of 1, t, t^2, ... of rate and specific force, shape (order + 1, 6), SI."""
        return np.vstack([np.concatenate([self.gyro, self.accel]), self.growth])

    def at(self, time_s: np.ndarray) -> np.ndarray:
        """Rate and specific force at times from t = 0 on (before it: the fit itself), shape (n, 6), SI."""
        return polyval(np.asarray(time_s, float), self.factors).T

    def means(self, begin_s: float, step_s: float, count: int) -> np.ndarray:
        """Means over ``count`` steps from a time on, shape (count, 6), SI; one row where it is constant."""
        if not len(self.growth):
            return self.factors
        middle = begin_s + step_s * (np.arange(count) + 0.5)
        # Up to order 3 the mean over a step h is the value p in its middle and h^2/24 times p''.
        return self.at(middle) + step_s**2 / 24.0 * polyval(middle, polyder(self.factors, 2)).T


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


def forecast_from(
    increments: np.ndarray, step_s: float = 1.0, order: int = 0, shifted: bool = False
) -> Forecast:
    """Forecast from an alignment record.

    Parameters
    ----------
    increments : ndarray, shape (n, 6)
        Angles (rad) and velocities (m/s) in body axes over intervals of about a second, the last one ending
        at t = 0.
    step_s : float
        Interval, s.
    order : int
        Of the polynomial that is fitted by least squares (Zhao 18 to 21), 0 to 3; a short part of the record
        has a lower one.
    shifted : bool
        Parts of the record are shifted onto the fit of the last one, Zhao 26 as printed, in place of turned
        into its attitude.

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
    time_s = step_s * (np.arange(len(increments)) - len(increments) + 0.5)
    used = np.concatenate([np.arange(first, last) for first, last in segments])
    joined = (
        joined_parts(increments, segments) if not shifted else _shifted(increments, time_s, segments, order)
    )
    factors = _fit(time_s[used], joined, order) / step_s
    return Forecast(factors[0, :3], factors[0, 3:], segments, factors[1:])


def joined_parts(increments: np.ndarray, segments: tuple[tuple[int, int], ...]) -> np.ndarray:
    """Increments at rest in the axes of t = 0, shape (still, 6): turned by the gyros over each motion."""
    joined = np.zeros((0, 6))
    for i, (first, last) in enumerate(segments):
        part = increments[first:last]
        if i > 0:
            gap = increments[segments[i - 1][1] : first, :3]
            # The Earth's rate goes on during the motion and is no part of it.
            joined = _turned_axes(joined, (gap - part[:, :3].mean(axis=0)).sum(axis=0))
        joined = np.concatenate([joined, part])
    gap = increments[segments[-1][1] :, :3]
    if len(gap):
        joined = _turned_axes(joined, (gap - joined[:, :3].mean(axis=0)).sum(axis=0))
    return joined


def _shifted(
    increments: np.ndarray, time_s: np.ndarray, segments: tuple[tuple[int, int], ...], order: int
) -> np.ndarray:
    """Increments at rest, each part shifted onto the fit of the last one (Zhao 26), shape (still, 6)."""
    fits = [_fit(time_s[first:last], increments[first:last], order) for first, last in segments]
    powers = np.vander(time_s, order + 1, increasing=True)
    return np.concatenate(
        [
            increments[first:last] + powers[first:last] @ (fits[-1] - fit)
            for (first, last), fit in zip(segments, fits, strict=True)
        ]
    )


def _fit(time_s: np.ndarray, values: np.ndarray, order: int) -> np.ndarray:
    """Factors of 1, t, t^2, ... by least squares, shape (order + 1, columns); few samples: a lower order."""
    factors = np.zeros((order + 1, values.shape[1]))
    possible = min(order, len(time_s) - 1)
    scale = max(float(np.abs(time_s).max()), 1.0)
    found = polyfit(time_s / scale, values, possible)
    factors[: possible + 1] = found / scale ** np.arange(possible + 1)[:, None]
    return factors


def _turned_axes(signals: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """Two vectors a row, shape (n, 6), in the axes of a body that has turned by a rotation vector since."""
    angle = float(np.linalg.norm(turn))
    if angle == 0.0:
        return signals.copy()
    axis, c, s = turn / angle, np.cos(angle), np.sin(angle)
    v = signals.reshape(-1, 2, 3)
    out = c * v - s * np.cross(axis, v) + (1.0 - c) * (v @ axis)[..., None] * axis
    return out.reshape(signals.shape)
