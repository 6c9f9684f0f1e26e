"""How a strapdown run is sampled: the IMU's rate, how often the law is asked and a state is recorded."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from navcore.errors import Fault
from navcore.motion.base import MotionParameters
from navcore.motion.course import COURSE_TIME, SPEED_TIME
from navcore.motion.kinematics import FREQUENCY
from navcore.motion.legs import LegsMotion
from navcore.motion.swing import SwingMotion
from navcore.motion.waves import WavesMotion
from navcore.units import HOUR

if TYPE_CHECKING:
    from navcore.scenario import RunSettings
    from navcore.sensors.reference import Reference

SAMPLES_A_PERIOD = 16.0
"""IMU samples that one period of the motion needs: 8 would do for the truth, coning needs its squares."""


@dataclass(frozen=True)
class Sampling:
    """Rates of a strapdown run.

    Attributes
    ----------
    rate_hz : float
        Samples of the IMU a second.
    law_every : int
        Samples between two calls of the law.
    record_every : int
        Samples between two recorded states, a multiple of ``law_every``.
    records : int
        Recorded intervals of the run.
    """

    rate_hz: float
    law_every: int
    record_every: int
    records: int

    @property
    def samples(self) -> int:
        """IMU samples of the run."""
        return self.records * self.record_every

    @property
    def law_step_s(self) -> float:
        """Time between two calls of the law, s."""
        return self.law_every / self.rate_hz

    @property
    def record_step_s(self) -> float:
        """Time between two recorded states, s: the grid of metrics, plots and output rows."""
        return self.record_every / self.rate_hz

    @property
    def duration_s(self) -> float:
        """Length of the run, s."""
        return self.records * self.record_step_s


def sampling(run: RunSettings, reference: Reference, rate_hz: float | None = None) -> Sampling:
    """Choose the rates: states every ``step_s``; the law every ``step_s``, or as often as a faster log.

    Parameters
    ----------
    run : RunSettings
        Its ``step_s`` is rounded to whole samples.
    reference : Reference
        A simulated log faster than the step is read at its own rate.
    rate_hz : float, optional
        Of a recorded IMU; default ``run.rate_hz``.
    """
    rate = run.rate_hz if rate_hz is None else rate_hz
    record_every = max(1, round(rate * run.step_s))
    wanted = record_every
    if reference.kind == "log":
        wanted = max(1, min(record_every, int(rate / reference.rate_hz + 1e-9)))
    law_every = next(n for n in range(wanted, 0, -1) if record_every % n == 0)
    records = int(run.duration_h * HOUR * rate / record_every + 1e-9)
    return Sampling(rate, law_every, record_every, records)


def rate_faults(motion: MotionParameters, rate_hz: float) -> Iterator[Fault]:
    """Say that the IMU's rate is too low for a swing or a change of course or speed, naming the field."""
    for what, frequency in _frequencies(motion):
        needed = SAMPLES_A_PERIOD * frequency
        if rate_hz < needed * (1.0 - 1e-9):
            yield Fault(
                "", "run.rate_hz", rate_hz,
                f"is too low for the motion: must be >= {needed:g} (Hz), {SAMPLES_A_PERIOD:g} samples a "
                f"period of {what}, which is {frequency:g} Hz",
            )  # fmt: skip


def _frequencies(motion: MotionParameters) -> Iterator[tuple[str, float]]:
    """What moves in a motion, with the field's name, and the frequency of it, Hz."""
    if isinstance(motion, SwingMotion):
        for name, axis in (("pitch", motion.pitch), ("roll", motion.roll), ("heading", motion.heading)):
            if axis.moving:
                yield f"motion.{name}.frequency_hz", axis.frequency_hz
    elif isinstance(motion, LegsMotion):
        for number, row in enumerate(motion.table()):
            times = [time for time in (row[SPEED_TIME], row[COURSE_TIME]) if time > 0.0]
            if times:
                yield f"motion.leg.{number}", 1.0 / min(times)
    elif isinstance(motion, WavesMotion) and motion.height_m > 0.0:
        yield "the shortest wave met (motion.peak_period_s)", float(motion.packed()[:, FREQUENCY].max())
