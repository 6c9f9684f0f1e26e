"""Many strapdown runs at once: the same motion and log, each run with its own sensor errors, start and law.

Runs are the inner, vectorised dimension in blocks of `WIDTH`, blocks are spread over threads. All states of a
block lie in one flat array whose width is known when compiling: with row views LLVM did not vectorise.
Vertical channel locked. The law runs once an interval for each run, as in the single run.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from navcore.compiled import kernel
from navcore.control.law import Law
from navcore.earth import Earth
from navcore.mechanization.strapdown.attitude import misalignment, quaternion_of
from navcore.mechanization.strapdown.kernel import LARGEST_LATITUDE, _law_epoch
from navcore.mechanization.strapdown.layout import (
    E2,
    G_EQUATOR,
    HEIGHT0,
    K6,
    K12,
    K_GRAVITY,
    LAT0,
    LON0,
    STATE,
    STEP,
)
from navcore.mechanization.strapdown.run import Settings, Start, VelocityReference, constants, no_reference
from navcore.mechanization.strapdown.step import earth_terms, strapdown_step
from navcore.motion.base import HEADING, LAT, LON, PITCH, ROLL, VE, VN

WIDTH = 16
"""Runs of a block."""
_W = WIDTH
# Rows of a block's flat state: what changes, then what is held.
_D_LAT, _D_LON, _V_E, _V_N, _Q, _Z, _M_E, _M_N, _M_LAT = 0, 1, 2, 3, 4, 8, 12, 13, 14
_C_E, _C_N, _A_E, _A_N, _TERMS, _ORIGIN, _BIAS = 15, 16, 17, 18, 19, 27, 28
_ROWS = 34
ERRORS = 7
"""dV_E, dV_N (m/s), dL, dlambda (rad), phi_E, phi_N, phi_U (rad)."""


@kernel
def _run_samples(first, last, increments, before, dt, e2, g_equator, k_gravity, k12, k6, height, x):
    px, py, pz, ex, ey, ez = before[0], before[1], before[2], before[3], before[4], before[5]
    for i in range(first, last):
        tx, ty, tz = increments[i, 0], increments[i, 1], increments[i, 2]
        bx, by, bz = increments[i, 3], increments[i, 4], increments[i, 5]
        for j in range(_W):
            g0, g1, g2 = x[_BIAS * _W + j], x[(_BIAS + 1) * _W + j], x[(_BIAS + 2) * _W + j]
            f0, f1, f2 = x[(_BIAS + 3) * _W + j], x[(_BIAS + 4) * _W + j], x[(_BIAS + 5) * _W + j]
            d_lat, m_lat = x[_D_LAT * _W + j], x[_M_LAT * _W + j]
            (v_e, v_n, _, q0, q1, q2, q3, z0, z1, z2, z3, m_e, m_n, _, m_lat, m_lon) = strapdown_step(
                dt, e2, g_equator, k_gravity, k12, k6, False,
                tx + g0, ty + g1, tz + g2, bx + f0, by + f1, bz + f2,
                px + g0, py + g1, pz + g2, ex + f0, ey + f1, ez + f2,
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
            x[_D_LAT * _W + j] = d_lat + m_lat
            x[_D_LON * _W + j] += m_lon
            x[_V_E * _W + j], x[_V_N * _W + j] = v_e, v_n
            x[_Q * _W + j], x[(_Q + 1) * _W + j], x[(_Q + 2) * _W + j], x[(_Q + 3) * _W + j] = q0, q1, q2, q3
            x[_Z * _W + j], x[(_Z + 1) * _W + j], x[(_Z + 2) * _W + j], x[(_Z + 3) * _W + j] = z0, z1, z2, z3
            x[_M_E * _W + j], x[_M_N * _W + j], x[_M_LAT * _W + j] = m_e, m_n, m_lat
        px, py, pz, ex, ey, ez = tx, ty, tz, bx, by, bz
    before[0], before[1], before[2], before[3], before[4], before[5] = px, py, pz, ex, ey, ez


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
    increments, first, law_every, record_every, final, begin, runs, con, x, before, lasts, bias, noise,
    noise_every, truth, epoch_s, epoch_v, epoch_valid, p, s, ring, out,
):  # fmt: skip
    """Advance one block of runs begin .. begin + runs by a chunk."""
    dt = con[begin, STEP]
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
                row = (k - first + first % noise_every) // noise_every
                for m in range(6):
                    for j in range(runs):
                        x[(_BIAS + m) * _W + j] = bias[begin + j, m] + noise[row, begin + j, m]
        _run_samples(
            k - first, k - first + n, increments, before, dt, con[begin, E2], con[begin, G_EQUATOR],
            con[begin, K_GRAVITY], con[begin, K12], con[begin, K6], con[begin, HEIGHT0], x,
        )  # fmt: skip
        k += n


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
    ) -> None:
        if settings.vertical != "locked":
            raise ValueError("a batch has a locked vertical channel")
        if settings.record_every % settings.law_every or settings.samples % settings.record_every:
            raise ValueError("samples must be a multiple of record_every, and that of law_every")
        reference = no_reference() if reference is None else reference
        self.settings, self.runs, self.position = settings, len(starts), 0
        self._reference, self._truth = reference, np.ascontiguousarray(truth, dtype=float)
        self._bias = np.asarray(biases, dtype=float) / settings.rate_hz
        self._con = np.stack([constants(start, settings, earth, reference) for start in starts])
        self._p, self._s = np.stack([law.p for law in laws]), np.stack([law.s for law in laws])
        self._ring = np.stack([law.ring for law in laws])
        self._last = np.zeros((self.runs, STATE))
        blocks = -(-self.runs // WIDTH)
        self._x = np.zeros((blocks, _ROWS * WIDTH))
        self._before = np.zeros((blocks, 6)) if before is None else np.tile(before, (blocks, 1))
        self.errors = np.zeros((settings.samples // settings.record_every + 1, self.runs, ERRORS))
        for run in range(self.runs):
            self._lay_out(run, starts[run])
        for block in range(blocks):
            # Lanes without a run repeat the block's first, so that nothing in them can go wrong.
            lanes = self._x[block].reshape(_ROWS, WIDTH)
            used = min(WIDTH, self.runs - block * WIDTH)
            lanes[:, used:] = lanes[:, :1]

    def _lay_out(self, run: int, start: Start) -> None:
        block, lane = divmod(run, WIDTH)
        column = self._x[block].reshape(_ROWS, WIDTH)[:, lane]
        column[_V_E], column[_V_N] = start.velocity[:2]
        column[_Q : _Q + 4] = start.quaternion
        column[_BIAS : _BIAS + 6] = self._bias[run]
        column[_TERMS + 6] = 1.0

    def advance(
        self, increments: np.ndarray, noise: np.ndarray | None = None, noise_every: int = 1, workers: int = 2
    ) -> bool:
        """Integrate a chunk; return True when the batch is complete.

        Parameters
        ----------
        increments : ndarray, shape (n, 6)
            Common increments.
        noise : ndarray, shape (m, runs, 6), optional
            Further increments of each run, each held for ``noise_every`` samples (its part of one sample).
        noise_every : int
            Samples for which a row of the noise holds.
        workers : int
            Threads.
        """
        increments = np.ascontiguousarray(increments[: self.settings.samples - self.position], dtype=float)
        own = np.zeros((0, self.runs, 6)) if noise is None else np.ascontiguousarray(noise, dtype=float)
        log, set_ = self._reference, self.settings

        def one(block: int) -> None:
            begin = block * WIDTH
            _advance_block(
                increments, self.position, set_.law_every, set_.record_every, set_.samples, begin,
                min(WIDTH, self.runs - begin), self._con, self._x[block], self._before[block], self._last,
                self._bias, own, noise_every if noise is not None else 0, self._truth, log.time_s,
                log.velocity, log.valid, self._p, self._s, self._ring, self.errors,
            )  # fmt: skip

        with ThreadPoolExecutor(workers) as pool:
            list(pool.map(one, range(len(self._x))))
        self.position += len(increments)
        return self.position >= self.settings.samples
