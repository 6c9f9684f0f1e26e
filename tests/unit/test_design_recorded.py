"""Recordings in budget and floor: a recorded log errs as it is fitted, or there is no floor."""

import pytest

from navcore.design.budget import budget
from navcore.design.ship import Ship
from navcore.fitting.recorded import fit_of, reference_of
from navcore.scenario.file import load
from navcore.scenario.model import Scenario


@pytest.fixture(scope="module")
def recorded() -> Scenario:
    return load("sikuliaq-recorded")


@pytest.mark.parametrize("steady", [True, False])
def test_the_budget_of_a_recording_is_that_of_its_fitted_log(recorded: Scenario, steady: bool) -> None:
    fitted = recorded.model_copy(update={"reference": reference_of(fit_of(recorded).fit)})
    found, like = budget(recorded, steady), budget(fitted, steady)
    assert found.floor.rms.velocity_mps == pytest.approx(like.floor.rms.velocity_mps, rel=1e-9)
    for own, other in zip(found.methods, like.methods, strict=True):
        assert own.total == other.total
    loops = found.methods[1:]
    assert loops and all((method.sources["log_drift"].rms.velocity_mps or 0.0) > 0.0 for method in loops)


def test_nothing_is_thousands_of_times_a_floor_of_an_errorless_log(recorded: Scenario) -> None:
    found = budget(recorded, steady=True)
    assert found.floor.rms.velocity_mps is not None and found.floor.rms.velocity_mps > 1e-3
    times = [value for method in found.methods for value in found.times_floor(method).values() if value]
    assert times and max(times) < 100.0


def test_a_recorded_log_that_cannot_be_fitted_has_no_floor(recorded: Scenario) -> None:
    at_sea = load("sikuliaq-like").motion
    alone = recorded.model_copy(update={"motion": at_sea})
    for steady in (True, False):
        found = budget(alone, steady)
        assert found.floor.rms.tilt_rad is None and found.document()["floor"]["tilt_rad"] is None
        assert "nothing says how the recorded log errs" in found.floor_reason
        assert all(value is None for method in found.methods for value in found.times_floor(method).values())
    assert Ship(alone).floor_series is None


def test_a_ship_keeps_the_scenario_that_was_given(recorded: Scenario) -> None:
    ship = Ship(recorded)
    assert ship.given is recorded and ship.scenario.reference.kind == "log"
    assert ship.scenario.reference.event == recorded.reference.event
