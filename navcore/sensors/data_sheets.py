"""Sensors and logs by name: figures as their makers publish them, each with its unit and source."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any, Literal

from navcore.foundation.assets import asset_path
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import UNITS

Block = Literal["imu", "reference"]
_FOOT = 0.3048
_GRAVITY = 9.80665
_PUBLISHED = {
    "deg/h": ("deg/h", 1.0),
    "deg/sqrt(h)": ("deg/sqrt(h)", 1.0),
    # a density of 1 deg/s/sqrt(Hz) is a walk of 60 deg in an hour
    "deg/s/sqrt(Hz)": ("deg/sqrt(h)", 60.0),
    "ug": ("ug", 1.0),
    "mg": ("ug", 1000.0),
    "ug/sqrt(Hz)": ("ug/sqrt(Hz)", 1.0),
    "mg/sqrt(Hz)": ("ug/sqrt(Hz)", 1000.0),
    # a walk of 1 m/s in an hour is a density of 1/60 m/s^2/sqrt(Hz)
    "m/s/sqrt(h)": ("ug/sqrt(Hz)", 1e6 / (60.0 * _GRAVITY)),
    "ft/s/sqrt(h)": ("ug/sqrt(Hz)", 1e6 * _FOOT / (60.0 * _GRAVITY)),
    "m/s": ("m/s", 1.0),
    "cm/s": ("m/s", 0.01),
    "mm/s": ("m/s", 0.001),
    "kn": ("m/s", UNITS["kn"]),
}
"""Unit of the scenario's field for a published unit, and what 1 is in it."""
_NEEDED: dict[Block, tuple[tuple[str, ...], ...]] = {
    "imu": (
        ("gyro_bias_std_dph", "gyro_bias_dph", "gyro_instability_dph"),
        ("gyro_arw_dpsh",),
        ("accel_bias_std_ug", "accel_bias_ug", "accel_instability_ug"),
        ("accel_vrw_ugpshz",),
    ),
    "reference": (("bias_std_mps", "bias_mps", "noise_mps", "drift_mps"),),
}
"""Fields without which a part says too little: one of each row must be stated, or given beside the part."""


@dataclass(frozen=True)
class Figure:
    """One published figure.

    Attributes
    ----------
    words : str
        What it is, in the maker's words.
    value, unit : float, str
        As published.
    field : str
        Field of the block that it gives; empty where it is only shown.
    """

    words: str
    value: float
    unit: str
    field: str = ""

    @property
    def in_field(self) -> float:
        """Value in the unit of the field."""
        return float(f"{self.value * _PUBLISHED[self.unit][1]:.6g}")


@dataclass(frozen=True)
class DataSheet:
    """One part and its figures.

    Attributes
    ----------
    name : str
    block : {"imu", "reference"}
        Block of a scenario that it fills.
    grade, source : str
        Class, and what states the figures.
    figures : tuple of Figure
    """

    name: str
    block: Block
    grade: str
    source: str
    figures: tuple[Figure, ...]

    @property
    def values(self) -> dict[str, float]:
        """Values of the block's fields."""
        return {figure.field: figure.in_field for figure in self.figures if figure.field}

    def absent(self, beside: frozenset[str] = frozenset()) -> list[str]:
        """Fields that a scenario needs and that are neither stated nor given beside; of several the first."""
        known = {*self.values} | beside
        return [row[0] for row in _NEEDED[self.block] if known.isdisjoint(row)]

    def document(self) -> dict[str, Any]:
        """Entry of ``schuler parts --json``."""
        return {
            "name": self.name,
            "block": self.block,
            "grade": self.grade,
            "source": self.source,
            "figures": [
                {
                    "figure": one.words,
                    "value": one.value,
                    "unit": one.unit,
                    "field": one.field or None,
                    "in_field": one.in_field if one.field else None,
                }
                for one in self.figures
            ],
            "absent": self.absent(),
        }


@dataclass(frozen=True)
class Grade:
    """What a review means by a grade.

    Attributes
    ----------
    name, source : str
    figures : tuple of str
        None where no source was found.
    """

    name: str
    source: str
    figures: tuple[str, ...]

    def document(self) -> dict[str, Any]:
        """Entry of ``schuler parts --json``."""
        return {"name": self.name, "source": self.source or None, "figures": [*self.figures]}


@cache
def _read() -> tuple[dict[str, DataSheet], tuple[Grade, ...]]:
    data = tomllib.loads(asset_path("parts.toml").read_text("utf-8"))
    sheets = [
        DataSheet(
            one["name"],
            one["block"],
            one["grade"],
            one["source"],
            tuple(
                Figure(row["words"], float(row["value"]), row["unit"], row.get("field", ""))
                for row in one["figures"]
            ),
        )
        for one in data["part"]
    ]
    grades = (Grade(one["name"], one["source"], tuple(one["figures"])) for one in data["grade"])
    return {sheet.name: sheet for sheet in sheets}, tuple(grades)


def data_sheets() -> dict[str, DataSheet]:
    """All parts by name."""
    return _read()[0]


def grades() -> tuple[Grade, ...]:
    """Grades in order, the best first."""
    return _read()[1]


def names_of(block: Block) -> tuple[str, ...]:
    """Names of the parts of a block."""
    return tuple(sheet.name for sheet in data_sheets().values() if sheet.block == block)


def with_part(data: Any, block: Block) -> Any:
    """Return the raw mapping of a block with the figures of the part that it names; a given field wins.

    Parameters
    ----------
    data : object
        As read; anything but a mapping with a known ``part`` is left as it is.
    block : {"imu", "reference"}
        Which block it is.

    Raises
    ------
    InputError
        The part states too little, and what it lacks is not given beside it.
    """
    name = data.get("part") if isinstance(data, dict) else None
    sheet = data_sheets().get(name) if isinstance(name, str) else None
    if sheet is None or sheet.block != block:
        return data
    given = frozenset(key for key, value in data.items() if value is not None)
    if absent := sheet.absent(given):
        allowed = Text(
            "does not state {fields}: give it beside the part ({source})",
            fields=", ".join(absent),
            source=sheet.source,
        )
        raise InputError(Fault("", "part", name, allowed))
    return sheet.values | {key: value for key, value in data.items() if value is not None}


def differing(block: Any, sheet: DataSheet) -> Iterator[str]:
    """Yield the fields of a block that differ from the figures of its part."""
    for field, value in sheet.values.items():
        own = getattr(block, field)
        if own is None or not math.isclose(float(own), value, rel_tol=1e-9):
            yield field
