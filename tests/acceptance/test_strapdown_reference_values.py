"""Full strapdown against an independent implementation (theory.md 9.5, 9.6), and with perfect sensors."""

import numpy as np
import pytest

from navcore.foundation.units import DEG
from navcore.mechanization.recorder import DV_E, DV_N, MAX_ABS, PHI_E, PHI_N
from navcore.motion.static import StaticMotion
from navcore.networks.compass import CompassNetwork
from navcore.sensors.imu import Imu
from tests.strapdown import navigate, reference

VE_COLUMN = 3


def test_free_velocity_under_a_gyro_bias_9_5():
    run = navigate(StaticMotion(), 100.0, 3600.0, Imu(gyro_bias_dph=(0.0, 0.02, 0.0)))
    v_e = run.navigation[:, VE_COLUMN]
    peak = np.abs(v_e).max()
    for t, wanted in ((1800, 0.9951), (2533, 1.2309), (3600, 0.7646)):
        assert v_e[t] == pytest.approx(wanted, abs=1e-3 * peak)


@pytest.mark.parametrize("law_step_s", [1.0, 0.01], ids=["law_1_hz", "law_100_hz"])
def test_compass_settles_9_6(law_step_s):
    imu = Imu(gyro_bias_dph=(0.0, 0.02, 0.0), accel_bias_ug=(50.0, 50.0, 0.0))
    run = navigate(
        StaticMotion(),
        100.0,
        3600.0,
        imu,
        [0, 0, 0, 0, 0.1 * DEG, 0.1 * DEG, 0],
        "external",
        CompassNetwork(sigma=0.0088, xi=0.7),
        reference((0, 0), 3600.0, law_step_s),
        law_step_s,
    )
    for column, final, settled in ((PHI_E, -0.002868, 541), (PHI_N, 0.002868, 545)):
        phi = run.recorder.rows[:, column] / DEG
        assert phi[-1] == pytest.approx(final, abs=1e-3 * 0.1)
        assert np.flatnonzero(np.abs(phi - phi[-1]) > 0.02 * 0.1)[-1] == pytest.approx(settled, abs=2)


@pytest.mark.parametrize("attitude", [(0, 0, 0), (0, 0, 90), (10, 20, 310), (6, 8, 75), (-30, 45, 200)])
def test_perfect_sensors_at_rest_leave_no_velocity(attitude):
    pitch, roll, heading = attitude
    motion = StaticMotion(pitch_deg=pitch, roll_deg=roll, heading_deg=heading)
    stats = navigate(motion, 200.0, 3 * 3600.0).recorder.stats
    assert stats[[DV_E, DV_N], MAX_ABS].max() <= 1e-9
