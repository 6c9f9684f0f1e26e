"""Formats of recorded streams: a module each, chosen by what a file holds."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from navcore.foundation.inputs import opened
from navcore.io.series import Recording
from navcore.io.source import read_text

if TYPE_CHECKING:
    from navcore.io.column_map import ColumnMap

FORMATS: list[Any] = [
    "navcore.io.tables",
    "navcore.io.stdbin",
    "navcore.io.gpx",
    "navcore.io.nmea_recording",
    "navcore.io.csv",
]
"""Modules that read a format, in the order in which they are asked; one that was added is itself here."""
_OTHERWISE = "navcore.io.nmea_recording"
"""Says what is expected of a text that no format recognises."""
_TABLES, _TEXT_TABLES = "navcore.io.tables", "navcore.io.csv"
"""Those that a map may describe; a text that no format recognises may be such a table too."""
_HEAD_BYTES = 512


class Format(Protocol):
    """Module of one format."""

    def recognises(self, candidate: Candidate) -> bool:
        """Whether a file is of this format."""
        ...

    def read(self, path: Path) -> Recording:
        """Read a file of this format; raises `InputError`."""
        ...


class TableFormat(Format, Protocol):
    """Module of a format of tables."""

    def read(self, path: Path, column_map: ColumnMap | None = None) -> Recording:
        """Read a table by a map, or by the names of its columns; raises `InputError`."""
        ...


class Candidate:
    """A file whose format is asked for.

    Attributes
    ----------
    path : Path
        The file.
    head : bytes
        Its first 512 bytes.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        with opened(path) as stream:
            self.head = stream.read(_HEAD_BYTES)

    @cached_property
    def text(self) -> str:
        """The whole file as text; raises `InputError` when it is binary."""
        return read_text(self.path).text


def format_of(path: Path) -> Format:
    """Find the module that reads a file; raises `InputError` for a binary file of no known format."""
    found = _recognising(path, FORMATS)
    return found if found is not None else _module(_OTHERWISE)


def mapped_format(path: Path) -> TableFormat | None:
    """Module that reads a table; None for a file of another kind.

    Raises
    ------
    InputError
        A binary file of no known format.
    """
    found: Any = _recognising(path, FORMATS)
    text = found is None or found is _module(_TEXT_TABLES)
    return _module(_TEXT_TABLES) if text else found if found is _module(_TABLES) else None


def _recognising(path: Path, names: Sequence[Any]) -> Format | None:
    """First of these modules that recognises a file."""
    candidate = Candidate(path)
    return next((found for found in map(_module, names) if found.recognises(candidate)), None)


def _module(name: Any) -> Any:
    return import_module(name) if isinstance(name, str) else name
