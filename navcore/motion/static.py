"""Motion `static`: the vehicle rests at any attitude; and the attitude fields that other motions share."""

import math
from typing import ClassVar, Literal

import numpy as np

from navcore.foundation.earth import Earth
from navcore.foundation.text import Text
from navcore.foundation.units import DEG
from navcore.motion.base import MotionParameters
from navcore.motion.fields import heading_field, pitch_field, roll_field
from navcore.motion.kinematics import REST, Kinematics
from navcore.motion.truth import COLUMNS, HEADING, HEIGHT, LAT, LON, PITCH, ROLL, Site, Truth


class AttitudeMotion(MotionParameters):
    """Base of the motions that are given a mean (or initial) attitude."""

    pitch_deg: float = pitch_field(0.0)
    roll_deg: float = roll_field(0.0)
    heading_deg: float = heading_field(0.0, Text("Heading, clockwise from true north."))

    def rest_row(self, site: Site) -> np.ndarray:
        """One row of truth at rest at the site with this attitude, shape (1, 15)."""
        row = np.zeros((1, COLUMNS))
        row[0, [LAT, LON, HEIGHT]] = site.lat, site.lon, site.height
        row[0, [PITCH, ROLL, HEADING]] = self.pitch_deg * DEG, self.roll_deg * DEG, self.heading_deg * DEG
        return row

    def before_start(self, true_row: np.ndarray, duration_s: float) -> MotionParameters:
        """Return rest at the attitude of t = 0."""
        return rest_at(true_row)


class StaticMotion(AttitudeMotion):
    """The vehicle rests on the Earth at one place and one attitude."""

    carries_recorded_imu: ClassVar[bool] = True
    kind: Literal["static"] = "static"

    def truth(
        self, count: int, step_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> Truth:
        """Return one row that stands for all times, shape (1, 15)."""
        return Truth(step_s, self.rest_row(site))

    def kinematics(
        self, end_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> Kinematics:
        """Return the row at rest."""
        return Kinematics(REST, self.rest_row(site)[0])


def rest_at(true_row: np.ndarray) -> StaticMotion:
    """Return the motion that rests at the attitude of a row of truth, shape (15,)."""
    return StaticMotion(
        pitch_deg=true_row[PITCH] / DEG,
        roll_deg=math.remainder(true_row[ROLL] / DEG, 360.0),
        heading_deg=math.fmod(true_row[HEADING] / DEG, 360.0),
    )
