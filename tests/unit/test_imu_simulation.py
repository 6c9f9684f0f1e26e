"""The simulated IMU: errors of the stated size; exact increments on every motion, independence of chunks."""

import math
import tracemalloc

import numpy as np
import pytest

from navcore.foundation.compiled import kernel
from navcore.foundation.earth import WGS84, attitude_matrix
from navcore.foundation.units import ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SQRT_HOUR, MICRO_G
from navcore.motion import LegsMotion
from navcore.motion.inertial import inertial_signals
from navcore.motion.kinematics import Kinematics
from navcore.motion.static import StaticMotion
from navcore.motion.truth import Truth
from navcore.sensors.imu import Imu
from navcore.sensors.imu_simulation import ImuSimulation, side_by_side
from navcore.sensors.imu_simulation import simulation as module
from navcore.sensors.imu_simulation.normal import fill_normals
from navcore.sensors.imu_simulation.work import HALF_NORMALS, NORMAL, WORK, W
from tests.motions import MANOEUVRES, SEA, ZHAO, circle_track
from tests.strapdown import DENG_SWING, DRIVE, SITE

RATE = 100.0


def increments(motion, imu, seconds, seed=1, rate=RATE):
    sim = ImuSimulation(motion, SITE, WGS84, imu, rate, int(seconds * rate), seed)
    return np.concatenate([chunk.copy() for chunk, _ in sim.chunks()])


def test_noise_has_the_stated_size_and_is_white_and_normal():
    imu = Imu(gyro_arw_dpsh=0.003, accel_vrw_ugpshz=10.0)
    error = increments(StaticMotion(), imu, 4000) - increments(StaticMotion(), Imu(), 1)[0]
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


def test_constant_errors_and_scale_factors():
    imu = Imu(
        gyro_bias_dph=(1.0, -2.0, 3.0),
        accel_bias_ug=(10.0, 20.0, -30.0),
        gyro_scale_ppm=(100.0, 0.0, 0.0),
        accel_misalignment_arcsec=(0.0, 10.0, 0.0, 0.0, 0.0, 0.0),
    )
    error = (increments(StaticMotion(), imu, 1) - increments(StaticMotion(), Imu(), 1))[0] * RATE
    perfect = increments(StaticMotion(), Imu(), 1)[0] * RATE
    wanted = np.concatenate(
        [np.array([1.0, -2.0, 3.0]) * DEG_PER_HOUR, np.array([10.0, 20.0, -30.0]) * MICRO_G]
    )
    wanted[0] += 100e-6 * perfect[0]
    wanted[3] += 10.0 * ARCSEC * perfect[5]
    np.testing.assert_allclose(error, wanted, atol=1e-12)


def test_quantisation_loses_nothing():
    lsb = 3e-7
    imu = Imu(gyro_lsb=(lsb, lsb, lsb), accel_lsb=(1e-4, 1e-4, 1e-4))
    counted, perfect = increments(DENG_SWING, imu, 60), increments(DENG_SWING, Imu(), 60)
    whole = counted[:, :3] / lsb
    assert np.abs(whole - np.rint(whole)).max() < 1e-6
    assert np.abs(np.cumsum(counted - perfect, axis=0)).max(axis=0)[:3].max() <= 0.5 * lsb * 1.001
    assert np.abs(np.cumsum(counted - perfect, axis=0)).max(axis=0)[3:].max() <= 0.5e-4 * 1.001


def test_gauss_markov_drift_is_held_by_the_second_and_stationary():
    imu = Imu(gyro_instability_dph=0.5, gyro_tau_s=20.0)
    error = (
        increments(StaticMotion(), imu, 20000, rate=10.0) - increments(StaticMotion(), Imu(), 1, rate=10.0)[0]
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


# ---------------------------------------------------------------- on every motion


TURN = LegsMotion(leg=[{"duration_s": 60.0, "speed_mps": 20.0, "accel_mps2": 0.1, "turn_dps": 3.0}])
"""Turns and gathers speed from the first sample on; the drive stands still for ten minutes."""
NOISY = Imu(gyro_arw_dpsh=0.003, gyro_instability_dph=0.1, gyro_lsb=(1e-7, 1e-7, 1e-7))
FINE = 24
"""Sub-intervals of an interval: composite Boole's rule."""


@pytest.fixture(params=["swing", "legs", "turn", "profile", "zhao", "waves", "track"])
def motion(request, tmp_path):
    fixed = {
        "swing": DENG_SWING, "legs": DRIVE, "turn": TURN, "profile": MANOEUVRES, "zhao": ZHAO, "waves": SEA,
    }  # fmt: skip
    return fixed[request.param] if request.param in fixed else circle_track(tmp_path)


def simulation(motion, seconds: float, rate: float = RATE) -> ImuSimulation:
    return ImuSimulation(motion, SITE, WGS84, Imu(), rate, int(seconds * rate), 1)


def integrated(motion, seconds: float) -> np.ndarray:
    """Signals of another module, integrated over each interval."""
    count, step = int(seconds * RATE), 1.0 / RATE / FINE
    rows = motion.rows(count * FINE + 1, step, SITE, WGS84)
    signals = inertial_signals(Truth(step, rows), WGS84)
    weights = np.tile([14.0, 32.0, 12.0, 32.0], FINE // 4) * 2.0 / 45.0
    inner = np.tensordot(weights, signals[:-1].reshape(count, FINE, 6), (0, 1))
    ends = 7.0 * 2.0 / 45.0 * (signals[FINE::FINE] - signals[:-1:FINE])
    return (inner + ends) * step


def test_increments_are_the_integral_of_the_signals(motion):
    """A tile ends after 50 samples, a block after 100: no seam shows. A track's jerk jumps each second."""
    wanted, got = integrated(motion, 3.0), increments(motion, Imu(), 3.0)
    smooth = np.ones(len(got), bool)
    if motion.kind == "track":
        at = np.arange(len(got)) % int(RATE)
        smooth = (at > 1) & (at < RATE - 1)
    tolerance = 1e-10 if motion.kind == "waves" else 1e-11
    np.testing.assert_allclose(got[smooth], wanted[smooth], rtol=0, atol=tolerance)
    np.testing.assert_allclose(got, wanted, rtol=0, atol=2e-8)


def test_the_interval_before_the_start_is_the_backward_continuation(motion):
    sim, got = simulation(motion, 3.0), increments(motion, Imu(), 3.0)
    extrapolated = 4.0 * got[0] - 6.0 * got[1] + 4.0 * got[2] - got[3]
    np.testing.assert_allclose(sim.before(), extrapolated, atol=1e-8)


def test_the_numbers_do_not_depend_on_the_chunks(motion, monkeypatch):
    whole = increments(motion, NOISY, 30.0)
    monkeypatch.setattr(module, "CHUNK_S", 7.0)
    np.testing.assert_array_equal(increments(motion, NOISY, 30.0), whole)
    assert np.abs(increments(motion, NOISY, 30.0, seed=2) - whole).max() > 0.0


def test_imus_side_by_side_are_each_as_alone(motion):
    """Each with its own errors and seed, over a chunk's end to the middle of a block; the first once more."""
    bent = NOISY.model_copy(update={"gyro_misalignment_arcsec": (9.0, 8.0, 7.0, 6.0, 5.0, 4.0)})
    imus, count = [NOISY, bent, Imu(accel_bias_ug=(10.0, 0.0, 0.0))], 6321
    sims = [ImuSimulation(motion, SITE, WGS84, imu, RATE, count, seed) for seed, imu in enumerate(imus)]
    lanes = np.concatenate([*side_by_side(sims, 4)])
    alone = [np.concatenate([chunk.copy() for chunk, _ in sim.chunks()]) for sim in [*sims, sims[0]]]
    np.testing.assert_array_equal(lanes, np.stack(alone, axis=2))


def test_memory_does_not_grow_with_the_run(motion):
    """20 min at 400 Hz are 58 MB as rows of truth."""
    sim = simulation(motion, 1190.0, 400.0)
    tracemalloc.start()
    try:
        for chunk, _ in sim.chunks():
            assert np.isfinite(chunk[-1]).all()
        assert tracemalloc.get_traced_memory()[1] < 5e6
    finally:
        tracemalloc.stop()


def test_a_motion_seen_from_a_later_start():
    for motion in (DENG_SWING, SEA):
        kin = motion.kinematics(100.0, SITE, WGS84)
        assert isinstance(kin.moved(3.0), Kinematics)
        np.testing.assert_allclose(
            kin.moved(3.0).moved(-3.0).oscillations, kin.oscillations, rtol=0, atol=1e-12
        )
