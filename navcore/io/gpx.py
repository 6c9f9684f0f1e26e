"""GPX tracks: the points of a receiver with their times; speed and course where a point has them."""

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.io.cells import numbers, times
from navcore.io.columns import MOST_CELLS, require_columns, table_recording
from navcore.io.formats import Candidate
from navcore.io.series import Recording
from navcore.io.source import read_text
from navcore.io.table_times import Table

_ROOT = re.compile(r"<(?:\w{1,20}:)?gpx[\s>]")
_HEAD_CHARACTERS = 4096
_COLUMNS = {
    "time": "utc",
    "lat": "lat_deg",
    "lon": "lon_deg",
    "ele": "height_m",
    "speed": "sog_mps",
    "course": "cog_deg",
}
"""Names in GPX and ours; speed and course are those of GPX 1.0 and of extensions."""
_NEEDED = ("time", "lat", "lon")


def recognises(candidate: Candidate) -> bool:
    """Whether the text begins as a GPX document."""
    return _ROOT.search(candidate.text[:_HEAD_CHARACTERS]) is not None


def read(path: Path) -> Recording:
    """Read the points of all tracks of a GPX file, in its order.

    Raises
    ------
    InputError
        No well-formed XML, an entity of its own, no point with a time, or a value as `navcore.io.csv.read`
        refuses it; "row" is the number of the point.
    """
    content = read_text(path)
    where = path.name
    points = _points(where, content.text)
    timed = [number for number, point in enumerate(points) if point.get("time")]
    if not timed:
        raise InputError(Fault(where, "", None, Text("has no track point with a time")))
    held = [name for name in _COLUMNS if any(name in points[number] for number in timed)]
    if "speed" not in held or "course" not in held:
        held = [name for name in held if name not in ("speed", "course")]
    cells = {name: [points[number].get(name, "") for number in timed] for name in held}
    rows = [number + 1 for number in timed]
    columns = require_columns(where, [_COLUMNS[name] for name in held])
    time_s, dated = times(where, "time", cells["time"], rows)
    values: dict[str, np.ndarray] = {}
    missing: dict[str, np.ndarray] = {}
    for stem, column in columns.items():
        name = held[column.index]
        if name == "time":
            continue
        values[stem], empty = numbers(where, name, cells[name], rows)
        if empty.any():
            missing[stem] = empty
    warnings = (*content.warnings(), *_left_out(len(points) - len(timed)))
    return table_recording(
        Table(
            where,
            "GPX track",
            columns,
            time_s,
            dated,
            "time",
            values,
            missing,
            rows,
            warnings,
            units_stated=True,
        )
    )


def _points(where: str, text: str) -> list[dict[str, str]]:
    """Values of each track point, by the names of `_COLUMNS`."""
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        allowed = Text("defines entities of its own, which a GPX file has no need of")
        raise InputError(Fault(where, "", None, allowed))
    parser = ElementTree.XMLPullParser(("end",))
    found: list[dict[str, str]] = []
    try:
        parser.feed(text)
        events: Any = parser.read_events()  # typed for all kinds of events
        for _, element in events:
            if _name(element) == "trkpt":
                found.append(_point(element))
                element.clear()
            if len(found) * len(_NEEDED) > MOST_CELLS:
                allowed = Text("has more than {most} points", most=MOST_CELLS // len(_NEEDED))
                raise InputError(Fault(where, "", None, allowed))
        parser.close()
    except ElementTree.ParseError as problem:
        raise InputError(
            Fault(where, "", None, Text("is no well-formed XML ({problem})", problem=problem))
        ) from None
    return found


def _point(element: ElementTree.Element) -> dict[str, str]:
    inside = {_name(part): (part.text or "").strip() for part in element.iter() if part is not element}
    point = {name: text for name, text in inside.items() if name in _COLUMNS and text}
    return point | {name: value for name in ("lat", "lon") if (value := element.get(name))}


def _name(element: ElementTree.Element) -> str:
    """Name of an element without its namespace."""
    return element.tag.rpartition("}")[2]


def _left_out(untimed: int) -> list[str]:
    if not untimed:
        return []
    return [
        Text.plural(
            "{count} point without a time left out", "{count} points without a time left out", count=untimed
        )
    ]
