"""MAT files up to level 5: variables, and the fields of structs by their paths, ``ref.lat``."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.inputs import opened
from navcore.foundation.text import Text
from navcore.io.columns import MOST_COLUMNS
from navcore.io.containers.base import MOST_UNPACKED_BYTES, Container, Part, by_column

NUMBERS = frozenset(Text("double single int8 uint8 int16 uint16 int32 uint32 int64 uint64 logical").split())
"""Classes of MATLAB that are numbers."""
_COMPRESSED = 15
_HEAD_BYTES = 128
_DEEPEST = 6
_STEP = 1 << 20


class MatFile(Container):
    """MAT file of level 4 or 5."""

    kind = "MAT file"

    def _parts(self) -> dict[str, Part]:
        from scipy.io import loadmat, whosmat

        told = whosmat(str(self.path))
        structs = [name for name, _, kind in told if kind == "struct"]
        self._fields: dict[str, np.ndarray] = {}
        if structs:
            _refuse_swollen(self.path)
            held = loadmat(str(self.path), variable_names=structs)
            for name in structs:
                self._fields.update(_numeric_fields(name, held[name]))
        parts = by_column(
            (name, shape, kind in NUMBERS, kind) for name, shape, kind in told if kind != "struct"
        )
        parts |= by_column((name, values.shape, True, "double") for name, values in self._fields.items())
        objects = [(name, kind) for name, _, kind in told if kind in ("opaque", "object", "function")]
        if objects and not any(part.is_number for part in parts.values()):
            raise object_error(self.path, objects)
        return parts

    def _unpacked(self, wanted: Sequence[int]) -> int:
        return 8 * sum(self._part(index).rows for index in wanted)

    def _variable(self, name: str) -> np.ndarray:
        from scipy.io import loadmat

        if name in self._fields:
            return self._fields[name]
        return loadmat(str(self.path), variable_names=[name])[name]


def object_error(path: Path, objects: Sequence[tuple[str, str]]) -> InputError:
    """Refusal of a file whose variables are tables, timetables or other objects."""
    allowed = Text(
        "holds {names}, of MATLAB's classes {kinds}, which only MATLAB reads: save their columns, as by "
        "s = table2struct(t, 'ToScalar', true); save('log.mat', '-struct', 's')",
        names=", ".join(name or "?" for name, _ in objects[:10]),
        kinds=", ".join(sorted({kind for _, kind in objects})),
    )
    return InputError(Fault(path.name, "", None, allowed))


def _numeric_fields(path: str, value: Any, deep: int = 0) -> Iterator[tuple[str, np.ndarray]]:
    """Yield the fields of a struct that are numbers by path; those of an array of structs together."""
    names = value.dtype.names if isinstance(value, np.ndarray) else None
    if not names or deep > _DEEPEST:
        if isinstance(value, np.ndarray) and value.dtype.kind in "iufb" and value.size:
            yield path, value
        return
    for name in names[:MOST_COLUMNS]:
        elements = np.ravel(value[name])
        if elements.size == 1:
            yield from _numeric_fields(f"{path}.{name}", elements[0], deep + 1)
        elif all(
            isinstance(one, np.ndarray) and one.dtype.kind in "iufb" and one.size == 1 for one in elements
        ):
            yield f"{path}.{name}", np.array([one.item() for one in elements])[:, None]


def _refuse_swollen(path: Path) -> None:
    """Refuse a file whose compressed variables unpack to more than may be."""
    left = MOST_UNPACKED_BYTES
    with opened(path) as stream:
        head = stream.read(_HEAD_BYTES)
        order = "<" if head[126:128] == b"IM" else ">"
        while len(tag := stream.read(8)) == 8:
            kind, size = struct.unpack(f"{order}II", tag)
            if kind != _COMPRESSED:
                stream.seek(size, 1)
                continue
            packed, unpacker = stream.read(size), zlib.decompressobj()
            while packed and left > 0:
                left -= len(unpacker.decompress(packed, _STEP))
                packed = unpacker.unconsumed_tail
            if left <= 0:
                allowed = Text("unpacks to more than {most} MiB", most=MOST_UNPACKED_BYTES >> 20)
                raise InputError(Fault(path.name, "", None, allowed))


def is_level_4(head: bytes) -> bool:
    """Whether a file begins as a MAT file of level 4, which has no name of its own."""
    if len(head) < 21:
        return False
    kind, rows, columns, imaginary, size = struct.unpack("<5i", head[:20])
    name = head[20 : 20 + max(size, 0)]
    formed = 0 <= kind < 60 and kind % 10 in (0, 1) and imaginary in (0, 1) and 1 < size <= 64
    letters = name[:-1].replace(b"_", b"a")
    return (
        formed
        and 0 < rows
        and 0 < columns
        and name.endswith(b"\0")
        and letters.isascii()
        and letters.isalnum()
    )
