"""The Earth against published values of WGS-84 (NGA.STND.0036, 2014) and its exact field; trigonometry."""

import math

import numpy as np
import pytest

from navcore.foundation.compiled import kernel
from navcore.foundation.earth import EARTH_RATE, ECCENTRICITY_SQUARED, SEMI_MAJOR_AXIS, SPHERE, WGS84
from navcore.foundation.trigonometry import sincos, sincos_cycles
from navcore.foundation.units import DEG

GM = 3.986004418e14
SEMI_MINOR_AXIS = 6356752.3142
"""NGA.STND.0036, table 3.5."""


def test_derived_constants_are_the_published_ones():
    """NGA.STND.0036, tables 3.1 to 3.6."""
    flattening = 1.0 - math.sqrt(1.0 - ECCENTRICITY_SQUARED)
    assert 1.0 / flattening == pytest.approx(298.257223563, rel=1e-11)
    assert SEMI_MAJOR_AXIS * (1.0 - flattening) == pytest.approx(SEMI_MINOR_AXIS, abs=1e-4)
    assert EARTH_RATE == 7.292115e-5


@pytest.mark.parametrize(
    ("lat_deg", "meridian", "prime_vertical"),
    [
        (0.0, 6335439.3273, 6378137.0),  # a (1 - e^2) and a
        (90.0, 6399593.6258, 6399593.6258),  # the polar radius of curvature, table 3.5
        (45.0, 6367381.8156, 6388838.2901),
    ],
)
def test_radii_of_curvature(lat_deg, meridian, prime_vertical):
    found = WGS84.radii(lat_deg * DEG)
    assert found == pytest.approx((meridian, prime_vertical), abs=1e-3)


@pytest.mark.parametrize(
    ("lat_deg", "gravity"),
    [(0.0, 9.7803253359), (90.0, 9.8321849379)],
)
def test_normal_gravity_on_the_ellipsoid(lat_deg, gravity):
    """Theoretical gravity at the equator and the poles, NGA.STND.0036, table 3.6."""
    assert WGS84.gravity(lat_deg * DEG) == pytest.approx(gravity, abs=2e-10)


def test_the_mean_of_normal_gravity_over_the_ellipsoid():
    """9.7976432223 m/s^2 in NGA.STND.0036, table 3.6; weighted by the area of each zone."""
    lat = np.linspace(-90.0, 90.0, 20_001) * DEG
    area = np.array([np.prod(WGS84.radii(x)) * math.cos(x) for x in lat])
    gravity = np.array([WGS84.gravity(x) for x in lat])
    assert np.average(gravity, weights=area) == pytest.approx(9.7976432223, abs=1e-8)


def exact_gravity(lat: float, height: float) -> float:
    """Normal gravity from the closed formulas in ellipsoidal coordinates (NGA.STND.0036, eq. 4-5 to 4-24)."""
    a, b, n = SEMI_MAJOR_AXIS, SEMI_MINOR_AXIS, WGS84.radii(lat)[1]
    x, z = (n + height) * math.cos(lat), (b * b / (a * a) * n + height) * math.sin(lat)
    focus = math.sqrt(a * a - b * b)
    d = x * x + z * z - focus**2
    u = math.sqrt(0.5 * d * (1.0 + math.sqrt(1.0 + 4.0 * focus**2 * z * z / d**2)))
    beta = math.atan2(z * math.sqrt(u * u + focus**2), u * x)
    w = math.sqrt((u * u + (focus * math.sin(beta)) ** 2) / (u * u + focus**2))

    def q(v: float) -> float:
        return 0.5 * ((1.0 + 3.0 * v * v / focus**2) * math.atan(focus / v) - 3.0 * v / focus)

    slope = 3.0 * (1.0 + u * u / focus**2) * (1.0 - u / focus * math.atan(focus / u)) - 1.0
    turning = EARTH_RATE**2
    radial = (
        -(
            GM / (u * u + focus**2)
            + turning
            * a
            * a
            * focus
            / (u * u + focus**2)
            * slope
            / q(b)
            * (0.5 * math.sin(beta) ** 2 - 1.0 / 6.0)
        )
        / w
        + turning * u * math.cos(beta) ** 2 / w
    )
    lateral = (
        turning * a * a / math.sqrt(u * u + focus**2) * q(u) / q(b) * math.sin(beta) * math.cos(beta) / w
        - turning * math.sqrt(u * u + focus**2) * math.sin(beta) * math.cos(beta) / w
    )
    return math.hypot(radial, lateral)


@pytest.mark.parametrize("lat_deg", [0.0, 20.0, -45.0, 70.0, 89.0])
@pytest.mark.parametrize("height", [-400.0, 0.0, 1000.0, 10_000.0, 20_000.0])
def test_gravity_falls_with_height_as_in_the_exact_field(lat_deg, height):
    """The series of second order is good to 2 ug up to 20 km; to first order it would err by 30 ug there."""
    assert WGS84.gravity(lat_deg * DEG, height) == pytest.approx(
        exact_gravity(lat_deg * DEG, height), abs=2e-5
    )


@pytest.mark.parametrize(("lat_deg", "gradient"), [(0.0, 3.0877e-6), (45.0, 3.0855e-6), (90.0, 3.0834e-6)])
def test_the_free_air_gradient_is_the_published_one(lat_deg, gradient):
    """0.30877 (1 - 0.00142 sin^2 L) mGal/m (Hofmann-Wellenhof and Moritz 2006, eq. 2-216)."""
    lat = lat_deg * DEG
    assert (WGS84.gravity(lat) - WGS84.gravity(lat, 1.0)) == pytest.approx(gradient, rel=2e-4)


def test_the_sphere_attracts_as_a_mass_at_its_centre():
    for height in (-100.0, 5000.0, 20_000.0):
        wanted = 9.80665 * (SEMI_MAJOR_AXIS / (SEMI_MAJOR_AXIS + height)) ** 2
        assert SPHERE.gravity(0.7, height) == pytest.approx(wanted, rel=2e-7)
    assert SPHERE.radii(0.7) == (SEMI_MAJOR_AXIS, SEMI_MAJOR_AXIS)


# ---------------------------------------------------------------- trigonometry


@kernel
def _pairs(x, out):
    for i in range(x.size):
        out[i, 0], out[i, 1] = sincos(x[i])


@kernel
def _cycle_pairs(x, out):
    for i in range(x.size):
        out[i, 0], out[i, 1] = sincos_cycles(x[i])


@pytest.mark.parametrize("reach", [1.0, 100.0, 1e6])
def test_against_the_c_library(reach: float) -> None:
    edges = [k * math.pi / 4 + d for k in range(-9, 10) for d in (-1e-9, 0.0, 1e-9)]
    x = np.concatenate([np.random.default_rng(1).uniform(-reach, reach, 20_000), [reach, -reach], edges])
    out = np.empty((x.size, 2))
    _pairs(x, out)
    assert np.abs(out - np.column_stack([np.sin(x), np.cos(x)])).max() < 4e-16


def test_whole_cycles_leave_no_trace() -> None:
    part = np.array([0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875])
    few, many = np.empty((8, 2)), np.empty((8, 2))
    _cycle_pairs(part, few)
    _cycle_pairs(part - 2.0**40, many)
    assert np.array_equal(few, many)
    assert np.abs(few - np.column_stack([np.sin(2 * np.pi * part), np.cos(2 * np.pi * part)])).max() < 4e-16


def test_what_is_no_number_stays_none() -> None:
    out = np.empty((2, 2))
    _pairs(np.array([math.nan, math.inf]), out)
    assert np.isnan(out).all()
