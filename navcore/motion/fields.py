"""Fields that several motions have: speed, heading, pitch and roll, each with its own help."""

from typing import Any

from navcore.foundation.parameters import quantity
from navcore.foundation.text import Text
from navcore.foundation.units import KNOT

SLOWEST, FASTEST = -50.0, 500.0
"""Range of speeds, m/s; negative is astern."""


def speed_mps_field(help_: str) -> Any:
    """Make an optional speed in m/s."""
    slider, label = (0.0, 20.0), Text("speed")
    return quantity(None, unit="m/s", ge=SLOWEST, le=FASTEST, slider=slider, label=label, help=help_)


def speed_kn_field(help_: str) -> Any:
    """Make the same in knots."""
    return quantity(None, unit="kn", ge=-97.0, le=970.0, slider=(0.0, 40.0), label=Text("speed"), help=help_)


def heading_field(default: float | None, help_: str, label: str = Text("heading")) -> Any:  # noqa: B008
    """Make a direction from true north, clockwise, deg."""
    return quantity(default, unit="deg", ge=-360.0, le=360.0, slider=(0.0, 360.0), label=label, help=help_)


def pitch_field(default: float | None) -> Any:
    """Make a pitch, deg."""
    label, help_ = Text("pitch"), Text("Pitch, bow up positive.")
    return quantity(default, unit="deg", ge=-89.0, le=89.0, slider=(-30.0, 30.0), label=label, help=help_)


def roll_field(default: float | None) -> Any:
    """Make a roll, deg."""
    label, help_ = Text("roll"), Text("Roll, starboard down positive.")
    return quantity(default, unit="deg", ge=-180.0, le=180.0, slider=(-30.0, 30.0), label=label, help=help_)


def speed_of(speed_mps: float | None, speed_kn: float | None) -> float | None:
    """Speed in m/s of the field that is given; None when neither is."""
    return speed_kn * KNOT if speed_kn is not None else speed_mps
