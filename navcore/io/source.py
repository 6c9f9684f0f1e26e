"""Reading a file's text, with the refusals that hold for every text format."""

import os
import re
from pathlib import Path
from typing import NamedTuple

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.io.compressed import unpacked

LARGEST_FILE_BYTES = 64 * 1024 * 1024
"""Larger files are refused before they are read."""
_MOST_ODD_BYTES = 0.01
_FEW_ODD_BYTES = 8
_NULS = re.compile(rb"\0{2,}")
_ASCII_TEXT = bytes(range(0x20, 0x7F)) + b"\t\n\v\f\r"
_HIGH_BYTES = bytes(range(0x80, 0x100))


def require_file(path: str | os.PathLike[str], where: str = "", field: str = "") -> Path:
    """Return the path of a readable regular file of acceptable size.

    Raises
    ------
    InputError
        No such file, not a file, not readable, empty or larger than `LARGEST_FILE_BYTES`.
    """
    file = Path(path)

    def refuse(why: str) -> InputError:
        return InputError(
            Fault(where, field, str(path), why) if field else Fault(where or str(path), "", None, why)
        )

    try:
        present, regular = file.exists(), file.is_file()
    except (OSError, ValueError) as problem:
        why = getattr(problem, "strerror", None) or type(problem).__name__
        raise refuse(Text("cannot be opened ({name})", name=why)) from problem
    if not present:
        raise refuse(Text("no such file"))
    if not regular:
        raise refuse(Text("is not a file"))
    if not os.access(file, os.R_OK):
        raise refuse(Text("cannot be read (permissions)"))
    size = file.stat().st_size
    if size == 0:
        raise refuse(Text("the file is empty"))
    if size > LARGEST_FILE_BYTES:
        raise refuse(
            Text(
                "{size:.0f} MiB; at most {largest_file_bytes} MiB are read",
                size=size / 2**20,
                largest_file_bytes=LARGEST_FILE_BYTES // 2**20,
            )
        )
    return file


class FileText(NamedTuple):
    """Text of a file.

    Attributes
    ----------
    text : str
        Lines end with a line feed; those that held a NUL byte are empty.
    damaged_lines : int
        Count of the latter.
    """

    text: str
    damaged_lines: int

    def warnings(self) -> list[str]:
        """Say that lines were left out."""
        if not self.damaged_lines:
            return []
        return [
            Text.plural(
                "{count} line with NUL bytes left out",
                "{count} lines with NUL bytes left out",
                count=self.damaged_lines,
            )
        ]


def read_text(path: Path, field: str = "") -> FileText:
    """Text of a file, unpacked if it is compressed; single odd bytes (line noise) become U+FFFD.

    A run of NUL bytes counts as one: a logger that loses its power leaves them behind.

    Raises
    ------
    InputError
        Binary content (more than 1 % of bytes that are not printable text), or nothing but white space.
    """
    raw = _unwrapped(unpacked(path, LARGEST_FILE_BYTES, field))
    text = _utf8(raw)
    odd = len(raw.translate(None, _ASCII_TEXT if text is None else _ASCII_TEXT + _HIGH_BYTES))
    if odd > max(_MOST_ODD_BYTES * len(raw), _FEW_ODD_BYTES):
        allowed = Text("binary content; expected a text file (NMEA 0183 or CSV)")
        raise InputError(Fault(path.name, field, None, allowed))
    if not raw.strip(b" \t\n\v\f\r\0"):
        raise InputError(Fault(path.name, field, None, Text("the file is empty")))
    text = text if text is not None else raw.decode("ascii", errors="replace")
    text = text.replace("\r\r\n", "\n").replace("\r\n", "\n").replace("\r", "\n")
    damaged = 0
    if "\0" in text:
        lines = text.split("\n")
        damaged = sum("\0" in line for line in lines)
        text = "\n".join("" if "\0" in line else line for line in lines)
    return FileText(text, damaged)


def _unwrapped(raw: bytes) -> bytes:
    """Bytes of UTF-8 (or nearly so) without the mark of an encoding and without long runs of NUL bytes."""
    if raw.startswith((b"\xff\xfe", b"\xfe\xff")) and len(raw) % 2 == 0 and raw.count(b"\0") > len(raw) // 4:
        raw = raw.decode("utf-16", errors="replace").encode()
    if raw.startswith(b"\xef\xbb\xbf"):
        raw = raw[3:]
    return _NULS.sub(b"\0", raw) if b"\0\0" in raw else raw


def _utf8(raw: bytes) -> str | None:
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError:
        return None
