"""Door "My ship, my limits": sensors by name and a few limits are all that a search for designs needs."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text, quoted
from navcore.scenario.model import Scenario
from navcore.sensors.data_sheets import data_sheets
from schuler_bench.editing.edits import with_value
from schuler_bench.editing.limits import label_of, with_limit
from schuler_bench.plots.table import cell

SEND = "my-ship"
"""Command that the form sends, with what was entered as JSON."""
TITLE = Text("My ship, my limits")
AS_NOW = Text("as on the page now")
_BLOCKS = {"imu": Text("gyros and accelerometers"), "reference": Text("log")}
LIMITS = {"tilt_max_arcsec": "20", "velocity_max_mps": "0.3", "position_max_m": ""}
"""Limits that the form asks for, and what stands there before."""
_METHODS: tuple[dict[str, Any], ...] = tuple(
    {"name": id, "damping": "external", "network": {"id": id}}
    for id in ("classic2", "classic3", "complementary")
)


def form_html() -> str:
    """Form with a sensor, a log, and limits; start.js sends it."""
    told = Text(
        "The ship stands at 45° for 24 h. Every network is tuned for these limits, and run on 200 seeds. "
        "All of it can be changed afterwards."
    )
    find = Text("Find designs")
    return Text(
        '<form class="sb-ship" data-send="{send}"><p>{told}</p>{fields}'
        '<button class="sb-do" type="submit">{find}</button></form>',
        send=SEND,
        told=told,
        fields=Text.joined("", _fields()),
        find=find,
    )


def _fields() -> Iterator[str]:
    for block, label in _BLOCKS.items():
        sheets = [sheet for sheet in data_sheets().values() if sheet.block == block]
        options: list[str] = [Text('<option value="">{as_now}</option>', as_now=AS_NOW)]
        options += [
            cell(
                quoted(Text("{name} ({grade})", name=one.name, grade=one.grade)), tag="option", value=one.name
            )
            for one in sheets
        ]
        yield Text(
            '<label>{label}<select name="{block}">{options}</select></label>',
            label=label,
            block=block,
            options=Text.joined("", options),
        )
    for key, value in LIMITS.items():
        yield Text(
            '<label>{label:html}<input name="{key}" value="{value}" inputmode="decimal" '
            'autocomplete="off"></label>',
            label=label_of(key),
            key=key,
            value=value,
        )


def scenario_for(text: str, present: Scenario) -> Scenario:
    """Scenario of a ship at rest with what was entered.

    Parameters
    ----------
    text : str
        JSON from the page: names of parts by block, limits as typed by quantity.
    present : Scenario
        Gives sensors and log that are kept as they are.

    Raises
    ------
    InputError
        A part is not in the list, a limit is no number or out of its range, or there is none.
    """
    entered = _read(text)
    data: dict[str, Any] = {
        "schema": 1,
        "title": TITLE,
        "run": {"duration_h": 24.0},
        "site": {"lat_deg": 45.0},
        "method": [*_METHODS],
    }
    now = present.canonical()
    data |= {block: now[block] for block in _BLOCKS if not now.get(block, {}).get("file")}
    if data.get("reference", {}).get("kind", "none") == "none":
        data["reference"] = {"kind": "log"}
    scenario = Scenario.parse(data)
    for block in _BLOCKS:
        if part := entered.get(block, ""):
            scenario = with_value(scenario, (block, "part"), part)
    for key in LIMITS:
        scenario = with_limit(scenario, key, entered.get(key, ""))
    if not scenario.requirement:
        raise InputError(Fault("", TITLE, "", Text("needs at least one limit")))
    return scenario


def _read(text: str) -> dict[str, str]:
    try:
        found = json.loads(text)
    except ValueError:
        found = None
    if not isinstance(found, dict):
        return {}
    return {str(key): value for key, value in found.items() if isinstance(value, str)}
