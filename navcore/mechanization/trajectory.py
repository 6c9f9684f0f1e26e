"""Coefficients of the linear error model along the true trajectory, each half step."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from navcore.compiled import inlined, kernel
from navcore.earth import EARTH_RATE, Earth, meridian_radius, normal_gravity, prime_vertical_radius
from navcore.motion.base import AE, AN, AU, HEADING, HEIGHT, LAT, VE, VN, VU, Truth

# Columns of Coefficients.half, one row each half step.
W_E, W_N, W_U = 0, 1, 2  # omega_in, rad/s
F_E, F_N, F_U = 3, 4, 5  # specific force, m/s^2
INV_M, INV_N = 6, 7  # 1/(M + h), 1/(N + h), 1/m
TAN_LAT = 8
EARTH_N, EARTH_U = 9, 10  # Earth rate, rad/s
V_E, V_N, V_U = 11, 12, 13  # true velocity as it enters the Coriolis and transport terms, m/s
UP_LAT = 14  # d(transport rate up)/d(latitude), rad/s per rad
SEC_LAT = 15
M, N_COS = 16, 17  # M and N cos L without height: what turns dL, dlambda into metres
COLUMNS = 18

# Columns of Coefficients.law, one row each step.
LAW_V_E, LAW_V_N, LAW_ACCEL, LAW_HEADING = 0, 1, 2, 3


@dataclass(frozen=True)
class Coefficients:
    """What the error model needs to know of the true motion.

    Attributes
    ----------
    half : ndarray, shape (2 n + 1, COLUMNS) or (1, COLUMNS)
        Coefficients each half step; one row when nothing changes.
    law : ndarray, shape (n + 1, 4) or (1, 4)
        True V_E, V_N (m/s), norm of the horizontal acceleration (m/s^2) and heading (rad) each step.
    """

    half: np.ndarray
    law: np.ndarray


@inlined
def gravity_and_radii(e2, g_equator, k, lat, height):
    """Gravity (m/s^2) and the radii M, N (m) at a latitude (rad) and height (m)."""
    s = math.sin(lat)
    return normal_gravity(g_equator, k, e2, s, height), meridian_radius(e2, s), prime_vertical_radius(e2, s)


@kernel
def _fill(values, coupled, e2, g_equator, k, half):
    for i in range(values.shape[0]):
        row, c = values[i], half[i]
        lat, height = row[LAT], row[HEIGHT]
        gravity, m, n = gravity_and_radii(e2, g_equator, k, lat, height)
        sin_lat, cos_lat = math.sin(lat), math.cos(lat)
        inv_m, inv_n, tan_lat = 1.0 / (m + height), 1.0 / (n + height), sin_lat / cos_lat
        v_e, v_n, v_u = coupled * row[VE], coupled * row[VN], coupled * row[VU]
        earth_n, earth_u = coupled * EARTH_RATE * cos_lat, coupled * EARTH_RATE * sin_lat
        transport_u = v_e * tan_lat * inv_n
        w_e, w_n, w_u = -v_n * inv_m, earth_n + v_e * inv_n, earth_u + transport_u
        # Coriolis: (2 omega_ie + omega_en) x V
        c_n, c_u = w_n + earth_n, w_u + earth_u
        c[W_E], c[W_N], c[W_U] = w_e, w_n, w_u
        c[F_E] = coupled * row[AE] + c_n * v_u - c_u * v_n
        c[F_N] = coupled * row[AN] + c_u * v_e - w_e * v_u
        c[F_U] = coupled * row[AU] + w_e * v_n - c_n * v_e + gravity
        c[INV_M], c[INV_N], c[TAN_LAT] = inv_m, inv_n, coupled * tan_lat
        c[EARTH_N], c[EARTH_U] = earth_n, earth_u
        c[V_E], c[V_N], c[V_U] = v_e, v_n, v_u
        c[UP_LAT] = v_e * inv_n / (cos_lat * cos_lat)
        c[SEC_LAT] = 1.0 / cos_lat
        c[M], c[N_COS] = m, n * cos_lat


def coefficients(truth_half: Truth, earth: Earth, coupled: bool) -> Coefficients:
    """Coefficients of the error model along a trajectory (Titterton & Weston ch. 12; Groves ch. 14).

    Parameters
    ----------
    truth_half : Truth
        True motion on the half-step grid, (2 n + 1, 15) or (1, 15).
    earth : Earth
        WGS-84 or the sphere.
    coupled : bool
        False for the `channel` fidelity: no Earth rate, no transport and Coriolis terms, f = (0, 0, g).
    """
    values = truth_half.values
    half = np.empty((values.shape[0], COLUMNS))
    _fill(values, 1.0 if coupled else 0.0, earth.e2, earth.g_equator, earth.somigliana_k, half)
    steps = values[::2]
    law = np.column_stack(
        [steps[:, VE], steps[:, VN], np.hypot(steps[:, AE], steps[:, AN]), steps[:, HEADING]]
    )
    return Coefficients(half, law)
