"""Motions of a vessel on a course of its own, which the block ``motion.waves`` puts into a seaway."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterator
from typing import Any, ClassVar

import numpy as np
from pydantic import Field

from navcore.foundation.earth import WGS84, Earth
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.motion.base import MotionParameters
from navcore.motion.course import COURSE_TIME, SPEED, SPEED_CHANGE, SPEED_TIME
from navcore.motion.kinematics import FREQUENCY, Kinematics
from navcore.motion.sampled import SampledMotion
from navcore.motion.sea import motion_along
from navcore.motion.sea_fields import AnswerFields, SeaFields
from navcore.motion.static import AttitudeMotion
from navcore.motion.truth import HEADING, HEIGHT, LAT, LON, PITCH, ROLL, VE, VN, Site, Truth
from navcore.motion.waves import WavesMotion


class Waves(AnswerFields, SeaFields):
    """Seaway in which the vessel runs its course, with the fields of the motion ``waves``.

    Pitch, roll, heading and height of the course are the means, about which the vessel moves; while speed or
    heading change, each wave is met at the frequency of the moment. With ``height_m = 0`` the sea is calm.
    """


class SeagoingMotion(AttitudeMotion):
    """Base of the motions on a course: `calm_truth` and its like give it on a calm sea.

    Attributes
    ----------
    waves : Waves
        The seaway.
    """

    waves: Waves = Field(default=Waves(height_m=0.0), description=Text("The seaway; calm if left out."))

    @abstractmethod
    def calm_truth(self, count: int, step_s: float, site: Site, earth: Earth) -> Truth:
        """Return `truth` without waves and changes of depth."""

    @abstractmethod
    def calm_kinematics(self, end_s: float, site: Site, earth: Earth) -> Kinematics:
        """Return `kinematics` without waves and changes of depth."""

    @abstractmethod
    def changes(self) -> np.ndarray:
        """Return the course as legs with their changes, shape (m, 8), columns of `navcore.motion.course`."""

    def calm_frequencies(self) -> Iterator[tuple[str, float]]:
        """Yield `frequencies` without waves."""
        yield from ()

    def depth_at(self, t_s: np.ndarray) -> np.ndarray:
        """Depth below the height of the site at times (n,), m; shape (n,)."""
        return np.zeros(t_s.size)

    def shortest_dive_s(self) -> float:
        """Return the shortest time of a change of depth, s; inf where there is none."""
        return math.inf

    @property
    def rough(self) -> bool:
        """Whether there are waves."""
        return self.waves.height_m > 0.0

    def head_sea(self) -> WavesMotion:
        """Return the steady course on which the waves are met fastest; not validated."""
        fields = {name: getattr(self.waves, name) for name in Waves.model_fields}
        legs, heading = self.changes(), math.fmod(self.waves.direction_deg, 360.0)
        speed = float(np.abs([legs[:, SPEED], legs[:, SPEED] + legs[:, SPEED_CHANGE]]).max())
        return WavesMotion.model_construct(
            **fields, speed_mps=speed, heading_deg=heading, pitch_deg=self.pitch_deg
        )

    def sea_faults(self) -> Iterator[Fault]:
        """Yield the fault of waves in which the vessel would turn over."""
        try:
            if self.rough:
                self.head_sea().require_upright()
        except InputError as error:
            yield from error.located("", "waves.").faults

    def truth(
        self, count: int, step_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> Truth:
        """Return the true motion at ``count`` times 0, step_s, ...; shape (count, 15), or (1, 15) at rest.

        Raises
        ------
        InputError
            The course leads beyond 89.5 deg of latitude, or the waves are too short for the step.
        """
        if self.rough:
            try:
                self.head_sea().check_step(step_s)
            except InputError as error:
                raise error.located("", "waves.") from None
        return Truth(step_s, self.rows(count, step_s, site, earth))

    def rows(
        self, count: int, step_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> np.ndarray:
        """Rows of truth at 0, step_s, ..., however long the step."""
        of = Voyage(motion=self, kind=self.kind) if self.rough or self.dives else None
        return (of.truth if of else self.calm_truth)(count, step_s, site, earth).values

    def kinematics(
        self, end_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> Kinematics:
        """Return the course, or splines through it in waves and where the depth changes."""
        of = Voyage(motion=self, kind=self.kind) if self.rough or self.dives else None
        return (of.kinematics if of else self.calm_kinematics)(end_s, site, earth)

    def frequencies(self) -> Iterator[tuple[str, float]]:
        """Yield those of the course, and that of the shortest wave in a head sea."""
        yield from self.calm_frequencies()
        if self.rough:
            yield "waves.peak_period_s", float(self.head_sea().packed()[:, FREQUENCY].max())

    def before_start(self, true_row: np.ndarray, duration_s: float) -> MotionParameters:
        """Return rest at the attitude of t = 0; in waves, the vessel stopped in the same sea."""
        if not self.rough:
            return super().before_start(true_row, duration_s)
        calm = self.calm_truth(1, 1.0, Site(*true_row[[LAT, LON, HEIGHT]]), WGS84).values[0]
        angles = {"pitch_deg": PITCH, "roll_deg": ROLL, "heading_deg": HEADING}
        means = {name: math.remainder(math.degrees(calm[column]), 360.0) for name, column in angles.items()}
        return self.head_sea().model_copy(update={"speed_mps": 0.0, **means})


class Voyage(SampledMotion):
    """A course in waves and through depths, as splines.

    Attributes
    ----------
    motion : SeagoingMotion
        The course.
    """

    samples_a_period: ClassVar[float] = 16.0
    kind: Any
    motion: SeagoingMotion

    def shortest_period_s(self) -> float:
        """Return the shortest period of waves and changes, s."""
        times = self.motion.changes()[:, [SPEED_TIME, COURSE_TIME]]
        waves = [1.0 / frequency for _, frequency in self.motion.frequencies()]
        return min([self.motion.shortest_dive_s(), *times[times > 0.0], *waves])

    def path(self, t_s: np.ndarray, site: Site, earth: Earth) -> np.ndarray:
        """Return the course's position and attitude with what the sea adds; steady before t = 0."""
        motion, step_s = self.motion, t_s[1] - t_s[0]
        later = t_s >= -1e-9
        rows = motion.calm_truth(int(later.sum()), step_s, site, earth).values
        rows = np.broadcast_to(rows, (int(later.sum()), rows.shape[1]))
        values = np.empty((t_s.size, 6))
        values[later] = rows[:, [LAT, LON, HEIGHT, PITCH, ROLL, HEADING]]
        velocity = np.empty((t_s.size, 2))
        velocity[later], velocity[~later] = rows[:, [VE, VN]], rows[0, [VE, VN]]
        meridian, prime_vertical = earth.radii(site.lat)
        rates = np.zeros(6)
        rates[0] = rows[0, VN] / (meridian + site.height)
        rates[1] = rows[0, VE] / ((prime_vertical + site.height) * math.cos(site.lat))
        values[~later] = values[later][0] + t_s[~later, None] * rates
        depth = motion.depth_at(t_s)
        values[:, 2] -= depth
        if motion.rough:
            steps = 0.5 * step_s * (velocity[1:] + velocity[:-1])
            moved = np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])
            moved -= moved[np.argmax(later)]
            sea, answers = motion.waves.seaway(), motion.waves.answers()
            swing = motion_along(sea, t_s, moved, velocity, values[:, 5].copy(), depth, answers)
            values[:, [3, 4, 5, 2]] += swing
        return values
