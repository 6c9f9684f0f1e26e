"""Coefficients of the linear error model along the true trajectory, each half step."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.earth import EARTH_RATE, Earth, meridian_radius, normal_gravity, prime_vertical_radius
from navcore.foundation.records import REAL, record_type
from navcore.mechanization.recorder import axes_along
from navcore.motion.truth import AE, AN, AU, HEADING, HEIGHT, LAT, VE, VN, VU, Truth

HALF_STEP = record_type(
    w_e=REAL, w_n=REAL, w_u=REAL,  # omega_in, rad/s
    f_e=REAL, f_n=REAL, f_u=REAL,  # specific force, m/s^2
    inv_m=REAL, inv_n=REAL,  # 1/(M + h), 1/(N + h), 1/m
    tan_lat=REAL,
    earth_n=REAL, earth_u=REAL,  # Earth rate, rad/s
    v_e=REAL, v_n=REAL, v_u=REAL,  # true velocity as it enters the Coriolis and transport terms, m/s
    up_lat=REAL,  # d(transport rate up)/d(latitude), rad/s per rad
    sec_lat=REAL,
    m=REAL, n_cos=REAL,  # M + h and (N + h) cos L: what turns dL, dlambda into metres
)  # fmt: skip
"""Coefficients at one half step."""
COLUMNS = len(HALF_STEP.names or ())
"""Numbers of a half step's coefficients."""


class RateTerms(NamedTuple):
    """Numbers of a half step that a rate needs (`navcore.mechanization.error_model`), named as there."""

    w_e: float
    w_n: float
    w_u: float
    f_e: float
    f_n: float
    f_u: float
    inv_m: float
    inv_n: float
    tan_lat: float
    earth_n: float
    earth_u: float
    v_e: float
    v_n: float
    v_u: float
    up_lat: float
    sec_lat: float


LAW_INPUT = record_type(
    v_e=REAL, v_n=REAL,  # true velocity, m/s
    heading=REAL,  # rad
)  # fmt: skip
"""True motion at one step, as the law is given it."""


@dataclass(frozen=True)
class Coefficients:
    """Coefficients of the error model along the true motion.

    Attributes
    ----------
    half : ndarray of `HALF_STEP`, shape (2 n + 1,) or (1,)
        Coefficients each half step; one row when nothing changes.
    law : ndarray of `LAW_INPUT`, shape (n + 1,) or (1,)
        What the law is told each step.
    axes : ndarray of `navcore.mechanization.recorder.AXES`, shape (n + 1,) or (1,)
        Of the ship, each step.
    """

    half: np.ndarray
    law: np.ndarray
    axes: np.ndarray


def table_of(half: np.ndarray) -> np.ndarray:
    """View records of `HALF_STEP` as a table (n, COLUMNS), to reckon with whole rows."""
    return half.view(float).reshape(-1, COLUMNS)


def named(table: np.ndarray) -> np.ndarray:
    """View a table (n, COLUMNS) as n records of `HALF_STEP` again."""
    return np.ascontiguousarray(table).view(HALF_STEP)[:, 0]


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
        c.w_e, c.w_n, c.w_u = w_e, w_n, w_u
        c.f_e = coupled * row[AE] + c_n * v_u - c_u * v_n
        c.f_n = coupled * row[AN] + c_u * v_e - w_e * v_u
        c.f_u = coupled * row[AU] + w_e * v_n - c_n * v_e + gravity
        c.inv_m, c.inv_n, c.tan_lat = inv_m, inv_n, coupled * tan_lat
        c.earth_n, c.earth_u = earth_n, earth_u
        c.v_e, c.v_n, c.v_u = v_e, v_n, v_u
        c.up_lat = v_e * inv_n / (cos_lat * cos_lat)
        c.sec_lat = 1.0 / cos_lat
        c.m, c.n_cos = m + height, (n + height) * cos_lat


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
    half = np.empty(values.shape[0], HALF_STEP)
    _fill(values, 1.0 if coupled else 0.0, earth.e2, earth.g_equator, earth.somigliana_k, half)
    steps = values[::2]
    law = np.empty(len(steps), LAW_INPUT)
    law["v_e"], law["v_n"], law["heading"] = steps[:, VE], steps[:, VN], steps[:, HEADING]
    return Coefficients(half, law, axes_along(steps))
