"""Motion `waves`: a ship on a steady course that rolls, pitches, yaws and heaves in a seaway."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Literal

import numpy as np
from pydantic import model_validator

from navcore.foundation.earth import Earth
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.parameters import Parameters, quantity
from navcore.foundation.text import Text
from navcore.foundation.units import DEG
from navcore.motion.base import MotionParameters
from navcore.motion.course import PoleReached, lay_course
from navcore.motion.filling import sample
from navcore.motion.kinematics import FREQUENCY, WAVES, Kinematics
from navcore.motion.sea import ship_motion
from navcore.motion.sea_fields import ANSWERS, AnswerFields, SeaFields
from navcore.motion.static import AttitudeMotion
from navcore.motion.swing import SAMPLES_A_PERIOD, STEEPEST_PITCH_DEG
from navcore.motion.truth import VE, VN, Site, Truth
from navcore.motion.wave_kernels import COMPONENT_COLUMNS, IMAGINARY, OMEGA, OMEGA_SQUARED, REAL


class _Way(Parameters):
    speed_mps: float = quantity(
        0.0,
        unit="m/s",
        ge=0.0,
        le=50.0,
        slider=(0.0, 15.0),
        label=Text("speed"),
        help=Text("Speed along the mean heading; it changes the frequency at which the waves are met."),
    )


class WavesMotion(AnswerFields, _Way, SeaFields, AttitudeMotion):
    """A ship on a steady course in a seaway: it rolls, pitches, yaws and heaves.

    The seaway is a sum of long-crested waves on deep water, drawn from ``seed``; its significant height is
    exact, its components share the spectrum between 0.5 and 3 times the peak frequency. Each motion answers
    as a second-order system, at the frequency of encounter: pitch to the slope of the waves along the ship,
    roll to the slope across, heading to both (largest in quartering seas), heave to the elevation. The means
    are ``pitch_deg``, ``roll_deg`` and ``heading_deg``, which is the course as well. Heave is a vertical
    velocity and a change of height about the site's. Everything is a closed formula of time but the position
    (as in `legs`).
    """

    kind: Literal["waves"] = "waves"

    @model_validator(mode="after")
    def _upright(self) -> WavesMotion:
        self.require_upright()
        return self

    def require_upright(self) -> None:
        """Refuse waves in which the pitch could pass its limit; raises `InputError`."""
        swing = np.hypot(*self._answers(0)).sum() / DEG
        room = STEEPEST_PITCH_DEG - abs(self.pitch_deg)
        if swing > room:
            raise InputError(
                Fault(
                    "",
                    "height_m",
                    self.height_m,
                    Text(
                        "pitch could reach {swing:.0f}° about a mean of {pitch_deg:g}°: must stay "
                        "within +-{steepest_pitch_deg:g}°; make height_m or pitch_gain smaller",
                        swing=swing,
                        pitch_deg=self.pitch_deg,
                        steepest_pitch_deg=STEEPEST_PITCH_DEG,
                    ),
                )
            )

    def packed(self) -> np.ndarray:
        """Components of the ship's motion, shape (n, 12), columns OMEGA ... IMAGINARY + 3; SI, Hz, cycles."""
        pitch, roll, heading, heave = self.answers()
        omega, complex_answers = ship_motion(
            self.seaway(),
            self.speed_mps,
            self.heading_deg * DEG,
            pitch=pitch,
            roll=roll,
            yaw=heading,
            heave=heave,
        )
        packed = np.zeros((self.components, COMPONENT_COLUMNS))
        packed[:, OMEGA], packed[:, OMEGA_SQUARED] = omega, omega**2
        packed[:, FREQUENCY] = omega / (2.0 * math.pi)
        packed[:, REAL : REAL + 4] = np.real(complex_answers)
        packed[:, IMAGINARY : IMAGINARY + 4] = np.imag(complex_answers)
        return packed

    def truth(
        self, count: int, step_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> Truth:
        """Return the true motion at ``count`` times 0, step_s, ...; shape (count, 15), or (1, 15) at rest.

        Raises
        ------
        InputError
            The ship moves too fast for the step (fewer than 8 true states a mean period), or leads beyond
            89.5 deg of latitude.
        """
        self.check_step(step_s)
        return Truth(step_s, self.rows(count, step_s, site, earth))

    def rows(
        self, count: int, step_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> np.ndarray:
        """Rows of truth at 0, step_s, ..., however long the step."""
        kin = self.kinematics(max(count - 1, 1) * step_s, site, earth, start_utc)
        if self.speed_mps == 0.0 and not kin.oscillations[:, REAL:].any():
            return kin.rest[None, :].copy()
        return sample(kin, count, step_s, earth)

    def kinematics(
        self, end_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> Kinematics:
        """Return the components, the steady velocity (in the row at rest) and the position nodes."""
        del start_utc
        rest, heading = self.rest_row(site)[0], self.heading_deg * DEG
        rest[VE], rest[VN] = self.speed_mps * math.sin(heading), self.speed_mps * math.cos(heading)
        leg = np.array([[0.0, self.speed_mps, 0.0, 0.0, heading, 0.0, 0.0, 0.0]])
        try:
            nodes = lay_course(leg, end_s, site, earth).nodes
        except PoleReached as reached:
            raise InputError(
                Fault(
                    "",
                    "speed_mps",
                    self.speed_mps,
                    Text(
                        "the course passes 89.5° of latitude after {time_s:.0f} s: must stay within +-89.5°",
                        time_s=reached.time_s,
                    ),
                )
            ) from None
        return Kinematics(WAVES, rest, oscillations=self.packed(), nodes=nodes)

    def before_start(self, true_row: np.ndarray, duration_s: float) -> MotionParameters:
        """Return the ship stopped in the same sea."""
        return self.model_copy(update={"speed_mps": 0.0})

    def frequencies(self) -> Iterator[tuple[str, float]]:
        """Yield the frequency of the shortest wave met."""
        if self.height_m > 0.0:
            yield "peak_period_s", float(self.packed()[:, FREQUENCY].max())

    def _answers(self, which: int) -> tuple[np.ndarray, np.ndarray]:
        packed = self.packed()
        return packed[:, REAL + which], packed[:, IMAGINARY + which]

    def check_step(self, step_s: float) -> None:
        """Refuse fewer than 8 true states a mean period; raises `InputError`."""
        packed = self.packed()
        energy = packed[:, REAL : REAL + 4] ** 2 + packed[:, IMAGINARY : IMAGINARY + 4] ** 2
        moving = energy.sum(axis=0) > 0.0
        if not moving.any():
            return
        mean_square = packed[:, OMEGA_SQUARED] @ energy[:, moving] / energy[:, moving].sum(axis=0)
        periods = 2.0 * math.pi / np.sqrt(mean_square)
        shortest = int(np.argmin(periods))
        if periods[shortest] < SAMPLES_A_PERIOD * step_s * (1.0 - 1e-9):
            name = [answer for answer, moves in zip(ANSWERS, moving, strict=True) if moves][shortest]
            raise InputError(
                Fault(
                    "",
                    "peak_period_s",
                    self.modal_period_s,
                    Text(
                        "the mean period of {name} at this course and speed is {periods:.1f} s: must "
                        "be >= {samples_a_period:g} s with true states every {step_s:g} s (half a "
                        "step of the run); or make run.step_s smaller",
                        name=name,
                        periods=periods[shortest],
                        samples_a_period=SAMPLES_A_PERIOD * step_s,
                        step_s=step_s,
                    ),
                )
            )
