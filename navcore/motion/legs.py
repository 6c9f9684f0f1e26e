"""Motion `legs`: straight runs, turns and changes of speed, one after the other, with smooth changes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np
from pydantic import Field, model_validator

from navcore.foundation.earth import Earth
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.parameters import quantity
from navcore.foundation.text import Text
from navcore.foundation.units import DEG, HOUR
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
)
from navcore.motion.fields import FASTEST, SLOWEST
from navcore.motion.filling import sample
from navcore.motion.kinematics import COURSE as BY_COURSE
from navcore.motion.kinematics import Kinematics
from navcore.motion.leg import (
    Change,
    Leg,
    change_of_depth,
    change_of_heading,
    change_of_speed,
)
from navcore.motion.seagoing import SeagoingMotion
from navcore.motion.truth import Site, Truth

MOST_LEGS = 10_000
"""Legs that a motion runs at most, all rounds together."""


class LegsMotion(SeagoingMotion):
    """Legs one after the other; pitch and roll are constant, the vehicle moves along its heading.

    The speed of the first leg is the initial speed (0 if it names none), its heading the initial heading
    (else ``heading_deg`` of the motion). In later legs a speed or heading is what the leg reaches, from its
    start on: speed at the mean acceleration ``accel_mps2`` (its size; default 0.1 m/s^2), heading by the
    shorter way at 1 deg/s (mean), or at ``turn_dps``, whose sign then chooses the side. ``accel_mps2`` or
    ``turn_dps`` without a speed or heading to reach acts over the whole leg. A change that does not end
    within its leg is a fault. After the last leg speed and heading stay; a
    notice says so where the run goes on. With ``repeat`` the legs are run
    again and again; from the second round on the first leg is one like the others, whose speed and heading
    are reached. A change of depth (``depth_m``) leaves the pitch and the speed over the ground as they are.

    Every change follows tau - sin(2 pi tau)/(2 pi): acceleration and turn rate are raised cosines,
    continuous, with a peak of twice the mean. While turning the vehicle keeps its speed,
    V = speed [sin psi, cos psi].
    """

    kind: Literal["legs"] = "legs"
    leg: tuple[Leg, ...] = Field(
        default=(Leg(),),
        max_length=1000,
        description=Text("The legs in their order, [[motion.leg]]."),
    )
    repeat: int = quantity(
        1,
        unit="1",
        ge=1,
        le=MOST_LEGS,
        slider=(1, 100),
        label=Text("rounds"),
        help=Text("How often the legs are run."),
    )
    repeat_from: int = quantity(
        0,
        unit="1",
        ge=0,
        le=999,
        label=Text("rounds from leg"),
        help=Text(
            "With repeat: the leg at which each further round begins, counted from 0. The legs before "
            "it are run once."
        ),
    )
    every_h: float | None = quantity(
        None,
        unit="h",
        gt=0.0,
        le=10000.0,
        slider=(0.1, 24.0),
        label=Text("a round every"),
        help=Text(
            "With repeat: time from the beginning of one round to that of the next; after its last leg the "
            "vehicle keeps speed and heading until then. Not given: the length of the legs."
        ),
    )

    @model_validator(mode="after")
    def _possible(self) -> LegsMotion:
        faults = list(self.faults()) or list(self.sea_faults())
        if faults:
            raise InputError(faults)
        return self

    def faults(self) -> Iterator[Fault]:
        """Yield the faults: both speeds given, a change that does not fit, a speed out of range."""
        if not self.leg:
            yield Fault("", "leg", None, Text("must hold at least one [[motion.leg]]"))
            return
        twice = [
            i for i, leg in enumerate(self.leg) if leg.speed_mps is not None and leg.speed_kn is not None
        ]
        for number in twice:
            knots = self.leg[number].speed_kn
            yield Fault("", f"leg.{number}.speed_kn", knots, Text("give speed_mps or speed_kn, not both"))
        rounds = list(self._misplaced_rounds())
        yield from rounds
        if not twice and not rounds:
            yield from self._misfits()

    def _misplaced_rounds(self) -> Iterator[Fault]:
        count = len(self.leg)
        if self.repeat_from >= count:
            allowed = Text("must be <= {last}, the number of the last leg", last=count - 1)
            yield Fault("", "repeat_from", self.repeat_from, allowed)
            return
        most = 1 + (MOST_LEGS - count) // (count - self.repeat_from)
        if self.repeat > most:
            allowed = Text("must be <= {most}: at most {legs} legs are run", most=most, legs=MOST_LEGS)
            yield Fault("", "repeat", self.repeat, allowed)
        length = sum(leg.duration_s for leg in self.leg[self.repeat_from :])
        if self.repeat > 1 and self.every_h is not None and self.every_h * HOUR < length * (1.0 - 1e-9):
            allowed = Text(
                "must be >= {length:g} (h), the length of the legs of a round", length=length / HOUR
            )
            yield Fault("", "every_h", self.every_h, allowed)

    def _sequence(self) -> Iterator[tuple[float, int]]:
        """Start (s) and number of each leg that is run, round after round."""
        start = again = 0.0
        for number, leg in enumerate(self.leg):
            again = start if number == self.repeat_from else again
            yield start, number
            start += leg.duration_s
        every = start - again if self.every_h is None else self.every_h * HOUR
        for turn in range(1, self.repeat):
            start = again + turn * every
            for number in range(self.repeat_from, len(self.leg)):
                yield start, number
                start += self.leg[number].duration_s

    def _misfits(self) -> Iterator[Fault]:
        faulty = set()
        for _, number, speed, changes in self._resolved():
            for change in changes:
                if change.fault and (number, change.fault[0]) not in faulty:
                    faulty.add((number, change.fault[0]))
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
        speed = first.speed or 0.0
        heading = (self.heading_deg if first.heading_deg is None else first.heading_deg) * DEG
        rows = []
        for start, _, _, (faster, turned, _) in self._resolved():
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
                    f"leg.{list(self._sequence())[reached.leg][1]}",
                    None,
                    Text(
                        "passes 89.5° of latitude after {time_s:.0f} s: must stay within +-89.5°",
                        time_s=reached.time_s,
                    ),
                )
            ) from None

    def calm_truth(self, count: int, step_s: float, site: Site, earth: Earth) -> Truth:
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
        kin = self.calm_kinematics(max(count - 1, 1) * step_s, site, earth)
        return Truth(step_s, sample(kin, count, step_s, earth))

    @property
    def dives(self) -> bool:
        """Whether any leg is below the height of the site."""
        return any(leg.depth_m for leg in self.leg)

    def depths(self) -> np.ndarray:
        """Start (s), depth and its change (m) and the time it takes (s) of each leg that is run, (m, 4)."""
        rows, depth = [], self.leg[0].depth_m or 0.0
        for start, _, _, (_, _, dived) in self._resolved():
            rows.append((start, depth, dived.amount, dived.time_s))
            depth += dived.amount
        return np.array(rows)

    def depth_at(self, t_s: np.ndarray) -> np.ndarray:
        """Depth at times (n,), m; shape (n,). A change follows tau - sin(2 pi tau)/(2 pi)."""
        table = self.depths()
        leg = table[np.maximum(np.searchsorted(table[:, 0], t_s, side="right") - 1, 0)]
        tau = np.clip((t_s - leg[:, 0]) / np.maximum(leg[:, 3], 1e-6), 0.0, 1.0)
        return leg[:, 1] + leg[:, 2] * (tau - np.sin(2.0 * np.pi * tau) / (2.0 * np.pi))

    def shortest_dive_s(self) -> float:
        """Return the shortest time of a change of depth, s; inf where there is none."""
        times = self.depths()[:, 3]
        return float(times[times > 0.0].min(initial=np.inf))

    def changes(self) -> np.ndarray:
        """Return the table of the legs."""
        return self.table()

    def calm_kinematics(self, end_s: float, site: Site, earth: Earth) -> Kinematics:
        """Return legs, position nodes and the constant pitch and roll."""
        course = self.course(end_s, site, earth)
        return Kinematics(
            BY_COURSE, self.rest_row(site)[0], legs=askable_before_start(course.legs), nodes=course.nodes
        )

    def calm_frequencies(self) -> Iterator[tuple[str, float]]:
        """Yield one over the shortest change of each leg."""
        shortest: dict[int, float] = {}
        for (_, number), row in zip(self._sequence(), self.table(), strict=True):
            for time in (row[SPEED_TIME], row[COURSE_TIME]):
                if time > 0.0:
                    shortest[number] = min(time, shortest.get(number, time))
        for number, time in sorted(shortest.items()):
            yield f"leg.{number}", 1.0 / time

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

    def _resolved(self) -> Iterator[tuple[float, int, float, tuple[Change, Change, Change]]]:
        """Start and number of each leg that is run, its final speed, its changes of speed, heading, depth."""
        first = self.leg[0]
        speed = first.speed or 0.0
        heading_deg = self.heading_deg if first.heading_deg is None else first.heading_deg
        depth = first.depth_m or 0.0
        initial = ("speed_mps", "speed_kn", "heading_deg", "depth_m")
        given = first.model_copy(update=dict.fromkeys(initial))
        for place, (start, number) in enumerate(self._sequence()):
            goal = self.leg[number] if place else given
            faster, turned = change_of_speed(goal, speed), change_of_heading(goal, heading_deg)
            dived = change_of_depth(goal, depth)
            speed, heading_deg = speed + faster.amount, heading_deg + turned.amount / DEG
            depth += dived.amount
            yield start, number, speed, (faster, turned, dived)
