"""Limits of a scenario as the page's boxes give them, each in the unit in which its quantity is shown."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from pydantic import ValidationError

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.numbers import NotANumber, read_number
from navcore.foundation.text import Text
from navcore.foundation.units import UNITS
from navcore.foundation.with_unit import read_with_unit
from navcore.quantities import LIMITED, QUANTITIES, limit_unit
from navcore.scenario.model import Scenario
from navcore.scenario.requirement import AT_AN_HOUR, OF_THE_SETTING, Requirement
from schuler_bench.editing.typed import unit_of
from schuler_bench.plots.limits import SIGNS

BOXES = (*OF_THE_SETTING, *(key for key in LIMITED if key not in OF_THE_SETTING))
"""Quantities with a box, in order."""
FROM = Text("errors count from (h)")


def label_of(key: str) -> str:
    """Label of a limit's box: what, sense and unit, e.g. ``settling ≤ (min)``."""
    row = QUANTITIES[key]
    shown = row.limit_shown
    unit = Text(" ({shown})", shown=shown) if shown else ""
    return Text("{label} {signs}{unit}", label=row.label, signs=SIGNS[row.sense], unit=unit)


def shown_limit(one: Requirement) -> float:
    """Limit in the unit in which it is shown."""
    return one.limit_si / UNITS[QUANTITIES[one.quantity].limit_shown]


def box_text(one: Requirement) -> str:
    """Text of a limit's box: as it was typed where it has a unit of its own."""
    return one.at_most if isinstance(one.at_most, str) else f"{shown_limit(one):.6g}"


def limit_text(scenario: Scenario, key: str) -> str:
    """Text of a quantity's box; empty where there is no limit."""
    first = _first(scenario, key)
    return "" if first is None else box_text(first)


def _first(scenario: Scenario, key: str) -> Requirement | None:
    return next((one for one in scenario.requirement if one.quantity == key), None)


@dataclass(frozen=True)
class Detail:
    """A further box of a limit.

    Attributes
    ----------
    label : str
        With its unit.
    text : callable
        Gives the box's text of a requirement.
    read : callable
        Gives the value of the field for a text that is not empty.
    allowed : callable
        Says whether the limit of a quantity, by its key, has this box.
    """

    label: str
    text: Callable[[Requirement], str]
    read: Callable[[str], float | str]
    allowed: Callable[[str], bool] = lambda key: True


DETAILS = {
    "share": Detail(
        Text("share of seeds (%)"),
        lambda one: "" if one.share is None else f"{100.0 * one.share:.6g}",
        lambda text: float(f"{read_with_unit(text, '%') / 100.0:.12g}"),
    ),
    "at_h": Detail(
        Text("at (h)"),
        lambda one: "" if one.at_h is None else f"{one.at_h:.6g}",
        lambda text: read_with_unit(text, "h"),
        lambda key: key in AT_AN_HOUR,
    ),
    "clause": Detail(Text("clause"), lambda one: one.clause or "", str),
}
"""Further boxes of a limit, by the field of its block."""


def detail_label(key: str, field: str) -> str:
    """Label of a further box of a quantity's limit."""
    return Text("{label}: {detail}", label=QUANTITIES[key].label, detail=DETAILS[field].label)


def detail_text(scenario: Scenario, key: str, field: str) -> str:
    """Text of a further box of a quantity's limit."""
    first = _first(scenario, key)
    return "" if first is None else DETAILS[field].text(first)


def with_detail(scenario: Scenario, key: str, field: str, text: str) -> Scenario:
    """Scenario with the share, hour or clause of a quantity's limit as typed; without it for an empty text.

    Raises
    ------
    InputError
        There is no limit, or the text is no number or outside what is allowed.
    """
    label, first = detail_label(key, field), _first(scenario, key)
    if first is None:
        raise InputError(Fault("", label, text, Text("needs a limit of the same quantity")))
    try:
        value = DETAILS[field].read(text.strip()) if text.strip() else None
    except NotANumber as error:
        raise InputError(Fault("", label, text, error.allowed)) from None
    blocks: list[Any] = [one.model_dump(exclude_none=True) for one in scenario.requirement]
    place = scenario.requirement.index(first)
    blocks[place] = {name: held for name, held in blocks[place].items() if name != field}
    blocks[place] |= {} if value is None else {field: value}
    return _parsed(scenario, blocks, label, text)


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
    named = "at_least" if QUANTITIES[key].sense == ">=" else "at_most"
    begins = from_text(scenario) if key not in OF_THE_SETTING else ""
    blocks: list[Any] = [one.model_dump(exclude_none=True) for one in scenario.requirement]
    first = next((k for k, one in enumerate(blocks) if one["quantity"] == key), None)
    made = {"quantity": key, named: _given(key, named, text)}
    if first is None:
        blocks.append(made | {"from_h": float(begins or 0.0)})
    else:
        blocks[first] |= made
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


def _given(key: str, named: str, text: str) -> float | str:
    """Limit of a block as typed: with a unit of its own as it is, else in the unit of a number."""
    try:
        read_number(text)
    except NotANumber:
        if named == "at_most":
            try:
                Requirement.model_validate({"quantity": key, named: text.strip()})
            except ValidationError:
                pass
            else:
                return text.strip()
    value = _number(label_of(key), text) * UNITS[QUANTITIES[key].limit_shown] / limit_unit(key)
    return float(f"{value:.12g}")


def _number(label: str, text: str) -> float:
    """Number in a box, in the unit of its label, or with a unit of its own."""
    try:
        return read_with_unit(text, unit_of(label))
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
