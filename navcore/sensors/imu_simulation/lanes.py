"""Increments of several IMUs on one motion, side by side: the motion is evaluated once for all of them."""

from collections.abc import Iterator, Sequence

import numpy as np

from navcore.foundation.compiled import kernel
from navcore.sensors.imu_simulation.corrupt import fill_errors, write_measured
from navcore.sensors.imu_simulation.simulation import ImuSimulation
from navcore.sensors.imu_simulation.work import INC, WORK, W, tile_number, tile_size

_LAID = 512
"""Samples that are laid side by side at once, at least one block: 0.4 MB, which the cache holds."""


@kernel
def _fill_lanes(
    perfect, first_block, blocks, block_samples, dt, flags, keys, slow, white, coupling, lsb, left, lanes
):
    """Add the errors of each IMU to the perfect increments (samples, 6) and lay them side by side.

    Of each of m IMUs: ``keys`` (m,), ``slow`` (m, blocks, 6), ``white``, ``lsb``, ``left`` (m, 6),
    ``coupling`` (m, 6, 3); see `fill_errors`. ``lanes`` (samples, 6, width): those beyond m repeat the first.
    """
    w, size = np.zeros(WORK), tile_size(block_samples)
    many, width, measured = len(keys), lanes.shape[2], np.empty((len(keys), size, 6))
    for n in range(blocks):
        for first in range(0, block_samples, size):
            samples, start = min(size, block_samples - first), n * block_samples + first
            for j in range(6):
                for i in range(samples):
                    w[(INC + j) * W + i] = perfect[start + i, j]
            tile = tile_number(first_block + n, first // size)
            for lane in range(many):
                fill_errors(
                    tile, samples, dt, flags, keys[lane], slow[lane], n, white[lane], coupling[lane],
                    lsb[lane], left[lane], w,
                )  # fmt: skip
                write_measured(0, samples, measured[lane], w)
            for i in range(samples):
                for j in range(6):
                    for lane in range(width):
                        lanes[start + i, j, lane] = measured[lane if lane < many else 0, i, j]


def side_by_side(simulations: Sequence[ImuSimulation], width: int) -> Iterator[np.ndarray]:
    """Lay the increments of IMUs that ride along the same motion side by side, piece by piece.

    Parameters
    ----------
    simulations : sequence of ImuSimulation
        At most ``width``, which differ in their errors and seeds alone.
    width : int
        Lanes. Those without an IMU repeat the first, so that nothing in them can go wrong.

    Yields
    ------
    ndarray, shape (n, 6, width)
        The numbers of `ImuSimulation.chunks`, to the last bit.
    """
    one, each = simulations[0], [simulation.errors for simulation in simulations]
    flags, left = int(np.bitwise_or.reduce([e.flags for e in each])), np.zeros((len(each), 6))
    keys = np.array([e.key for e in each])
    white, coupling, lsb = (
        np.stack([getattr(e, name) for e in each]) for name in ("white", "coupling", "lsb")
    )
    many, block = max(1, _LAID // one.block), one.block
    for first, perfect, _ in one.without_errors().whole_blocks():
        for begin in range(0, len(perfect) // block, many):
            rows = perfect[begin * block : (begin + many) * block]
            blocks, lanes = len(rows) // block, np.empty((len(rows), 6, width))
            slow = np.stack([e.slow[first + begin : first + begin + blocks] for e in each])
            _fill_lanes(
                rows, first + begin, blocks, block, 1.0 / one.rate_hz, flags, keys, slow, white, coupling,
                lsb, left, lanes,
            )  # fmt: skip
            yield lanes[: one.samples - (first + begin) * block]
