"""Many strapdown runs at once: the same motion and log, each run with its own sensor errors, start and law.

Runs are the inner, vectorised dimension in blocks of `WIDTH`, blocks are spread over threads. All states of a
block lie in one flat array whose width is known when compiling: with row views LLVM did not vectorise.
Vertical channel locked. The law runs once an interval for each run, as in the single run. White noise of each
run's own is drawn inside the loop, from a counter: it depends on the key, the run's number and the sample.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from navcore.compiled import inlined, kernel
from navcore.control.law import Law
from navcore.earth import Earth
from navcore.mechanization.strapdown.attitude import misalignment, quaternion_of
from navcore.mechanization.strapdown.kernel import _law_epoch
from navcore.mechanization.strapdown.layout import (
    E2,
    G_EQUATOR,
    HEIGHT0,
    K6,
    K12,
    K_GRAVITY,
    LARGEST_LATITUDE,
    LAT0,
    LON0,
    STATE,
    STEP,
)
from navcore.mechanization.strapdown.run import Settings, Start, VelocityReference, constants, no_reference
from navcore.mechanization.strapdown.step import earth_terms, strapdown_step
from navcore.motion.base import HEADING, LAT, LON, PITCH, ROLL, VE, VN
from navcore.sensors.imu_simulation.normal import fill_normals, stream_key
from navcore.sensors.imu_simulation.work import HALF_NORMALS, NORMAL, WORK, W

WIDTH = 16
"""Runs of a block."""
_W = WIDTH
# Rows of a block's flat state: what changes, then what is held.
_D_LAT, _D_LON, _V_E, _V_N, _Q, _Z, _M_E, _M_N, _M_LAT = 0, 1, 2, 3, 4, 8, 12, 13, 14
_C_E, _C_N, _A_E, _A_N, _TERMS, _ORIGIN = 15, 16, 17, 18, 19, 27
# Of an increment, six each: constant error, deviation of the noise, error now; the previous increment.
_BIAS, _WHITE, _ERROR, _BEFORE = 28, 34, 40, 46
_ROWS = 52
_DRAWS = 2 * HALF_NORMALS // (6 * WIDTH)
"""Draws of a block's noise that one call of `fill_normals` gives."""
ERRORS = 7
"""dV_E, dV_N (m/s), dL, dlambda (rad), phi_E, phi_N, phi_U (rad)."""


@kernel
def _run_samples(first, last, increments, dt, e2, g_equator, k_gravity, k12, k6, height, x):
    for i in range(first, last):
        tx, ty, tz = increments[i, 0], increments[i, 1], increments[i, 2]
        bx, by, bz = increments[i, 3], increments[i, 4], increments[i, 5]
        for j in range(_W):
            t0, t1, t2 = tx + x[_ERROR * _W + j], ty + x[(_ERROR + 1) * _W + j], tz + x[(_ERROR + 2) * _W + j]
            b0, b1 = bx + x[(_ERROR + 3) * _W + j], by + x[(_ERROR + 4) * _W + j]
            b2 = bz + x[(_ERROR + 5) * _W + j]
            d_lat, m_lat = x[_D_LAT * _W + j], x[_M_LAT * _W + j]
            (v_e, v_n, _, q0, q1, q2, q3, z0, z1, z2, z3, m_e, m_n, _, m_lat, m_lon) = strapdown_step(
                dt, e2, g_equator, k_gravity, k12, k6, False,
                t0, t1, t2, b0, b1, b2,
                x[_BEFORE * _W + j], x[(_BEFORE + 1) * _W + j], x[(_BEFORE + 2) * _W + j],
                x[(_BEFORE + 3) * _W + j], x[(_BEFORE + 4) * _W + j], x[(_BEFORE + 5) * _W + j],
                x[_TERMS * _W + j], x[(_TERMS + 1) * _W + j], x[(_TERMS + 2) * _W + j],
                x[(_TERMS + 3) * _W + j], x[(_TERMS + 4) * _W + j], x[(_TERMS + 5) * _W + j],
                x[(_TERMS + 6) * _W + j], x[(_TERMS + 7) * _W + j],
                d_lat - x[_ORIGIN * _W + j] + 0.5 * m_lat,
                height, x[_V_E * _W + j], x[_V_N * _W + j], 0.0,
                x[_Q * _W + j], x[(_Q + 1) * _W + j], x[(_Q + 2) * _W + j], x[(_Q + 3) * _W + j],
                x[_Z * _W + j], x[(_Z + 1) * _W + j], x[(_Z + 2) * _W + j], x[(_Z + 3) * _W + j],
                x[_M_E * _W + j], x[_M_N * _W + j], 0.0,
                x[_C_E * _W + j], x[_C_N * _W + j], x[_A_E * _W + j], x[_A_N * _W + j], 0.0,
            )  # fmt: skip
            x[_BEFORE * _W + j], x[(_BEFORE + 1) * _W + j], x[(_BEFORE + 2) * _W + j] = t0, t1, t2
            x[(_BEFORE + 3) * _W + j], x[(_BEFORE + 4) * _W + j], x[(_BEFORE + 5) * _W + j] = b0, b1, b2
            x[_D_LAT * _W + j] = d_lat + m_lat
            x[_D_LON * _W + j] += m_lon
            x[_V_E * _W + j], x[_V_N * _W + j] = v_e, v_n
            x[_Q * _W + j], x[(_Q + 1) * _W + j], x[(_Q + 2) * _W + j], x[(_Q + 3) * _W + j] = q0, q1, q2, q3
            x[_Z * _W + j], x[(_Z + 1) * _W + j], x[(_Z + 2) * _W + j], x[(_Z + 3) * _W + j] = z0, z1, z2, z3
            x[_M_E * _W + j], x[_M_N * _W + j], x[_M_LAT * _W + j] = m_e, m_n, m_lat


@inlined
def _draw(number, block, key, again, x, w):
    """Put bias and draw ``number`` of the noise into the errors of an increment."""
    group, place = number // _DRAWS, number % _DRAWS
    if place == 0 or again:
        fill_normals((block << 32) + group, key, HALF_NORMALS, w)
    unit = NORMAL * W + 6 * _W * place
    for i in range(6 * _W):
        x[_ERROR * _W + i] = x[_BIAS * _W + i] + x[_WHITE * _W + i] * w[unit + i]


@kernel
def _epoch(k, run, j, record, con, x, last, truth, epoch_s, epoch_v, epoch_valid, p, s, ring, out):
    """Earth terms, law and record of one run at sample k."""
    d_lat, v_e, v_n = x[_D_LAT * _W + j], x[_V_E * _W + j], x[_V_N * _W + j]
    q0, q1, q2, q3 = x[_Q * _W + j], x[(_Q + 1) * _W + j], x[(_Q + 2) * _W + j], x[(_Q + 3) * _W + j]
    lat = con[run, LAT0] + d_lat
    if not abs(lat) < LARGEST_LATITUDE:
        lat = 0.0 if not math.isfinite(lat) else math.copysign(LARGEST_LATITUDE, lat)
    x[_ORIGIN * _W + j] = d_lat
    for i, term in enumerate(earth_terms(con[run, E2], lat, con[run, HEIGHT0])):
        x[(_TERMS + i) * _W + j] = term
    c_e, c_n, a_e, a_n = _law_epoch(
        k * con[run, STEP], v_e, v_n, q0, q1, q2, q3, con[run], last,
        epoch_s, epoch_v, epoch_valid, p, s, ring,
    )  # fmt: skip
    x[_C_E * _W + j], x[_C_N * _W + j], x[_A_E * _W + j], x[_A_N * _W + j] = c_e, c_n, a_e, a_n
    if record >= 0:
        i = record if truth.shape[0] > 1 else 0
        t0, t1, t2, t3 = quaternion_of(truth[i, PITCH], truth[i, ROLL], truth[i, HEADING])
        phi_e, phi_n, phi_u = misalignment(q0, q1, q2, q3, t0, t1, t2, t3)
        out[record, run, 0], out[record, run, 1] = v_e - truth[i, VE], v_n - truth[i, VN]
        out[record, run, 2] = con[run, LAT0] + d_lat - truth[i, LAT]
        out[record, run, 3] = con[run, LON0] - truth[i, LON] + x[_D_LON * _W + j]
        out[record, run, 4], out[record, run, 5], out[record, run, 6] = phi_e, phi_n, phi_u


@kernel
def _advance_block(
    increments, first, law_every, record_every, final, block, runs, con, x, lasts, noise_every, key,
    truth, epoch_s, epoch_v, epoch_valid, p, s, ring, out,
):  # fmt: skip
    """Advance one block, of which ``runs`` runs are in use, by a chunk."""
    begin = block * _W
    dt, w = con[begin, STEP], np.empty(WORK)
    k, end = first, first + increments.shape[0]
    while True:
        if k % law_every == 0 and (k < end or k == final):
            record = k // record_every if k % record_every == 0 else -1
            for j in range(runs):
                run = begin + j
                _epoch(k, run, j, record, con, x, lasts[run], truth, epoch_s, epoch_v, epoch_valid,
                       p[run], s[run], ring[run], out)  # fmt: skip
        if k == end:
            return
        n = min(law_every - k % law_every, end - k)
        if noise_every > 0:
            n = min(n, noise_every - k % noise_every)
            if k % noise_every == 0 or k == first:
                _draw(k // noise_every, block, key, k == first, x, w)
        _run_samples(
            k - first, k - first + n, increments, dt, con[begin, E2], con[begin, G_EQUATOR],
            con[begin, K_GRAVITY], con[begin, K12], con[begin, K6], con[begin, HEIGHT0], x,
        )  # fmt: skip
        k += n


@dataclass(frozen=True)
class BatchNoise:
    """White noise of each run's own sensors.

    Attributes
    ----------
    walk : ndarray, shape (6,) or (runs, 6)
        Random walks of gyros and accelerometers: rad/sqrt(s), m/s/sqrt(s).
    seed : int
        Seed of the scenario.
    every : int
        Samples for which a drawn number is held; its size is such that the walk stays the same.
    """

    walk: np.ndarray
    seed: int
    every: int = 1


class BatchRun:
    """A batch under way; give it perfect (or commonly disturbed) increments chunk by chunk.

    Parameters
    ----------
    starts : sequence of Start
        One a run.
    laws : sequence of Law
        One a run, all for the same law interval.
    biases : ndarray, shape (runs, 6)
        Constant errors of each run's IMU, body axes: rad/s, m/s^2.
    settings : Settings
        Common; vertical must be locked, ``record_every`` a multiple of ``law_every``.
    earth : Earth
        Earth model.
    truth : ndarray, shape (records + 1, 15) or (1, 15)
        True states at the recorded times.
    reference : VelocityReference, optional
        Common log.
    before : ndarray, shape (6,), optional
        Perfect increment of the interval that ends at t = 0.
    noise : BatchNoise, optional
        White noise; without, a run has its biases only.

    Attributes
    ----------
    errors : ndarray, shape (records + 1, runs, 7)
        dV_E, dV_N, dL, dlambda, phi_E, phi_N, phi_U (SI) at the recorded times.

    Raises
    ------
    ValueError
        Settings that a batch cannot do.
    """

    def __init__(
        self,
        starts: Sequence[Start],
        laws: Sequence[Law],
        biases: np.ndarray,
        settings: Settings,
        earth: Earth,
        truth: np.ndarray,
        reference: VelocityReference | None = None,
        before: np.ndarray | None = None,
        noise: BatchNoise | None = None,
    ) -> None:
        if settings.vertical != "locked":
            raise ValueError("a batch has a locked vertical channel")
        if settings.record_every % settings.law_every or settings.samples % settings.record_every:
            raise ValueError("samples must be a multiple of record_every, and that of law_every")
        reference = no_reference() if reference is None else reference
        self.settings, self.runs, self.position = settings, len(starts), 0
        self._reference, self._truth = reference, np.ascontiguousarray(truth, dtype=float)
        self._noise_every = 0 if noise is None else noise.every
        self._key = np.uint64(0 if noise is None else stream_key(noise.seed, "batch.white"))
        self._con = np.stack([constants(start, settings, earth, reference) for start in starts])
        self._p, self._s = np.stack([law.p for law in laws]), np.stack([law.s for law in laws])
        self._ring = np.stack([law.ring for law in laws])
        self._last = np.zeros((self.runs, STATE))
        blocks = -(-self.runs // WIDTH)
        self._x = np.zeros((blocks, _ROWS * WIDTH))
        self.errors = np.zeros((settings.samples // settings.record_every + 1, self.runs, ERRORS))
        for run in range(self.runs):
            self._lay_out(run, starts[run], np.asarray(biases, dtype=float)[run] / settings.rate_hz, before)
            if noise is not None:
                walk = np.broadcast_to(noise.walk, (self.runs, 6))[run]
                self._column(run)[_WHITE : _WHITE + 6] = walk / np.sqrt(settings.rate_hz * noise.every)
        for block in range(blocks):
            # Lanes without a run repeat the block's first, so that nothing in them can go wrong.
            lanes = self._x[block].reshape(_ROWS, WIDTH)
            used = min(WIDTH, self.runs - block * WIDTH)
            lanes[:, used:] = lanes[:, :1]

    def _column(self, run: int) -> np.ndarray:
        block, lane = divmod(run, WIDTH)
        return self._x[block].reshape(_ROWS, WIDTH)[:, lane]

    def _lay_out(self, run: int, start: Start, bias: np.ndarray, before: np.ndarray | None) -> None:
        column = self._column(run)
        column[_V_E], column[_V_N] = start.velocity[:2]
        column[_Q : _Q + 4] = start.quaternion
        column[_BIAS : _BIAS + 6] = column[_ERROR : _ERROR + 6] = bias
        column[_BEFORE : _BEFORE + 6] = bias if before is None else before + bias
        column[_TERMS + 6] = 1.0

    def advance(self, increments: np.ndarray, workers: int = 2) -> bool:
        """Integrate a chunk; return True when the batch is complete.

        Parameters
        ----------
        increments : ndarray, shape (n, 6)
            Common increments.
        workers : int
            Threads.
        """
        increments = np.ascontiguousarray(increments[: self.settings.samples - self.position], dtype=float)
        log, set_ = self._reference, self.settings

        def one(block: int) -> None:
            _advance_block(
                increments, self.position, set_.law_every, set_.record_every, set_.samples, block,
                min(WIDTH, self.runs - block * WIDTH), self._con, self._x[block], self._last,
                self._noise_every, self._key, self._truth, log.time_s, log.velocity, log.valid,
                self._p, self._s, self._ring, self.errors,
            )  # fmt: skip

        with ThreadPoolExecutor(workers) as pool:
            list(pool.map(one, range(len(self._x))))
        self.position += len(increments)
        return self.position >= self.settings.samples
