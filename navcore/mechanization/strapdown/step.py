"""One strapdown step, shared by the single run and the batch: scalars in, scalars out, inlined.

Increments of angle and velocity over one interval advance quaternion, velocity and position (Savage 1998;
Groves 2013, ch. 5). Two-sample coning and sculling with the previous interval, plus the third-order term
(1/6) theta x (theta x dv), make the whole of order 3. Everything that changes slowly (Earth rate, radii,
Coriolis) is taken at the middle of the interval, extrapolated from the previous one: this is of second order
and keeps those terms off the chain quaternion -> velocity -> transport rate -> quaternion, which would
otherwise set the time of a step.

The quaternion turns body to navigation axes. Its *increment* is formed first and added by a compensated sum,
the renormalisation included: a plain product drifts by 1e-7 m/s in three hours at some attitudes.
"""

import math
from typing import NamedTuple

from navcore.foundation.compiled import inlined
from navcore.foundation.earth import EARTH_RATE, SEMI_MAJOR_AXIS, normal_gravity

TWO_SAMPLE = 1.0 / 12.0
"""Weight of the coning and sculling terms with the previous increment (Savage 1998)."""
THIRD_ORDER = 1.0 / 6.0


class Increment(NamedTuple):
    """Output of an IMU over one interval in body axes: angles t (rad) and velocities b (m/s)."""

    tx: float
    ty: float
    tz: float
    bx: float
    by: float
    bz: float


class Constants(NamedTuple):
    """Constants of a step: interval (s), Earth, weights of the compensation terms."""

    dt: float
    e2: float
    g_equator: float
    k_gravity: float
    two_sample: float
    third_order: float


class EarthTerms(NamedTuple):
    """Sine and cosine of a latitude, then value and slope of 1/(N+h), 1/(M+h) (1/m) and sec L."""

    sin: float
    cos: float
    inv_n: float
    inv_n_slope: float
    inv_m: float
    inv_m_slope: float
    sec: float
    sec_slope: float


class Navigation(NamedTuple):
    """Navigation state, which changes with each interval.

    Latitude and longitude (rad) are offsets from the start; q is the quaternion body to navigation axes and z
    its carries; m are the changes of velocity (m/s) and latitude over the last interval.
    """

    d_lat: float
    d_lon: float
    height: float
    v_e: float
    v_n: float
    v_u: float
    q0: float
    q1: float
    q2: float
    q3: float
    z0: float
    z1: float
    z2: float
    z3: float
    m_e: float
    m_n: float
    m_u: float
    m_lat: float


class Held(NamedTuple):
    """Corrections held by law and altimeter: c (m/s; up rad/s), a (m/s^2), a rate of the height (m/s)."""

    c_e: float
    c_n: float
    c_u: float
    a_e: float
    a_n: float
    a_u: float
    height_rate: float


@inlined
def compensated_angle(k12, now, before):
    """Rotation vector of an interval: the angle increment with coning from the previous one (rad)."""
    return (
        now.tx + k12 * (before.ty * now.tz - before.tz * now.ty),
        now.ty + k12 * (before.tz * now.tx - before.tx * now.tz),
        now.tz + k12 * (before.tx * now.ty - before.ty * now.tx),
    )


@inlined
def compensated_velocity(k12, k6, now, before):
    """Velocity increment in the axes at the interval's start: rotation, sculling and third-order term."""
    tx, ty, tz, bx, by, bz = now
    px, py, pz, ex, ey, ez = before
    rx, ry, rz = ty * bz - tz * by, tz * bx - tx * bz, tx * by - ty * bx
    sx = py * bz - pz * by + ey * tz - ez * ty
    sy = pz * bx - px * bz + ez * tx - ex * tz
    sz = px * by - py * bx + ex * ty - ey * tx
    return (
        bx + 0.5 * rx + k12 * sx + k6 * (ty * rz - tz * ry),
        by + 0.5 * ry + k12 * sy + k6 * (tz * rx - tx * rz),
        bz + 0.5 * rz + k12 * sz + k6 * (tx * ry - ty * rx),
    )


@inlined
def turned(q0, q1, q2, q3, x, y, z):
    """Turn a vector by a quaternion."""
    ax, ay, az = 2.0 * (q2 * z - q3 * y), 2.0 * (q3 * x - q1 * z), 2.0 * (q1 * y - q2 * x)
    return (
        x + q0 * ax + (q2 * az - q3 * ay),
        y + q0 * ay + (q3 * ax - q1 * az),
        z + q0 * az + (q1 * ay - q2 * ax),
    )


@inlined
def quaternion_change(q0, q1, q2, q3, ax, ay, az, h1, h2, h3):
    """Change of the quaternion by a body rotation a and half the turn h of the navigation frame, rad."""
    u = 0.25 * (ax * ax + ay * ay + az * az)
    k = 0.5 - u * (1.0 / 12.0 - u * (1.0 / 240.0 - u * (1.0 / 10080.0)))
    b0 = -u * (0.5 - u * (1.0 / 24.0 - u * (1.0 / 720.0)))
    b1, b2, b3 = k * ax, k * ay, k * az
    f0 = q0 * b0 - q1 * b1 - q2 * b2 - q3 * b3
    f1 = q0 * b1 + q1 * b0 + q2 * b3 - q3 * b2
    f2 = q0 * b2 - q1 * b3 + q2 * b0 + q3 * b1
    f3 = q0 * b3 + q1 * b2 - q2 * b1 + q3 * b0
    g0, g1, g2, g3 = q0 + f0, q1 + f1, q2 + f2, q3 + f3
    # norm of q itself, and what (1, h) in place of the exact turn adds to it
    r = 0.5 - 0.5 * (q0 * q0 + q1 * q1 + q2 * q2 + q3 * q3) - 0.5 * (h1 * h1 + h2 * h2 + h3 * h3)
    return (
        f0 - (h1 * g1 + h2 * g2 + h3 * g3) + r * q0,
        f1 + (h1 * g0 + h2 * g3 - h3 * g2) + r * q1,
        f2 + (h2 * g0 + h3 * g1 - h1 * g3) + r * q2,
        f3 + (h3 * g0 + h1 * g2 - h2 * g1) + r * q3,
    )


@inlined
def compensated_sum(total, carry, change):
    """Kahan's sum: new total and carry."""
    y = change - carry
    t = total + y
    return t, (t - total) - y


@inlined
def earth_terms(e2, lat, height):
    """`EarthTerms` of a latitude (rad) and height (m).

    Between two calls the step takes them as linear in the latitude (sine and cosine as quadratic). At
    300 m/s and 1 s between calls this leaves 1e-9 of them.
    """
    s, c = math.sin(lat), math.cos(lat)
    x = 1.0 - e2 * s * s
    n, m = SEMI_MAJOR_AXIS / math.sqrt(x), SEMI_MAJOR_AXIS * (1.0 - e2) / (x * math.sqrt(x))
    stretch = e2 * s * c / x
    inv_n, inv_m, sec = 1.0 / (n + height), 1.0 / (m + height), 1.0 / c
    slope_n, slope_m = -stretch * n * inv_n * inv_n, -3.0 * stretch * m * inv_m * inv_m
    return EarthTerms(s, c, inv_n, slope_n, inv_m, slope_m, sec, s * sec * sec)


@inlined
def strapdown_step(con, now, before, nav, terms, origin, held, altimeter):
    """Advance one interval; return the next `Navigation`.

    Parameters
    ----------
    con : Constants
    now, before : Increment
        Of this interval and the previous one.
    nav : Navigation
    terms, origin : EarthTerms, float
        Earth terms, and the offset of the latitude (rad) at which they were formed.
    held : Held
    altimeter : bool
        Whether the vertical channel runs; height and vertical velocity stay otherwise.
    """
    dt, v_e, v_n, v_u = con.dt, nav.v_e, nav.v_n, nav.v_u
    ux, uy, uz = compensated_velocity(con.two_sample, con.third_order, now, before)
    d_e, d_n, d_u = turned(nav.q0, nav.q1, nav.q2, nav.q3, ux, uy, uz)
    offset = nav.d_lat - origin + 0.5 * nav.m_lat
    sm = terms.sin + offset * (terms.cos - 0.5 * offset * terms.sin)
    cm = terms.cos - offset * (terms.sin + 0.5 * offset * terms.cos)
    inv_n, inv_m = terms.inv_n + offset * terms.inv_n_slope, terms.inv_m + offset * terms.inv_m_slope
    sec = terms.sec + offset * terms.sec_slope
    mid_e, mid_n = v_e + 0.5 * nav.m_e, v_n + 0.5 * nav.m_n
    earth_n, earth_u = EARTH_RATE * cm, EARTH_RATE * sm
    transport_n = mid_e * inv_n
    w_u = earth_u + transport_n * sm * sec
    o_u = w_u + earth_u
    # The platform turns with V* = V_c + c in its level components, with c_U more in azimuth (theory.md 3).
    w_u += held.c_u
    w_e, w_n = -(mid_n + held.c_n) * inv_m, earth_n + (mid_e + held.c_e) * inv_n
    half = 0.5 * dt
    if altimeter:
        o_e, o_n, mid_u = -mid_n * inv_m, 2.0 * earth_n + transport_n, v_u + 0.5 * nav.m_u
        gravity = normal_gravity(con.g_equator, con.k_gravity, con.e2, sm, nav.height)
        n_e = d_e - half * (w_n * d_u - w_u * d_n) - dt * (o_n * mid_u - o_u * mid_n - held.a_e)
        n_n = d_n - half * (w_u * d_e - w_e * d_u) - dt * (o_u * mid_e - o_e * mid_u - held.a_n)
        n_u = d_u - half * (w_e * d_n - w_n * d_e) - dt * (o_e * mid_n - o_n * mid_e + gravity - held.a_u)
        height = nav.height + dt * (0.5 * (v_u + (v_u + n_u)) + held.height_rate)
    else:
        n_e = d_e - half * (w_n * d_u - w_u * d_n) + dt * (o_u * mid_n + held.a_e)
        n_n = d_n - half * (w_u * d_e - w_e * d_u) - dt * (o_u * mid_e - held.a_n)
        n_u, height = 0.0, nav.height
    d_lat = (v_n + 0.5 * n_n) * inv_m * dt
    d_lon = (v_e + 0.5 * n_e) * inv_n * sec * dt
    ax, ay, az = compensated_angle(con.two_sample, now, before)
    f0, f1, f2, f3 = quaternion_change(
        nav.q0, nav.q1, nav.q2, nav.q3, ax, ay, az, -half * w_e, -half * w_n, -half * w_u
    )
    q0, z0 = compensated_sum(nav.q0, nav.z0, f0)
    q1, z1 = compensated_sum(nav.q1, nav.z1, f1)
    q2, z2 = compensated_sum(nav.q2, nav.z2, f2)
    q3, z3 = compensated_sum(nav.q3, nav.z3, f3)
    return Navigation(
        nav.d_lat + d_lat, nav.d_lon + d_lon, height, v_e + n_e, v_n + n_n, v_u + n_u,
        q0, q1, q2, q3, z0, z1, z2, z3, n_e, n_n, n_u, d_lat,
    )  # fmt: skip


@inlined
def increment_at(increments, i):
    """Row i of a chunk of increments (n, 6)."""
    return Increment(
        increments[i, 0], increments[i, 1], increments[i, 2],
        increments[i, 3], increments[i, 4], increments[i, 5],
    )  # fmt: skip
