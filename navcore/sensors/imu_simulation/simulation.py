"""Increments of an IMU that rides along a motion: made block by block, the same whatever the chunks."""

from __future__ import annotations

import math
from collections.abc import Iterator
from copy import copy

import numpy as np

from navcore.foundation.earth import Earth
from navcore.foundation.errors import InputError
from navcore.motion.base import MotionParameters
from navcore.motion.kinematics import Kinematics
from navcore.motion.truth import Site
from navcore.sensors.imu import Imu
from navcore.sensors.imu_errors.base import Clock
from navcore.sensors.imu_simulation.blocks import simulate_blocks
from navcore.sensors.imu_simulation.corrupt import COUNTS, COUPLING, NOISE, SUMS
from navcore.sensors.imu_simulation.normal import stream_key

CHUNK_S = 60.0
"""Length of a chunk: 3 MB at 1000 Hz."""


class ImuSimulation:
    """The IMU of a run.

    Parameters
    ----------
    motion : MotionParameters
        Any motion: it is evaluated at the samples, block by block.
    site : Site
        Where it starts.
    earth : Earth
        WGS-84 or the sphere.
    imu : Imu
        Errors.
    rate_hz : float
        Samples a second.
    samples : int
        Samples of the run.
    seed : int
        Seed of the scenario.
    start_utc : float, optional
        UTC of t = 0 of a recorded track.
    begin_s : float
        Time of the first sample, s after the start of navigation; negative for an alignment.

    Attributes
    ----------
    block : int
        Samples of a block, about 1 s: white noise is drawn and slow errors are held by the block.
    errors : ErrorTerms
        What is added to the perfect increments.

    Raises
    ------
    InputError
        The motion cannot be carried out.
    """

    def __init__(
        self,
        motion: MotionParameters,
        site: Site,
        earth: Earth,
        imu: Imu,
        rate_hz: float,
        samples: int,
        seed: int,
        start_utc: float | None = None,
        begin_s: float = 0.0,
    ) -> None:
        self.motion, self.site, self.earth, self.rate_hz, self.samples = motion, site, earth, rate_hz, samples
        self.block = max(1, round(rate_hz))
        self.blocks = -(-samples // self.block)
        self._start_utc = start_utc
        clock = Clock(self.block / rate_hz, self.blocks, seed, begin_s)
        self.errors = ErrorTerms(imu, clock, 1.0 / rate_hz)
        end_s = (samples + self.block) / rate_hz
        self._kinematics = motion.kinematics(end_s, site, earth, start_utc)
        self._turns = self._kinematics.turns(1.0 / rate_hz)

    def truth_rows(self, count: int, step_s: float) -> np.ndarray:
        """True states at 0, step_s, ...: shape (count, 15), or (1, 15) at rest; no step is too long."""
        return self.motion.rows(count, step_s, self.site, self.earth, self._start_utc)

    def before(self) -> np.ndarray:
        """Perfect increment of the interval that ends at t = 0, shape (6,)."""
        measured = np.empty((self.block, 6))
        earlier = self._kinematics.moved(-1.0 / self.rate_hz)
        self.without_errors()._fill(0, 1, measured, np.empty((0, 6)), kinematics=earlier)
        return measured[0]

    def without_errors(self) -> ImuSimulation:
        """Return the perfect IMU on the same motion."""
        perfect = copy(self)
        clock = Clock(self.block / self.rate_hz, max(1, self.blocks), 0, 0.0)
        perfect.errors = ErrorTerms(Imu(), clock, 1.0 / self.rate_hz)
        return perfect

    def chunks(self, with_sums: bool = False) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Yield measured increments from the start on, chunk by chunk.

        Parameters
        ----------
        with_sums : bool
            Also give the errors, turned to the navigation frame and summed over each block: what a linear
            model must be fed with to see the same noise.

        Yields
        ------
        increments : ndarray, shape (n, 6)
            Angles (rad) and velocities (m/s) in body axes; each interval ends at its sample's time. The
            array is used again for the chunk after the next, so that one can be made while the other is read.
        sums : ndarray, shape (blocks, 6) or (0, 6)
            Sums of the errors over each block, E N U: rad, m/s.
        """
        for first, measured, sums in self.whole_blocks(with_sums):
            yield measured[: self.samples - first * self.block], sums

    def whole_blocks(self, with_sums: bool = False) -> Iterator[tuple[int, np.ndarray, np.ndarray]]:
        """Yield what `chunks` does, each with the number of its first block, and the last block whole."""
        self.errors.restart()
        place = np.zeros(2, np.int64)
        many = max(1, int(CHUNK_S * self.rate_hz) // self.block)
        buffers = [np.empty((min(many, self.blocks) * self.block, 6)) for _ in range(2)]
        for first in range(0, self.blocks, many):
            blocks = min(many, self.blocks - first)
            sums = np.empty((blocks if with_sums else 0, 6))
            measured = buffers[first // many % 2][: blocks * self.block]
            self._fill(first, blocks, measured, sums, place)
            yield first, measured, sums

    def _fill(
        self,
        first: int,
        blocks: int,
        measured: np.ndarray,
        sums: np.ndarray,
        place: np.ndarray | None = None,
        kinematics: Kinematics | None = None,
    ) -> None:
        e, earth, dt = self.errors, self.earth, 1.0 / self.rate_hz
        kin = kinematics or self._kinematics
        simulate_blocks(
            kin.kind,
            first,
            blocks,
            self.block,
            dt,
            kin.rest,
            kin.oscillations,
            self._turns,
            kin.legs,
            kin.nodes,
            kin.attitude,
            np.zeros(2, np.int64) if place is None else place,
            earth.e2,
            earth.g_equator,
            earth.somigliana_k,
            e.flags | (SUMS if len(sums) else 0),
            e.key,
            e.slow[first : first + blocks],
            e.white,
            e.coupling,
            e.lsb,
            e.left,
            measured,
            sums,
        )


class ErrorTerms:
    """The IMU's errors as the compiled loop takes them."""

    def __init__(self, imu: Imu, clock: Clock, dt: float) -> None:
        triads = imu.gyro(), imu.accel()
        self.key = np.uint64(stream_key(clock.seed, "imu.white"))
        self.white = np.repeat([triad.white * math.sqrt(dt) for triad in triads], 3)
        self.coupling = np.concatenate([triad.coupling for triad in triads])
        self.lsb = np.concatenate([triad.lsb for triad in triads])
        self.left = np.zeros(6)
        self.slow = np.empty((clock.count, 6))
        self.slow[:, :3], self.slow[:, 3:] = (triad.slow(clock) for triad in triads)
        self.flags = (
            (NOISE if self.white.any() else 0)
            | (COUPLING if self.coupling.any() else 0)
            | (COUNTS if self.lsb.any() else 0)
        )

    def restart(self) -> None:
        """Forget what quantisation carries over."""
        self.left[:] = 0.0


__all__ = ["ImuSimulation", "InputError"]
