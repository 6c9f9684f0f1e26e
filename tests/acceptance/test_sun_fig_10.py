"""Sun 2017, figures 10 to 12: a ship accelerates at 10 h; conventional, adaptive and free."""

from __future__ import annotations

import numpy as np
import pytest

from navcore.foundation.units import HOUR, KNOT
from navcore.motion.base import VE, VN
from navcore.scenario.file import load
from tests.acceptance.papers import verdicts
from tests.papers.runs import Runs, method
from tests.papers.sun_ship import ANGLES, EQ_8_GYROS, METHODS, SHIP, SMALL_ERRORS, measured, over_conventional
from tests.papers.sun_vehicle import VEHICLE


@pytest.fixture(scope="module")
def runs() -> Runs:
    return Runs()


def test_the_setting_is_the_papers(runs):
    scenario = load("sun-ship")
    assert scenario.initial_error.attitude_arcmin == (6.0, 6.0, 90.0)
    assert scenario.imu.gyro_bias_dph == (0.02, 0.02, 0.02)
    assert scenario.reference.scale_ppm == 20000.0
    run = runs("sun-ship")
    speed = np.hypot(run.truth[:, VE], run.truth[:, VN]) / KNOT
    np.testing.assert_allclose(
        np.interp(np.array([5.0, 15.0]) * HOUR, run.t_s, speed), [2.0, 10.0], rtol=1e-6
    )
    # 4 kn/min at 10 h 2 min: half of the 8 kn are gained there
    assert np.interp(10.0 * HOUR + 120.0, run.t_s, speed) == pytest.approx(6.0, abs=0.01)


@pytest.mark.parametrize("angle", ANGLES)
def test_adaptive_overshoots_less_than_conventional(runs, angle):
    assert np.all(over_conventional(runs, "overshoot", angle) < 0.7)


def test_the_law_stays_at_the_end_of_its_table_with_the_printed_initial_errors(runs):
    assert measured(runs)["largest xi"] == pytest.approx(0.04)


def test_small_initial_errors_do_not_change_that_but_better_gyros_do(runs):
    assert np.mean(measured(runs, SMALL_ERRORS)["xi"]) < 0.07
    assert np.mean(measured(runs, EQ_8_GYROS)["xi"]) > 0.25
    for angle in ("pitch", "heading"):
        assert np.mean(over_conventional(runs, "overshoot", angle, EQ_8_GYROS)) > 1.0


def test_every_method_finishes(runs):
    assert all(method(runs("sun-ship"), name).status == "ok" for name in METHODS)


def test_what_is_claimed(runs):
    found = ["agrees"] * 4 + ["differs"] * 3 + ["agrees", "differs", "agrees"] + ["differs"] * 3
    assert verdicts(SHIP, runs) == found


def test_the_vehicle_experiment(runs):
    assert verdicts(VEHICLE, runs) == ["undecided", "agrees", "agrees"]
