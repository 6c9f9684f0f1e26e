"""Zha 2019, figures 2 to 5 and tables 1, 2: roll error without and with a reference, velocity on a drive."""

from __future__ import annotations

import numpy as np
import pytest

from navcore.scenario.file import load
from tests.acceptance.papers import verdicts
from tests.papers import zha, zha_drive
from tests.papers.runs import Runs


@pytest.fixture(scope="module")
def runs() -> Runs:
    return Runs()


def test_the_sensors_are_the_papers():
    for name in ("zha-internal", "zha-external"):
        imu = load(name).imu
        assert imu.gyro_bias_dph == (0.01, 0.01, 0.01) and imu.gyro_arw_dpsh == 0.005
        assert imu.accel_bias_ug == (100.0, 100.0, 100.0)
        assert set(imu.gyro_scale_ppm + imu.accel_scale_ppm) == {5.0}
        assert set(imu.gyro_misalignment_arcsec + imu.accel_misalignment_arcsec) == {5.0}
    assert load("zha-internal").motion == load("zha-external").motion
    assert load("zha-internal").reference.kind == "none"
    assert load("zha-external").reference.bias_mps == (0.5, 0.5)


def test_figure_2_fast_damping_without_a_reference_is_worse_than_none(runs):
    free, fast = (np.mean(zha.roll_spreads(runs, "zha-internal", name)) for name in ("free", "fast"))
    assert fast > 2.0 * free


def test_figure_3_percentages_come_with_an_initial_tilt(runs):
    assert zha.reduction(runs, "free") == pytest.approx(86.0, rel=0.1)
    assert zha.reduction(runs, "classic2") == pytest.approx(48.9, rel=0.1)
    assert zha.reduction(runs, "classic2", zha.NO_TILT) < 35.0
    assert zha.reduction(runs, "classic2", zha.AT_REST, zha.NO_TILT) < 0.0


@pytest.mark.parametrize(
    ("exhibit", "expected"),
    [
        (zha.FAST, ["agrees"] * 2 + ["differs"] * 4),
        (zha.INTERNAL, ["agrees"] * 2),
        (zha.EXTERNAL, ["agrees", "agrees", "undecided", "differs"]),
        (zha.LAB, ["agrees"] * 2),
        (zha_drive.DRIVE, ["agrees", "differs", "agrees", "differs"]),
    ],
    ids=lambda value: getattr(value, "name", ""),
)
def test_what_is_claimed(runs, exhibit, expected):
    assert verdicts(exhibit, runs) == expected


def test_the_schedule_is_the_papers():
    scenario = load("zha-drive").canonical()
    policy = scenario["method"][2]["policy"]
    assert policy["from"] == [0.0264, 156.063, 0.904]
    assert (policy["to"], policy["duration_s"]) == ([7.68e-3, 6.68, 7.68e-3], 60.0)
    assert scenario["imu"]["accel_bias_ug"] == [500.0, 500.0, 500.0]


def test_tables_1_and_2_order_of_the_methods(runs):
    for axis in zha_drive.COLUMNS:
        free, classic, fast = (np.mean(zha_drive.spreads(runs, name, axis)) for name in zha_drive.METHODS)
        assert free > 1.5 * classic > 1.5 * 4.0 * fast
