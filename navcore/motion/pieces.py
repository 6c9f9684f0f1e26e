"""A motion as piecewise cubic polynomials of time: position, height and attitude, compiled.

Every spline is re-expanded on the pieces that all of them share, so that one search serves six quantities.
"""

import numpy as np

from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.earth import SEMI_MAJOR_AXIS
from navcore.foundation.trigonometry import sincos
from navcore.motion.course import leg_at
from navcore.motion.kinematics import WIDTH
from navcore.motion.truth import (
    AE,
    AN,
    AU,
    HEADING,
    HEADING_RATE,
    HEIGHT,
    LAT,
    LON,
    PITCH,
    PITCH_RATE,
    ROLL,
    ROLL_RATE,
    VE,
    VN,
    VU,
)

# Columns of a piece: its start, then four coefficients, constant term first, of each quantity (rad).
START = 0
PIECE_LAT, PIECE_LON, PIECE_HEADING, PIECE_PITCH, PIECE_ROLL, PIECE_HEIGHT = 1, 5, 9, 13, 17, 21
PIECE_COLUMNS = 25


def shared_pieces(
    splines: dict[int, tuple[np.ndarray, np.ndarray]],
    constants: dict[int, float],
    times_s: np.ndarray | None = None,
) -> np.ndarray:
    """Expand splines on the union of their breakpoints.

    Parameters
    ----------
    splines : dict
        First column of a quantity -> breakpoints (n + 1,) in s and coefficients (4, n), highest power first
        (scipy's layout).
    constants : dict
        First column of a quantity that does not change -> its value.
    times_s : ndarray, shape (k,), optional
        Only the pieces in which one of these times lies: few rows of a long recording need few. Default: all.

    Returns
    -------
    ndarray, shape (m, 25)
        The first piece also serves earlier times, the last one later times.
    """
    starts = np.unique(np.concatenate([breaks[:-1] for breaks, _ in splines.values()]))
    if times_s is not None and times_s.size < starts.size:
        starts = starts[np.unique(np.maximum(np.searchsorted(starts, times_s, side="right") - 1, 0))]
    pieces = np.zeros((starts.size, PIECE_COLUMNS))
    pieces[:, START] = starts
    for column, (breaks, coefficients) in splines.items():
        parent = np.clip(np.searchsorted(breaks, starts, side="right") - 1, 0, breaks.size - 2)
        x = starts - breaks[parent]
        cubic, square, linear, constant = coefficients[:, parent]
        pieces[:, column] = constant + x * (linear + x * (square + x * cubic))
        pieces[:, column + 1] = linear + x * (2.0 * square + 3.0 * x * cubic)
        pieces[:, column + 2] = square + 3.0 * x * cubic
        pieces[:, column + 3] = cubic
    for column, value in constants.items():
        pieces[:, column] = value
    return pieces


@inlined
def _value(x, pieces, i, j):
    return pieces[i, j] + x * (pieces[i, j + 1] + x * (pieces[i, j + 2] + x * pieces[i, j + 3]))


@inlined
def _rate(x, pieces, i, j):
    return pieces[i, j + 1] + x * (2.0 * pieces[i, j + 2] + 3.0 * x * pieces[i, j + 3])


@inlined
def _rate_of_rate(x, pieces, i, j):
    return 2.0 * pieces[i, j + 2] + 6.0 * x * pieces[i, j + 3]


@inlined
def path_at(x, pieces, i, height, height_rate, e2):
    """Latitude, longitude (rad), V_E, V_N (m/s) and their derivatives (m/s^2) at x s into piece i.

    Velocity and acceleration are the derivatives of the position on this Earth.
    """
    lat, lon = _value(x, pieces, i, PIECE_LAT), _value(x, pieces, i, PIECE_LON)
    lat_rate, lon_rate = _rate(x, pieces, i, PIECE_LAT), _rate(x, pieces, i, PIECE_LON)
    sin_lat, cos_lat = sincos(lat)
    w = 1.0 - e2 * sin_lat * sin_lat
    prime_vertical = SEMI_MAJOR_AXIS / np.sqrt(w)
    meridian = prime_vertical * (1.0 - e2) / w
    stretch = e2 * sin_lat * cos_lat * lat_rate / w  # d(ln N)/dt; d(ln M)/dt is three times this
    north_arm, east_arm = meridian + height, (prime_vertical + height) * cos_lat
    east_arm_rate = prime_vertical * stretch * cos_lat - (prime_vertical + height) * sin_lat * lat_rate
    a_n = _rate_of_rate(x, pieces, i, PIECE_LAT) * north_arm + 3.0 * lat_rate * meridian * stretch
    a_n += lat_rate * height_rate
    a_e = _rate_of_rate(x, pieces, i, PIECE_LON) * east_arm + lon_rate * east_arm_rate
    a_e += lon_rate * cos_lat * height_rate
    return lat, lon, lon_rate * east_arm, lat_rate * north_arm, a_e, a_n


@kernel
def fill_pieces(t0, dt, pieces, place, e2, columns, samples, w):
    """Fill the buffer ``w`` (`navcore.motion.kinematics.WIDTH`) with such a motion from t0 on.

    ``place[0]`` is the number of the piece reached, for the next call, which begins ``samples`` steps later.
    """
    i = place[0]
    for k in range(columns):
        t = t0 + k * dt
        i = leg_at(t, pieces, i)
        if k == samples - 1:
            place[0] = i
        x = t - pieces[i, START]
        height, v_u = _value(x, pieces, i, PIECE_HEIGHT), _rate(x, pieces, i, PIECE_HEIGHT)
        lat, lon, v_e, v_n, a_e, a_n = path_at(x, pieces, i, height, v_u, e2)
        w[LAT * WIDTH + k], w[LON * WIDTH + k], w[HEIGHT * WIDTH + k] = lat, lon, height
        w[VE * WIDTH + k], w[VN * WIDTH + k], w[VU * WIDTH + k] = v_e, v_n, v_u
        w[AE * WIDTH + k], w[AN * WIDTH + k] = a_e, a_n
        w[AU * WIDTH + k] = _rate_of_rate(x, pieces, i, PIECE_HEIGHT)
        w[HEADING * WIDTH + k] = _value(x, pieces, i, PIECE_HEADING)
        w[PITCH * WIDTH + k] = _value(x, pieces, i, PIECE_PITCH)
        w[ROLL * WIDTH + k] = _value(x, pieces, i, PIECE_ROLL)
        w[HEADING_RATE * WIDTH + k] = _rate(x, pieces, i, PIECE_HEADING)
        w[PITCH_RATE * WIDTH + k] = _rate(x, pieces, i, PIECE_PITCH)
        w[ROLL_RATE * WIDTH + k] = _rate(x, pieces, i, PIECE_ROLL)
