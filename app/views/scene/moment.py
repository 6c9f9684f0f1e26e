"""One moment of a run: true attitude and velocity, what each method takes them for, and its errors."""

from __future__ import annotations

import math
from dataclasses import dataclass
from html import escape
from typing import NamedTuple

import numpy as np

from app.plots import style
from app.plots.units import (
    AUTO,
    KNOTS,
    NAMED,
    Unit,
    angle_unit,
    duration,
    length_unit,
    number,
    speed_unit,
    wanted_unit,
)
from app.session.display import Display
from navcore.engine.run import MethodRun, Run
from navcore.foundation.earth import attitude_matrix
from navcore.foundation.notation import with_unit
from navcore.foundation.units import DEG
from navcore.mechanization.recorder import DV_E, DV_N, PHI_E, PHI_U, POSITION, QUANTITIES
from navcore.motion.base import HEADING, PITCH, ROLL, VE, VN

_AS_IT_FITS = Display()
_LEAST = 0.01
"""Of the smallest units, such as µas: no sensor and no plot knows less."""
_COMPUTED = (6, 7, 8)
"""Pitch, roll and heading among the columns of `MethodRun.navigation`."""


class Pose(NamedTuple):
    """Attitude (rad; heading clockwise from north, 0 to 2 pi) and speed over ground (m/s)."""

    heading: float
    pitch: float
    roll: float
    speed: float


@dataclass(frozen=True, eq=False)
class MethodMoment:
    """Pose that one method computes, and its errors.

    Attributes
    ----------
    name, color : str
        The method's.
    pose : Pose
        As computed.
    errors : ndarray, shape (8,)
        The quantities of `navcore.mechanization.recorder.NAMES`, SI.
    ended : bool
        The method did not come this far: its last values are shown.
    """

    name: str
    color: str
    pose: Pose
    errors: np.ndarray
    ended: bool


class Moment(NamedTuple):
    """One moment: its time in the run (s), the true pose, and the methods in the scenario's order."""

    t_s: float
    truth: Pose
    methods: tuple[MethodMoment, ...]


def moment(run: Run, t_s: float) -> Moment:
    """Attitude, speed and errors at a time, interpolated between the output rows."""
    truth = row_at(run.t_s, run.truth[:, [PITCH, ROLL, HEADING, VE, VN]], t_s)
    pitch, roll, heading, ve, vn = truth.tolist()
    attitude = attitude_matrix(pitch, roll, heading)
    methods = []
    for index, method in enumerate(run.methods):
        errors = row_at(method.t_s, method.rows[:, :QUANTITIES], t_s)
        speed = math.hypot(ve + errors[DV_E], vn + errors[DV_N])
        methods.append(
            MethodMoment(
                name=method.method.name,
                color=style.method_color(index),
                pose=Pose(*_computed(method, errors, attitude, t_s), speed),
                errors=errors,
                ended=len(method.t_s) == 0 or t_s > method.t_s[-1] + 1e-6,
            )
        )
    return Moment(t_s, Pose(heading % math.tau, pitch, roll, math.hypot(ve, vn)), tuple(methods))


def row_at(t_s: np.ndarray, rows: np.ndarray, at_s: float) -> np.ndarray:
    """Row of a series at a time, shape (columns,): interpolated, the first or last one outside."""
    if len(t_s) == 0:
        return np.zeros(rows.shape[1])
    after = int(np.clip(np.searchsorted(t_s, at_s), 1, max(len(t_s) - 1, 1)))
    if after >= len(t_s):
        return rows[0].copy()
    span = t_s[after] - t_s[after - 1]
    part = min(max((at_s - t_s[after - 1]) / span, 0.0), 1.0)
    return (1.0 - part) * rows[after - 1] + part * rows[after]


def _computed(
    method: MethodRun, errors: np.ndarray, attitude: np.ndarray, t_s: float
) -> tuple[float, float, float]:
    """Heading, pitch and roll that a method computes: C~ = (I - [phi x]) C, or what the strapdown says."""
    if method.navigation is not None and len(method.navigation):
        at = int(np.clip(np.searchsorted(method.t_s, t_s, side="right") - 1, 0, len(method.navigation) - 1))
        pitch, roll, heading = (float(value) for value in method.navigation[at, _COMPUTED])
        return heading % math.tau, pitch, roll
    e, n, u = errors[PHI_E : PHI_U + 1]
    cross = np.array([[0.0, -u, n], [u, 0.0, -e], [-n, e, 0.0]])
    c = attitude - cross @ attitude
    heading = math.atan2(c[0, 1], c[1, 1])
    pitch = math.asin(min(max(c[2, 1], -1.0), 1.0))
    return heading % math.tau, pitch, math.atan2(-c[2, 0], c[2, 2])


def readout_html(now: Moment, selected: int, display: Display = _AS_IT_FITS) -> str:
    """True and computed attitude and speed of one method, and its errors, in the units that are asked for.

    Attitude is in degrees and speed in knots unless speeds are asked for in another unit.
    """
    method = now.methods[min(selected, len(now.methods) - 1)]
    true, computed = now.truth, method.pose
    turned = math.remainder(computed.heading - true.heading, math.tau)
    attitude = (
        ("heading", true.heading, computed.heading, turned),
        ("pitch", true.pitch, computed.pitch, computed.pitch - true.pitch),
        ("roll", true.roll, computed.roll, computed.roll - true.roll),
    )
    rows = [
        (name, _degrees(a), _degrees(b), _signed(off, wanted_unit(display.angle, abs(off), angle_unit)))
        for name, a, b, off in attitude
    ]
    way = KNOTS if display.speed == AUTO else NAMED[display.speed]
    a, b = (f"{pose.speed / way.si:.2f} {way.name}" for pose in (true, computed))
    faster, off = computed.speed - true.speed, float(method.errors[POSITION])
    rows.append(("speed", a, b, _signed(faster, wanted_unit(display.speed, abs(faster), speed_unit))))
    rows.append(("position", "", "", _signed(off, wanted_unit(display.length, off, length_unit)).lstrip("+")))
    cells = "".join(
        f"<tr><th scope='row'>{name}</th><td>{a}</td><td>{b}</td><td>{c}</td></tr>" for name, a, b, c in rows
    )
    ended = " (ended)" if method.ended else ""
    return (
        f"<table data-t='{now.t_s:.3f}'><thead><tr><th scope='col'>{duration(now.t_s)}</th>"
        f"<th scope='col'>true</th><th scope='col'><span class='sb-name' style='border-color:{method.color}'>"
        f"{escape(method.name)}{ended}</span></th><th scope='col'>error</th></tr></thead>"
        f"<tbody>{cells}</tbody></table>"
    )


def _degrees(angle: float) -> str:
    return f"{round(angle / DEG, 2) + 0.0:.2f}°"


def _signed(value: float, unit: Unit) -> str:
    """Error with its sign; what is below a hundredth of the smallest unit is rounding, and reads as 0."""
    rounded = float(f"{value / unit.si:.3g}")
    if unit.name.startswith("µ") and abs(rounded) < _LEAST:
        return f"0 {unit.name}"
    return f"{'+' if rounded > 0 else ''}{with_unit(number(rounded), unit.name)}"
