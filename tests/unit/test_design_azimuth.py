"""The covariance with an azimuth channel: equal to the run for one known error, to many seeds for noise."""

from typing import Any

import numpy as np
import pytest

from navcore.design.bands import covariance_bands
from navcore.design.budget import budget
from navcore.engine.simulation import simulate
from navcore.scenario.model import Scenario

COMPLEMENTARY, UNITY2 = {"id": "complementary"}, {"id": "unity2", "zeta": 0.5}
EXTERNAL = {"damping": "external", "network": COMPLEMENTARY, "azimuth": UNITY2}
INTERNAL = {**EXTERNAL, "damping": "internal"}
COMPASS = {
    "damping": "external",
    "network": {"id": "compass", "sigma": 0.0015, "xi": 0.7},
    "gyrocompass": {"sigma": 0.002, "xi": 0.707},
}
UNDER_WAY = {
    "kind": "legs",
    "leg": [
        {"duration_s": 7200.0, "speed_kn": 10.0, "heading_deg": 30.0},
        {"duration_s": 90.0, "turn_dps": 1.0},
        {"duration_s": 50_000.0},
    ],
}
OUTAGE = {"outage": [{"t_h": 5.0, "duration_s": 3600.0}]}
GYRO = {"imu": {"gyro_bias_dph": [0.0, 0.0, 0.01]}}
HEADING = {"initial_error": {"attitude_arcmin": [0.0, 0.0, 3.0]}}
LOG_NORTH, LOG_EAST = {"reference": {"bias_mps": [0.0, 0.1]}}, {"reference": {"bias_mps": [0.1, 0.0]}}


def made(method: dict[str, Any], hours: float = 12.0, **blocks: dict[str, Any]) -> Scenario:
    """One method, a log of 1 Hz unless blocks say otherwise."""
    log = {"kind": "log", "rate_hz": 1.0} | blocks.pop("reference", {})
    run = {"duration_h": hours, "output_step_s": 60.0} | blocks.pop("run", {})
    return Scenario.parse({"run": run, "reference": log, "method": [method], **blocks})


def apart(scenario: Scenario) -> np.ndarray:
    """Largest difference of the budget's deviation from the run's error, over its peak; shape (7,)."""
    series, run = budget(scenario).methods[0].series, simulate(scenario).methods[0]
    assert series is not None
    rows = [int(np.argmin(np.abs(run.t_s - t))) for t in series.t_s]
    error = np.abs(run.rows[rows, :7])
    return np.abs(np.sqrt(series.total) - error).max(axis=0) / error.max(axis=0)


@pytest.mark.parametrize("method", [EXTERNAL, COMPASS], ids=["whole", "gyrocompass"])
@pytest.mark.parametrize(
    ("error", "log"),
    [
        (GYRO, {}),
        (HEADING, OUTAGE),
        (LOG_NORTH, {"rate_hz": 0.05}),
        (LOG_EAST, {"rate_hz": 0.05, **OUTAGE}),
        (LOG_NORTH, OUTAGE),
    ],
    ids=["gyro", "heading-outage", "slow-north", "slow-east-outage", "north-outage"],
)
def test_one_known_error_is_carried_as_the_run_carries_it(method, error, log) -> None:
    """At rest nothing is approximated: held log, outage, clearing and dead reckoning are in the map."""
    scenario = made(method, **(error | {"reference": log | error.get("reference", {})}))
    assert apart(scenario).max() < 1e-6


@pytest.mark.parametrize(
    ("method", "error"), [(EXTERNAL, LOG_NORTH), (COMPASS, HEADING), (INTERNAL, {})], ids=str
)
def test_under_way_the_budget_follows_the_run(method, error) -> None:
    """With a turn at 10 knots, whose coefficients are means; internal damping by the manoeuvre itself."""
    scenario = made(method, motion=UNDER_WAY, **error)
    assert apart(scenario).max() < 0.006


@pytest.mark.parametrize("method", [EXTERNAL, INTERNAL, COMPASS], ids=["whole", "internal", "gyrocompass"])
def test_noise_and_drifts_agree_with_many_seeds(method) -> None:
    """All six random sources, log at 0.1 Hz; the deviation of 200 runs is known to 5 %."""
    blocks: dict[str, Any] = {
        "imu": {
            "gyro_arw_dpsh": 0.003,
            "gyro_instability_dph": 0.01,
            "accel_vrw_ugpshz": 10.0,
            "accel_instability_ug": 20.0,
        },
        "reference": {"noise_mps": 0.2, "drift_mps": 0.1, "rate_hz": 0.1},
    }
    seeds, squares = 200, np.zeros(1)
    run = {"step_s": 10.0, "output_step_s": 3600.0}
    for seed in range(seeds):
        one = made(method, run={**run, "seed": seed}, **{**blocks, "reference": {**blocks["reference"]}})
        squares = squares + simulate(one).methods[0].rows[:, :7] ** 2
    scenario = made(method, run=run, **blocks)
    found = budget(scenario).methods[0]
    assert found.shown == "covariance"
    assert found.series is not None
    rows = [int(np.argmin(np.abs(found.series.t_s - t))) for t in np.arange(2, 13) * 3600.0]
    ratio = np.sqrt(squares[2:] / seeds / found.series.total[rows])
    assert np.all(np.abs(ratio - 1.0) < 4.0 * 0.05)
    assert abs(float(np.mean(ratio)) - 1.0) < 0.06
    bands = covariance_bands(scenario)
    assert bands is not None
    assert bands.methods[0].kind == "covariance"


def test_the_steady_state_says_that_the_azimuth_channel_is_not_in_it() -> None:
    """It is one level channel; the budget along the run has all of them."""
    noisy = {"imu": {"gyro_arw_dpsh": 0.003}}
    found = budget(made(EXTERNAL, **noisy), steady=True).methods[0]
    assert any("azimuth" in text for text in found.warnings)
    plain = {name: value for name, value in EXTERNAL.items() if name != "azimuth"}
    level = budget(made(plain, **noisy), steady=True).methods[0]
    assert not any("azimuth" in text for text in level.warnings)
