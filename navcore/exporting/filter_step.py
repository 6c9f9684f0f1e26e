"""One call of an exported Kalman filter: covariance, gain and estimates at the computed motion. Compiled.

The filter of the run moves along the true motion in half steps; this one along the computed one, from call to
call, with the mean of two calls in the middle.
"""

import math
from typing import Any, NamedTuple

from navcore.exporting.step import SAMPLE
from navcore.foundation.compiled import inlined
from navcore.foundation.earth import EARTH_RATE
from navcore.law.records import E, N
from navcore.mechanization.kalman.filter import (
    fill_transition,
    fill_turn,
    predict,
    sensed_errors,
    update,
)
from navcore.mechanization.trajectory import RateTerms, gravity_and_radii


class FilterCommands(NamedTuple):
    """Outputs of a call: those of a law, then what is to be taken off the navigation at once."""

    v_star_e_mps: float
    v_star_n_mps: float
    feedback_e_mps2: float
    feedback_n_mps2: float
    azimuth_rate_radps: float
    damped: bool
    off_v_e_mps: float
    off_v_n_mps: float
    off_lat_rad: float
    off_lon_rad: float
    off_phi_e_rad: float
    off_phi_n_rad: float
    off_phi_u_rad: float


class Motion(NamedTuple):
    """What the filter knows of the motion: `navcore.exporting.records.MOTION` and `MOTION_STATE`."""

    p: Any
    s: Any


@inlined
def rate_terms(p, lat, v_e, v_n, a_e, a_n):
    """Coefficients of the error model at a latitude, a velocity and an acceleration (theory.md section 2)."""
    gravity, m, n = gravity_and_radii(p.e2, p.g_equator, p.k_gravity, lat, p.height)
    sin_lat, cos_lat = math.sin(lat), math.cos(lat)
    inv_m, inv_n, tan_lat = 1.0 / (m + p.height), 1.0 / (n + p.height), sin_lat / cos_lat
    earth_n, earth_u = EARTH_RATE * cos_lat, EARTH_RATE * sin_lat
    w_e, w_n, w_u = -v_n * inv_m, earth_n + v_e * inv_n, earth_u + v_e * tan_lat * inv_n
    c_n, c_u = w_n + earth_n, w_u + earth_u
    return RateTerms(
        w_e,
        w_n,
        w_u,
        a_e - c_u * v_n,
        a_n + c_u * v_e,
        w_e * v_n - c_n * v_e + gravity,
        inv_m,
        inv_n,
        tan_lat,
        earth_n,
        earth_u,
        v_e,
        v_n,
        0.0,
        v_e * inv_n / (cos_lat * cos_lat),
        1.0 / cos_lat,
    )


@inlined
def _predict(motion, model, f, given, now):
    """Move covariance and estimates from the last call to this one."""
    p, m = motion.p, motion.s
    begin = rate_terms(p, m.lat, m.velocity[E], m.velocity[N], m.acceleration[E], m.acceleration[N])
    middle = rate_terms(
        p,
        0.5 * (m.lat + given.lat_rad),
        0.5 * (m.velocity[E] + given.v_e_mps),
        0.5 * (m.velocity[N] + given.v_n_mps),
        0.5 * (m.acceleration[E] + given.accel_e_mps2),
        0.5 * (m.acceleration[N] + given.accel_n_mps2),
    )
    fill_transition(p.step, begin, middle, now, f)
    predict(model, f)


@inlined
def filter_step(motion, model, f, given):
    """One call: the errors that the filter has found, and the corrections held until the next call."""
    p, m = motion.p, motion.s
    now = rate_terms(p, given.lat_rad, given.v_e_mps, given.v_n_mps, given.accel_e_mps2, given.accel_n_mps2)
    if m.started:
        _predict(motion, model, f, given, now)
    m.started, m.lat = True, given.lat_rad
    m.velocity[E], m.velocity[N] = given.v_e_mps, given.v_n_mps
    m.acceleration[E], m.acceleration[N] = given.accel_e_mps2, given.accel_n_mps2
    fill_turn(p.pitch, p.roll, given.yaw_rad, f.turn)
    damped = given.log_valid == SAMPLE
    if damped:
        d_e, d_n = given.log_e_mps - given.v_e_mps, given.log_n_mps - given.v_n_mps
        update(model, 0, d_e, d_n, given.v_e_mps, given.v_n_mps, f)
    else:
        f.errors[:] = 0.0
    g_e, g_n, g_u, a_e, a_n = sensed_errors(model, f)
    return FilterCommands(
        given.v_e_mps + g_n / now.inv_n,
        given.v_n_mps - g_e / now.inv_m,
        -a_e,
        -a_n,
        g_u,
        damped,
        f.errors[0],
        f.errors[1],
        f.errors[2],
        f.errors[3],
        f.errors[4],
        f.errors[5],
        f.errors[6],
    )
