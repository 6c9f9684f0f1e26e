"""The Kalman filter on the linear error model: what it finds of the errors is taken off step by step."""

from dataclasses import dataclass

import numpy as np

from navcore.foundation.compiled import kernel
from navcore.law.law import Law
from navcore.law.records import E, N, Watched
from navcore.mechanization.error_model import (
    COMPLETE,
    DIVERGED,
    UNDER_WAY,
    Held,
    LogErrors,
    in_range,
    read_log,
    runge_kutta,
)
from navcore.mechanization.kalman.filter import (
    FilterModel,
    FilterState,
    fill_transition,
    fill_turn,
    keep_sigma,
    predict,
    sensed_errors,
    update,
)
from navcore.mechanization.recorder import Errors, Recorder, flush, record
from navcore.mechanization.trajectory import Coefficients
from navcore.motion.truth import HEADING, PITCH, ROLL
from navcore.sensors.base import ReferenceErrors, SensorErrors


@kernel
def _advance(
    first, last, final, h, half, law_input, truth, gyro, accel, log, s, state, recorder, model, f
):  # fmt: skip
    """Integrate steps first..last of 0..final; state, filter and recorder go on from call to call."""
    half_stride = 1 if half.shape[0] > 1 else 0
    law_stride = 1 if law_input.shape[0] > 1 else 0
    truth_stride = 1 if truth.shape[0] > 1 else 0
    gyro_stride = 1 if gyro.shape[0] > 1 else 0
    accel_stride = 1 if accel.shape[0] > 1 else 0
    x = Errors(state[0], state[1], state[2], state[3], state[4], state[5], state[6])
    reached, code = last, UNDER_WAY
    for k in range(first, last):
        if not in_range(x):
            flush(recorder)
            reached, code = k, DIVERGED
            break
        log_inputs, true = law_input[k * law_stride], truth[2 * k * truth_stride]
        before = s.epoch
        read_log(k * h, x, log_inputs.v_e, log_inputs.v_n, log, s)
        fill_turn(true[PITCH], true[ROLL], true[HEADING], f.turn)
        if s.epoch != before and s.valid:
            update(model, s.epoch, s.difference[E], s.difference[N], log_inputs.v_e, log_inputs.v_n, f)
            d = f.errors
            x = Errors(
                x.dv_e - d[0], x.dv_n - d[1], x.d_lat - d[2], x.d_lon - d[3],
                x.phi_e - d[4], x.phi_n - d[5], x.phi_u - d[6],
            )  # fmt: skip
        begin, row = half[2 * k * half_stride], recorder.cursor.row
        record(k, x, begin.m, begin.n_cos, Watched(0.0, 0.0, 0.0, 0.0), recorder)
        if recorder.cursor.row > row:
            keep_sigma(f, row)
        if (k + 1) % recorder.bin_width == 0 or k + 1 == last:
            flush(recorder)
        if k == final:
            reached, code = k, COMPLETE
            break
        middle, end = half[(2 * k + 1) * half_stride], half[(2 * k + 2) * half_stride]
        g_e, g_n, g_u, a_e, a_n = sensed_errors(model, f)
        g, a = k * gyro_stride, k * accel_stride
        held = Held(
            gyro[g, 0] - g_e, gyro[g, 1] - g_n, gyro[g, 2] - g_u, accel[a, 0] - a_e, accel[a, 1] - a_n,
            0.0, 0.0, 0.0, 0.0, 0.0,
        )  # fmt: skip
        x = runge_kutta(x, h, begin, middle, end, held)
        if (half_stride or k == first) and not f.known:
            fill_transition(h, begin, middle, end, f)
        predict(model, f)
    state[0], state[1], state[2], state[3] = x.dv_e, x.dv_n, x.d_lat, x.d_lon
    state[4], state[5], state[6] = x.phi_e, x.phi_n, x.phi_u
    return reached, code


@dataclass
class FilteredErrorModel:
    """One run of the filter under way; advanced, stopped and read like an `ErrorModelRun`.

    Attributes
    ----------
    step_s : float
        Integration step, s.
    steps : int
        Number of steps; states exist at 0..steps.
    coefficients, sensors, reference
        Of the run, as in `ErrorModelRun`.
    truth : ndarray, shape (2 steps + 1, 15) or (1, 15)
        True motion on half steps: its attitude turns the sensors' axes.
    law : Law
        Of a free method: keeps the log's difference and epoch.
    x : ndarray, shape (7,)
        Present error state, SI.
    model : FilterModel
        What the filter is told.
    filter : FilterState
        Its covariance and estimates.
    """

    step_s: float
    steps: int
    coefficients: Coefficients
    sensors: SensorErrors
    reference: ReferenceErrors
    truth: np.ndarray
    law: Law
    x: np.ndarray
    recorder: Recorder
    model: FilterModel
    filter: FilterState
    position: int = 0
    diverged: bool = False

    def advance(self, steps: int) -> bool:
        """Integrate up to ``steps`` further steps; return True when the run is complete or has diverged."""
        last = min(self.position + steps, self.steps + 1)
        c, log = self.coefficients, self.reference
        reached, code = _advance(
            self.position, last, self.steps, self.step_s, c.half, c.law, self.truth,
            self.sensors.gyro, self.sensors.accel,
            LogErrors(log.time_s, log.error, log.valid, log.body_frame, float(log.hold_s)),
            self.law.s, self.x, self.recorder, self.model, self.filter,
        )  # fmt: skip
        self.diverged = code == DIVERGED
        self.position = reached
        return code != UNDER_WAY
