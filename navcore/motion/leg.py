"""One leg of a course: its fields, and the changes of speed and heading that they ask for."""

import math
from typing import NamedTuple

from navcore.foundation.parameters import quantity
from navcore.foundation.text import Text
from navcore.foundation.times import EitherUnit
from navcore.foundation.units import DEG
from navcore.motion.fields import heading_field, speed_kn_field, speed_mps_field, speed_of

DEFAULT_ACCELERATION = 0.1
"""Mean acceleration of a change of speed when none is given, m/s^2."""
DEFAULT_TURN_RATE_DPS = 1.0
"""Mean turn rate of a change of heading when none is given, deg/s."""
DEFAULT_DIVE = 0.5
"""Mean vertical speed of a change of depth when none is given, m/s."""
_SAME_HEADING_DEG = 1e-6
_SAME = 1e-9
"""Values whose difference is a smaller part of them, or of 1 m or 1 m/s, are the same: it is rounding."""


class Leg(EitherUnit):
    """One leg of a `legs` motion; a field left out changes nothing."""

    duration_s: float = quantity(
        3600.0,
        unit="s",
        gt=0.0,
        le=1e7,
        slider=(60.0, 36000.0),
        log=True,
        label=Text("duration"),
        help=Text("Length of the leg; a change must end within it."),
    )
    speed_mps: float | None = speed_mps_field(
        Text(
            "First leg: the initial speed. Later legs: the speed to reach, at accel_mps2 (mean), else at a "
            "mean of 0.1 m/s². Negative is astern. Not together with speed_kn."
        )
    )
    speed_kn: float | None = speed_kn_field(Text("The same in knots. Not together with speed_mps."))
    accel_mps2: float | None = quantity(
        None,
        unit="m/s2",
        ge=-20.0,
        le=20.0,
        slider=(-0.5, 0.5),
        label=Text("acceleration"),
        help=Text(
            "With a speed to reach: the size of the mean acceleration. Alone, or in the first leg: the mean "
            "acceleration over the whole leg. It rises and falls as a raised cosine, its peak is "
            "twice the mean."
        ),
    )
    turn_dps: float | None = quantity(
        None,
        unit="deg/s",
        ge=-60.0,
        le=60.0,
        slider=(-3.0, 3.0),
        label=Text("turn rate"),
        help=Text(
            "With a heading to reach: the mean turn rate, whose sign chooses the side. Alone, or in the "
            "first leg: the mean turn rate over the whole leg, starboard positive. Its peak is "
            "twice the mean."
        ),
    )
    heading_deg: float | None = heading_field(
        None,
        Text(
            "First leg: the initial heading, in place of that of the motion. Later legs: the heading to "
            "reach, at turn_dps (mean) if given, else by the shorter way at a mean of 1 °/s."
        ),
    )

    depth_m: float | None = quantity(
        None,
        unit="m",
        ge=0.0,
        le=12000.0,
        slider=(0.0, 500.0),
        label=Text("depth"),
        help=Text(
            "First leg: the initial depth below the height of the site, 0 if it names none. Later legs: the "
            "depth to reach, at dive_mps."
        ),
    )
    dive_mps: float | None = quantity(
        None,
        unit="m/s",
        gt=0.0,
        le=20.0,
        slider=(0.05, 3.0),
        label=Text("dive"),
        help=Text(
            "Mean vertical speed of a change of depth, up or down, else 0.5 m/s; its peak is twice that."
        ),
    )

    @property
    def speed(self) -> float | None:
        """Speed in m/s, None when the leg names none."""
        return speed_of(self.speed_mps, self.speed_kn)

    @property
    def speed_field(self) -> str:
        """Name of the field that the speed came from."""
        return "speed_kn" if self.speed_kn is not None else "speed_mps"


class Change(NamedTuple):
    """Change of speed (m/s), heading (rad) or depth (m), the time it takes (s), and what is wrong with it."""

    amount: float
    time_s: float
    fault: tuple[str, object, str] | None = None


def change_of_speed(leg: Leg, speed: float) -> Change:
    """Change of speed that a leg asks for, from a speed in m/s."""
    if leg.speed is None:
        amount = (leg.accel_mps2 or 0.0) * leg.duration_s
        return Change(amount, leg.duration_s if amount else 0.0)
    amount = _difference(leg.speed, speed)
    if amount == 0.0:
        return Change(0.0, 0.0)
    rate = DEFAULT_ACCELERATION if leg.accel_mps2 is None else abs(leg.accel_mps2)
    what = Text(
        "the change from {speed:g} to {speed_2:g} m/s at a mean of {rate:g} m/s²",
        speed=speed,
        speed_2=leg.speed,
        rate=rate,
    )
    return _fitted(leg, amount, rate, what, leg.speed_field)


def change_of_depth(leg: Leg, depth: float) -> Change:
    """Change of depth that a leg asks for, from a depth in m."""
    amount = 0.0 if leg.depth_m is None else _difference(leg.depth_m, depth)
    if amount == 0.0:
        return Change(0.0, 0.0)
    rate = DEFAULT_DIVE if leg.dive_mps is None else leg.dive_mps
    what = Text(
        "the change from {depth:g} to {depth_2:g} m at a mean of {rate:g} m/s",
        depth=depth,
        depth_2=leg.depth_m,
        rate=rate,
    )
    return _fitted(leg, amount, rate, what, "depth_m")


def change_of_heading(leg: Leg, heading_deg: float) -> Change:
    """Change of heading that a leg asks for, from a heading in deg; the amount is in rad."""
    turn = leg.turn_dps
    if leg.heading_deg is None:
        amount = (turn or 0.0) * leg.duration_s * DEG
        return Change(amount, leg.duration_s if amount else 0.0)
    amount = _turn_deg(leg.heading_deg - heading_deg, turn)
    if amount == 0.0:
        return Change(0.0, 0.0)
    rate = DEFAULT_TURN_RATE_DPS if turn is None else abs(turn)
    what = Text("the turn by {amount:g}° at a mean of {rate:g} °/s", amount=amount, rate=rate)
    change = _fitted(leg, amount, rate, what, "heading_deg")
    return change._replace(amount=amount * DEG)


def _difference(goal: float, present: float) -> float:
    """Change from one value to another; 0 where rounding alone tells them apart.

    Examples
    --------
    >>> _difference(0.3, 0.1 + 0.2), _difference(0.31, 0.3) > 0.0
    (0.0, True)
    """
    change = goal - present
    return 0.0 if abs(change) <= _SAME * max(abs(goal), 1.0) else change


def _turn_deg(difference: float, turn: float | None) -> float:
    """Turn to a heading: by the shorter way (starboard when both are equal), or to the side of ``turn``."""
    shorter = difference - 360.0 * math.floor(difference / 360.0 + 0.5)
    if abs(shorter) < _SAME_HEADING_DEG:  # rounding of the headings, which is no turn
        return 0.0
    if abs(abs(shorter) - 180.0) < _SAME_HEADING_DEG:
        shorter = 180.0
    if turn is not None and turn * shorter < 0.0:
        return shorter + math.copysign(360.0, turn)
    return shorter


def _fitted(leg: Leg, amount: float, rate: float, what: str, field: str) -> Change:
    """Change at a mean rate, with a fault when it does not end within the leg."""
    if rate * leg.duration_s >= abs(amount) * (1.0 - 1e-9):
        return Change(amount, min(abs(amount) / rate, leg.duration_s))
    takes = Text("takes {amount:.6g} s", amount=abs(amount) / rate) if rate else Text("never ends")
    text = Text(
        "{what} {takes}, but the leg ends after {duration_s:g} s",
        what=what,
        takes=takes,
        duration_s=leg.duration_s,
    )
    return Change(amount, leg.duration_s, (field, getattr(leg, field), text))
