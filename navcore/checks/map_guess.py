"""The guess of a map: what the columns of a table seem to mean, to be shown, edited and written as TOML."""

from __future__ import annotations

import math
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.inputs import opened
from navcore.foundation.visible import visible
from navcore.io.column_names import CLOCK, DATE, QUANTITIES, SECONDS, UNIX, UTC, known_columns
from navcore.io.columns import MOST_CELLS, MOST_COLUMNS
from navcore.io.containers.base import MOST_UNPACKED_BYTES, Container
from navcore.io.containers.opening import is_container, open_container
from navcore.io.decimal_signs import decimal_of
from navcore.io.imu_columns import AXES, DIMENSIONS, imu_columns
from navcore.io.imu_table import imu_layout, is_imu_names, is_imu_table
from navcore.io.recording import NO_TABLE, takes_map
from navcore.io.rows import split_line
from navcore.io.source import read_text, require_file
from navcore.io.table_layout import layout

MOST_ROWS = 3
"""Rows that are shown."""
MOST_SAMPLES = 120
"""Numbers of a column, evenly through the file, that its plot shows."""
_FEWEST_COLUMNS = 2
_MOST_SHOWN = 60
"""Columns of a file that holds many."""
_HEAD_BYTES = 64
_IMU_NAMES = {"rate": "g{}_rad_s", "force": "f{}_mps2", "angle": "da{}_rad", "velocity": "dv{}_mps"}
IMU_QUANTITIES = {name.format(axis): DIMENSIONS[kind] for kind, name in _IMU_NAMES.items() for axis in AXES}
"""Dimension by the name that a map gives a quantity of an IMU."""
_TIME_FORMS = tuple(
    f"{date}{between}%H:%M:%S{fraction}"
    for date in ("%d.%m.%Y", "%Y/%m/%d", "%d/%m/%Y", "%m/%d/%Y", "%d-%m-%Y")
    for between in (" ", ",")
    for fraction in ("", ".%f")
)


class Preview(NamedTuple):
    """Look of a table before it is read.

    Attributes
    ----------
    header : tuple of str
        Names of the columns.
    rows : tuple of tuple of str
        Cells of the first rows.
    samples : tuple of tuple of float
        By column, numbers evenly through the file; NaN where a cell is none.
    separator : str
        Between the cells.
    """

    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    samples: tuple[tuple[float, ...], ...]
    separator: str

    @property
    def is_table(self) -> bool:
        """Whether there are columns, and numbers in one of them, so that a map may say what they mean."""
        return len(self.header) >= _FEWEST_COLUMNS and any(
            math.isfinite(number) for column in self.samples for number in column
        )

    def cells(self, *columns: str) -> list[str]:
        """First cells of a column; of several, joined by a space."""
        places = [self.header.index(column) for column in columns if column in self.header]
        return [" ".join(row[i] for i in places) for row in self.rows if len(row) == len(self.header)]


def preview(text: str) -> Preview:
    """Header, first rows and a sample of the numbers of a text table."""
    if text.count("\n") > MOST_CELLS // _FEWEST_COLUMNS:
        return Preview((), (), (), "")
    separator, line, header = imu_layout(text) if is_imu_table(text) else layout(text)
    if len(header) > MOST_COLUMNS:
        return Preview((), (), (), "")
    names = tuple(name.strip() for name in header)
    body = text[text.find(line) + len(line) :].splitlines()[1:] if line else []
    every = max(1, len(body) // MOST_SAMPLES)
    rows = [_cells(row, separator) for row in body[:MOST_ROWS]]
    sampled = [_cells(row, separator) for row in body[::every][:MOST_SAMPLES]]
    samples = (tuple(_number(row, i, separator) for row in sampled) for i in range(len(names)))
    return Preview(names, tuple(rows), tuple(samples), separator)


def preview_of(path: Path) -> Preview | None:
    """Preview of a table that a map may describe; None for all other files; raises `InputError`."""
    if not takes_map(path):
        return None
    with opened(path) as stream:
        packed = is_container(stream.read(_HEAD_BYTES), path)
    found = _of_container(open_container(path)) if packed else preview(read_text(path).text)
    return found if found.is_table else None


def _of_container(held: Container) -> Preview:
    """Preview of a Parquet, MAT or npz file."""
    parts = list(held.parts.values())[:_MOST_SHOWN]
    numbers = [place for place, part in enumerate(parts) if part.is_number]
    texts = [place for place, part in enumerate(parts) if not part.is_number and part.is_time]
    if len(numbers) + len(texts) < _FEWEST_COLUMNS:
        return Preview((), (), (), "")
    most = MOST_UNPACKED_BYTES // 8 if is_imu_names(held.names) else MOST_CELLS
    read = held.fetch(numbers, texts, most_cells=most)
    cells = [
        [str(value) for value in read[place][0][:MOST_ROWS]] if place in read else []
        for place in range(len(parts))
    ]
    rows = zip(*(column if len(column) == MOST_ROWS else [""] * MOST_ROWS for column in cells), strict=True)
    samples = (_evenly(read[place][0]) if place in numbers else () for place in range(len(parts)))
    return Preview(tuple(held.names[:_MOST_SHOWN]), tuple(rows), tuple(samples), "")


def _evenly(values: np.ndarray) -> tuple[float, ...]:
    return tuple(values[:: max(1, values.size // MOST_SAMPLES)][:MOST_SAMPLES].astype(float).tolist())


def _cells(row: str, separator: str) -> tuple[str, ...]:
    return tuple(cell.strip() for cell in split_line(row, separator))


def _number(row: tuple[str, ...], index: int, separator: str) -> float:
    try:
        return float(row[index] if separator == "," else row[index].replace(",", "."))
    except (ValueError, IndexError):
        return math.nan


def guess(table: Preview) -> dict[str, Any]:
    """Data of a map of a table (see `navcore.io.column_map`); what is not known is left out of it."""
    imu = is_imu_names(table.header)
    columns = {name: table.cells(name) for name in table.header}
    return {
        "time": _time(table),
        "decimal": decimal_of(columns),
        **({"delimiter": table.separator} if table.separator else {}),
        "skip_bad_rows": False,
        "quantity": {
            name: {"column": column, "unit": unit, "sign": 1}
            for name, column, unit in _quantities(list(table.header), imu)
        },
    }


def _quantities(header: list[str], imu: bool) -> Iterator[tuple[str, str, str]]:
    """Name, column and unit of each quantity."""
    if imu:
        for column in imu_columns(header).values():
            yield _IMU_NAMES[column.kind].format(column.axis), column.name, column.unit
        return
    for stem, column in known_columns(header).items():
        if stem in QUANTITIES:
            yield stem, column.name, column.unit


def _time(table: Preview) -> dict[str, Any]:
    """Where the time stands."""
    known = known_columns(table.header)
    pair = [known[stem].name for stem in (DATE, CLOCK) if stem in known]
    if len(pair) == 2:
        return {"column": pair, "unit": _form(table.cells(*pair))}
    stem = next((stem for stem in (UTC, UNIX, SECONDS) if stem in known), "")
    if not stem:
        return {"column": "", "unit": ""}
    column = known[stem]
    return {
        "column": column.name,
        "unit": column.unit or ("s" if stem == SECONDS else _form(table.cells(column.name))),
    }


def _form(cells: list[str]) -> str:
    """``iso`` or the format of the cells; empty where none or several would do."""
    fitting = time_forms(cells)
    return fitting[0] if len(fitting) == 1 else ""


def time_forms(cells: list[str]) -> list[str]:
    """Forms in which all these cells are times: ``iso``, formats of `datetime.strptime`."""

    def fits(form: str) -> bool:
        try:
            for cell in cells:
                _ = datetime.fromisoformat(cell) if form == "iso" else datetime.strptime(cell, form)
        except ValueError:
            return False
        return bool(cells) and not all(cell.isdigit() for cell in cells)

    return [form for form in ("iso", *_TIME_FORMS) if fits(form)]


def as_toml(data: dict[str, Any], table: Preview, name: str) -> str:
    """Text of a map, with the columns of the file and their first cells as comments."""
    words = [
        f"# Map of {visible(name)}: what its columns mean. Names, units and signs may be changed.",
        "# Columns:",
    ]
    words += [
        f"#   {_quoted(column)}: {visible(', '.join(row[i] for row in table.rows if i < len(row)))[:80]}"
        for i, column in enumerate(table.header)
    ]
    time = data["time"]
    if not time["column"]:
        words.append("# No column of time is known by its name.")
    columns = time["column"]
    column = _quoted(columns) if isinstance(columns, str) else f"[{', '.join(map(_quoted, columns))}]"
    given = "".join(f", {key} = {_quoted(time[key])}" for key in ("unit", "zone") if time.get(key))
    words += [
        f"time = {{ column = {column}{given} }}",
        f"decimal = {_quoted(data['decimal'])}",
        *([f"delimiter = {_quoted(data['delimiter'])}"] if data.get("delimiter") else []),
        f"skip_bad_rows = {str(data['skip_bad_rows']).lower()}",
    ]
    for quantity, entry in data["quantity"].items():
        unit = f"unit = {_quoted(entry['unit'])}" if entry["unit"] else '# unit = ""'
        words += ["", f"[quantity.{quantity}]", f"column = {_quoted(entry['column'])}", unit]
        words += [f"sign = {entry['sign']}"]
    return "\n".join(words) + "\n"


def guessed_map(file: str) -> str:
    """Return the guess of a map for a table, as TOML.

    Raises
    ------
    InputError
        The file cannot be read or is no table.
    """
    path = require_file(file)
    table = preview_of(path)
    if table is None:
        raise InputError(Fault(path.name, "", None, NO_TABLE))
    return as_toml(guess(table), table, path.name)


def _quoted(text: str) -> str:
    """Text as a basic string of TOML."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\t", "\\t")
    return '"' + "".join(c if c.isprintable() else f"\\u{ord(c):04x}" for c in escaped) + '"'
