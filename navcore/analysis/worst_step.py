"""The largest error that a log within 1 m/s can ever cause in one level channel (theory.md 21).

It is the total variation of the response to a step of the log's error: the integral of the impulse response's
magnitude, without an end of time.
"""

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from navcore.analysis.loop import analyse
from navcore.analysis.response import free_states, matrix_exponential
from navcore.analysis.transfers import Output, Transfer, normalised_transfer
from navcore.networks.base import ComplexArray, LinearNetwork
from navcore.networks.state_space import StateSpace, state_spaces

_OUTPUTS: tuple[Output, Output] = ("phi", "dv")
_STEP = 0.05
"""Step over the time constant of the fastest mode that is left."""
_BLOCK = 128
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
    tilt, velocity = (normalised_transfer(network, "dv_r", output) for output in _OUTPUTS)
    if np.array_equal(tilt.poles, velocity.poles) and np.any(tilt.num):
        return WorstStep(*_variations(network, (tilt, velocity)))
    return WorstStep(*_variations(network, (tilt,)), *_variations(network, (velocity,)))


def _variations(network: LinearNetwork, transfers: tuple[Transfer, ...]) -> tuple[float | None, ...]:
    """Total variations of transfers with the same poles."""
    if not any(np.any(one.num) for one in transfers):
        return (0.0,) * len(transfers)
    own = transfers[0].poles
    poles, loop = own.astype(np.complex128), analyse(network)
    if not loop.stable or loop.damping_ratio == 0.0 or np.max(poles.real, initial=-1.0) >= 0.0:
        return (None,) * len(transfers)
    systems = state_spaces([one.scale * one.num for one in transfers], own)
    return tuple(total_variations(systems, poles).tolist())


def total_variations(systems: Sequence[StateSpace], poles: ComplexArray) -> np.ndarray:
    """Total variations of the step responses of systems whose modes all decay, shape of ``systems``.

    Parameters
    ----------
    systems : sequence of StateSpace
        Of the same A and B, in normalised time.
    poles : ndarray of complex
        Of the systems.
    """
    total, tau = np.array([abs(float(one.D)) for one in systems]), 0.0
    A, state, C = systems[0].A, systems[0].B, np.stack([one.C for one in systems], axis=1)
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
        transition, integral = _over_step(A, step)
        states = free_states(transition, state, count + 1)
        added = np.abs(states[:-1] @ (integral.T @ C)).sum(axis=0)
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


def _over_step(A: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
    """e^(A t) after a step, and its integral over the step; shape (n, n) each."""
    n = len(A)
    both = np.zeros((2 * n, 2 * n))
    both[:n, :n], both[:n, n:] = A * step, np.eye(n) * step
    moved = matrix_exponential(both)
    return moved[:n, :n], moved[:n, n:]
