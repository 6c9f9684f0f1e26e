"""Containers of named columns; what they would unpack to is bounded before anything is unpacked.

A few kilobytes of any of them may stand for gigabytes: types, rows and sizes are read from the file's own
account first. A file that lies in it is for the caller's limits (`navcore.foundation.guarded`). A matrix is
one column after the other: ``imu_1``, ``imu_2``; a field of a struct or a group has its path, ``ref.lat``.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.io.column_names import SECONDS, UNIX, UTC, known_columns
from navcore.io.columns import MOST_CELLS, MOST_COLUMNS

MOST_UNPACKED_BYTES = 256 * 2**20
"""Of the columns that are used, by the file's own account."""
LONGEST_TIME = 64
"""Letters of a text that may be a time."""
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
    notes : dict
        What is assumed of variables that are times, by the variable; empty where nothing is.
    """

    kind: str

    def __init__(self, path: Path) -> None:
        self.path = path
        self.notes: dict[str, str] = {}
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

    def notes_of(self, places: Sequence[int]) -> list[str]:
        """What is assumed of the columns at some places."""
        return [note for place in places if (note := self.notes.get(self._part(place).variable, ""))]

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


def of_one_length(parts: dict[str, Part]) -> dict[str, Part]:
    """Columns as long as that of the time, if one is named so: the others are coordinates or notes."""
    clocks = known_columns(list(parts)).keys() & {UTC, UNIX, SECONDS}
    sizes = [parts[name].rows for name in parts if known_columns([name]).keys() & clocks]
    if not sizes:
        return parts
    return {name: part for name, part in parts.items() if part.rows == max(sizes)}


def by_column(variables: Any, variable: str = "") -> dict[str, Part]:
    """Columns of variables: of a matrix (n, k) each one, of vectors and numbers all of them together.

    Parameters
    ----------
    variables : iterable of (str, tuple of int, bool, str)
        Name, shape, whether they are numbers, and class.
    variable : str
        Where the values stand, if it is not the name.
    """
    parts: dict[str, Part] = {}
    for name, shape, is_number, kind in variables:
        held = variable or name
        size = int(np.prod(shape, dtype=object))
        if len(shape) == 2 and 1 < shape[1] <= _WIDEST and shape[0] > 1:
            parts |= {
                f"{name}_{place + 1}": Part(held, place, shape[0], is_number, kind)
                for place in range(shape[1])
            }
        else:
            parts[name] = Part(held, None, size, is_number, kind)
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
