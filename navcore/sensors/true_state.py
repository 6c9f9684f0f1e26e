"""True velocity and heading at any time, from the truth on its grid."""

import numpy as np

from navcore.motion.truth import AE, AN, HEADING, HEADING_RATE, PITCH_RATE, ROLL_RATE, VE, VN, Truth


def horizontal_state(truth: Truth, time_s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Horizontal velocity and heading, between grid points by the cubic through values and derivatives.

    Parameters
    ----------
    truth : Truth
        True motion on its grid.
    time_s : ndarray, shape (m,)
        Times; those outside the grid are taken at its ends.

    Returns
    -------
    velocity : ndarray, shape (m, 2), or (1, 2) for a constant truth
        E, N, m/s.
    heading : ndarray, shape (m,) or (1,)
        rad, not wrapped.
    """
    values = truth.values
    if truth.constant:
        return values[:, [VE, VN]], values[:, HEADING]
    last = values.shape[0] - 1
    place = np.clip(time_s / truth.step_s, 0.0, last)
    nearest = np.rint(place).astype(np.int64)
    if np.all(np.abs(place - nearest) < 1e-6):
        return np.column_stack([values[nearest, VE], values[nearest, VN]]), values[nearest, HEADING]
    left = np.minimum(place.astype(np.int64), last - 1)
    rows, rates = (VE, VN, HEADING), (AE, AN, HEADING_RATE)
    state = _hermite(values, truth.step_s, left, place - left, rows, rates)
    return state[:, :2], state[:, 2]


def horizontal_acceleration(truth: Truth, time_s: np.ndarray) -> np.ndarray:
    """Rate of change of the horizontal velocity, E and N, m/s^2, linear between grid points.

    Shape (m, 2), or (1, 2) for a constant truth; parameters as of `horizontal_state`.
    """
    values = truth.values
    if truth.constant:
        return values[:, [AE, AN]]
    return np.column_stack([_linear(truth, time_s, axis) for axis in (AE, AN)])


def heading_rate(truth: Truth, time_s: np.ndarray) -> np.ndarray:
    """Rate of change of the heading, rad/s, linear between grid points; shape (m,), or (1,) if constant."""
    values = truth.values
    if truth.constant:
        return values[:, HEADING_RATE]
    return _linear(truth, time_s, HEADING_RATE)


def arm_velocity(truth: Truth, time_s: np.ndarray, arm_m: tuple[float, float, float]) -> np.ndarray:
    """Velocity that turning, pitching and rolling give to a place on board, small pitch and roll.

    Parameters
    ----------
    truth, time_s
        As of `horizontal_state`.
    arm_m : tuple of float
        Where the place is: starboard, forward, up, m.

    Returns
    -------
    ndarray, shape (m, 2), or (1, 2) for a constant truth
        Starboard, forward, m/s: w x r in the ship's axes.
    """
    starboard, forward, up = arm_m
    values = truth.values
    columns = (PITCH_RATE, ROLL_RATE, HEADING_RATE)
    pitch, roll, turn = (
        values[:, column] if truth.constant else _linear(truth, time_s, column) for column in columns
    )
    return np.column_stack([roll * up + turn * forward, -turn * starboard - pitch * up])


def _linear(truth: Truth, time_s: np.ndarray, column: int) -> np.ndarray:
    """One column of the truth at times (m,), linear between grid points; shape (m,)."""
    values = truth.values[:, column]
    return np.interp(time_s, truth.step_s * np.arange(values.size), values)


def _hermite(
    values: np.ndarray,
    step_s: float,
    left: np.ndarray,
    fraction: np.ndarray,
    columns: tuple[int, ...],
    derivatives: tuple[int, ...],
) -> np.ndarray:
    u = fraction[:, None]
    rows = left[:, None]
    begin, end = values[rows, columns], values[rows + 1, columns]
    slope_begin, slope_end = values[rows, derivatives] * step_s, values[rows + 1, derivatives] * step_s
    rise = end - begin
    return begin + u * (
        slope_begin
        + u * (3.0 * rise - 2.0 * slope_begin - slope_end + u * (slope_begin + slope_end - 2.0 * rise))
    )


def to_navigation(starboard_forward: np.ndarray, heading: np.ndarray) -> np.ndarray:
    """Turn speeds along the ship's axes to E, N by a heading (rad), level ship; shape (m, 2)."""
    return turned(starboard_forward, np.sin(heading), np.cos(heading))


def turned(starboard_forward: np.ndarray, sine: np.ndarray, cosine: np.ndarray) -> np.ndarray:
    """Turn as `to_navigation`, by the sine and cosine of a heading."""
    starboard, forward = starboard_forward[:, 0], starboard_forward[:, 1]
    return np.column_stack([starboard * cosine + forward * sine, forward * cosine - starboard * sine])


def to_ship(east_north: np.ndarray, heading: np.ndarray) -> np.ndarray:
    """Turn E, N to speeds starboard, forward by a heading (rad), level ship; shape (m, 2)."""
    sine, cosine = np.sin(heading), np.cos(heading)
    east, north = east_north[:, 0], east_north[:, 1]
    return np.column_stack([east * cosine - north * sine, east * sine + north * cosine])
