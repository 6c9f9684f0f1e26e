"""Design of the compass loop of an alignment (theory.md 6.1): its numbers, gains and where it works."""

from dataclasses import dataclass

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import DEG

LARGEST_LATITUDE_DEG = 85.0
"""Beyond, the horizontal Earth rate is too small to find north."""

SHORTEST_COARSE_S = 30.0
"""Least length of a coarse alignment, s: gravity turns by 7.5' cos L with the Earth."""


@dataclass(frozen=True)
class CompassLoop:
    """Design of the fine alignment.

    Attributes
    ----------
    level_s : float
        Length of the first part, level channels only, s.
    level_sigma : float
        Decay rate of the level loops in the first part, 1/s.
    sigma, xi : float
        Of level and azimuth loops in the second part.
    """

    level_s: float = 120.0
    level_sigma: float = 0.03
    sigma: float = 0.02
    xi: float = 0.707


def check_latitude(lat: float) -> None:
    """Refuse a latitude (rad) at which the compass loop finds no north.

    Raises
    ------
    InputError
        |latitude| above 85 deg.
    """
    if abs(lat) > LARGEST_LATITUDE_DEG * DEG:
        raise InputError(
            Fault(
                "",
                "site.lat_deg",
                round(lat / DEG, 6),
                Text(
                    "compass alignment needs |latitude| <= {largest_latitude_deg:g}°: the "
                    "horizontal Earth rate, by which it finds north, is too small beyond",
                    largest_latitude_deg=LARGEST_LATITUDE_DEG,
                ),
            )
        )
