"""Compressed text files: gzip, zip with one member, zstd; unpacked to a bounded size."""

import gzip
import io
import zipfile
import zlib
from pathlib import Path

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text

_GZIP, _ZIP, _ZSTD = b"\x1f\x8b", b"PK\x03\x04", b"\x28\xb5\x2f\xfd"
_NAMES = {_GZIP: "gzip", _ZIP: "zip", _ZSTD: "zstd"}


def unpacked(path: Path, most: int, field: str = "") -> bytes:
    """Bytes of a file, unpacked if it is compressed.

    Parameters
    ----------
    path : Path
        The file.
    most : int
        Bytes that are unpacked.
    field : str
        Field that faults name.

    Raises
    ------
    InputError
        Damaged, encrypted, more than ``most`` bytes, or a zip file that does not hold one file alone.
    """
    with path.open("rb") as stream:
        head = stream.read(4)
    kind = next((magic for magic in _NAMES if head.startswith(magic)), b"")
    if not kind:
        return path.read_bytes()
    try:
        content = _READERS[kind](path, most + 1)
    except InputError as error:
        raise InputError([Fault(path.name, field, f.value, f.allowed) for f in error.faults]) from None
    except (OSError, EOFError, zlib.error, zipfile.BadZipFile, RuntimeError, NotImplementedError) as problem:
        why = (str(problem).splitlines() or [type(problem).__name__])[0][:120]
        allowed = Text("cannot be unpacked as a {kind} file ({why})", kind=_NAMES[kind], why=why)
        raise InputError(Fault(path.name, field, None, allowed)) from None
    if len(content) > most:
        allowed = Text("unpacks to more than {most} MiB: cut it", most=most >> 20)
        raise InputError(Fault(path.name, field, None, allowed))
    return content


def head_of(path: Path, size: int) -> bytes:
    """First bytes of a file, unpacked if it is compressed; of a damaged one those that are packed."""
    with path.open("rb") as stream:
        packed = stream.read(size)
    kind = next((magic for magic in _NAMES if packed.startswith(magic)), b"")
    if not kind:
        return packed
    try:
        return _READERS[kind](path, size)
    except (InputError, OSError, EOFError, zlib.error, zipfile.BadZipFile, RuntimeError, NotImplementedError):
        return packed


def _read_gzip(path: Path, size: int) -> bytes:
    with gzip.open(path) as stream:
        return stream.read(size)


def _read_zip(path: Path, size: int) -> bytes:
    with zipfile.ZipFile(path) as archive:
        members = [m for m in archive.infolist() if not m.is_dir() and not m.filename.startswith("__MACOSX/")]
        if len(members) != 1:
            names = ", ".join(member.filename[:40] for member in members[:10])
            allowed = Text(
                "is a zip file of {count} files ({names}): one is read", count=len(members), names=names
            )
            raise InputError(Fault("", "", None, allowed))
        with archive.open(members[0]) as stream:
            return stream.read(size)


def _read_zstd(path: Path, size: int) -> bytes:
    import pyarrow

    with pyarrow.CompressedInputStream(pyarrow.BufferReader(path.read_bytes()), "zstd") as stream:
        return _filled(stream, size)


def _filled(stream: "io.RawIOBase", size: int) -> bytes:
    """Read until ``size`` bytes or the end."""
    parts: list[bytes] = []
    left = size
    while left and (part := stream.read(left)):
        parts.append(part)
        left -= len(part)
    return b"".join(parts)


_READERS = {_GZIP: _read_gzip, _ZIP: _read_zip, _ZSTD: _read_zstd}
