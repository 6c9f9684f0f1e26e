"""Motion `legs`: straight runs, turns and changes of speed, one after the other, with smooth changes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Literal, NamedTuple

import numpy as np
from pydantic import Field, model_validator

from navcore.foundation.earth import Earth
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.parameters import quantity
from navcore.foundation.text import Text
from navcore.foundation.times import EitherUnit
from navcore.foundation.units import DEG, HOUR, KNOT
from navcore.motion.course import (
    COURSE,
    COURSE_CHANGE,
    COURSE_TIME,
    RAISED_COSINE,
    SPEED,
    SPEED_CHANGE,
    SPEED_TIME,
    START,
    Course,
    PoleReached,
    askable_before_start,
    lay_course,
    sample_course,
)
from navcore.motion.kinematics import COURSE as BY_COURSE
from navcore.motion.kinematics import Kinematics
from navcore.motion.static import AttitudeMotion
from navcore.motion.truth import Site, Truth

DEFAULT_ACCELERATION = 0.1
"""Mean acceleration of a change of speed when none is given, m/s^2."""
DEFAULT_TURN_RATE_DPS = 1.0
"""Mean turn rate of a change of heading when none is given, deg/s."""
SLOWEST, FASTEST = -50.0, 500.0
"""Range of speeds, m/s; negative is astern."""
_SAME_HEADING_DEG = 1e-6


class Leg(EitherUnit):
    """One leg of a `legs` motion; a field left out changes nothing."""

    duration_s: float = quantity(
        3600.0,
        unit="s",
        gt=0.0,
        le=1e7,
        slider=(60.0, 36000.0),
        log=True,
        label="duration",
        help="Length of the leg; a change must end within it.",
    )
    speed_mps: float | None = quantity(
        None,
        unit="m/s",
        ge=SLOWEST,
        le=FASTEST,
        slider=(0.0, 20.0),
        label="speed",
        help="First leg: the initial speed. Later legs: the speed to reach, at accel_mps2 (mean), else at a "
        "mean of 0.1 m/s². Negative is astern. Not together with speed_kn.",
    )
    speed_kn: float | None = quantity(
        None,
        unit="kn",
        ge=-97.0,
        le=970.0,
        slider=(0.0, 40.0),
        label="speed",
        help="The same in knots. Not together with speed_mps.",
    )
    accel_mps2: float | None = quantity(
        None,
        unit="m/s2",
        ge=-20.0,
        le=20.0,
        slider=(-0.5, 0.5),
        label="acceleration",
        help="With a speed to reach: the size of the mean acceleration. Alone, or in the first leg: the mean "
        "acceleration over the whole leg. It rises and falls as a raised cosine, its peak is twice the mean.",
    )
    turn_dps: float | None = quantity(
        None,
        unit="deg/s",
        ge=-60.0,
        le=60.0,
        slider=(-3.0, 3.0),
        label="turn rate",
        help="With a heading to reach: the mean turn rate, whose sign chooses the side. Alone, or in the "
        "first leg: the mean turn rate over the whole leg, starboard positive. Its peak is twice the mean.",
    )
    heading_deg: float | None = quantity(
        None,
        unit="deg",
        ge=-360.0,
        le=360.0,
        slider=(0.0, 360.0),
        label="heading",
        help="First leg: the initial heading, in place of that of the motion. Later legs: the heading to "
        "reach, at turn_dps (mean) if given, else by the shorter way at a mean of 1 °/s.",
    )

    @property
    def speed(self) -> float | None:
        """Speed in m/s, None when the leg names none."""
        return self.speed_kn * KNOT if self.speed_kn is not None else self.speed_mps

    @property
    def speed_field(self) -> str:
        """Name of the field that the speed came from."""
        return "speed_kn" if self.speed_kn is not None else "speed_mps"


class _Change(NamedTuple):
    """Change of speed (m/s) or heading (rad), the time it takes (s), and what is wrong with it."""

    amount: float
    time_s: float
    fault: tuple[str, object, str] | None = None


class LegsMotion(AttitudeMotion):
    """Legs one after the other; pitch and roll are constant, the vehicle moves along its heading.

    The speed of the first leg is the initial speed (0 if it names none), its heading the initial heading
    (else ``heading_deg`` of the motion). In later legs a speed or heading is what the leg reaches, from its
    start on: speed at the mean acceleration ``accel_mps2`` (its size; default 0.1 m/s^2), heading by the
    shorter way at 1 deg/s (mean), or at ``turn_dps``, whose sign then chooses the side. ``accel_mps2`` or
    ``turn_dps`` without a speed or heading to reach acts over the whole leg. A change that does not end
    within its leg is a fault. After the last leg speed and heading stay; a notice
    says so where the run goes on.

    Every change follows tau - sin(2 pi tau)/(2 pi): acceleration and turn rate are raised cosines,
    continuous, with a peak of twice the mean. While turning the vehicle keeps its speed,
    V = speed [sin psi, cos psi].
    """

    kind: Literal["legs"] = "legs"
    leg: tuple[Leg, ...] = Field(
        default=(Leg(),),
        max_length=1000,
        description="The legs in their order, [[motion.leg]].",
    )

    @model_validator(mode="after")
    def _possible(self) -> LegsMotion:
        faults = list(self.faults())
        if faults:
            raise InputError(faults)
        return self

    def faults(self) -> Iterator[Fault]:
        """Yield the faults: both speeds given, a change that does not fit, a speed out of range."""
        if not self.leg:
            yield Fault("", "leg", None, "must hold at least one [[motion.leg]]")
            return
        twice = [
            i for i, leg in enumerate(self.leg) if leg.speed_mps is not None and leg.speed_kn is not None
        ]
        for number in twice:
            knots = self.leg[number].speed_kn
            yield Fault("", f"leg.{number}.speed_kn", knots, "give speed_mps or speed_kn, not both")
        if not twice:
            yield from self._misfits()

    def _misfits(self) -> Iterator[Fault]:
        for number, speed, changes in self._resolved():
            for change in changes:
                if change.fault:
                    field, value, text = change.fault
                    yield Fault("", f"leg.{number}.{field}", value, text)
            if not SLOWEST - 1e-9 <= speed <= FASTEST + 1e-9:
                leg = self.leg[number]
                field = "accel_mps2" if leg.speed is None or number == 0 else leg.speed_field
                yield Fault(
                    "",
                    f"leg.{number}.{field}",
                    getattr(leg, field),
                    Text(
                        "leads to {speed:g} m/s: speeds must be >= {slowest:g} and <= {fastest:g} (m/s)",
                        speed=speed,
                        slowest=SLOWEST,
                        fastest=FASTEST,
                    ),
                )
                return

    def table(self) -> np.ndarray:
        """Legs as numbers, shape (m, 8), columns of `navcore.motion.course`; s, m/s, rad."""
        first = self.leg[0]
        start, speed = 0.0, first.speed or 0.0
        heading = (self.heading_deg if first.heading_deg is None else first.heading_deg) * DEG
        rows = []
        for number, _, (faster, turned) in self._resolved():
            rows.append(
                [
                    start,
                    speed,
                    faster.amount,
                    faster.time_s,
                    heading,
                    turned.amount,
                    turned.time_s,
                    RAISED_COSINE,
                ]
            )
            start += self.leg[number].duration_s
            speed, heading = speed + faster.amount, heading + turned.amount
        return np.array(rows)

    def course(self, end_s: float, site: Site, earth: Earth) -> Course:
        """Lay the course from t = 0 to ``end_s``: the compiled functions of `navcore.motion.course` read it.

        Raises
        ------
        InputError
            It leads beyond 89.5 deg of latitude; names the leg.
        """
        try:
            return lay_course(self.table(), end_s, site, earth)
        except PoleReached as reached:
            raise InputError(
                Fault(
                    "",
                    f"leg.{reached.leg}",
                    None,
                    Text(
                        "passes 89.5° of latitude after {time_s:.0f} s: must stay within +-89.5°",
                        time_s=reached.time_s,
                    ),
                )
            ) from None

    def truth(
        self, count: int, step_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> Truth:
        """Return the true motion at ``count`` times 0, step_s, ...; shape (count, 15), or (1, 15) at rest.

        The position is within 0.01 mm of an exact integration over 24 h, whatever the step. Heading and
        longitude are not wrapped.

        Raises
        ------
        InputError
            The course leads beyond 89.5 deg of latitude.
        """
        legs = self.table()
        if not legs[:, [SPEED, SPEED_CHANGE, COURSE_CHANGE]].any():
            heading = self.heading_deg if self.leg[0].heading_deg is None else self.leg[0].heading_deg
            return Truth(step_s, self.model_copy(update={"heading_deg": heading}).rest_row(site))
        course = self.course(max(count - 1, 1) * step_s, site, earth)
        pitch, roll = self.pitch_deg * DEG, self.roll_deg * DEG
        return Truth(step_s, sample_course(course, count, step_s, pitch, roll, site.height))

    def kinematics(
        self, end_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> Kinematics:
        """Return legs, position nodes and the constant pitch and roll."""
        course = self.course(end_s, site, earth)
        return Kinematics(
            BY_COURSE, self.rest_row(site)[0], legs=askable_before_start(course.legs), nodes=course.nodes
        )

    def frequencies(self) -> Iterator[tuple[str, float]]:
        """Yield one over the shortest change of each leg."""
        for number, row in enumerate(self.table()):
            times = [time for time in (row[SPEED_TIME], row[COURSE_TIME]) if time > 0.0]
            if times:
                yield f"leg.{number}", 1.0 / min(times)

    def ending(self, end_s: float) -> Iterator[str]:
        """Say when the last leg ends before the run, and that speed and heading stay."""
        last, number = self.table()[-1], len(self.leg) - 1
        over_s = last[START] + self.leg[number].duration_s
        if over_s >= end_s:
            return
        speed, course = last[SPEED] + last[SPEED_CHANGE], (last[COURSE] + last[COURSE_CHANGE]) / DEG % 360.0
        yield Text(
            "motion.leg.{number} is the last and ends after {over:.4g} h: for the other {rest:.4g} h of the "
            "run the vehicle keeps {speed:.4g} m/s and heading {heading:.4g}°",
            number=number,
            over=over_s / HOUR,
            rest=(end_s - over_s) / HOUR,
            speed=speed,
            heading=course,
        )

    def _resolved(self) -> Iterator[tuple[int, float, tuple[_Change, _Change]]]:
        """Number of each leg, the speed at its end, and its changes of speed and heading."""
        first = self.leg[0]
        speed = first.speed or 0.0
        heading_deg = self.heading_deg if first.heading_deg is None else first.heading_deg
        for number, leg in enumerate(self.leg):
            given = leg.model_copy(update={"speed_mps": None, "speed_kn": None, "heading_deg": None})
            goal = given if number == 0 else leg
            faster, turned = _change_of_speed(goal, speed), _change_of_heading(goal, heading_deg)
            speed, heading_deg = speed + faster.amount, heading_deg + turned.amount / DEG
            yield number, speed, (faster, turned)


def _change_of_speed(leg: Leg, speed: float) -> _Change:
    if leg.speed is None:
        amount = (leg.accel_mps2 or 0.0) * leg.duration_s
        return _Change(amount, leg.duration_s if amount else 0.0)
    amount = leg.speed - speed
    if amount == 0.0:
        return _Change(0.0, 0.0)
    rate = DEFAULT_ACCELERATION if leg.accel_mps2 is None else abs(leg.accel_mps2)
    what = Text(
        "the change from {speed:g} to {speed_2:g} m/s at a mean of {rate:g} m/s²",
        speed=speed,
        speed_2=leg.speed,
        rate=rate,
    )
    return _fitted(leg, amount, rate, what, leg.speed_field)


def _change_of_heading(leg: Leg, heading_deg: float) -> _Change:
    turn = leg.turn_dps
    if leg.heading_deg is None:
        amount = (turn or 0.0) * leg.duration_s * DEG
        return _Change(amount, leg.duration_s if amount else 0.0)
    amount = _turn_deg(leg.heading_deg - heading_deg, turn)
    if amount == 0.0:
        return _Change(0.0, 0.0)
    rate = DEFAULT_TURN_RATE_DPS if turn is None else abs(turn)
    what = Text("the turn by {amount:g}° at a mean of {rate:g} °/s", amount=amount, rate=rate)
    change = _fitted(leg, amount, rate, what, "heading_deg")
    return change._replace(amount=amount * DEG)


def _turn_deg(difference: float, turn: float | None) -> float:
    """Turn to a heading: by the shorter way (starboard when both are equal), or to the side of ``turn``."""
    shorter = difference - 360.0 * math.floor(difference / 360.0 + 0.5)
    if abs(shorter) < _SAME_HEADING_DEG:
        return shorter
    if abs(abs(shorter) - 180.0) < _SAME_HEADING_DEG:
        shorter = 180.0
    if turn is not None and turn * shorter < 0.0:
        return shorter + math.copysign(360.0, turn)
    return shorter


def _fitted(leg: Leg, amount: float, rate: float, what: str, field: str) -> _Change:
    """Change at a mean rate, with a fault when it does not end within the leg."""
    if rate * leg.duration_s >= abs(amount) * (1.0 - 1e-9):
        return _Change(amount, min(abs(amount) / rate, leg.duration_s))
    takes = Text("takes {amount:.6g} s", amount=abs(amount) / rate) if rate else "never ends"
    text = Text(
        "{what} {takes}, but the leg ends after {duration_s:g} s",
        what=what,
        takes=takes,
        duration_s=leg.duration_s,
    )
    return _Change(amount, leg.duration_s, (field, getattr(leg, field), text))
