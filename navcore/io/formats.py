"""Formats of recorded streams: a module each, chosen by what a file holds."""

from __future__ import annotations

from functools import cached_property
from importlib import import_module
from pathlib import Path
from typing import Any, Protocol

from navcore.io.series import Recording
from navcore.io.source import read_text

FORMATS = (
    "navcore.io.tables",
    "navcore.io.nmea_recording",
    "navcore.io.csv",
)
"""Modules that read a format, in the order in which they are asked."""
_OTHERWISE = "navcore.io.nmea_recording"
"""Says what is expected of a text that no format recognises."""
_HEAD_BYTES = 512


class Format(Protocol):
    """Module of one format."""

    def recognises(self, candidate: Candidate) -> bool:
        """Whether a file is of this format."""
        ...

    def read(self, path: Path) -> Recording:
        """Read a file of this format; raises `InputError`."""
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
        with path.open("rb") as stream:
            self.head = stream.read(_HEAD_BYTES)

    @cached_property
    def text(self) -> str:
        """The whole file as text; raises `InputError` when it is binary."""
        return read_text(self.path).text


def format_of(path: Path) -> Format:
    """Find the module that reads a file; raises `InputError` for a binary file of no known format."""
    candidate = Candidate(path)
    for name in FORMATS:
        module: Any = import_module(name)
        if module.recognises(candidate):
            return module
    otherwise: Any = import_module(_OTHERWISE)
    return otherwise


def takes_map(path: Path) -> bool:
    """Whether a file is a text table, which a map may describe; raises `InputError` for a binary file."""
    candidate = Candidate(path)
    for name in FORMATS[:-1]:
        module: Any = import_module(name)
        if module.recognises(candidate):
            return False
    return True
