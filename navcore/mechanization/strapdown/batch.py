"""Many strapdown runs at once: the same motion and log, each run with its own sensor errors, start and law.

Runs are the inner, vectorised dimension in blocks of `WIDTH`, blocks are spread over threads. All states of a
block lie in one flat array whose width is known when compiling: with row views LLVM did not vectorise.
Vertical channel locked. The law runs once an interval for each run, as in the single run. White noise of each
run's own is drawn inside the loop, from a counter: it depends on the key, the run's number and the sample.
"""

import math
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.earth import Earth
from navcore.law.law import LAW_PARAMETERS, LAW_STATE, Law
from navcore.mechanization.strapdown.attitude import misalignment, quaternion_of
from navcore.mechanization.strapdown.kernel import law_epoch
from navcore.mechanization.strapdown.records import (
    CONSTANTS,
    LARGEST_LATITUDE,
    LAST_CALL,
    constants_of,
)
from navcore.mechanization.strapdown.run import Settings, Start, VelocityReference, constants, no_reference
from navcore.mechanization.strapdown.step import (
    EarthTerms,
    Held,
    Increment,
    Navigation,
    earth_terms,
    increment_at,
    strapdown_step,
)
from navcore.motion.truth import HEADING, LAT, LON, PITCH, ROLL, VE, VN
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


@inlined
def _navigation_of(x, j, height):
    return Navigation(
        x[_D_LAT * _W + j], x[_D_LON * _W + j], height, x[_V_E * _W + j], x[_V_N * _W + j], 0.0,
        x[_Q * _W + j], x[(_Q + 1) * _W + j], x[(_Q + 2) * _W + j], x[(_Q + 3) * _W + j],
        x[_Z * _W + j], x[(_Z + 1) * _W + j], x[(_Z + 2) * _W + j], x[(_Z + 3) * _W + j],
        x[_M_E * _W + j], x[_M_N * _W + j], 0.0, x[_M_LAT * _W + j],
    )  # fmt: skip


@inlined
def _keep_navigation(x, j, nav):
    x[_D_LAT * _W + j], x[_D_LON * _W + j], x[_M_LAT * _W + j] = nav.d_lat, nav.d_lon, nav.m_lat
    x[_V_E * _W + j], x[_V_N * _W + j] = nav.v_e, nav.v_n
    x[_Q * _W + j], x[(_Q + 1) * _W + j], x[(_Q + 2) * _W + j] = nav.q0, nav.q1, nav.q2
    x[(_Q + 3) * _W + j] = nav.q3
    x[_Z * _W + j], x[(_Z + 1) * _W + j], x[(_Z + 2) * _W + j] = nav.z0, nav.z1, nav.z2
    x[(_Z + 3) * _W + j] = nav.z3
    x[_M_E * _W + j], x[_M_N * _W + j] = nav.m_e, nav.m_n


@inlined
def _before(x, j):
    return Increment(
        x[_BEFORE * _W + j], x[(_BEFORE + 1) * _W + j], x[(_BEFORE + 2) * _W + j],
        x[(_BEFORE + 3) * _W + j], x[(_BEFORE + 4) * _W + j], x[(_BEFORE + 5) * _W + j],
    )  # fmt: skip


@inlined
def _keep_before(x, j, now):
    x[_BEFORE * _W + j], x[(_BEFORE + 1) * _W + j], x[(_BEFORE + 2) * _W + j] = now.tx, now.ty, now.tz
    x[(_BEFORE + 3) * _W + j], x[(_BEFORE + 4) * _W + j] = now.bx, now.by
    x[(_BEFORE + 5) * _W + j] = now.bz


@inlined
def _disturbed(true, x, j):
    """Increment of one run: the common one and the run's own error."""
    return Increment(
        true.tx + x[_ERROR * _W + j], true.ty + x[(_ERROR + 1) * _W + j], true.tz + x[(_ERROR + 2) * _W + j],
        true.bx + x[(_ERROR + 3) * _W + j], true.by + x[(_ERROR + 4) * _W + j],
        true.bz + x[(_ERROR + 5) * _W + j],
    )  # fmt: skip


@inlined
def _terms_of(x, j):
    return EarthTerms(
        x[_TERMS * _W + j], x[(_TERMS + 1) * _W + j], x[(_TERMS + 2) * _W + j], x[(_TERMS + 3) * _W + j],
        x[(_TERMS + 4) * _W + j], x[(_TERMS + 5) * _W + j], x[(_TERMS + 6) * _W + j],
        x[(_TERMS + 7) * _W + j],
    )  # fmt: skip


@kernel
def _run_samples(first, last, increments, con, x):
    """Integrate samples first..last of a chunk for all runs of a block with what their laws hold."""
    step, height = constants_of(con), con.height0
    for i in range(first, last):
        true = increment_at(increments, i)
        for j in range(_W):
            now = _disturbed(true, x, j)
            held = Held(x[_C_E * _W + j], x[_C_N * _W + j], x[_A_E * _W + j], x[_A_N * _W + j], 0.0, 0.0)
            nav = strapdown_step(
                step, now, _before(x, j), _navigation_of(x, j, height), _terms_of(x, j), x[_ORIGIN * _W + j],
                held, False,
            )  # fmt: skip
            _keep_before(x, j, now)
            _keep_navigation(x, j, nav)


@inlined
def _draw(number, block, key, again, x, w):
    """Put bias and draw ``number`` of the noise into the errors of an increment."""
    group, place = number // _DRAWS, number % _DRAWS
    if place == 0 or again:
        fill_normals((block << 32) + group, key, HALF_NORMALS, w)
    unit = NORMAL * W + 6 * _W * place
    for i in range(6 * _W):
        x[_ERROR * _W + i] = x[_BIAS * _W + i] + x[_WHITE * _W + i] * w[unit + i]


class _Runs(NamedTuple):
    """Records of each run, and the common log and truth."""

    con: np.ndarray  # `records.CONSTANTS`, a run each
    last: np.ndarray  # `records.LAST_CALL`
    p: np.ndarray  # of the laws
    s: np.ndarray
    ring: np.ndarray
    log: VelocityReference
    truth: np.ndarray
    errors: np.ndarray


class _Pace(NamedTuple):
    """Samples of the run, between two calls of the law, two records and two draws of noise (0: none)."""

    final: int
    law_every: int
    record_every: int
    noise_every: int


@kernel
def _epoch(k, run, j, row, x, runs):
    """Earth terms, law and record of one run, lane j of its block, at sample k."""
    con, truth = runs.con[run], runs.truth
    d_lat, v_e, v_n = x[_D_LAT * _W + j], x[_V_E * _W + j], x[_V_N * _W + j]
    q = (x[_Q * _W + j], x[(_Q + 1) * _W + j], x[(_Q + 2) * _W + j], x[(_Q + 3) * _W + j])
    lat = con.lat0 + d_lat
    if not abs(lat) < LARGEST_LATITUDE:
        lat = 0.0 if not math.isfinite(lat) else math.copysign(LARGEST_LATITUDE, lat)
    x[_ORIGIN * _W + j] = d_lat
    for i, term in enumerate(earth_terms(con.e2, lat, con.height0)):
        x[(_TERMS + i) * _W + j] = term
    law = Law(runs.p[run], runs.s[run], runs.ring[run])
    held = law_epoch(k * con.dt, v_e, v_n, q, runs.last[run], runs.log, law)
    x[_C_E * _W + j], x[_C_N * _W + j], x[_A_E * _W + j], x[_A_N * _W + j] = held
    if row >= 0:
        i = row if truth.shape[0] > 1 else 0
        t0, t1, t2, t3 = quaternion_of(truth[i, PITCH], truth[i, ROLL], truth[i, HEADING])
        phi_e, phi_n, phi_u = misalignment(q[0], q[1], q[2], q[3], t0, t1, t2, t3)
        out = runs.errors[row, run]
        out[0], out[1] = v_e - truth[i, VE], v_n - truth[i, VN]
        out[2] = con.lat0 + d_lat - truth[i, LAT]
        out[3] = con.lon0 - truth[i, LON] + x[_D_LON * _W + j]
        out[4], out[5], out[6] = phi_e, phi_n, phi_u


@kernel
def _advance_block(increments, first, pace, block, lanes, key, x, runs):
    """Advance one block, of which ``lanes`` lanes are in use, by a chunk."""
    begin, w = block * _W, np.empty(WORK)
    con = runs.con[begin]
    k, end = first, first + increments.shape[0]
    while True:
        if k % pace.law_every == 0 and (k < end or k == pace.final):
            row = k // pace.record_every if k % pace.record_every == 0 else -1
            for j in range(lanes):
                _epoch(k, begin + j, j, row, x, runs)
        if k == end:
            return
        n = min(pace.law_every - k % pace.law_every, end - k)
        if pace.noise_every > 0:
            n = min(n, pace.noise_every - k % pace.noise_every)
            if k % pace.noise_every == 0 or k == first:
                _draw(k // pace.noise_every, block, key, k == first, x, w)
        _run_samples(k - first, k - first + n, increments, con, x)
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
        self._noise_every = 0 if noise is None else noise.every
        self._key = np.uint64(0 if noise is None else stream_key(noise.seed, "batch.white"))
        blocks = -(-self.runs // WIDTH)
        self._x = np.zeros((blocks, _ROWS * WIDTH))
        self.errors = np.zeros((settings.samples // settings.record_every + 1, self.runs, ERRORS))
        self._own = _Runs(
            con=_stacked([constants(start, settings, earth) for start in starts], CONSTANTS),
            last=np.zeros(self.runs, LAST_CALL),
            p=_stacked([law.p for law in laws], LAW_PARAMETERS),
            s=_stacked([law.s for law in laws], LAW_STATE),
            ring=np.stack([law.ring for law in laws]),
            log=reference,
            truth=np.ascontiguousarray(truth, dtype=float),
            errors=self.errors,
        )
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
        set_ = self.settings
        pace = _Pace(set_.samples, set_.law_every, set_.record_every, self._noise_every)

        def one(block: int) -> None:
            lanes = min(WIDTH, self.runs - block * WIDTH)
            _advance_block(
                increments, self.position, pace, block, lanes, self._key, self._x[block], self._own
            )

        with ThreadPoolExecutor(workers) as pool:
            list(pool.map(one, range(len(self._x))))
        self.position += len(increments)
        return self.position >= self.settings.samples


def _stacked(records: Sequence[np.void], kind: np.dtype) -> np.ndarray:
    out = np.zeros(len(records), kind)
    for i, each in enumerate(records):
        out[i] = each
    return out
