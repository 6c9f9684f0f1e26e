"""Columns of numbers of time: which epoch and unit they count from, by the column's name and the numbers."""

import re

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.io.column_names import SECONDS, UNIX, Column, count_of, plain_name
from navcore.io.times.counts import (
    Ambiguous,
    Times,
    epoch_words,
    gps_to_unix,
    read_counts,
    since,
    unit_words,
    unix_by_size,
)
from navcore.io.times.doubts import is_plausible
from navcore.io.times.named_counts import NamedCount
from navcore.io.written_units import UNITS

_GPS = re.compile(r"(?:^|_)(?:gps|gpst)(?:_|$)")
_LAST_GPS_S = 1.6e9
"""GPS time in s up to 2030; larger numbers under such a name are Unix time."""
_GPS_FROM_S = 1e8


def numeric_times(where: str, column: Column, values: np.ndarray) -> tuple[np.ndarray, bool, list[str]]:
    """Times of a column of numbers, s, whether they are dated (since 1970), and what was assumed.

    Raises
    ------
    InputError
        The numbers may count from several epochs; names the column.
    """
    if column.stem != SECONDS and _GPS.search(plain_name(column.name)):
        found = _gps_times(column, values)
        if found is not None:
            return found
    if column.stem != SECONDS and (count := count_of(column)) is not None:
        return _named_times(where, column, values, count)
    if column.stem == UNIX and not column.unit:
        return unix_by_size(values), True, []
    if column.stem == SECONDS and not column.unit:
        return values, False, []
    found = _counted(where, column, values, column.unit or ("s" if column.stem == SECONDS else ""))
    if column.stem == SECONDS:
        return (values if not column.unit else found.time_s), False, []
    told: list[str] = (
        [Text("column {name} counts {what}", name=column.name, what=found.told)] if found.told else []
    )
    return found.time_s, found.dated, told


def _counted(where: str, column: Column, values: np.ndarray, unit: str) -> Times:
    """Times of numbers of a unit, if it is known, by their size; raises `InputError` where several fit."""
    try:
        return read_counts(values, unit)
    except Ambiguous as either:
        allowed = Text(
            "may count {either}: name the unit, as in time (s), give ISO 8601, or say time.unit and "
            "time.epoch by "
            "a map",
            either=str(either),
        )
        first = values[~np.isnan(values)][0]
        raise InputError(Fault(where, column.name, float(first), allowed)) from None


def _named_times(
    where: str, column: Column, values: np.ndarray, count: NamedCount
) -> tuple[np.ndarray, bool, list[str]]:
    """Times of a column whose name says what it counts, where that gives dates that can be; else by size."""
    unit = column.unit or count.unit
    if count.epoch and values.size:
        time_s = since(values, UNITS["time"][unit], count.epoch)
        if is_plausible(np.array([np.nanmedian(time_s)]))[0]:
            told = Text("{unit} since {epoch}", unit=unit_words(unit), epoch=epoch_words(count.epoch))
            return time_s, True, [Text("column {name} counts {what}", name=column.name, what=told)]
    found = _counted(where, column, values, unit)
    if found.dated:
        told = found.told or Text("{unit} since {epoch}", unit=unit_words(unit), epoch="1970")
        return found.time_s, True, [Text("column {name} counts {what}", name=column.name, what=told)]
    told = Text(
        "column {name} counts days from a zero that is not known, such as those of a year: read without a "
        "date. Add a column year, or say time.epoch by a map (2023-12-31 for days of 2024)",
        name=column.name,
    )
    return found.time_s, False, [told]


def _gps_times(column: Column, values: np.ndarray) -> tuple[np.ndarray, bool, list[str]] | None:
    """Times of a column that is named after GPS; None where the numbers are too small for a date."""
    seconds = values.copy()
    if column.unit:
        seconds = values * UNITS["time"][column.unit]
    elif np.isfinite(np.nanmedian(values)):
        while abs(float(np.nanmedian(seconds))) >= _GPS_FROM_S * 1e3:
            seconds = seconds / 1e3
    middle = float(np.nanmedian(seconds)) if seconds.size else np.nan
    if not abs(middle) >= _GPS_FROM_S:
        return None
    if middle > _LAST_GPS_S:
        told = Text("column {name} is taken as Unix time: as GPS time it lies after 2030", name=column.name)
        return seconds, True, [told]
    told = Text(
        "column {name} is taken as GPS time, s since 1980-01-06: leap seconds removed", name=column.name
    )
    return gps_to_unix(seconds), True, [told]
