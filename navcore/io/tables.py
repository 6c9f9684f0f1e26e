"""Parquet and MAT files with the same columns as a text table; what they would unpack to is bounded first.

A few kilobytes of either may stand for gigabytes: types, rows and sizes are read from the file's own account
before anything is unpacked. A file that lies in it is for the caller's limits (`navcore.io.guarded`).
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.io.cells import times
from navcore.io.column_names import CLOCK, DATE, QUANTITIES, SECONDS, UNIX, UTC, Column
from navcore.io.columns import (
    MOST_CELLS,
    MOST_COLUMNS,
    Table,
    column_warnings,
    require_columns,
    table_recording,
)
from navcore.io.epochs import numeric_times
from navcore.io.formats import Candidate
from navcore.io.hemispheres import is_named
from navcore.io.series import Recording

if TYPE_CHECKING:
    import pyarrow

MOST_UNPACKED_BYTES = 256 * 2**20
"""Of the columns that are used, by a Parquet file's own account."""
_PARQUET = b"PAR1"
_MAT = b"MATLAB 5.0 MAT-file"
_MAT_NUMBERS = frozenset(
    Text("double single int8 uint8 int16 uint16 int32 uint32 int64 uint64 logical").split()
)
_LONGEST_TIME = 64


def recognises(candidate: Candidate) -> bool:
    """Whether a file is a Parquet or MAT (level 5) file."""
    return candidate.head.startswith((_PARQUET, _MAT))


def read(path: Path) -> Recording:
    """Read a Parquet or MAT file; raises `InputError` as `navcore.io.csv.read` does."""
    with path.open("rb") as stream:
        parquet = stream.read(len(_PARQUET)) == _PARQUET
    kind = "Parquet table" if parquet else "MAT file"
    try:
        names, columns, raw = _read_parquet(path) if parquet else _read_mat(path)
    except InputError:
        raise
    except MemoryError:
        raise InputError(
            Fault(path.name, "", None, Text("unpacks to more memory than a {kind} may take", kind=kind))
        ) from None
    except Exception as problem:  # the libraries raise many kinds for a damaged file
        message = (str(problem).splitlines() or [type(problem).__name__])[0][:200]
        raise InputError(
            Fault(
                path.name,
                "",
                None,
                Text("cannot be read as a {kind} ({message})", kind=kind, message=message),
            )
        ) from problem
    sizes = {values.size for values, _ in raw.values()}
    if sizes == {0} or len(sizes) != 1:
        allowed = Text("has no rows") if sizes == {0} else Text("the columns differ in length")
        raise InputError(Fault(path.name, "", None, allowed))
    clock = next(columns[stem] for stem in (UTC, UNIX, SECONDS) if stem in columns)
    rows = np.arange(1, sizes.pop() + 1)
    notes: list[str] = []
    time_s, dated = _timing(path.name, clock, raw[clock.stem][0], rows, notes)
    held = {stem: raw[stem] for stem in QUANTITIES if stem in raw}
    values = {stem: _numeric(path.name, columns[stem], cells) for stem, (cells, _) in held.items()}
    missing = {stem: gone for stem, (_, gone) in held.items() if gone.any()}
    warnings = (*column_warnings(names, columns), *notes)
    return table_recording(
        Table(path.name, kind, columns, time_s, dated, clock.name.lower(), values, missing, rows, warnings)
    )


Raw = tuple[np.ndarray, np.ndarray]
"""Values of a column and which of them are missing."""


def _needed(where: str, names: list[str]) -> dict[str, Column]:
    """Columns that are used; of the columns of time one is enough."""
    columns = require_columns(where, names)
    if DATE in columns:
        allowed = Text("date and time in two columns: join them in one column utc")
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
        seconds = cells.astype("datetime64[us]").astype(np.int64) * 1e-6
        return np.where(np.isnat(cells), np.nan, seconds), True
    if cells.dtype.kind in "iufb":
        numbers = cells.astype(float)
        seconds, dated, told = numeric_times(where, clock, numbers)
        notes += told
        return seconds, dated
    distinct, places = np.unique(cells.astype(str), return_inverse=True)
    if distinct.size and distinct.dtype.itemsize > 4 * _LONGEST_TIME:
        raise InputError(
            Fault(
                where,
                clock.name,
                None,
                Text("holds texts of more than {longest_time} letters", longest_time=_LONGEST_TIME),
            )
        )
    if distinct.size == cells.size:
        return times(where, clock.name.lower(), [str(cell) for cell in cells], rows.tolist())
    seconds, dated = times(where, clock.name.lower(), distinct.tolist(), rows[: distinct.size].tolist())
    return seconds[places], dated


def _numeric(where: str, column: Column, values: np.ndarray) -> np.ndarray:
    try:
        return values.astype(float)
    except (TypeError, ValueError):
        raise InputError(
            Fault(where, column.name.lower(), None, Text("must be a column of numbers"))
        ) from None


def _refuse_size(where: str, rows: int, columns: int, size: int = 0) -> None:
    if columns and rows > MOST_CELLS // columns:
        allowed = Text(
            "has {rows} rows of {columns} columns that are used; at most {most_cells} cells are read",
            rows=rows,
            columns=columns,
            most_cells=MOST_CELLS,
        )
        raise InputError(Fault(where, "", None, allowed))
    if size > MOST_UNPACKED_BYTES:
        allowed = Text(
            "unpacks to {size:.0f} MiB; at most {most_unpacked_bytes} MiB are read",
            size=size / 2**20,
            most_unpacked_bytes=MOST_UNPACKED_BYTES // 2**20,
        )
        raise InputError(Fault(where, "", None, allowed))


def _read_parquet(path: Path) -> tuple[list[str], dict[str, Column], dict[str, Raw]]:
    import pyarrow.parquet as parquet

    with parquet.ParquetFile(path) as file:
        _require_few(path.name, file.metadata.num_columns)
        names, schema = file.schema_arrow.names, file.schema_arrow
        columns = _needed(path.name, names)
        for column in columns.values():
            _require_plain(path.name, column, schema.field(column.index).type)
        _refuse_size(path.name, file.metadata.num_rows, len(columns), _unpacked(file, columns))
        texts = [c.name for c in columns.values() if not _is_number(schema.field(c.index).type)]
    # A text that repeats is kept once: 0.8 MB of such a column may be gigabytes otherwise.
    with parquet.ParquetFile(path, read_dictionary=texts) as file:
        table = file.read(columns=[names[column.index] for column in columns.values()], use_threads=False)
    return names, columns, dict(zip(columns, map(_values, table.columns), strict=True))


def _require_few(where: str, columns: int) -> None:
    if columns > MOST_COLUMNS:
        raise InputError(
            Fault(
                where,
                "",
                None,
                Text(
                    "has {columns} columns; at most {most_columns} are read: no log",
                    columns=columns,
                    most_columns=MOST_COLUMNS,
                ),
            )
        )


def _unpacked(file: Any, columns: dict[str, Column]) -> int:
    """Bytes that the used columns unpack to, by the file's own account."""
    metadata, wanted = file.metadata, {column.name for column in columns.values()}
    groups = (metadata.row_group(index) for index in range(metadata.num_row_groups))
    chunks = (group.column(index) for group in groups for index in range(group.num_columns))
    return sum(chunk.total_uncompressed_size for chunk in chunks if chunk.path_in_schema in wanted)


def _is_number(kind: pyarrow.DataType) -> bool:
    import pyarrow.types as types

    return (
        types.is_floating(kind) or types.is_integer(kind) or types.is_boolean(kind) or types.is_decimal(kind)
    )


def _require_plain(where: str, column: Column, kind: pyarrow.DataType) -> None:
    """Refuse lists, structs and texts where numbers belong, before they are read."""
    import pyarrow.types as types

    if _is_number(kind):
        return
    if column.stem in QUANTITIES:
        raise InputError(Fault(where, column.name.lower(), None, Text("must be a column of numbers")))
    text = types.is_string(kind) or types.is_large_string(kind) or types.is_dictionary(kind)
    if not (text or types.is_timestamp(kind) or types.is_date(kind)):
        raise InputError(Fault(where, column.name, None, Text("must be a column of times")))


def _values(column: pyarrow.ChunkedArray) -> Raw:
    import pyarrow.types as types

    missing = column.is_null().to_numpy()
    if types.is_dictionary(column.type):
        joined = column.unify_dictionaries().combine_chunks()
        chunk = joined.chunk(0) if hasattr(joined, "chunks") else joined
        texts = np.array([str(text)[: _LONGEST_TIME + 1] for text in chunk.dictionary.to_pylist()] or [""])
        return texts[chunk.indices.fill_null(0).to_numpy(zero_copy_only=False)], missing
    if types.is_decimal(column.type):
        column = column.cast("float64")
    return np.asarray(column.to_numpy()), missing


def _read_mat(path: Path) -> tuple[list[str], dict[str, Column], dict[str, Raw]]:
    from scipy.io import loadmat, whosmat

    held = {name: (shape, kind) for name, shape, kind in whosmat(str(path))}
    names = list(held)
    columns = _needed(path.name, names)
    for column in columns.values():
        shape, kind = held[names[column.index]]
        if kind not in _MAT_NUMBERS:
            allowed = Text("must be a column of numbers, is of class {kind}", kind=kind)
            raise InputError(Fault(path.name, column.name.lower(), None, allowed))
        _refuse_size(path.name, int(np.prod(shape, dtype=object)), len(columns))
    content = loadmat(str(path), variable_names=[names[column.index] for column in columns.values()])
    raw = {stem: np.ravel(content[names[column.index]]) for stem, column in columns.items()}
    return names, columns, {stem: (values, np.zeros(values.size, bool)) for stem, values in raw.items()}
