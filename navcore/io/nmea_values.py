"""Values of fields of NMEA 0183 sentences in SI: NaN where not given, infinite where they make no sense."""

import math
import re
from collections.abc import Callable
from functools import lru_cache

from navcore.io.stamps import midnight

_TIME = re.compile(r"(?:[01]\d|2[0-3])[0-5]\d[0-5]\d(?:\.\d*)?")
_DEGREES = re.compile(r"(\d+)(\d\d\.\d+)")


def _remembered(value: Callable[..., float]) -> Callable[..., float]:
    """Value of fields, infinite when they make no sense.

    Fields repeat: a second stands in several sentences, and instruments round.
    """

    @lru_cache(maxsize=4096)
    def sensible(*fields: str) -> float:
        try:
            return value(*fields)
        except (ValueError, OverflowError):
            return math.inf

    return sensible


def number(field: str) -> float:
    """Number in any form that `float` reads; infinite for what is none."""
    try:
        found = float(field)
    except ValueError:
        return math.inf
    return math.inf if math.isnan(found) else found


def seconds_of(field: str) -> float:
    """Time ``hhmmss`` or ``hhmmss.sss``, s."""
    return int(field[:2]) * 3600.0 + int(field[2:4]) * 60.0 + float(field[4:])


@_remembered
def time_of_day(field: str) -> float:
    """UTC of a standard sentence, s: a time that a clock can show."""
    if _TIME.fullmatch(field) is None:
        raise ValueError(f"{field} is no time")
    return seconds_of(field)


@_remembered
def makers_time(field: str) -> float:
    """UTC of a maker's sentence, s; other sentences of the maker do not begin with digits."""
    return seconds_of(field) if field[:6].isdigit() else math.nan


@_remembered
def day(field: str) -> float:
    """UTC midnight of an optional ``ddmmyy``, s since 1970."""
    if field == "":
        return math.nan
    if len(field) != 6 or not field[4:].isdigit():
        raise ValueError(f"{field} is no date")
    return midnight(int(field[4:]), int(field[2:4]), int(field[:2]))


@_remembered
def date(day: str, month: str, year: str) -> float:
    """UTC midnight, s since 1970."""
    return midnight(int(year), int(month), int(day))


@_remembered
def degrees(field: str) -> float:
    """Angle of degrees and minutes, ``dddmm.mmmm``."""
    if field == "0":
        return 0.0
    parts = _DEGREES.fullmatch(field)
    return int(parts[1]) + float(parts[2]) / 60.0 if parts else math.inf
