"""The simulation loop over blocks of tiles: kinematics, signals, increments, errors; one for all motions."""

import numpy as np

from navcore.foundation.compiled import kernel
from navcore.motion.filling import fill_motion, fill_rest
from navcore.motion.kinematics import REST, SWING, WIDTH
from navcore.motion.truth import HEIGHT, LAT
from navcore.sensors.imu_simulation.corrupt import SUMS, add_sums, fill_errors, write_measured
from navcore.sensors.imu_simulation.signals import (
    fill_attitude,
    fill_increments,
    fill_navigation,
    fill_navigation_at_rest,
    fill_signals,
)
from navcore.sensors.imu_simulation.work import HALO, TILE, WORK, W, tile_number, tile_size

assert W == WIDTH


@kernel
def simulate_blocks(
    kind,
    first_block,
    blocks,
    block_samples,
    dt,
    rest,
    oscillations,
    turns,
    legs,
    nodes,
    attitude,
    place,
    e2,
    g_equator,
    k,
    flags,
    key,
    slow,
    white,
    coupling,
    lsb,
    left,
    measured,
    sums,
):
    """Measured increments of ``blocks`` blocks of ``block_samples`` each into ``measured`` (n, 6).

    ``kind`` to ``attitude``: the motion (`navcore.motion.kinematics.Kinematics`); ``turns``: its
    oscillations' turns in a tile; ``place`` (2,): legs and nodes reached; ``slow`` (blocks, 6); ``left``
    (6,): what quantisation carries over; ``sums`` (blocks, 6) or (0, 6).
    """
    w = np.zeros(WORK)
    fill_rest(rest, w)
    fill_navigation_at_rest(rest[LAT], rest[HEIGHT], e2, g_equator, k, w)
    if kind == REST:
        fill_attitude(W, w)
        fill_signals(W, w)
        fill_increments(TILE, dt, w)
    size = tile_size(block_samples)
    for n in range(blocks):
        block = first_block + n
        if flags & SUMS:
            sums[n, :] = 0.0
        for first in range(0, block_samples, size):
            samples = min(size, block_samples - first)
            columns = samples + HALO
            # Whole vectors: the rest of a row would otherwise be done one by one.
            padded = min(W, (columns + 7) // 8 * 8)
            t0 = (block * block_samples + first - 1) * dt
            fill_motion(
                kind, t0, dt, rest, oscillations, turns, legs, nodes, attitude, place, e2, columns, padded,
                samples, w,
            )  # fmt: skip
            if kind != REST:
                if kind != SWING:
                    fill_navigation(padded, e2, g_equator, k, w)
                fill_attitude(padded, w)
                fill_signals(padded, w)
                fill_increments(samples, dt, w)
            tile = tile_number(block, first // size)
            fill_errors(tile, samples, dt, flags, key, slow, n, white, coupling, lsb, left, w)
            write_measured(n * block_samples + first, samples, measured, w)
            if flags & SUMS:
                add_sums(n, samples, sums, w)
