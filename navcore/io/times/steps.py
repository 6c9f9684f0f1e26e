"""Steps of a clock: by a size that has a known cause, or of rows that only stand in another order."""

from datetime import UTC, datetime

import numpy as np

from navcore.foundation.text import Text
from navcore.foundation.units import HOUR

_LEAP_DATES = (
    "1981-07 1982-07 1983-07 1985-07 1988-01 1990-01 1991-01 1992-07 1993-07 1994-07 1996-01 1997-07 1999-01 "
    "2006-01 2009-01 2012-07 2015-07 2017-01"
).split()
LEAPS_S = np.array(
    [datetime.strptime(f"{date}-01", "%Y-%m-%d").replace(tzinfo=UTC).timestamp() for date in _LEAP_DATES]
)
"""Since which GPS time is ahead of UTC by a second more, Unix time."""
DAY_S = 86400.0
ROLLOVER_S = 1024 * 7 * DAY_S
"""Time after which a receiver's counter of weeks begins anew."""
_MOST_HOURS = 14
_LEAP_WITHIN_S = 1.5
_DISTINCT = 0.5
"""Share of the usual interval by which the rows of one clock lie apart at least."""


def leap_seconds(unix_s: float) -> int:
    """Seconds by which GPS time is ahead of UTC at a Unix time."""
    return int(np.searchsorted(LEAPS_S, unix_s, side="right"))


def reason_of(apart_s: float, within_s: float, at_s: float) -> str:
    """Known cause of a clock that is off by ``apart_s``, to ``within_s``; empty where none fits.

    Tried are weeks of a receiver's counter, days, whole hours and the leap seconds.

    Parameters
    ----------
    apart_s, within_s : float
        s.
    at_s : float
        When, Unix time; small where there is no date, which excludes the leap seconds.
    """
    size = abs(apart_s)
    weeks = round(size / ROLLOVER_S)
    if weeks and abs(size - weeks * ROLLOVER_S) < within_s:
        return Text(
            "{days} days = {weeks} weeks: a receiver's week counter has rolled over, its dates are too early",
            days=weeks * 7168,
            weeks=weeks * 1024,
        )
    hours = round(size / HOUR)
    if 1 <= hours <= _MOST_HOURS and abs(size - hours * HOUR) < min(within_s, 0.25 * HOUR):
        return Text("{hours} h: is one of them in local time, or does summer time begin or end?", hours=hours)
    if abs(size - DAY_S) < min(within_s, 0.25 * HOUR):
        return Text("a day: does the date change late or early at midnight?")
    leaps = leap_seconds(at_s)
    if leaps and abs(size - leaps) < min(within_s, _LEAP_WITHIN_S):
        return Text("{leaps} s: the leap seconds by which GPS time is ahead of UTC", leaps=leaps)
    return ""


def sorting_mends(time_s: np.ndarray) -> bool:
    """Whether times, shape (n,), would be those of one clock if they were put in order.

    They are not where rows would then coincide or lie closer than the rest, as after a clock that was set
    back, or where a step would be longer than all the rest.
    """
    steps = np.diff(np.sort(time_s))
    if steps.size == 0 or not steps.min() > 0.0:
        return False
    usual = float(np.median(steps))
    return bool(steps.min() >= _DISTINCT * usual and 2.0 * steps.max() <= max(steps.sum(), 8.0 * usual))


def back_advice(time_s: np.ndarray, place: int, dated: bool) -> str:
    """What to do about times that run backwards behind a place, shape (n,): the cause, if one is known."""
    steps = np.diff(time_s)
    forward = steps[steps > 0.0]
    usual = float(np.median(forward)) if forward.size else 0.0
    error = float(steps[place]) - usual
    reason = reason_of(error, 0.5 * usual + 0.1, float(time_s[place]) if dated else 0.0)
    if reason:
        return Text("the clock steps by {reason}; put the rows before or after right", reason=reason)
    if sorting_mends(time_s):
        return Text("put the rows in order or split the file")
    return Text("the clock was set back, or two recordings stand one behind the other: split the file there")


def without_leap_step(time_s: np.ndarray) -> tuple[np.ndarray, int, int]:
    """Times of one receiver that learns the leap seconds on its way, and so steps back once.

    Parameters
    ----------
    time_s : ndarray, shape (n,)
        Unix time in the order of the lines; equal times may follow each other.

    Returns
    -------
    time_s : ndarray, shape (n,)
        Those before the step without the leap seconds; as they are where there is no such step.
    count, leaps : int
        How many were put right, and by how much; 0 where none was.
    """
    steps = np.diff(time_s)
    back = np.flatnonzero(steps < -1.0)
    if back.size != 1:
        return time_s, 0, 0
    forward = steps[steps > 0.0]
    usual = float(np.median(forward)) if forward.size else 0.0
    at, leaps = int(back[0]), leap_seconds(float(time_s[back[0]]))
    if not leaps or abs(steps[at] - usual + leaps) >= min(0.5 * max(usual, 0.2) + 0.05, _LEAP_WITHIN_S):
        return time_s, 0, 0
    mended = time_s.copy()
    mended[: at + 1] -= leaps
    return mended, at + 1, leaps
