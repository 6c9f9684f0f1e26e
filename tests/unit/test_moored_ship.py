"""The velocity zero that a moored ship knows: in the place of the log, in runs, filter, budget and floor."""

from typing import Any

import numpy as np
import pytest

from navcore.design.ship import Ship
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.motion.truth import VN
from navcore.scenario.model import Scenario
from navcore.sensors.log import reference_errors

LEGS = [
    {"duration_s": 1500.0, "speed_mps": 8.0},
    {"duration_s": 2100.0, "speed_mps": 0.0, "accel_mps2": 0.05},
]


def scenario(fidelity: str = "error_model", damping: str = "external", **reference: Any) -> Scenario:
    own = {"bias_mps": [0.2, -0.3], "noise_mps": 0.1, "drift_mps": 0.1, "event": [], **reference}
    return Scenario.parse(
        {
            "run": {"duration_h": 2.0, "rate_hz": 50.0, "fidelity": fidelity},
            "motion": {"kind": "legs", "leg": LEGS, "repeat": 2},
            "imu": {"gyro_bias_dph": [0.01, -0.02, 0.01]},
            "initial_error": {"attitude_arcmin": [0.2, 0.2, 1.0]},
            "reference": {"kind": "log", "frame": "body", **own},
            "method": [
                {"damping": damping} | ({"network": {"id": "classic2"}} if damping == "external" else {})
            ],
        }
    )


def velocity_error(of: Scenario) -> np.ndarray:
    return simulate(of).methods[0].rows[:, 3:5]


def test_zero_stands_in_the_place_of_the_log():
    event = [{"t_h": 0.1, "duration_s": 10.0, "accel_mps2": [0.1, 0.1]}]
    moored = scenario(
        zero_below_mps=0.05, min_speed_mps=1.0, event=event, outage=[{"t_h": 0.8, "duration_s": 900.0}]
    )
    truth = moored.motion.truth(7201, 1.0, moored.site.site(), moored.earth)
    log = reference_errors(moored.reference, truth, 7200.0, 1, step_s=1.0)
    still = truth.values[:, VN] < 0.05
    assert 1700 < still[:3600].sum() < 2100
    assert np.array_equal(log.moored, still)
    assert log.valid[still].all()
    assert not log.valid[(truth.values[:, VN] >= 0.05) & (truth.values[:, VN] < 1.0)].any()
    assert log.error[still] == pytest.approx(-truth.values[still][:, [VN - 1, VN]])
    assert np.abs(log.error[~still]).max() > 1.0


@pytest.mark.parametrize("damping", ["external", "kalman"])
def test_both_fidelities_agree(damping: str):
    linear = velocity_error(scenario(damping=damping, zero_below_mps=0.05))
    full = velocity_error(scenario("strapdown", damping=damping, zero_below_mps=0.05))
    plain = velocity_error(scenario(damping=damping))
    scale = np.abs(plain).max()
    assert np.abs(linear - plain).max() > 0.2 * scale
    assert np.abs(full - linear).max() < 0.1 * scale


def test_the_budget_knows_it():
    moored = scenario(zero_below_mps=0.05, bias_mps=[0.0, -0.3], noise_mps=0.0, drift_mps=0.0)
    silent = moored.model_copy(
        update={"imu": type(moored.imu)(), "initial_error": type(moored.initial_error)()}
    )
    found = Ship(silent).along(silent.method[0])
    run = velocity_error(silent)
    places = np.rint(found.t_s / 10.0).astype(int)
    assert found.variance["log_bias"].max() > 0.0
    expected = np.sqrt(found.total[:, 3:5])
    assert expected == pytest.approx(np.abs(run[places]), abs=0.04 * expected.max())
    random = scenario(zero_below_mps=0.05)
    budget, plain = (Ship(s).along(s.method[0]).variance for s in (random, scenario()))
    assert budget["log_white"][-1, 3] < 0.5 * plain["log_white"][-1, 3]


def test_the_floor_is_the_filters_own_covariance():
    moored = scenario(damping="kalman", zero_below_mps=0.05)
    sigma = simulate(moored).methods[0].sigma
    floor = Ship(moored).floor_series
    assert sigma is not None and floor is not None
    places = np.rint(floor.t_s / 10.0).astype(int)
    assert np.sqrt(floor.total[1:, 3]) == pytest.approx(sigma[places[1:], 3], rel=0.15)


def test_a_negative_speed_is_named():
    with pytest.raises(InputError) as refused:
        scenario(zero_below_mps=-0.1)
    (fault,) = refused.value.faults
    assert (fault.field, fault.value) == ("reference.zero_below_mps", -0.1)
    assert "must be >= 0 and <= 5 (m/s)" in str(fault.allowed)
