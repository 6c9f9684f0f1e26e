"""The guess of a map, as TOML text to be edited: what the columns of a table seem to mean."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.io.column_names import CLOCK, DATE, QUANTITIES, SECONDS, UNIX, UTC, known_columns
from navcore.io.csv import layout
from navcore.io.formats import takes_map
from navcore.io.imu_columns import imu_columns
from navcore.io.imu_table import imu_layout, is_imu_table
from navcore.io.recording import NO_TABLE
from navcore.io.source import read_text, require_file

_MOST_ROWS = 3
_IMU_NAMES = {"rate": "g{}_rad_s", "force": "f{}_mps2", "angle": "da{}_rad", "velocity": "dv{}_mps"}
_TIME_FORMS = ("%d.%m.%Y %H:%M:%S", "%d.%m.%Y %H:%M:%S.%f", "%Y/%m/%d %H:%M:%S", "%Y/%m/%d %H:%M:%S.%f")


def write_map(file: str, target: str, map_file: str | None = None) -> None:
    """Write the guess of a map for a text table.

    Raises
    ------
    InputError
        The file cannot be read or is no text table, or the target cannot be written; nothing is half-written.
    """
    if map_file is not None:
        raise InputError(Fault("", "write_map", target, Text("cannot be given together with map")))
    path = require_file(file)
    if not takes_map(path):
        raise InputError(Fault(path.name, "write_map", target, NO_TABLE))
    text = guess(read_text(path).text, path.name)
    goal = Path(target)
    try:
        handle, name = tempfile.mkstemp(dir=goal.parent or ".", prefix=f".{goal.name}.")
        try:
            with os.fdopen(handle, "w", encoding="utf-8") as stream:
                stream.write(text)
            Path(name).chmod(0o644)
            Path(name).replace(goal)
        except OSError:
            Path(name).unlink(missing_ok=True)
            raise
    except OSError as problem:
        why = problem.strerror or type(problem).__name__
        raise InputError(Fault("", "write_map", target, Text("cannot be written ({why})", why=why))) from None


def guess(text: str, name: str) -> str:
    """Map of a table as TOML text; what is not known stands in it as a comment."""
    imu = is_imu_table(text)
    separator, line, header = imu_layout(text) if imu else layout(text)
    below = text[text.find(line) + len(line) :].splitlines()[1 : _MOST_ROWS + 1] if line else []
    rows = [[c.strip() for c in (row.split() if separator == " " else row.split(separator))] for row in below]
    comma = separator != "," and any("," in cell for row in rows for cell in row)
    words = [f"# Map of {name}: what its columns mean. Names, units and signs may be changed.", "# Columns:"]
    words += [
        f"#   {_quoted(column.strip())}: {', '.join(row[i] for row in rows if i < len(row))[:80]}"
        for i, column in enumerate(header)
    ]
    words += [
        _time(header, rows),
        f'decimal = "{"," if comma else "."}"',
        f"delimiter = {_quoted(separator)}",
    ]
    words += ["skip_bad_rows = false"]
    for quantity, column, unit in _quantities(header, imu):
        words += ["", f"[quantity.{quantity}]", f"column = {_quoted(column)}"]
        words += [f"unit = {_quoted(unit)}" if unit else '# unit = ""', "sign = 1"]
    return "\n".join(words) + "\n"


def _quantities(header: list[str], imu: bool) -> list[tuple[str, str, str]]:
    """Name, column and unit of each quantity."""
    if imu:
        found = imu_columns(header).values()
        return [(_IMU_NAMES[c.kind].format(c.axis), c.name, c.unit) for c in found]
    return [
        (stem, column.name, column.unit)
        for stem, column in known_columns(header).items()
        if stem in QUANTITIES
    ]


def _time(header: list[str], rows: list[list[str]]) -> str:
    """The line of the time."""
    known = known_columns(header)
    pair = [known[stem].name for stem in (DATE, CLOCK) if stem in known]
    stem = next((stem for stem in (UTC, UNIX, SECONDS) if stem in known), "")
    if len(pair) == 2:
        column = "[" + ", ".join(map(_quoted, pair)) + "]"
        cells = [
            " ".join(row[known[s].index] for s in (DATE, CLOCK)) for row in rows if len(row) == len(header)
        ]
    elif stem:
        column = _quoted(known[stem].name)
        cells = [row[known[stem].index] for row in rows if len(row) == len(header)]
    else:
        return '# No column of time is known by its name.\ntime = { column = "" }'
    unit = known[stem].unit if stem else ""
    unit = unit or ("s" if stem == SECONDS else _form(cells))
    given = f", unit = {_quoted(unit)}" if unit else ""
    return f"time = {{ column = {column}{given} }}"


def _form(cells: list[str]) -> str:
    """``iso`` or the format of the cells; empty where it is best left to the guess."""
    from datetime import datetime

    def fits(form: str) -> bool:
        try:
            for cell in cells:
                _ = datetime.fromisoformat(cell) if form == "iso" else datetime.strptime(cell, form)
        except ValueError:
            return False
        return bool(cells) and not all(cell.isdigit() for cell in cells)

    return next((form for form in ("iso", *_TIME_FORMS) if fits(form)), "")


def _quoted(text: str) -> str:
    """Text as a basic string of TOML."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\t", "\\t")
    return '"' + "".join(c if c.isprintable() else f"\\u{ord(c):04x}" for c in escaped) + '"'
