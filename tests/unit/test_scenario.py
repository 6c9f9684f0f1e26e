"""The scenario: defaults, faults by name, overrides, one hash for one scenario, TOML out and in."""

import tomllib
from typing import Any

import pytest
from hypothesis import HealthCheck, assume, given, settings

from navcore.foundation.errors import InputError
from navcore.scenario.file import apply_overrides, load, parse_toml, presets, scenario_hash, to_toml
from navcore.scenario.frozen import frozen
from navcore.scenario.model import Scenario
from tests.random_models import raw_scenarios

CONTRACT_EXAMPLE = """
schema = 1
title  = "..."
source = "Liu 2021, fig. 4"
[run]
fidelity = "error_model"
duration_h = 10.0
step_s = 1.0
rate_hz = 100.0
output_step_s = 10.0
seed = 1
earth = "wgs84"
[site]
lat_deg = 32.06
lon_deg = 118.8
height_m = 0.0
[motion]
kind = "static"
pitch_deg = 0.0
roll_deg = 0.0
heading_deg = 0.0
[imu]
gyro_bias_dph = [0.0, 0.02, 0.0]
gyro_arw_dpsh = 0.0
accel_bias_ug = [50.0, 50.0, 0.0]
accel_vrw_ugpshz = 0.0
[alignment]
kind = "none"
duration_s = 600.0
[initial_error]
attitude_arcmin = [0.0, 0.0, 0.0]
velocity_mps = [0.0, 0.0]
position_arcsec = [0.0, 0.0]
[reference]
kind = "log"
frame = "enu"
bias_mps = [0.0, 0.0]
noise_mps = 0.0
rate_hz = 1.0
[[method]]
name = "compass"
damping = "external"
network = { id = "compass", sigma = 0.0088, xi = 0.7 }
policy = { id = "constant" }
switching = { id = "hard" }
"""


def _faults(data: dict) -> list[str]:
    with pytest.raises(InputError) as caught:
        Scenario.parse(data, "x.toml")
    return [str(fault) for fault in caught.value.faults]


def test_the_contracts_example_is_a_scenario():
    scenario = Scenario.parse(tomllib.loads(CONTRACT_EXAMPLE))
    assert scenario.steps == 36000
    assert scenario.method[0].name == "compass"


def test_defaults_are_one_free_method_and_no_errors():
    scenario = Scenario.parse({})
    assert [(m.name, m.damping) for m in scenario.method] == [("free", "free")]
    assert scenario.imu.gyro_bias_dph == (0.0, 0.0, 0.0)
    assert scenario.initial_error.state() == [0.0] * 7
    assert scenario.reference.kind == "none"


@pytest.mark.parametrize(
    ("data", "line"),
    [
        ({"run": {"duration_h": -1}}, "x.toml: run.duration_h = -1: must be > 0 and <= 8760 (h)"),
        ({"run": {"duration_h": 1e-9}}, "x.toml: run.duration_h = 1e-09: must hold at least one step of 1 s"),
        ({"site": {"lat_deg": 95}}, "x.toml: site.lat_deg = 95: must be >= -89 and <= 89 (°)"),
        (
            {"initial_error": {"attitude_arcmin": [0, 1e9, 0]}},
            "x.toml: initial_error.attitude_arcmin.1 = 1000000000.0: must be >= -600 and <= 600 (arcmin)",
        ),
        (
            {"method": [{"name": "a"}, {"name": "a"}]},
            "x.toml: method.1.name = 'a': must differ from the name of method.0",
        ),
        (
            {"method": [{"damping": "external"}]},
            "x.toml: method.0.damping = 'external': needs a reference velocity: "
            'reference.kind must not be "none"',
        ),
        (
            {
                "method": [
                    {"damping": "internal", "network": {"id": "classic2"}, "policy": {"id": "threshold"}}
                ]
            },
            "x.toml: method.0.policy.id = 'threshold': needs a reference velocity: "
            'reference.kind must not be "none"',
        ),
        ({"run": {"step_s": True}}, "x.toml: run.step_s = True: must be a number, >= 0.005 and <= 10 (s)"),
        (
            {"imu": {"gyro_bias_dph": [0, "0.7", 0]}},
            "x.toml: imu.gyro_bias_dph.1 = '0.7': must be a number (write 0.7 without quotation marks), "
            ">= -100000 and <= 100000 (°/h)",
        ),
        ({"method": []}, "x.toml: method = 0: must be 1 to 12 blocks [[method]]"),
    ],
)
def test_each_fault_names_field_value_and_range(data, line):
    assert _faults(data) == [line]


def test_every_fault_is_told_at_once():
    lines = _faults({"run": {"duration_h": -1, "fidelity": "magic"}, "site": {"lat_deg": 95}})
    assert len(lines) == 3


@pytest.mark.parametrize("steps_h", [1e6, 8760])
def test_a_scenario_too_long_to_run_is_refused_with_the_reason(steps_h):
    lines = _faults({"run": {"duration_h": steps_h, "step_s": 0.005}})
    assert "run.duration_h" in lines[0]


def test_overrides_set_single_fields_and_restart_a_block_of_another_kind():
    data = tomllib.loads(CONTRACT_EXAMPLE)
    apply_overrides(data, ["method.0.network.xi=0.5", "method.0.network.sigma = 0.01", "run.earth=sphere"])
    scenario = Scenario.parse(data)
    network = scenario.method[0].network.model_dump()
    assert (network["sigma"], network["xi"], scenario.run.earth) == (0.01, 0.5, "sphere")
    apply_overrides(data, ["method.0.network.id=complementary"])
    assert Scenario.parse(data).method[0].network.model_dump() == {
        "id": "complementary",
        "zeta": 0.5,
        "eta": 0.5,
    }


@pytest.mark.parametrize(
    ("override", "said"),
    [("nothing", "KEY=VALUE"), ("method.7.name=x", "from 0 to 0"), ("run.seed.x=1", "single value")],
)
def test_an_override_that_leads_nowhere_is_told(override, said):
    data = tomllib.loads(CONTRACT_EXAMPLE)
    data["run"]["seed"] = 1
    with pytest.raises(InputError, match=said):
        apply_overrides(data, [override])


def test_resolved_toml_reads_back_to_the_same_scenario_and_hash():
    assert presets()
    for name in presets():
        scenario = load(name)
        again = Scenario.parse(parse_toml(to_toml(scenario), name))
        assert again == scenario
        assert scenario_hash(again) == scenario_hash(scenario)
        assert scenario_hash(load(name, [f"run.seed={scenario.run.seed + 1}"])) != scenario_hash(scenario)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"title = ", "is not valid TOML"),
        (b"\xff\xfe\x00", "is not UTF-8"),
        (b"schema = 7", "schema = 7: must be 1"),
    ],
)
def test_a_broken_file_is_one_clear_line(tmp_path, content, said):
    path = tmp_path / "s.toml"
    path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        load(str(path))
    assert len(caught.value.faults) == 1 and said in str(caught.value) and "\n" not in str(caught.value)


def test_an_unknown_preset_is_answered_with_the_nearest():
    with pytest.raises(InputError, match="neither a preset nor a file"):
        load("liu-overshot")


# ---------------------------------------------------------------- any scenario


_CHECKS = [HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large]


def parsed(data: dict[str, Any]) -> Scenario | None:
    """The scenario, or None when it is refused; then every fault must be one telling line."""
    try:
        return Scenario.parse(data)
    except InputError as error:
        assert error.faults
        for fault in error.faults:
            assert fault.allowed, fault
            assert fault.field, fault
            assert "\n" not in str(fault)
        return None


@given(data=raw_scenarios())
@settings(max_examples=150, suppress_health_check=_CHECKS)
def test_written_and_read_again_it_is_the_same(data):
    scenario = parsed(data)
    assume(scenario is not None)
    assert scenario is not None
    again = Scenario.parse(parse_toml(to_toml(scenario), "text"))
    assert again == frozen(scenario)
    assert again.canonical() == frozen(scenario).canonical()
    assert scenario_hash(again) == scenario_hash(scenario)
    assert to_toml(again) == to_toml(scenario)


def test_an_override_makes_a_list_of_blocks_and_its_next_one() -> None:
    """`navcore.designs` names it in its example; a method is not made by a mistyped number."""
    limits = ["requirement.0.quantity=velocity_rms_mps", "requirement.0.at_most=0.5"]
    limits += ["requirement.1.quantity=settling_s", "requirement.1.at_most=60"]
    asked = load("zha-fast", limits).requirement
    assert [(one.quantity, one.limit) for one in asked] == [("velocity_rms_mps", 0.5), ("settling_s", 60.0)]
    with pytest.raises(InputError, match='"2" must be a number from 0 to 0'):
        load("zha-fast", [*limits[:2], "requirement.2.at_most=3"])
    with pytest.raises(InputError, match='"3" must be a number from 0 to 2'):
        load("zha-fast", ["method.3.damping=free"])
