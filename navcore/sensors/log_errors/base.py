"""The terms of a log's error: what each one adds to a sample and to the covariance."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from navcore.foundation.parameters import Parameters
from navcore.sensors.base import ErrorPart


@dataclass(frozen=True, eq=False)
class LogPart(ErrorPart):
    """Contribution of one term to the readings of the simulated log, m/s, in the log's own axes.

    Attributes
    ----------
    scale : float
        Relative error of the measured velocity.
    acceleration_s : float
        Error by the ship's acceleration, s.
    turn_s : float
        Error across the course by yaw rate times speed, s.
    delay_s : float
        Age of the velocity that is measured, s.
    smoothing_s : float
        Time constant of the first-order filter that smooths the measured velocity, s.
    water : callable, optional
        Velocity of the water over the ground, E and N: takes times (m,), returns (m, 2) or (1, 2).
    after : callable, optional
        Error of the finished reading, E and N: takes times (m,), returns (m, 2) or (1, 2).
    """

    scale: float = 0.0
    acceleration_s: float = 0.0
    turn_s: float = 0.0
    delay_s: float = 0.0
    smoothing_s: float = 0.0
    water: Callable[[np.ndarray], np.ndarray] | None = None
    after: Callable[[np.ndarray], np.ndarray] | None = None

    @property
    def has_shape(self) -> bool:
        """Whether the error budget knows it by the numbers of the scenario as they stand."""
        seconds = self.acceleration_s, self.turn_s, self.delay_s, self.smoothing_s
        return any((self.scale, *seconds, self.water, self.after))

    def smoothed(self, tau_s: float, interval_s: float) -> LogPart:
        """Return the part behind a filter y_k = e y_(k-1) + (1 - e) x_k with e = exp(-interval / tau).

        Of white samples of standard deviation sigma it makes a Gauss-Markov process of the correlation time
        tau and sigma sqrt(tanh(interval / (2 tau))); constant errors and slow drift pass it. The velocity is
        smoothed where it is read. ``tau_s`` is 0 for no filter.
        """
        if tau_s == 0.0 or self.white == 0.0:
            return self
        sigma = self.white * math.sqrt(math.tanh(0.5 * interval_s / tau_s))
        return replace(self, white=0.0, markov=(sigma, tau_s))


class LogTerm(Parameters):
    """Base of the terms: fields of the block ``reference``, and the parts that they make."""

    @abstractmethod
    def parts(self) -> Iterator[LogPart]:
        """Yield the parts."""
