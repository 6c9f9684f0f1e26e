"""Times of the columns that a map names: formats, zones, GPS weeks, counts."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime, timedelta
from zoneinfo import ZoneInfo

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.numbers import read_number
from navcore.foundation.text import Text
from navcore.io.column_map import GPS_WEEK, ISO, TimeMap, zone_of
from navcore.io.columns import limited
from navcore.io.times.counts import Ambiguous, gps_to_unix, read_counts, rolled_weeks, since
from navcore.io.written_units import UNITS

_WEEK_S = 604800.0
_MOST_WEEKS = 10_000


class MappedClock:
    """Reads the cells of a map's time; cells of several columns are joined by a space.

    Parameters
    ----------
    time : TimeMap
        With a unit or a zone.
    decimal : str
        ``.`` or ``,`` of counts.
    """

    def __init__(self, time: TimeMap, decimal: str = ".") -> None:
        self._decimal = decimal
        self._time = time
        self._zone = zone_of(time.zone) if time.zone else 0.0
        self._last = -np.inf
        self._told = ""
        self.twice = 0
        """Times read so far that local clocks show twice."""
        self._offsets: dict[tuple[int, ...], tuple[float, float]] = {}

    def read(self, where: str, cells: Sequence[str], rows: Sequence[int]) -> tuple[np.ndarray, bool]:
        """Times in s, shape (n,), and whether they are dated; raises `InputError` for other cells."""
        bad, parsed = [], np.full(len(cells), np.nan)
        for index, cell in enumerate(cells):
            try:
                parsed[index] = self.seconds(cell)
            except (ValueError, OverflowError) as problem:
                bad.append((index, cell, problem))
        if bad:
            faults = [
                Fault(
                    Text("{where}, row {row}", where=where, row=rows[i]),
                    ", ".join(self._time.columns),
                    cell,
                    Text(
                        "is no time of the form {unit} ({problem})",
                        unit=self._time.unit or ISO,
                        problem=str(problem),
                    ),
                )
                for i, cell, problem in bad
            ]
            raise InputError(limited(where, faults))
        return self.counted(parsed)

    def counted(self, parsed: np.ndarray) -> tuple[np.ndarray, bool]:
        """Times of `seconds`, shape (n,), as s, and whether they are dated."""
        if self._time.unit == GPS_WEEK:
            weeks = np.floor(parsed / _WEEK_S)
            gps_s, rolled = rolled_weeks(weeks, parsed - weeks * _WEEK_S)
            if rolled:
                self._told = Text("the GPS weeks have rolled over: {rolled} added", rolled=rolled)
            return gps_to_unix(gps_s), True
        if self._time.zero:
            return since(parsed, UNITS["time"][self._time.numeric or "s"], self._time.zero), True
        if self._time.numeric:
            try:
                found = read_counts(parsed, self._time.numeric)
            except Ambiguous as either:
                allowed = Text("may count {either}: say time.epoch too", either=str(either))
                raise InputError(Fault("", "time.unit", self._time.unit, allowed)) from None
            if found.told:
                self._told = Text("the times count {what}", what=found.told)
            return found.time_s, found.dated
        return parsed, True

    def seconds(self, cell: str) -> float:
        """One cell: a count, or s since 1970; raises ValueError when it is no time.

        Rows must come in their order: it tells the two hours apart that local clocks show twice in autumn.
        """
        if self._time.unit == GPS_WEEK:
            week, _, second = cell.strip().partition(" ")
            weeks, seconds = self._number(week), self._number(second)
            if not (0.0 <= weeks < _MOST_WEEKS and 0.0 <= seconds <= _WEEK_S):
                raise ValueError(Text("a week and the seconds in it, 0 to 604800"))
            return weeks * _WEEK_S + seconds
        if self._time.numeric or self._time.zero:
            return self._number(cell)
        text = cell.strip()
        moment = (
            datetime.fromisoformat(text)
            if self._time.unit in ("", ISO)
            else datetime.strptime(text, self._time.unit)
        )
        if moment.tzinfo is not None:
            return moment.timestamp()
        self._last = self._utc(moment)
        return self._last

    def warnings(self) -> list[str]:
        """Assumptions about the times that were read."""
        told = [self._told] if self._told else []
        if not self.twice:
            return told
        return [
            *told,
            Text.plural(
                "{count} time is of the hour that local clocks show twice: taken by the order of rows",
                "{count} times are of the hour that local clocks show twice: taken by the order of rows",
                count=self.twice,
            ),
        ]

    def _number(self, text: str) -> float:
        return read_number(text, self._decimal)

    def _utc(self, moment: datetime) -> float:
        """UTC in s of a local time; of an hour that comes twice the first that is not before the last row."""
        naive = moment.replace(tzinfo=UTC).timestamp()
        if not isinstance(self._zone, ZoneInfo):
            return naive - self._zone
        key = (moment.year, moment.month, moment.day, moment.hour, moment.minute // 15)
        if key not in self._offsets:
            self._offsets[key] = _offsets(moment, self._zone)
        first, second = self._offsets[key]
        if first < second:
            raise ValueError(Text("local clocks leave this hour out: summer time begins"))
        self.twice += first != second
        return naive - first if naive - first >= self._last or first == second else naive - second


def _offsets(moment: datetime, zone: ZoneInfo) -> tuple[float, float]:
    """Local time minus UTC, s, before and after a change of the clocks; equal at all other times."""
    before, after = (moment.replace(tzinfo=zone, fold=fold).utcoffset() or timedelta() for fold in (0, 1))
    return before.total_seconds(), after.total_seconds()
