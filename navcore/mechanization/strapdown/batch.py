"""Many strapdown runs at once: the same motion, each run with its own increments, log, start and law.

Runs are the inner, vectorised dimension. All states of a block lie in one flat array whose width is known
when compiling: with row views LLVM did not vectorise. Vertical channel locked. The law runs once an interval
for each run, as in the single run. A batch keeps what an ensemble judges: spans and the last position.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.earth import Earth
from navcore.foundation.records import stacked
from navcore.law.law import LAW_PARAMETERS, LAW_STATE, Law
from navcore.mechanization.recorder import axes_along, given_out, no_readings, reading_steps, take_lengths
from navcore.mechanization.strapdown.kernel import (
    arms,
    azimuth_epoch,
    errors_at,
    law_epoch,
    navigates,
    true_attitude,
)
from navcore.mechanization.strapdown.log import VelocityReference
from navcore.mechanization.strapdown.records import CONSTANTS, LARGEST_LATITUDE, LAST_CALL, constants_of
from navcore.mechanization.strapdown.run import Settings, Start, constants
from navcore.mechanization.strapdown.step import (
    EarthTerms,
    Held,
    Increment,
    Navigation,
    earth_terms,
    strapdown_step,
)

WIDTH = 16
"""Runs of a block."""
_W = WIDTH
# Rows of a block's flat state: what changes, then what is held, then the previous increment.
_D_LAT, _D_LON, _V_E, _V_N, _Q, _Z, _M_E, _M_N, _M_LAT = 0, 1, 2, 3, 4, 8, 12, 13, 14
_C_E, _C_N, _A_E, _A_N, _TERMS, _ORIGIN, _BEFORE, _C_U = 15, 16, 17, 18, 19, 27, 28, 34
_ROWS = 35


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
def _increment_of(rows, first, j):
    """Increment of lane j, whose six numbers begin at row ``first`` of flat rows."""
    return Increment(
        rows[first * _W + j], rows[(first + 1) * _W + j], rows[(first + 2) * _W + j],
        rows[(first + 3) * _W + j], rows[(first + 4) * _W + j], rows[(first + 5) * _W + j],
    )  # fmt: skip


@inlined
def _keep_before(x, j, now):
    x[_BEFORE * _W + j], x[(_BEFORE + 1) * _W + j], x[(_BEFORE + 2) * _W + j] = now.tx, now.ty, now.tz
    x[(_BEFORE + 3) * _W + j], x[(_BEFORE + 4) * _W + j] = now.bx, now.by
    x[(_BEFORE + 5) * _W + j] = now.bz


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
        # sliced: of a place in the whole array numba would ask, lane by lane, whether it is negative
        rows = increments[6 * _W * i : 6 * _W * (i + 1)]
        for j in range(_W):
            now = _increment_of(rows, 0, j)
            held = Held(
                x[_C_E * _W + j], x[_C_N * _W + j], x[_C_U * _W + j],
                x[_A_E * _W + j], x[_A_N * _W + j], 0.0, 0.0,
            )  # fmt: skip
            nav = strapdown_step(
                step, now, _increment_of(x, _BEFORE, j), _navigation_of(x, j, height), _terms_of(x, j),
                x[_ORIGIN * _W + j], held, False,
            )  # fmt: skip
            _keep_before(x, j, now)
            _keep_navigation(x, j, nav)


class _Runs(NamedTuple):
    """Records of each run, their logs one behind the other, and the common truth."""

    con: np.ndarray  # `records.CONSTANTS`, a run each
    last: np.ndarray  # `records.LAST_CALL`
    p: np.ndarray  # of the laws
    s: np.ndarray
    ring: np.ndarray
    log: VelocityReference
    truth: np.ndarray
    axes: np.ndarray  # `AXES`, at the rows of the truth
    spans: np.ndarray  # `SPAN`, shape (runs, MOST_SPANS)
    readings: np.ndarray  # (runs, m, 2), as of the single run's recorder
    position_m: np.ndarray
    diverged: np.ndarray
    reading_every: int


class _Pace(NamedTuple):
    """Samples of the run, between two calls of the law, and between two records."""

    final: int
    law_every: int
    record_every: int


@inlined
def _record(row, run, errors, m, n_cos, runs):
    """Take the errors of one run at record ``row`` into its spans; m, n_cos of `arms`."""
    north, east = m * errors.d_lat, n_cos * errors.d_lon
    position = math.sqrt(north * north + east * east)
    runs.position_m[run] = position
    axes = runs.axes[row if runs.axes.shape[0] > 1 else 0]
    take_lengths(row, errors, position, axes, runs.spans[run])
    if row % runs.reading_every == 0:
        place = row // runs.reading_every
        runs.readings[run, place, 0] = errors.phi_u
        runs.readings[run, place, 1] = errors.phi_u * axes.cos_lat


@kernel
def _epoch(k, run, row, true_q, m, n_cos, x, runs):
    """Earth terms, law and record of one run, lane of the same number, at sample k.

    What the truth says of record ``row`` is the same for all runs: its quaternion, and m, n_cos of `arms`.
    """
    con, truth, j = runs.con[run], runs.truth, run
    d_lat, v_e, v_n = x[_D_LAT * _W + j], x[_V_E * _W + j], x[_V_N * _W + j]
    q = (x[_Q * _W + j], x[(_Q + 1) * _W + j], x[(_Q + 2) * _W + j], x[(_Q + 3) * _W + j])
    lat = con.lat0 + d_lat
    if not abs(lat) < LARGEST_LATITUDE:
        runs.diverged[run] = True
        lat = 0.0 if not math.isfinite(lat) else math.copysign(LARGEST_LATITUDE, lat)
    x[_ORIGIN * _W + j] = d_lat
    terms = earth_terms(con.e2, lat, con.height0)
    for i, term in enumerate(terms):
        x[(_TERMS + i) * _W + j] = term
    law, logs = Law(runs.p[run], runs.s[run], runs.ring[run]), runs.log
    log = VelocityReference(
        logs.time_s[run], logs.velocity[run], logs.valid[run], logs.body_frame, logs.hold_s
    )  # fmt: skip
    held = law_epoch(k * con.dt, v_e, v_n, q, runs.last[run], log, law)
    held, x[_C_U * _W + j] = azimuth_epoch(law, held, terms, runs.last[run])
    x[_C_E * _W + j], x[_C_N * _W + j], x[_A_E * _W + j], x[_A_N * _W + j] = held
    if row >= 0:
        i = row if truth.shape[0] > 1 else 0
        errors = errors_at(con, d_lat, x[_D_LON * _W + j], v_e, v_n, q, truth, i, true_q)
        if not navigates(errors, con.height0):
            runs.diverged[run] = True
        if not runs.diverged[run]:
            _record(row, run, given_out(errors, law.s), m, n_cos, runs)


@kernel
def _advance_block(increments, samples, first, pace, x, runs):
    """Advance a block by a chunk of so many samples."""
    k, end = first, first + samples
    while True:
        if k % pace.law_every == 0 and (k < end or k == pace.final):
            row = k // pace.record_every if k % pace.record_every == 0 else -1
            true_q, m, n_cos = (1.0, 0.0, 0.0, 0.0), 0.0, 0.0
            if row >= 0:
                i = row if runs.truth.shape[0] > 1 else 0
                true_q = true_attitude(runs.truth, i)
                m, n_cos = arms(runs.con[0], runs.truth, i)
            for run in range(runs.con.shape[0]):
                _epoch(k, run, row, true_q, m, n_cos, x, runs)
        if k == end:
            return
        n = min(pace.law_every - k % pace.law_every, end - k)
        _run_samples(k - first, k - first + n, increments, runs.con[0], x)
        k += n


class BatchRun:
    """Up to `WIDTH` runs of one method under way; give it their increments chunk by chunk.

    Parameters
    ----------
    starts : sequence of Start
        One a run, at the same height.
    laws : sequence of Law
        One a run, of one method.
    logs : sequence of VelocityReference
        One a run, with as many epochs each.
    settings : Settings
        Common; vertical must be locked, ``record_every`` a multiple of ``law_every``.
    earth : Earth
        Earth model.
    truth : ndarray, shape (records + 1, 15) or (1, 15)
        True states at the recorded times.
    spans : ndarray of `SPAN`, shape (MOST_SPANS,)
        Empty, from `navcore.mechanization.recorder.spans_from`.
    before : ndarray, shape (6,)
        Increment of the interval that ends at t = 0.

    Attributes
    ----------
    spans : ndarray of `SPAN`, shape (runs, MOST_SPANS)
        Lengths of each run's error vectors, as of the single run's recorder.
    readings : ndarray, shape (runs, m, 2)
        Of the heading, as of the single run's recorder.
    position_m : ndarray, shape (runs,)
        Last recorded position error, m.
    diverged : ndarray of bool, shape (runs,)
        Runs that left the range in which they mean anything.

    Raises
    ------
    ValueError
        Settings that a batch cannot do.
    """

    def __init__(
        self,
        starts: Sequence[Start],
        laws: Sequence[Law],
        logs: Sequence[VelocityReference],
        settings: Settings,
        earth: Earth,
        truth: np.ndarray,
        spans: np.ndarray,
        before: np.ndarray,
    ) -> None:
        if settings.vertical != "locked":
            raise ValueError("a batch has a locked vertical channel")
        if settings.record_every % settings.law_every or settings.samples % settings.record_every:
            raise ValueError("samples must be a multiple of record_every, and that of law_every")
        if (runs := len(starts)) > WIDTH:
            raise ValueError(f"a batch has at most {WIDTH} runs, not {runs}")
        self.settings, self.position = settings, 0
        self.spans = np.tile(spans, (runs, 1))
        every = reading_steps(settings.record_step_s)
        self.readings = np.stack([no_readings(settings.samples // settings.record_every, every)] * runs)
        self.position_m, self.diverged = np.zeros(runs), np.zeros(runs, bool)
        self._own = _Runs(
            con=stacked([constants(start, settings, earth) for start in starts], CONSTANTS),
            last=np.zeros(runs, LAST_CALL),
            p=stacked([law.p for law in laws], LAW_PARAMETERS),
            s=stacked([law.s for law in laws], LAW_STATE),
            ring=np.stack([law.ring for law in laws]),
            log=VelocityReference(
                np.stack([log.time_s for log in logs]),
                np.stack([log.velocity for log in logs]),
                np.stack([log.valid for log in logs]),
                logs[0].body_frame,
                logs[0].hold_s,
            ),
            truth=np.ascontiguousarray(truth, dtype=float),
            axes=axes_along(truth),
            spans=self.spans,
            readings=self.readings,
            position_m=self.position_m,
            diverged=self.diverged,
            reading_every=every,
        )
        x = np.zeros((_ROWS, WIDTH))
        for lane in range(WIDTH):
            start = starts[lane if lane < runs else 0]
            x[[_V_E, _V_N], lane] = start.velocity[:2]
            x[_Q : _Q + 4, lane] = start.quaternion
        x[_BEFORE : _BEFORE + 6] = np.asarray(before)[:, np.newaxis]
        x[_TERMS + 6] = 1.0
        self._x = x.reshape(-1)

    def advance(self, increments: np.ndarray) -> None:
        """Integrate a chunk; what lies beyond the end of the run is not taken.

        Parameters
        ----------
        increments : ndarray, shape (n, 6, WIDTH)
            Of each run, as `navcore.sensors.imu_simulation.side_by_side` lays them.
        """
        set_ = self.settings
        samples = min(len(increments), set_.samples - self.position)
        if samples == 0:
            return
        pace = _Pace(set_.samples, set_.law_every, set_.record_every)
        _advance_block(increments.reshape(-1), samples, self.position, pace, self._x, self._own)
        self.position += samples
