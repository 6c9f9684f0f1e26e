"""The steady Kalman filter as a loop: poles, settling, and where it stands in metrics and designs."""

import math

import numpy as np
import pytest

from navcore.analysis.filter_loop import filter_loop
from navcore.design.budget import budget
from navcore.design.designs import designs
from navcore.engine.ensemble import outcomes
from navcore.engine.measures import metrics
from navcore.engine.simulation import simulate
from navcore.networks.lqg import PHI, filter_covariance, plant
from navcore.scenario.model import Scenario
from tests.acceptance.test_design_values import SET_A, set_a

FILTER = {"name": "filter", "damping": "kalman"}


@pytest.mark.known(
    "twin", ["settling_s"], kinds=["kalman"], fidelities=["loop"], source="the estimator's own response"
)
def test_settling_is_that_of_the_estimators_response() -> None:
    """Sampled 30,000 times, to the step; the poles are those of A - L C."""
    scenario = set_a({"id": "classic2"})
    loop = filter_loop(scenario.figures(), scenario.omega_s)
    assert loop is not None and loop.settling_s is not None
    system = plant(scenario.figures(), scenario.omega_s).excited()
    estimator = system.A - filter_covariance(system) @ system.C.T @ system.C / system.V
    values, vectors = np.linalg.eig(estimator)
    shares = np.linalg.solve(vectors, np.eye(len(values))[PHI])
    t = np.linspace(0.0, 3.0 * loop.settling_s, 30001)
    tilt = np.exp(np.outer(t * scenario.omega_s, values)) @ (vectors[PHI] * shares)
    assert t[np.flatnonzero(np.abs(tilt) > 0.02)[-1]] == pytest.approx(loop.settling_s, abs=2.0 * t[1])
    assert sorted(loop.poles.real) == pytest.approx(sorted(np.real(values) * scenario.omega_s))
    assert math.isnan(loop.h0) and 0.0 < loop.damping_ratio < 1.0


def test_metrics_and_limits_have_the_filters_loop() -> None:
    """Not the undamped one: it settles, it decays, and meets limits on both."""
    limits = [{"quantity": "settling_s", "at_most": 3600.0}, {"quantity": "growth_per_s", "at_most": 0.0}]
    blocks = {
        **SET_A,
        "run": {"duration_h": 0.5, "earth": "sphere"},
        "method": [FILTER],
        "requirement": limits,
    }
    scenario = Scenario.parse(blocks)
    (method,) = metrics(simulate(scenario))["methods"]
    assert method["loop"]["settling_s"] == pytest.approx(3078.2, rel=1e-3)
    assert method["loop"]["growth_per_s"] == pytest.approx(-2.778e-4, rel=1e-3)
    assert method["loop"]["h0"] is None and all(one["met"] for one in method["requirements"])
    assert designs(scenario, 2, as_set=True).methods[0].met == 1.0


def test_without_a_steady_state_there_is_no_loop() -> None:
    """Perfect gyros and accelerometers: the filter goes on learning."""
    quiet = Scenario.parse({"reference": {"kind": "log", "noise_mps": 0.1}, "method": [FILTER]})
    assert filter_loop(quiet.figures(), quiet.omega_s) is None


def test_budget_with_an_error_that_the_filter_is_not_told_of() -> None:
    """An event of the log: own covariance and response together are the mean square of 60 seeds."""
    event = [{"t_h": 2.0, "duration_s": 60.0, "accel_mps2": [0.01, 0.0]}]
    scenario = Scenario.parse(
        {
            **SET_A,
            "run": {"duration_h": 6.0, "output_step_s": 60.0, "step_s": 2.0},
            "reference": {**SET_A["reference"], "rate_hz": 0.5, "event": event},
            "initial_error": {"level_std_arcmin": 0.2},
            "method": [FILTER],
        }
    )
    found = budget(scenario).methods[0]
    assert found.shown == "covariance" and set(found.sources) == {"told", "log_events"}
    spans = [one[0].spans[0].rms for one in outcomes(scenario, scenario.method, range(60))]
    tilt, velocity, *_ = np.sqrt(np.mean(np.array(spans) ** 2, axis=0) / 2.0)
    assert found.total.rms.tilt_rad == pytest.approx(tilt, rel=0.04)
    assert found.total.rms.velocity_mps == pytest.approx(velocity, rel=0.04)
    assert (found.sources["log_events"].rms.velocity_mps or 0.0) > 0.1


def test_biases_in_the_filters_steady_budget() -> None:
    """nabla / g stays; a gyro's velocity R eps is told from the log's bias by their spreads."""
    biases = {"gyro_bias_dph": [0.01, 0.01, 0.0], "accel_bias_ug": [50.0, 50.0, 0.0]}
    blocks = {**SET_A, "imu": {**SET_A["imu"], **biases}, "method": [FILTER]}
    alone = budget(Scenario.parse(blocks), steady=True).methods[0].sources
    assert alone["accel_bias"].rms.tilt_rad == pytest.approx(50e-6, rel=1e-3)
    assert alone["gyro_bias"].rms.velocity_mps == 0.0
    blocks["reference"] = {**SET_A["reference"], "bias_std_mps": 0.3092}
    both = budget(Scenario.parse(blocks), steady=True).methods[0].sources
    assert both["gyro_bias"].rms.velocity_mps == pytest.approx(0.5 * 0.3092, rel=2e-3)
    assert both["log_bias"].rms.velocity_mps == pytest.approx(0.5 * 0.3092, rel=2e-3)
