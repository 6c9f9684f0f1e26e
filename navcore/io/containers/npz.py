"""npz files of numpy, without pickles."""

from __future__ import annotations

import zipfile
from collections.abc import Sequence
from typing import Any

import numpy as np

from navcore.io.columns import MOST_COLUMNS
from navcore.io.containers.base import Container, Part, by_column

NPY = ".npy"
"""Ending of its members."""


class NpzFile(Container):
    """Arrays of an npz file."""

    kind = "npz file"

    def _parts(self) -> dict[str, Part]:
        found: list[tuple[str, tuple[int, ...], bool, str]] = []
        self._sizes: dict[str, int] = {}
        with zipfile.ZipFile(self.path) as archive:
            for member in archive.infolist()[: MOST_COLUMNS + 1]:
                name = member.filename.removesuffix(NPY)
                with archive.open(member) as stream:
                    version = np.lib.format.read_magic(stream)  # pyright: ignore[reportArgumentType]
                    read = np.lib.format.read_array_header_1_0 if version == (1, 0) else _header_2
                    shape, _, dtype = read(stream)  # pyright: ignore[reportArgumentType]
                self._sizes[name] = int(np.prod(shape, dtype=object)) * dtype.itemsize
                found.append((name, shape, dtype.kind in "iufb", str(dtype)[:40]))
        return by_column(found)

    def _unpacked(self, wanted: Sequence[int]) -> int:
        return sum(self._sizes[name] for name in {self._part(index).variable for index in wanted})

    def _variable(self, name: str) -> np.ndarray:
        with zipfile.ZipFile(self.path) as archive, archive.open(name + NPY) as stream:
            return np.lib.format.read_array(stream, allow_pickle=False)  # pyright: ignore[reportArgumentType]


def _header_2(stream: Any) -> tuple[tuple[int, ...], bool, np.dtype]:
    return np.lib.format.read_array_header_2_0(stream)
