"""A seaway and a ship in it as a scenario gives them: fields that every motion in waves shares."""

from typing import Literal

import numpy as np

from navcore.foundation.parameters import Parameters, choice, quantity
from navcore.foundation.text import Text
from navcore.foundation.units import DEG
from navcore.motion.sea import Answer, Seaway, fully_developed_peak_period, make_seaway

ANSWERS = ("pitch", "roll", "heading", Text("heave"))


def _gain(default: float, what: str, unit: str = "deg/deg") -> float:
    return quantity(
        default,
        unit=unit,
        ge=0.0,
        le=5.0,
        slider=(0.0, 2.0),
        label=Text("{what} gain", what=what),
        help=Text("{what} in long waves as a part of what excites it; 0 for none.", what=what),
    )


def _period(default: float, what: str) -> float:
    return quantity(
        default,
        unit="s",
        ge=0.5,
        le=60.0,
        slider=(3.0, 30.0),
        label=Text("{what} period", what=what),
        help=Text("Natural period of the ship's {what}.", what=what),
    )


def _damping(default: float, what: str) -> float:
    return quantity(
        default,
        unit="1",
        ge=0.02,
        le=2.0,
        slider=(0.02, 1.0),
        label=Text("{what} damping", what=what),
        help=Text("Damping ratio of the ship's {what}.", what=what),
    )


class SeaFields(Parameters):
    """The seaway."""

    spectrum: Literal["bretschneider", "pierson_moskowitz"] = choice(
        "bretschneider",
        label=Text("spectrum"),
        help=Text(
            "bretschneider: height and peak period are free; pierson_moskowitz: a fully developed sea, "
            "whose peak period follows from the height, 5.0 s x √(height in m)."
        ),
    )
    height_m: float = quantity(
        2.5,
        unit="m",
        ge=0.0,
        le=20.0,
        slider=(0.0, 10.0),
        label=Text("wave height"),
        help=Text("Significant wave height, four times the standard deviation of the surface."),
    )
    peak_period_s: float = quantity(
        8.0,
        unit="s",
        ge=2.0,
        le=30.0,
        slider=(4.0, 20.0),
        label=Text("peak period"),
        help=Text("Period at the peak of the spectrum; bretschneider only."),
    )
    direction_deg: float = quantity(
        60.0,
        unit="deg",
        ge=-360.0,
        le=360.0,
        slider=(0.0, 360.0),
        label=Text("waves from"),
        help=Text("Direction the waves come from, clockwise from true north."),
    )
    spread_deg: float = quantity(
        15.0,
        unit="deg",
        ge=0.0,
        le=60.0,
        slider=(0.0, 45.0),
        label=Text("spread"),
        help=Text("Standard deviation of the components' directions; 0 for a long-crested sea."),
    )
    components: int = quantity(
        32,
        unit="1",
        ge=8,
        le=200,
        slider=(8, 100),
        label=Text("components"),
        help=Text("Number of sinusoids; their frequencies are irregular, so the motion does not repeat."),
    )
    seed: int = quantity(
        1,
        unit="1",
        ge=0,
        le=2**31 - 1,
        slider=(0, 100),
        label=Text("sea"),
        help=Text("Seed of the seaway: another number, another sea of the same spectrum."),
    )

    @property
    def modal_period_s(self) -> float:
        """Period at the peak of the spectrum in use, s."""
        if self.spectrum == "bretschneider" or self.height_m == 0.0:
            return self.peak_period_s
        return fully_developed_peak_period(self.height_m)

    def seaway(self) -> Seaway:
        """Draw the components."""
        return make_seaway(
            self.height_m,
            self.modal_period_s,
            (self.direction_deg + 180.0) * DEG,
            self.spread_deg * DEG,
            self.components,
            np.random.default_rng(self.seed),
        )


class AnswerFields(Parameters):
    """The ship's answers."""

    pitch_gain: float = _gain(0.7, "pitch")
    pitch_period_s: float = _period(6.0, "pitch")
    pitch_damping: float = _damping(0.4, "pitch")
    roll_gain: float = _gain(0.8, "roll")
    roll_period_s: float = _period(11.0, "roll")
    roll_damping: float = _damping(0.12, "roll")
    heading_gain: float = _gain(0.5, "heading")
    heading_period_s: float = _period(12.0, "heading")
    heading_damping: float = _damping(0.5, "heading")
    heave_gain: float = _gain(1.0, "heave", "m/m")
    heave_period_s: float = _period(6.0, "heave")
    heave_damping: float = _damping(0.4, "heave")

    def answers(self) -> tuple[Answer, ...]:
        """Transfer functions of pitch, roll, heading and heave."""
        names = ("gain", "period_s", "damping")
        return tuple(Answer(*(getattr(self, f"{answer}_{name}") for name in names)) for answer in ANSWERS)
