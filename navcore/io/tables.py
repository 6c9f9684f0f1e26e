"""Parquet and MAT files with the same columns as a CSV table."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from navcore.errors import Fault, InputError
from navcore.io.columns import known_columns, require_columns, table_recording, utc_seconds
from navcore.io.csv import unused_columns
from navcore.io.series import Recording

SNIFFED_BYTES = 512
MOST_ROWS = 10_000_000
"""Longer tables are refused before they are unpacked."""
_PARQUET = b"PAR1"
_MAT = b"MATLAB 5.0 MAT-file"


def looks_like_table(head: bytes) -> bool:
    """Whether a file that begins so is a Parquet or MAT (level 5) file."""
    return head.startswith((_PARQUET, _MAT))


def read_table(path: Path) -> Recording:
    """Read a Parquet or MAT file; raises `InputError` as `navcore.io.csv.read_csv` does."""
    with path.open("rb") as stream:
        parquet = stream.read(len(_PARQUET)) == _PARQUET
    kind = "Parquet table" if parquet else "MAT file"
    try:
        names, raw = _read_parquet(path) if parquet else _read_mat(path)
    except InputError:
        raise
    except Exception as problem:  # the libraries raise many kinds for a damaged file
        message = str(problem).splitlines()[0] if str(problem) else type(problem).__name__
        raise InputError(Fault(path.name, "", None, f"cannot be read as a {kind} ({message})")) from problem
    found = require_columns(path.name, names)
    size = {values.size for values in raw.values()}
    if size == {0} or len(size) != 1:
        allowed = "has no rows" if size == {0} else "the columns differ in length"
        raise InputError(Fault(path.name, "", None, allowed))
    rows = np.arange(1, size.pop() + 1)
    columns = {name: _numeric(path.name, name, raw[name], rows) for name in found}
    if "utc" in columns:
        columns.pop("t_s", None)
    return table_recording(path.name, kind, columns, rows, unused_columns(names, found))


def _numeric(where: str, name: str, values: np.ndarray, rows: np.ndarray) -> np.ndarray:
    if name == "utc":
        if np.issubdtype(values.dtype, np.datetime64):
            seconds = values.astype("datetime64[us]").astype(np.int64) * 1e-6
            return np.where(np.isnat(values), np.nan, seconds)
        return utc_seconds(where, [str(value) for value in values], rows.tolist())
    try:
        return values.astype(float)
    except (TypeError, ValueError):
        raise InputError(Fault(where, name, None, "must be a column of numbers")) from None


def _read_parquet(path: Path) -> tuple[list[str], dict[str, np.ndarray]]:
    import pyarrow.parquet as parquet

    with parquet.ParquetFile(path) as file:
        _require_rows(path, file.metadata.num_rows)
        names = file.schema_arrow.names
        found = known_columns(names)
        table = file.read(columns=[names[index] for index in found.values()])
    columns = dict(zip(found, table.columns, strict=True))
    return names, {name: column.to_pandas().to_numpy() for name, column in columns.items()}


def _read_mat(path: Path) -> tuple[list[str], dict[str, np.ndarray]]:
    from scipy.io import loadmat, whosmat

    shapes = {name: shape for name, shape, _ in whosmat(str(path))}
    names = list(shapes)
    found = {name: names[index] for name, index in known_columns(names).items()}
    for name in found.values():
        _require_rows(path, int(np.prod(shapes[name])))
    content = loadmat(str(path), variable_names=list(found.values()))
    return names, {name: np.ravel(content[stored]) for name, stored in found.items()}


def _require_rows(path: Path, count: int) -> None:
    if count > MOST_ROWS:
        raise InputError(Fault(path.name, "", count, f"at most {MOST_ROWS} rows are read"))
