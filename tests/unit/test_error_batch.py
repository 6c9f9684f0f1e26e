"""Runs of the error model side by side are the single runs, bit for bit."""

from typing import Any

import pytest

from navcore.engine.ensemble import batch_outcomes, linear_outcomes, outcomes
from navcore.law.policy import POLICIES
from navcore.law.switching import SWITCHINGS
from navcore.mechanization.error_batch import WIDTH
from navcore.scenario.model import Scenario

SHIP: dict[str, Any] = {
    "run": {"duration_h": 3.0, "output_step_s": 600.0},
    "motion": {
        "kind": "legs",
        "leg": [
            {"duration_s": 2400.0, "speed_kn": 12.0, "heading_deg": 40.0},
            {"duration_s": 60.0, "turn_dps": 1.5},
            {"duration_s": 9000.0},
        ],
    },
    "imu": {"gyro_arw_dpsh": 0.003, "gyro_instability_dph": 0.01, "accel_vrw_ugpshz": 20.0},
    "reference": {
        "kind": "log", "frame": "body", "noise_mps": 0.1, "drift_mps": 0.1, "lsb_mps": 0.05,
        "outage": [{"t_h": 1.0, "duration_s": 900.0}],
    },
    "requirement": [
        {"quantity": "tilt_max_arcsec", "at_most": 20.0},
        {"quantity": "velocity_rms_mps", "at_most": 1.0, "from_h": 1.5},
    ],
}  # fmt: skip
COMPLEMENTARY, COMPASS = {"id": "complementary"}, {"id": "compass", "sigma": 0.002, "xi": 0.7}
METHODS: dict[str, dict[str, Any]] = {
    "free": {"damping": "free"},
    "internal": {"damping": "internal", "network": {"id": "classic2"}},
    "external": {"network": COMPLEMENTARY},
    "feedback": {"network": COMPASS},
    "optimal": {"network": {"id": "optimal"}},
    "whole": {"network": COMPLEMENTARY, "azimuth": {"id": "unity2", "zeta": 0.5}},
    "gyrocompass": {"network": COMPASS, "gyrocompass": {"sigma": 0.002, "xi": 0.7}},
    "output corrected": {
        "network": COMPLEMENTARY,
        "policy": {"id": "variation"},
        "switching": {"id": "bridge", "output": "corrected"},
    },
    **{
        f"{policy} and {switching}": {
            "network": COMPASS if policy in ("schedule", "mobility") else {"id": "unity2", "zeta": 0.5},
            "policy": {"id": policy},
            "switching": {"id": switching},
        }
        for policy, switching in [*((p, "hard") for p in POLICIES), *(("variation", s) for s in SWITCHINGS)]
    },
}


def seeded(method: dict[str, Any], count: int, **blocks: Any) -> list[Scenario]:
    one = Scenario.parse({**SHIP, **blocks, "method": [{"damping": "external", "name": "m", **method}]})
    return [
        one.model_copy(update={"run": one.run.model_copy(update={"seed": seed})}) for seed in range(count)
    ]


@pytest.mark.parametrize("name", METHODS)
def test_a_run_beside_others_is_the_run_alone(name: str) -> None:
    some = seeded(METHODS[name], 3)
    found = batch_outcomes(some, lambda _: False)
    assert found == [linear_outcomes(one, {}) for one in some]
    assert len(found[0][0].spans) == 2
    assert found[0] != found[1]


@pytest.mark.parametrize("fidelity", ["error_model", "channel"])
def test_at_rest_and_in_one_channel_what_does_not_change_stands_once(fidelity: str) -> None:
    still = {"motion": {"kind": "static"}, "imu": {}, "run": SHIP["run"] | {"fidelity": fidelity}}
    some = seeded(METHODS["external"], WIDTH, **still)
    assert batch_outcomes(some, lambda _: False) == [linear_outcomes(one, {}) for one in some]


def test_a_run_that_diverges_leaves_its_neighbours_as_they_are() -> None:
    some = seeded({"network": {"id": "compass", "sigma": 1.0, "xi": 0.7}}, 2)
    calm = seeded(METHODS["external"], 3)
    wild = calm[1].model_copy(
        update={"imu": calm[1].imu.model_copy(update={"gyro_bias_dph": (2e5, 0.0, 0.0)})}
    )
    assert [each[0].ended for each in batch_outcomes(some, lambda _: False)] == [False, False]
    found = batch_outcomes([calm[0], wild, calm[2]], lambda _: False)
    assert [each[0].ended for each in found] == [True, False, True]
    assert found == [linear_outcomes(one, {}) for one in (calm[0], wild, calm[2])]


def test_more_runs_than_lanes_come_in_their_order_and_a_filter_stands_among_them() -> None:
    (one,) = seeded(METHODS["external"], 1)
    methods = (one.method[0], Scenario.parse({**SHIP, "method": [{"damping": "kalman"}]}).method[0])
    together = outcomes(one, methods, range(WIDTH + 3))
    assert len(together) == WIDTH + 3
    alone = outcomes(one, methods, [3, 4])
    assert [each[0] for each in together[3:5]] == [each[0] for each in alone]
    # the gains of a filter are those of the first seed
    for ours, theirs in zip(together[3:5], alone, strict=True):
        assert ours[1].final_m == pytest.approx(theirs[1].final_m, rel=1e-6)
    said: list[float] = []
    stopped = outcomes(one, methods, range(40), said.append, lambda: len(said) > 4)
    assert 0 < len(stopped) < 40 and stopped == outcomes(one, methods, range(len(stopped)))
