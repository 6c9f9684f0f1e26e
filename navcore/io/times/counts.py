"""Numbers of time: from which epoch and in which unit they count, by their size and by what comes of it.

A hypothesis must give dates in which recordings are made and a rate that an instrument has. Where several do,
it is asked; the step between neighbours alone says nothing, since stamps may be rounded.
"""

from datetime import UTC, datetime
from typing import NamedTuple

import numpy as np

from navcore.foundation.text import Text
from navcore.io.times.doubts import is_plausible, latest_s, moment_text
from navcore.io.times.steps import DAY_S, LEAPS_S
from navcore.io.written_units import UNITS

GPS_EPOCH_S = 315964800.0
"""1980-01-06, Unix time."""
FASTEST_HZ = 1440.0
"""Rows a second of a log; more are counted in another unit."""
_SLOWEST_S = 4.0 * 3600.0
"""Between the rows of a log; more are counted in another unit."""
_DATED_FROM = 1e8
"""Numbers from here on have an epoch, in whichever unit."""
_UNIX_FROM = 1e9
"""Unix time, s, of 2001: smaller numbers are seconds since 2000 or 2001 as likely, which are of our days."""
_TICK_S = 1e-7
EPOCHS = {
    "unix": 0.0,
    "1970": 0.0,
    "gps": GPS_EPOCH_S,
    "1980": GPS_EPOCH_S,
    "excel": -25569.0 * DAY_S,
    "1899": -25569.0 * DAY_S,
    "excel1904": -24107.0 * DAY_S,
    "1904": -24107.0 * DAY_S,
    "labview": -24107.0 * DAY_S,
    "mac": -24107.0 * DAY_S,
    "ntp": -2208988800.0,
    "1900": -2208988800.0,
    "mjd": -40587.0 * DAY_S,
    "jd": -2440587.5 * DAY_S,
    "matlab": -719529.0 * DAY_S,
    "datenum": -719529.0 * DAY_S,
    "2000": 946684800.0,
    "j2000": 946728000.0,
    "2001": 978307200.0,
    "1950": -7305.0 * DAY_S,
    "filetime": -11644473600.0,
    "dotnet": -62135596800.0,
}
"""Unix time of the zero of known counts, s, by name. Those of GPS time have no leap seconds."""


def epoch_words(key: str) -> str:
    """Zero of a known count, for people: a date, or what the count is called."""
    named = {"matlab": Text("the year 0 of MATLAB"), "jd": Text("noon of 4713 BC, Julian")}
    return named.get(key) or moment_text(EPOCHS[key]).removesuffix("T00:00:00Z")


class Count(NamedTuple):
    """Hypothesis: numbers that count a unit from an epoch.

    Attributes
    ----------
    name : str
        Of the epoch, for people.
    unit, unit_name : float, str
        In s, and for people.
    zero_s : float
        Epoch, Unix time.
    """

    name: str
    unit: float
    unit_name: str
    zero_s: float

    def times(self, values: np.ndarray) -> np.ndarray:
        """Unix time, s."""
        return values * self.unit + self.zero_s

    def words(self) -> str:
        """Unit and epoch, for people."""
        return Text("{unit} since {epoch}", unit=self.unit_name, epoch=self.name)


_NAMED = {
    "s": Text("seconds"),
    "ms": "ms",
    "us": "µs",
    "ns": "ns",
    "min": Text("minutes"),
    "h": Text("hours"),
}


def _counts(unit: str, *epochs: tuple[str, str]) -> tuple[Count, ...]:
    return tuple(Count(words, UNITS["time"][unit], unit_words(unit), EPOCHS[key]) for key, words in epochs)


def unit_words(unit: str) -> str:
    """Unit of time, for people."""
    return Text("days") if unit == "day" else _NAMED[unit]


_UNIX = {unit: _counts(unit, ("unix", "1970"))[0] for unit in ("s", "ms", "us", "ns")}
_DAYS = _counts(
    "day",
    ("excel", "1899-12-30"),
    ("mjd", "1858-11-17"),
    ("matlab", epoch_words("matlab")),
    ("jd", epoch_words("jd")),
)
"""Counts that differ in size, so that the size says which."""
_FURTHER_DAYS = _counts("day", ("unix", "1970"), ("1950", "1950"), ("gps", "1980-01-06"), ("2000", "2000"))
_FURTHER = (
    *_counts(
        "s", ("1904", "1904"), ("1900", "1900"), ("gps", "1980-01-06"), ("2000", "2000"), ("2001", "2001")
    ),
    Count("1601", _TICK_S, Text("tenths of µs"), EPOCHS["filetime"]),
    Count(Text("the year 1"), _TICK_S, Text("tenths of µs"), EPOCHS["dotnet"]),
)
_FEWEST_DAYS = 3000.0
"""Smaller numbers of days may be those of a year, or years."""
_OF_SECONDS = 5
"""Of these, the epochs from which seconds are counted."""
_CALENDAR_FROM, _CALENDAR_TO = 1.99e13, 2.2e13
"""Numbers that are a date and a time run together, 20240517093000."""


class Times(NamedTuple):
    """Times of counts.

    Attributes
    ----------
    time_s : ndarray, shape (n,)
        Unix time, or s since the file's own zero.
    dated : bool
        Which of the two.
    told : str
        What was assumed; empty for Unix time and s.
    """

    time_s: np.ndarray
    dated: bool
    told: str = ""


class Ambiguous(ValueError):
    """Numbers that may count from several epochs; its text says which, with the date that each would give."""


def read_counts(values: np.ndarray, unit: str = "") -> Times:
    """Times of numbers.

    Parameters
    ----------
    values : ndarray, shape (n,)
        NaN where there is none.
    unit : str
        Key of `navcore.io.written_units.UNITS` of times, if it is known.

    Raises
    ------
    Ambiguous
        Several hypotheses give dates and rates that can be.
    """
    known = values[~np.isnan(values)]
    if known.size == 0:
        return Times(values, False)
    if unit:
        return _in_unit(values, known, unit)
    size = float(np.median(np.abs(known)))
    if _CALENDAR_FROM <= size < _CALENDAR_TO and (found := _of_digits(values)) is not None:
        return Times(found, True, Text("dates and times run together, as in 20240517093000"))
    own = size < _DATED_FROM and _has_a_rate(known, 1.0)
    days = [count for count in _DAYS if _fits(count, known)]
    unix = [count for key, count in _UNIX.items() if _fits(count, known) and _is_used(count, key, size)]
    if size < _DATED_FROM:
        if own and (clock := _of_day_digits(values)) is not None:
            return Times(clock, False, Text("times of day, hhmmss"))
        if not days and not own and size >= _FEWEST_DAYS:
            days = [count for count in _FURTHER_DAYS if _fits(count, known)]
        if days and own:
            raise Ambiguous(_either(known, days, own=True))
        found = _only(values, known, days) or Times(values, False)
        return found._replace(told=found.told + _of_1904(known)) if days == [_DAYS[0]] else found
    others = [count for count in _FURTHER if _fits(count, known)]
    if unix and size < _UNIX_FROM:
        unix += [count for count in others if count.zero_s > EPOCHS["gps"]]
    found = _only(values, known, unix, tell=False)
    if found is None:
        found = _only(values, known, others)
    elif gps := next((count for count in others if count.zero_s == EPOCHS["gps"]), None):
        found = found._replace(told=_unless(known, gps))
    return found or Times(unix_by_size(values), True)


def _in_unit(values: np.ndarray, known: np.ndarray, unit: str) -> Times:
    """Times of numbers of a known unit: Unix time, or of the one other epoch that fits."""
    scale = UNITS["time"][unit]
    seconds = values * scale
    size = float(np.median(np.abs(known))) * scale
    if size < _DATED_FROM:
        return Times(seconds, False)
    if is_plausible(np.array([size]))[0]:
        return Times(seconds, True)
    name = unit_words(unit)
    zeros = (*_DAYS, *_FURTHER_DAYS) if unit == "day" else _FURTHER[:_OF_SECONDS]
    counts = [Count(one.name, scale, name, one.zero_s) for one in zeros]
    return _only(values, known, [one for one in counts if _fits(one, known)]) or Times(seconds, True)


def _only(values: np.ndarray, known: np.ndarray, counts: list[Count], tell: bool = True) -> Times | None:
    """Times by the only hypothesis; raises `Ambiguous` where there are several."""
    if not counts:
        return None
    if len({count.zero_s for count in counts}) > 1 or len({count.unit for count in counts}) > 1:
        raise Ambiguous(_either(known, counts, own=False))
    return Times(counts[0].times(values), True, counts[0].words() if tell else "")


def _fits(count: Count, known: np.ndarray) -> bool:
    middle = count.times(np.array([np.median(known)]))
    return bool(is_plausible(middle)[0]) and _has_a_rate(known, count.unit)


def _is_used(count: Count, unit: str, size: float) -> bool:
    """Whether such counts were in use: µs and ns since 1970 only since 2000."""
    return unit in ("s", "ms") or size * count.unit >= EPOCHS["2000"]


def _has_a_rate(known: np.ndarray, unit: float) -> bool:
    """Whether rows of a log may lie so far apart as a mean; equal ones are too coarse."""
    if known.size < 2:
        return unit <= 1.0
    step_s = float(np.ptp(known)) * unit / (known.size - 1)
    return 1.0 / FASTEST_HZ <= step_s <= _SLOWEST_S or (step_s == 0.0 and unit > 1.0)


def _either(known: np.ndarray, counts: list[Count], own: bool) -> str:
    first = float(known[0])
    span = float(np.ptp(known)) / max(known.size - 1, 1)
    meant = [
        Text(
            "{words} ({moment}, each {step:.3g} s)",
            words=one.words(),
            moment=moment_text(one.times(np.array([first]))[0]),
            step=span * one.unit,
        )
        for one in counts
    ]
    if own:
        meant.append(Text("seconds (each {step:.3g} s)", step=span))
    return Text.joined(Text(" or "), meant)


def _unless(known: np.ndarray, other: Count) -> str:
    """Say of Unix time which date another count would give."""
    moment = moment_text(other.times(known[:1])[0])
    return Text("seconds since 1970 (as {words} it would be {moment})", words=other.words(), moment=moment)


def unix_by_size(values: np.ndarray) -> np.ndarray:
    """Unix time of numbers in s, ms, us or ns, whatever year comes out."""
    known = values[~np.isnan(values)]
    size, steps = float(np.median(np.abs(known))) if known.size else 0.0, 0
    while size >= _DATED_FROM * 1e3 and steps < 3:
        size, steps = size / 1e3, steps + 1
    return values / 1e3**steps


def _of_1904(known: np.ndarray) -> str:
    """Say of days since 1899-12-30 which date they give from 1904 on, as workbooks of old Macs count."""
    moment = (np.array([known[0]]) * DAY_S) + EPOCHS["1904"]
    return (
        Text(" (from 1904 on it would be {moment})", moment=moment_text(moment[0]))
        if is_plausible(moment)[0]
        else ""
    )


def _of_day_digits(values: np.ndarray) -> np.ndarray | None:
    """Seconds of numbers such as 93000 and 93001.5, times of day; None where plain seconds are as likely."""
    whole = np.floor(values)
    hours, minutes, seconds = whole // 10000, whole // 100 % 100, whole % 100 + (values - whole)
    if values.size < 2 or not np.all((hours < 24) & (minutes < 60) & (seconds < 60)):
        return None
    found = hours * 3600.0 + minutes * 60.0 + seconds
    steps, plain = np.diff(found), np.diff(values)
    # At each full minute the digits leap by 41 where the time goes on by 1.
    leaps = np.abs(plain - steps) > 1.0
    regular = np.all(steps > 0.0) and steps.max() < 10.0 * np.median(steps)
    return found if leaps.any() and regular else None


def _of_digits(values: np.ndarray) -> np.ndarray | None:
    """Unix time of numbers such as 20240517093000; None where one is no time."""
    found = np.full(values.size, np.nan)
    for row in np.flatnonzero(~np.isnan(values)).tolist():
        whole = int(values[row])
        try:
            moment = datetime.strptime(str(whole), "%Y%m%d%H%M%S").replace(tzinfo=UTC)
        except ValueError:
            return None
        found[row] = moment.timestamp() + float(values[row]) - whole
    return found


def gps_to_unix(gps_s: np.ndarray) -> np.ndarray:
    """Unix time (UTC) of s since 1980-01-06 that count leap seconds, shape (n,)."""
    unix = gps_s + GPS_EPOCH_S
    return unix - np.searchsorted(LEAPS_S + np.arange(1, LEAPS_S.size + 1), unix, side="right")


def since(values: np.ndarray, unit: float, epoch: str) -> np.ndarray:
    """Unix time of counts from a known epoch, by its name or a date; raises ValueError for another epoch."""
    zero = zero_of(epoch)
    if zero == GPS_EPOCH_S and epoch.strip().lower() in ("gps", "1980"):
        return gps_to_unix(values * unit)
    return values * unit + zero


def zero_of(epoch: str) -> float:
    """Unix time of an epoch: a key of `EPOCHS`, or a date; raises ValueError for others."""
    name = epoch.strip().lower().replace(" ", "").replace("_", "")
    if name in EPOCHS:
        return EPOCHS[name]
    text = epoch.strip().removesuffix("UTC").removesuffix("GMT").strip()
    moment = datetime.fromisoformat(text)
    return (moment if moment.tzinfo else moment.replace(tzinfo=UTC)).timestamp()


def rolled_weeks(weeks: np.ndarray, seconds: np.ndarray) -> tuple[np.ndarray, int]:
    """GPS time of weeks and seconds in them, s, and the weeks by which the counter had rolled over.

    A counter of ten bits begins anew each 1024 weeks; the latest time that is not in the future is meant.
    """
    gps_s = weeks * 7.0 * DAY_S + seconds
    middle = float(np.nanmedian(gps_s)) + GPS_EPOCH_S
    if np.nanmax(weeks) >= 1024:
        return gps_s, 0
    turns = max(0, int((latest_s() - 2.0 * 365.25 * DAY_S + DAY_S * 366.0 - middle) // (1024 * 7 * DAY_S)))
    return gps_s + turns * 1024 * 7 * DAY_S, 1024 * turns
