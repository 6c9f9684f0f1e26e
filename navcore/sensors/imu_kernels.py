"""Compiled parts of the IMU error model: mean attitude, scaled signals, quantisation, turning.

An array with one row stands for all steps. Rows are addressed by index: a view of each row
(``row = values[i]``) made these loops ten times slower.
"""

import numpy as np

from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.trigonometry import sincos
from navcore.motion.inertial import inertial_row
from navcore.motion.truth import HEADING, PITCH, ROLL

_CHUNK = 128


@kernel
def mean_attitude(values, out):
    """Simpson's mean of C_b^n over each step into ``out`` (n, 9); ``values`` has 2 n + 1 rows of truth.

    Works on chunks with the angles side by side: only so are sine and cosine vectorised.
    """
    trig = np.empty((6, 2 * _CHUNK + 1))
    c = np.empty((9, 2 * _CHUNK + 1))
    for first in range(0, out.shape[0], _CHUNK):
        steps = min(_CHUNK, out.shape[0] - first)
        rows = 2 * steps + 1
        for i in range(rows):
            trig[0, i] = values[2 * first + i, PITCH]
            trig[2, i] = values[2 * first + i, ROLL]
            trig[4, i] = values[2 * first + i, HEADING]
        for axis in range(3):
            for i in range(rows):
                trig[2 * axis, i], trig[2 * axis + 1, i] = sincos(trig[2 * axis, i])
        for i in range(rows):
            sp, cp, sr, cr, sh, ch = trig[0, i], trig[1, i], trig[2, i], trig[3, i], trig[4, i], trig[5, i]
            c[0, i], c[1, i], c[2, i] = ch * cr + sh * sp * sr, sh * cp, ch * sr - sh * sp * cr
            c[3, i], c[4, i], c[5, i] = ch * sp * sr - sh * cr, ch * cp, -sh * sr - ch * sp * cr
            c[6, i], c[7, i], c[8, i] = -cp * sr, sp, cp * cr
        for k in range(steps):
            for j in range(9):
                out[first + k, j] = (c[j, 2 * k] + 4.0 * c[j, 2 * k + 1] + c[j, 2 * k + 2]) / 6.0


@kernel
def attitude_changes(values):
    """True when pitch, roll or heading of any row of truth differs from the first."""
    for i in range(1, values.shape[0]):
        for column in (PITCH, ROLL, HEADING):
            if values[i, column] != values[0, column]:
                return True
    return False


@inlined
def _scaled_row(values, i, level, e2, g_equator, k, coupling, felt, out):
    """Write the true signals (body axes) and C_b^n coupling signal (n frame) at row i into ``out[0:12]``."""
    c = inertial_row(values, i, level, e2, g_equator, k, felt)
    for sensor in range(2):
        j = 3 * sensor
        x, y, z = felt[j], felt[j + 1], felt[j + 2]
        u = coupling[sensor, 0, 0] * x + coupling[sensor, 0, 1] * y + coupling[sensor, 0, 2] * z
        v = coupling[sensor, 1, 0] * x + coupling[sensor, 1, 1] * y + coupling[sensor, 1, 2] * z
        w = coupling[sensor, 2, 0] * x + coupling[sensor, 2, 1] * y + coupling[sensor, 2, 2] * z
        out[j], out[j + 1], out[j + 2] = x, y, z
        out[j + 6] = c[0] * u + c[1] * v + c[2] * w
        out[j + 7] = c[3] * u + c[4] * v + c[5] * w
        out[j + 8] = c[6] * u + c[7] * v + c[8] * w


@kernel
def scaled_signals(values, level, e2, g_equator, k, coupling, signal, turned):
    """Simpson's mean over each step of the true signals (body axes), and of C_b^n coupling signal (n frame).

    ``coupling`` (2, 3, 3), ``signal`` and ``turned`` (2, n, 3): gyros first, then accelerometers.
    """
    felt, row, total = np.empty(6), np.empty(12), np.zeros(12)
    single = values.shape[0] == 1
    for i in range(values.shape[0]):
        _scaled_row(values, i, level, e2, g_equator, k, coupling, felt, row)
        if i % 2 == 1:
            for j in range(12):
                total[j] += 4.0 * row[j]
            continue
        if i > 0 or single:
            step = 0 if single else i // 2 - 1
            for j in range(6):
                mean = row[j] if single else (total[j] + row[j]) / 6.0
                product = row[j + 6] if single else (total[j + 6] + row[j + 6]) / 6.0
                signal[j // 3, step, j % 3], turned[j // 3, step, j % 3] = mean, product
        for j in range(12):
            total[j] = row[j]


@kernel
def add_quantisation(signal, coupling, lsb, step, error):
    """Add what counting does to the errors: increments in whole counts, the rest goes into the next one."""
    stride = 1 if signal.shape[0] > 1 else 0
    for j in range(3):
        rest = 0.0
        if lsb[j] > 0.0:
            for i in range(error.shape[0]):
                s = i * stride
                reading = signal[s, j] + error[i, j]
                for m in range(3):
                    reading += coupling[j, m] * signal[s, m]
                increment = rest + step * reading
                left = increment - lsb[j] * np.floor(increment / lsb[j] + 0.5)
                error[i, j] += (rest - left) / step
                rest = left


@kernel
def turn_errors(turning, coupled, body, errors):
    """Turn errors from body axes to the navigation frame, and add those that are there already.

    ``turning`` is C_b^n row by row, ``body`` (IMUs, n, 3), ``errors`` (n, 3, width): places beyond the IMUs
    repeat the first.
    """
    turn_stride = 1 if turning.shape[0] > 1 else 0
    coupled_stride = 1 if coupled.shape[0] > 1 else 0
    body_stride = 1 if body.shape[1] > 1 else 0
    for i in range(errors.shape[0]):
        b, c, extra = i * body_stride, i * turn_stride, i * coupled_stride
        for place in range(errors.shape[2]):
            imu = place if place < body.shape[0] else 0
            x, y, z = body[imu, b, 0], body[imu, b, 1], body[imu, b, 2]
            for j in range(3):
                total = turning[c, 3 * j] * x + turning[c, 3 * j + 1] * y + turning[c, 3 * j + 2] * z
                errors[i, j, place] = total + coupled[extra, j]
