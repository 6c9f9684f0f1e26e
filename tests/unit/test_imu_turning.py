"""Means over a step while the body turns, and quantisation with carry, against fine numeric twins."""

from typing import Any

import numpy as np
import pytest

from navcore.foundation.earth import WGS84, attitude_matrix
from navcore.foundation.units import DEG, DEG_PER_HOUR, MICRO_G
from navcore.motion import LegsMotion, StaticMotion, SwingMotion
from navcore.motion.base import HEADING, PITCH, ROLL, MotionParameters, Site
from navcore.motion.inertial import inertial_signals
from navcore.sensors.imu import Imu, imu_errors
from navcore.sensors.imu_errors.base import Clock

SITE = Site(45.0 * DEG, 10.0 * DEG, 0.0)
SWING = SwingMotion(
    pitch_deg=8.0,
    roll_deg=6.0,
    heading_deg=75.0,
    pitch={"amplitude_deg": 10.0, "frequency_hz": 0.2},
    roll={"amplitude_deg": 12.0, "frequency_hz": 0.125},
    heading={"amplitude_deg": 6.0, "frequency_hz": 0.15},
)
TURN = LegsMotion(leg=[{"duration_s": 60.0, "speed_mps": 20.0, "accel_mps2": 0.1, "turn_dps": 3.0}])
IMU = Imu(
    gyro_bias_dph=(0.3, -0.2, 0.1),
    accel_bias_ug=(100.0, 50.0, -80.0),
    gyro_scale_ppm=(100.0, -200.0, 50.0),
    accel_scale_ppm=(-30.0, 60.0, 90.0),
    gyro_misalignment_arcsec=(10.0, -20.0, 30.0, 5.0, -15.0, 25.0),
    accel_misalignment_arcsec=(-10.0, 20.0, 30.0, -5.0, 15.0, 25.0),
)
FINE = 200


def _fine_means(motion: MotionParameters, count: int, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Means over each step by 200 midpoints: C (bias + coupling signal), gyros and accelerometers."""
    parts = 2 * FINE * count + 1
    truth = motion.truth(parts, step / (2 * FINE), SITE, WGS84)
    middle = slice(1, None, 2)
    values, signals = truth.values[middle], inertial_signals(truth, WGS84)[middle]
    out = []
    for model, felt in ((IMU.gyro(), signals[:, :3]), (IMU.accel(), signals[:, 3:])):
        body = model.slow(Clock(step, count, 1)) + felt @ model.coupling.T
        turned = [
            attitude_matrix(row[PITCH], row[ROLL], row[HEADING]) @ error
            for row, error in zip(values, body, strict=True)
        ]
        out.append(np.array(turned).reshape(count, FINE, 3).mean(axis=1))
    return out[0], out[1]


# Simpson's rule errs by (2 pi f)^4 / 2880 of an oscillation at 1 s: 9e-4 at 0.2 Hz.
@pytest.mark.parametrize(
    ("motion", "step", "part"), [(SWING, 1.0, 2e-3), (SWING, 0.1, 2e-7), (TURN, 1.0, 2e-5)]
)
def test_simpson_means_against_a_fine_grid(motion: MotionParameters, step: float, part: float) -> None:
    count = 40
    truth = motion.truth(2 * count + 1, 0.5 * step, SITE, WGS84)
    errors = imu_errors(IMU.all_parts(), truth, count, step, WGS84, seed=1)
    gyro, accel = _fine_means(motion, count, step)
    tolerance = part + 2e-5 / FINE
    assert np.abs(errors.gyro - gyro).max() < tolerance * np.abs(gyro).max()
    assert np.abs(errors.accel - accel).max() < tolerance * np.abs(accel).max()


def test_the_mean_over_a_swing_is_kept() -> None:
    # Over whole cycles (400 s) the rectified part of the swing must come out, not only the oscillation.
    truth = SWING.truth(801, 0.5, SITE, WGS84)
    errors = imu_errors(Imu(gyro_bias_dph=(0.0, 0.0, 1.0)).all_parts(), truth, 400, 1.0, WGS84, seed=1)
    fine = SWING.truth(40_000, 0.01, SITE, WGS84).values
    third = np.array([attitude_matrix(r[PITCH], r[ROLL], r[HEADING])[:, 2] for r in fine[::4]])
    assert errors.gyro.mean(axis=0) == pytest.approx(third.mean(axis=0) * DEG_PER_HOUR, rel=1e-6)


def _counted(
    motion: MotionParameters, count: int, step: float = 1.0, **fields: Any
) -> tuple[np.ndarray, np.ndarray]:
    """Errors of the gyros' and accelerometers' integrals that counting alone makes, n frame."""
    truth = motion.truth(2 * count + 1, 0.5 * step, SITE, WGS84)
    smooth = {key: value for key, value in fields.items() if not key.endswith("_lsb")}
    with_counts = imu_errors(Imu(**fields).all_parts(), truth, count, step, WGS84, seed=3)
    without = imu_errors(Imu(**smooth).all_parts(), truth, count, step, WGS84, seed=3)
    return step * (with_counts.gyro - without.gyro), step * (with_counts.accel - without.accel)


@pytest.mark.parametrize("fields", [{}, {"gyro_arw_dpsh": 0.05, "accel_vrw_ugpshz": 200.0}])
def test_what_counting_leaves_is_at_most_half_a_count(fields: dict[str, float]) -> None:
    lsb = np.array([1e-6, 3e-6, 2e-5])
    gyro, accel = _counted(StaticMotion(), 5000, gyro_lsb=tuple(lsb), accel_lsb=(1e-3, 1e-4, 1e-2), **fields)
    for increments, count in ((gyro, lsb), (accel, np.array([1e-3, 1e-4, 1e-2]))):
        rest = np.cumsum(increments, axis=0)
        assert (np.abs(rest) <= 0.5 * count * (1.0 + 1e-6)).all()
        assert (np.abs(rest[:, 2]) > 0.2 * count[2]).any()


def test_increments_are_whole_counts() -> None:
    step, lsb = 0.1, 2e-6
    count = 3000
    truth = StaticMotion().truth(1, 0.05, SITE, WGS84)
    imu = Imu(
        gyro_bias_dph=(3.0, 2.0, 1.0),
        gyro_arw_dpsh=0.1,
        gyro_scale_ppm=(0.0, 500.0, 0.0),
        gyro_lsb=(lsb,) * 3,
    )
    (signal,) = inertial_signals(truth, WGS84)
    increments = (
        step * (signal[:3] + imu_errors(imu.all_parts(), truth, count, step, WGS84, seed=1).gyro) / lsb
    )
    assert np.abs(increments - np.rint(increments)).max() < 1e-6
    assert len(np.unique(np.rint(increments[:, 1]))) > 3


def test_an_axis_without_counts_is_not_counted() -> None:
    gyro, accel = _counted(StaticMotion(), 200, gyro_lsb=(0.0, 1e-5, 0.0))
    assert not accel.any()
    assert np.abs(gyro[:, [0, 2]]).max() < 1e-20
    assert np.abs(gyro[:, 1]).max() > 1e-6


def test_counting_a_swing_does_not_drift() -> None:
    # Each rest is turned by the attitude of its own step: the sum wanders by some counts.
    lsb = 1e-5
    gyro, _ = _counted(SWING, 20_000, gyro_lsb=(lsb, lsb, lsb))
    total = np.abs(np.cumsum(gyro, axis=0)).max()
    assert 0.1 * lsb < total < 100.0 * lsb
    assert np.abs(gyro).max() < 2.0 * lsb


def test_counting_follows_the_level_body() -> None:
    truth = StaticMotion(heading_deg=90.0).truth(1, 0.5, SITE, WGS84)
    imu = Imu(accel_bias_ug=(10.0, 0.0, 0.0), accel_lsb=(1e-3, 0.0, 0.0))
    level = imu_errors(imu.all_parts(), truth, 2000, 1.0, WGS84, seed=1, level_body=True)
    total = np.cumsum(level.accel, axis=0)[:, 0]
    assert np.abs(total - 10.0 * MICRO_G * np.arange(1, 2001)).max() <= 0.5e-3 * (1.0 + 1e-9)
    assert not level.accel[:, 1].any()
