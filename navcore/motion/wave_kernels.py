"""A ship in waves at the samples of a tile: its oscillations, component by component. Compiled."""

import numpy as np

from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.trigonometry import sincos_cycles
from navcore.motion.course import node_at, position_at
from navcore.motion.kinematics import FREQUENCY, PHASE, WIDTH
from navcore.motion.truth import (
    AU,
    HEADING,
    HEADING_RATE,
    HEIGHT,
    LAT,
    LON,
    PITCH,
    PITCH_RATE,
    ROLL,
    ROLL_RATE,
    VU,
)

# Columns of a component beside FREQUENCY and PHASE: angular frequency and its square, then real and imaginary
# parts of the answers in pitch, roll, heading and height.
OMEGA, OMEGA_SQUARED, REAL, IMAGINARY = 0, 1, 4, 8
COMPONENT_COLUMNS = 12
HEAVE = 3
"""Place of heave among the answers."""


@inlined
def _amplitudes(m, which, components, s, c):
    """Real and imaginary part of one answer, turned by a phase of sine s and cosine c."""
    real, imaginary = components[m, REAL + which], components[m, IMAGINARY + which]
    return real * c - imaginary * s, real * s + imaginary * c


@inlined
def _fill_quantity(m, components, s, c, turns, columns, row, rate_row, which, w):
    """Add one component of a quantity and of its rate, whose phase at the start has sine s and cosine c."""
    p, q = _amplitudes(m, which, components, s, c)
    rate_p, rate_q = components[m, OMEGA] * p, components[m, OMEGA] * q
    # Unsigned, or numba's care for negative indices keeps LLVM from vectorising.
    first, half = np.uint64(2 * m * WIDTH), np.uint64(WIDTH)
    for i in range(columns):
        ci, si = turns[first + np.uint64(i)], turns[first + half + np.uint64(i)]
        w[row * WIDTH + i] += p * ci - q * si
        w[rate_row * WIDTH + i] -= rate_q * ci + rate_p * si


@inlined
def _fill_vertical_acceleration(m, components, s, c, turns, columns, w):
    p, q = _amplitudes(m, HEAVE, components, s, c)
    p, q = components[m, OMEGA_SQUARED] * p, components[m, OMEGA_SQUARED] * q
    first, half = np.uint64(2 * m * WIDTH), np.uint64(WIDTH)
    for i in range(columns):
        w[AU * WIDTH + i] -= p * turns[first + np.uint64(i)] - q * turns[first + half + np.uint64(i)]


@inlined
def _restart_row(row, rest, columns, w):
    for i in range(columns):
        w[row * WIDTH + i] = rest[row]


@kernel
def fill_waves(t0, dt, components, turns, rest, nodes, place, columns, samples, w):
    """Fill the buffer ``w`` (`navcore.motion.kinematics.WIDTH`) with a ship in waves from t0 on.

    ``turns`` (2 m WIDTH,): cosine and sine of each component's angle after i steps; its phase is taken afresh
    at t0. ``place[1]`` is the number of the node reached, for the next call, which begins ``samples`` steps
    later. Horizontal velocity stays as it is.
    """
    node = place[1]
    for i in range(columns):
        t = t0 + i * dt
        node = node_at(t, nodes, node)
        if i == samples - 1:
            place[1] = node
        w[LAT * WIDTH + i], w[LON * WIDTH + i] = position_at(t, nodes, node)
    _restart_row(HEIGHT, rest, columns, w)
    _restart_row(VU, rest, columns, w)
    for row in range(AU, HEADING_RATE + 1):
        _restart_row(row, rest, columns, w)
    for m in range(components.shape[0]):
        s, c = sincos_cycles(components[m, FREQUENCY] * t0 + components[m, PHASE])
        _fill_quantity(m, components, s, c, turns, columns, PITCH, PITCH_RATE, 0, w)
        _fill_quantity(m, components, s, c, turns, columns, ROLL, ROLL_RATE, 1, w)
        _fill_quantity(m, components, s, c, turns, columns, HEADING, HEADING_RATE, 2, w)
        _fill_quantity(m, components, s, c, turns, columns, HEIGHT, VU, HEAVE, w)
        _fill_vertical_acceleration(m, components, s, c, turns, columns, w)
