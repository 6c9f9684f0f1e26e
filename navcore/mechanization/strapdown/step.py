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

from __future__ import annotations

import math

from navcore.compiled import inlined
from navcore.earth import EARTH_RATE, SEMI_MAJOR_AXIS

TWO_SAMPLE = 1.0 / 12.0
"""Weight of the coning and sculling terms with the previous increment (Savage 1998)."""
THIRD_ORDER = 1.0 / 6.0


@inlined
def compensated_angle(k12, tx, ty, tz, px, py, pz):
    """Rotation vector of an interval: the angle increment with coning, previous increment p (rad)."""
    return (
        tx + k12 * (py * tz - pz * ty),
        ty + k12 * (pz * tx - px * tz),
        tz + k12 * (px * ty - py * tx),
    )


@inlined
def compensated_velocity(k12, k6, tx, ty, tz, bx, by, bz, px, py, pz, ex, ey, ez):
    """Velocity increment in the axes at the interval's start: rotation, sculling and third-order term.

    Angles t, velocities b of this interval; p, e of the previous one (rad, m/s).
    """
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
    """Sine and cosine of a latitude (rad), then value and slope of 1/(N+h), 1/(M+h) and sec L.

    Between two calls the step takes them as linear in the latitude (sine and cosine as quadratic). At
    300 m/s and 1 s between calls this leaves 1e-9 of them.
    """
    s, c = math.sin(lat), math.cos(lat)
    x = 1.0 - e2 * s * s
    n, m = SEMI_MAJOR_AXIS / math.sqrt(x), SEMI_MAJOR_AXIS * (1.0 - e2) / (x * math.sqrt(x))
    stretch = e2 * s * c / x
    inv_n, inv_m, sec = 1.0 / (n + height), 1.0 / (m + height), 1.0 / c
    slope_n, slope_m = -stretch * n * inv_n * inv_n, -3.0 * stretch * m * inv_m * inv_m
    return s, c, inv_n, slope_n, inv_m, slope_m, sec, s * sec * sec


@inlined
def strapdown_step(
    dt, e2, g_equator, k_gravity, k12, k6, altimeter,
    tx, ty, tz, bx, by, bz, px, py, pz, ex, ey, ez,
    sin_0, cos_0, n_0, n_1, m_0, m_1, sec_0, sec_1, offset,
    height, v_e, v_n, v_u, q0, q1, q2, q3, z0, z1, z2, z3, m_e, m_n, m_u,
    c_e, c_n, a_e, a_n, a_u,
):  # fmt: skip
    """Advance one interval of dt s.

    Increments t (rad), b (m/s), the previous p, e; `earth_terms` and the offset of the mid-interval
    latitude from theirs; height (m), velocity (m/s), quaternion q with carries z; m: changes of velocity
    over the previous interval. The law's c (m/s, into the transport rate) and a (m/s^2). Returns velocity,
    quaternion, carries and the changes of velocity, latitude and longitude.
    """
    ux, uy, uz = compensated_velocity(k12, k6, tx, ty, tz, bx, by, bz, px, py, pz, ex, ey, ez)
    d_e, d_n, d_u = turned(q0, q1, q2, q3, ux, uy, uz)
    sm, cm = sin_0 + offset * (cos_0 - 0.5 * offset * sin_0), cos_0 - offset * (sin_0 + 0.5 * offset * cos_0)
    inv_n, inv_m, sec = n_0 + offset * n_1, m_0 + offset * m_1, sec_0 + offset * sec_1
    mid_e, mid_n = v_e + 0.5 * m_e, v_n + 0.5 * m_n
    earth_n, earth_u = EARTH_RATE * cm, EARTH_RATE * sm
    transport_n = mid_e * inv_n
    w_u = earth_u + transport_n * sm * sec
    # The platform turns with V* = V_c + c in its level components, physics.md section 3.
    w_e, w_n = -(mid_n + c_n) * inv_m, earth_n + (mid_e + c_e) * inv_n
    o_u = w_u + earth_u
    half = 0.5 * dt
    if altimeter:
        o_e, o_n, mid_u, s2 = -mid_n * inv_m, 2.0 * earth_n + transport_n, v_u + 0.5 * m_u, sm * sm
        surface = g_equator * (1.0 + k_gravity * s2) / math.sqrt(1.0 - e2 * s2)
        gravity = surface * (1.0 - (2.0 / SEMI_MAJOR_AXIS) * height)
        n_e = d_e - half * (w_n * d_u - w_u * d_n) - dt * (o_n * mid_u - o_u * mid_n - a_e)
        n_n = d_n - half * (w_u * d_e - w_e * d_u) - dt * (o_u * mid_e - o_e * mid_u - a_n)
        n_u = d_u - half * (w_e * d_n - w_n * d_e) - dt * (o_e * mid_n - o_n * mid_e + gravity - a_u)
    else:
        n_e = d_e - half * (w_n * d_u - w_u * d_n) + dt * (o_u * mid_n + a_e)
        n_n = d_n - half * (w_u * d_e - w_e * d_u) - dt * (o_u * mid_e - a_n)
        n_u = 0.0
    d_lat = (v_n + 0.5 * n_n) * inv_m * dt
    d_lon = (v_e + 0.5 * n_e) * inv_n * sec * dt
    ax, ay, az = compensated_angle(k12, tx, ty, tz, px, py, pz)
    f0, f1, f2, f3 = quaternion_change(q0, q1, q2, q3, ax, ay, az, -half * w_e, -half * w_n, -half * w_u)
    q0, z0 = compensated_sum(q0, z0, f0)
    q1, z1 = compensated_sum(q1, z1, f1)
    q2, z2 = compensated_sum(q2, z2, f2)
    q3, z3 = compensated_sum(q3, z3, f3)
    return v_e + n_e, v_n + n_n, v_u + n_u, q0, q1, q2, q3, z0, z1, z2, z3, n_e, n_n, n_u, d_lat, d_lon
