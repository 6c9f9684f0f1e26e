"""The Earth against published values of WGS-84 (NGA.STND.0036, 2014) and the exact field of the ellipsoid."""

import math

import numpy as np
import pytest

from navcore.foundation.earth import EARTH_RATE, ECCENTRICITY_SQUARED, SEMI_MAJOR_AXIS, SPHERE, WGS84
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
