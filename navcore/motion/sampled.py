"""A motion given as positions and angles at any time: everything else follows from splines through them.

This is the quickest way to a new motion. A subclass of `SampledMotion` gives `path` and, where something
swings, `shortest_period_s`. Cubic splines of latitude, longitude, height and the three angles join samples
of the path, and these splines *are* the motion: velocity and acceleration are their derivatives, and the
simulated IMU feels them at its own rate. Truth and sensors therefore agree to rounding in every fidelity.
What the samples cost is fidelity to the path that was meant: with n samples a period, the velocity of a
sinusoid is followed to (2 pi/n)^4/180 of its amplitude, 3.4e-6 at the 40 samples taken.
"""

import math
from abc import abstractmethod
from collections.abc import Iterator
from typing import ClassVar

import numpy as np

from navcore.foundation.earth import Earth
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import DEG
from navcore.motion.base import MotionParameters
from navcore.motion.filling import sample
from navcore.motion.kinematics import PIECES, Kinematics
from navcore.motion.pieces import (
    PIECE_HEADING,
    PIECE_HEIGHT,
    PIECE_LAT,
    PIECE_LON,
    PIECE_PITCH,
    PIECE_ROLL,
    shared_pieces,
)
from navcore.motion.static import rest_at
from navcore.motion.truth import COLUMNS, Site, Truth

SAMPLES_A_PERIOD = 40.0
LONGEST_SAMPLE_S = 10.0
MAX_SAMPLES = 2_000_000
"""Samples of a motion: 0.4 GB of splines."""
_BEYOND = 32
"""Samples before t = 0 and after the end: the influence of a spline's end falls by 0.27 a sample."""
_LARGEST_LATITUDE = 89.5 * DEG
_QUANTITIES = (PIECE_LAT, PIECE_LON, PIECE_HEIGHT, PIECE_PITCH, PIECE_ROLL, PIECE_HEADING)


class SampledMotion(MotionParameters):
    """Base of the motions that `path` describes.

    During an alignment before t = 0 the vehicle rests at the attitude of t = 0; a motion that knows better
    overrides `before_start`.
    """

    samples_a_period: ClassVar[float] = SAMPLES_A_PERIOD

    @abstractmethod
    def path(self, t_s: np.ndarray, site: Site, earth: Earth) -> np.ndarray:
        """Return position and attitude at any times, as smooth functions of time.

        Parameters
        ----------
        t_s : ndarray, shape (n,)
            Times, s; a few lie before 0 and after the end of the run.
        site : Site
            Where the motion starts.
        earth : Earth
            WGS-84 or the sphere.

        Returns
        -------
        ndarray, shape (n, 6)
            Latitude, longitude (rad), height (m), pitch, roll, heading (rad); longitude and heading without
            jumps.
        """

    def shortest_period_s(self) -> float:
        """Return the shortest period of what swings, s; inf where nothing does."""
        return math.inf

    def frequencies(self) -> Iterator[tuple[str, float]]:
        """Yield the frequency of the shortest period."""
        if math.isfinite(self.shortest_period_s()):
            yield "kind", 1.0 / self.shortest_period_s()

    def before_start(self, true_row: np.ndarray, duration_s: float) -> MotionParameters:
        """Return rest at the attitude of t = 0."""
        return rest_at(true_row)

    def truth(
        self, count: int, step_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> Truth:
        """Return the motion at ``count`` times 0, step_s, ...; shape (count, 15)."""
        kin = self.kinematics((count - 1) * step_s, site, earth)
        return Truth(step_s, sample(kin, count, step_s, earth))

    def kinematics(
        self, end_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> Kinematics:
        """Return the pieces of the splines."""
        return Kinematics(PIECES, np.zeros(COLUMNS), legs=self._pieces(end_s, site, earth))

    def _pieces(self, end_s: float, site: Site, earth: Earth) -> np.ndarray:
        from scipy.interpolate import CubicSpline

        step = min(LONGEST_SAMPLE_S, self.shortest_period_s() / self.samples_a_period)
        last = math.ceil(end_s / step)
        if last > MAX_SAMPLES:
            allowed = Text(
                "takes {last:.3g} samples in {end_s:g} s: at most {max_samples}; make the run shorter",
                last=last,
                end_s=end_s,
                max_samples=MAX_SAMPLES,
            )
            raise InputError(Fault("", "kind", self.kind, allowed))
        t = np.arange(-_BEYOND, last + _BEYOND + 1) * step
        values = self.path(t, site, earth)
        if not np.isfinite(values).all():
            raise InputError(
                Fault("", "kind", self.kind, Text("gives positions or angles that are not finite"))
            )
        if np.abs(values[:, 0]).max() > _LARGEST_LATITUDE:
            raise InputError(Fault("", "kind", self.kind, Text("must stay within +-89.5° of latitude")))
        spline = CubicSpline(t, values)
        return shared_pieces({column: (t, spline.c[:, :, j]) for j, column in enumerate(_QUANTITIES)}, {})


def displaced(site: Site, earth: Earth, east_m: np.ndarray, north_m: np.ndarray) -> np.ndarray:
    """Return latitude and longitude (rad) of points near the site, shape (n, 2).

    Parameters
    ----------
    site : Site
        Origin.
    earth : Earth
        Gives the radii of curvature at the site, which are taken for all points.
    east_m, north_m : ndarray, shape (n,)
        Distances from the site, m; up to some 10 km.
    """
    meridian, prime_vertical = earth.radii(site.lat)
    lat = site.lat + north_m / (meridian + site.height)
    lon = site.lon + east_m / ((prime_vertical + site.height) * math.cos(site.lat))
    return np.column_stack([lat, lon])
