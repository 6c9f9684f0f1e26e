"""The largest error that a log within 1 m/s can ever cause in one level channel (theory.md 21).

It is the total variation of the response to a step of the log's error: the integral of the impulse response's
magnitude, without an end of time.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from navcore.analysis.loop import analyse
from navcore.analysis.response import free_states, matrix_exponential
from navcore.analysis.transfers import Output, normalised_transfer
from navcore.networks.base import ComplexArray, LinearNetwork
from navcore.networks.state_space import StateSpace, state_space

_STEP = 0.03
"""Step over the time constant of the fastest mode that is left."""
_BLOCK = 256
_GONE = 1e-9
"""Size at which a mode counts as gone."""
_MOST_BLOCKS = 2000


class WorstStep(NamedTuple):
    """Largest errors of one level channel for a log within 1 m/s; None where there is no bound.

    Attributes
    ----------
    tilt_rad, velocity_mps : float or None
        For 1 m/s.
    """

    tilt_rad: float | None
    velocity_mps: float | None


@lru_cache(maxsize=256)
def worst_step(network: LinearNetwork) -> WorstStep:
    """Bound tilt and velocity error of one level channel under external damping.

    Parameters
    ----------
    network : LinearNetwork
        H(s).
    """
    loop = analyse(network)
    if not loop.stable or loop.damping_ratio == 0.0:
        return WorstStep(None, None)
    return WorstStep(_variation(network, "phi"), _variation(network, "dv"))


def _variation(network: LinearNetwork, output: Output) -> float | None:
    transfer = normalised_transfer(network, "dv_r", output)
    if not np.any(transfer.num):
        return 0.0
    poles = transfer.poles.astype(np.complex128)
    if np.max(poles.real, initial=-1.0) >= 0.0:
        return None
    return total_variation(state_space(transfer.scale * transfer.num, transfer.poles), poles)


def total_variation(system: StateSpace, poles: ComplexArray) -> float:
    """Total variation of the step response of a system whose modes all decay.

    Parameters
    ----------
    system : StateSpace
        In normalised time.
    poles : ndarray of complex
        Of the system.
    """
    total, tau = abs(float(system.D)), 0.0
    state = system.B
    for _ in range(_MOST_BLOCKS if len(state) else 0):
        left = poles[poles.real * tau > math.log(_GONE)]
        if not len(left):
            break
        slowest, period = float(np.min(np.abs(left.real))), _period_of_one(left)
        step = min(_STEP / float(np.max(np.abs(left))), 1.0 / slowest / _BLOCK)
        count = _BLOCK
        if period:
            count = max(_BLOCK, math.ceil(period / step))
            step = period / count
        states = free_states(matrix_exponential(system.A * step), state, count + 1)
        added = float(np.sum(np.abs(states[:-1] @ (system.C @ _integral(system.A, step)))))
        if period:
            return total + added / -math.expm1(-slowest * period)
        total, tau, state = total + added, tau + count * step, states[-1]
    return total


def _period_of_one(poles: ComplexArray) -> float:
    """Time after which all is as before times one factor: of a pole or a pair; 0 of several modes."""
    size = np.abs(poles)
    if len(poles) > 2 or np.ptp(size) > 1e-9 * np.max(size):
        return 0.0
    turn, decay = float(np.max(np.abs(poles.imag))), float(np.min(np.abs(poles.real)))
    return 2.0 * math.pi / turn if turn > 0.1 * decay else 1.0 / decay


def _integral(A: np.ndarray, step: float) -> np.ndarray:
    """Integral of e^(A t) over a step, shape (n, n)."""
    n = len(A)
    both = np.zeros((2 * n, 2 * n))
    both[:n, :n], both[:n, n:] = A * step, np.eye(n) * step
    return matrix_exponential(both)[:n, n:]
