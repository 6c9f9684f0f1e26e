"""Any scenario the models allow survives being written and read (same hash), or is refused in words."""

from typing import Any

from hypothesis import HealthCheck, assume, given, settings

from navcore.foundation.errors import InputError
from navcore.scenario.file import load, parse_toml, scenario_hash, to_toml
from navcore.scenario.model import Scenario
from tests.random_models import raw_scenarios

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
    assert again == scenario
    assert again.canonical() == scenario.canonical()
    assert scenario_hash(again) == scenario_hash(scenario)
    assert to_toml(again) == to_toml(scenario)


@given(data=raw_scenarios())
@settings(max_examples=40, suppress_health_check=_CHECKS)
def test_through_a_file_and_load(tmp_path_factory, data):
    scenario = parsed(data)
    assume(scenario is not None)
    assert scenario is not None
    path = tmp_path_factory.mktemp("scenario") / "scenario.toml"
    path.write_text(to_toml(scenario), encoding="utf-8")
    assert scenario_hash(load(str(path))) == scenario_hash(scenario)
    seed = scenario.run.seed + 1 if scenario.run.seed < 1000 else 0
    other = load(str(path), [f"run.seed={seed}"])
    assert scenario_hash(other) != scenario_hash(scenario)


@given(data=raw_scenarios())
@settings(max_examples=60, suppress_health_check=_CHECKS)
def test_canonical_is_complete(data):
    """Resolving a scenario twice changes nothing: every default is written out, nothing is derived anew."""
    scenario = parsed(data)
    assume(scenario is not None)
    assert scenario is not None
    assert Scenario.parse(scenario.canonical()) == scenario
