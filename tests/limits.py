"""Requirements for tests, by key and in the units in which the page shows them."""

from dataclasses import replace
from typing import Any

from navcore.engine.run import Run
from navcore.foundation.units import UNITS
from navcore.quantities import QUANTITIES, limit_unit
from navcore.scenario.file import scenario_hash
from navcore.scenario.requirement import Requirement


def limits(**shown: float) -> tuple[Requirement, ...]:
    """One block a quantity."""
    return tuple(_limit(key, value) for key, value in shown.items())


def _limit(key: str, value: float) -> Requirement:
    row = QUANTITIES[key]
    named = "at_least" if row.sense == ">=" else "at_most"
    si = value * UNITS[row.limit_shown]
    return Requirement.model_validate({"quantity": key, named: si / limit_unit(key)})


def under(run: Run, **shown: float) -> Run:
    """Give a run's scenario these requirements."""
    scenario = run.scenario.model_copy(update={"requirement": limits(**shown)})
    return replace(run, scenario=scenario, scenario_sha256=scenario_hash(scenario))


def require(bench: Any, **shown: float) -> None:
    """Give the scenario of a page these limits, without a click; wait until it shows who meets them."""
    session = bench.session
    session.change(session.scenario.model_copy(update={"requirement": limits(**shown)}), None)
    bench.catch_up()
