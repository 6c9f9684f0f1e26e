"""Rates of a strapdown run: of the IMU, of the damping law and of the recorded states."""

from collections.abc import Iterator
from dataclasses import dataclass

from navcore.foundation.errors import Fault
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.motion.base import MotionParameters
from navcore.scenario.blocks import RunSettings
from navcore.sensors.reference import Reference

SAMPLES_A_PERIOD = 16.0
"""IMU samples in the shortest period of the motion: coning is quadratic in the motion and takes twice the 8
samples that the motion itself needs."""


@dataclass(frozen=True)
class Sampling:
    """Rates of a strapdown run.

    Attributes
    ----------
    rate_hz : float
        IMU samples per second.
    law_every : int
        IMU samples between two calls of the law.
    record_every : int
        IMU samples between two recorded states, a multiple of ``law_every``.
    records : int
        Intervals between recorded states in the run.
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
    """Choose the rates: states and calls of the law every ``step_s``, calls at the rate of a faster log.

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
    """Yield a fault of ``run.rate_hz`` for each part of the motion that the IMU samples too seldom."""
    for field, frequency in motion.frequencies():
        needed = SAMPLES_A_PERIOD * frequency
        if rate_hz < needed * (1.0 - 1e-9):
            allowed = Text(
                "is too low for the motion: must be >= {needed:g} (Hz), {samples_a_period:g} "
                "samples a period of motion.{field}, which is {frequency:g} Hz",
                needed=needed,
                samples_a_period=SAMPLES_A_PERIOD,
                field=field,
                frequency=frequency,
            )
            yield Fault("", "run.rate_hz", rate_hz, allowed)
