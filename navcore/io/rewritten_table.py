"""A text table of an INS with other readings in it: the same columns, cells written as they came in."""

import csv
import io
import math
import re
from pathlib import Path

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.io.column_map import ColumnMap
from navcore.io.columns import understood
from navcore.io.csv import laid_out
from navcore.io.rewritten import Moved, wrapped, written_like
from navcore.io.rows import Rows, split_line
from navcore.io.table_times import Table

_SAME_S = 1e-3
_PLAIN = re.compile(r"\s*[+-]?\d+(?:\.\d*)?\s*")
_New = dict[str, tuple[float, float]]
"""By what a column holds: the number as it was read, in the column's unit, and the new one, SI."""
_TURNS = {"lon": 2.0 * math.pi, "heading": 2.0 * math.pi, "cog": 2.0 * math.pi}
"""Columns whose angles come round again."""


def rewritten_table(path: Path, moved: Moved, column_map: ColumnMap | None = None) -> str:
    """Return a text table with its readings moved.

    Rows before ``moved`` begins, and whatever is no row of numbers, stay as they are; rows behind its end
    are left out.

    Parameters
    ----------
    path : Path
        Of the table.
    moved : Moved
        By the table's own clock.
    column_map : ColumnMap, optional
        What its columns mean.

    Raises
    ------
    InputError
        The table cannot be read, or a cell that would have to be written anew is no plain number.
    """
    content, rows, table = laid_out(path, column_map)
    table = understood(table)
    at = moved.at(table.time_s)
    inside = (table.time_s >= moved.time_s[0]) & (table.time_s <= moved.time_s[-1] + _SAME_S)
    changed = {stem: values for stem, values in _changed(table, at).items() if stem in table.columns}
    lines: list[str | None] = list(content.text.split("\n"))
    for place in np.flatnonzero(table.time_s > moved.time_s[-1] + _SAME_S).tolist():
        lines[int(table.rows[place]) - 1] = None
    for place in np.flatnonzero(inside).tolist():
        number = int(table.rows[place])
        new = {
            stem: (float(table.values[stem][place]), float(values[place]))
            for stem, values in changed.items()
            if not (stem in table.missing and table.missing[stem][place])
        }
        lines[number - 1] = _line(path.name, lines[number - 1] or "", number, rows, table, new)
    return "\n".join(line for line in lines if line is not None)


def _changed(table: Table, at: Moved) -> dict[str, np.ndarray]:
    """Readings with what damping changes, SI, by what the columns hold."""
    held = {stem: values * table.columns[stem].factor for stem, values in table.values.items()}
    pitch = held.get("pitch", np.zeros(len(at.time_s)))
    changes = dict(zip(("pitch", "roll"), at.leaning(pitch), strict=True))
    changes |= {"lat": at.place[:, 0], "lon": at.place[:, 1], "heading": at.turn}
    changes |= {"ve": at.velocity[:, 0], "vn": at.velocity[:, 1]}
    found = {stem: held[stem] + change for stem, change in changes.items() if stem in held}
    if {"sog", "cog"} <= held.keys():
        east = held["sog"] * np.sin(held["cog"]) + at.velocity[:, 0]
        north = held["sog"] * np.cos(held["cog"]) + at.velocity[:, 1]
        found |= {"sog": np.hypot(east, north), "cog": np.arctan2(east, north)}
    for stem, turn in _TURNS.items():
        if stem in found:
            low = 0.0 if np.nanmin(held[stem], initial=0.0) >= 0.0 else -math.pi
            found[stem] = wrapped(found[stem], low, turn)
    return found


def _line(where: str, line: str, number: int, rows: Rows, table: Table, new: _New) -> str:
    """Return a row with new readings in its cells."""
    separator = rows.layout[0]
    cells = re.findall(r"\s*\S+", line) if separator == " " else split_line(line, separator)
    shift = len(cells) - len(rows.header) if separator == " " else 0
    clock = min((column.index for column in table.columns.values() if column.stem == "utc"), default=-1)
    for stem, (before, value) in new.items():
        column = table.columns[stem]
        place = column.index + (shift if shift > 0 and -1 < clock < column.index else 0)
        cell = cells[place]
        (pointed,) = rows.numerals.pointed([cell])
        if _PLAIN.fullmatch(pointed) is None:
            allowed = Text("cannot be written anew: only plain numbers can")
            at = Text("{where}, row {number}", where=where, number=number)
            raise InputError(Fault(at, column.name, cell.strip(), allowed))
        written = value / column.factor / rows.signs.get(stem, 1.0)
        if stem in ("lat", "lon") and float(pointed) * before < 0.0:
            written = -written  # a column of hemispheres beside it gives the sign
        text = written_like(pointed, written)
        cells[place] = text.replace(".", ",") if rows.numerals.decimal == "," else text
    if separator == " ":
        return "".join(cells)
    if '"' not in line:
        return separator.join(cells)
    stream = io.StringIO()
    csv.writer(stream, delimiter=separator, lineterminator="").writerow(cells)
    return stream.getvalue()
