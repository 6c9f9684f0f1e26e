"""NetCDF of the classic format (versions 1 and 2), by the CF conventions."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from navcore.io.columns import MOST_COLUMNS
from navcore.io.containers.attributes import clock_note, name_of, values_of
from navcore.io.containers.base import Container, Part, by_column, of_one_length


class NetcdfFile(Container):
    """NetCDF file whose variables along the dimension of the time are columns."""

    kind = "NetCDF file"

    def _parts(self) -> dict[str, Part]:
        from scipy.io import netcdf_file

        parts: dict[str, Part] = {}
        self._raw: dict[str, np.ndarray] = {}
        with netcdf_file(str(self.path), "r", mmap=False, maskandscale=False) as file:
            for name, variable in list(file.variables.items())[: MOST_COLUMNS + 1]:
                attributes = dict(variable._attributes)
                raw = np.array(variable[:]) if variable.shape else np.array(variable.getValue())
                number = raw.dtype.kind in "iufb"
                if number:
                    self._raw[name] = values_of(raw, attributes, name)
                    self.notes[name] = clock_note(name, attributes)
                parts |= by_column([(name_of(name, attributes), raw.shape, number, str(raw.dtype))], name)
        return of_one_length(parts)

    def _unpacked(self, wanted: Sequence[int]) -> int:
        return sum(self._raw[name].nbytes for name in {self._part(index).variable for index in wanted})

    def _variable(self, name: str) -> np.ndarray:
        return self._raw[name]
