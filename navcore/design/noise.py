"""Covariance that the random processes add within one interval, for one set of coefficients.

A source is carried with three states of its own, the values of its drift on each axis (zero for white
noise), so that all six have the same shape: x first, then the drift.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from navcore.design.maps import ACCEL, GYRO, LOG, LoopModel, Map, call_map, calls_joined
from navcore.scenario.stochastic import RANDOM_SOURCES, StochasticModel

AXES = 3
_INPUTS = {"gyro": GYRO, "accel": ACCEL, "log": LOG}
INPUTS_OF = tuple(_INPUTS[source.split("_")[0]] for source in RANDOM_SOURCES)
"""Input columns of each random source."""


@dataclass(frozen=True, eq=False)
class Injection:
    """Joint map of errors and drifts, and the covariance that is added on the way; one for each source.

    Attributes
    ----------
    A, Q : ndarray, shape (6, n + 3, n + 3)
        In navigation axes.
    """

    A: np.ndarray
    Q: np.ndarray

    def then(self, later: Injection) -> Injection:
        """Return this piece followed by another."""
        return Injection(later.A @ self.A, later.A @ self.Q @ later.A.mT + later.Q)


def interval_noise(
    loop: LoopModel, model: StochasticModel, half: np.ndarray, calls: int, damped: bool
) -> Injection:
    """Covariance that each source adds within an interval of ``calls`` calls.

    Parameters
    ----------
    loop : LoopModel
        The method.
    model : StochasticModel
        The sources.
    half : ndarray, shape (1, COLUMNS)
        Coefficients.
    calls : int
        Calls of the law.
    damped : bool
        Whether the law acts.
    """
    fresh = _one_call(loop, model, call_map(loop, half, damped, fresh=True), fresh=True)

    def held() -> Injection:
        return _one_call(loop, model, call_map(loop, half, damped, fresh=False), fresh=False)

    return calls_joined(fresh, held, calls, loop.hold)


def _one_call(loop: LoopModel, model: StochasticModel, one: Map, fresh: bool) -> Injection:
    n = loop.states
    A, Q = np.zeros((2, len(RANDOM_SOURCES), n + AXES, n + AXES))
    samples = max(1.0, model.figures.log_rate_hz * loop.step_s)
    densities = {
        "gyro_white": model.figures.gyro_white**2 / loop.step_s,
        "accel_white": model.figures.accel_white**2 / loop.step_s,
        "log_white": model.loop_figures.log_noise**2 / samples if fresh else 0.0,
    }
    variances = {
        "gyro_drift": model.gyro_drift.sigma**2,
        "accel_drift": model.accel_drift.sigma**2,
        "log_drift": model.log_drift.sigma**2,
    }
    A[:, :n, :n] = one.Phi[0]
    for k, source in enumerate(RANDOM_SOURCES):
        columns = INPUTS_OF[k]
        width = columns.stop - columns.start
        drive = one.B[0][:, columns]
        if source in densities:
            Q[k, :n, :n] = densities[source] * drive @ drive.T
            continue
        left = one.decay[columns.start]
        own = range(n, n + width)
        A[k, :n, n : n + width] = drive
        A[k, own, own] = left
        Q[k, own, own] = variances[source] * (1.0 - left * left)
    return Injection(A, Q)
