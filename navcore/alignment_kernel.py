"""Compiled loops of the alignment."""

from __future__ import annotations

import math

from navcore.compiled import kernel
from navcore.earth import EARTH_RATE
from navcore.mechanization.strapdown.step import (
    THIRD_ORDER,
    TWO_SAMPLE,
    compensated_angle,
    compensated_velocity,
    quaternion_change,
    turned,
)


@kernel
def coarse_kernel(increments, half, q, sums):
    """Turn the body against the inertial frame of the start; sum the velocity of each half in that frame."""
    px = py = pz = ex = ey = ez = 0.0
    for i in range(increments.shape[0]):
        tx, ty, tz = increments[i, 0], increments[i, 1], increments[i, 2]
        bx, by, bz = increments[i, 3], increments[i, 4], increments[i, 5]
        ux, uy, uz = compensated_velocity(
            TWO_SAMPLE, THIRD_ORDER, tx, ty, tz, bx, by, bz, px, py, pz, ex, ey, ez
        )
        d0, d1, d2 = turned(q[0], q[1], q[2], q[3], ux, uy, uz)
        part = 0 if i < half else 1
        sums[part, 0] += d0
        sums[part, 1] += d1
        sums[part, 2] += d2
        ax, ay, az = compensated_angle(TWO_SAMPLE, tx, ty, tz, px, py, pz)
        f0, f1, f2, f3 = quaternion_change(q[0], q[1], q[2], q[3], ax, ay, az, 0.0, 0.0, 0.0)
        q[0] += f0
        q[1] += f1
        q[2] += f2
        q[3] += f3
        px, py, pz, ex, ey, ez = tx, ty, tz, bx, by, bz


@kernel
def fine_kernel(increments, first, last, dt, lat, m, n, east, north, up, azimuth, q, v, integrals):
    """Compass loop of physics.md 6.1 over samples first..last with V_r = 0; q, v, integrals go on.

    ``east``, ``north``: K1, K2, K3 of the level channels; ``up``: K_U1 ... K_U4 of the azimuth loop, which
    then replaces the north channel's. ``integrals``: P_E, P_N, omega_cU.
    """
    earth_n, earth_u = EARTH_RATE * math.cos(lat), EARTH_RATE * math.sin(lat)
    half = 0.5 * dt
    i = first - 1 if first > 0 else first
    px, py, pz = increments[i, 0], increments[i, 1], increments[i, 2]
    ex, ey, ez = increments[i, 3], increments[i, 4], increments[i, 5]
    for i in range(first, last):
        tx, ty, tz = increments[i, 0], increments[i, 1], increments[i, 2]
        bx, by, bz = increments[i, 3], increments[i, 4], increments[i, 5]
        v_e, v_n = v[0], v[1]
        c_n = (1.0 + east[1]) * v_e / n + integrals[0]
        if azimuth:
            c_e, c_u = -(1.0 + up[1]) * v_n / m, integrals[2]
            back_n = up[0] * v_n
        else:
            c_e, c_u = -(1.0 + north[1]) * v_n / m - integrals[1], 0.0
            back_n = north[0] * v_n
        ux, uy, uz = compensated_velocity(
            TWO_SAMPLE, THIRD_ORDER, tx, ty, tz, bx, by, bz, px, py, pz, ex, ey, ez
        )
        d_e, d_n, d_u = turned(q[0], q[1], q[2], q[3], ux, uy, uz)
        w_e, w_n, w_u = c_e, c_n + earth_n, earth_u + c_u
        v[0] = v_e + d_e - half * (w_n * d_u - w_u * d_n) + dt * (2.0 * earth_u * v_n - east[0] * v_e)
        v[1] = v_n + d_n - half * (w_u * d_e - w_e * d_u) - dt * (2.0 * earth_u * v_e + back_n)
        integrals[0] += dt * east[2] * v_e / n
        integrals[1] += dt * north[2] * v_n / m
        if azimuth:
            integrals[2] += dt * (up[2] * v_n / earth_n - up[3] * integrals[2])
        ax, ay, az = compensated_angle(TWO_SAMPLE, tx, ty, tz, px, py, pz)
        f0, f1, f2, f3 = quaternion_change(
            q[0], q[1], q[2], q[3], ax, ay, az, -half * w_e, -half * w_n, -half * w_u
        )
        q[0] += f0
        q[1] += f1
        q[2] += f2
        q[3] += f3
        px, py, pz, ex, ey, ez = tx, ty, tz, bx, by, bz
