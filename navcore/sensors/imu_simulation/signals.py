"""From kinematics to perfect increments: rate and force at every sample, then a 4-point quadrature. Compiled.

Column i of a tile holds the time (first + i - 1) dt: one sample before the tile and two after it serve the
quadrature. The increment over one interval is h/24 (-y0 + 13 y1 + 13 y2 - y3), exact for cubics: its error,
11/720 h^5 y'''', is far below that of the mechanization (order 3), which it does not share a line with.
"""

import math

from navcore.foundation.compiled import inlined
from navcore.foundation.earth import EARTH_RATE, meridian_radius, normal_gravity, prime_vertical_radius
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
)
from navcore.sensors.imu_simulation.work import INC, NAV, SIG, TRIG, C, W


@inlined
def fill_navigation(columns, e2, g_equator, k, w):
    """Rate of the navigation frame and specific force in it, from the kinematic rows of a moving vehicle."""
    for i in range(columns):
        sin_lat, cos_lat = sincos(w[LAT * W + i])
        height, v_e, v_n, v_u = w[HEIGHT * W + i], w[VE * W + i], w[VN * W + i], w[VU * W + i]
        north = v_n / (meridian_radius(e2, sin_lat) + height)
        east = v_e / (prime_vertical_radius(e2, sin_lat) + height)
        earth_n, earth_u = EARTH_RATE * cos_lat, EARTH_RATE * sin_lat
        w_e, w_n, w_u = -north, east + earth_n, east * sin_lat / cos_lat + earth_u
        c_n, c_u = w_n + earth_n, w_u + earth_u
        gravity = normal_gravity(g_equator, k, e2, sin_lat, height)
        w[NAV * W + i], w[(NAV + 1) * W + i], w[(NAV + 2) * W + i] = w_e, w_n, w_u
        w[(NAV + 3) * W + i] = w[AE * W + i] + c_n * v_u - c_u * v_n
        w[(NAV + 4) * W + i] = w[AN * W + i] + c_u * v_e - w_e * v_u
        w[(NAV + 5) * W + i] = w[AU * W + i] + w_e * v_n - c_n * v_e + gravity


@inlined
def fill_navigation_at_rest(lat, height, e2, g_equator, k, w):
    """The same at one place, in all columns."""
    sin_lat, cos_lat = math.sin(lat), math.cos(lat)
    gravity = normal_gravity(g_equator, k, e2, sin_lat, height)
    for i in range(W):
        w[NAV * W + i], w[(NAV + 3) * W + i], w[(NAV + 4) * W + i] = 0.0, 0.0, 0.0
        w[(NAV + 1) * W + i], w[(NAV + 2) * W + i] = EARTH_RATE * cos_lat, EARTH_RATE * sin_lat
        w[(NAV + 5) * W + i] = gravity


@inlined
def _fill_trig(angle, row, columns, w):
    # Rows whose number is an argument are not vectorised through the flat array (three times the time).
    angles, sines = w[angle * W : (angle + 1) * W], w[row * W : (row + 1) * W]
    cosines = w[(row + 1) * W : (row + 2) * W]
    for i in range(columns):
        sines[i], cosines[i] = sincos(angles[i])


@inlined
def fill_attitude(columns, w):
    """C_b^n from pitch, roll and heading."""
    _fill_trig(PITCH, TRIG, columns, w)
    _fill_trig(ROLL, TRIG + 2, columns, w)
    _fill_trig(HEADING, TRIG + 4, columns, w)
    for i in range(columns):
        sp, cp, sr = w[TRIG * W + i], w[(TRIG + 1) * W + i], w[(TRIG + 2) * W + i]
        cr, sh, ch = w[(TRIG + 3) * W + i], w[(TRIG + 4) * W + i], w[(TRIG + 5) * W + i]
        w[C * W + i] = ch * cr + sh * sp * sr
        w[(C + 1) * W + i] = sh * cp
        w[(C + 2) * W + i] = ch * sr - sh * sp * cr
        w[(C + 3) * W + i] = ch * sp * sr - sh * cr
        w[(C + 4) * W + i] = ch * cp
        w[(C + 5) * W + i] = -sh * sr - ch * sp * cr
        w[(C + 6) * W + i] = -cp * sr
        w[(C + 7) * W + i] = sp
        w[(C + 8) * W + i] = cp * cr


@inlined
def fill_signals(columns, w):
    """Body rate C_n^b omega_in + omega_nb and specific force C_n^b f."""
    for i in range(columns):
        c0, c1, c2 = w[C * W + i], w[(C + 1) * W + i], w[(C + 2) * W + i]
        c3, c4, c5 = w[(C + 3) * W + i], w[(C + 4) * W + i], w[(C + 5) * W + i]
        c6, c7, c8 = w[(C + 6) * W + i], w[(C + 7) * W + i], w[(C + 8) * W + i]
        w_e, w_n, w_u = w[NAV * W + i], w[(NAV + 1) * W + i], w[(NAV + 2) * W + i]
        f_e, f_n, f_u = w[(NAV + 3) * W + i], w[(NAV + 4) * W + i], w[(NAV + 5) * W + i]
        sr, cr = w[(TRIG + 2) * W + i], w[(TRIG + 3) * W + i]
        pitch_rate, heading_rate = w[PITCH_RATE * W + i], w[HEADING_RATE * W + i]
        w[SIG * W + i] = c0 * w_e + c3 * w_n + c6 * w_u + pitch_rate * cr - heading_rate * c6
        w[(SIG + 1) * W + i] = c1 * w_e + c4 * w_n + c7 * w_u + w[ROLL_RATE * W + i] - heading_rate * c7
        w[(SIG + 2) * W + i] = c2 * w_e + c5 * w_n + c8 * w_u + pitch_rate * sr - heading_rate * c8
        w[(SIG + 3) * W + i] = c0 * f_e + c3 * f_n + c6 * f_u
        w[(SIG + 4) * W + i] = c1 * f_e + c4 * f_n + c7 * f_u
        w[(SIG + 5) * W + i] = c2 * f_e + c5 * f_n + c8 * f_u


@inlined
def _integrate(row, target, samples, h, w):
    y, increments = w[row * W : (row + 1) * W], w[target * W : (target + 1) * W]
    for i in range(samples):
        increments[i] = h * (13.0 * (y[i + 1] + y[i + 2]) - y[i] - y[i + 3])


@inlined
def fill_increments(samples, dt, w):
    """Perfect increments over each interval."""
    h = dt / 24.0
    _integrate(SIG, INC, samples, h, w)
    _integrate(SIG + 1, INC + 1, samples, h, w)
    _integrate(SIG + 2, INC + 2, samples, h, w)
    _integrate(SIG + 3, INC + 3, samples, h, w)
    _integrate(SIG + 4, INC + 4, samples, h, w)
    _integrate(SIG + 5, INC + 5, samples, h, w)
