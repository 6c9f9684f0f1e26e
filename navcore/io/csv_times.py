"""Times of the rows of a text table: one column, a date beside a clock, week and seconds, or parts."""

import re
from collections.abc import Sequence

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.io.cells import is_empty, numbers, times
from navcore.io.column_map import GPS_WEEK, ColumnMap, TimeMap
from navcore.io.column_names import (
    CLOCK,
    DATE,
    SECONDS,
    UNIX,
    UTC,
    Column,
)
from navcore.io.epochs import numeric_times
from navcore.io.mapped_times import MappedClock
from navcore.io.rows import Rows
from navcore.io.times.counts import GPS_EPOCH_S, gps_to_unix
from navcore.io.times.parts import times_of_parts

_WEEK_AND_SECONDS = re.compile(r"\d{1,4}(?:\.0{0,9})? {1,9}\d{1,6}(?:\.\d{0,9})?")


def clock_column(columns: dict[str, Column]) -> Column:
    """Column that holds the time of a row."""
    return next(columns[stem] for stem in (CLOCK, UTC, UNIX, SECONDS) if stem in columns)


def timed(rows: Rows) -> tuple[list[int], int]:
    """Rows whose time is not empty, and how many are not."""
    cells = rows.cells[clock_column(rows.columns).stem]
    kept = [index for index, cell in enumerate(cells) if not is_empty(cell)]
    return kept, len(cells) - len(kept)


def times_of_rows(
    where: str, rows: Rows, kept: list[int], column_map: ColumnMap | None
) -> tuple[np.ndarray, bool, str]:
    """Times, whether they are dated, and the name of their column."""
    column = clock_column(rows.columns)
    numbered = [rows.numbers[i] for i in kept]
    name = column.name.lower()
    cells = rows.numerals.pointed([rows.cells[column.stem][i] for i in kept])
    if column_map is not None and column_map.time.stated:
        clock = MappedClock(column_map.time)
        time_s, dated = clock.read(where, cells, numbered)
        rows.warnings += clock.warnings()
        return time_s, dated, name
    if rows.parts and cells:
        return _of_parts(where, rows, cells, numbered, name)
    if column.stem == UTC and cells and all(_WEEK_AND_SECONDS.fullmatch(cell.strip()) for cell in cells):
        weeks = MappedClock(TimeMap(column=name, unit=GPS_WEEK))
        time_s, dated = weeks.read(where, cells, numbered)
        rows.warnings += [Text("{name}: GPS weeks and seconds, leap seconds removed", name=column.name)]
        rows.warnings += weeks.warnings()
        return time_s, dated, name
    if column.stem == CLOCK and DATE in rows.columns:
        dates = rows.cells[DATE]
        cells = [f"{dates[i].strip()} {cell.strip()}" for i, cell in zip(kept, cells, strict=True)]
    parsed = _as_numbers(cells)
    if parsed is None and column.stem in (UTC, CLOCK) and not column.unit:
        time_s, dated = times(where, name, cells, numbered)
        if dated and "gpst" in name:
            rows.warnings.append(Text("column {name} is GPS time: leap seconds removed", name=column.name))
            time_s = gps_to_unix(time_s - GPS_EPOCH_S)
        return time_s, dated, name
    if parsed is None:
        parsed, _ = numbers(where, name, cells, numbered)
    time_s, dated, told = numeric_times(where, column, parsed)
    rows.warnings += told
    return time_s, dated, name


def _of_parts(
    where: str, rows: Rows, cells: Sequence[str], numbered: Sequence[int], name: str
) -> tuple[np.ndarray, bool, str]:
    """Times of which each part stands in a column of its own."""
    try:
        table = np.array([cell.split() for cell in cells], dtype=float)
        time_s = times_of_parts(dict(zip(rows.parts, table.T, strict=True)))
    except ValueError:
        time_s = np.full(len(cells), np.nan)
    bad = np.flatnonzero(np.isnan(time_s))
    if bad.size:
        allowed = Text("is no date and time by {parts}", parts=", ".join(rows.parts))
        at = Text("{where}, row {number}", where=where, number=numbered[int(bad[0])])
        raise InputError(Fault(at, name, cells[int(bad[0])], allowed))
    told = Text("the time is read from {parts}, taken as UTC", parts=", ".join(rows.parts))
    rows.warnings.append(told)
    return time_s, True, name


def _as_numbers(cells: Sequence[str]) -> np.ndarray | None:
    try:
        return np.array(cells, dtype=float)
    except ValueError:
        return None
