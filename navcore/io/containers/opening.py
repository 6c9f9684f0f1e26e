"""Which container a file is, by its first bytes."""

from __future__ import annotations

import zipfile
from pathlib import Path

from navcore.foundation.inputs import opened
from navcore.io.containers.base import Container
from navcore.io.containers.hdf import HdfFile, MatHdfFile
from navcore.io.containers.mat import MatFile, is_level_4
from navcore.io.containers.netcdf import NetcdfFile
from navcore.io.containers.npz import NPY, NpzFile
from navcore.io.containers.parquet import ParquetTable

_ZIP = b"PK\x03\x04"
_KINDS: dict[bytes, type[Container]] = {
    b"PAR1": ParquetTable,
    b"MATLAB 5.0 MAT-file": MatFile,
    b"MATLAB 7.3 MAT-file": MatHdfFile,
    b"\x89HDF\r\n\x1a\n": HdfFile,
    b"CDF\x01": NetcdfFile,
    b"CDF\x02": NetcdfFile,
    _ZIP: NpzFile,
}
"""Readers by the first bytes of a file."""


def is_container(head: bytes, path: Path) -> bool:
    """Whether a file that begins so is one of these."""
    kind = _kind_of(head)
    return kind is not None and (kind is not NpzFile or _is_npz(path))


def open_container(path: Path) -> Container:
    """Columns of a file that is one of these; raises `InputError` where it cannot be read."""
    with opened(path) as stream:
        kind = _kind_of(stream.read(512))
    return (kind or MatFile)(path)


def _kind_of(head: bytes) -> type[Container] | None:
    found = next((kind for start, kind in _KINDS.items() if head.startswith(start)), None)
    return MatFile if found is None and is_level_4(head) else found


def _is_npz(path: Path) -> bool:
    try:
        with zipfile.ZipFile(path) as archive:
            names = archive.namelist()
    except (OSError, ValueError, zipfile.BadZipFile, NotImplementedError):
        return False
    return bool(names) and all(name.endswith(NPY) for name in names)
