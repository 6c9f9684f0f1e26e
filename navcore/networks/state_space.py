"""A state-space form of a rational function that keeps its accuracy: a chain of small blocks, or their sum.

The poles stand on the diagonal as they are, repeated ones included, so nothing is lost that the companion
form loses; every block has unit DC gain, so all states have the size of the input.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

_SPREAD = 1e3
"""Factor by which the shares of a chain's states in its output must exceed those of partial fractions, that
these are taken: between fast zeros the shares of the chain cancel."""
_NEAR = 1e-6
"""Distance of two poles, relative to the largest, below which partial fractions lose more than they gain."""


@dataclass(frozen=True, eq=False)
class StateSpace:
    """x' = A x + B u, y = C x + D u with one input and one output, in normalised time.

    Attributes
    ----------
    A : ndarray, shape (n, n)
    B, C : ndarray, shape (n,)
    D : float
    """

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: float


def state_space(num: np.ndarray, poles: np.ndarray) -> StateSpace:
    """Realise num(p) / prod(p - pole) as a chain.

    The chain's blocks have the outputs X_k = U prod_(j<=k) s_j/q_j, with q_j the block's factor of the
    denominator and s_j its size at p = 0 (Newton's form of the partial fractions, finite for repeated poles).

    Parameters
    ----------
    num : ndarray, shape (m + 1,)
        Numerator, descending powers, m <= n.
    poles : ndarray of complex, shape (n,)
        Complex ones with their conjugates.
    """
    return state_spaces([num], poles)[0]


def state_spaces(nums: Sequence[np.ndarray], poles: np.ndarray) -> tuple[StateSpace, ...]:
    """Realise several outputs of the same states: as `state_space`, with one A and B for all.

    Parameters
    ----------
    nums : sequence of ndarray
        Numerators, as for `state_space`.
    poles : ndarray of complex, shape (n,)
        Complex ones with their conjugates.
    """
    blocks = _blocks(np.asarray(poles).tolist())
    chains = [_chain(num, blocks) for num in nums]
    parallels = [_parallel(num, blocks, chain.D) for num, chain in zip(nums, chains, strict=True)]
    good = [parallel for parallel in parallels if parallel is not None]
    if len(good) < len(chains):
        return tuple(chains)
    near = all(_spread(c) < _SPREAD * _spread(p) for c, p in zip(chains, good, strict=True))
    return tuple(chains if near else good)


def _chain(num: np.ndarray, blocks: list[list[complex]]) -> StateSpace:
    """Blocks in a row, each driven by the one before."""
    scales = [_scale(block) for block in blocks]
    order = sum(len(block) for block in blocks)
    A, B, C = np.zeros((order, order)), np.zeros(order), np.zeros(order)
    remainder, end = [float(c) for c in num], order
    for k in range(len(blocks) - 1, -1, -1):
        remainder, rest = _divide(remainder, _factor(blocks[k]))
        start = end - len(blocks[k])
        _fill(A, C, start, blocks[k], scales[k], rest, math.prod(scales[:k]))
        gain = scales[k] if len(blocks[k]) == 1 else math.sqrt(scales[k])
        if k == 0:
            B[end - 1] = gain
        else:  # driven by the state of the block before whose transfer is 1/q: its first one
            A[end - 1, start - len(blocks[k - 1])] = gain
        end = start
    return StateSpace(A, B, C, remainder[-1] if remainder else 0.0)


def _spread(system: StateSpace) -> float:
    """Largest share of a state in the output: all states have the size of the input."""
    return float(np.max(np.abs(system.C), initial=0.0))


def _parallel(num: np.ndarray, blocks: list[list[complex]], D: float) -> StateSpace | None:
    """Sum of partial fractions, a block each; None where poles are so near that there are none."""
    poles = np.array([pole for block in blocks for pole in block])
    apart = poles[:, None] - poles[None, :]
    np.fill_diagonal(apart, 1.0)
    if len(poles) == 0 or np.min(np.abs(apart)) <= _NEAR * np.max(np.abs(poles)):
        return None
    residues = np.polyval(num, poles) / np.prod(apart, axis=1)
    order = len(poles)
    A, B, C = np.zeros((order, order)), np.zeros(order), np.zeros(order)
    i = 0
    for block in blocks:
        size, residue, pole = abs(block[0]) or 1.0, residues[i], block[0]
        A[i, i], B[i], C[i] = pole.real, size, len(block) * residue.real / size
        if len(block) == 2:
            A[i + 1, i + 1], A[i, i + 1], A[i + 1, i] = pole.real, pole.imag, -pole.imag
            C[i + 1] = 2.0 * residue.imag / size
        i += len(block)
    return StateSpace(A, B, C, D)


def _factor(block: list[complex]) -> list[float]:
    """Coefficients of the block's monic factor after the leading one."""
    pole = block[0]
    return [-pole.real] if len(block) == 1 else [-2.0 * pole.real, pole.real**2 + pole.imag**2]


def _divide(num: list[float], factor: list[float]) -> tuple[list[float], list[float]]:
    """Quotient and remainder (as many coefficients as the factor has) of a division by a monic polynomial."""
    work, degree = list(num), len(factor)
    for i in range(len(work) - degree):
        for j, coefficient in enumerate(factor, start=1):
            work[i + j] -= work[i] * coefficient
    split = max(0, len(work) - degree)
    return work[:split], [0.0] * (degree - len(work)) + work[split:]


def _blocks(poles: list[complex]) -> list[list[complex]]:
    """Real poles alone, complex ones in pairs; slowest first."""
    poles = [complex(p) for p in poles]
    real = [[p] for p in poles if p.imag == 0.0]
    pairs = [[p, p.conjugate()] for p in poles if p.imag > 0.0]
    return sorted(real + pairs, key=lambda block: (abs(block[0]), abs(block[0].imag)))


def _scale(block: list[complex]) -> float:
    """DC value of the block's factor; 1 for a pole at zero."""
    value = abs(block[0]) ** len(block)
    return value if value > 0.0 else 1.0


def _fill(
    A: np.ndarray, C: np.ndarray, i: int, block: list[complex], scale: float, rest: list[float], before: float
) -> None:
    pole = block[0]
    if len(block) == 1:
        A[i, i] = pole.real
        C[i] = rest[0] / (scale * before)
        return
    r1, r0 = rest
    m = math.sqrt(scale)
    # x1 = m^2/q, x2 = m (p - re)/q: stays regular when the pair meets on the real axis
    A[i, i] = A[i + 1, i + 1] = pole.real
    A[i, i + 1] = m
    A[i + 1, i] = -pole.imag * (pole.imag / m)
    C[i + 1] = r1 / (m * before)
    C[i] = (r0 + r1 * pole.real) / (scale * before)
