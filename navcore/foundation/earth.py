"""Earth: radii of curvature, gravity, rotation; WGS-84 or the textbook sphere."""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from navcore.foundation.compiled import inlined
from navcore.foundation.units import EARTH_RATE as EARTH_RATE

SEMI_MAJOR_AXIS = 6378137.0
"""WGS-84 equatorial radius, and the radius of the textbook sphere, m."""
ECCENTRICITY_SQUARED = 6.6943799901413e-3
GRAVITY_EQUATOR = 9.7803253359
"""Somigliana normal gravity at the equator, m/s^2."""
SOMIGLIANA_K = 0.00193185265241
CENTRIFUGAL_RATIO = 3.44978650684e-3
"""m = Omega^2 a^2 b/GM of WGS-84 (NGA.STND.0036)."""
SPHERE_GRAVITY = 9.80665

EarthName = Literal["wgs84", "sphere"]


def _meridian_radius(e2, sin_lat):
    """Radius of curvature M in the meridian, m."""
    x = 1.0 - e2 * sin_lat * sin_lat
    return SEMI_MAJOR_AXIS * (1.0 - e2) / (x * math.sqrt(x))


def _prime_vertical_radius(e2, sin_lat):
    """Radius of curvature N in the prime vertical, m."""
    return SEMI_MAJOR_AXIS / math.sqrt(1.0 - e2 * sin_lat * sin_lat)


def _normal_gravity(g_equator, k, e2, sin_lat, height):
    """Somigliana gravity, with height by its series to second order (theory.md 11; NGA.STND.0036), m/s^2.

    g(h) = g (1 - 2 (1 + f + m - 2 f sin^2 L) h/a + 3 h^2/a^2). The sphere has f = 0 and, as it does not turn
    in its gravity, m = 0.
    """
    s2 = sin_lat * sin_lat
    surface = g_equator * (1.0 + k * s2) / math.sqrt(1.0 - e2 * s2)
    flattening = 1.0 - math.sqrt(1.0 - e2)
    centrifugal = CENTRIFUGAL_RATIO if e2 > 0.0 else 0.0
    x = height / SEMI_MAJOR_AXIS
    return surface * (1.0 - 2.0 * (1.0 + flattening + centrifugal - 2.0 * flattening * s2) * x + 3.0 * x * x)


# Plain for a call from Python (compiling takes some 100 ms a process), compiled for the kernels.
meridian_radius = inlined(_meridian_radius)
prime_vertical_radius = inlined(_prime_vertical_radius)
normal_gravity = inlined(_normal_gravity)


@dataclass(frozen=True)
class Earth:
    """Constants that turn the same formulas into WGS-84 or the sphere.

    Attributes
    ----------
    name : str
        ``"wgs84"`` or ``"sphere"``.
    e2 : float
        First eccentricity squared.
    g_equator : float
        Normal gravity at the equator, m/s^2.
    somigliana_k : float
        Somigliana's constant.
    """

    name: EarthName
    e2: float
    g_equator: float
    somigliana_k: float

    def radii(self, lat: float) -> tuple[float, float]:
        """Radii of curvature (M meridian, N prime vertical) at a latitude in rad, m."""
        s = math.sin(lat)
        return float(_meridian_radius(self.e2, s)), float(_prime_vertical_radius(self.e2, s))

    def gravity(self, lat: float, height: float = 0.0) -> float:
        """Gravity at a latitude (rad) and height (m), m/s^2."""
        return float(_normal_gravity(self.g_equator, self.somigliana_k, self.e2, math.sin(lat), height))

    def schuler_frequency(self, lat: float) -> float:
        """omega_s = sqrt(g(L)/a) with a = 6378137 m, rad/s (theory.md 3.6: one for site and networks)."""
        return math.sqrt(self.gravity(lat) / SEMI_MAJOR_AXIS)


WGS84 = Earth("wgs84", ECCENTRICITY_SQUARED, GRAVITY_EQUATOR, SOMIGLIANA_K)
SPHERE = Earth("sphere", 0.0, SPHERE_GRAVITY, 0.0)
EARTHS: dict[str, Earth] = {"wgs84": WGS84, "sphere": SPHERE}


def attitude_matrix(pitch: float, roll: float, heading: float) -> np.ndarray:
    """Body-to-navigation matrix C_b^n = Rz(-heading) Rx(pitch) Ry(roll), shape (3, 3); angles in rad."""
    sp, cp = math.sin(pitch), math.cos(pitch)
    sr, cr = math.sin(roll), math.cos(roll)
    sh, ch = math.sin(heading), math.cos(heading)
    return np.array(
        [
            [ch * cr + sh * sp * sr, sh * cp, ch * sr - sh * sp * cr],
            [-sh * cr + ch * sp * sr, ch * cp, -sh * sr - ch * sp * cr],
            [-cp * sr, sp, cp * cr],
        ]
    )
