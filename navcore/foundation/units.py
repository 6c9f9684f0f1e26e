"""Factors to SI of the units that exist at the edges: ``value_si = value * FACTOR``."""

import math

DEG = math.pi / 180.0
ARCMIN = DEG / 60.0
ARCSEC = DEG / 3600.0
MINUTE = 60.0
HOUR = 3600.0
DEG_PER_HOUR = DEG / HOUR
DEG_PER_SQRT_HOUR = DEG / math.sqrt(HOUR)
"""Angular random walk, deg/sqrt(h) -> rad/sqrt(s)."""
KNOT = 1852.0 / 3600.0
NAUTICAL_MILE = 1852.0
STANDARD_GRAVITY = 9.80665
MICRO_G = 1e-6 * STANDARD_GRAVITY
"""Accelerometer bias unit, m/s^2; also velocity random walk ug/sqrt(Hz) -> (m/s^2)/sqrt(Hz)."""
PPM = 1e-6
EARTH_RATE = 7.292115e-5
"""Rotation rate Omega of the Earth, rad/s."""
UNITS = {
    "rad": 1.0,
    "deg": DEG,
    "arcmin": ARCMIN,
    "arcsec": ARCSEC,
    "s": 1.0,
    "min": MINUTE,
    "h": HOUR,
    "m/s": 1.0,
    "kn": KNOT,
    "nmi/h": KNOT,
    "m": 1.0,
    "km": 1000.0,
    "nmi": NAUTICAL_MILE,
    "1/s": 1.0,
    "%": 0.01,
    "": 1.0,
}
"""Sizes of units by name, SI."""
