"""Dates and times in several columns: year, month, day, hour, minute, second; or year and day of the year."""

from collections.abc import Mapping, Sequence

import numpy as np

_NAMES = {
    "year": "year yyyy yy yr utc_year jahr annee ano",
    "month": "month mon mm mo utc_month monat mois mes",
    "day": "day dd utc_day tag jour dia",
    "doy": "doy day_of_year dayofyear jday julian_day julday jul_day yday yearday year_day jd_day "
    "decimal_doy decimal_day decimal_yearday tag_des_jahres",
    "hour": "hour hours hh hr utc_hour stunde",
    "minute": "minute minutes min mi mm nn utc_minute",
    "second": "second seconds sec ss s utc_second sekunde seconde",
    "second_of_day": "second_of_day seconds_of_day sec_of_day secs_of_day sod seconds_since_midnight",
}
_STAMPS = {
    "seconds": "stamp_sec stamp_secs header_stamp_sec header_stamp_secs",
    "nanoseconds": "stamp_nanosec stamp_nanosecs stamp_nsec stamp_nsecs header_stamp_nanosec "
    "header_stamp_nanosecs header_stamp_nsec header_stamp_nsecs",
}
"""Parts of the stamp of a ROS message."""
_KNOWN = {part: frozenset(names.split()) for part, names in _NAMES.items()}
_LAYOUTS = (
    ("year", "doy", "second_of_day"),
    ("year", "doy", "hour", "minute", "second"),
    ("year", "month", "day", "hour", "minute", "second"),
    ("year", "month", "day", "second_of_day"),
    ("year", "doy", "hour", "minute"),
    ("year", "month", "day", "hour", "minute"),
    ("year", "doy"),
)
"""Parts that together are a time, the finer first."""
_SIZES_S = {"hour": 3600.0, "minute": 60.0, "second": 1.0, "second_of_day": 1.0}
_DAY_S = 86400.0


def part_columns(names: Sequence[str]) -> dict[str, int]:
    """Places of the columns that together are a time, by part, in plain names; empty where they are none."""
    places: dict[str, int] = {}
    for index, name in enumerate(names):
        part = next((part for part, known in _KNOWN.items() if name in known and part not in places), "")
        if part:
            places[part] = index
    layout = next((layout for layout in _LAYOUTS if places.keys() >= set(layout)), ())
    return {part: places[part] for part in layout}


def stamp_columns(names: Sequence[str]) -> dict[str, int]:
    """Places of the seconds and nanoseconds of a ROS stamp, in plain names; empty where one is missing."""
    found = {
        part: next((i for i, name in enumerate(names) if name.endswith(tuple(known.split()))), -1)
        for part, known in _STAMPS.items()
    }
    return {} if -1 in found.values() else found


def times_of_parts(parts: Mapping[str, np.ndarray]) -> np.ndarray:
    """Unix time in s, shape (n,), of the parts, each of shape (n,); NaN where they are no date.

    A day of the year may have a fraction, where nothing finer stands beside it.
    """
    if "nanoseconds" in parts:
        return parts["seconds"] + 1e-9 * parts["nanoseconds"]
    year = np.where(parts["year"] < 100.0, parts["year"] + 2000.0, parts["year"])
    day = parts.get("doy", parts.get("day", np.ones(year.size)))
    month = parts.get("month", np.ones(year.size))
    good = (
        (year >= 1900.0) & (year <= 9999.0) & (month >= 1.0) & (month <= 12.0) & (day >= 1.0) & (day < 367.0)
    )
    months = np.where(good, (year - 1970.0) * 12.0 + month - 1.0, 0.0).astype("int64")
    begin = months.astype("datetime64[M]").astype("datetime64[s]").astype(float)
    rest = sum(size * parts[part] for part, size in _SIZES_S.items() if part in parts)
    return np.where(good, begin + (day - 1.0) * _DAY_S + rest, np.nan)
