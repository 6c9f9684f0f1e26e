"""Motion `static`: the vehicle rests at any attitude; and the attitude fields that other motions share."""

from __future__ import annotations

from typing import Literal

import numpy as np

from navcore.earth import Earth
from navcore.motion.base import COLUMNS, HEADING, HEIGHT, LAT, LON, PITCH, ROLL, MotionParameters, Site, Truth
from navcore.motion.kinematics import REST, Kinematics
from navcore.parameters import quantity
from navcore.units import DEG


class AttitudeMotion(MotionParameters):
    """Base of the motions that are given a mean (or initial) attitude."""

    pitch_deg: float = quantity(
        0.0,
        unit="deg",
        ge=-89.0,
        le=89.0,
        slider=(-30.0, 30.0),
        label="pitch",
        help="Pitch, bow up positive.",
    )
    roll_deg: float = quantity(
        0.0,
        unit="deg",
        ge=-180.0,
        le=180.0,
        slider=(-30.0, 30.0),
        label="roll",
        help="Roll, starboard down positive.",
    )
    heading_deg: float = quantity(
        0.0, unit="deg", ge=-360.0, le=360.0, slider=(0.0, 360.0), label="heading",
        help="Heading, clockwise from true north.",
    )  # fmt: skip

    def rest_row(self, site: Site) -> np.ndarray:
        """One row of truth at rest at the site with this attitude, shape (1, 15)."""
        row = np.zeros((1, COLUMNS))
        row[0, [LAT, LON, HEIGHT]] = site.lat, site.lon, site.height
        row[0, [PITCH, ROLL, HEADING]] = self.pitch_deg * DEG, self.roll_deg * DEG, self.heading_deg * DEG
        return row


class StaticMotion(AttitudeMotion):
    """The vehicle rests on the Earth at one place and one attitude."""

    kind: Literal["static"] = "static"

    def truth(self, count: int, step_s: float, site: Site, earth: Earth) -> Truth:
        """Return one row that stands for all times, shape (1, 15)."""
        return Truth(step_s, self.rest_row(site))

    def kinematics(
        self, end_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> Kinematics:
        """Return the row at rest."""
        return Kinematics(REST, self.rest_row(site)[0])
