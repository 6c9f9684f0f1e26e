"""Angles of a table that are in radians though no name says so: found by what the columns say of each other.

Positions in radians move 57.3 times as slowly as those in degrees, and headings in radians stand far from the
course of the track. Where that decides it, radians are taken; where nothing does, it is told.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from navcore.foundation.text import Text
from navcore.foundation.units import DEG
from navcore.io.column_names import names_unit
from navcore.io.courses import Way, angle_off, legs_of
from navcore.io.series import Series
from navcore.io.table_times import Table

_LARGEST = {"lat": 0.5 * np.pi, "lon": 2.0 * np.pi, "heading": 2.0 * np.pi, "cog": 2.0 * np.pi}
"""Angles that may show which unit they are in, and their largest size in rad."""
_FOLLOWING = ("pitch", "roll")
"""Angles that are as the others are."""
_DIRECTIONS = ("heading", "cog")
_ROUNDING = 0.01
_FASTEST_MPS = 60.0
"""Positions that move faster in radians are none."""
_SLOWEST_MPS = 0.25
"""A slower speed decides nothing."""
_NEAR, _FAR = 2.5, 10.0
"""Factors within which a speed agrees with the track, and beyond which it contradicts it."""
_LEAST_TURN_RAD = 0.5 * np.pi
"""A heading without positions that spans less, as rad, is steady in degrees as likely."""
_LARGEST_SHARE = 0.2
_LEAST_OFF_RAD = 15.0 * DEG


class Verdict(NamedTuple):
    """Whether the angles are in radians, None where nothing decides it, and what decided."""

    radians: bool | None
    by: str = ""


def with_radians(table: Table) -> Table:
    """Table whose angles are in rad where they are; says what was taken, or that nothing decides it."""
    bare = {
        stem: values
        for stem in (*_LARGEST, *_FOLLOWING)
        if stem in table.values and not names_unit(table.columns[stem])
        if (values := _known(table, stem)).size
    }
    fitting = [stem for stem in bare if stem in _LARGEST and _fits(stem, bare[stem])]
    if table.units_stated or not fitting:
        return table
    placed = {"lat", "lon"} <= set(fitting)
    if {"lat", "lon"} & bare.keys() and not placed:
        return table  # positions in degrees: a heading in radians is found by its course
    if not placed and all(np.ptp(bare[stem]) < _LEAST_TURN_RAD for stem in fitting):
        return table
    verdict = _verdict(table, [stem for stem in fitting if stem in _DIRECTIONS]) if placed else Verdict(None)
    if verdict.radians is None and table.kind.startswith("MAT") and set(bare) & set(_LARGEST) == set(fitting):
        verdict = Verdict(True, Text("which all values fit, as MATLAB has them"))
    if verdict.radians is False:
        return table
    if verdict.radians is None:
        return replace(table, warnings=(*table.warnings, _undecided(table, fitting)))
    taken = [*fitting, *(stem for stem in _FOLLOWING if stem in bare)]
    told = Text(
        "angles without a unit are taken as radians, {by}: {names}",
        by=verdict.by,
        names=", ".join(table.columns[stem].name for stem in taken),
    )
    columns = table.columns | {stem: replace(table.columns[stem], unit="rad") for stem in taken}
    return replace(table, columns=columns, warnings=(*table.warnings, told))


def _known(table: Table, stem: str) -> np.ndarray:
    """Values of a column that are not missing."""
    return table.values[stem][~np.broadcast_to(table.missing.get(stem, False), table.time_s.shape)]


def _fits(stem: str, values: np.ndarray) -> bool:
    return bool(np.abs(values).max() <= _LARGEST[stem] + _ROUNDING)


def _verdict(table: Table, directions: Sequence[str]) -> Verdict:
    """What speeds and directions say of positions that may be in either unit."""
    in_degrees, in_radians = (_legs(table, unit) for unit in (DEG, 1.0))
    if in_degrees is None or in_radians is None:
        return Verdict(None)
    moved = [float(np.median(np.hypot(way.east, way.north))) for way in (in_degrees, in_radians)]
    if moved[1] > _FASTEST_MPS:
        return Verdict(False)
    for what, given in _speeds(table):
        if given < _SLOWEST_MPS:
            continue
        as_degrees, as_radians = (given / max(one, 1e-9) for one in moved)
        if 1.0 / _NEAR <= as_radians <= _NEAR and as_degrees > _FAR:
            return Verdict(True, Text("with which {what} agrees", what=what))
        if 1.0 / _FAR <= as_degrees <= _FAR:
            return Verdict(False)
    course = np.arctan2(in_radians.east, in_radians.north)
    for stem in directions if moved[1] > _SLOWEST_MPS else ():
        whole = ~np.broadcast_to(table.missing.get(stem, False), table.time_s.shape)
        at = np.clip(np.searchsorted(table.time_s[whole], in_radians.time_s), 0, int(whole.sum()) - 1)
        angle = table.values[stem][whole][at]
        off = [angle_off(angle * unit, course) for unit in (DEG, 1.0)]
        if off[0] > _LEAST_OFF_RAD and off[1] < _LARGEST_SHARE * off[0]:
            return Verdict(True, Text("with which {name} follows the track", name=table.columns[stem].name))
    return Verdict(None)


def _legs(table: Table, unit: float) -> Way | None:
    """Velocity of the positions, read in a unit."""
    whole = ~(_missing(table, "lat") | _missing(table, "lon"))
    values = np.column_stack([table.values["lat"], table.values["lon"]])[whole] * unit
    time_s = table.time_s[whole].copy()
    return legs_of(Series(time_s, values, np.ones(time_s.size, bool), table.where, ""))


def _missing(table: Table, stem: str) -> np.ndarray:
    return np.broadcast_to(table.missing.get(stem, False), table.time_s.shape)


def _speeds(table: Table) -> Sequence[tuple[str, float]]:
    """Name and median of each speed, m/s, those over ground first."""
    found: list[tuple[str, float]] = []
    for stem in ("sog", "ground", "speed"):
        if stem in table.values and (known := _known(table, stem)).size:
            size = float(np.median(np.abs(known))) * table.columns[stem].factor
            found.append((table.columns[stem].name, size))
    if {"ve", "vn"} <= table.values.keys():
        east, north = (
            np.where(_missing(table, stem), 0.0, table.values[stem]) * table.columns[stem].factor
            for stem in ("ve", "vn")
        )
        found.insert(0, (table.columns["ve"].name, float(np.median(np.hypot(east, north)))))
    return found


def _undecided(table: Table, fitting: Sequence[str]) -> str:
    first = table.columns[fitting[0]].name
    return Text(
        "{names}: no unit is named, and all values would fit radians too: taken as degrees. If they are "
        "radians, say so in the names, as in {first}_rad, or by a map",
        names=", ".join(table.columns[stem].name for stem in fitting),
        first=first,
    )
