"""The Kalman filter as a method: refused where it cannot work, its covariance true, its limits visible."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from navcore import budget
from navcore.design.floor import steady_floor
from navcore.design.tuned_designs import kalman
from navcore.engine.drivers.kalman import NOTHING_RANDOM, filtered_linear, filtered_strapdown
from navcore.engine.drivers.strapdown import settings_of
from navcore.engine.environment import environment
from navcore.engine.simulation import simulate
from navcore.engine.strapdown_environment import strapdown_environment
from navcore.foundation.compiled import plain
from navcore.mechanization.kalman.strapdown import _correct
from navcore.mechanization.strapdown.attitude import quaternion_of
from navcore.mechanization.strapdown.run import turned_by
from navcore.scenario.model import Scenario
from navcore.scenario.stochastic import stochastic_model
from tools.filter_consistency import consistency

SET_A = {
    "gyro_arw_dpsh": 0.003, "gyro_instability_dph": 0.003, "gyro_tau_s": 3600.0,
    "accel_vrw_ugpshz": 10.0, "accel_instability_ug": 10.0, "accel_tau_s": 3600.0,
}  # fmt: skip
KALMAN = {"damping": "kalman"}


def scenario(**blocks: Any) -> Scenario:
    data: dict[str, Any] = {
        "run": {"duration_h": 24.0, "step_s": 2.0, "earth": "sphere"},
        "imu": SET_A,
        "reference": {"kind": "log", "noise_mps": 0.2, "drift_mps": 0.1, "drift_tau_s": 600.0},
        "method": [KALMAN],
    }
    for name, block in blocks.items():
        data[name] = {**data[name], **block} if isinstance(block, dict) and name in data else block
    return Scenario.parse(data)


def test_network_policy_and_switching_are_told_to_be_unused() -> None:
    method = KALMAN | {"network": {"id": "classic2"}, "policy": {"id": "variation"}}
    run = simulate(scenario(run={"duration_h": 0.1}, method=[method])).methods[0]
    assert any("the network is not used" in text for text in run.warnings)
    assert any("policy and switching are not used" in text for text in run.warnings)


def test_without_random_errors_it_says_that_it_corrects_nothing() -> None:
    quiet = scenario(run={"duration_h": 0.1}, imu={name: 0.0 for name in SET_A if "tau" not in name})
    quiet = quiet.model_copy(update={"reference": quiet.reference.model_copy(update={"drift_mps": 0.0})})
    assert NOTHING_RANDOM in simulate(quiet).methods[0].warnings


def test_its_covariance_comes_to_the_floor() -> None:
    """At rest the variance of the tilt after a day is that of the Riccati equation of one channel."""
    found = scenario()
    run, _ = filtered_linear(found, found.method[0], environment(found), np.zeros(7))
    while not run.advance(100_000):
        pass
    floor = steady_floor(stochastic_model(found), found.omega_s)
    P = run.filter.P
    assert floor.tilt_rad is not None
    assert floor.velocity_mps is not None
    assert math.sqrt(P[4, 4]) == pytest.approx(floor.tilt_rad, rel=0.02)
    assert math.sqrt(P[0, 0]) == pytest.approx(floor.velocity_mps, rel=0.02)
    np.testing.assert_allclose(P, P.T, rtol=1e-12)
    assert np.linalg.eigvalsh(P / np.sqrt(np.outer(np.diag(P), np.diag(P)))).min() > 0.0


@pytest.mark.slow
@pytest.mark.parametrize("fidelity", ["error_model", "strapdown"])
def test_its_covariance_holds_over_seeds(fidelity: str) -> None:
    """Normalised error of a moving ship with a log along its axes, biases and initial errors drawn."""
    found = consistency(100, fidelity, duration_h=2.0)
    assert found.holds, found


def test_it_wins_while_its_model_is_right_and_loses_to_an_event_it_was_not_told_of() -> None:
    event = {"t_h": 12.0, "duration_s": 1000.0, "accel_mps2": [0.002, 0.002]}
    others = [{"damping": "external", "network": {"id": name}} for name in ("unity2", "classic2", "classic3")]

    def tilts(events: list[dict[str, Any]]) -> list[float]:
        found = simulate(scenario(method=[method | {"event": events} for method in (KALMAN, *others)]))
        errors = [method.errors for method in found.methods]
        return [math.hypot(error["phi_e_rad"]["rms"], error["phi_n_rad"]["rms"]) for error in errors]

    kalman, *damped = tilts([])
    assert kalman < min(damped)
    misled, *disturbed = tilts([event])
    assert misled > 2.0 * max(disturbed)


TURNING = {
    "kind": "legs",
    "leg": [
        {"duration_s": 5400.0, "speed_mps": 6.0},
        {"duration_s": 180.0, "turn_dps": 0.5},
        {"duration_s": 5400.0},
        {"duration_s": 180.0, "turn_dps": 0.5},
        {"duration_s": 20000.0, "speed_mps": 3.0},
    ],
}
WATER = {"current_std_mps": 0.4, "current_tau_s": 1e6}
SCALE = {"scale_std_ppm": 8000.0}


def through_water(methods: list[dict[str, Any]], **log: Any) -> Scenario:
    """A ship that turns through moving water, with a log along its axes."""
    reference = {"frame": "body", "drift_mps": 0.02, **log}
    return scenario(run={"duration_h": 8.0}, motion=TURNING, reference=reference, method=methods)


def test_it_estimates_the_current_and_the_scale_that_it_is_told_of() -> None:
    """Without these states it takes both for errors of the navigation, and loses to a network."""
    damped = {"damping": "external", "network": {"id": "classic2"}}
    methods = [
        KALMAN,
        KALMAN | {"name": "water", "kalman": WATER},
        KALMAN | {"name": "both", "kalman": WATER | SCALE},
        damped,
    ]
    found = simulate(through_water(methods, current_mps=(0.4, -0.3), scale_ppm=8000.0)).methods
    plain_m, water_m, both_m, damped_m = (one.errors["position_m"]["rms"] for one in found)
    assert plain_m > damped_m > 2.0 * max(water_m, both_m)
    run, _ = filtered_linear(
        ship := through_water(methods[2:3], current_mps=(0.4, -0.3), scale_ppm=8000.0),
        ship.method[0], environment(ship), np.zeros(7),
    )  # fmt: skip
    while not run.advance(100_000):
        pass
    at = [*run.model.axis].index(8)
    east, north, scale = run.filter.sensors[at : at + 3]
    sigma = np.sqrt(np.diag(run.filter.P)[7 + at : 10 + at])
    assert (sigma < 0.5 * np.array([0.4, 0.4, 8e-3])).all(), "it has learnt of each"
    assert (np.abs([east - 0.4, north + 0.3, scale - 8e-3]) < 3.0 * sigma).all()


def test_its_covariance_holds_for_currents_and_scales_as_it_is_told() -> None:
    generator = np.random.default_rng(7)
    squares = []
    for seed in range(24):
        current, scale = 0.4 * generator.standard_normal(2), 8000.0 * generator.standard_normal()
        ship = through_water(
            [KALMAN | {"kalman": WATER | SCALE}], current_mps=tuple(current), scale_ppm=scale
        )
        run = ship.run.model_copy(update={"seed": seed, "duration_h": 4.0, "step_s": 5.0})
        (one,) = simulate(ship.model_copy(update={"run": run})).methods
        assert one.sigma is not None
        squares.append((one.rows[-1, :7] / one.sigma[-1]) ** 2)
    mean = np.mean(squares, axis=0)  # of 24 chi squares: within 0.5 and 1.75 with 98 % each
    assert (mean > 0.4).all() and (mean < 2.0).all(), mean


def test_what_it_is_told_further_changes_no_other_filter() -> None:
    before, after = (
        simulate(through_water([KALMAN | block], current_mps=(0.2, 0.1))).methods[0].rows
        for block in ({}, {"kalman": {"current_std_mps": 0.0, "scale_std_ppm": 0.0}})
    )
    np.testing.assert_array_equal(before, after)


def test_a_design_offers_it_where_the_water_moves() -> None:
    still, moving = through_water([KALMAN]), through_water([KALMAN], tide_mps=(0.6, 0.0), scale_ppm=-5000.0)
    assert [one.name for one in kalman(still)] == ["kalman"]
    (_, told) = kalman(moving)
    assert told.settings.current_std_mps == pytest.approx(0.3) and told.settings.scale_std_ppm == 5000.0
    assert told.settings.current_tau_s == 20_000.0
    assert kalman(through_water([KALMAN], current_mps=(0.3, 0.4)))[1].settings.current_tau_s == 1e6


def test_its_budget_is_that_of_seeds() -> None:
    found = budget(
        through_water([KALMAN, KALMAN | {"name": "water", "kalman": WATER}], current_mps=(0.4, -0.3)), seeds=8
    )
    assert [one.shown for one in found.methods] == ["covariance", "seeds"]


def test_the_log_out_of_service_lets_the_covariance_grow() -> None:
    outage = scenario(reference={"outage": [{"t_h": 20.0, "duration_s": 14400.0}]})
    with_log = scenario()
    ends = []
    for found in (with_log, outage):
        run, _ = filtered_linear(found, found.method[0], environment(found), np.zeros(7))
        while not run.advance(100_000):
            pass
        ends.append(run.filter.P[0, 0])
    assert ends[1] > 2.0 * ends[0]


def test_both_fidelities_agree() -> None:
    """The same biases, start and log: the error model and the mechanization, which sees the second order."""
    moving = {
        "run": {"duration_h": 2.0, "step_s": 1.0, "rate_hz": 10.0},
        "motion": {"kind": "legs", "leg": [{"duration_s": 1800.0, "speed_mps": 6.0}, {"duration_s": 90.0,
                                            "turn_dps": 1.0}, {"duration_s": 9000.0}]},
        "imu": {name: 0.0 for name in SET_A if "tau" not in name}
        | {"gyro_bias_dph": [0.01, -0.02, 0.01], "accel_bias_ug": [20.0, -30.0, 0.0]},
        "initial_error": {"attitude_arcmin": [0.5, -0.5, 3.0], "velocity_mps": [0.1, 0.0]},
    }  # fmt: skip
    linear, full = (
        simulate(scenario(**(moving | {"run": moving["run"] | {"fidelity": fidelity}}))).methods[0]
        for fidelity in ("error_model", "strapdown")
    )
    scale = np.abs(linear.rows[:, :7]).max(axis=0)
    np.testing.assert_allclose(full.rows[:, :7] / scale, linear.rows[:, :7] / scale, atol=0.02)


@pytest.mark.parametrize("chunk", [7, 1000])
def test_the_length_of_the_chunks_changes_nothing(chunk: int) -> None:
    found = scenario(run={"duration_h": 0.1, "fidelity": "strapdown", "rate_hz": 10.0})
    env = strapdown_environment(found)
    samples = np.concatenate([increments.copy() for increments, _ in env.imu.chunks()])
    ends = []
    for length in (len(samples), chunk):
        run, _ = filtered_strapdown(found, found.method[0], env, settings_of(found, env.sampling))
        for first in range(0, len(samples), length):
            run.advance(samples[first : first + length])
        ends.append((run.recorder.rows[-1], run.filter.P))
    np.testing.assert_array_equal(ends[1][0], ends[0][0])
    np.testing.assert_array_equal(ends[1][1], ends[0][1])


def test_a_correction_turns_the_attitude_back_by_the_estimated_tilt() -> None:
    quaternion = np.array(quaternion_of(0.2, -0.3, 1.0))
    x = SimpleNamespace(q=quaternion.copy(), v=np.zeros(3), d_lat=0.0, d_lon=0.0)
    found = np.array([0.3, -0.2, 1e-5, 2e-5, 2e-3, -1e-3, 5e-3])
    plain(_correct)(x, found)
    assert x.q == pytest.approx(turned_by(found[4:], quaternion), abs=1e-15)
    assert (*x.v, x.d_lat, x.d_lon) == pytest.approx((-0.3, 0.2, 0.0, -1e-5, -2e-5), abs=1e-15)
