"""UTC that a sentence of a log gives: its own time, or the stamp beside it.

The stamp says which day, since old receivers give wrong dates. Stamps in local time are told by the first
dated sentence and corrected. What gives no time has it from its neighbours (`navcore.io.times.between`).
"""

import math
import re
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from navcore.io.nmea_lines import Sentences, Tally
from navcore.io.nmea_values import seconds_of
from navcore.io.stamps import LONGEST_STAMP, StampReader, midnight
from navcore.io.times.steps import leap_seconds

_DAY = 86400.0
_QUARTER_S = 900.0
"""Time zones differ from UTC by whole quarters of an hour."""
_FARTHEST_ZONE_S = 14.5 * 3600.0
_CLOCK_ERROR_S = 120.0
"""By how much a logger's clock may be off for its time zone to be recognised."""
_LEAST_ERROR_S, _LARGEST_ERROR_S = 5.0, 3600.0
"""An error of the logger's clock within these is taken from the first dated sentence, for all lines."""
_LEAP_SLACK_S = 1.5
_LONGEST_SENTENCE = 120
_MOST_TRIES = 20_000
_LOGGED_ADDRESS = "UNIXD"
_DATE_PLACES = {"RMC,": (0, 8), "ZDA,": (0, 1)}
"""Where the fields stand: time and date (RMC), time and day (ZDA; month and year follow)."""
_OF_DAY_PLACES = {"GGA,": (0, 5), "GNS,": (0, 5), "GLL,": (4, 5)}
"""... and where the time of day stands, and the flag of the fix."""
_LOGGED_DAY = re.compile(r"(?<!\d)(\d{4})_\d{3}_\d{5}(?!\d)")
"""Name of a file of the University of Hawaii's logger: year, day and second of the day."""


class Clock:
    """Time of the lines of one file, which are given in their order.

    Parameters
    ----------
    text : str
        Whole file: its first dated sentence serves those before it.
    name : str
        File name; some loggers put the year there.
    tally : Tally
        Told whether times are dated, and how far the stamps are off.
    """

    def __init__(self, text: str, name: str, tally: Tally) -> None:
        self._tally = tally
        self._now: float | None = None
        self._without_fix: float | None = None
        self._logged: float | None = None
        dated = _first_dated(text)
        self._date = None if dated is None else dated[0] // _DAY * _DAY
        ahead = _ahead_of_day(text) if dated is None else _settled(text, dated)
        if ahead is not None:
            tally.local_time_s = _zone(ahead)
            wrong = ahead - tally.local_time_s
            tally.clock_error_s = wrong if _LEAST_ERROR_S < abs(wrong) <= _LARGEST_ERROR_S else 0.0
        year = _LOGGED_DAY.search(Path(name).stem)
        known = datetime.fromtimestamp(self._date, UTC).year if self._date is not None else None
        self._year = int(year[1]) if year is not None else known

    def times(self, sentences: Sentences, readings: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """UTC that each of the next sentences gives, s since 1970 (since midnight when nothing is dated).

        Parameters
        ----------
        readings : ndarray of `navcore.io.nmea_sentences.READING`, shape (n,)

        Returns
        -------
        time_s : ndarray, shape (n,)
            NaN of a sentence that gives none, and of one that makes no sense.
        doubtful : ndarray of bool, shape (n,)
            Which are the time of a receiver without a fix.
        """
        rows, text = sentences.rows, sentences.block.text
        found: list[float] = []
        doubtful = np.zeros(len(sentences.addresses), bool)
        stamps_s = rows["stamp_s"] - self._tally.local_time_s - self._tally.clock_error_s
        columns = (
            stamps_s,
            rows["dated"],
            *(readings[name] for name in ("sensible", "invalid", "time_of_day", "day")),
        )
        for row, (address, stamp_s, dated, sensible, invalid, time_of_day, day) in enumerate(
            zip(sentences.addresses, *(column.tolist() for column in columns), strict=True)
        ):
            if not sensible:
                found.append(math.nan)
                continue
            told = address == _LOGGED_ADDRESS
            if told:
                self._take_logged(text[rows["begin"][row] : rows["end"][row]])
            near = stamp_s if dated and not math.isnan(stamp_s) else self._near(stamp_s)
            if math.isnan(time_of_day) or (invalid and near is not None):
                if near is None or (math.isnan(stamp_s) and not told):
                    found.append(math.nan)
                    continue
                now = near
            elif invalid:
                found.append(self._of_no_fix(time_of_day, day))
                doubtful[row] = True
                continue
            elif near is None:
                now = self._without_stamp(time_of_day, day)
            else:
                now = _nearest_day(time_of_day, near)
                self._tally.clock_offsets.append(near - now)
            self._now = now
            found.append(now)
        return np.array(found), doubtful

    def _of_no_fix(self, own: float, day: float) -> float:
        """Time of a receiver without a fix: near the last one, whatever date it gives."""
        near = self._without_fix if self._now is None else self._now
        found = self._without_stamp(own, day) if near is None else _nearest_day(own, near)
        self._without_fix = found
        return found

    def _take_logged(self, body: str) -> None:
        """Take the time of a line ``$UNIXD,<days since the year began>``: it holds for the lines after."""
        try:
            days = float(body.split(",")[1])
            if self._year is not None and 0.0 <= days <= 800.0:
                self._logged = datetime(self._year, 1, 1, tzinfo=UTC).timestamp() + days * _DAY
        except (ValueError, IndexError):
            return

    def _near(self, stamp_s: float) -> float | None:
        """Time of a stamp without a date, or of the logger's line before."""
        return self._logged if math.isnan(stamp_s) else self._without_stamp(stamp_s, math.nan)

    def _without_stamp(self, own: float, day: float) -> float:
        if not math.isnan(day):
            return day + own
        if self._now is not None:
            return _nearest_day(own, self._now)
        self._tally.dated = self._date is not None
        return (self._date or 0.0) + own


def _nearest_day(time_of_day: float, near: float) -> float:
    return time_of_day + _DAY * round((near - time_of_day) / _DAY)


def _first_dated(text: str) -> tuple[float, int] | None:
    """UTC of the first RMC or ZDA sentence with a date, and where it stands in the text."""
    dates = [dated for key in _DATE_PLACES for dated in [_first_of(text, key)] if dated is not None]
    return min(dates, key=lambda dated: dated[1], default=None)


def _first_of(text: str, key: str) -> tuple[float, int] | None:
    position = text.find(key)
    for _ in range(_MOST_TRIES):
        if position < 0:
            return None
        moment = _moment(key, text[position + 4 : position + 4 + _LONGEST_SENTENCE].split("\n", 1)[0])
        if moment is not None:
            return moment, position
        position = text.find(key, position + 4)
    return None


def _moment(key: str, fields: str) -> float | None:
    """UTC of the fields behind an address; None when they hold no whole time."""
    parts = fields.partition("*")[0].split(",")
    time_place, date_place = _DATE_PLACES[key]
    try:
        time = parts[time_place]
        if key == "RMC,":
            if parts[1] != "A":
                return None
            date = parts[date_place]
            day, month, year = int(date[:2]), int(date[2:4]), int(date[4:6])
        else:
            day, month, year = (int(part) for part in parts[date_place : date_place + 3])
        moment = midnight(year, month, day) + seconds_of(time)
        datetime.fromtimestamp(moment, UTC)
    except (ValueError, IndexError, OverflowError):  # no calendar has it
        return None
    return moment


def _settled(text: str, dated: tuple[float, int]) -> float:
    """By how much the stamps are ahead of UTC, s: by the first dated sentence, or by the last one.

    A receiver that does not know the leap seconds yet is ahead of UTC by them at the first one.
    """
    ahead, last = _ahead(text, *dated), _last_dated(text)
    if last is None:
        return ahead
    later = _ahead(text, *last)
    learnt = abs(later - ahead - leap_seconds(dated[0])) < _LEAP_SLACK_S
    return later if learnt else ahead


def _last_dated(text: str) -> tuple[float, int] | None:
    found = [(position, key) for key in _DATE_PLACES if (position := text.rfind(key)) >= 0]
    for position, key in sorted(found, reverse=True):
        moment = _moment(key, text[position + 4 : position + 4 + _LONGEST_SENTENCE].split("\n", 1)[0])
        if moment is not None:
            return moment, position
    return None


def _ahead_of_day(text: str) -> float | None:
    """By how much the stamp of the first fix without a date is ahead of its time of day, s; None without."""
    for key, (time_place, flag_place) in _OF_DAY_PLACES.items():
        position = text.find(key)
        for _ in range(_MOST_TRIES):
            if position < 0:
                break
            fields = text[position + 4 : position + 4 + _LONGEST_SENTENCE].split("\n", 1)[0]
            parts = fields.partition("*")[0].split(",")
            with suppress(ValueError, IndexError):
                if parts[flag_place][:1] not in ("", "0", "N", "V"):
                    return _ahead(text, seconds_of(parts[time_place]), position, dated=False)
            position = text.find(key, position + 4)
    return None


def _ahead(text: str, utc: float, position: int, dated: bool = True) -> float:
    """By how much the stamp of a sentence's line is ahead of its UTC, s; 0 without a stamp.

    Where one of them has no date, it is by less than half a day.
    """
    begin = max(
        text.rfind("\n", max(0, position - 2 * LONGEST_STAMP), position) + 1, position - LONGEST_STAMP
    )
    try:
        stamp, _ = StampReader().read(text[max(0, begin) : position].rpartition("$")[0])
    except ValueError:
        return 0.0
    if stamp is None:
        return 0.0
    ahead = stamp.seconds - (utc if stamp.dated else utc % _DAY)
    if not (stamp.dated and dated):
        ahead -= _DAY * round(ahead / _DAY)
    return ahead


def _zone(ahead: float) -> float:
    """The part of it that is a time zone, s."""
    quarters = round(ahead / _QUARTER_S) * _QUARTER_S
    recognised = quarters != 0.0 and abs(quarters) <= _FARTHEST_ZONE_S
    return quarters if recognised and abs(ahead - quarters) <= _CLOCK_ERROR_S else 0.0
