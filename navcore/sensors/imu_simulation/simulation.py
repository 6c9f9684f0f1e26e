"""Increments of an IMU that rides along a motion: made block by block, the same whatever the chunks."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from navcore.earth import Earth
from navcore.errors import InputError
from navcore.motion.base import COLUMNS, HEADING, HEADING_RATE, PITCH, PITCH_RATE, MotionParameters, Site
from navcore.motion.course import COURSE_TIME, SPEED_TIME, sample_course
from navcore.motion.legs import LegsMotion
from navcore.motion.static import StaticMotion
from navcore.motion.swing import SwingMotion
from navcore.motion.track import TrackMotion
from navcore.sensors.imu import Imu
from navcore.sensors.imu_simulation.blocks import COURSE, REST, ROWS, SWING, simulate_blocks
from navcore.sensors.imu_simulation.corrupt import COUNTS, COUPLING, NOISE, SUMS
from navcore.sensors.imu_simulation.normal import stream_key
from navcore.sensors.imu_simulation.work import HALO, W
from navcore.sensors.noise import gauss_markov, unit_noise
from navcore.units import DEG

CHUNK_S = 60.0
"""Length of a chunk: 3 MB at 1000 Hz."""


class ImuSimulation:
    """The IMU of a run.

    Parameters
    ----------
    motion : MotionParameters
        Static, swing, legs or track; any other is sampled through its ``truth``.
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

    Attributes
    ----------
    block : int
        Samples of a block, about 1 s: white noise is drawn and Gauss-Markov drift is held by the block.

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
    ) -> None:
        self.motion, self.site, self.earth, self.rate_hz, self.samples = motion, site, earth, rate_hz, samples
        self.block = max(1, round(rate_hz))
        self.blocks = -(-samples // self.block)
        self._start_utc = start_utc
        self._errors = _Errors(imu, seed, self.block, self.blocks, 1.0 / rate_hz)
        self._kind, self._course = REST, (np.zeros((1, 7)), np.zeros((2, 6)))
        self._axes, self._table = np.zeros((3, 4)), np.zeros(6 * W)
        self._rest = np.zeros(COLUMNS)
        self._prepare()

    def _prepare(self) -> None:
        motion = self.motion
        if isinstance(motion, SwingMotion):
            self._kind, self._axes, self._rest = SWING, motion.packed(), motion.rest_row(self.site)[0]
            turns = np.outer(self._axes[:, 2], np.arange(W) / self.rate_hz)
            self._table = np.stack([f(2.0 * np.pi * turns) for f in (np.cos, np.sin)], axis=1).reshape(-1)
        elif isinstance(motion, LegsMotion):
            self._rest = motion.rest_row(self.site)[0]
            course = motion.course(self.samples / self.rate_hz + 2.0 / self.rate_hz, self.site, self.earth)
            self._kind, self._course = COURSE, (_askable_before_start(course.legs), course.nodes)
        elif isinstance(motion, StaticMotion):
            self._rest = motion.rest_row(self.site)[0]
        else:
            self._kind = ROWS

    def truth_rows(self, count: int, step_s: float) -> np.ndarray:
        """True states at 0, step_s, ...: shape (count, 15), or (1, 15) at rest; no step is too long."""
        if self._kind == REST:
            return self._rest[None, :].copy()
        if self._kind == SWING:
            return self._swing_rows(np.arange(count) * step_s)
        if isinstance(self.motion, LegsMotion):
            course = self.motion.course(max(count - 1, 1) * step_s, self.site, self.earth)
            level = self.motion.pitch_deg * DEG, self.motion.roll_deg * DEG
            return sample_course(course, count, step_s, *level, self.site.height)
        return self._sampled(0.0, count, step_s)

    def _swing_rows(self, time_s: np.ndarray) -> np.ndarray:
        rows = np.tile(self._rest, (len(time_s), 1))
        for axis, (mean, amplitude, frequency, phase) in enumerate(self._axes):
            angle = 2.0 * np.pi * np.remainder(frequency * time_s + phase, 1.0)
            rows[:, PITCH + axis] = mean + amplitude * np.sin(angle)
            rows[:, PITCH_RATE + axis] = 2.0 * np.pi * frequency * amplitude * np.cos(angle)
        return rows

    def _sampled(self, start_s: float, count: int, step_s: float) -> np.ndarray:
        """Rows of a sampled motion from ``start_s`` on; beyond the ends the motion goes on evenly."""
        inside = min(max(count, 2), int(self.samples / self.rate_hz / step_s + 1e-9) + 1)
        del start_s
        if isinstance(self.motion, TrackMotion):
            truth = self.motion.truth(inside, step_s, self.site, self.earth, start_utc=self._start_utc)
        else:
            truth = self.motion.truth(inside, step_s, self.site, self.earth)
        rows = np.array(np.broadcast_to(truth.values, (inside, COLUMNS)))
        return _extended(rows, 0, max(count - inside, 0), step_s)[:count]

    def before(self) -> np.ndarray:
        """Perfect increment of the interval that ends at t = 0, shape (6,)."""
        perfect = ImuSimulation(
            self.motion, self.site, self.earth, Imu(), self.rate_hz, max(self.samples, self.block), 0,
            self._start_utc,
        )  # fmt: skip
        measured = np.empty((self.block, 6))
        if self._kind == ROWS:
            rows = perfect._sampled(0.0, self.block + HALO, 1.0 / self.rate_hz)
            values = _extended(rows, 2, 0, 1.0 / self.rate_hz)
            perfect._fill(0, 1, measured, np.empty((0, 6)), values)
        else:
            perfect._fill(0, 1, measured, np.empty((0, 6)), shift=-1)
        return measured[0]

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
            array is used again for the next chunk.
        sums : ndarray, shape (blocks, 6) or (0, 6)
            Sums of the errors over each block, E N U: rad, m/s.
        """
        self._errors.restart()
        place = np.zeros(2, np.int64)
        many = max(1, int(CHUNK_S * self.rate_hz) // self.block)
        measured = np.empty((many * self.block, 6))
        whole = self._sampled_values() if self._kind == ROWS else None
        for first in range(0, self.blocks, many):
            blocks = min(many, self.blocks - first)
            sums = np.empty((blocks if with_sums else 0, 6))
            values = None
            if whole is not None:
                values = whole[first * self.block : (first + blocks) * self.block + HALO]
            self._fill(first, blocks, measured, sums, values, place)
            yield measured[: min(blocks * self.block, self.samples - first * self.block)], sums

    def _sampled_values(self) -> np.ndarray:
        """All samples of a sampled motion, one before the start and two after the last block."""
        step = 1.0 / self.rate_hz
        return _extended(self._sampled(0.0, self.blocks * self.block + 3, step), 1, 0, step)

    def _fill(
        self,
        first: int,
        blocks: int,
        measured: np.ndarray,
        sums: np.ndarray,
        values: np.ndarray | None = None,
        place: np.ndarray | None = None,
        shift: int = 0,
    ) -> None:
        e, earth, dt = self._errors, self.earth, 1.0 / self.rate_hz
        axes = self._axes
        legs, nodes = self._course
        if shift:
            axes, legs, nodes = axes.copy(), legs.copy(), nodes.copy()
            axes[:, 3] += shift * dt * axes[:, 2]
            legs[:, 0] -= shift * dt
            nodes[:, 0] -= shift * dt
        simulate_blocks(
            self._kind, first, blocks, self.block, dt, self._rest, axes, self._table, legs, nodes,
            np.zeros(2, np.int64) if place is None else place,
            np.zeros((1, COLUMNS)) if values is None else np.ascontiguousarray(values),
            earth.e2, earth.g_equator, earth.somigliana_k, e.flags | (SUMS if len(sums) else 0),
            e.key, e.bias, e.drift[first : first + blocks], e.white, e.coupling,
            e.lsb, e.left, measured, sums,
        )  # fmt: skip


def _askable_before_start(legs: np.ndarray) -> np.ndarray:
    """Legs whose empty changes have a duration: at t < 0 the quadrature would divide 0 by 0."""
    legs = legs.copy()
    legs[:, [SPEED_TIME, COURSE_TIME]] = np.maximum(legs[:, [SPEED_TIME, COURSE_TIME]], 1e-6)
    return legs


def _extended(rows: np.ndarray, before: int, after: int, step_s: float) -> np.ndarray:
    """Rows of truth with some more at either end, where heading and position go on evenly."""
    parts = []
    for edge, number in ((0, before), (-1, after)):
        times = (np.arange(-number, 0) if edge == 0 else np.arange(1, number + 1)) * step_s
        more = np.tile(rows[edge], (number, 1))
        for angle in range(3):
            more[:, PITCH + angle] += times * rows[edge, PITCH_RATE + angle]
        parts.append(more)
    return np.concatenate([parts[0], rows, parts[1]])


assert HEADING == PITCH + 2 and HEADING_RATE == PITCH_RATE + 2


class _Errors:
    """The IMU's errors as the compiled loop takes them."""

    def __init__(self, imu: Imu, seed: int, block: int, blocks: int, dt: float) -> None:
        models = imu.gyro(), imu.accel()
        self.key = np.uint64(stream_key(seed, "imu.white"))
        self.bias = np.concatenate([m.bias for m in models]).astype(float)
        self.white = np.repeat([m.white * math.sqrt(dt) for m in models], 3).astype(float)
        self.coupling = np.concatenate([m.coupling for m in models])
        self.lsb = np.concatenate([m.lsb for m in models]).astype(float)
        self.left = np.zeros(6)
        self.drift = np.zeros((blocks, 6))
        for i, model in enumerate(models):
            if model.instability > 0.0:
                unit = unit_noise(seed, f"{model.stream}.instability", blocks, 3)
                decay = math.exp(-block * dt / model.tau_s)
                self.drift[:, 3 * i : 3 * i + 3] = model.instability * gauss_markov(unit, decay)
        self.flags = (
            (NOISE if self.white.any() else 0)
            | (COUPLING if self.coupling.any() else 0)
            | (COUNTS if self.lsb.any() else 0)
        )

    def restart(self) -> None:
        """Forget what quantisation carries over."""
        self.left[:] = 0.0


__all__ = ["ImuSimulation", "InputError"]
