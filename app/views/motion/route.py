"""Route of a motion that is a list, legs or points: a table of them, and one at a time to be edited."""

from navcore.foundation.notation import with_unit
from navcore.foundation.registry import blocks_of
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.editing import edits, form
from schuler_bench.editing.form import FieldSpec, Path
from schuler_bench.plots.table import cell, row, table
from schuler_bench.plots.units import rounded

WORDS = {"leg": Text("leg"), "point": Text("point")}
_TIME = "t_s"
_LATER_S = 600.0
_MOST_ROWS = 200


def list_of(scenario: Scenario) -> str:
    """Name of the list in a scenario's motion, such as ``leg``; empty where it has none."""
    lists = [name for fields in blocks_of(type(scenario.motion)).values() for name, many in fields if many]
    return next((name for name in lists if name in WORDS), "")


def count_of(scenario: Scenario) -> int:
    """Blocks of the list."""
    return len(getattr(scenario.motion, list_of(scenario) or "", ()))


def fields_of(scenario: Scenario, place: int) -> list[FieldSpec]:
    """Controls of one block of the list."""
    name = list_of(scenario)
    if not name or not 0 <= place < count_of(scenario):
        return []
    block = type(getattr(scenario.motion, name)[place])
    label = Text("{what} {number}", what=WORDS[name], number=place + 1)
    return form.fields(block, ("motion", name, place), prefix=label)


def with_one_more(scenario: Scenario, place: int) -> Scenario:
    """Return a scenario with a block like the one at a place behind it; a point half-way to the next.

    Raises
    ------
    InputError
        The motion does not allow it.
    """
    name = list_of(scenario)
    given = scenario.canonical()["motion"][name]
    block = dict(given[place])
    if _TIME in block:
        following = given[place + 1][_TIME] if place + 1 < len(given) else block[_TIME] + 2.0 * _LATER_S
        block[_TIME] = 0.5 * (block[_TIME] + following)
    return edits.with_list(scenario, _path(scenario), [*given[: place + 1], block, *given[place + 1 :]])


def without_one(scenario: Scenario, place: int) -> Scenario:
    """Return a scenario without the block at a place; raises `InputError`."""
    given = scenario.canonical()["motion"][list_of(scenario)]
    return edits.with_list(scenario, _path(scenario), [*given[:place], *given[place + 1 :]])


def _path(scenario: Scenario) -> Path:
    return "motion", list_of(scenario)


def route_html(scenario: Scenario, selected: int) -> str:
    """Table of all blocks, with the fields that one of them gives; the one that is edited stands out."""
    name = list_of(scenario)
    if not name:
        return ""
    blocks = getattr(scenario.motion, name)
    specs = [
        spec
        for spec in form.fields(type(blocks[0]), ("motion", name, 0))
        if any(getattr(block, str(spec.path[-1])) is not None for block in blocks)
    ]
    head = row([cell(WORDS[name], tag="th"), *(cell(spec.label, "sb-m", tag="th") for spec in specs)])
    body = [
        row(
            [
                cell(Text("<b>{number}</b>", number=place + 1) if place == selected else str(place + 1)),
                *(cell(_number(getattr(block, str(spec.path[-1]))), "sb-n") for spec in specs),
            ]
        )
        for place, block in enumerate(blocks[:_MOST_ROWS])
    ]
    return table([head], body)


def _number(value: object) -> str:
    return rounded(value) if isinstance(value, float) else "" if value is None else with_unit(str(value), "")
