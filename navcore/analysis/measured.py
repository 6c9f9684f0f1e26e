"""Gain and phase of a discrete network, measured: it is driven with sines and its output is fitted."""

import math

import numpy as np

from navcore.networks.base import ComplexArray
from navcore.networks.discrete import DiscreteNetwork

BLOCK = 64
"""Steps carried out at once."""
MOST_STEPS = 400_000
_TIME_CONSTANTS = 14.0
"""After so many of the slowest pole's time constants its transient is below 1e-6."""


def measured_response(discrete: DiscreteNetwork, omega: np.ndarray) -> ComplexArray | None:
    """Complex gain at ``omega`` of the recursion x += dA x + B u, y = C x + D u, found by driving it.

    All sines start at once from rest; when the transient has died away the output of one period of the
    slowest sine is fitted with a sine, a cosine and a constant. `BLOCK` steps are carried out at once, with
    matrices that come from stepping the recursion itself.

    Parameters
    ----------
    discrete : DiscreteNetwork
        From `navcore.networks.discrete.discretise`.
    omega : ndarray, shape (k,)
        Frequencies, rad/s, above 0 and below pi / step.

    Returns
    -------
    ndarray of complex, shape (k,), or None
        None when the network never comes to rest, or not within `MOST_STEPS`.
    """
    omega = np.asarray(omega, dtype=float)
    settle = _settling_steps(discrete)
    span = math.ceil(2.0 * math.pi / float(np.min(omega)) / discrete.step_s)
    if settle is None or settle + span > MOST_STEPS:
        return None
    first = -(-settle // BLOCK)
    blocks = first + -(-span // BLOCK)
    angle = omega * discrete.step_s
    steps = np.arange(BLOCK)
    free, driven, transition, entry = _block(discrete)
    turn, sines = np.exp(1j * angle * BLOCK), np.exp(1j * np.outer(steps, angle))
    state = np.zeros((discrete.order, len(omega)))
    outputs = np.empty((blocks - first, BLOCK, len(omega)))
    inputs = np.empty((blocks - first, BLOCK, len(omega)), dtype=np.complex128)
    phase = np.ones(len(omega), dtype=np.complex128)
    for block in range(blocks):
        wave = sines * phase
        u = wave.imag
        if block >= first:
            outputs[block - first] = free @ state + driven @ u
            inputs[block - first] = wave
        state = state + transition @ state + entry @ u
        phase = phase * turn
        phase /= np.abs(phase)
    rows = outputs.shape[0] * BLOCK
    return _fitted(inputs.reshape(rows, -1), outputs.reshape(rows, -1))


def _settling_steps(discrete: DiscreteNetwork) -> int | None:
    if discrete.order == 0:
        return 0
    size = np.abs(1.0 + np.linalg.eigvals(discrete.dA))
    slowest = float(np.max(size))
    if slowest >= 1.0 - 1e-9:
        return None
    return math.ceil(-_TIME_CONSTANTS / math.log(slowest)) if slowest > 0.0 else discrete.order


def _block(discrete: DiscreteNetwork) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Outputs and last state of `BLOCK` steps for unit states and unit pulses (transition less identity)."""
    order = discrete.order
    x = np.eye(order)
    free = np.empty((BLOCK, order))
    pulse = np.zeros((BLOCK, order))  # state k steps after a pulse, k = 1 ..
    hit = discrete.B.copy()
    for k in range(BLOCK):
        free[k] = discrete.C @ x
        x = x + discrete.dA @ x
        pulse[k] = hit
        hit = hit + discrete.dA @ hit
    late = pulse @ discrete.C
    driven = np.zeros((BLOCK, BLOCK))
    for k in range(BLOCK):
        driven[k, k] = discrete.D
        driven[k, :k] = late[:k][::-1]
    return free, driven, x - np.eye(order), pulse[::-1].T


def _fitted(inputs: ComplexArray, outputs: np.ndarray) -> ComplexArray:
    """Gain of each column by least squares on sine, cosine and a constant."""
    gains = np.empty(outputs.shape[1], dtype=np.complex128)
    for k in range(outputs.shape[1]):
        sine, cosine = inputs[:, k].imag, inputs[:, k].real
        table = np.stack([sine, cosine, np.ones(len(sine))], axis=1)
        normal, right = table.T @ table, table.T @ outputs[:, k]
        a, b, _ = np.linalg.solve(normal, right)
        gains[k] = complex(a, b)
    return gains
