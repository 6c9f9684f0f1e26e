"""Attributes of NetCDF and HDF5 variables by the CF conventions: names, units, scales, epochs."""

from __future__ import annotations

import re
from collections.abc import Mapping
from datetime import UTC, datetime
from typing import Any

import numpy as np

from navcore.foundation.text import Text
from navcore.io.column_names import QUANTITIES, known_columns, plain_name
from navcore.io.times.counts import EPOCHS, GPS_EPOCH_S, gps_to_unix
from navcore.io.times.named_counts import named_count
from navcore.io.written_units import UNITS, unit_of

_SINCE = re.compile(r"\s*([A-Za-z]{1,20})\s+(?:since|after|from)\s+(.{4,60})", re.IGNORECASE)
_ZONE = re.compile(r"\s*(?:UTC|GMT|Z|[+-]?0{1,2}:?0{2})\s*$", re.IGNORECASE)
_DATE = re.compile(
    r"(?P<y>\d{1,4})-(?P<mo>\d{1,2})-(?P<d>\d{1,2})"
    r"(?:[T ]+(?P<h>\d{1,2})(?::(?P<m>\d{1,2})(?::(?P<s>\d{1,2}(?:\.\d*)?))?)?)?"
)
_JULIAN = re.compile(r"-471[23]-(?:0?1-0?1|11-24)(?:[T ]+12(?::?00?){0,2})?")
"""Zero of Julian dates in the Julian or the Gregorian calendar."""
_GPS = re.compile(r"(?<![a-z])gps(?:t|time)?(?![a-z])", re.IGNORECASE)
_UTC = re.compile(r"\butc\b", re.IGNORECASE)
_SAID_IN = ("long_name", "standard_name", "units", "comment", "description", "timescale", "time_scale",
            "time_system", "time_reference")  # fmt: skip
"""Attributes that may say that a time is GPS time."""
_CALENDARS = frozenset(("", "standard", "gregorian", "proleptic_gregorian", "none"))


def text_of(value: Any) -> str:
    """Attribute as text; empty for one that is none."""
    if isinstance(value, np.ndarray):
        value = value.ravel()[0] if value.size else ""
    return (
        value.decode("utf-8", "replace")
        if isinstance(value, bytes)
        else value
        if isinstance(value, str)
        else ""
    )


def name_of(variable: str, attributes: Mapping[str, Any]) -> str:
    """Name of a column: the variable, its standard name if only that is known, and its unit."""
    unit, standard = (
        text_of(attributes.get("units", "")).strip(),
        text_of(attributes.get("standard_name", "")).strip(),
    )
    if epoch_of(attributes) is not None:
        return variable if known_columns([variable]) else f"{variable}.time"
    named = variable
    if standard and not known_columns([variable]).keys() & QUANTITIES.keys():
        named = f"{variable}.{standard}"
    return f"{named} [{unit[:30]}]" if unit and not re.search(r"[\[\]()]", unit) else named


def epoch_of(attributes: Mapping[str, Any]) -> tuple[float, float] | None:
    """Unit in s and Unix time of the zero, of ``seconds since 2018-12-06 00:00:00``; None without an epoch.

    Raises
    ------
    ValueError
        Another calendar, or an epoch or unit that is not understood.
    """
    units = text_of(attributes.get("units", ""))
    named = named_count(units)
    if named is not None and named.epoch:
        return UNITS["time"][named.unit], EPOCHS[named.epoch]
    match = _SINCE.fullmatch(units)
    if match is None:
        return None
    calendar = text_of(attributes.get("calendar", "")).strip().lower()
    if calendar not in _CALENDARS:
        raise ValueError(Text("times of the calendar {calendar} are not read", calendar=calendar))
    unit = unit_of(plain_name(match[1]), "time")
    if unit and (julian := _JULIAN.match(match[2].strip())) and _is_utc(match[2].strip()[julian.end() :]):
        return UNITS["time"][unit], EPOCHS["jd"]
    date = _DATE.match(match[2].strip())
    rest = match[2].strip()[date.end() :] if date else ""
    if not unit or date is None or not _is_utc(rest):
        raise ValueError(Text("the unit of time {units} is not understood", units=units))
    second = float(date["s"] or 0.0)
    moment = datetime(*(int(date[k] or 0) for k in ("y", "mo", "d", "h", "m")), tzinfo=UTC)
    return UNITS["time"][unit], moment.timestamp() + second


def _is_utc(rest: str) -> bool:
    """Whether what stands behind a date is nothing, or UTC."""
    return not rest.strip() or _ZONE.fullmatch(rest) is not None


def _is_gps_time(name: str, attributes: Mapping[str, Any]) -> bool:
    said = " ".join(
        [plain_name(name).replace("_", " "), *(text_of(attributes.get(key, "")) for key in _SAID_IN)]
    )
    return _GPS.search(said) is not None and _UTC.search(said) is None


def clock_note(name: str, attributes: Mapping[str, Any]) -> str:
    """What is assumed of a variable of times with an epoch, GPS time or UTC; empty where nothing is."""
    units = text_of(attributes.get("units", "")).strip()
    try:
        epoch = epoch_of(attributes)
    except ValueError:  # said when the variable is read
        return ""
    if epoch is None:
        return ""
    if named_count(units) is not None:
        return Text("{name} counts {units}", name=name, units=units)
    if _is_gps_time(name, attributes) and epoch[1] == GPS_EPOCH_S:
        return Text("{name} is GPS time, {units}: leap seconds removed", name=name, units=units)
    if _is_gps_time(name, attributes) or epoch[1] == GPS_EPOCH_S:
        return Text(
            "{name}, {units}, is taken as UTC, as the CF conventions have it. If it is GPS time, whole leap "
            'seconds ahead of UTC, say time.epoch = "gps" by a map',
            name=name,
            units=units,
        )
    return ""


def values_of(raw: np.ndarray, attributes: Mapping[str, Any], name: str = "") -> np.ndarray:
    """Numbers of a variable, scaled, NaN where missing or out of range; times with an epoch.

    Returns
    -------
    ndarray
        Floating-point numbers; ``datetime64[us]`` where the attributes give an epoch.
    """
    raw = np.atleast_1d(raw)
    values = raw.astype(float)
    gone = np.zeros(values.shape, bool)
    for name in ("_FillValue", "missing_value"):
        for number in np.ravel(np.asarray(attributes.get(name, []))):
            if np.issubdtype(np.asarray(number).dtype, np.number):
                gone |= raw == number
    low, high = _range(attributes)
    gone |= (values < low) | (values > high)
    values = values * _number(attributes, "scale_factor", 1.0) + _number(attributes, "add_offset", 0.0)
    values[gone] = np.nan
    epoch = epoch_of(attributes)
    if epoch is None:
        return values
    unit, zero = epoch
    if zero == GPS_EPOCH_S and _is_gps_time(name, attributes):
        values, unit, zero = gps_to_unix(values * unit), 1.0, 0.0
    found = np.full(values.shape, np.datetime64("NaT", "us"))
    time_s = values * unit + zero
    known = np.isfinite(time_s) & (np.abs(time_s) < 1e11)
    found[known] = (np.round(time_s[known] * 1e6)).astype(np.int64).astype("datetime64[us]")
    return found


def _range(attributes: Mapping[str, Any]) -> tuple[float, float]:
    both = np.ravel(np.asarray(attributes.get("valid_range", [])))
    if both.size == 2 and np.issubdtype(both.dtype, np.number):
        return float(both[0]), float(both[1])
    return _number(attributes, "valid_min", -np.inf), _number(attributes, "valid_max", np.inf)


def _number(attributes: Mapping[str, Any], name: str, otherwise: float) -> float:
    value = np.ravel(np.asarray(attributes.get(name, [])))
    return float(value[0]) if value.size and np.issubdtype(value.dtype, np.number) else otherwise
