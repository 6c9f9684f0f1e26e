"""The simulated IMU: exact increments, errors of the stated size, independence of chunks."""

import math

import numpy as np
import pytest

from navcore.foundation.compiled import kernel
from navcore.foundation.earth import WGS84, attitude_matrix
from navcore.foundation.units import ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SQRT_HOUR, MICRO_G
from navcore.motion.static import StaticMotion
from navcore.sensors.imu import Imu
from navcore.sensors.imu_simulation import ImuSimulation
from navcore.sensors.imu_simulation import simulation as module
from navcore.sensors.imu_simulation.normal import fill_normals
from navcore.sensors.imu_simulation.work import HALF_NORMALS, NORMAL, WORK, W
from tests.strapdown import DENG_SWING, DRIVE, SITE

RATE = 100.0


def _increments(motion, imu, seconds, seed=1, rate=RATE):
    sim = ImuSimulation(motion, SITE, WGS84, imu, rate, int(seconds * rate), seed)
    return np.concatenate([chunk.copy() for chunk, _ in sim.chunks()])


def test_noise_has_the_stated_size_and_is_white_and_normal():
    imu = Imu(gyro_arw_dpsh=0.003, accel_vrw_ugpshz=10.0)
    error = _increments(StaticMotion(), imu, 4000) - _increments(StaticMotion(), Imu(), 1)[0]
    n, dt = len(error), 1.0 / RATE
    wanted = np.repeat([0.003 * DEG_PER_SQRT_HOUR, 10.0 * MICRO_G], 3) * math.sqrt(dt)
    z = error / wanted
    assert np.abs(z.mean(axis=0)).max() < 4.0 / math.sqrt(n)
    assert np.abs(z.std(axis=0) - 1.0).max() < 4.0 / math.sqrt(2 * n)
    assert np.abs((z**4).mean(axis=0) - 3.0).max() < 4.0 * math.sqrt(96.0 / n)
    assert np.abs(np.corrcoef(z.T) - np.eye(6)).max() < 4.5 / math.sqrt(n)
    for lag in (1, 2, 64, 100):
        assert np.abs((z[lag:] * z[:-lag]).mean(axis=0)).max() < 4.5 / math.sqrt(n)


def test_normals_pass_a_distribution_test():
    from scipy.stats import kstest

    w, parts = np.zeros(WORK), []
    for tile in range(300):
        fill_normals(tile, np.uint64(77), 192, w)
        parts.append(w[NORMAL * W : NORMAL * W + 2 * HALF_NORMALS].copy())
    assert kstest(np.concatenate(parts), "norm").pvalue > 0.01


def test_philox_of_the_paper():
    """Known answers of Random123 for philox2x32 with ten rounds."""
    from navcore.sensors.imu_simulation.normal import _philox

    @kernel
    def call(low, high, key):
        return _philox(np.uint64(low), np.uint64(high), np.uint64(key))

    assert tuple(int(v) for v in call(0, 0, 0)) == (0xFF1DAE59, 0x6CD10DF2)
    full = 0xFFFFFFFF
    assert tuple(int(v) for v in call(full, full, full)) == (0x2C3F628B, 0xAB4FD7AD)


def test_the_numbers_do_not_depend_on_the_chunks(monkeypatch):
    imu = Imu(gyro_arw_dpsh=0.003, gyro_instability_dph=0.1, gyro_lsb=(1e-7, 1e-7, 1e-7))
    whole = _increments(DRIVE, imu, 30)
    monkeypatch.setattr(module, "CHUNK_S", 7.0)
    np.testing.assert_array_equal(_increments(DRIVE, imu, 30), whole)
    assert np.abs(_increments(DRIVE, imu, 30, seed=2) - whole).max() > 0.0


def test_constant_errors_and_scale_factors():
    imu = Imu(
        gyro_bias_dph=(1.0, -2.0, 3.0),
        accel_bias_ug=(10.0, 20.0, -30.0),
        gyro_scale_ppm=(100.0, 0.0, 0.0),
        accel_misalignment_arcsec=(0.0, 10.0, 0.0, 0.0, 0.0, 0.0),
    )
    error = (_increments(StaticMotion(), imu, 1) - _increments(StaticMotion(), Imu(), 1))[0] * RATE
    perfect = _increments(StaticMotion(), Imu(), 1)[0] * RATE
    wanted = np.concatenate(
        [np.array([1.0, -2.0, 3.0]) * DEG_PER_HOUR, np.array([10.0, 20.0, -30.0]) * MICRO_G]
    )
    wanted[0] += 100e-6 * perfect[0]
    wanted[3] += 10.0 * ARCSEC * perfect[5]
    np.testing.assert_allclose(error, wanted, atol=1e-12)


def test_quantisation_loses_nothing():
    lsb = 3e-7
    imu = Imu(gyro_lsb=(lsb, lsb, lsb), accel_lsb=(1e-4, 1e-4, 1e-4))
    counted, perfect = _increments(DENG_SWING, imu, 60), _increments(DENG_SWING, Imu(), 60)
    whole = counted[:, :3] / lsb
    assert np.abs(whole - np.rint(whole)).max() < 1e-6
    assert np.abs(np.cumsum(counted - perfect, axis=0)).max(axis=0)[:3].max() <= 0.5 * lsb * 1.001
    assert np.abs(np.cumsum(counted - perfect, axis=0)).max(axis=0)[3:].max() <= 0.5e-4 * 1.001


def test_gauss_markov_drift_is_held_by_the_second_and_stationary():
    imu = Imu(gyro_instability_dph=0.5, gyro_tau_s=20.0)
    error = (
        _increments(StaticMotion(), imu, 20000, rate=10.0)
        - _increments(StaticMotion(), Imu(), 1, rate=10.0)[0]
    )
    drift = error[::10, :3] * 10.0 / DEG_PER_HOUR
    np.testing.assert_allclose(error[:10, 0], error[0, 0], rtol=1e-12)
    assert drift.std() == pytest.approx(0.5, rel=0.1)
    assert (drift[1:] * drift[:-1]).mean() / drift.var() == pytest.approx(math.exp(-1 / 20), abs=0.02)


def test_sums_turn_all_three_axes():
    gyro, accel = (1.0, -2.0, 3.0), (100.0, -50.0, 30.0)
    motion = StaticMotion(pitch_deg=6.0, roll_deg=8.0, heading_deg=75.0)
    sim = ImuSimulation(motion, SITE, WGS84, Imu(gyro_bias_dph=gyro, accel_bias_ug=accel), RATE, 1000, 1)
    sums = np.concatenate([s.copy() for _, s in sim.chunks(with_sums=True)])
    turn = attitude_matrix(6.0 * DEG, 8.0 * DEG, 75.0 * DEG)
    np.testing.assert_allclose(sums[:, :3], np.tile(turn @ gyro * DEG_PER_HOUR, (10, 1)), rtol=1e-9)
    np.testing.assert_allclose(sums[:, 3:], np.tile(turn @ accel * MICRO_G, (10, 1)), rtol=1e-9)
