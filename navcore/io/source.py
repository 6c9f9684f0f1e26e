"""Reading a file's text, with the refusals that hold for every text format."""

from __future__ import annotations

import os
from pathlib import Path

from navcore.errors import Fault, InputError

LARGEST_FILE_BYTES = 64 * 1024 * 1024
"""Larger files are refused before they are read."""
_MOST_ODD_BYTES = 0.01
_ASCII_TEXT = bytes(range(0x20, 0x7F)) + b"\t\n\v\f\r"
_HIGH_BYTES = bytes(range(0x80, 0x100))


def require_file(path: str | os.PathLike[str], where: str = "", field: str = "") -> Path:
    """Return the path of a readable regular file of acceptable size.

    Raises
    ------
    InputError
        No such file, not a file, not readable, empty or larger than `LARGEST_FILE_BYTES`.
    """
    found = Path(path)

    def refuse(why: str) -> InputError:
        return InputError(
            Fault(where, field, str(path), why) if field else Fault(where or str(path), "", None, why)
        )

    try:
        present, regular = found.exists(), found.is_file()
    except (OSError, ValueError) as problem:
        raise refuse(f"cannot be opened ({problem.__class__.__name__})") from problem
    if not present:
        raise refuse("no such file")
    if not regular:
        raise refuse("is not a file")
    if not os.access(found, os.R_OK):
        raise refuse("cannot be read (permissions)")
    size = found.stat().st_size
    if size == 0:
        raise refuse("the file is empty")
    if size > LARGEST_FILE_BYTES:
        raise refuse(f"{size / 2**20:.0f} MiB; at most {LARGEST_FILE_BYTES // 2**20} MiB are read")
    return found


def read_text(path: Path, field: str = "") -> str:
    """Text of a file that is not binary; single odd bytes (line noise) become U+FFFD.

    Raises
    ------
    InputError
        Binary content (NUL bytes, or more than 1 % of bytes that are not printable text).
    """
    raw = path.read_bytes()
    if raw.startswith(b"\xef\xbb\xbf"):
        raw = raw[3:]
    text = _utf8(raw)
    odd = len(raw.translate(None, _ASCII_TEXT if text is None else _ASCII_TEXT + _HIGH_BYTES))
    if b"\0" in raw or odd > _MOST_ODD_BYTES * len(raw):
        allowed = "binary content; expected a text file (NMEA 0183 or CSV)"
        raise InputError(Fault(path.name, field, None, allowed))
    if not raw.strip():
        raise InputError(Fault(path.name, field, None, "the file is empty"))
    return text if text is not None else raw.decode("ascii", errors="replace")


def _utf8(raw: bytes) -> str | None:
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError:
        return None
