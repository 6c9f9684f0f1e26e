"""Motion `profile`: what the vehicle does at given times, and how it changes in between."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Literal, NamedTuple

import numpy as np
from pydantic import Field, model_validator

from navcore.foundation.earth import Earth
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.parameters import bounded, choice, quantity
from navcore.foundation.text import Text
from navcore.foundation.times import EitherUnit
from navcore.foundation.units import DEG
from navcore.motion.course import (
    HALF_SINE,
    RAISED_COSINE,
    SPEED,
    SPEED_CHANGE,
    TRIANGLE,
    PoleReached,
    askable_before_start,
    lay_course,
)
from navcore.motion.fields import (
    FASTEST,
    heading_field,
    pitch_field,
    roll_field,
    speed_kn_field,
    speed_mps_field,
    speed_of,
)
from navcore.motion.filling import sample
from navcore.motion.kinematics import PROFILE, Kinematics
from navcore.motion.seagoing import SeagoingMotion
from navcore.motion.truth import HEADING, PITCH, ROLL, Site, Truth

_SHAPES = {"raised_cosine": RAISED_COSINE, "half_sine": HALF_SINE, "triangle": TRIANGLE}
_Component = Annotated[float, bounded(unit="m/s", ge=-FASTEST, le=FASTEST)]


class Point(EitherUnit):
    """State of a `profile` at one time; a field left out is as at the point before."""

    t_s: float = quantity(
        0.0,
        unit="s",
        ge=0.0,
        le=1e7,
        slider=(0.0, 86400.0),
        label=Text("time"),
        help=Text("Time of the point; the first one is at 0, each later than the one before."),
    )
    speed_mps: float | None = speed_mps_field(
        Text(
            "Speed along the course, negative is astern; 0 at the first point if it names none. "
            "Not together with speed_kn."
        )
    )
    speed_kn: float | None = speed_kn_field(Text("The same in knots."))
    course_deg: float | None = heading_field(
        None,
        Text("Direction of the velocity, clockwise from true north; reached by the shorter way."),
        Text("course"),
    )
    velocity_mps: tuple[_Component, _Component] | None = Field(
        default=None,
        description=Text(
            "Velocity E, N in place of speed and course. At rest the course stays, that of the first "
            "point is that of the point after it."
        ),
        json_schema_extra={"unit": "m/s", "elements": ["E", "N"], "label": "velocity"},
    )
    heading_deg: float | None = heading_field(
        None,
        Text("Heading, reached by the shorter way; only when the bow does not follow the course."),
    )
    pitch_deg: float | None = pitch_field(None)
    roll_deg: float | None = roll_field(None)

    def contradictions(self) -> Iterator[tuple[str, object, str]]:
        """Fields given twice over: name, value, what is allowed."""
        if self.speed_mps is not None and self.speed_kn is not None:
            yield "speed_kn", self.speed_kn, Text("give speed_mps or speed_kn, not both")
        polar = {"speed_mps": self.speed_mps, "speed_kn": self.speed_kn, "course_deg": self.course_deg}
        for name, value in polar.items():
            if self.velocity_mps is not None and value is not None:
                yield name, value, Text("give velocity_mps, or speed and course, not both")
        if self.velocity_mps is not None and math.hypot(*self.velocity_mps) > FASTEST:
            yield (
                "velocity_mps",
                list(self.velocity_mps),
                Text("the speed must be <= {fastest:g} (m/s)", fastest=FASTEST),
            )

    @property
    def speed(self) -> float | None:
        """Speed in m/s, None when the point names none."""
        if self.velocity_mps is not None:
            return math.hypot(*self.velocity_mps)
        return speed_of(self.speed_mps, self.speed_kn)

    @property
    def course(self) -> float | None:
        """Course in rad, None when the point names none or rests."""
        if self.velocity_mps is not None:
            return math.atan2(*self.velocity_mps) if any(self.velocity_mps) else None
        return None if self.course_deg is None else self.course_deg * DEG


class _State(NamedTuple):
    """State at a point: s, m/s, rad; course and heading without wraps."""

    t_s: float
    speed: float
    course: float
    pitch: float
    roll: float
    heading: float


class ProfileMotion(SeagoingMotion):
    """Speed, course and attitude at given times; in between all change together, smoothly.

    From one point to the next every quantity goes over the whole time between them. ``shape`` is the course
    of its rate (of the acceleration, of the turn rate): ``raised_cosine`` (smoothest, as in `legs`),
    ``half_sine`` (the value follows (1 - cos pi tau)/2: Zhao 2015, 5.1) or ``triangle`` (rises and falls
    evenly: Sun 2017, 5.1). The rate is 0 at every point, its peak twice the mean (half_sine: pi/2 times).
    After the last point all stays. A quick change is two points near each other.

    ``pitch_deg``, ``roll_deg`` and ``heading_deg`` hold until a point names others; ``heading_deg`` also is
    the course of a vehicle whose points name none. With ``bow = "course"`` the heading is the course, with
    ``bow = "heading"`` it is that of the points: the vehicle may crab.
    """

    kind: Literal["profile"] = "profile"
    shape: Literal["raised_cosine", "half_sine", "triangle"] = choice(
        "raised_cosine",
        label=Text("acceleration"),
        help=Text(
            "How the rate of every change rises from 0 and falls to 0 between two points: raised_cosine, "
            "half_sine (values follow a cosine) or triangle."
        ),
    )
    bow: Literal["course", "heading"] = choice(
        "course",
        label=Text("bow"),
        help=Text("course: the bow points along the course; heading: where heading_deg says."),
    )
    point: tuple[Point, ...] = Field(
        default=(Point(),),
        max_length=10_000,
        description=Text("The points in their order, [[motion.point]]."),
    )

    @model_validator(mode="after")
    def _possible(self) -> ProfileMotion:
        faults = list(self.faults()) or list(self.sea_faults())
        if faults:
            raise InputError(faults)
        return self

    def faults(self) -> Iterator[Fault]:
        """Yield the faults: times out of order, a quantity given twice over or without effect."""
        if not self.point:
            yield Fault("", "point", None, Text("must hold at least one [[motion.point]]"))
        elif self.point[0].t_s != 0.0:
            yield Fault("", "point.0.t_s", self.point[0].t_s, Text("must be 0: the first point is the start"))
        for number, point in enumerate(self.point):
            if number and point.t_s <= self.point[number - 1].t_s:
                text = Text(
                    "must be > {t_s:g} (s), the time of the point before", t_s=self.point[number - 1].t_s
                )
                yield Fault("", f"point.{number}.t_s", point.t_s, text)
            for name, value, text in point.contradictions():
                yield Fault("", f"point.{number}.{name}", value, text)
            if self.bow == "course" and point.heading_deg is not None:
                text = Text(
                    'has no effect when the bow follows the course: leave it out, or set bow = "heading"'
                )
                yield Fault("", f"point.{number}.heading_deg", point.heading_deg, text)

    def table(self) -> tuple[np.ndarray, np.ndarray]:
        """Legs (m, 8), columns of `navcore.motion.course`, and attitudes (m, 6) of `Kinematics`; m/s, rad."""
        states, shape = list(self._states()), _SHAPES[self.shape]
        legs, attitude = [], []
        for a, b in zip(states, [*states[1:], states[-1]], strict=True):
            span = b.t_s - a.t_s
            legs.append([a.t_s, a.speed, b.speed - a.speed, span, a.course, b.course - a.course, span, shape])
            attitude.append(
                [a.pitch, a.roll, a.heading, b.pitch - a.pitch, b.roll - a.roll, b.heading - a.heading]
            )
        return np.array(legs), np.array(attitude)

    def calm_truth(self, count: int, step_s: float, site: Site, earth: Earth) -> Truth:
        """Return the true motion at ``count`` times 0, step_s, ...; shape (count, 15), or (1, 15) at rest.

        The position is as exact as that of `legs`; heading and longitude are not wrapped.

        Raises
        ------
        InputError
            The course leads beyond 89.5 deg of latitude.
        """
        legs, attitude = self.table()
        if not (legs[:, [SPEED, SPEED_CHANGE]].any() or attitude[:, 3:].any()):
            row = self.rest_row(site)
            row[0, [PITCH, ROLL, HEADING]] = attitude[0, :3]
            return Truth(step_s, row)
        kin = self.calm_kinematics(max(count - 1, 1) * step_s, site, earth)
        return Truth(step_s, sample(kin, count, step_s, earth))

    def changes(self) -> np.ndarray:
        """Return the table of the legs."""
        return self.table()[0]

    def calm_kinematics(self, end_s: float, site: Site, earth: Earth) -> Kinematics:
        """Return legs, position nodes and attitudes; raises `InputError` near a pole, naming the point."""
        legs, attitude = self.table()
        try:
            course = lay_course(legs, end_s, site, earth)
        except PoleReached as reached:
            raise InputError(
                Fault(
                    "",
                    f"point.{reached.leg}",
                    None,
                    Text(
                        "the course from here passes 89.5° of latitude after {time_s:.0f} s: must "
                        "stay within +-89.5°",
                        time_s=reached.time_s,
                    ),
                )
            ) from None
        return Kinematics(
            PROFILE,
            self.rest_row(site)[0],
            legs=askable_before_start(legs),
            nodes=course.nodes,
            attitude=attitude,
        )

    def _states(self) -> Iterator[_State]:
        """State at each point: what it leaves out is as before."""
        speed, pitch, roll, heading = 0.0, self.pitch_deg * DEG, self.roll_deg * DEG, self.heading_deg * DEG
        course = heading
        if self.point[0].velocity_mps is not None and len(self.point) > 1:
            course = heading if self.point[1].course is None else self.point[1].course
        for number, point in enumerate(self.point):
            speed = speed if point.speed is None else point.speed
            pitch = pitch if point.pitch_deg is None else point.pitch_deg * DEG
            roll = roll if point.roll_deg is None else point.roll_deg * DEG
            course = _turned(course, point.course, first=number == 0)
            own = None if point.heading_deg is None else point.heading_deg * DEG
            heading = _turned(heading, own, first=number == 0)
            yield _State(point.t_s, speed, course, pitch, roll, course if self.bow == "course" else heading)


def _turned(angle: float, goal: float | None, first: bool) -> float:
    """Angle after the shorter turn to the goal (starboard when both are equal)."""
    if goal is None or first:
        return angle if goal is None else goal
    difference = goal - angle
    return angle + difference - 2.0 * math.pi * math.ceil(difference / (2.0 * math.pi) - 0.5)
