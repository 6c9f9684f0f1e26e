"""Kinds of damping: each holds what the other rooms take from it, and none of them asks its name."""

import ast
from pathlib import Path

import numpy as np
import pytest

from navcore.damping import KINDS
from navcore.design.bands import covariance_bands
from navcore.design.budget import budget
from navcore.engine.load import estimated_bytes, estimated_seconds
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.law.records import CHANNELS, MAX_STATES, U
from navcore.networks import parse_network
from navcore.scenario.file import to_toml
from navcore.scenario.model import Scenario
from schuler_bench.cli.check_scenario import check_scenario
from tests.unit.test_architecture import modules

pytestmark = pytest.mark.contract

LOG = {"kind": "log", "rate_hz": 1.0, "noise_mps": 0.1}
IMU = {"gyro_bias_dph": [0.01, 0.01, 0.01], "gyro_arw_dpsh": 0.001}
MOVING = {"kind": "legs", "leg": [{"speed_mps": 5.0, "duration_s": 600.0}]}
UNMET = {
    "reference": {"reference": {"kind": "none"}},
    "log": {"reference": {"kind": "none"}},
    "coupled channels": {"run": {"fidelity": "channel"}},
    "simulated IMU": {"imu": {"file": "imu.csv"}, "run": {"fidelity": "strapdown"}},
    "standing start": {"motion": MOVING},
}
"""A scenario for each condition in which it is not met."""
each_kind = pytest.mark.parametrize("name", KINDS)


def method_of(name: str) -> dict[str, object]:
    return {"damping": name, "network": {"id": "complementary" if KINDS[name].uses_network else "none"}}


def scenario_of(name: str, **blocks: object) -> Scenario:
    return Scenario.parse({"reference": LOG, "imu": IMU, "method": [method_of(name)]} | blocks)


@each_kind
@pytest.mark.parametrize("fidelity", ["error_model", "strapdown"])
def test_every_kind_runs_and_is_described(name: str, fidelity: str, tmp_path: Path) -> None:
    run_settings = {"fidelity": fidelity, "duration_h": 0.1, "rate_hz": 10.0}
    scenario = scenario_of(name, run=run_settings)
    method = simulate(scenario).methods[0]
    assert method.status == "ok" and not any("not used" in text for text in method.warnings)
    assert np.all(np.isfinite(method.rows)) and np.ptp(method.rows[:, 0]) > 0.0
    assert bool(method.law_in_force.damped_share) == KINDS[name].uses_network
    assert scenario.method[0].name == KINDS[name].label(scenario.method[0])
    file = tmp_path / "scenario.toml"
    file.write_text(to_toml(scenario))
    assert KINDS[name].description(scenario.method[0]) in check_scenario(file).text[-1]
    assert estimated_seconds(scenario) > 0.0 and estimated_bytes(scenario) > 0.0


@each_kind
def test_every_kind_has_a_budget_a_band_or_the_reason(name: str) -> None:
    kind, scenario = KINDS[name], scenario_of(name, run={"duration_h": 0.5})
    along = budget(scenario, seeds=2).methods[0]
    assert along.shown == ("seeds" if kind.covering == "seeds" else "covariance")
    assert along.total.rms.tilt_rad
    steady = budget(scenario, steady=True).methods[0]
    assert (steady.shown == "steady") == (kind.covering != "seeds")
    bands = covariance_bands(scenario)
    assert bands is not None
    band = bands.methods[0]
    assert (band.sigma is None) == bool(band.reason)
    assert band.kind == {"covariance": "covariance", "seeds": "none", "filter": "filter"}[kind.covering]


@each_kind
def test_what_a_kind_needs_is_refused_and_what_it_ignores_is_said(name: str) -> None:
    spare = scenario_of(name, method=[{"damping": name, "network": {"id": "classic2"}}])
    warned = any("not used" in text for text in simulate(spare).methods[0].warnings)
    assert warned == (not KINDS[name].uses_network)
    for need in KINDS[name].needs:
        with pytest.raises(InputError) as refused:
            scenario_of(name, **UNMET[need.of])
        assert need.because in str(refused.value)


@each_kind
def test_the_loop_is_that_of_what_acts(name: str) -> None:
    """No network: H = 1. Without a reference there is no velocity feedback, so the network form counts."""
    kind, compass = KINDS[name], parse_network('id = "compass"').transfer(1.24e-3)
    acting = kind.acting(compass)
    assert (acting.order == 0) == (not kind.uses_network)
    assert acting.realisation == ("feedback" if kind.referenced else "network")
    assert kind.acting(compass) is acting, "kept, so that what is analysed of it is kept too"


def test_the_law_has_room_for_an_azimuth_channel() -> None:
    from navcore.law.law import LAW_HISTORY, LAW_PARAMETERS, LAW_STATE

    assert CHANNELS == U + 1 == 3
    assert "azimuth_order" in (LAW_PARAMETERS.names or ())
    for record in (LAW_STATE, LAW_HISTORY):
        assert record["x"].shape == (CHANNELS, MAX_STATES) and record["difference"].shape == (CHANNELS,)
    assert LAW_STATE["azimuth"] == LAW_STATE["network"] and LAW_STATE["correction"].shape == (CHANNELS,)


def test_no_code_but_the_kinds_compares_a_kind_with_a_name() -> None:
    found = [
        f"{module}:{node.lineno}"
        for package in ("navcore", "schuler_bench", "tools")
        for module, tree in modules(package).items()
        if not module.startswith("navcore.damping")
        for node in ast.walk(tree)
        if isinstance(node, (ast.Compare, ast.MatchValue)) and names_in(node) & set(KINDS)
    ]
    assert found == []


def names_in(node: ast.AST) -> set[str]:
    return {at.value for at in ast.walk(node) if isinstance(at, ast.Constant) and isinstance(at.value, str)}


def test_the_price_of_internal_whole_damping_is_told_with_its_number() -> None:
    """5 m/s at 45 deg give 0.1015 deg/h with unity2: 0.0287 deg/h at the equator for 1 m/s."""
    method = {
        "damping": "internal",
        "network": {"id": "complementary"},
        "azimuth": {"id": "unity2", "zeta": 0.5},
    }
    [notice] = [
        text
        for text in simulate(Scenario.parse({"run": {"duration_h": 0.1}, "method": [method]}))
        .methods[0]
        .warnings
        if text.startswith("internal azimuth network")
    ]
    assert "Y'(0) = 12179 s: 0.0287 °/h times cos L for each m/s" in notice
    assert 0.0287 * 5.0 * np.sqrt(0.5) == pytest.approx(0.1015, abs=2e-4)
