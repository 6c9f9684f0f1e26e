"""Reading a file's text, with the refusals that hold for every text format."""

import os
import re
from pathlib import Path
from typing import NamedTuple

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.inputs import NotRegularError, regular
from navcore.foundation.text import Text
from navcore.io.compressed import unpacked

LARGEST_FILE_BYTES = 64 * 1024 * 1024
"""Larger files are refused before they are read."""
_MOST_ODD_BYTES = 0.01
_FEW_ODD_BYTES = 8
_NULS = re.compile(rb"\0{2,}")
_HOLE = re.compile(rb"(?<!\0)\0{9,}(?=[$!])")
"""Where a logger lost its power: what stood before is cut, a sentence begins behind."""
_CONTROL = rb"[\0-\x08\x0e-\x1f\x7f\xff]"
_NOISE = re.compile(
    rb"(?<!%b)%b{1,8}(?=[$!\r\n]|\Z)|(?<=[\r\n])%b{1,8}(?!%b)" % (_CONTROL, _CONTROL, _CONTROL, _CONTROL)
)
"""What an instrument or its interface sends beside its lines: before the mark of a sentence, or at the
ends."""
_ASCII_TEXT = bytes(range(0x20, 0x7F)) + b"\t\n\v\f\r"
_HIGH_BYTES = bytes(range(0x80, 0x100))
_LETTERS = bytes(range(0xA0, 0xFF))
"""Of code page 1252."""
_MOST_LETTERS = 0.3
"""Of a text in code page 1252 that are no ASCII; more are another encoding."""
_ODD = bytes((*range(0x09), *range(0x0E, 0x20), 0x7F, 0xFF))


def require_file(path: str | os.PathLike[str], where: str = "", field: str = "") -> Path:
    """Return the path of a readable regular file of acceptable size.

    Raises
    ------
    InputError
        No such file, not a regular file, not readable, empty or larger than `LARGEST_FILE_BYTES`.
    """
    file = Path(path)

    def refuse(why: str) -> InputError:
        return InputError(
            Fault(where, field, str(path), why) if field else Fault(where or str(path), "", None, why)
        )

    try:
        size = regular(file).st_size
    except (FileNotFoundError, NotADirectoryError):
        raise refuse(Text("no such file")) from None
    except NotRegularError as problem:
        raise refuse(problem.reason) from None
    except OSError as problem:
        why = problem.strerror or type(problem).__name__
        raise refuse(Text("cannot be opened ({name})", name=why)) from None
    if not os.access(file, os.R_OK):
        raise refuse(Text("cannot be read (permissions)"))
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
    """Text of a file, unpacked if it is compressed: UTF-8, UTF-16, or else code page 1252.

    NUL bytes at the ends of a line or before the mark of a sentence are left out, as an interface sends
    them. A run of them elsewhere counts as one, and costs its line: a logger that loses its power leaves
    them behind.

    Raises
    ------
    InputError
        Binary content (more than 1 % of bytes that are not printable text), or nothing but white space.
    """
    raw = unpacked(path, LARGEST_FILE_BYTES, field)
    if not raw.strip(b" \t\n\v\f\r\0"):
        raise InputError(Fault(path.name, field, None, Text("the file is empty")))
    raw = _unwrapped(raw)
    text, code_page = _decoded(raw)
    if _is_binary(raw, code_page):
        allowed = Text("binary content; expected a text file (NMEA 0183 or CSV)")
        raise InputError(Fault(path.name, field, None, allowed))
    text = text.replace("\r\r\n", "\n").replace("\r\n", "\n").replace("\r", "\n")
    damaged = 0
    if "\0" in text:
        lines = text.split("\n")
        damaged = sum("\0" in line for line in lines)
        text = "\n".join("" if "\0" in line else line for line in lines)
    return FileText(text, damaged)


def _unwrapped(raw: bytes) -> bytes:
    """Bytes in UTF-8 if they were UTF-16, without the mark of an encoding and noise beside lines."""
    if _is_utf16(raw):
        marked = raw.startswith((b"\xff\xfe", b"\xfe\xff"))
        encoding = (
            "utf-16" if marked else "utf-16-le" if raw[1::2].count(0) > raw[::2].count(0) else "utf-16-be"
        )
        raw = raw.decode(encoding, errors="replace").encode()
    if raw.startswith(b"\xef\xbb\xbf"):
        raw = raw[3:]
    if len(raw.translate(None, _ODD)) < len(raw):
        raw = _HOLE.sub(b"\0\n", _NOISE.sub(b"", raw))
    return _NULS.sub(b"\0", raw) if b"\0\0" in raw else raw


def _is_utf16(raw: bytes) -> bool:
    """Whether nearly every second byte is NUL, and hardly one of the others."""
    if b"\0" not in raw:
        return False
    nuls = raw[::2].count(0), raw[1::2].count(0)
    return len(raw) % 2 == 0 and max(nuls) > len(raw) // 4 and min(nuls) * 20 <= max(nuls)


def _decoded(raw: bytes) -> tuple[str, bool]:
    """Text in UTF-8, else in code page 1252, as spreadsheets of western Europe write it; and which."""
    try:
        return raw.decode("utf-8"), False
    except UnicodeDecodeError:
        return raw.decode("cp1252", errors="replace"), True


def _is_binary(raw: bytes, code_page: bool) -> bool:
    """Whether too many bytes are neither printable nor letters of the encoding."""
    if code_page and len(raw.translate(None, bytes(range(0x80)))) > _MOST_LETTERS * len(raw):
        return True
    odd = len(raw.translate(None, _ASCII_TEXT + (_LETTERS if code_page else _HIGH_BYTES)))
    return odd > max(_MOST_ODD_BYTES * len(raw), _FEW_ODD_BYTES)


def as_utf8(raw: bytes) -> bytes | None:
    """Text of any of these encodings in UTF-8; None for binary content."""
    if raw.isascii() and b"\0" not in raw:
        return raw
    raw = _unwrapped(raw)
    text, code_page = _decoded(raw)
    return None if _is_binary(raw, code_page) else text.encode()
