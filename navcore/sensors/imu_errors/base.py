"""The terms of an inertial sensor's error: what each one adds to readings, covariance and alignment."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np

from navcore.foundation.parameters import Parameters
from navcore.sensors.base import ErrorPart
from navcore.sensors.noise import gauss_markov, unit_noise


@dataclass(frozen=True)
class Clock:
    """Equal intervals over which errors are simulated.

    Attributes
    ----------
    step_s : float
        Length of an interval, s.
    count : int
        Number of intervals.
    seed : int
        Seed of the random numbers.
    begin_s : float
        Time at which the first interval begins, s after the start of navigation.
    record : bool
        True for the record before t = 0 whose errors continue those of the navigation back in time.
    """

    step_s: float
    count: int
    seed: int
    begin_s: float = 0.0
    record: bool = False

    @property
    def middle_s(self) -> np.ndarray:
        """Time at the middle of each interval, s after the start of navigation, shape (count,)."""
        return self.begin_s + (np.arange(self.count) + 0.5) * self.step_s

    def white_noise(self, sensor: str) -> np.ndarray:
        """Unit white noise of three gyros or accelerometers, float32, shape (count, 3)."""
        stream = f"{sensor}.alignment.white" if self.record else f"{sensor}.white"
        return unit_noise(self.seed, stream, self.count, 3)

    def drift(self, source: str, sigma: float, tau_s: float) -> np.ndarray:
        """Gauss-Markov drift, stationary from the start and held over each interval, shape (count, 3).

        In the record before t = 0 it goes back in time from its value there.
        """
        stream = source.replace("_drift", "")
        if self.record:
            first = unit_noise(self.seed, f"{stream}.instability", 1, 3)
            before = unit_noise(self.seed, f"{stream}.alignment.instability", self.count, 3)
            unit = np.concatenate([first, before])
            unit.flags.writeable = False  # as all drawn numbers: else numba compiles the kernel once more
        else:
            unit = unit_noise(self.seed, f"{stream}.instability", self.count, 3)
        drift = gauss_markov(unit, math.exp(-self.step_s / tau_s))
        return np.multiply(drift[:0:-1] if self.record else drift, sigma, dtype=float)


@dataclass(frozen=True, eq=False)
class Part(ErrorPart):
    """Contribution of one term to the errors of three gyros or accelerometers: rad/s or m/s^2, body axes.

    Attributes
    ----------
    coupling : ndarray, shape (3, 3)
        Error over the true signal: the error is ``coupling @ true``.
    shape : callable, optional
        Mean over each interval of an error that changes with time: takes a `Clock`, returns (count, 3).
    """

    coupling: np.ndarray = field(default_factory=lambda: np.zeros((3, 3)))
    shape: Callable[[Clock], np.ndarray] | None = None

    @property
    def has_shape(self) -> bool:
        """Whether the error budget knows it by the numbers of the scenario as they stand."""
        return self.shape is not None or bool(self.coupling.any())


class ImuTerm(Parameters):
    """Base of the terms: fields of the block ``imu``, and the parts that they make."""

    @abstractmethod
    def parts(self) -> Iterator[Part]:
        """Yield the part of the gyros and that of the accelerometers, as far as the term has both."""
