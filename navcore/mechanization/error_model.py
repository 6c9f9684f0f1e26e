"""The linear phi-angle error model with the damping law inside, compiled.

Seven states x = [dV_E, dV_N, dL, dlambda, phi_E, phi_N, phi_U], integrated by RK4 at the run's step; sensor
errors and the law's correction are held over a step. With the Schuler frequency at 1.24e-3 rad/s and a step
of 1 s the RK4 error is below 1e-14 a step; what remains is the hold of the correction, half a step of delay,
which belongs to the sampled law itself (contract: the *difference* of the last log epoch is held).

The equations are those of physics.md section 2 with transport and Coriolis terms and f x phi along the
trajectory (Titterton & Weston ch. 12; Groves ch. 14); the vertical channel is locked.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from navcore.compiled import inlined, kernel
from navcore.control.law import Law, law_step
from navcore.control.layout import DAMPED, DIFFERENCE, EPOCH_INDEX, MEASURE, VALID, WANTED, XI
from navcore.mechanization.recorder import Recorder, flush, record
from navcore.mechanization.trajectory import (
    EARTH_N,
    EARTH_U,
    F_E,
    F_N,
    F_U,
    INV_M,
    INV_N,
    LAW_ACCEL,
    LAW_HEADING,
    LAW_V_E,
    LAW_V_N,
    N_COS,
    SEC_LAT,
    TAN_LAT,
    UP_LAT,
    V_E,
    V_N,
    V_U,
    W_E,
    W_N,
    W_U,
    Coefficients,
    M,
)
from navcore.sensors.base import ReferenceErrors, SensorErrors

STATES = 7
UNDER_WAY, COMPLETE, DIVERGED = 0, 1, 2
TILT_LIMIT = 1.0
"""Beyond this misalignment (rad) a linear model says nothing: the run has diverged."""
VELOCITY_LIMIT = 1e5
"""m/s."""


@inlined
def _rate(c, i, x0, x1, x2, x4, x5, x6, eps_e, eps_n, eps_u, nab_e, nab_n, c_e, c_n, a_e, a_n):
    """Time derivative of the seven states with row i of the coefficients."""
    up = x0 * c[i, TAN_LAT] * c[i, INV_N] + c[i, UP_LAT] * x2
    coriolis_up = c[i, W_U] + c[i, EARTH_U]
    d_up = 2.0 * c[i, EARTH_N] * x2 + up
    d_north = -2.0 * c[i, EARTH_U] * x2 + x0 * c[i, INV_N]
    r0 = (
        c[i, F_N] * x6
        - c[i, F_U] * x5
        + coriolis_up * x1
        + d_up * c[i, V_N]
        - d_north * c[i, V_U]
        + nab_e
        + a_e
    )
    r1 = (
        c[i, F_U] * x4
        - c[i, F_E] * x6
        - coriolis_up * x0
        - d_up * c[i, V_E]
        - x1 * c[i, INV_M] * c[i, V_U]
        + nab_n
        + a_n
    )
    r2 = x1 * c[i, INV_M]
    r3 = (x0 + c[i, V_E] * c[i, TAN_LAT] * x2) * c[i, INV_N] * c[i, SEC_LAT]
    r4 = c[i, W_U] * x5 - c[i, W_N] * x6 - (x1 + c_n) * c[i, INV_M] - eps_e
    r5 = c[i, W_E] * x6 - c[i, W_U] * x4 + (x0 + c_e) * c[i, INV_N] - c[i, EARTH_U] * x2 - eps_n
    r6 = c[i, W_N] * x4 - c[i, W_E] * x5 + up + c[i, EARTH_N] * x2 - eps_u
    return r0, r1, r2, r3, r4, r5, r6


@inlined
def _read_log(t, x, v_e, v_n, epoch_s, epoch_error, epoch_valid, body_frame, hold_s, s):
    """Take the newest log epoch at or before t and hold its difference V_r - V_c (contract, log samples)."""
    j = int(s[EPOCH_INDEX])
    fresh = False
    while j + 1 < epoch_s.shape[0] and epoch_s[j + 1] <= t + 1e-9:
        j += 1
        fresh = True
    s[EPOCH_INDEX] = j
    if fresh:
        d_e = epoch_error[j, 0] - x[0]
        d_n = epoch_error[j, 1] - x[1]
        if body_frame:
            d_e += x[6] * v_n
            d_n -= x[6] * v_e
        s[DIFFERENCE] = d_e
        s[DIFFERENCE + 1] = d_n
    s[VALID] = 1.0 if j >= 0 and epoch_valid[j] and t - epoch_s[j] <= hold_s else 0.0


@kernel
def _advance(
    first, last, final, h, half, law_rows, gyro, accel,
    epoch_s, epoch_error, epoch_valid, body_frame, hold_s,
    p, s, ring, x, row_steps, rows, stats, bin_width, bin_low, bin_high, bin_order, buffer, cursor,
):  # fmt: skip
    half_stride = 1 if half.shape[0] > 1 else 0
    law_stride = 1 if law_rows.shape[0] > 1 else 0
    gyro_stride = 1 if gyro.shape[0] > 1 else 0
    accel_stride = 1 if accel.shape[0] > 1 else 0
    h2, h6 = 0.5 * h, h / 6.0
    for k in range(first, last):
        x0, x1, x2, x3, x4, x5, x6 = x[0], x[1], x[2], x[3], x[4], x[5], x[6]
        if not (abs(x4) < TILT_LIMIT and abs(x5) < TILT_LIMIT and abs(x6) < TILT_LIMIT
                and abs(x0) < VELOCITY_LIMIT and abs(x1) < VELOCITY_LIMIT
                and math.isfinite(x2 + x3)):  # fmt: skip
            flush(k - 1, bin_width, buffer, stats, bin_low, bin_high, bin_order, cursor)
            return k, DIVERGED
        t = k * h
        j = k * law_stride
        v_e, v_n = law_rows[j, LAW_V_E], law_rows[j, LAW_V_N]
        _read_log(t, x, v_e, v_n, epoch_s, epoch_error, epoch_valid, body_frame, hold_s, s)
        c_e, c_n, a_e, a_n = law_step(
            p, s, ring, v_e + x0, v_n + x1, law_rows[j, LAW_ACCEL], law_rows[j, LAW_HEADING]
        )
        i0 = 2 * k * half_stride
        record(
            k, x, half[i0, M], half[i0, N_COS], s[DAMPED], s[XI], s[WANTED], s[MEASURE],
            row_steps, rows, buffer, cursor,
        )  # fmt: skip
        if (k + 1) % bin_width == 0 or k + 1 == last:
            flush(k, bin_width, buffer, stats, bin_low, bin_high, bin_order, cursor)
        if k == final:
            return k, COMPLETE
        g, a = k * gyro_stride, k * accel_stride
        eps_e, eps_n, eps_u, nab_e, nab_n = gyro[g, 0], gyro[g, 1], gyro[g, 2], accel[a, 0], accel[a, 1]
        i1, i2 = i0 + half_stride, i0 + 2 * half_stride
        k0, k1, k2, k3, k4, k5, k6 = _rate(
            half, i0, x0, x1, x2, x4, x5, x6,
            eps_e, eps_n, eps_u, nab_e, nab_n, c_e, c_n, a_e, a_n)  # fmt: skip
        l0, l1, l2, l3, l4, l5, l6 = _rate(
            half, i1, x0 + h2 * k0, x1 + h2 * k1, x2 + h2 * k2, x4 + h2 * k4, x5 + h2 * k5, x6 + h2 * k6,
            eps_e, eps_n, eps_u, nab_e, nab_n, c_e, c_n, a_e, a_n)  # fmt: skip
        m0, m1, m2, m3, m4, m5, m6 = _rate(
            half, i1, x0 + h2 * l0, x1 + h2 * l1, x2 + h2 * l2, x4 + h2 * l4, x5 + h2 * l5, x6 + h2 * l6,
            eps_e, eps_n, eps_u, nab_e, nab_n, c_e, c_n, a_e, a_n)  # fmt: skip
        n0, n1, n2, n3, n4, n5, n6 = _rate(
            half, i2, x0 + h * m0, x1 + h * m1, x2 + h * m2, x4 + h * m4, x5 + h * m5, x6 + h * m6,
            eps_e, eps_n, eps_u, nab_e, nab_n, c_e, c_n, a_e, a_n)  # fmt: skip
        x[0] = x0 + h6 * (k0 + 2.0 * (l0 + m0) + n0)
        x[1] = x1 + h6 * (k1 + 2.0 * (l1 + m1) + n1)
        x[2] = x2 + h6 * (k2 + 2.0 * (l2 + m2) + n2)
        x[3] = x3 + h6 * (k3 + 2.0 * (l3 + m3) + n3)
        x[4] = x4 + h6 * (k4 + 2.0 * (l4 + m4) + n4)
        x[5] = x5 + h6 * (k5 + 2.0 * (l5 + m5) + n5)
        x[6] = x6 + h6 * (k6 + 2.0 * (l6 + m6) + n6)
    return last, UNDER_WAY


@dataclass
class ErrorModelRun:
    """One method under way: its state, law and recorder; advanced in chunks so that it can be stopped.

    Attributes
    ----------
    step_s : float
        Integration step, s.
    steps : int
        Number of steps; states exist at 0..steps.
    x : ndarray, shape (7,)
        Present error state, SI.
    """

    step_s: float
    steps: int
    coefficients: Coefficients
    sensors: SensorErrors
    reference: ReferenceErrors
    law: Law
    x: np.ndarray
    recorder: Recorder
    position: int = 0
    diverged: bool = False

    def advance(self, steps: int) -> bool:
        """Integrate up to ``steps`` further steps; return True when the run is complete or has diverged."""
        last = min(self.position + steps, self.steps + 1)
        c, r, log = self.coefficients, self.recorder, self.reference
        reached, code = _advance(
            self.position, last, self.steps, self.step_s, c.half, c.law,
            self.sensors.gyro, self.sensors.accel,
            log.time_s, log.error, log.valid, log.body_frame, log.hold_s,
            self.law.p, self.law.s, self.law.ring, self.x, r.row_steps, r.rows, r.stats,
            r.bin_width, r.bin_low, r.bin_high, r.bin_order, r.buffer, r.cursor,
        )  # fmt: skip
        self.diverged = code == DIVERGED
        self.position = reached
        return code != UNDER_WAY


def system_matrix(lat: float, radius: float, gravity: float, earth_rate: float) -> np.ndarray:
    """System matrix of the undamped model at rest, shape (7, 7) (physics.md section 2).

    Parameters
    ----------
    lat : float
        Latitude, rad.
    radius, gravity : float
        Radius (m) and gravity (m/s^2) of the sphere.
    earth_rate : float
        Omega, rad/s.
    """
    wz, wy = earth_rate * math.sin(lat), earth_rate * math.cos(lat)
    f = np.zeros((7, 7))
    f[0, 1], f[0, 5] = 2.0 * wz, -gravity
    f[1, 0], f[1, 4] = -2.0 * wz, gravity
    f[2, 1] = 1.0 / radius
    f[3, 0] = 1.0 / (radius * math.cos(lat))
    f[4, 1], f[4, 5], f[4, 6] = -1.0 / radius, wz, -wy
    f[5, 0], f[5, 2], f[5, 4] = 1.0 / radius, -wz, -wz
    f[6, 0], f[6, 2], f[6, 4] = math.tan(lat) / radius, wy, wy
    return f
