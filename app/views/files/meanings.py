"""Meanings that a column of an uploaded table may have, and how a choice changes the data of a map."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from navcore.foundation.text import Text
from navcore.io.column_map import GPS_WEEK
from navcore.io.column_names import QUANTITIES
from navcore.io.written_units import UNITS

if TYPE_CHECKING:
    from navcore.checks.map_guess import Preview

UNUSED, TIME, TIME_REST = "", "time", "time_rest"
_IMU = {
    "g": Text("rate"),
    "f": Text("force"),
    "da": Text("angle increment"),
    "dv": Text("velocity increment"),
}
MEANINGS: dict[str, str] = {
    UNUSED: Text("not used"),
    TIME: Text("time"),
    TIME_REST: Text("time, second part"),
    "lat": Text("latitude"),
    "lon": Text("longitude"),
    "height": Text("height"),
    "heading": Text("heading"),
    "pitch": Text("pitch"),
    "roll": Text("roll"),
    "ve": Text("velocity east"),
    "vn": Text("velocity north"),
    "speed": Text("speed through water"),
    "speed_starboard": Text("speed through water, to starboard"),
    "ground": Text("speed over ground, forward"),
    "ground_starboard": Text("speed over ground, to starboard"),
    "sog": Text("speed over ground"),
    "cog": Text("course over ground"),
    **{
        f"{first}{axis}_{unit}": Text("{kind} {axis}", kind=kind, axis=axis)
        for (first, kind), unit in zip(_IMU.items(), ("rad_s", "mps2", "rad", "mps"), strict=True)
        for axis in "xyz"
    },
}
"""Words by what a map calls a quantity; the first three are no quantities."""
_UNIT_SIGNS = {
    "mps": "m/s", "kmh": "km/h", "cms": "cm/s", "mms": "mm/s", "fps": "ft/s", "nm": "nmi", "us": "µs",
    "mps2": "m/s²", "fps2": "ft/s²", "ug": "µg", "rad_s": "rad/s", "mrad_s": "mrad/s", "deg_s": "°/s",
    "mdeg_s": "m°/s", "deg_h": "°/h", "urad": "µrad", "e7": "1e-7 °", "cdeg": "0.01 °", "deg": "°",
}  # fmt: skip
"""Units of a map as a reader writes them."""
_DIMENSIONS = {"rad_s": "rate", "mps2": "force", "rad": "angle", "mps": "speed"}
GUESSED = Text("as guessed")
_LETTERS = {"%d": "DD", "%m": "MM", "%Y": "YYYY", "%H": "hh", "%M": "mm", "%S": "ss", ".%f": ".f"}


def meaning_of(data: Mapping[str, Any], column: str) -> str:
    """Key of `MEANINGS` of a column."""
    clocks = columns_of_time(data)
    if column in clocks:
        return TIME if column == clocks[0] else TIME_REST
    return next((name for name, entry in data["quantity"].items() if entry["column"] == column), UNUSED)


def columns_of_time(data: Mapping[str, Any]) -> list[str]:
    """Names of the columns of time, in their order."""
    column = data["time"]["column"]
    return [column] if isinstance(column, str) else list(column)


def units_for(data: Mapping[str, Any], table: Preview, column: str) -> dict[str, str]:
    """Words by unit that a column's meaning leaves to choose; of times the forms that fit the cells."""
    from navcore.checks.map_guess import time_forms

    name = meaning_of(data, column)
    if name == UNUSED:
        return {"": "-"}
    if name in (TIME, TIME_REST):
        forms = {form: shown(form) for form in time_forms(table.cells(*columns_of_time(data)))}
        counts = (*UNITS["time"], GPS_WEEK)
        return {"": GUESSED, **forms, **{unit: unit.replace("_", " ") for unit in counts}}
    dimension = QUANTITIES[name].dimension if name in QUANTITIES else _DIMENSIONS[name.split("_", 1)[1]]
    return {unit: shown(unit) for unit in ("", *UNITS[dimension])} | {"": GUESSED}


def unit_of(data: Mapping[str, Any], column: str) -> str:
    """Unit of a column; empty where it is guessed."""
    name = meaning_of(data, column)
    entry = data["time"] if name in (TIME, TIME_REST) else data["quantity"].get(name, {})
    return entry.get("unit", "")


def with_meaning(data: Mapping[str, Any], column: str, name: str) -> dict[str, Any]:
    """Data in which a column means something else; no other column means the same."""
    found: dict[str, Any] = copy.deepcopy(dict(data))
    clocks = [clock for clock in columns_of_time(data) if clock and clock != column]
    found["quantity"] = {
        quantity: entry
        for quantity, entry in found["quantity"].items()
        if entry["column"] != column and quantity != name
    }
    if name == TIME:
        found["time"] |= {"column": column, "unit": ""}
    elif name == TIME_REST:
        found["time"] |= {"column": [*clocks[:1], column], "unit": ""}
    else:
        found["time"]["column"] = clocks if len(clocks) > 1 else "".join(clocks)
        if name != UNUSED:
            found["quantity"][name] = {"column": column, "unit": "", "sign": 1}
    return found


def with_choice(data: Mapping[str, Any], column: str, key: str, value: Any) -> dict[str, Any]:
    """Data in which the ``unit`` or ``sign`` of a column's quantity, or of its time, is another."""
    found: dict[str, Any] = copy.deepcopy(dict(data))
    name = meaning_of(data, column)
    entry = found["time"] if name in (TIME, TIME_REST) else found["quantity"].get(name)
    if entry is not None and not (key == "sign" and entry is found["time"]):
        entry[key] = value
    return found


def asks_for_the_order(data: Mapping[str, Any], table: Preview) -> str:
    """Column whose dates may begin with the day or with the month, and nobody said which; else empty."""
    from navcore.checks.map_guess import time_forms

    clocks = columns_of_time(data)
    forms = time_forms(table.cells(*clocks)) if clocks[0] and not data["time"]["unit"] else []
    return clocks[0] if len({form[:8] for form in forms}) > 1 else ""


def shown(form: str) -> str:
    """``%d.%m.%Y`` as DD.MM.YYYY, ``mps`` as m/s."""
    if form in _UNIT_SIGNS:
        return _UNIT_SIGNS[form]
    for sign, letters in _LETTERS.items():
        form = form.replace(sign, letters)
    return "ISO 8601" if form == "iso" else form
