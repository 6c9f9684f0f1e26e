"""Compressed text files: gzip, bzip2, xz, zstd, zip with one member; unpacked to a bounded size."""

import bz2
import gzip
import io
import lzma
import zipfile
import zlib
from pathlib import Path

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.inputs import opened
from navcore.foundation.text import Text
from navcore.io.known_files import refuse_known

_GZIP, _ZIP, _ZSTD = b"\x1f\x8b", b"PK\x03\x04", b"\x28\xb5\x2f\xfd"
_BZIP, _XZ = b"BZh", b"\xfd7zX"
_NAMES = {_GZIP: "gzip", _ZIP: "zip", _ZSTD: "zstd", _BZIP: "bzip2", _XZ: "xz"}
_DAMAGED = (
    OSError, EOFError, zlib.error, zipfile.BadZipFile, RuntimeError, NotImplementedError, lzma.LZMAError,
    ValueError,
)  # fmt: skip


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
    refuse_known(path, field)
    with opened(path) as stream:
        head = stream.read(4)
    kind = next((magic for magic in _NAMES if head.startswith(magic)), b"")
    if not kind:
        with opened(path) as stream:  # anew: a stream that has been read from copies the rest
            return stream.read()
    try:
        content = _READERS[kind](path, most + 1)
    except InputError as error:
        raise InputError([Fault(path.name, field, f.value, f.allowed) for f in error.faults]) from None
    except _DAMAGED as problem:
        why = (str(problem).splitlines() or [type(problem).__name__])[0][:120]
        allowed = Text("cannot be unpacked as a {kind} file ({why})", kind=_NAMES[kind], why=why)
        raise InputError(Fault(path.name, field, None, allowed)) from None
    if len(content) > most:
        allowed = Text("unpacks to more than {most} MiB: cut it", most=most >> 20)
        raise InputError(Fault(path.name, field, None, allowed))
    refuse_known(path, field, content)
    if any(content.startswith(start) for start in _PACKED_TABLES):
        allowed = Text(
            "holds a {kind} table inside of {packing}: unpack it first",
            kind=_named(content),
            packing=_NAMES[kind],
        )
        raise InputError(Fault(path.name, field, None, allowed))
    return content


_PACKED_TABLES = {
    b"PAR1": "Parquet", b"MATLAB ": "MAT", b"\x89HDF": "HDF5", b"CDF": "NetCDF", b"PK\x03\x04": "zip", _GZIP:
    "gzip",
}  # fmt: skip


def _named(content: bytes) -> str:
    return next(name for start, name in _PACKED_TABLES.items() if content.startswith(start))


def head_of(path: Path, size: int) -> bytes:
    """First bytes of a file, unpacked if it is compressed; of a damaged one those that are packed."""
    with opened(path) as stream:
        packed = stream.read(size)
    kind = next((magic for magic in _NAMES if packed.startswith(magic)), b"")
    if not kind:
        return packed
    try:
        return _READERS[kind](path, size)
    except _DAMAGED:
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


def _read_bzip(path: Path, size: int) -> bytes:
    with bz2.open(path) as stream:
        return stream.read(size)


def _read_xz(path: Path, size: int) -> bytes:
    with lzma.open(path) as stream:
        return stream.read(size)


_READERS = {_GZIP: _read_gzip, _ZIP: _read_zip, _ZSTD: _read_zstd, _BZIP: _read_bzip, _XZ: _read_xz}
