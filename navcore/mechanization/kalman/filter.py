"""The velocity-aided Kalman filter (theory.md 16): covariance, gain and estimates, compiled.

Its states are the seven errors of the navigation and the errors of the sensors, each a first-order
Gauss-Markov process or a constant. It is closed loop: what it estimates of the navigation is corrected at
once, so that only the estimates of the sensors are carried. The covariance moves with the transition of the
error model itself: the Runge-Kutta step, applied to unit vectors.
"""

import math
from typing import NamedTuple

import numpy as np

from navcore.foundation.compiled import inlined, kernel
from navcore.mechanization.error_model import STATES, Held, runge_kutta
from navcore.mechanization.recorder import Errors

GYRO, ACCEL, LOG, WATER, SCALE, AXES = 0, 3, 6, 8, 10, 11
"""First axis of each sensor among the axes of all: three gyros, three accelerometers, two of the log; the
velocity of the water, east and north, and the scale error of the log."""
INPUTS = 5
"""Sensor errors of the error model: eps in E, N, U, nabla in E, N."""


class FilterModel(NamedTuple):
    """Model of the filter over one step.

    Attributes
    ----------
    axis : ndarray of int, shape (m,)
        Axis of each state of a sensor, 0 to `AXES` - 1.
    left : ndarray, shape (m,)
        Share of the state that a step leaves; 1 for a constant.
    drive : ndarray, shape (m,)
        Variance that a step adds, SI.
    gyro_white, accel_white : float
        Variance of the white errors' mean over a step, (rad/s)^2 and (m/s^2)^2.
    log_white : float
        Variance of a sample of the log, (m/s)^2.
    body_frame : bool
        The log measures along the ship's axes and is turned by the computed heading.
    moored : ndarray of bool, shape (k,) or (0,)
        Samples that are the velocity zero of a moored ship.
    moored_white : float
        Variance of such a sample, (m/s)^2.
    """

    axis: np.ndarray
    left: np.ndarray
    drive: np.ndarray
    gyro_white: float
    accel_white: float
    log_white: float
    body_frame: bool
    moored: np.ndarray
    moored_white: float


class FilterState(NamedTuple):
    """State of the filter; n = 7 + m states.

    Attributes
    ----------
    P : ndarray, shape (n, n)
        Covariance of its error, SI; first dV_E, dV_N, dL, dlambda, phi_E, phi_N, phi_U.
    sensors : ndarray, shape (m,)
        Estimates of the sensors' states.
    turn : ndarray, shape (3, 3)
        C_b^n of the present step.
    moved : ndarray, shape (7, n)
        Transition of the seven errors over the present step.
    inputs : ndarray, shape (7, 5)
        Their response to sensor errors that are held over it.
    sigma : ndarray, shape (rows, 7)
        Standard deviations of the seven errors at the output rows, as the filter has them.
    scratch : ndarray, shape (n, n)
    errors : ndarray, shape (n,)
        What the last sample of the log corrected.
    gains : ndarray, shape (epochs, 2, n)
        Gains of each epoch of the log, for both components; no epochs where they are not kept.
    known : bool
        The gains are known: they depend on the truth and on the model alone, so that runs with other noise
        share them, and the covariance need not be carried.
    """

    P: np.ndarray
    sensors: np.ndarray
    turn: np.ndarray
    moved: np.ndarray
    inputs: np.ndarray
    sigma: np.ndarray
    scratch: np.ndarray
    errors: np.ndarray
    gains: np.ndarray
    known: bool


def filter_state(
    P: np.ndarray, rows: int, gains: np.ndarray | None = None, known: bool = False
) -> FilterState:
    """State at t = 0 from the covariance, shape (n, n), of a run with so many output rows."""
    n = len(P)
    return FilterState(
        np.array(P, dtype=float), np.zeros(n - STATES), np.eye(3), np.zeros((STATES, n)),
        np.zeros((STATES, INPUTS)), np.zeros((rows, STATES)), np.zeros((n, n)), np.zeros(n),
        np.zeros((0, 2, n)) if gains is None else gains, known,
    )  # fmt: skip


@inlined
def _one(j, k):
    """Return 1 where j is k, else 0."""
    return 1.0 if j == k else 0.0


@inlined
def _unit(j):
    """Unit vector of the seven errors; zero when j is none of them."""
    return Errors(_one(j, 0), _one(j, 1), _one(j, 2), _one(j, 3), _one(j, 4), _one(j, 5), _one(j, 6))


@inlined
def _put(table, j, x):
    """Write `Errors` into column j."""
    table[0, j], table[1, j], table[2, j], table[3, j] = x.dv_e, x.dv_n, x.d_lat, x.d_lon
    table[4, j], table[5, j], table[6, j] = x.phi_e, x.phi_n, x.phi_u


@kernel
def fill_transition(h, begin, middle, end, f):
    """Transition of the errors and their response to sensor errors over a step of h seconds."""
    none = Held(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for j in range(STATES):
        _put(f.moved, j, runge_kutta(_unit(j), h, begin, middle, end, none))
    for j in range(INPUTS):
        one = Held(_one(j, 0), _one(j, 1), _one(j, 2), _one(j, 3), _one(j, 4), 0.0, 0.0, 0.0, 0.0, 0.0)
        _put(f.inputs, j, runge_kutta(_unit(-1), h, begin, middle, end, one))


@inlined
def fill_turn(pitch, roll, heading, turn):
    """C_b^n = Rz(-heading) Rx(pitch) Ry(roll) into ``turn``, shape (3, 3)."""
    sp, cp, sr, cr = math.sin(pitch), math.cos(pitch), math.sin(roll), math.cos(roll)
    sh, ch = math.sin(heading), math.cos(heading)
    turn[0, 0], turn[0, 1], turn[0, 2] = ch * cr + sh * sp * sr, sh * cp, ch * sr - sh * sp * cr
    turn[1, 0], turn[1, 1], turn[1, 2] = -sh * cr + ch * sp * sr, ch * cp, -sh * sr - ch * sp * cr
    turn[2, 0], turn[2, 1], turn[2, 2] = -cp * sr, sp, cp * cr


@inlined
def log_share(model, turn, channel, axis, v_e, v_n):
    """What a unit of a state of the log adds to its error in E (channel 0) or N (1).

    Its axes are east, north or starboard, forward. The velocity of the water is missing in what it reads; a
    scale error adds its part of the velocity.
    """
    if axis >= SCALE:
        return v_e if channel == 0 else v_n
    if axis >= WATER:
        return -1.0 if channel == axis - WATER else 0.0
    if not model.body_frame:
        return 1.0 if channel == axis - LOG else 0.0
    size = math.hypot(turn[0, 1], turn[1, 1])
    sine, cosine = turn[0, 1] / size, turn[1, 1] / size
    if axis == LOG:
        return cosine if channel == 0 else -sine
    return sine if channel == 0 else cosine


@kernel
def predict(model, f):
    """Move covariance and estimates over the step of `fill_transition` with the attitude ``f.turn``."""
    P, A, G, M = f.P, f.moved, f.inputs, f.scratch
    n = P.shape[0]
    if f.known:
        for i in range(n - STATES):
            f.sensors[i] *= model.left[i]
        return
    for i in range(n - STATES):
        axis = model.axis[i]
        first, body, inputs = (0, axis, 3) if axis < ACCEL else (3, axis - ACCEL, 2)
        for r in range(STATES):
            total = 0.0
            if axis < LOG:
                for k in range(inputs):
                    total += G[r, first + k] * f.turn[k, body]
            A[r, STATES + i] = total
    for i in range(STATES):
        for j in range(n):
            M[i, j] = 0.0
        for k in range(n):
            a = A[i, k]
            for j in range(n):
                M[i, j] += a * P[k, j]
    for i in range(STATES):
        for j in range(i + 1):
            total = 0.0
            for k in range(n):
                total += M[i, k] * A[j, k]
            for k in range(3):
                total += model.gyro_white * G[i, k] * G[j, k]
            for k in range(3, INPUTS):
                total += model.accel_white * G[i, k] * G[j, k]
            P[i, j] = P[j, i] = total
        for j in range(STATES, n):
            P[i, j] = P[j, i] = M[i, j] * model.left[j - STATES]
    for i in range(STATES, n):
        for j in range(STATES, n):
            P[i, j] *= model.left[i - STATES] * model.left[j - STATES]
        P[i, i] += model.drive[i - STATES]
        f.sensors[i - STATES] *= model.left[i - STATES]


@kernel
def update(model, epoch, d_e, d_n, v_e, v_n, f):
    """Take the difference V_r - V_c of sample ``epoch``; ``f.errors`` is to be taken off the errors.

    The two components are independent, so that they are taken one after the other.
    """
    moored = model.moored.shape[0] > 0 and model.moored[epoch]
    P, seen, gain = f.P, f.scratch[0], f.scratch[1]
    n = P.shape[0]
    f.errors[:] = 0.0
    for channel in range(2):
        innovation = -(d_e if channel == 0 else d_n)
        seen[:] = 0.0
        seen[channel] = 1.0
        if model.body_frame and not moored:
            seen[6] = -v_n if channel == 0 else v_e
        for i in range(n - STATES):
            if model.axis[i] >= LOG and not moored:
                share = log_share(model, f.turn, channel, model.axis[i], v_e, v_n)
                seen[STATES + i] = -share
                innovation += share * f.sensors[i]
        if f.known:
            for i in range(n):
                innovation -= seen[i] * f.errors[i]
            for i in range(n):
                f.errors[i] += f.gains[epoch, channel, i] * innovation
            continue
        variance = model.moored_white if moored else model.log_white
        for i in range(n):
            total = 0.0
            for j in range(n):
                total += P[i, j] * seen[j]
            gain[i] = total
            variance += seen[i] * total
            innovation -= seen[i] * f.errors[i]
        for i in range(n):
            f.errors[i] += gain[i] * innovation / variance
            for j in range(n):
                P[i, j] -= gain[i] * gain[j] / variance
        if f.gains.shape[0] > 0:
            for i in range(n):
                f.gains[epoch, channel, i] = gain[i] / variance
    for i in range(n - STATES):
        f.sensors[i] += f.errors[STATES + i]


@inlined
def keep_sigma(f, row):
    """Put the standard deviations of the seven errors into an output row."""
    for i in range(STATES):
        f.sigma[row, i] = math.sqrt(max(f.P[i, i], 0.0))


@inlined
def sensed_errors(model, f):
    """Estimated errors of gyros (E, N, U, rad/s) and accelerometers (E, N, m/s^2)."""
    g_e = g_n = g_u = a_e = a_n = 0.0
    for i in range(f.sensors.shape[0]):
        axis, value = model.axis[i], f.sensors[i]
        if axis < ACCEL:
            g_e += f.turn[0, axis] * value
            g_n += f.turn[1, axis] * value
            g_u += f.turn[2, axis] * value
        elif axis < LOG:
            a_e += f.turn[0, axis - ACCEL] * value
            a_n += f.turn[1, axis - ACCEL] * value
    return g_e, g_n, g_u, a_e, a_n
