"""CSV tables: comma or semicolon, a header line, columns named with their unit (see `columns`).

The standard library's reader and numpy are enough, name the row of a bad cell, and start faster than pandas.
"""

from __future__ import annotations

import csv
import io
from pathlib import Path

from navcore.errors import Fault, InputError
from navcore.io.columns import known_columns, numbers, require_columns, table_recording, utc_seconds
from navcore.io.series import Recording
from navcore.io.source import read_text

_MOST_FAULTS = 10


def _header(text: str) -> str:
    return next((line for line in text[:65536].splitlines() if line.strip() and not line.startswith("#")), "")


def _delimiter(header: str) -> str:
    return ";" if header.count(";") > header.count(",") else ","


def looks_like_csv(text: str) -> bool:
    """Whether the first line that is no comment names a known column."""
    header = _header(text)
    return bool(known_columns([cell.strip().strip('"') for cell in header.split(_delimiter(header))]))


def read_csv(path: Path) -> Recording:
    """Read one table.

    Raises
    ------
    InputError
        Missing columns, rows of another length, cells that are no finite number in range, time out of order.
    """
    text = read_text(path)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=_delimiter(_header(text)), strict=True)
    header: list[str] | None = None
    rows: list[int] = []
    cells: list[list[str]] = []
    faults: list[Fault] = []
    try:
        for row in reader:
            if not any(cell.strip() for cell in row) or row[0].startswith("#"):
                continue
            if header is None:
                header = row
            elif len(row) != len(header):
                allowed = f"has {len(row)} cells, the header {len(header)}"
                faults.append(Fault(f"{path.name}, row {reader.line_num}", "", None, allowed))
            else:
                rows.append(reader.line_num)
                cells.append(row)
    except csv.Error as problem:
        faults.append(Fault(f"{path.name}, row {reader.line_num}", "", None, f"not a CSV row ({problem})"))
    if faults:
        more = [Fault(path.name, "", None, f"and {len(faults) - _MOST_FAULTS} more such rows")]
        raise InputError(faults[:_MOST_FAULTS] + (more if len(faults) > _MOST_FAULTS else []))
    return _recording(path, header or [], rows, cells)


def _recording(path: Path, header: list[str], rows: list[int], cells: list[list[str]]) -> Recording:
    found = require_columns(path.name, header)
    if not rows:
        raise InputError(Fault(path.name, "", None, "a header but no rows"))
    columns = {}
    faults: list[Fault] = []
    for name, index in found.items():
        column = [row[index] for row in cells]
        try:
            if name == "utc":
                columns[name] = utc_seconds(path.name, column, rows)
            elif not (name == "t_s" and "utc" in found):
                columns[name] = numbers(path.name, name, column, rows)
        except InputError as error:
            faults += error.faults
    if faults:
        raise InputError(faults)
    return table_recording(path.name, "CSV table", columns, rows, unused_columns(header, found))


def unused_columns(header: list[str], found: dict[str, int]) -> list[str]:
    """Warn of columns that are not used, in case one is a misspelt name."""
    unused = [name.strip() for index, name in enumerate(header) if index not in found.values()]
    return [f"columns not used: {', '.join(unused)}"] if unused else []
