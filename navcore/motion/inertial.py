"""Signals of perfect gyros and accelerometers along a true motion, and the body's attitude.

omega_ib^b = C_n^b (omega_ie + omega_en) + omega_nb^b, f^b = C_n^b [dV/dt + (2 omega_ie + omega_en) x V - g]
(Titterton & Weston 2004, ch. 3; Groves 2013, ch. 5).
"""

import numpy as np

from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.earth import EARTH_RATE, Earth, meridian_radius, normal_gravity, prime_vertical_radius
from navcore.foundation.trigonometry import sincos
from navcore.motion.truth import (
    AE,
    AN,
    AU,
    HEADING,
    HEADING_RATE,
    HEIGHT,
    LAT,
    PITCH,
    PITCH_RATE,
    ROLL,
    ROLL_RATE,
    VE,
    VN,
    VU,
    Truth,
)


@inlined
def attitude_elements(sp, cp, sr, cr, sh, ch):
    """Nine elements of C_b^n, row by row, from sines and cosines of pitch, roll and heading."""
    return (
        ch * cr + sh * sp * sr,
        sh * cp,
        ch * sr - sh * sp * cr,
        ch * sp * sr - sh * cr,
        ch * cp,
        -sh * sr - ch * sp * cr,
        -cp * sr,
        sp,
        cp * cr,
    )


@inlined
def frame_rates(values, i, e2, sin_lat, cos_lat):
    """Transport rate E, N, U and Earth rate N, U at row i of truth, rad/s."""
    north = values[i, VN] / (meridian_radius(e2, sin_lat) + values[i, HEIGHT])
    east = values[i, VE] / (prime_vertical_radius(e2, sin_lat) + values[i, HEIGHT])
    return -north, east, east * sin_lat / cos_lat, EARTH_RATE * cos_lat, EARTH_RATE * sin_lat


@inlined
def inertial_row(values, i, level, e2, g_equator, k, felt):
    """Write omega_ib^b (rad/s) and f^b (m/s^2) at row i of truth into ``felt[0:6]``; return C_b^n row by row.

    ``level``: a level body pointing north without Earth rate and coupling: only the transport rate of the two
    level channels, the acceleration and gravity remain.
    """
    sin_lat, cos_lat = sincos(values[i, LAT])
    gravity = normal_gravity(g_equator, k, e2, sin_lat, values[i, HEIGHT])
    w_e, w_n, w_u, earth_n, earth_u = frame_rates(values, i, e2, sin_lat, cos_lat)
    if level:
        felt[0], felt[1], felt[2] = w_e, w_n, 0.0
        felt[3], felt[4], felt[5] = values[i, AE], values[i, AN], values[i, AU] + gravity
        return 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0
    i_n, i_u = w_n + earth_n, w_u + earth_u
    c_n, c_u = i_n + earth_n, i_u + earth_u
    v_e, v_n, v_u = values[i, VE], values[i, VN], values[i, VU]
    f_e = values[i, AE] + c_n * v_u - c_u * v_n
    f_n = values[i, AN] + c_u * v_e - w_e * v_u
    f_u = values[i, AU] + w_e * v_n - c_n * v_e + gravity
    sp, cp = sincos(values[i, PITCH])
    sr, cr = sincos(values[i, ROLL])
    sh, ch = sincos(values[i, HEADING])
    c = attitude_elements(sp, cp, sr, cr, sh, ch)
    pitch_rate, heading_rate = values[i, PITCH_RATE], values[i, HEADING_RATE]
    felt[0] = c[0] * w_e + c[3] * i_n + c[6] * i_u + pitch_rate * cr + heading_rate * cp * sr
    felt[1] = c[1] * w_e + c[4] * i_n + c[7] * i_u + values[i, ROLL_RATE] - heading_rate * sp
    felt[2] = c[2] * w_e + c[5] * i_n + c[8] * i_u + pitch_rate * sr - heading_rate * cp * cr
    felt[3] = c[0] * f_e + c[3] * f_n + c[6] * f_u
    felt[4] = c[1] * f_e + c[4] * f_n + c[7] * f_u
    felt[5] = c[2] * f_e + c[5] * f_n + c[8] * f_u
    return c


@kernel
def _fill(values, level, e2, g_equator, k, out):
    felt = np.empty(6)
    for i in range(values.shape[0]):
        inertial_row(values, i, level, e2, g_equator, k, felt)
        for j in range(6):
            out[i, j] = felt[j]


def inertial_signals(truth: Truth, earth: Earth, level_body: bool = False) -> np.ndarray:
    """Perfect gyro and accelerometer readings at the times of the truth.

    Parameters
    ----------
    truth : Truth
        True motion.
    earth : Earth
        WGS-84 or the sphere.
    level_body : bool
        True for the `channel` fidelity: a level body pointing north, no Earth rate, no coupling.

    Returns
    -------
    ndarray, shape (n, 6), or (1, 6) when nothing changes
        omega_ib in body x, y, z (rad/s), specific force in body x, y, z (m/s^2).
    """
    out = np.empty((truth.values.shape[0], 6))
    _fill(truth.values, bool(level_body), earth.e2, earth.g_equator, earth.somigliana_k, out)
    return out
