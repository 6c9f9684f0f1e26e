"""Compiled loops of the alignment."""

import math

from navcore.foundation.compiled import kernel
from navcore.foundation.earth import EARTH_RATE
from navcore.mechanization.strapdown.step import (
    THIRD_ORDER,
    TWO_SAMPLE,
    Increment,
    compensated_angle,
    compensated_velocity,
    increment_at,
    quaternion_change,
    turned,
)


@kernel
def coarse_kernel(increments, half, q, sums):
    """Turn the body against the inertial frame of the start; sum the velocity of each half in that frame."""
    before = Increment(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for i in range(increments.shape[0]):
        now = increment_at(increments, i)
        ux, uy, uz = compensated_velocity(TWO_SAMPLE, THIRD_ORDER, now, before)
        d0, d1, d2 = turned(q[0], q[1], q[2], q[3], ux, uy, uz)
        part = 0 if i < half else 1
        sums[part, 0] += d0
        sums[part, 1] += d1
        sums[part, 2] += d2
        ax, ay, az = compensated_angle(TWO_SAMPLE, now, before)
        f0, f1, f2, f3 = quaternion_change(q[0], q[1], q[2], q[3], ax, ay, az, 0.0, 0.0, 0.0)
        q[0] += f0
        q[1] += f1
        q[2] += f2
        q[3] += f3
        before = now


@kernel
def fine_kernel(increments, first, last, dt, lat, m, n, east, north, up, azimuth, q, v, integrals):
    """Compass loop of theory.md 6.1 over samples first..last with V_r = 0; q, v, integrals go on.

    ``east``, ``north``: K1, K2, K3 of the level channels; ``up``: K_U1 ... K_U4 of the azimuth loop, which
    then replaces the north channel's. ``integrals``: P_E, P_N, omega_cU.
    """
    earth_n, earth_u = EARTH_RATE * math.cos(lat), EARTH_RATE * math.sin(lat)
    half = 0.5 * dt
    i = first - 1 if first > 0 else first
    before = increment_at(increments, i)
    for i in range(first, last):
        now = increment_at(increments, i)
        v_e, v_n = v[0], v[1]
        c_n = (1.0 + east[1]) * v_e / n + integrals[0]
        if azimuth:
            c_e, c_u = -(1.0 + up[1]) * v_n / m, integrals[2]
            back_n = up[0] * v_n
        else:
            c_e, c_u = -(1.0 + north[1]) * v_n / m - integrals[1], 0.0
            back_n = north[0] * v_n
        ux, uy, uz = compensated_velocity(TWO_SAMPLE, THIRD_ORDER, now, before)
        d_e, d_n, d_u = turned(q[0], q[1], q[2], q[3], ux, uy, uz)
        w_e, w_n, w_u = c_e, c_n + earth_n, earth_u + c_u
        v[0] = v_e + d_e - half * (w_n * d_u - w_u * d_n) + dt * (2.0 * earth_u * v_n - east[0] * v_e)
        v[1] = v_n + d_n - half * (w_u * d_e - w_e * d_u) - dt * (2.0 * earth_u * v_e + back_n)
        integrals[0] += dt * east[2] * v_e / n
        integrals[1] += dt * north[2] * v_n / m
        if azimuth:
            integrals[2] += dt * (up[2] * v_n / earth_n - up[3] * integrals[2])
        ax, ay, az = compensated_angle(TWO_SAMPLE, now, before)
        f0, f1, f2, f3 = quaternion_change(
            q[0], q[1], q[2], q[3], ax, ay, az, -half * w_e, -half * w_n, -half * w_u
        )
        q[0] += f0
        q[1] += f1
        q[2] += f2
        q[3] += f3
        before = now
