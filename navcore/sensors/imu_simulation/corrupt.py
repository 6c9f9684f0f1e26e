"""From perfect to measured increments: the IMU's errors, one tile at a time. Compiled."""

import numpy as np

from navcore.foundation.compiled import inlined
from navcore.sensors.imu_simulation.normal import fill_normals
from navcore.sensors.imu_simulation.work import ERR, HALF_NORMALS, INC, NORMAL, C, W

# Flags of what there is to do.
NOISE, COUPLING, COUNTS, SUMS = 1, 2, 4, 8


@inlined
def _fill_error(j, first, samples, flags, constant, white, coupling, w):
    """Errors of sensor j, whose three axes begin at row INC + first."""
    x, y, z = INC + first, INC + first + 1, INC + first + 2
    kx, ky, kz = coupling[j, 0], coupling[j, 1], coupling[j, 2]
    for i in range(samples):
        w[(ERR + j) * W + i] = constant
    if flags & COUPLING:
        for i in range(samples):
            w[(ERR + j) * W + i] += kx * w[x * W + i] + ky * w[y * W + i] + kz * w[z * W + i]
    if flags & NOISE:
        unit = NORMAL * W + (HALF_NORMALS if j >= 3 else 0) + (j % 3) * samples
        for i in range(samples):
            w[(ERR + j) * W + i] += white * w[unit + i]


@inlined
def _count(j, samples, lsb, left, w):
    """Quantise with carry: the rest of a count goes into the next increment. Return what is left over."""
    if lsb == 0.0:
        return left
    inverse, total, before = 1.0 / lsb, left, 0.0
    for i in range(samples):
        total += w[(INC + j) * W + i] + w[(ERR + j) * W + i]
        counts = np.floor(total * inverse + 0.5)
        w[(ERR + j) * W + i] = lsb * (counts - before) - w[(INC + j) * W + i]
        before = counts
    return total - lsb * before


@inlined
def _summed(a, b, row, first, samples, w):
    """Sum over the tile of one navigation component of the errors, at the attitude amid each interval."""
    x, y, z = first * W, (first + 1) * W, (first + 2) * W
    total = 0.0
    for i in range(samples):
        u = (w[row * W + i + a] + w[row * W + i + b]) * w[x + i]
        v = (w[(row + 1) * W + i + a] + w[(row + 1) * W + i + b]) * w[y + i]
        total += u + v + (w[(row + 2) * W + i + a] + w[(row + 2) * W + i + b]) * w[z + i]
    return 0.5 * total


@inlined
def fill_errors(place, samples, dt, flags, key, slow, block, white, coupling, lsb, left, w):
    """Errors of a tile's increments.

    Row ``block`` of ``slow`` (n, 6): rad/s, m/s^2; ``white`` (6,): random walk times
    sqrt(dt); ``coupling`` (6, 3); ``lsb``, ``left`` (6,): rad, m/s.
    """
    if flags & NOISE:
        fill_normals(place, key, (3 * samples + 7) // 8 * 8, w)
    _fill_error(0, 0, samples, flags, slow[block, 0] * dt, white[0], coupling, w)
    _fill_error(1, 0, samples, flags, slow[block, 1] * dt, white[1], coupling, w)
    _fill_error(2, 0, samples, flags, slow[block, 2] * dt, white[2], coupling, w)
    _fill_error(3, 3, samples, flags, slow[block, 3] * dt, white[3], coupling, w)
    _fill_error(4, 3, samples, flags, slow[block, 4] * dt, white[4], coupling, w)
    _fill_error(5, 3, samples, flags, slow[block, 5] * dt, white[5], coupling, w)
    if flags & COUNTS:
        for j in range(6):
            left[j] = _count(j, samples, lsb[j], left[j], w)


@inlined
def write_measured(start, samples, measured, w):
    """Perfect increments plus errors into rows ``start``, ... of ``measured`` (n, 6)."""
    flat = measured[start : start + samples].reshape(-1)
    # Written out: three times as fast as a loop over the six.
    for i in range(samples):
        flat[6 * i] = w[INC * W + i] + w[ERR * W + i]
        flat[6 * i + 1] = w[(INC + 1) * W + i] + w[(ERR + 1) * W + i]
        flat[6 * i + 2] = w[(INC + 2) * W + i] + w[(ERR + 2) * W + i]
        flat[6 * i + 3] = w[(INC + 3) * W + i] + w[(ERR + 3) * W + i]
        flat[6 * i + 4] = w[(INC + 4) * W + i] + w[(ERR + 4) * W + i]
        flat[6 * i + 5] = w[(INC + 5) * W + i] + w[(ERR + 5) * W + i]


@inlined
def add_sums(block, samples, sums, w):
    """Add the tile's errors, turned to the navigation frame, to row ``block`` of ``sums`` (n, 6)."""
    for j in range(2):
        first = ERR + 3 * j
        sums[block, 3 * j] += _summed(1, 2, C, first, samples, w)
        sums[block, 3 * j + 1] += _summed(1, 2, C + 3, first, samples, w)
        sums[block, 3 * j + 2] += _summed(1, 2, C + 6, first, samples, w)
