"""The ships of the scenario guide: short scenarios that run in both fidelities, and stand in the guide."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from navcore.design.budget import budget
from navcore.engine.simulation import simulate
from navcore.mechanization.recorder import DAMPED_COLUMN
from navcore.scenario.file import read_toml
from navcore.scenario.guide import SHIPS
from navcore.scenario.model import Scenario

MOST_LINES = 40
HOURS = {"ferry": 2.5, "submarine": 1.0, "survey": 0.6}
"""Shortened runs."""


@pytest.fixture
def given(repo_root: Path, request: pytest.FixtureRequest) -> dict[str, Any]:
    return read_toml(repo_root / "examples" / f"{request.param}.toml", request.param)


ships = pytest.mark.parametrize("given", SHIPS, indirect=True)


def of(given: dict[str, Any], **run: Any) -> Scenario:
    return Scenario.parse(given | {"run": given["run"] | run})


@pytest.mark.parametrize("ship", SHIPS)
def test_the_scenario_is_short_and_stands_in_the_guide(repo_root: Path, ship: str):
    text = (repo_root / "examples" / f"{ship}.toml").read_text("utf-8")
    assert len(text.splitlines()) <= MOST_LINES
    assert text.strip() in (repo_root / "docs" / "scenario.md").read_text("utf-8")


@ships
def test_it_is_a_scenario_of_its_whole_length(given: dict[str, Any]):
    scenario = of(given)
    motion: Any = scenario.motion
    length = sum(leg.duration_s for leg in motion.leg[motion.repeat_from :])
    rounds = sum(leg.duration_s for leg in motion.leg) + (motion.repeat - 1) * length
    assert rounds >= 3600.0 * scenario.run.duration_h


@ships
def test_both_fidelities_agree(given: dict[str, Any], request: pytest.FixtureRequest):
    hours = HOURS[request.node.callspec.params["given"]]
    quiet = given | {"imu": {k: v for k, v in given["imu"].items() if k != "gyro_arw_dpsh"}}
    dives = any(leg.get("depth_m") for leg in given["motion"]["leg"])
    deep = {"vertical": "altimeter"} if dives else {}
    full = of(quiet, fidelity="strapdown", duration_h=hours, rate_hz=20.0, output_step_s=10.0, **deep)
    linear = of(quiet, fidelity="error_model", duration_h=hours, step_s=0.5, output_step_s=10.0)
    runs = [simulate(scenario).methods[0] for scenario in (linear, full)]
    assert [run.status for run in runs] == ["ok", "ok"]
    one, other = (run.rows[:, :5] for run in runs)
    assert (np.abs(one - other).max(axis=0) < 0.1 * np.abs(one).max(axis=0)).all()


@pytest.mark.parametrize("given", ["ferry", "submarine"], indirect=True)
def test_its_log_fails_in_part(given: dict[str, Any]):
    damped = simulate(of(given)).methods[0].rows[:, DAMPED_COLUMN]
    assert 0.5 < damped.mean() < 0.999
    assert np.count_nonzero(np.diff(damped)) >= 14


@ships
def test_it_has_a_budget(given: dict[str, Any]):
    found = budget(of(given, fidelity="error_model", duration_h=1.0), seeds=2).methods[0]
    assert found.total is not None
    assert (found.total.rms.velocity_mps or 0.0) > 0.0
