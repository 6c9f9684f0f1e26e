"""Errors of sensors and logs of several seeds side by side are, to the last bit, those of each alone."""

import numpy as np
import pytest

from navcore.engine.ensemble import drawn
from navcore.engine.environment import environment, environment_side_by_side
from navcore.scenario.file import load
from navcore.scenario.model import Scenario

WIDTH, SEEDS = 4, 3
QUIET = ["imu.gyro_arw_dpsh=0", "imu.accel_vrw_ugpshz=0", "reference.noise_mps=0", "reference.drift_mps=0"]
ERRORS = {
    "as it is": [],
    "constant": QUIET,
    "constant in one channel": [*QUIET, "run.fidelity=channel"],
    "one channel": ["run.fidelity=channel"],
    "drifting sensors": ["imu.gyro_instability_dph=0.01", "imu.accel_instability_ug=20"],
    "counts": ["imu.gyro_lsb=[1e-6, 1e-6, 0]", "imu.accel_lsb=[0, 1e-4, 1e-4]"],
    "scale and misalignment": [
        "imu.gyro_scale_ppm=[5, -3, 2]",
        "imu.accel_misalignment_arcsec=[1, 2, 3, 4, 5, 6]",
    ],
    "no delay": ["reference.delay_s=0"],
    "scale of the log": ["reference.delay_s=0", "reference.scale_ppm=500"],
    "current": ["reference.delay_s=0", "reference.current_mps=[0.3, -0.2]"],
    "resolution and smoothing": ["reference.lsb_mps=0.05", "reference.smoothing_s=30"],
    "fast log": ["reference.rate_hz=10", "reference.lsb_mps=0.01", "reference.delay_s=0"],
    "log in E and N": ["reference.frame=enu", "reference.lsb_mps=0.02"],
    "outage and low speed": ["reference.min_speed_mps=1", "reference.outage=[{t_h=0.2, duration_s=700}]"],
}


def test_without_a_log_there_is_none_side_by_side() -> None:
    judge(load("zha-internal", ["run.duration_h=1.2"]))


@pytest.mark.parametrize("changes", ERRORS.values(), ids=ERRORS)
def test_seeds_side_by_side_are_each_alone(changes: list[str]) -> None:
    judge(load("sikuliaq-like", ["run.duration_h=1.2", *changes]))


def judge(base: Scenario) -> None:
    """Compare the errors of the seeds of a scenario."""
    scenarios = [drawn(base, number) for number in range(SEEDS)]
    together = environment_side_by_side(scenarios, WIDTH)
    for place in range(WIDTH):
        alone = environment(scenarios[place if place < SEEDS else 0])
        np.testing.assert_array_equal(together.sensors.gyro[:, :, place], alone.sensors.gyro)
        np.testing.assert_array_equal(together.sensors.accel[:, :, place], alone.sensors.accel)
        np.testing.assert_array_equal(together.reference.error[:, :, place], alone.reference.error)
        np.testing.assert_array_equal(together.reference.valid, alone.reference.valid)
        np.testing.assert_array_equal(together.reference.time_s, alone.reference.time_s)
    if base.reference.kind == "log":
        assert len(np.unique(together.reference.error[-1], axis=1).T) == SEEDS
    assert len(np.unique(together.sensors.gyro[-1], axis=1).T) == SEEDS
