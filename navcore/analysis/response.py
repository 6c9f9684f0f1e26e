"""Time responses by the matrix exponential, in normalised time; nothing here minds repeated poles."""

import numpy as np

from navcore.networks.state_space import StateSpace

_TAYLOR_TERMS = 13
_SMALL = 0.25


def matrix_exponential(matrices: np.ndarray) -> np.ndarray:
    """Exponential of one matrix or a stack, shape (..., n, n), by scaling, Taylor series and squaring."""
    norm = float(np.max(np.sum(np.abs(matrices), axis=-1), initial=0.0))
    squarings = max(0, int(np.ceil(np.log2(norm / _SMALL)))) if norm > 0.0 else 0
    result = _series_minus_identity(matrices / 2.0**squarings)
    for _ in range(squarings):
        result = 2.0 * result + result @ result
    return result + np.eye(matrices.shape[-1])


def _series_minus_identity(small: np.ndarray) -> np.ndarray:
    """Taylor series of e^M - 1 for a norm up to `_SMALL`."""
    identity = np.eye(small.shape[-1])
    result = identity
    for term in range(_TAYLOR_TERMS, 1, -1):
        result = identity + small @ result / term
    return small @ result


class ExponentialLadder:
    """e^(A end/2^k) for k = 0 .. levels from one series and squarings.

    Kept as e^M - 1, so that the small ones lose nothing next to the identity.

    Parameters
    ----------
    A : ndarray, shape (n, n)
    end : float
        Longest time.
    levels : int
        Depth; more are added when the shortest step is too long for the series.
    """

    def __init__(self, A: np.ndarray, end: float, levels: int) -> None:
        norm = float(np.max(np.sum(np.abs(A), axis=-1))) * end
        depth = max(levels, int(np.ceil(np.log2(norm / _SMALL)))) if norm > 0.0 else levels
        rung = _series_minus_identity(A * (end / 2.0**depth))
        rungs = [rung]
        for _ in range(depth):
            rung = 2.0 * rung + rung @ rung
            rungs.append(rung)
        self._rungs = rungs[::-1]
        self._identity = np.eye(len(A))

    def minus_identity(self, level: int) -> np.ndarray:
        """e^(A end/2^level) - 1."""
        return self._rungs[level]

    def states(self, start: np.ndarray, level: int, grid: int) -> np.ndarray:
        """States after 0 .. 2^grid steps of length end/2^level by doubling, shape (2^grid + 1, n)."""
        states = start[None, :]
        for doubling in range(grid):
            transition = self._identity + self._rungs[level - doubling]
            states = np.concatenate([states, states @ transition.T])
        beyond = (self._identity + self._rungs[level - grid]) @ start
        return np.concatenate([states, beyond[None, :]])


def free_states(transition: np.ndarray, start: np.ndarray, count: int) -> np.ndarray:
    """States x_0 .. x_(count-1) of x_(k+1) = transition x_k, shape (count, n), by doubling the block."""
    states = start[None, :]
    power = transition
    while len(states) < count:
        states = np.concatenate([states, states @ power.T])
        power = power @ power
    return states[:count]


def impulse_response(system: StateSpace, tau: np.ndarray) -> np.ndarray:
    """C e^(A tau) B at normalised times, shape of ``tau``; fastest on an even grid."""
    return _propagate(system.A, system.B, system.C, np.asarray(tau, dtype=float))


def step_response(system: StateSpace, tau: np.ndarray) -> np.ndarray:
    """Response to a unit step at tau = 0, shape of ``tau``."""
    n = len(system.B)
    augmented = np.zeros((n + 1, n + 1))
    augmented[:n, :n], augmented[:n, n] = system.A, system.B
    start = np.zeros(n + 1)
    start[n] = 1.0
    return _propagate(augmented, start, np.append(system.C, system.D), np.asarray(tau, dtype=float))


def _propagate(A: np.ndarray, start: np.ndarray, C: np.ndarray, tau: np.ndarray) -> np.ndarray:
    times = tau.reshape(-1)
    if len(A) == 0 or len(times) == 0:
        return np.zeros(tau.shape)
    steps = np.diff(times)
    even = len(times) > 2 and np.ptp(steps) <= 1e-12 * np.max(np.abs(times)) * 4.0
    if even:
        first = matrix_exponential(A * times[0]) @ start
        transition = matrix_exponential(A * ((times[-1] - times[0]) / len(steps)))
        return (free_states(transition, first, len(times)) @ C).reshape(tau.shape)
    return (matrix_exponential(A * times[:, None, None]) @ start @ C).reshape(tau.shape)
