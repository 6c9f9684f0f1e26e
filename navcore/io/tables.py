"""Logs in Parquet, MAT and npz files with the same columns as a text table, by their names or by a map."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.io.cells import times
from navcore.io.column_map import ColumnMap
from navcore.io.column_names import CLOCK, DATE, QUANTITIES, SECONDS, UNIX, UTC, Column
from navcore.io.columns import column_warnings, pair_faults, require_columns, table_recording
from navcore.io.containers.base import LONGEST_TIME, Raw
from navcore.io.containers.opening import is_container, open_container
from navcore.io.dialects import dialect_words
from navcore.io.epochs import numeric_times
from navcore.io.formats import Candidate
from navcore.io.hemispheres import is_named
from navcore.io.mapped_times import MappedClock
from navcore.io.series import Recording
from navcore.io.table_times import Table
from navcore.io.times.counts import GPS_EPOCH_S, gps_to_unix, zero_of


def recognises(candidate: Candidate) -> bool:
    """Whether a file is a Parquet, MAT or npz file."""
    return is_container(candidate.head, candidate.path)


def read(path: Path, column_map: ColumnMap | None = None) -> Recording:
    """Read a Parquet, MAT or npz file; raises `InputError` as `navcore.io.csv.read` does."""
    held = open_container(path)
    if column_map is None:
        columns, signs, clocks = _needed(path.name, held.names), dict[str, float](), list[int]()
    else:
        found = column_map.log_columns(path.name, held.names)
        columns = {stem: column for stem, (column, _) in found.items()}
        signs = {stem: sign for stem, (_, sign) in found.items()}
        clocks = column_map.clocks(path.name, held.names)
        columns[UTC] = Column(clocks[0], column_map.time.columns[0], UTC)
        if pairs := pair_faults(path.name, columns):
            raise InputError(pairs)
    places = {stem: column.index for stem, column in columns.items() if stem in QUANTITIES}
    clock = next(columns[stem] for stem in (UTC, UNIX, SECONDS) if stem in columns)
    raw = held.fetch(list(places.values()), clocks or [clock.index])
    size = rows_of(path.name, raw)
    rows, notes = np.arange(1, size + 1), list[str]()
    if column_map is None or not column_map.time.zero:
        notes += held.notes_of(clocks or [clock.index])
    if column_map is not None and column_map.time.stated:
        time_s, dated = mapped_times(path.name, [raw[index][0] for index in clocks], column_map, notes)
    else:
        time_s, dated = _timing(path.name, clock, raw[clock.index][0], rows, notes)
    values = {stem: raw[place][0].astype(float) * signs.get(stem, 1.0) for stem, place in places.items()}
    missing = {stem: raw[place][1] for stem, place in places.items() if raw[place][1].any()}
    told = dialect_words(held.names) if column_map is None else []
    warnings = (*told, *column_warnings(held.names, columns), *notes)
    stated = column_map is not None
    return table_recording(
        Table(
            path.name, held.kind, columns, time_s, dated, clock.name.lower(), values, missing, rows, warnings,
            units_stated=stated,
        )
    )  # fmt: skip


def rows_of(where: str, raw: dict[int, Raw]) -> int:
    """Length that all columns share; raises `InputError` where they differ or hold nothing."""
    sizes = {values.size for values, _ in raw.values()}
    if sizes == {0} or len(sizes) != 1:
        allowed = Text("has no rows") if sizes == {0} else Text("the columns differ in length")
        raise InputError(Fault(where, "", None, allowed))
    return sizes.pop()


def mapped_times(
    where: str, cells: Sequence[np.ndarray], column_map: ColumnMap, notes: list[str]
) -> tuple[np.ndarray, bool]:
    """Times in s of the columns that a map names, and whether they are dated; notes what was assumed."""
    clock = MappedClock(column_map.time, column_map.decimal)
    if np.issubdtype(cells[0].dtype, np.datetime64):
        return _of_dated(where, cells[0], column_map), True
    if column_map.time.numeric and cells[0].dtype.kind in "iufb":
        return clock.counted(cells[0].astype(float))
    texts = [" ".join(row) for row in zip(*(map(str, column.tolist()) for column in cells), strict=True)]
    found = clock.read(where, texts, range(1, len(texts) + 1))
    notes += clock.warnings()
    return found


def _of_dated(where: str, cells: np.ndarray, column_map: ColumnMap) -> np.ndarray:
    """Unix time in s of times that the file itself dates, which a map may call GPS time."""
    time_s = of_datetimes(cells)
    if not column_map.time.zero:
        return time_s
    if zero_of(column_map.time.zero) != GPS_EPOCH_S:
        allowed = Text('must be left out, or "gps": the file gives the epoch of this column itself')
        raise InputError(Fault(where, "time.epoch", column_map.time.zero, allowed))
    return gps_to_unix(time_s - GPS_EPOCH_S)


def of_datetimes(cells: np.ndarray) -> np.ndarray:
    """Unix time in s of ``datetime64``; NaN where there is none."""
    return np.where(np.isnat(cells), np.nan, cells.astype("datetime64[us]").astype(np.int64) * 1e-6)


def _needed(where: str, names: list[str]) -> dict[str, Column]:
    """Columns that are used; of the columns of time one is enough."""
    columns = require_columns(where, names)
    if DATE in columns:
        allowed = Text("date and time in two columns: name both by a map, or join them in one column utc")
        raise InputError(Fault(where, "", columns[DATE].name, allowed))
    sides = [
        (name, stem) for stem in ("lat", "lon") for name in names if stem in columns and is_named(name, stem)
    ]
    if sides:
        allowed = Text("a hemisphere in a column of its own: give {stem} its sign instead", stem=sides[0][1])
        raise InputError(Fault(where, "", sides[0][0], allowed))
    clock = next(stem for stem in (UTC, UNIX, SECONDS) if stem in columns)
    return {stem: c for stem, c in columns.items() if stem in QUANTITIES or stem in (clock, CLOCK)}


def _timing(
    where: str, clock: Column, cells: np.ndarray, rows: np.ndarray, notes: list[str]
) -> tuple[np.ndarray, bool]:
    if np.issubdtype(cells.dtype, np.datetime64):
        return of_datetimes(cells), True
    if cells.dtype.kind in "iufb":
        seconds, dated, told = numeric_times(where, clock, cells.astype(float))
        notes += told
        return seconds, dated
    distinct, places = np.unique(cells.astype(str), return_inverse=True)
    if distinct.size and distinct.dtype.itemsize > 4 * LONGEST_TIME:
        allowed = Text("holds texts of more than {longest_time} letters", longest_time=LONGEST_TIME)
        raise InputError(Fault(where, clock.name, None, allowed))
    if distinct.size == cells.size:
        return times(where, clock.name.lower(), [str(cell) for cell in cells], rows.tolist())
    seconds, dated = times(where, clock.name.lower(), distinct.tolist(), rows[: distinct.size].tolist())
    return seconds[places], dated
