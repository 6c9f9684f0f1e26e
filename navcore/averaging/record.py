"""The alignment record: one-second IMU increments of a vehicle at rest, but for small motions of its base."""

import math
from collections.abc import Sequence

import numpy as np

from navcore.averaging.parameters import AlignmentMotion
from navcore.foundation.earth import Earth, attitude_matrix
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import DEG
from navcore.motion.inertial import inertial_signals
from navcore.motion.truth import AE, AU, COLUMNS, HEADING, HEIGHT, LAT, LON, PITCH, ROLL, VE, VU, Truth
from navcore.sensors.imu import Imu
from navcore.sensors.imu_errors.base import Clock

RECORD_STEP_S = 1.0
"""Interval of the record's increments (theory.md section 5), s."""
FASTEST_START_MPS = 0.01
"""A vehicle faster than this at t = 0 did not stand before."""
MUST_STAND = Text(
    "half-period averaging forecasts from an alignment at rest: the motion must start from rest"
)


def under_way(true_row: np.ndarray, because: str) -> Fault | None:
    """Fault of a vehicle that moves at t = 0; None where it stands."""
    speed = float(np.linalg.norm(true_row[VE : VU + 1]))
    if speed <= FASTEST_START_MPS:
        return None
    return Fault("", "motion", Text("{speed:.3g} m/s at t = 0", speed=speed), because)


def standing_row(true_row: np.ndarray) -> np.ndarray:
    """Row of truth of the vehicle before t = 0: place and attitude of t = 0, at rest; shape (15,).

    Raises
    ------
    InputError
        The vehicle moves at t = 0: what lies before cannot be forecast from a record at rest.
    """
    if fault := under_way(true_row, MUST_STAND):
        raise InputError(fault)
    row = np.zeros(COLUMNS)
    kept = [LAT, LON, HEIGHT, PITCH, ROLL, HEADING]
    row[kept] = true_row[kept]
    return row


def standing_signals(standing: np.ndarray, earth: Earth) -> np.ndarray:
    """Return what perfect sensors feel at rest in body axes: rad/s and m/s^2, shape (6,)."""
    assert not standing[AE : AU + 1].any()
    return inertial_signals(Truth(RECORD_STEP_S, standing[None, :]), earth)[0]


def alignment_record(
    imu: Imu,
    standing: np.ndarray,
    duration_s: float,
    motions: Sequence[AlignmentMotion],
    earth: Earth,
    seed: int,
) -> np.ndarray:
    """Measured increments over each second of the alignment, the last one ending at t = 0.

    Sensor errors continue those of the run: the Gauss-Markov drift goes back in time from its value at t = 0,
    white noise and the rest of quantisation have numbers of their own.

    Parameters
    ----------
    imu : Imu
        Sensor errors.
    standing : ndarray, shape (15,)
        From `standing_row`.
    duration_s : float
        Length of the alignment, s.
    motions : sequence of AlignmentMotion
        Small motions of the base.
    earth : Earth
        WGS-84 or the sphere.
    seed : int
        Seed of the scenario.

    Returns
    -------
    ndarray, shape (seconds, 6)
        Angles (rad) and velocities (m/s) in body axes.
    """
    seconds = max(1, int(duration_s / RECORD_STEP_S + 1e-9))
    true = _true_increments(standing_signals(standing, earth), standing, seconds, motions)
    clock = Clock(RECORD_STEP_S, seconds, seed, -RECORD_STEP_S * seconds, record=True)
    return _measured(imu, true / RECORD_STEP_S, clock) * RECORD_STEP_S


def sensed_at_rest(
    imu: Imu, standing: np.ndarray, count: int, step_s: float, earth: Earth, seed: int
) -> np.ndarray:
    """Return what the IMU of the run reads after t = 0 if the vehicle stays as it stands: what was forecast.

    With the step of a run on the error model the errors are those of that run.

    Parameters
    ----------
    imu, standing, earth, seed
        As of `alignment_record`.
    count : int
        Number of steps.
    step_s : float
        Length of a step, s.

    Returns
    -------
    ndarray, shape (count, 6)
        Mean rate (rad/s) and specific force (m/s^2) over each step in body axes.
    """
    true = np.tile(standing_signals(standing, earth), (count, 1))
    return _measured(imu, true, Clock(step_s, count, seed))


def _true_increments(
    felt: np.ndarray, standing: np.ndarray, seconds: int, motions: Sequence[AlignmentMotion]
) -> np.ndarray:
    """Perfect increments (seconds, 6); each motion ends in the attitude that the next one starts from."""
    if not motions:
        return np.tile(felt * RECORD_STEP_S, (seconds, 1))
    from scipy.spatial.transform import Rotation

    time_s = (np.arange(seconds + 1) - seconds) * RECORD_STEP_S
    turns = [_share(motion, time_s)[:, None] * np.array(motion.turn_deg) * DEG for motion in motions]
    turned = np.sum(turns, axis=0)
    # Body axes at each second seen from those at t = 0.
    attitude = Rotation.from_rotvec(turned - turned[-1])
    end = attitude_matrix(standing[PITCH], standing[ROLL], standing[HEADING])
    seen = [attitude.inv().apply(end.T @ (end @ felt[part])) for part in (slice(0, 3), slice(3, 6))]
    means = [0.5 * RECORD_STEP_S * (values[:-1] + values[1:]) for values in seen]
    steps = (attitude[:-1].inv() * attitude[1:]).as_rotvec()
    return np.column_stack([means[0] + steps, means[1]])


def _share(motion: AlignmentMotion, time_s: np.ndarray) -> np.ndarray:
    """Part of a motion's turn that is done, 0..1, smooth in rate."""
    place = np.clip((time_s - motion.t_s) / motion.duration_s, 0.0, 1.0)
    return 0.5 - 0.5 * np.cos(math.pi * place)


def _measured(imu: Imu, true: np.ndarray, clock: Clock) -> np.ndarray:
    """Rates and specific forces with the errors of gyros and accelerometers, shape of ``true``, SI."""
    parts = []
    for model, signal in ((imu.gyro(), true[:, :3]), (imu.accel(), true[:, 3:])):
        parts.append(signal + model.body_errors(signal, clock) + signal @ model.coupling.T)
    return np.column_stack(parts)
