"""HDF5: MAT files of version 7.3 with their structs, NetCDF 4, and files of others with named datasets."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from navcore.io.columns import MOST_COLUMNS
from navcore.io.containers.attributes import clock_note, name_of, text_of, values_of
from navcore.io.containers.base import LONGEST_TIME, Container, Part, by_column, of_one_length
from navcore.io.containers.mat import NUMBERS, object_error

_DEEPEST = 6


class _Hdf(Container):
    """Variables of an HDF5 file by their paths."""

    def _unpacked(self, wanted: Sequence[int]) -> int:
        import h5py

        with h5py.File(self.path, "r", locking=False) as file:
            names = {self._part(index).variable.partition("\0")[0] for index in wanted}
            return sum(_own(file, name).nbytes for name in names)


class MatHdfFile(_Hdf):
    """MAT file of version 7.3."""

    kind = "MAT file of version 7.3"

    def _parts(self) -> dict[str, Part]:
        import h5py

        found: list[tuple[str, tuple[int, ...], bool, str]] = []
        objects: list[tuple[str, str]] = []
        with h5py.File(self.path, "r", locking=False) as file:
            for path, held in islice(_datasets(file), MOST_COLUMNS + 1):
                kind = text_of(held.attrs.get("MATLAB_class", b""))[:40]
                plain = held.dtype.kind in "iufb" and "MATLAB_empty" not in held.attrs
                if "MATLAB_object_decode" in held.attrs:
                    objects.append((path, kind))
                found.append((path.replace("/", "."), held.shape[::-1], kind in NUMBERS and plain, kind))
        if objects and not any(number for _, _, number, _ in found):
            raise object_error(self.path, objects)
        return by_column(found)

    def _variable(self, name: str) -> np.ndarray:
        import h5py

        with h5py.File(self.path, "r", locking=False) as file:
            return np.asarray(_own(file, name)[()]).T  # HDF5 has the axes of MATLAB in reverse


class HdfFile(_Hdf):
    """NetCDF 4, or HDF5 of others: the variables that are as long as that of the time."""

    def __init__(self, path: Path) -> None:
        self.kind = "NetCDF file" if _is_netcdf(path) else "HDF5 file"
        super().__init__(path)

    def _parts(self) -> dict[str, Part]:
        import h5py

        parts: dict[str, Part] = {}
        self._held: dict[str, str] = {}
        with h5py.File(self.path, "r", locking=False) as file:
            for path, held in islice(_datasets(file), MOST_COLUMNS + 1):
                if text_of(held.attrs.get("NAME", b"")).startswith("This is a netCDF dimension but not"):
                    continue
                for field in held.dtype.names or ("",):
                    variable = f"{path}\0{field}"
                    dtype = held.dtype[field] if field else held.dtype
                    shown = ".".join((*path.split("/"), *([field] if field else [])))
                    name = name_of(shown, {} if field else dict(held.attrs))
                    kind = "string" if dtype.kind in "OSU" else str(dtype)[:40]
                    self.notes[variable] = "" if field else clock_note(shown, dict(held.attrs))
                    parts |= by_column([(name, held.shape, dtype.kind in "iufb", kind)], variable)
        return of_one_length(parts)

    def _variable(self, name: str) -> np.ndarray:
        import h5py

        path, _, field = name.partition("\0")
        with h5py.File(self.path, "r", locking=False) as file:
            held = _own(file, path)
            raw = np.asarray(held[field] if field else held[()])
            attributes = {} if field else dict(held.attrs)
        if raw.dtype.kind in "OSU":
            texts = [
                one.decode("utf-8", "replace") if isinstance(one, bytes) else str(one) for one in raw.ravel()
            ]
            return np.array([text[: LONGEST_TIME + 1] for text in texts] or [""])
        return values_of(raw, attributes, path) if attributes else raw


def _is_netcdf(path: Path) -> bool:
    import h5py

    try:
        with h5py.File(path, "r", locking=False) as file:
            scales = (
                isinstance(one, h5py.Dataset) and "DIMENSION_LIST" in one.attrs
                for one in islice(file.values(), 20)
            )
            return "_NCProperties" in file.attrs or "Conventions" in file.attrs or any(scales)
    except (OSError, RuntimeError, ValueError, KeyError):
        return False


def _datasets(group: Any, path: str = "", deep: int = 0) -> Iterator[tuple[str, Any]]:
    """Yield the datasets of the file itself, those of groups with their paths."""
    import h5py

    for name in islice(group, MOST_COLUMNS + 1):
        if name.startswith("#"):  # what MATLAB keeps for its own use
            continue
        if not isinstance(group.get(name, getlink=True), h5py.HardLink):
            continue
        held, own = group[name], f"{path}/{name}" if path else name
        if isinstance(held, h5py.Group) and deep < _DEEPEST:
            yield from _datasets(held, own, deep + 1)
        elif _own(group, name) is not None:
            yield own, held


def _own(file: Any, name: str) -> Any:
    """A dataset that the file itself holds: a link or a dataset may point into any other file."""
    import h5py

    path = name.replace(".", "/") if name.partition("/")[0] not in file and "." in name else name
    if not isinstance(file.get(path, getlink=True), h5py.HardLink):
        return None
    held = file[path]
    return held if isinstance(held, h5py.Dataset) and not held.is_virtual and not held.external else None
