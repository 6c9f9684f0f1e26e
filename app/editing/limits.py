"""Limits of a scenario as the page's boxes give them, each in the unit in which its quantity is shown."""

from typing import Any

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.numbers import NotANumber
from navcore.foundation.text import Text
from navcore.quantities import LIMITED, QUANTITIES, limit_unit
from navcore.scenario.model import Scenario
from navcore.scenario.requirement import OF_THE_SETTING, Requirement
from schuler_bench.editing.typed import read_typed, unit_of
from schuler_bench.plots.limits import SIGNS

BOXES = (*OF_THE_SETTING, *(key for key in LIMITED if key not in OF_THE_SETTING))
"""Quantities with a box, in order."""
FROM = Text("errors count from (h)")


def label_of(key: str) -> str:
    """Label of a limit's box: what, sense and unit, e.g. ``settling ≤ (min)``."""
    row = QUANTITIES[key]
    unit = Text(" ({shown})", shown=row.shown) if row.shown else ""
    return Text("{label} {signs}{unit}", label=row.label, signs=SIGNS[row.sense], unit=unit)


def shown_limit(one: Requirement) -> float:
    """Limit in the unit in which its quantity is shown."""
    return one.limit_si / QUANTITIES[one.quantity].size


def limit_text(scenario: Scenario, key: str) -> str:
    """Text of a quantity's box; empty where there is no limit."""
    first = next((one for one in scenario.requirement if one.quantity == key), None)
    return "" if first is None else f"{shown_limit(first):.6g}"


def from_text(scenario: Scenario) -> str:
    """Text of the box for the time from which errors count; empty where the limits differ in it."""
    begins = {one.from_h for one in scenario.requirement if one.quantity not in OF_THE_SETTING}
    return f"{begins.pop():.6g}" if len(begins) == 1 else ""


def with_limit(scenario: Scenario, key: str, text: str) -> Scenario:
    """Scenario with a limit as typed; without any of this quantity for an empty text.

    Raises
    ------
    InputError
        Not a number, or outside what is allowed.
    """
    kept = [one for one in scenario.requirement if one.quantity != key]
    if not text.strip():
        return scenario.model_copy(update={"requirement": tuple(kept)})
    value = _number(label_of(key), text) * QUANTITIES[key].size / limit_unit(key)
    named = "at_least" if QUANTITIES[key].sense == ">=" else "at_most"
    begins = from_text(scenario) if key not in OF_THE_SETTING else ""
    made = {"quantity": key, named: float(f"{value:.12g}"), "from_h": float(begins or 0.0)}
    blocks: list[Any] = [one.model_dump(exclude_none=True) for one in scenario.requirement]
    first = next((k for k, one in enumerate(blocks) if one["quantity"] == key), None)
    if first is None:
        blocks.append(made)
    else:
        blocks[first] = made | {"from_h": blocks[first]["from_h"]}
    return _parsed(scenario, blocks, label_of(key), text)


def with_begin(scenario: Scenario, text: str) -> Scenario:
    """Scenario whose limits on errors count from this time on, h; from the start for an empty text.

    Raises
    ------
    InputError
        Not a number, or outside what is allowed.
    """
    begin = _number(FROM, text) if text.strip() else 0.0
    if not 0.0 <= begin <= scenario.run.duration_h:
        allowed = Text("must be >= 0 and <= {end:g} (h), the end of the run", end=scenario.run.duration_h)
        raise InputError(Fault("", FROM, text, allowed))
    blocks = [
        one.model_dump(exclude_none=True) | ({} if one.quantity in OF_THE_SETTING else {"from_h": begin})
        for one in scenario.requirement
    ]
    return _parsed(scenario, blocks, FROM, text)


def _number(label: str, text: str) -> float:
    """Number in a box, in the unit of its label, or with a unit of its own."""
    try:
        return read_typed(text, unit_of(label))
    except NotANumber as error:
        allowed = Text("{allowed}; leave it empty for no requirement", allowed=error.allowed)
        raise InputError(Fault("", label, text, allowed)) from None


def _parsed(scenario: Scenario, blocks: list[Any], label: str, text: str) -> Scenario:
    """Scenario with these blocks; a fault names the box."""
    data = {key: value for key, value in scenario.canonical().items() if key != "requirement"}
    try:
        return Scenario.parse(data | {"requirement": blocks})
    except InputError as error:
        raise InputError(Fault("", label, text, fault.allowed) for fault in error.faults) from None
