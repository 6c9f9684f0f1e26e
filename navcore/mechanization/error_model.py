"""The linear phi-angle error model with the damping law inside, compiled.

Seven states x = [dV_E, dV_N, dL, dlambda, phi_E, phi_N, phi_U], integrated by RK4 at the run's step; sensor
errors and the law's correction are held over a step. With the Schuler frequency at 1.24e-3 rad/s and a step
of 1 s the RK4 error is below 1e-14 a step; what remains is the hold of the correction, half a step of delay,
which belongs to the sampled law itself (interface.md: the *difference* of the last log epoch is held).

The equations are those of theory.md section 2 with transport and Coriolis terms and f x phi along the
trajectory (Titterton & Weston ch. 12; Groves ch. 14); the vertical channel is locked.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from navcore.foundation.compiled import inlined, kernel
from navcore.law.azimuth import UpRate, steer
from navcore.law.law import Law, law_step
from navcore.law.records import E, N, Sensed, Watched
from navcore.law.user_law import ask_user_law
from navcore.mechanization.recorder import Errors, Recorder, flush, given_out, record
from navcore.mechanization.trajectory import Coefficients
from navcore.sensors.base import ReferenceErrors, SensorErrors

STATES = 7
UNDER_WAY, COMPLETE, DIVERGED = 0, 1, 2
TILT_LIMIT = 1.0
"""Beyond this misalignment (rad) a linear model says nothing: the run has diverged."""
VELOCITY_LIMIT = 1e5
"""m/s."""


class LogErrors(NamedTuple):
    """Errors of the reference velocity, as `navcore.sensors.base.ReferenceErrors`; of a batch with lanes."""

    time_s: np.ndarray
    error: np.ndarray
    valid: np.ndarray
    body_frame: bool
    hold_s: float


class Held(NamedTuple):
    """Values held over a step: sensor errors (rad/s, m/s^2); c (m/s), a (m/s^2), c_U (rad/s) of the law."""

    eps_e: float
    eps_n: float
    eps_u: float
    nabla_e: float
    nabla_n: float
    c_e: float
    c_n: float
    a_e: float
    a_n: float
    c_u: float


@inlined
def _rate(c, x, held):
    """Time derivative of the `Errors` x with the coefficients of one half step."""
    up = x.dv_e * c.tan_lat * c.inv_n + c.up_lat * x.d_lat
    coriolis_up = c.w_u + c.earth_u
    d_up = 2.0 * c.earth_n * x.d_lat + up
    d_north = -2.0 * c.earth_u * x.d_lat + x.dv_e * c.inv_n
    return Errors(
        c.f_n * x.phi_u
        - c.f_u * x.phi_n
        + coriolis_up * x.dv_n
        + d_up * c.v_n
        - d_north * c.v_u
        + held.nabla_e
        + held.a_e,
        c.f_u * x.phi_e
        - c.f_e * x.phi_u
        - coriolis_up * x.dv_e
        - d_up * c.v_e
        - x.dv_n * c.inv_m * c.v_u
        + held.nabla_n
        + held.a_n,
        x.dv_n * c.inv_m,
        (x.dv_e + c.v_e * c.tan_lat * x.d_lat) * c.inv_n * c.sec_lat,
        c.w_u * x.phi_n - c.w_n * x.phi_u - (x.dv_n + held.c_n) * c.inv_m - held.eps_e,
        c.w_e * x.phi_u - c.w_u * x.phi_e + (x.dv_e + held.c_e) * c.inv_n - c.earth_u * x.d_lat - held.eps_n,
        c.w_n * x.phi_e - c.w_e * x.phi_n + up + c.earth_n * x.d_lat + held.c_u - held.eps_u,
    )


@inlined
def _moved(x, h, k):
    """Return x + h k."""
    return Errors(
        x.dv_e + h * k.dv_e,
        x.dv_n + h * k.dv_n,
        x.d_lat + h * k.d_lat,
        x.d_lon + h * k.d_lon,
        x.phi_e + h * k.phi_e,
        x.phi_n + h * k.phi_n,
        x.phi_u + h * k.phi_u,
    )


@inlined
def _mean(k, l, m, n):  # noqa: E741
    """Return k + 2 (l + m) + n: six times the mean rate of the step."""
    return Errors(
        k.dv_e + 2.0 * (l.dv_e + m.dv_e) + n.dv_e,
        k.dv_n + 2.0 * (l.dv_n + m.dv_n) + n.dv_n,
        k.d_lat + 2.0 * (l.d_lat + m.d_lat) + n.d_lat,
        k.d_lon + 2.0 * (l.d_lon + m.d_lon) + n.d_lon,
        k.phi_e + 2.0 * (l.phi_e + m.phi_e) + n.phi_e,
        k.phi_n + 2.0 * (l.phi_n + m.phi_n) + n.phi_n,
        k.phi_u + 2.0 * (l.phi_u + m.phi_u) + n.phi_u,
    )


@inlined
def runge_kutta(x, h, begin, middle, end, held):
    """One step of the classical Runge-Kutta method from coefficients at its begin, middle and end."""
    k = _rate(begin, x, held)
    l = _rate(middle, _moved(x, 0.5 * h, k), held)  # noqa: E741
    m = _rate(middle, _moved(x, 0.5 * h, l), held)
    n = _rate(end, _moved(x, h, m), held)
    return _moved(x, h / 6.0, _mean(k, l, m, n))


@inlined
def newest_epoch(t, j, time_s):
    """Index of the newest log epoch at or before t, from the index j on (contract, log samples)."""
    while j + 1 < time_s.shape[0] and time_s[j + 1] <= t + 1e-9:
        j += 1
    return j


@inlined
def hold_difference(x, v_e, v_n, error_e, error_n, body_frame, s):
    """Hold the difference V_r - V_c of a new log epoch."""
    d_e = error_e - x.dv_e
    d_n = error_n - x.dv_n
    if body_frame:
        d_e += x.phi_u * v_n
        d_n -= x.phi_u * v_e
    s.difference[E], s.difference[N] = d_e, d_n


@inlined
def read_log(t, x, v_e, v_n, log, s):
    """Take the newest log epoch at t."""
    j = newest_epoch(t, s.epoch, log.time_s)
    if j > s.epoch:
        s.epoch = j
        hold_difference(x, v_e, v_n, log.error[j, 0], log.error[j, 1], log.body_frame, s)
    s.valid = log_is_valid(t, j, log)


@inlined
def log_is_valid(t, j, log):
    """Whether the log epoch j counts at t."""
    return j >= 0 and log.valid[j] and t - log.time_s[j] <= log.hold_s


@inlined
def in_range(x):
    """Whether the linear model still says something."""
    level = abs(x.phi_e) < TILT_LIMIT and abs(x.phi_n) < TILT_LIMIT and abs(x.phi_u) < TILT_LIMIT
    slow = abs(x.dv_e) < VELOCITY_LIMIT and abs(x.dv_n) < VELOCITY_LIMIT
    return level and slow and math.isfinite(x.d_lat + x.d_lon)


@inlined
def correction(law, sensed, begin, x):
    """Return the `Correction` of the level channels, and c_U (rad/s); with a step's first coefficients."""
    c, c_u = law_step(law, sensed), 0.0
    if law.p.azimuth_order > 0:
        if law.p.user.step != 0:
            lat = math.atan(begin.tan_lat) + x.d_lat
            return ask_user_law(law, sensed.v_e, sensed.v_n, sensed.heading, lat)
        c, c_u = steer(law, c, _up_rate(begin, x))
    return c, c_u


@inlined
def _up_rate(c, x):
    """Computed rate about the vertical with the `Errors` x, at the coefficients of a step's begin."""
    by_lat, by_v_e = c.earth_n + c.up_lat, c.tan_lat * c.inv_n
    return UpRate(c.w_u + by_lat * x.d_lat + by_v_e * x.dv_e, by_lat, by_v_e, c.inv_m, c.earth_n)


@kernel
def _advance(first, last, final, h, half, law_input, gyro, accel, log, law, state, recorder):
    """Integrate steps first..last of 0..final; ``state`` (7,), law and recorder go on from call to call."""
    half_stride = 1 if half.shape[0] > 1 else 0
    law_stride = 1 if law_input.shape[0] > 1 else 0
    gyro_stride = 1 if gyro.shape[0] > 1 else 0
    accel_stride = 1 if accel.shape[0] > 1 else 0
    s = law.s
    x = Errors(state[0], state[1], state[2], state[3], state[4], state[5], state[6])
    reached, code = last, UNDER_WAY
    for k in range(first, last):
        if not in_range(x):
            flush(recorder)
            reached, code = k, DIVERGED
            break
        t = k * h
        motion = law_input[k * law_stride]
        read_log(t, x, motion.v_e, motion.v_n, log, s)
        # the heading that the ship has is the computed one: level, it is off by phi_U (theory.md 2.3)
        begin = half[2 * k * half_stride]
        c, c_u = correction(
            law, Sensed(motion.v_e + x.dv_e, motion.v_n + x.dv_n, motion.heading + x.phi_u), begin, x
        )
        watched = Watched(float(s.wanted), 1.0 if s.damped else 0.0, s.xi, s.measure)
        record(k, given_out(x, s), begin.m, begin.n_cos, watched, recorder)
        if (k + 1) % recorder.bin_width == 0 or k + 1 == last:
            flush(recorder)
        if k == final:
            reached, code = k, COMPLETE
            break
        g, a = k * gyro_stride, k * accel_stride
        held = Held(
            gyro[g, 0], gyro[g, 1], gyro[g, 2], accel[a, 0], accel[a, 1], c.c_e, c.c_n, c.a_e, c.a_n, c_u
        )  # fmt: skip
        middle, end = half[(2 * k + 1) * half_stride], half[(2 * k + 2) * half_stride]
        x = runge_kutta(x, h, begin, middle, end, held)
    state[0], state[1], state[2], state[3] = x.dv_e, x.dv_n, x.d_lat, x.d_lon
    state[4], state[5], state[6] = x.phi_e, x.phi_n, x.phi_u
    return reached, code


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
        c, log = self.coefficients, self.reference
        reached, code = _advance(
            self.position, last, self.steps, self.step_s, c.half, c.law,
            self.sensors.gyro, self.sensors.accel,
            LogErrors(log.time_s, log.error, log.valid, log.body_frame, float(log.hold_s)),
            self.law, self.x, self.recorder,
        )  # fmt: skip
        self.diverged = code == DIVERGED
        self.position = reached
        return code != UNDER_WAY


def system_matrix(lat: float, radius: float, gravity: float, earth_rate: float) -> np.ndarray:
    """System matrix of the undamped model at rest, shape (7, 7) (theory.md section 2).

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
