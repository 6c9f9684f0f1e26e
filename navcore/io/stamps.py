"""The time that a data logger writes beside a sentence, in the forms in use on research vessels.

Read are, anywhere in the text beside the sentence (UTC where no zone is given):

- ISO 8601 and its relatives: ``2019-03-26T10:06:31.5Z``, ``2019/03/26 10:06:31``, ``20190326T100631.5Z``,
  ``20190326100631``;
- year and day of the year (Lamont, ``LDS``): ``19+085:10:06:31.512``, ``2019:085:10:06:31.512``;
- ``03/26/2019,10:06:31.512`` (SCS; the month comes first, unless a file proves the contrary),
  ``26.03.2019 10:06:31``, ``26-03-2019 10:06:31``, ``26-Mar-2019 10:06:31``, ``26. März 2019 10:06:31``,
  ``Tue Mar 26 10:06:31 UTC 2019``, with months in English and six further languages;
- Unix time in s, ms, us or ns, also in an NMEA 4 tag block (``c:1553594791``);
- a time of day alone, ``10:06:31.512``: the day then comes from the sentences.

No expression here repeats a group, and every repetition is bounded, so that each is linear in its input.
"""

import re
from collections.abc import Callable, Iterable
from datetime import UTC, datetime
from functools import lru_cache
from typing import NamedTuple

from navcore.io.written_units import unaccented

LONGEST_STAMP = 160
"""Characters next to the sentence in which a stamp is looked for."""
_TIME = (
    r"(?P<h>\d\d?):(?P<m>\d\d):(?P<s>\d\d)(?:\.(?P<f>\d{1,9})|,(?P<g>\d{3}|\d{6})(?!\d))?"
    r"(?P<half> ?[AaPp][Mm]\b)?(?P<zone> ?(?:Z|UTC|GMT)| ?[+-]\d\d:?\d\d(?!\d))?"
)
_GAP = r"[T ,;_\t:]{1,3}"
_MONTHS = {
    name: number
    for number, names in enumerate(
        (
            "jan ene gen", "feb fev", "mar mrz mrt", "apr avr abr", "may mai mag mei maj", "jun juin giu",
            "jul juil lug", "aug aou ago", "sep set", "oct okt ott out", "nov", "dec dez dic des",
        ),
        start=1,
    )
    for name in names.split()
}  # fmt: skip
"""Months by the letters with which they begin, without accents: of English, German, French, Spanish, Italian,
Portuguese, Dutch and the Nordic languages."""
_MONTH = r"(?P<name>[^\W\d_]{3,10})"
_EARLIEST, _LATEST = 631152000.0, 4102444800.0
"""1990 and 2100: a number outside is no Unix time."""
_FARTHEST_ZONE_S = 15 * 3600.0
_DAY = 86400.0


class Stamp(NamedTuple):
    """A stamp that was read.

    Attributes
    ----------
    seconds : float
        UTC, s since 1970, or s after midnight.
    dated : bool
        False for a time of day alone.
    """

    seconds: float
    dated: bool = True


def _calendar(match: re.Match[str], day_first: bool) -> Stamp:
    return Stamp(midnight(int(match["y"]), int(match["mo"]), int(match["d"])) + _clock_s(match))


def _ordinal(match: re.Match[str], day_first: bool) -> Stamp:
    day = int(match["n"])
    if not 1 <= day <= 366:
        raise ValueError(f"{day} is no day of the year")
    return Stamp(midnight(int(match["y"]), 1, 1) + (day - 1) * _DAY + _clock_s(match))


def _either_order(match: re.Match[str], day_first: bool) -> Stamp:
    first, second = int(match["a"]), int(match["b"])
    by_day = day_first or match["sep"] != "/"
    if first > 12 or second > 12:
        by_day = first > 12
    month, day = (second, first) if by_day else (first, second)
    return Stamp(midnight(int(match["y"]), month, day) + _clock_s(match))


def _named(match: re.Match[str], day_first: bool) -> Stamp:
    name = unaccented(match["name"].lower())
    month = _MONTHS.get(name[:4]) or _MONTHS.get(name[:3])
    if month is None:
        raise ValueError(f"{name} is no month")
    return Stamp(midnight(int(match["y"]), month, int(match["d"])) + _clock_s(match))


def _unix(match: re.Match[str], day_first: bool) -> Stamp:
    digits = match["u"]
    seconds = float(digits + (match["f"] or "")) / 10.0 ** (0 if len(digits) < 13 else len(digits) - 10)
    if not _EARLIEST <= seconds <= _LATEST:
        raise LookupError(digits)
    return Stamp(seconds)


def _time_of_day(match: re.Match[str], day_first: bool) -> Stamp:
    return Stamp(_clock_s(match), dated=False)


Reader = Callable[[re.Match[str], bool], Stamp]
_FORMS: tuple[tuple[re.Pattern[str], Reader], ...] = (
    (re.compile(rf"(?<!\d)(?P<y>\d{{4}})[-/.](?P<mo>\d\d?)[-/.](?P<d>\d\d?){_GAP}{_TIME}"), _calendar),
    (re.compile(rf"(?<!\d)(?P<y>\d{{4}}|\d\d)[+:/ -](?P<n>\d{{3}})[:T ,/+-]{_TIME}"), _ordinal),
    (
        re.compile(
            rf"(?<!\d)(?P<a>\d\d?)(?P<sep>[/.-])(?P<b>\d\d?)[/.-](?P<y>\d{{4}}|\d\d)(?!\d){_GAP}{_TIME}"
        ),
        _either_order,
    ),
    (
        re.compile(rf"(?<!\d)(?P<d>\d\d?)(?:\. ?|[- ]){_MONTH}(?:\.? |\.?-)(?P<y>\d{{4}}|\d\d){_GAP}{_TIME}"),
        _named,
    ),
    (re.compile(rf"{_MONTH} (?P<d>\d\d?),? (?P<y>\d{{4}}){_GAP}{_TIME}"), _named),
    (re.compile(rf"{_MONTH} {{1,2}}(?P<d>\d\d?) {_TIME} (?P<y>\d{{4}})(?!\d)"), _named),
    (re.compile(rf"(?<!\d)(?P<y>\d{{4}})(?P<mo>\d\d)(?P<d>\d\d){_GAP}{_TIME}"), _calendar),
    (
        re.compile(
            r"(?<!\d)(?P<y>\d{4})(?P<mo>\d\d)(?P<d>\d\d)[T ,;_-]?(?P<h>\d\d)(?P<m>\d\d)(?P<s>\d\d)"
            r"(?:\.(?P<f>\d{1,9})|(?P<g>\d{3}))?(?P<zone>Z)?(?P<half>)(?!\d)"
        ),
        _calendar,
    ),
    (
        re.compile(r"(?<![\d.])(?P<u>\d{9,10}|\d{13}|\d{16}|\d{19})(?P<f>\.\d{1,9})?(?![\d.])"),
        _unix,
    ),
    (re.compile(rf"(?<![\d:]){_TIME}"), _time_of_day),
)


@lru_cache(maxsize=64)
def midnight(year: int, month: int, day: int) -> float:
    """UTC midnight, s since 1970; a year below 100 lies in 1969 to 2068, as POSIX reads two digits.

    Raises
    ------
    ValueError
        There is no such day.
    """
    century = 2000 if 0 <= year < 69 else 1900 if 69 <= year < 100 else 0
    return datetime(century + year, month, day, tzinfo=UTC).timestamp()


def _clock_s(match: re.Match[str]) -> float:
    hour, minute, second = int(match["h"]), int(match["m"]), int(match["s"])
    half = (match["half"] or "").strip().lower()
    if half:
        hour = hour % 12 + (12 if half == "pm" else 0)
    if hour > 23 or minute > 59 or second > 60:
        raise ValueError(f"{hour}:{minute}:{second} is no time of day")
    fraction = match["f"] or match["g"] or ""
    seconds = hour * 3600.0 + minute * 60.0 + second + (float(f"0.{fraction}") if fraction else 0.0)
    zone = (match["zone"] or "").strip()
    if zone[:1] in ("+", "-"):
        offset = int(zone[1:3]) * 3600.0 + int(zone[-2:]) * 60.0
        if offset > _FARTHEST_ZONE_S:
            raise ValueError(f"{zone} is no time zone")
        seconds -= offset if zone[0] == "+" else -offset
    return seconds


def _iso(text: str) -> float | None:
    """UTC of ``2018-12-06T00:00:00.6208Z`` and the like, the form of most loggers; None for all others."""
    if len(text) < 14 or text[-1] != "Z" or text[4] != "-" or text[13] != ":":
        return None
    try:
        return datetime.fromisoformat(text).timestamp()
    except ValueError:
        return None


class StampReader:
    """Reads the stamps of one file, in which all have the same form as a rule.

    Parameters
    ----------
    day_first : bool
        Whether ``03/04/2019`` means the third of April.
    """

    def __init__(self, day_first: bool = False) -> None:
        self._day_first = day_first
        self._order = tuple(range(len(_FORMS)))

    def read(self, text: str) -> tuple[Stamp | None, str]:
        """Stamp in the text beside a sentence, and the text without it.

        Raises
        ------
        ValueError
            There is something of a stamp's form that is no time, such as the 30th of February.
        """
        if len(text) < 6:
            return None, text
        if (seconds := _iso(text.strip())) is not None:
            return Stamp(seconds), ""
        for index in self._order:
            pattern, reader = _FORMS[index]
            match = pattern.search(text)
            if match is None:
                continue
            try:
                stamp = reader(match, self._day_first)
            except LookupError:
                continue
            # A time of day is found within a dated stamp too: it never becomes the first form tried.
            if stamp.dated and index != self._order[0]:
                self._order = (index, *(i for i in range(len(_FORMS)) if i != index))
            return stamp, text[: match.start()] + text[match.end() :]
        return None, text


_EITHER = re.compile(r"(?<!\d)(\d\d?)/(\d\d?)/(\d{4}|\d\d)(?!\d)")


def day_comes_first(texts: Iterable[str]) -> bool | None:
    """Whether dates with slashes begin with the day; None where both orders are possible.

    A number above 12 is a day. Else the dates themselves may say it: days that follow each other in one order
    lie months apart in the other.
    """
    dates = (tuple(map(int, match.groups())) for match in map(_EITHER.search, texts) if match is not None)
    found = {(first, second, year) for first, second, year in dates if first and second}
    first, second = (max((date[i] for date in found), default=0) for i in (0, 1))
    if first > 12 or second > 12:
        return first > 12 >= second
    if all(date[0] == date[1] for date in found):
        return False
    reach = [_days(found, day_first) for day_first in (False, True)]
    longest = _SEASON * max(len(found), 2)
    if len(found) > 1 and min(reach) <= longest < max(reach):
        return reach[1] < reach[0]
    return None


_SEASON = 3
"""Days that a date of a recording may stand for, weekends among them."""


def _days(dates: Iterable[tuple[int, int, int]], day_first: bool) -> float:
    """Days from the first to the last of dates in one of the two orders."""
    days = [midnight(year, *((b, a) if day_first else (a, b))) / _DAY for a, b, year in dates]
    return max(days) - min(days)
