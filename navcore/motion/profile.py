"""Motion `profile`: what the vehicle does at given times, and how it changes in between."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Literal, NamedTuple

import numpy as np
from pydantic import Field, model_validator

from navcore.foundation.compiled import kernel
from navcore.foundation.earth import Earth
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.parameters import bounded, choice, quantity
from navcore.foundation.text import Text
from navcore.foundation.times import EitherUnit
from navcore.foundation.trigonometry import sincos
from navcore.foundation.units import DEG, KNOT
from navcore.motion.course import (
    COURSE,
    COURSE_CHANGE,
    HALF_SINE,
    RAISED_COSINE,
    SHAPE,
    SPEED,
    SPEED_CHANGE,
    SPEED_TIME,
    START,
    TRIANGLE,
    PoleReached,
    askable_before_start,
    lay_course,
    leg_at,
    node_at,
    position_at,
    smooth_change,
)
from navcore.motion.kinematics import PROFILE, WIDTH, Kinematics, write_rows
from navcore.motion.leg import FASTEST, SLOWEST
from navcore.motion.seagoing import SeagoingMotion
from navcore.motion.truth import (
    AE,
    AN,
    COLUMNS,
    HEADING,
    HEADING_RATE,
    LAT,
    LON,
    PITCH,
    PITCH_RATE,
    ROLL,
    ROLL_RATE,
    VE,
    VN,
    Site,
    Truth,
)

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
    speed_mps: float | None = quantity(
        None,
        unit="m/s",
        ge=SLOWEST,
        le=FASTEST,
        slider=(0.0, 20.0),
        label=Text("speed"),
        help=Text(
            "Speed along the course, negative is astern; 0 at the first point if it names none. "
            "Not together with speed_kn."
        ),
    )
    speed_kn: float | None = quantity(
        None,
        unit="kn",
        ge=-97.0,
        le=970.0,
        slider=(0.0, 40.0),
        label=Text("speed"),
        help=Text("The same in knots."),
    )
    course_deg: float | None = quantity(
        None,
        unit="deg",
        ge=-360.0,
        le=360.0,
        slider=(0.0, 360.0),
        label=Text("course"),
        help=Text("Direction of the velocity, clockwise from true north; reached by the shorter way."),
    )
    velocity_mps: tuple[_Component, _Component] | None = Field(
        default=None,
        description=Text(
            "Velocity E, N in place of speed and course. At rest the course stays, that of the first "
            "point is that of the point after it."
        ),
        json_schema_extra={"unit": "m/s", "elements": ["E", "N"], "label": "velocity"},
    )
    heading_deg: float | None = quantity(
        None,
        unit="deg",
        ge=-360.0,
        le=360.0,
        slider=(0.0, 360.0),
        label=Text("heading"),
        help=Text("Heading, reached by the shorter way; only when the bow does not follow the course."),
    )
    pitch_deg: float | None = quantity(
        None,
        unit="deg",
        ge=-89.0,
        le=89.0,
        slider=(-30.0, 30.0),
        label=Text("pitch"),
        help=Text("Pitch, bow up positive."),
    )
    roll_deg: float | None = quantity(
        None,
        unit="deg",
        ge=-180.0,
        le=180.0,
        slider=(-30.0, 30.0),
        label=Text("roll"),
        help=Text("Roll, starboard down positive."),
    )

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
        return self.speed_kn * KNOT if self.speed_kn is not None else self.speed_mps

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
        values = np.empty((count, COLUMNS))
        _sample(kin.rest, kin.legs, kin.nodes, kin.attitude, float(step_s), values)
        return Truth(step_s, values)

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


@kernel
def fill_profile(t0, dt, legs, nodes, attitude, place, columns, samples, w):
    """Fill the buffer ``w`` (`navcore.motion.kinematics.WIDTH`) with a profile from t0 on.

    ``place`` holds the numbers of leg and node reached, for the next call, which begins ``samples`` steps
    later. Height and vertical motion stay as they are.
    """
    leg, node = place[0], place[1]
    for i in range(columns):
        t = t0 + i * dt
        leg, node = leg_at(t, legs, leg), node_at(t, nodes, node)
        if i == samples - 1:
            place[0], place[1] = leg, node
        w[LAT * WIDTH + i], w[LON * WIDTH + i] = position_at(t, nodes, node)
        done, rate = smooth_change(t - legs[leg, START], legs[leg, SPEED_TIME], 1.0, legs[leg, SHAPE])
        speed, acceleration = (
            legs[leg, SPEED] + done * legs[leg, SPEED_CHANGE],
            rate * legs[leg, SPEED_CHANGE],
        )
        across = speed * rate * legs[leg, COURSE_CHANGE]
        s, c = sincos(legs[leg, COURSE] + done * legs[leg, COURSE_CHANGE])
        w[VE * WIDTH + i], w[VN * WIDTH + i] = speed * s, speed * c
        w[AE * WIDTH + i], w[AN * WIDTH + i] = acceleration * s + across * c, acceleration * c - across * s
        w[PITCH * WIDTH + i] = attitude[leg, 0] + done * attitude[leg, 3]
        w[ROLL * WIDTH + i] = attitude[leg, 1] + done * attitude[leg, 4]
        w[HEADING * WIDTH + i] = attitude[leg, 2] + done * attitude[leg, 5]
        w[PITCH_RATE * WIDTH + i] = rate * attitude[leg, 3]
        w[ROLL_RATE * WIDTH + i] = rate * attitude[leg, 4]
        w[HEADING_RATE * WIDTH + i] = rate * attitude[leg, 5]


@kernel
def _sample(rest, legs, nodes, attitude, step, out):
    w, place = np.repeat(rest, WIDTH), np.zeros(2, np.int64)
    for first in range(0, out.shape[0], WIDTH):
        rows = min(WIDTH, out.shape[0] - first)
        fill_profile(first * step, step, legs, nodes, attitude, place, rows, rows, w)
        write_rows(first, rows, w, out)
