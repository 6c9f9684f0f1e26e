"""Sources of a method's errors: the budget where it models the method, else the scenario run apart."""

import numpy as np
import pytest

from navcore.design import sources
from navcore.design.ship import Ship
from navcore.design.sources import active_sources, contributions, only
from navcore.engine.simulation import simulate
from navcore.mechanization.recorder import NAMES
from navcore.scenario.file import load
from navcore.scenario.model import Scenario

SCENARIO = {
    "run": {"duration_h": 3.0, "step_s": 5.0},
    "imu": {"gyro_bias_dph": [0.0, 0.01, 0.0], "gyro_arw_dpsh": 0.002, "accel_bias_ug": [20.0, 0.0, 0.0]},
    "initial_error": {"velocity_mps": [0.1, 0.0]},
    "reference": {"kind": "log", "noise_mps": 0.2, "rate_hz": 0.2},
    "method": [
        {"name": "free"},
        {
            "name": "damped",
            "damping": "external",
            "network": {"id": "classic2"},
            "event": [{"t_h": 1.0, "duration_s": 100.0, "accel_mps2": [0.01, 0.0]}],
        },
    ],
}
ALL = ("initial error", "gyro bias", "accelerometer bias", "gyro noise", "log noise", "log events")


def test_what_is_switched_on_is_named():
    assert active_sources(Scenario.parse(SCENARIO)) == ALL
    assert active_sources(Scenario.parse({})) == ()


def test_errors_of_the_sources_add_up_to_the_whole():
    scenario = Scenario.parse(SCENARIO)
    whole = simulate(scenario)
    runs = [simulate(only(scenario, name)) for name in ALL]
    for i, method in enumerate(whole.methods):
        together = np.sum([run.methods[i].rows[:, :7] for run in runs], axis=0)
        scale = np.abs(method.rows[:, :7]).max(axis=0)
        assert np.abs(together - method.rows[:, :7]).max(axis=0) == pytest.approx(0.0, abs=1e-9 * scale.max())


def test_by_covariance_the_sources_are_those_of_the_scenario_run_apart() -> None:
    """Each source errs on one axis, so that its square is the same in both; noise by its mean over seeds."""
    ship = Ship(Scenario.parse(SCENARIO))
    damped = ship.scenario.method[1]
    by_covariance = contributions(ship, damped)
    apart = [
        sources._run_apart(one, damped, lambda _: None, lambda: False)
        for one in (
            ship.scenario.model_copy(update={"run": ship.scenario.run.model_copy(update={"seed": seed})})
            for seed in range(20)
        )
    ]
    assert set(by_covariance) == set(ALL) == set(apart[0])
    for name in ALL:
        tolerance = 0.5 if "noise" in name else 0.01
        mean = np.mean([squares[name] for squares in apart], axis=0)
        assert by_covariance[name][:7].sum() == pytest.approx(mean.sum(), rel=tolerance)
        for k in (0, 3):  # tilt and velocity of the east channel
            if mean[k] > 0.02 * max(squares[k] for squares in apart[0].values()):
                assert by_covariance[name][k] == pytest.approx(mean[k], rel=tolerance)


@pytest.mark.parametrize("field", ["policy", "imu", "log"])
def test_what_the_budget_does_not_model_is_run_apart(field: str, tmp_path) -> None:
    log = tmp_path / "log.csv"
    log.write_text("t_s,speed_mps,speed_starboard_mps\n" + "".join(f"{t},0.3,0\n" for t in range(0, 400)))
    policy, imu, reference, expected = {
        "policy": ("threshold", {}, {"kind": "log", "bias_mps": [0.3, 0.0]}, "log bias"),
        "imu": ("constant", {"gyro_lsb": [1e-3] * 3}, {"kind": "log"}, "IMU quantisation"),
        "log": ("constant", {}, {"kind": "file", "file": str(log), "frame": "body"}, "recorded log"),
    }[field]
    method = {"damping": "external", "network": {"id": "classic2"}, "policy": {"id": policy}}
    data = {"imu": imu, "reference": reference, "method": [method]}
    scenario = Scenario.parse({"run": {"duration_h": 0.1}} | data)
    assert active_sources(scenario) == (expected,)
    squares = contributions(Ship(scenario), scenario.method[0])
    errors = simulate(scenario).methods[0].errors
    np.testing.assert_allclose(np.sqrt(squares[expected]), [errors[name]["rms"] for name in NAMES[:7]])


def test_cancel_leaves_out_what_has_not_run() -> None:
    scenario = load("liu-switching", ["run.duration_h=0.5"])
    (method,) = [one for one in scenario.method if one.policy.id != "constant"][:1]
    asked: list[float] = []
    squares = contributions(Ship(scenario), method, asked.append, lambda: bool(asked))
    assert len(squares) == len(asked) == 1 < len(active_sources(scenario))
