"""Maps: what the columns of a table mean, said by the user in a TOML file instead of guessed from names.

time = { column = "zeit", unit = "iso", zone = "Europe/Berlin" }
decimal = ","
delimiter = ";"
skip_bad_rows = true

[quantity.speed]
column = "fahrt"
unit = "kn"
sign = 1
"""

from __future__ import annotations

import os
import re
from functools import cached_property
from pathlib import Path
from typing import Any, Literal
from zoneinfo import ZoneInfo

from pydantic import Field, ValidationError

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.faults import faults_from
from navcore.foundation.inputs import TooLargeError, read_bytes
from navcore.foundation.parameters import Parameters
from navcore.foundation.stage_cache import MAP_SUFFIX
from navcore.foundation.text import Text
from navcore.foundation.written_toml import read_toml_text
from navcore.io.column_names import QUANTITIES, Column, known_columns, plain_name
from navcore.io.columns import listed
from navcore.io.imu_columns import DIMENSIONS, ImuColumn, imu_column
from navcore.io.times.counts import EPOCHS, zero_of
from navcore.io.times.named_counts import named_count
from navcore.io.written_units import UNITS, unit_of, written

LARGEST_MAP_BYTES = 65536
GPS_WEEK = "gps_week_s"
ISO = "iso"
_SCALE = re.compile(r"\s*\d{1,9}(?:\.\d{0,15})?(?:[eE][+-]?\d{1,2})?\s+(?=\S)")
_OFFSET = re.compile(r"(?:UTC|GMT)?([+-])(\d\d?)(?::?(\d\d))?")


class TimeMap(Parameters):
    """Where the time stands.

    Parameters
    ----------
    column : str or list of str
        Name in the header; several are joined by a space (date and time, GPS week and seconds).
    unit : str
        ``iso``; ``s``, ``ms``, ``us``, ``ns``, ``min``, ``h`` or ``day``, of Unix time or of the file's own
        zero; with an epoch, ``days since 1899-12-30`` or ``mjd``; ``gps_week_s``; or a format of
        `datetime.strptime`.
        Empty: as it would be guessed.
    epoch : str
        From which the numbers count: a date, or a name such as ``excel``, ``matlab``, ``gps``, ``ntp``.
        Empty: by the size of the numbers.
    zone : str
        Of dates and times that state none: ``Europe/Berlin``, ``+02:00``. Empty: UTC.
    """

    column: str | tuple[str, ...]
    unit: str = ""
    zone: str = ""
    epoch: str = ""

    @property
    def zero(self) -> str:
        """Epoch of counts, from either field; empty without one."""
        return self.epoch.strip() or self._since[1]

    @property
    def _since(self) -> tuple[str, str]:
        """Unit and epoch of ``days since 1970-01-01`` and of names such as ``mjd``."""
        named = named_count(self.unit)
        if named is not None:
            return named.unit, named.epoch
        unit, _, epoch = self.unit.partition(" since ")
        return unit.strip(), epoch.strip()

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the columns, in their order."""
        return (self.column,) if isinstance(self.column, str) else self.column

    @property
    def stated(self) -> bool:
        """Whether the map says how the time is written; else it is guessed."""
        return bool(self.unit or self.zone or self.epoch)

    @property
    def numeric(self) -> str:
        """Key of `UNITS` for a column of numbers; empty for others."""
        return unit_of(plain_name(self._since[0]), "time") if "%" not in self.unit else ""


class QuantityMap(Parameters):
    """Where a quantity stands.

    Parameters
    ----------
    column : str
        Name in the header.
    unit : str
        Of its numbers, after a number that counts are multiplied by (``0.1 arcsec``); empty: that of the
        quantity's own name (``heading_deg``) or of the column's.
    sign : int
        1, or -1 for a column that counts the other way.
    """

    column: str
    unit: str = ""
    sign: Literal[1, -1] = 1

    @property
    def factor(self) -> float:
        """Sign, times the number before the unit."""
        scale = _SCALE.match(self.unit)
        return float(self.sign) * (float(scale[0]) if scale else 1.0)

    @property
    def bare_unit(self) -> str:
        """Unit without the number before it."""
        scale = _SCALE.match(self.unit)
        return self.unit[scale.end() :] if scale else self.unit


class ColumnMap(Parameters):
    r"""Meaning of the columns of one kind of table.

    Parameters
    ----------
    time : TimeMap
    quantity : dict of QuantityMap
        By the name of a known column: ``lat_deg``, ``speed``, ``gx_rad_s``.
    decimal : {".", ","}
    delimiter : str
        One character; ``\t`` for tabs, a space for any white space. Empty: as it would be guessed.
    skip_bad_rows : bool
        Leave out rows that cannot be read and count them; else they are faults.
    """

    time: TimeMap
    quantity: dict[str, QuantityMap] = Field(min_length=1, max_length=40)
    decimal: Literal[".", ","] = "."
    delimiter: str = Field(default="", max_length=1)
    skip_bad_rows: bool = False

    @cached_property
    def is_imu(self) -> bool:
        """Whether the quantities are those of an IMU."""
        return any(imu_column(0, name) is not None for name in self.quantity)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all columns that the map uses."""
        return (*self.time.columns, *(entry.column for entry in self.quantity.values()))

    def places(self, where: str, header: list[str]) -> dict[str, int]:
        """Place of each mapped column; raises `InputError` that names those the table does not hold."""
        held = {name.strip(): index for index, name in reversed(list(enumerate(header)))}
        faults = [
            Fault(
                where,
                "map",
                name,
                Text("is no column of the file; columns found: {held}", held=listed(header)),
            )
            for name in self.names
            if name.strip() not in held
        ]
        if faults:
            raise InputError(faults)
        return {name: held[name.strip()] for name in self.names}

    def clocks(self, where: str, header: list[str]) -> list[int]:
        """Places of the columns of time."""
        places = self.places(where, header)
        return [places[name] for name in self.time.columns]

    def log_columns(self, where: str, header: list[str]) -> dict[str, tuple[Column, float]]:
        """Columns of a log with their signs, by what they hold; the time is not among them."""
        places = self.places(where, header)
        return {
            stem: (Column(places[e.column], e.column, stem, unit), e.factor)
            for name, e in self.quantity.items()
            for stem, unit in [_meant(name, e)]
        }

    def imu_columns(self, where: str, header: list[str]) -> dict[tuple[str, str], ImuColumn]:
        """Columns of an IMU by kind and axis."""
        places = self.places(where, header)
        found: dict[tuple[str, str], ImuColumn] = {}
        for name, entry in self.quantity.items():
            meant = imu_column(0, name)
            assert meant is not None  # checked by `parse_map`
            unit = _imu_unit(meant, entry)
            found[meant.kind, meant.axis] = ImuColumn(
                places[entry.column], entry.column, meant.kind, meant.axis, unit, sign=entry.factor
            )
        return found


def map_field() -> Any:
    """Declare the field ``map`` that stands beside a block's ``file``."""
    return Field(
        default=None,
        description=Text("Map (TOML) that says what the columns of a text table mean: docs/import.md."),
        json_schema_extra={"label": Text("map of columns")},
    )


def read_map(path: str | os.PathLike[str], field: str = "map") -> ColumnMap:
    """Read a map.

    Raises
    ------
    InputError
        No such file, no regular file, no TOML, or a field that is wrong: names it, its value and what is
        allowed.
    """
    file = Path(path)
    try:
        text = read_bytes(file, LARGEST_MAP_BYTES).decode("utf-8-sig")
    except TooLargeError:
        allowed = Text("is larger than {most} bytes: no map", most=LARGEST_MAP_BYTES)
        raise InputError(Fault("", field, str(path), allowed)) from None
    except (OSError, ValueError) as problem:
        why = getattr(problem, "strerror", None) or Text("is not UTF-8 text: no map")
        raise InputError(Fault("", field, str(path), why)) from None
    return parse_map(text, file.name)


def map_beside(path: str | os.PathLike[str]) -> Path | None:
    """Map that is saved beside a recording under its name and `MAP_SUFFIX`; None where there is none."""
    beside = Path(f"{os.fspath(path)}{MAP_SUFFIX}")
    return beside if os.path.isfile(beside) else None  # no path is too odd to be asked for


def parse_map(text: str, where: str) -> ColumnMap:
    """Parse the text of a map; raises `InputError` as `read_map` does."""
    try:
        data = read_toml_text(text, where)
    except InputError:
        raise
    except (RecursionError, ValueError) as problem:
        raise InputError(Fault(where, "", None, Text("not TOML ({problem})", problem=str(problem)))) from None
    try:
        found = ColumnMap.model_validate(data)
    except ValidationError as error:
        raise InputError(faults_from(error, ColumnMap, data, where)) from None
    faults = [*_time_faults(found.time, where), *_quantity_faults(found, where)]
    if faults:
        raise InputError(faults)
    return found


def zone_of(name: str) -> ZoneInfo | float:
    """Zone of a name, or the offset in s of one such as ``+02:00``; raises ValueError for neither."""
    offset = _OFFSET.fullmatch(name.strip())
    if offset:
        seconds = int(offset[2]) * 3600.0 + int(offset[3] or 0) * 60.0
        if seconds > 15 * 3600.0:
            raise ValueError(name)
        return -seconds if offset[1] == "-" else seconds
    try:
        return ZoneInfo(name)
    except (KeyError, OSError) as problem:  # no such file, or a folder of the database
        raise ValueError(name) from problem


def _time_faults(time: TimeMap, where: str) -> list[Fault]:
    faults: list[Fault] = []
    if time.zone:
        try:
            zone_of(time.zone)
        except ValueError:
            allowed = Text("must be a time zone such as Europe/Berlin, or an offset such as +02:00")
            faults.append(Fault(where, "time.zone", time.zone, allowed))
        if time.numeric or time.unit == GPS_WEEK:
            allowed = Text("must be left out: counts of {unit} have no time zone", unit=time.unit)
            faults.append(Fault(where, "time.zone", time.zone, allowed))
    if time.zero:
        try:
            zero_of(time.zero)
        except ValueError:
            allowed = Text("must be a date such as 1899-12-30, or one of {names}", names=", ".join(EPOCHS))
            faults.append(Fault(where, "time.epoch", time.zero, allowed))
        if time.unit and not time.numeric:
            allowed = Text("must be left out: times of the form {unit} have a date", unit=time.unit)
            faults.append(Fault(where, "time.epoch", time.zero, allowed))
    if not (time.unit in ("", ISO, GPS_WEEK) or time.numeric or "%" in time.unit):
        allowed = Text(
            "must be iso, {units}, gps_week_s, or a format such as %d.%m.%Y %H:%M:%S",
            units=", ".join(UNITS["time"]),
        )
        faults.append(Fault(where, "time.unit", time.unit, allowed))
    return faults


def _quantity_faults(found: ColumnMap, where: str) -> list[Fault]:
    faults: list[Fault] = []
    meanings: list[object] = []
    for name, entry in found.quantity.items():
        field = f"quantity.{name}"
        meant = imu_column(0, name) if found.is_imu else known_columns([name])
        stem = next((stem for stem in meant if stem in QUANTITIES), "") if isinstance(meant, dict) else ""
        if not meant or (isinstance(meant, dict) and not stem):
            known = (
                "gx_rad_s, gy_rad_s, gz_rad_s, fx_mps2, fy_mps2, fz_mps2, dax_rad ... dvz_mps"
                if found.is_imu
                else ", ".join(QUANTITIES)
            )
            faults.append(
                Fault(where, field, None, Text("is no known quantity; known: {known}", known=known))
            )
            continue
        meanings.append((meant.kind, meant.axis) if isinstance(meant, ImuColumn) else stem)
        dimension = DIMENSIONS[meant.kind] if isinstance(meant, ImuColumn) else QUANTITIES[stem].dimension
        unit = _imu_unit(meant, entry) if isinstance(meant, ImuColumn) else _meant(name, entry)[1]
        if not unit:
            allowed = Text("must be one of {units}", units=", ".join(UNITS[dimension]))
            faults.append(Fault(where, f"{field}.unit", entry.unit or None, allowed))
        if meanings.count(meanings[-1]) > 1:
            faults.append(Fault(where, field, None, Text("is given twice")))
    return faults


def _unit(text: str, dimension: str) -> str:
    """Key of `UNITS` for a unit as users write it; empty when it is none of this dimension."""
    said = written([text], dimension)
    return said.unit if said.dimension == dimension else ""


def _meant(name: str, entry: QuantityMap) -> tuple[str, str]:
    """Meaning of a quantity's name, and the unit of its column; empty when it is not known."""
    stem, column = next((s, c) for s, c in known_columns([name]).items() if s in QUANTITIES)
    if entry.unit:
        return stem, _unit(entry.bare_unit, QUANTITIES[stem].dimension)
    if column.unit_given and plain_name(name) not in QUANTITIES[stem].names:
        return stem, column.unit
    said = known_columns([entry.column]).get(stem)
    if said is not None and said.unit_given and not said.unknown:
        return stem, said.unit
    return stem, column.unit if column.unit_given else ""


def _imu_unit(meant: ImuColumn, entry: QuantityMap) -> str:
    if entry.unit:
        return _unit(entry.bare_unit, DIMENSIONS[meant.kind])
    said = imu_column(0, entry.column)
    return meant.unit or (said.unit if said and said.kind == meant.kind else "")
