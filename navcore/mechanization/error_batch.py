"""Many runs of the error model at once: the same motion and method, each run with its own errors and start.

Runs are the inner, vectorised dimension, as in `navcore.mechanization.strapdown.batch`, in the errors of the
sensors and the log too: so a step reads a few streams of memory, not five a run. Every number comes out as in
the single run, bit for bit. A batch keeps what an ensemble judges: spans and the last position.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.records import stacked
from navcore.law.law import LAW_PARAMETERS, LAW_STATE, Law
from navcore.law.records import Sensed
from navcore.mechanization.error_model import (
    Held,
    LogErrors,
    correction,
    hold_difference,
    in_range,
    log_is_valid,
    newest_epoch,
    runge_kutta,
)
from navcore.mechanization.recorder import Errors, given_out, no_readings, reading_steps, take_lengths
from navcore.mechanization.trajectory import Coefficients, RateTerms
from navcore.sensors.base import ReferenceErrors, SensorErrors

WIDTH = 8
"""Runs of a block."""
_W = WIDTH
# Rows of a block's flat state: the errors, then what is held over a step, of the sensors and of the law.
_HELD, _LAW, _ROWS = 7, 12, 17


class _Runs(NamedTuple):
    """Records of each run, and the log that they read at the same epochs."""

    p: np.ndarray  # of the laws
    s: np.ndarray
    ring: np.ndarray
    log: LogErrors  # error: (m, 2, WIDTH)
    axes: np.ndarray  # `AXES`, of the motion that all share
    spans: np.ndarray  # `SPAN`, shape (runs, spans)
    readings: np.ndarray  # (runs, m, 2), as of the single run's recorder
    position_m: np.ndarray
    diverged: np.ndarray


@inlined
def _half(c):
    """As scalars, so that LLVM knows that no store into the block's state changes them."""
    return RateTerms(
        c.w_e, c.w_n, c.w_u, c.f_e, c.f_n, c.f_u, c.inv_m, c.inv_n, c.tan_lat, c.earth_n, c.earth_u,
        c.v_e, c.v_n, c.v_u, c.up_lat, c.sec_lat,
    )  # fmt: skip


@inlined
def _errors_of(x, j):
    return Errors(x[j], x[_W + j], x[2 * _W + j], x[3 * _W + j], x[4 * _W + j], x[5 * _W + j], x[6 * _W + j])


@inlined
def _keep_errors(x, j, errors):
    x[j], x[_W + j], x[2 * _W + j], x[3 * _W + j] = errors.dv_e, errors.dv_n, errors.d_lat, errors.d_lon
    x[4 * _W + j], x[5 * _W + j], x[6 * _W + j] = errors.phi_e, errors.phi_n, errors.phi_u


@inlined
def _held_of(x, j):
    return Held(
        x[7 * _W + j], x[8 * _W + j], x[9 * _W + j], x[10 * _W + j], x[11 * _W + j],
        x[12 * _W + j], x[13 * _W + j], x[14 * _W + j], x[15 * _W + j], x[16 * _W + j],
    )  # fmt: skip


@inlined
def _take_epoch(t, j, run, x, motion, log, s):
    """Take the log epoch j, the newest at t, for one run with the `Errors` x."""
    if j > s.epoch:
        s.epoch = j
        of_e, of_n = log.error[j, 0, run], log.error[j, 1, run]
        hold_difference(x, motion.v_e, motion.v_n, of_e, of_n, log.body_frame, s)
    s.valid = log_is_valid(t, j, log)


@inlined
def _epoch(k, t, run, motion, begin, x, runs, epoch, reading):
    """Log, law and record of one run, lane of the same number, at step k; log epoch ``epoch`` is in force.

    The heading is read there as number ``reading``; not if that is negative.
    """
    errors = _errors_of(x, run)
    if not in_range(errors):
        runs.diverged[run] = True
        for row in range(_ROWS):
            x[row * _W + run] = 0.0
    if runs.diverged[run]:
        return
    log, law = runs.log, Law(runs.p[run], runs.s[run], runs.ring[run])
    _take_epoch(t, epoch, run, errors, motion, log, law.s)
    sensed = Sensed(motion.v_e + errors.dv_e, motion.v_n + errors.dv_n, motion.heading + errors.phi_u)
    c, c_u = correction(law, sensed, begin, errors)
    north, east = begin.m * errors.d_lat, begin.n_cos * errors.d_lon
    position = math.sqrt(north * north + east * east)
    runs.position_m[run] = position
    axes = runs.axes[k if runs.axes.shape[0] > 1 else 0]
    take_lengths(k, given_out(errors, law.s), position, axes, runs.spans[run])
    if reading >= 0:
        runs.readings[run, reading, 0] = errors.phi_u
        runs.readings[run, reading, 1] = errors.phi_u * axes.cos_lat
    x[_LAW * _W + run], x[(_LAW + 1) * _W + run] = c.c_e, c.c_n
    x[(_LAW + 2) * _W + run], x[(_LAW + 3) * _W + run], x[(_LAW + 4) * _W + run] = c.a_e, c.a_n, c_u


@kernel
def _advance_block(first, last, final, h, half, law_input, gyro, accel, x, runs, reading_every):
    """Integrate steps first..last of 0..final for all runs of a block; ``gyro`` and ``accel`` are flat."""
    half_stride = 1 if half.shape[0] > 1 else 0
    law_stride = 1 if law_input.shape[0] > 1 else 0
    gyro_stride = 3 * _W if gyro.shape[0] > 3 * _W else 0
    accel_stride = 3 * _W if accel.shape[0] > 3 * _W else 0
    epoch = -1
    for k in range(first, last):
        record = half[2 * k * half_stride]
        epoch = newest_epoch(k * h, epoch, runs.log.time_s)
        reading = k // reading_every if k % reading_every == 0 else -1
        for run in range(runs.p.shape[0]):
            _epoch(k, k * h, run, law_input[k * law_stride], record, x, runs, epoch, reading)
        if k == final:
            return
        begin = _half(record)
        middle, end = _half(half[(2 * k + 1) * half_stride]), _half(half[(2 * k + 2) * half_stride])
        of_gyro, of_accel = gyro[k * gyro_stride :], accel[k * accel_stride :]
        # into the state first: where the steps themselves read a second array, LLVM does not vectorise them
        for j in range(3 * _W):
            x[_HELD * _W + j] = of_gyro[j]
        for j in range(2 * _W):
            x[(_HELD + 3) * _W + j] = of_accel[j]
        for j in range(_W):
            _keep_errors(x, j, runge_kutta(_errors_of(x, j), h, begin, middle, end, _held_of(x, j)))


class ErrorModelBatch:
    """Up to `WIDTH` runs of one method under way.

    Parameters
    ----------
    step_s : float
        Integration step, s.
    steps : int
        Number of steps; states exist at 0..steps.
    coefficients : Coefficients
        Along the motion that all share.
    sensors : SensorErrors
        Of all runs side by side, shapes (n, 3, WIDTH).
    reference : ReferenceErrors
        Likewise: the errors have shape (m, 2, WIDTH).
    law : Law
        Of the method, as each run begins with it.
    starts : sequence of ndarray, shape (7,)
        Errors at t = 0, SI.
    spans : ndarray of `navcore.mechanization.recorder.SPAN`
        Empty.

    Attributes
    ----------
    spans : ndarray of `SPAN`, shape (runs, spans)
        Lengths of each run's error vectors, as of the single run's recorder.
    readings : ndarray, shape (runs, m, 2)
        Of the heading, as of the single run's recorder.
    position_m : ndarray, shape (runs,)
        Last position error, m.
    diverged : ndarray of bool, shape (runs,)
        Runs that left the range of the linear model.

    Raises
    ------
    ValueError
        There are too many runs.
    """

    def __init__(
        self,
        step_s: float,
        steps: int,
        coefficients: Coefficients,
        sensors: SensorErrors,
        reference: ReferenceErrors,
        law: Law,
        starts: Sequence[np.ndarray],
        spans: np.ndarray,
    ) -> None:
        if (runs := len(starts)) > WIDTH:
            raise ValueError(f"a batch has at most {WIDTH} runs, not {runs}")
        self._step_s, self._steps, self._position = step_s, steps, 0
        self._coefficients = coefficients
        self._gyro, self._accel = sensors.gyro.reshape(-1), sensors.accel.reshape(-1)
        self.spans = np.tile(spans[spans["first"] <= steps], (runs, 1))
        self._reading_every = reading_steps(step_s)
        self.readings = np.stack([no_readings(steps, self._reading_every)] * runs)
        self.position_m, self.diverged = np.zeros(runs), np.zeros(runs, bool)
        self._runs = _Runs(
            p=stacked([law.p] * runs, LAW_PARAMETERS),
            s=stacked([law.s] * runs, LAW_STATE),
            ring=np.stack([law.ring] * runs),
            log=LogErrors(
                reference.time_s,
                reference.error,
                reference.valid,
                reference.body_frame,
                float(reference.hold_s),
            ),
            axes=coefficients.axes,
            spans=self.spans,
            readings=self.readings,
            position_m=self.position_m,
            diverged=self.diverged,
        )
        x = np.zeros((_ROWS, WIDTH))
        x[:_HELD, :runs] = np.transpose(starts)
        self._x = x.reshape(-1)

    def advance(self, steps: int) -> bool:
        """Integrate up to ``steps`` further steps; return True when the runs are complete."""
        last = min(self._position + steps, self._steps + 1)
        c = self._coefficients
        _advance_block(
            self._position, last, self._steps, self._step_s, c.half, c.law, self._gyro, self._accel,
            self._x, self._runs, self._reading_every,
        )  # fmt: skip
        self._position = last
        return last > self._steps
