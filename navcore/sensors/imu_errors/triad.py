"""Three gyros or three accelerometers: what all terms of their errors add up to."""

import math
from collections.abc import Iterable

import numpy as np

from navcore.sensors.base import NO_DRIFT, modelled_drift
from navcore.sensors.imu_errors.base import Clock, Part
from navcore.sensors.imu_kernels import add_quantisation


class Triad:
    """Sum of the parts of three gyros or accelerometers, SI.

    Parameters
    ----------
    sensor : str
        "gyro" or "accel".
    parts : iterable of Part
        Those of the other sensor are left out.

    Attributes
    ----------
    white : float
        Random walk of the integral, (rad/s)/sqrt(Hz) or (m/s^2)/sqrt(Hz).
    coupling : ndarray, shape (3, 3)
        Error over the true signal.
    lsb : ndarray, shape (3,)
        One count of an increment, rad or m/s; 0 for none.
    """

    def __init__(self, sensor: str, parts: Iterable[Part]) -> None:
        self.sensor = sensor
        self._all = tuple(part for part in parts if part.sensor == sensor)
        self._parts = tuple(part for part in self._all if part.active)
        self.white = math.hypot(*(part.white for part in self._parts))
        self.coupling = sum((part.coupling for part in self._parts), np.zeros((3, 3)))
        self.lsb = sum((part.lsb for part in self._parts), np.zeros(3))

    @property
    def perfect(self) -> bool:
        """True when there is no error at all."""
        return not self._parts

    @property
    def measures_motion(self) -> bool:
        """True when the error depends on the true signal."""
        return bool(self.coupling.any() or self.lsb.any())

    @property
    def markov(self) -> tuple[float, float]:
        """Standard deviation and correlation time (s) of the drift that the stochastic model holds."""
        drift = modelled_drift(self._all)
        return NO_DRIFT if drift is None else drift.markov

    @property
    def constant(self) -> np.ndarray:
        """Constant errors that the scenario gives, shape (3,)."""
        return sum((part.constant for part in self._all), np.zeros(3))

    @property
    def deviation(self) -> np.ndarray:
        """Standard deviations of the constant errors, shape (3,)."""
        return np.sqrt(sum((part.deviation**2 for part in self._all), np.zeros(3)))

    def slow(self, clock: Clock) -> np.ndarray:
        """Return what changes slowly, held over each interval: rad/s or m/s^2, shape (count, 3) or (1, 3)."""
        error = sum((part.constant for part in self._parts), np.zeros((1, 3)))
        for part in self._parts:
            if part.markov[0] > 0.0:
                error = error + clock.drift(part.source, *part.markov)
            if part.shape is not None:
                error = error + part.shape(clock)
        return error

    def body_errors(self, signal: np.ndarray, clock: Clock) -> np.ndarray:
        """Return the mean errors in body axes, but for what is in proportion to the true signal.

        Parameters
        ----------
        signal : ndarray, shape (count, 3) or (1, 3)
            True mean over each interval, rad/s or m/s^2, which quantisation needs.
        clock : Clock
            The intervals.

        Returns
        -------
        ndarray, shape (count, 3), or (1, 3) when constant
        """
        error = self.slow(clock)
        if self.white > 0.0:
            amplitude = self.white / math.sqrt(clock.step_s)
            noise = np.multiply(clock.white_noise(self.sensor), amplitude, dtype=float)
            error = np.add(noise, error, out=noise)
        if self.lsb.any():
            error = np.array(np.broadcast_to(error, (clock.count, 3)), order="C")
            add_quantisation(signal, self.coupling, self.lsb, clock.step_s, error)
        return error
