"""Motion `swing`: harmonic pitch, roll and heading about a mean attitude, at one place."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Literal

import numpy as np
from pydantic import Field, model_validator

from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.earth import Earth
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.parameters import Parameters, quantity
from navcore.foundation.text import Text
from navcore.foundation.trigonometry import sincos_cycles
from navcore.foundation.units import DEG
from navcore.motion.base import MotionParameters
from navcore.motion.kinematics import SWING, Kinematics
from navcore.motion.static import AttitudeMotion
from navcore.motion.truth import COLUMNS, HEADING, PITCH, PITCH_RATE, ROLL, Site, Truth

STEEPEST_PITCH_DEG = 89.0
"""Beyond, roll and heading rates lose their meaning."""
SAMPLES_A_PERIOD = 8.0
"""True states a period that Simpson's rule needs for the attitude and its squares (twice the frequency)."""
_TWO_PI = 2.0 * math.pi
_CHUNK = 256
_AXES = ("pitch", "roll", "heading")


class Oscillation(Parameters):
    """One angle's swing ``amplitude sin(2 pi frequency t + phase)`` about its mean."""

    amplitude_deg: float = quantity(
        0.0,
        unit="deg",
        ge=0.0,
        le=90.0,
        slider=(0.0, 20.0),
        label=Text("amplitude"),
        help=Text("Largest departure from the mean."),
    )
    frequency_hz: float = quantity(
        0.1,
        unit="Hz",
        ge=0.0,
        le=100.0,
        slider=(0.01, 0.25),
        label=Text("frequency"),
        help=Text("Swings a second; at most 1 / (4 x the step of the run): 0.25 Hz at 1 s."),
    )
    phase_deg: float = quantity(
        0.0,
        unit="deg",
        ge=-360.0,
        le=360.0,
        slider=(-180.0, 180.0),
        label=Text("phase"),
        help=Text("Phase at t = 0."),
    )

    @property
    def moving(self) -> bool:
        """True when the angle changes at all."""
        return self.amplitude_deg > 0.0 and self.frequency_hz > 0.0


class SwingMotion(AttitudeMotion):
    """The vehicle swings about a mean attitude at one place (Deng 2019, section 3: three-axis swing).

    Each angle is ``mean + amplitude sin(2 pi frequency t + phase)``; the means are pitch_deg, roll_deg and
    heading_deg.
    """

    kind: Literal["swing"] = "swing"
    pitch: Oscillation = Field(default=Oscillation(), description=Text("Swing about the mean pitch."))
    roll: Oscillation = Field(default=Oscillation(), description=Text("Swing about the mean roll."))
    heading: Oscillation = Field(default=Oscillation(), description=Text("Swing about the mean heading."))

    @model_validator(mode="after")
    def _upright(self) -> SwingMotion:
        room = STEEPEST_PITCH_DEG - abs(self.pitch_deg)
        if self.pitch.amplitude_deg > room + 1e-9:
            raise InputError(
                Fault(
                    "",
                    "pitch.amplitude_deg",
                    self.pitch.amplitude_deg,
                    Text(
                        "must be <= {room:g} (°) about a mean pitch of {pitch_deg:g}°: pitch stays "
                        "within +-{steepest_pitch_deg:g}°",
                        room=room,
                        pitch_deg=self.pitch_deg,
                        steepest_pitch_deg=STEEPEST_PITCH_DEG,
                    ),
                )
            )
        return self

    def truth(
        self, count: int, step_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> Truth:
        """Return the swing at times 0, step_s, ...; shape (count, 15), or (1, 15) when nothing moves.

        Raises
        ------
        InputError
            A swing is too fast for the step: fewer than 8 true states a period.
        """
        self._check_step(step_s)
        return Truth(step_s, self.rows(count, step_s, site, earth))

    def rows(
        self, count: int, step_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> np.ndarray:
        """Rows of truth at 0, step_s, ..., however long the step."""
        axes = (self.pitch, self.roll, self.heading)
        if not any(axis.moving for axis in axes):
            row = self.rest_row(site)
            for column, axis in zip((PITCH, ROLL, HEADING), axes, strict=True):
                row[0, column] += axis.amplitude_deg * DEG * math.sin(axis.phase_deg * DEG)
            return row
        values = np.empty((count, COLUMNS))
        _fill(self.rest_row(site)[0], self.packed(), float(step_s), values)
        return values

    def kinematics(
        self, end_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> Kinematics:
        """Return the place and the three oscillations."""
        return Kinematics(SWING, self.rest_row(site)[0], oscillations=self.packed())

    def before_start(self, true_row: np.ndarray, duration_s: float) -> MotionParameters:
        """Return the same swing, earlier: it ends in the phases of t = 0."""
        del true_row
        earlier = {}
        for name in _AXES:
            axis: Oscillation = getattr(self, name)
            phase = math.fmod(axis.phase_deg - 360.0 * math.fmod(axis.frequency_hz * duration_s, 1.0), 360.0)
            earlier[name] = axis.model_copy(update={"phase_deg": phase})
        return self.model_copy(update=earlier)

    def frequencies(self) -> Iterator[tuple[str, float]]:
        """Yield the frequency of each angle that moves."""
        for name in _AXES:
            axis: Oscillation = getattr(self, name)
            if axis.moving:
                yield f"{name}.frequency_hz", axis.frequency_hz

    def packed(self) -> np.ndarray:
        """Mean and amplitude (rad), frequency (Hz), phase (cycles) of pitch, roll, heading; shape (3, 4)."""
        means = (self.pitch_deg, self.roll_deg, self.heading_deg)
        axes = (self.pitch, self.roll, self.heading)
        return np.array(
            [
                [mean * DEG, axis.amplitude_deg * DEG, axis.frequency_hz, axis.phase_deg / 360.0]
                for mean, axis in zip(means, axes, strict=True)
            ]
        )

    def _check_step(self, step_s: float) -> None:
        fastest = 1.0 / (SAMPLES_A_PERIOD * step_s)
        faults = [
            Fault(
                "",
                f"{name}.frequency_hz",
                axis.frequency_hz,
                Text(
                    "must be <= {fastest:g} (Hz) with true states every {step_s:g} s (half a "
                    "step of the run): {samples_a_period:g} a period are needed; or make "
                    "run.step_s smaller",
                    fastest=fastest,
                    step_s=step_s,
                    samples_a_period=SAMPLES_A_PERIOD,
                ),
            )
            for name, axis in (("pitch", self.pitch), ("roll", self.roll), ("heading", self.heading))
            if axis.moving and axis.frequency_hz > fastest * (1.0 + 1e-9)
        ]
        if faults:
            raise InputError(faults)


@inlined
def oscillation_at(t, mean, amplitude, frequency, phase):
    """Angle (rad) and its rate (rad/s) of one axis at time t."""
    s, c = sincos_cycles(frequency * t + phase)
    return mean + amplitude * s, _TWO_PI * frequency * amplitude * c


@kernel
def _fill(rest, axes, step, out):
    """Write the swing at every time; ``rest`` gives the place.

    Works on chunks, an axis at a time with the times as floats: only so are sine and cosine vectorised.
    """
    number, angle, rate = np.empty(_CHUNK), np.empty((3, _CHUNK)), np.empty((3, _CHUNK))
    for i in range(_CHUNK):
        number[i] = i
    for first in range(0, out.shape[0], _CHUNK):
        rows = min(_CHUNK, out.shape[0] - first)
        before = float(first)
        for axis in range(3):
            mean, amplitude, frequency, phase = axes[axis, 0], axes[axis, 1], axes[axis, 2], axes[axis, 3]
            for i in range(rows):
                t = (before + number[i]) * step
                angle[axis, i], rate[axis, i] = oscillation_at(t, mean, amplitude, frequency, phase)
        for i in range(rows):
            for j in range(PITCH):
                out[first + i, j] = rest[j]
            for j in range(3):
                out[first + i, PITCH + j] = angle[j, i]
                out[first + i, PITCH_RATE + j] = rate[j, i]
