"""One call of a box beside an INS: the INS's output and the log in, the damped output out. Compiled.

The law drives e, the difference of the damped and the given output, which obeys the error model along the
output (theory.md 22; `navcore.mechanization.outside`).
"""

import math
from typing import Any, NamedTuple

from navcore.exporting.filter_step import rate_terms
from navcore.exporting.step import step
from navcore.foundation.compiled import inlined
from navcore.law.called import Given
from navcore.law.records import E, N
from navcore.mechanization.error_model import Held, runge_kutta
from navcore.mechanization.recorder import Errors


class Output(NamedTuple):
    """Inputs of a call: what the INS gives out, and the log."""

    v_e_mps: float
    v_n_mps: float
    lat_rad: float
    lon_rad: float
    yaw_rad: float
    log_e_mps: float
    log_n_mps: float
    log_valid: int


class Damped(NamedTuple):
    """Outputs of a call: the damped output, and the misalignment that damping has taken off it."""

    v_e_out_mps: float
    v_n_out_mps: float
    lat_out_rad: float
    lon_out_rad: float
    yaw_out_rad: float
    phi_e_rad: float
    phi_n_rad: float
    phi_u_rad: float
    damped: bool


class Box(NamedTuple):
    """Parameters and state of the box: `navcore.exporting.records.BOX` and `BOX_STATE`."""

    p: Any
    s: Any


@inlined
def _held_errors(m):
    return Errors(m.e[0], m.e[1], m.e[2], m.e[3], m.e[4], m.e[5], m.e[6])


@inlined
def _advance(p, m, given):
    """Move e from the last output to this one: a Runge-Kutta step with the correction of the last call."""
    a_e, a_n = (given.v_e_mps - m.velocity[E]) / p.step, (given.v_n_mps - m.velocity[N]) / p.step
    begin = rate_terms(p, m.lat, m.velocity[E], m.velocity[N], a_e, a_n)
    middle = rate_terms(
        p,
        0.5 * (m.lat + given.lat_rad),
        0.5 * (m.velocity[E] + given.v_e_mps),
        0.5 * (m.velocity[N] + given.v_n_mps),
        a_e,
        a_n,
    )
    end = rate_terms(p, given.lat_rad, given.v_e_mps, given.v_n_mps, a_e, a_n)
    held = Held(0.0, 0.0, 0.0, 0.0, 0.0, m.c[0], m.c[1], m.c[2], m.c[3], m.c[4])
    x = runge_kutta(_held_errors(m), p.step, begin, middle, end, held)
    m.e[0], m.e[1], m.e[2], m.e[3] = x.dv_e, x.dv_n, x.d_lat, x.d_lon
    m.e[4], m.e[5], m.e[6] = x.phi_e, x.phi_n, x.phi_u


@inlined
def _asked(law, reading, given, v_e, v_n, lat, yaw, turned):
    """Ask a law at a velocity, latitude and heading; a log in the ship's axes is turned by the heading."""
    log_e, log_n = given.log_e_mps, given.log_n_mps
    if turned:
        sin, cos = math.sin(yaw), math.cos(yaw)
        log_e, log_n = (
            given.log_e_mps * cos + given.log_n_mps * sin,
            given.log_n_mps * cos - given.log_e_mps * sin,
        )
    return step(law, reading, Given(v_e, v_n, lat, log_e, log_n, given.log_valid, yaw, 0.0, 0.0))


@inlined
def outside_step(box, law, reading, own, own_reading, given):
    """One call: e is moved to this output, the law is asked, and the damped output is given."""
    p, m = box.p, box.s
    if m.started:
        _advance(p, m, given)
    m.started, m.lat = True, given.lat_rad
    m.velocity[E], m.velocity[N] = given.v_e_mps, given.v_n_mps
    v_e, v_n = given.v_e_mps + m.e[0], given.v_n_mps + m.e[1]
    lat, yaw = given.lat_rad + m.e[2], given.yaw_rad + m.e[6]
    found = _asked(law, reading, given, v_e, v_n, lat, yaw, p.ship_axes)
    m.c[0], m.c[1] = found.v_star_e_mps - v_e, found.v_star_n_mps - v_n
    m.c[2], m.c[3], m.c[4] = found.feedback_e_mps2, found.feedback_n_mps2, found.azimuth_rate_radps
    if p.own_law:
        off = _asked(
            own, own_reading, given, given.v_e_mps, given.v_n_mps, given.lat_rad, given.yaw_rad, p.ship_axes
        )
        m.c[0] -= off.v_star_e_mps - given.v_e_mps
        m.c[1] -= off.v_star_n_mps - given.v_n_mps
        m.c[2] -= off.feedback_e_mps2
        m.c[3] -= off.feedback_n_mps2
        m.c[4] -= off.azimuth_rate_radps
    return Damped(
        found.v_out_e_mps,
        found.v_out_n_mps,
        lat,
        given.lon_rad + m.e[3],
        yaw,
        m.e[4],
        m.e[5],
        m.e[6],
        found.damped,
    )
