"""Parquet, MAT and npz files as named columns; what they would unpack to is bounded first.

A few kilobytes of any of them may stand for gigabytes: types, rows and sizes are read from the file's own
account before anything is unpacked. A file that lies in it is for the caller's limits
(`navcore.io.guarded`). A matrix of a MAT or npz file is one column after the other: ``imu_1``, ``imu_2``.
"""

from __future__ import annotations

import zipfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.io.columns import MOST_CELLS, MOST_COLUMNS

if TYPE_CHECKING:
    import pyarrow

MOST_UNPACKED_BYTES = 256 * 2**20
"""Of the columns that are used, by the file's own account."""
LONGEST_TIME = 64
"""Letters of a text that may be a time."""
_PARQUET = b"PAR1"
_MAT, _MAT_HDF = b"MATLAB 5.0 MAT-file", b"MATLAB 7.3 MAT-file"
_ZIP = b"PK\x03\x04"
_NPY = ".npy"
_MAT_NUMBERS = frozenset(
    Text("double single int8 uint8 int16 uint16 int32 uint32 int64 uint64 logical").split()
)
_WIDEST = 24
"""Columns of a matrix that are named one by one."""

Raw = tuple[np.ndarray, np.ndarray]
"""Values of a column and which of them are missing."""


class Part(NamedTuple):
    """One column: the variable that holds it, its place there, the rows, and whether they are numbers."""

    variable: str
    place: int | None
    rows: int
    is_number: bool
    kind: str

    @property
    def is_time(self) -> bool:
        """Whether it may be a column of times that are no numbers."""
        return self.kind.startswith(("string", "large_string", "timestamp", "date", "dictionary"))


class Container:
    """Columns of one file by their names.

    Attributes
    ----------
    path : Path
        The file.
    kind : str
        What it is, for people.
    names : list of str
        Names of the columns.
    """

    kind: str

    def __init__(self, path: Path) -> None:
        self.path = path
        with refusing(path.name, self.kind):
            self.parts = self._parts()
        self.names = list(self.parts)
        if len(self.names) > MOST_COLUMNS:
            allowed = Text(
                "has {columns} columns; at most {most_columns} are read: no log",
                columns=len(self.names),
                most_columns=MOST_COLUMNS,
            )
            raise InputError(Fault(path.name, "", None, allowed))

    def fetch(
        self, numbers: Sequence[int], times: Sequence[int] = (), most_cells: int = MOST_CELLS
    ) -> dict[int, Raw]:
        """Read columns by their places; raises `InputError` for other types or more than may be unpacked."""
        wanted = [*numbers, *times]
        faults = [
            Fault(
                self.path.name,
                self.names[index].lower(),
                None,
                Text("must be a column of numbers, is of class {kind}", kind=self._part(index).kind),
            )
            for index in numbers
            if not self._part(index).is_number
        ]
        if faults:
            raise InputError(faults)
        rows = max(self._part(index).rows for index in wanted)
        with refusing(self.path.name, self.kind):
            _refuse_size(self.path.name, rows, len(wanted), self._unpacked(wanted), most_cells)
            return self._read(wanted)

    def _part(self, index: int) -> Part:
        return self.parts[self.names[index]]

    def _parts(self) -> dict[str, Part]:
        raise NotImplementedError

    def _unpacked(self, wanted: Sequence[int]) -> int:
        """Bytes that columns unpack to, by the file's own account."""
        return 0

    def _read(self, wanted: Sequence[int]) -> dict[int, Raw]:
        held: dict[str, np.ndarray] = {}
        found: dict[int, Raw] = {}
        for index in wanted:
            part = self._part(index)
            if part.variable not in held:
                held[part.variable] = self._variable(part.variable)
            values = held[part.variable]
            values = np.ravel(values) if part.place is None else values[:, part.place]
            found[index] = values, np.zeros(values.size, bool)
        return found

    def _variable(self, name: str) -> np.ndarray:
        raise NotImplementedError


class _Parquet(Container):
    kind = "Parquet table"

    def _parts(self) -> dict[str, Part]:
        import pyarrow.parquet as parquet

        with parquet.ParquetFile(self.path) as file:
            rows, schema = file.metadata.num_rows, file.schema_arrow
            if len(schema.names) > MOST_COLUMNS:
                return dict.fromkeys(schema.names, Part("", None, rows, False, ""))
            return {
                field.name: Part(field.name, None, rows, _is_number(field.type), str(field.type)[:40])
                for field in schema
            }

    def _unpacked(self, wanted: Sequence[int]) -> int:
        import pyarrow.parquet as parquet

        with parquet.ParquetFile(self.path) as file:
            metadata, names = file.metadata, {self.names[index] for index in wanted}
            groups = (metadata.row_group(index) for index in range(metadata.num_row_groups))
            chunks = (group.column(index) for group in groups for index in range(group.num_columns))
            return sum(chunk.total_uncompressed_size for chunk in chunks if chunk.path_in_schema in names)

    def _read(self, wanted: Sequence[int]) -> dict[int, Raw]:
        import pyarrow.parquet as parquet

        names = [self.names[index] for index in wanted]
        with parquet.ParquetFile(self.path) as file:
            for name in names:
                _require_plain(self.path.name, name, file.schema_arrow.field(name).type)
        # A text that repeats is kept once: 0.8 MB of such a column may be gigabytes otherwise.
        texts = [name for name in names if not self.parts[name].is_number]
        with parquet.ParquetFile(self.path, read_dictionary=texts) as file:
            table = file.read(columns=names, use_threads=False)
        return {index: _values(table.column(self.names[index])) for index in wanted}


class _Mat(Container):
    kind = "MAT file"

    def _parts(self) -> dict[str, Part]:
        from scipy.io import whosmat

        return _by_column(
            (name, shape, kind in _MAT_NUMBERS, kind) for name, shape, kind in whosmat(str(self.path))
        )

    def _unpacked(self, wanted: Sequence[int]) -> int:
        return 8 * sum(self._part(index).rows for index in wanted)

    def _variable(self, name: str) -> np.ndarray:
        from scipy.io import loadmat

        return loadmat(str(self.path), variable_names=[name])[name]


class _MatHdf(Container):
    kind = "MAT file of version 7.3"

    def _parts(self) -> dict[str, Part]:
        import h5py

        found: list[tuple[str, tuple[int, ...], bool, str]] = []
        with h5py.File(self.path, "r", locking=False) as file:
            for name in islice(file, MOST_COLUMNS + 1):
                held = _own_dataset(file, name)
                if held is None:
                    continue
                kind = str(np.bytes_(held.attrs.get("MATLAB_class", b"")).decode("ascii", "replace"))[:40]
                number = (
                    kind in _MAT_NUMBERS and held.dtype.kind in "iufb" and "MATLAB_empty" not in held.attrs
                )
                found.append((name, held.shape[::-1], number, kind))
        return _by_column(found)

    def _unpacked(self, wanted: Sequence[int]) -> int:
        import h5py

        with h5py.File(self.path, "r", locking=False) as file:
            held = (_own_dataset(file, name) for name in {self._part(index).variable for index in wanted})
            return sum(one.nbytes for one in held)

    def _variable(self, name: str) -> np.ndarray:
        import h5py

        with h5py.File(self.path, "r", locking=False) as file:
            return np.asarray(_own_dataset(file, name)[()]).T  # HDF5 has the axes of MATLAB in reverse


def _own_dataset(file: Any, name: str) -> Any:
    """A variable that the file itself holds: a link or a dataset may point into any other file."""
    import h5py

    if not isinstance(file.get(name, getlink=True), h5py.HardLink):
        return None
    held = file[name]
    return held if isinstance(held, h5py.Dataset) and not held.is_virtual and not held.external else None


class _Npz(Container):
    kind = "npz file"

    def _parts(self) -> dict[str, Part]:
        found: list[tuple[str, tuple[int, ...], bool, str]] = []
        self._sizes: dict[str, int] = {}
        with zipfile.ZipFile(self.path) as archive:
            for member in archive.infolist()[: MOST_COLUMNS + 1]:
                name = member.filename.removesuffix(_NPY)
                with archive.open(member) as stream:
                    version = np.lib.format.read_magic(stream)  # pyright: ignore[reportArgumentType]
                    read = np.lib.format.read_array_header_1_0 if version == (1, 0) else _header_2
                    shape, _, dtype = read(stream)  # pyright: ignore[reportArgumentType]
                self._sizes[name] = int(np.prod(shape, dtype=object)) * dtype.itemsize
                found.append((name, shape, dtype.kind in "iufb", str(dtype)[:40]))
        return _by_column(found)

    def _unpacked(self, wanted: Sequence[int]) -> int:
        return sum(self._sizes[name] for name in {self._part(index).variable for index in wanted})

    def _variable(self, name: str) -> np.ndarray:
        with zipfile.ZipFile(self.path) as archive, archive.open(name + _NPY) as stream:
            return np.lib.format.read_array(stream, allow_pickle=False)  # pyright: ignore[reportArgumentType]


def _header_2(stream: Any) -> tuple[tuple[int, ...], bool, np.dtype]:
    return np.lib.format.read_array_header_2_0(stream)


def is_container(head: bytes, path: Path) -> bool:
    """Whether a file that begins so is a Parquet, MAT or npz file."""
    return head.startswith((_PARQUET, _MAT, _MAT_HDF)) or (head.startswith(_ZIP) and _is_npz(path))


def open_container(path: Path) -> Container:
    """Columns of a Parquet, MAT or npz file; raises `InputError` where it cannot be read."""
    with path.open("rb") as stream:
        head = stream.read(len(_MAT))
    kinds = {_PARQUET: _Parquet, _ZIP: _Npz, _MAT_HDF: _MatHdf}
    return next((kind for start, kind in kinds.items() if head.startswith(start)), _Mat)(path)


def _is_npz(path: Path) -> bool:
    try:
        with zipfile.ZipFile(path) as archive:
            names = archive.namelist()
    except (OSError, ValueError, zipfile.BadZipFile, NotImplementedError):
        return False
    return bool(names) and all(name.endswith(_NPY) for name in names)


@contextmanager
def refusing(where: str, kind: str) -> Iterator[None]:
    """Turn what the libraries raise for a damaged file, which is of many kinds, into an `InputError`."""
    try:
        yield
    except InputError:
        raise
    except MemoryError:
        allowed = Text("unpacks to more memory than a {kind} may take", kind=kind)
        raise InputError(Fault(where, "", None, allowed)) from None
    except Exception as problem:
        message = (str(problem).splitlines() or [type(problem).__name__])[0][:200]
        allowed = Text("cannot be read as a {kind} ({message})", kind=kind, message=message)
        raise InputError(Fault(where, "", None, allowed)) from problem


def _by_column(variables: Any) -> dict[str, Part]:
    """Columns of variables: of a matrix (n, k) each one, of vectors and numbers all of them together."""
    parts: dict[str, Part] = {}
    for name, shape, is_number, kind in variables:
        size = int(np.prod(shape, dtype=object))
        if len(shape) == 2 and 1 < shape[1] <= _WIDEST and shape[0] > 1:
            parts |= {
                f"{name}_{place + 1}": Part(name, place, shape[0], is_number, kind)
                for place in range(shape[1])
            }
        else:
            parts[name] = Part(name, None, size, is_number, kind)
    return parts


def _refuse_size(where: str, rows: int, columns: int, size: int, most_cells: int) -> None:
    if columns and rows > most_cells // columns:
        allowed = Text(
            "has {rows} rows of {columns} columns that are used; at most {most_cells} cells are read",
            rows=rows,
            columns=columns,
            most_cells=most_cells,
        )
        raise InputError(Fault(where, "", None, allowed))
    if size > MOST_UNPACKED_BYTES:
        allowed = Text(
            "unpacks to {size:.0f} MiB; at most {most_unpacked_bytes} MiB are read",
            size=size / 2**20,
            most_unpacked_bytes=MOST_UNPACKED_BYTES // 2**20,
        )
        raise InputError(Fault(where, "", None, allowed))


def _is_number(kind: pyarrow.DataType) -> bool:
    import pyarrow.types as types

    return (
        types.is_floating(kind) or types.is_integer(kind) or types.is_boolean(kind) or types.is_decimal(kind)
    )


def _require_plain(where: str, name: str, kind: pyarrow.DataType) -> None:
    """Refuse lists and structs where times belong, before they are read."""
    import pyarrow.types as types

    text = types.is_string(kind) or types.is_large_string(kind) or types.is_dictionary(kind)
    if not (_is_number(kind) or text or types.is_timestamp(kind) or types.is_date(kind)):
        raise InputError(Fault(where, name, None, Text("must be a column of times")))


def _values(column: pyarrow.ChunkedArray) -> Raw:
    import pyarrow.types as types

    missing = column.is_null().to_numpy()
    if types.is_dictionary(column.type):
        joined = column.unify_dictionaries().combine_chunks()
        chunk = joined.chunk(0) if hasattr(joined, "chunks") else joined
        texts = np.array([str(text)[: LONGEST_TIME + 1] for text in chunk.dictionary.to_pylist()] or [""])
        return texts[chunk.indices.fill_null(0).to_numpy(zero_copy_only=False)], missing
    if types.is_decimal(column.type):
        column = column.cast("float64")
    return np.asarray(column.to_numpy()), missing
