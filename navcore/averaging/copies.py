"""Which copies of the navigation run, how far each is ahead, and which are averaged for which output.

Zhao 2015, section 3: a copy that is half a period ahead carries the same oscillation with the opposite sign,
so the mean of both has none. The Schuler line of the coupled system is split in two (theory.md sections 1
and 5); a cascade of two half periods, four copies, takes both away.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from navcore.averaging.parameters import Averaging
from navcore.foundation.earth import EARTH_RATE, Earth

HALF_SIDEREAL_DAY = math.pi / EARTH_RATE
"""s."""


@dataclass(frozen=True)
class Copies:
    """The copies and what is made of them.

    Attributes
    ----------
    ahead_s : tuple of float
        How far each copy runs on the forecast before t = 0, s; the first is the main navigation, 0.
    level : tuple of int
        Copies whose mean gives horizontal velocity and tilt.
    slow : tuple of int
        Copies whose mean gives position and heading.
    """

    ahead_s: tuple[float, ...]
    level: tuple[int, ...]
    slow: tuple[int, ...]


def coupled_lines(east: Any, north: Any, up_rate: Any) -> tuple[Any, Any]:
    """Frequencies of the two level channels when the navigation frame turns about the vertical, faster first.

    With one Schuler frequency sqrt(omega_s^2 + w^2) +- |w| (theory.md section 1). The two radii of the
    ellipsoid give each channel its own; then the lines x are the roots of
    (omega_E^2 - x^2)(omega_N^2 - x^2) = (2 w x)^2.

    Parameters
    ----------
    east, north : float or ndarray
        Schuler frequency of each channel alone, rad/s.
    up_rate : float or ndarray
        Rate w of the navigation frame about the vertical in space, rad/s; Omega sin L at rest.
    """
    total = east**2 + north**2 + (2.0 * up_rate) ** 2
    # x1 x2 = omega_E omega_N and x1^2 + x2^2 = total: half sum and half difference without cancellation
    mean, half = (
        0.5 * np.sqrt(total + 2.0 * east * north),
        0.5 * np.sqrt((east - north) ** 2 + (2.0 * up_rate) ** 2),
    )
    return mean + half, mean - half


def split_schuler_lines(lat: float, height: float, earth: Earth) -> tuple[float, float]:
    """Both Schuler lines at rest at a latitude (rad) and height (m), rad/s, the faster first."""
    meridian, prime = earth.radii(lat)
    gravity = earth.gravity(lat, height)
    east, north = math.sqrt(gravity / (prime + height)), math.sqrt(gravity / (meridian + height))
    fast, slow = coupled_lines(east, north, EARTH_RATE * math.sin(lat))
    return float(fast), float(slow)


def copies_of(averaging: Averaging, omega_s: float, lat: float, height: float, earth: Earth) -> Copies:
    """Copies that a method runs.

    ``schuler``: B and C, pi/omega_s ahead; with ``earth`` D too, pi/Omega ahead: velocity and tilt from
    (B + C)/2, position and heading from (B + D)/2 (Zhao 17); without, everything from (B + C)/2.
    ``cascade``: half a period of each split line, alone and together, four copies; with ``earth`` all four
    once more half a sidereal day ahead. Everything from the mean of all.

    Parameters
    ----------
    averaging : Averaging
        Variant, and whether the 24 h line is averaged too.
    omega_s : float
        Schuler frequency of the site, rad/s.
    lat, height : float
        Where the vehicle stands before t = 0, rad, m.
    earth : Earth
        WGS-84 or the sphere.
    """
    if averaging.variant == "schuler":
        half = math.pi / omega_s
        if averaging.earth:
            return Copies((0.0, half, HALF_SIDEREAL_DAY), (0, 1), (0, 2))
        return Copies((0.0, half), (0, 1), (0, 1))
    fast, slow = (math.pi / line for line in split_schuler_lines(lat, height, earth))
    ahead = (0.0, fast, slow, fast + slow)
    if averaging.earth:
        ahead += tuple(HALF_SIDEREAL_DAY + delay for delay in ahead)
    every = tuple(range(len(ahead)))
    return Copies(ahead, every, every)
