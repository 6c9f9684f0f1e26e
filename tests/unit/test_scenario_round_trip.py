"""Any scenario the models allow survives being written and read (same hash), or is refused in words."""

from typing import Any

from hypothesis import HealthCheck, assume, given, settings

from navcore.foundation.errors import InputError
from navcore.scenario.file import parse_toml, scenario_hash, to_toml
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
