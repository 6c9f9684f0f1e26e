"""IMU errors in the navigation frame: statistics of the noises, independence of the parts, constant parts."""

import math
from typing import Any

import numpy as np
import pytest

from navcore.foundation.earth import EARTH_RATE, WGS84, attitude_matrix
from navcore.foundation.units import ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SQRT_HOUR, MICRO_G
from navcore.motion import LegsMotion, StaticMotion, SwingMotion
from navcore.motion.base import MotionParameters
from navcore.motion.inertial import inertial_signals
from navcore.motion.truth import HEADING, PITCH, ROLL, Site
from navcore.sensors.base import SensorErrors
from navcore.sensors.imu import Imu, imu_errors
from navcore.sensors.imu_errors.base import Clock

SITE = Site(32.06 * DEG, 118.8 * DEG, 0.0)
LEVEL = StaticMotion()
SWING = SwingMotion(
    pitch_deg=8.0,
    roll_deg=6.0,
    heading_deg=75.0,
    pitch={"amplitude_deg": 10.0, "frequency_hz": 0.2},
    roll={"amplitude_deg": 12.0, "frequency_hz": 0.125},
    heading={"amplitude_deg": 6.0, "frequency_hz": 0.15},
)
DAY = 86_400


def _errors(
    motion: MotionParameters = LEVEL,
    count: int = DAY,
    step: float = 1.0,
    seed: int = 1,
    level: bool = False,
    **imu: Any,
) -> SensorErrors:
    truth = motion.truth(2 * count + 1, 0.5 * step, SITE, WGS84)
    return imu_errors(Imu(**imu).all_parts(), truth, count, step, WGS84, seed, level)


@pytest.mark.parametrize("motion", [LEVEL, SWING])
def test_a_perfect_imu_is_one_row_of_zeros(motion: MotionParameters) -> None:
    errors = _errors(motion, count=10)
    for error in (errors.gyro, errors.accel):
        assert error.shape == (1, 3)
        assert not error.any()


def test_a_bias_at_rest_is_one_row_turned_by_the_attitude() -> None:
    motion = StaticMotion(pitch_deg=6.0, roll_deg=8.0, heading_deg=75.0)
    errors = _errors(motion, gyro_bias_dph=(0.01, 0.02, -0.03), accel_bias_ug=(50.0, -20.0, 10.0))
    turn = attitude_matrix(6.0 * DEG, 8.0 * DEG, 75.0 * DEG)
    assert errors.gyro.shape == errors.accel.shape == (1, 3)
    assert errors.gyro[0] == pytest.approx(turn @ np.array([0.01, 0.02, -0.03]) * DEG_PER_HOUR, rel=1e-13)
    assert errors.accel[0] == pytest.approx(turn @ np.array([50.0, -20.0, 10.0]) * MICRO_G, rel=1e-13)


def test_a_straight_course_keeps_a_bias_constant_and_a_turn_does_not() -> None:
    straight = LegsMotion(leg=[{"speed_mps": 5.0, "heading_deg": 30.0}])
    assert _errors(straight, 100, gyro_bias_dph=(0.0, 1.0, 0.0)).gyro.shape == (1, 3)
    turning = LegsMotion(leg=[{"duration_s": 50.0, "speed_mps": 5.0}, {"heading_deg": 20.0}])
    errors = _errors(turning, 100, gyro_bias_dph=(0.0, 1.0, 0.0))
    assert errors.gyro.shape == (100, 3)
    assert errors.accel.shape == (1, 3)
    assert errors.gyro[0] / DEG_PER_HOUR == pytest.approx([0.0, 1.0, 0.0], abs=1e-12)
    expected = [math.sin(20.0 * DEG), math.cos(20.0 * DEG), 0.0]
    assert errors.gyro[99] / DEG_PER_HOUR == pytest.approx(expected)


@pytest.mark.parametrize(
    ("fields", "sensor", "step", "walk"),
    [
        *(({"gyro_arw_dpsh": 0.006}, "gyro", step, 0.006 * DEG_PER_SQRT_HOUR) for step in (1.0, 0.25)),
        ({"accel_vrw_ugpshz": 30.0}, "accel", 1.0, 30.0 * MICRO_G),
    ],
)
def test_a_random_walk_integrates_to_its_name(
    fields: dict[str, float], sensor: str, step: float, walk: float
) -> None:
    count = round(DAY / step)
    rate = getattr(_errors(count=count, step=step, **fields), sensor)
    white = np.full(3, walk / math.sqrt(step))
    assert np.std(rate, axis=0) == pytest.approx(white, rel=4.5 / math.sqrt(2.0 * count))
    # 288 quarters of an hour (3 axes)
    integral = step * rate.reshape(96, -1, 3).sum(axis=1)
    assert np.std(integral) == pytest.approx(walk * math.sqrt(900.0), rel=4.5 / math.sqrt(2.0 * 288))


@pytest.mark.parametrize(
    ("fields", "sensor", "sigma"),
    [
        ({"gyro_instability_dph": 0.02, "gyro_tau_s": 100.0}, "gyro", 0.02 * DEG_PER_HOUR),
        ({"accel_instability_ug": 40.0, "accel_tau_s": 100.0}, "accel", 40.0 * MICRO_G),
    ],
)
def test_instability_has_its_deviation_and_correlation_time(
    fields: dict[str, float], sensor: str, sigma: float
) -> None:
    drift = getattr(_errors(**fields), sensor) / sigma
    # About DAY / tau = 864 independent values an axis, three axes.
    assert np.mean(drift**2) == pytest.approx(1.0, abs=4.5 * math.sqrt(2.0 / (3.0 * 864)))
    for lag in (50, 100, 200):
        measured = np.mean(drift[lag:] * drift[:-lag])
        assert measured == pytest.approx(math.exp(-lag / 100.0), abs=4.5 / math.sqrt(3.0 * 864))


def test_turning_keeps_the_size_of_the_noise() -> None:
    level, swinging = _errors(gyro_arw_dpsh=0.01, count=3000), _errors(SWING, gyro_arw_dpsh=0.01, count=3000)
    size = np.linalg.norm(swinging.gyro, axis=1) / np.linalg.norm(level.gyro, axis=1)
    # The mean of a turning matrix is a little shorter than 1: 0.1 rad of swing within a step.
    assert np.abs(size - 1.0).max() < 5e-3
    assert np.abs(swinging.gyro - level.gyro).max() > np.std(level.gyro)


def test_one_part_does_not_change_the_numbers_of_another() -> None:
    gyro, accel = _errors(count=500, gyro_arw_dpsh=0.01), _errors(count=500, accel_vrw_ugpshz=10.0)
    drift = _errors(count=500, gyro_instability_dph=0.01, accel_instability_ug=20.0)
    bias = _errors(count=500, gyro_bias_dph=(1.0, 2.0, 3.0))
    everything = _errors(
        count=500,
        gyro_arw_dpsh=0.01,
        accel_vrw_ugpshz=10.0,
        gyro_instability_dph=0.01,
        accel_instability_ug=20.0,
        gyro_bias_dph=(1.0, 2.0, 3.0),
    )
    assert everything.gyro == pytest.approx(gyro.gyro + drift.gyro + bias.gyro, abs=1e-20)
    assert everything.accel == pytest.approx(accel.accel + drift.accel, abs=1e-18)


def test_an_amplitude_scales_the_same_numbers() -> None:
    one, two = _errors(count=500, gyro_arw_dpsh=0.01), _errors(count=500, gyro_arw_dpsh=0.02)
    assert np.array_equal(2.0 * one.gyro, two.gyro)
    assert not np.array_equal(one.gyro, _errors(count=500, gyro_arw_dpsh=0.01, seed=2).gyro)


def test_a_longer_run_begins_like_a_shorter_one() -> None:
    fields = {"gyro_arw_dpsh": 0.01, "gyro_instability_dph": 0.01, "gyro_lsb": (1e-6, 1e-6, 1e-6)}
    short, long = _errors(SWING, 200, **fields), _errors(SWING, 800, **fields)
    assert short.gyro == pytest.approx(long.gyro[:200], rel=1e-12)


@pytest.mark.parametrize(
    "fields", [{"gyro_arw_dpsh": 0.5}, {"gyro_instability_dph": 0.5}], ids=["noise", "drift"]
)
def test_a_run_of_one_step_begins_like_a_longer_one(fields: dict[str, float]) -> None:
    one, ten = (_errors(LEVEL, count, **fields).gyro for count in (1, 10))
    assert one.shape == (1, 3) and one.any()
    assert one[0].tolist() == ten[0].tolist()


def test_the_order_of_misalignments() -> None:
    terms = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
    errors = _errors(
        gyro_scale_ppm=(10.0, 20.0, 30.0), gyro_misalignment_arcsec=terms, accel_misalignment_arcsec=terms
    )
    north, up = EARTH_RATE * math.cos(SITE.lat), EARTH_RATE * math.sin(SITE.lat)
    expected = [
        (1.0 * north + 2.0 * up) * ARCSEC,
        20e-6 * north + 4.0 * ARCSEC * up,
        6.0 * ARCSEC * north + 30e-6 * up,
    ]
    assert errors.gyro.shape == (1, 3)
    assert errors.gyro[0] == pytest.approx(expected, rel=1e-12)
    g = WGS84.gravity(SITE.lat)
    assert errors.accel[0] == pytest.approx([2.0 * ARCSEC * g, 4.0 * ARCSEC * g, 0.0], rel=1e-12, abs=1e-20)


def test_a_scale_factor_errs_by_its_part_of_a_turn() -> None:
    motion = LegsMotion(
        leg=[{"duration_s": 20.0, "speed_mps": 5.0}, {"duration_s": 200.0, "heading_deg": 90.0}]
    )
    errors = _errors(motion, 200, gyro_scale_ppm=(0.0, 0.0, 100.0))
    earth = 200.0 * EARTH_RATE * math.sin(SITE.lat)
    # Heading grows clockwise: the gyro about the up axis sees -90 deg.
    assert errors.gyro[:, 2].sum() == pytest.approx(100e-6 * (earth - 90.0 * DEG), rel=1e-4)


def test_the_level_body_ignores_attitude_and_earth_rate() -> None:
    motion = StaticMotion(pitch_deg=6.0, roll_deg=8.0, heading_deg=75.0)
    errors = _errors(
        motion,
        10,
        level=True,
        gyro_bias_dph=(0.0, 0.02, 0.0),
        accel_bias_ug=(50.0, 0.0, 0.0),
        gyro_scale_ppm=(1000.0, 1000.0, 1000.0),
        accel_misalignment_arcsec=(0.0, 0.0, 0.0, 10.0, 0.0, 0.0),
    )
    assert errors.gyro[0] == pytest.approx([0.0, 0.02 * DEG_PER_HOUR, 0.0])
    assert errors.accel[0] == pytest.approx([50.0 * MICRO_G, 10.0 * ARCSEC * WGS84.gravity(SITE.lat), 0.0])


def test_truth_of_another_length_is_refused() -> None:
    truth = SWING.truth(21, 0.5, SITE, WGS84)
    with pytest.raises(ValueError, match="11 steps need 1 or 23 rows of truth at half steps, not 21"):
        imu_errors(Imu(gyro_arw_dpsh=0.01).all_parts(), truth, 11, 1.0, WGS84, 1)


# ---------------------------------------------------------------- while the body turns; counts


TURN_SITE = Site(45.0 * DEG, 10.0 * DEG, 0.0)
TURN = LegsMotion(leg=[{"duration_s": 60.0, "speed_mps": 20.0, "accel_mps2": 0.1, "turn_dps": 3.0}])
TURN_IMU = Imu(
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
    truth = motion.truth(parts, step / (2 * FINE), TURN_SITE, WGS84)
    middle = slice(1, None, 2)
    values, signals = truth.values[middle], inertial_signals(truth, WGS84)[middle]
    out = []
    for model, felt in ((TURN_IMU.gyro(), signals[:, :3]), (TURN_IMU.accel(), signals[:, 3:])):
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
    truth = motion.truth(2 * count + 1, 0.5 * step, TURN_SITE, WGS84)
    errors = imu_errors(TURN_IMU.all_parts(), truth, count, step, WGS84, seed=1)
    gyro, accel = _fine_means(motion, count, step)
    tolerance = part + 2e-5 / FINE
    assert np.abs(errors.gyro - gyro).max() < tolerance * np.abs(gyro).max()
    assert np.abs(errors.accel - accel).max() < tolerance * np.abs(accel).max()


def test_the_mean_over_a_swing_is_kept() -> None:
    # Over whole cycles (400 s) the rectified part of the swing must come out, not only the oscillation.
    truth = SWING.truth(801, 0.5, TURN_SITE, WGS84)
    errors = imu_errors(Imu(gyro_bias_dph=(0.0, 0.0, 1.0)).all_parts(), truth, 400, 1.0, WGS84, seed=1)
    fine = SWING.truth(40_000, 0.01, TURN_SITE, WGS84).values
    third = np.array([attitude_matrix(r[PITCH], r[ROLL], r[HEADING])[:, 2] for r in fine[::4]])
    assert errors.gyro.mean(axis=0) == pytest.approx(third.mean(axis=0) * DEG_PER_HOUR, rel=1e-6)


def _counted(
    motion: MotionParameters, count: int, step: float = 1.0, **fields: Any
) -> tuple[np.ndarray, np.ndarray]:
    """Errors of the gyros' and accelerometers' integrals that counting alone makes, n frame."""
    truth = motion.truth(2 * count + 1, 0.5 * step, TURN_SITE, WGS84)
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
    truth = StaticMotion().truth(1, 0.05, TURN_SITE, WGS84)
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
    truth = StaticMotion(heading_deg=90.0).truth(1, 0.5, TURN_SITE, WGS84)
    imu = Imu(accel_bias_ug=(10.0, 0.0, 0.0), accel_lsb=(1e-3, 0.0, 0.0))
    level = imu_errors(imu.all_parts(), truth, 2000, 1.0, WGS84, seed=1, level_body=True)
    total = np.cumsum(level.accel, axis=0)[:, 0]
    assert np.abs(total - 10.0 * MICRO_G * np.arange(1, 2001)).max() <= 0.5e-3 * (1.0 + 1e-9)
    assert not level.accel[:, 1].any()
