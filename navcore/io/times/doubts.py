"""Times of which the outcome is doubted: years in which no recording was made, a clock that was set late."""

from datetime import UTC, datetime
from typing import NamedTuple

import numpy as np

from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.io.times.steps import DAY_S

FIRST_YEAR = 1990
_YEAR_S = 365.25 * DAY_S
_EARLIEST_S = datetime(FIRST_YEAR, 1, 1, tzinfo=UTC).timestamp()


class Trust(NamedTuple):
    """Which dated times are those of a recording.

    Attributes
    ----------
    kept : ndarray of bool, shape (n,)
        All, where none of the years makes sense.
    warnings : list of str
        What is left out, or looks odd.
    """

    kept: np.ndarray
    warnings: list[str]


def latest_s() -> float:
    """End of the next year, Unix time: no recording is dated later."""
    return datetime(datetime.now(UTC).year + 2, 1, 1, tzinfo=UTC).timestamp()


def is_plausible(time_s: np.ndarray) -> np.ndarray:
    """Which Unix times lie in 1990 to the end of the next year; arrays of bool of the same shape."""
    return (time_s >= _EARLIEST_S) & (time_s < latest_s())


def trust_of(time_s: np.ndarray, what: str) -> Trust:
    """Leave out times that a clock gave before it was set, among others that make sense.

    Parameters
    ----------
    time_s : ndarray, shape (n,)
        Unix time in the order of the rows, without NaN.
    what : str
        Rows or lines, for people.
    """
    plausible = is_plausible(time_s)
    everything = np.ones(time_s.size, bool)
    if plausible.all():
        return Trust(everything, [])
    years = sorted({_year(t) for t in (time_s[~plausible].min(), time_s[~plausible].max())})
    named = Text("{first} to {last}", first=years[0], last=years[-1]) if len(years) > 1 else str(years[0])
    if not plausible.any():
        told = Text(
            "the times are of the year {years}, outside {first} to {last}: is it another epoch, or was the "
            "clock not "
            "set?",
            years=named,
            first=FIRST_YEAR,
            last=_year(latest_s()) - 1,
        )
        return Trust(everything, [told])
    count = int(np.count_nonzero(~plausible))
    told = Text(
        "{count} {what} dated {years} left out: the clock was not set (the first time that is trusted is "
        "{moment})",
        count=count,
        what=what,
        years=named,
        moment=moment_text(float(time_s[plausible].min())),
    )
    return Trust(plausible, [told])


def span_text(seconds: float) -> str:
    """Length of time in a unit that suits it."""
    for size, unit in ((_YEAR_S, Text("years")), (DAY_S, Text("days")), (HOUR, "h")):
        if seconds >= 2.0 * size:
            return Text("{number:.3g} {unit}", number=seconds / size, unit=unit)
    return Text("{seconds:.1f} s", seconds=seconds)


def moment_text(time_s: float) -> str:
    """UTC in ISO 8601 to the second."""
    return f"{datetime.fromtimestamp(round(time_s), UTC):%Y-%m-%dT%H:%M:%SZ}"


def _year(time_s: float) -> int:
    return datetime.fromtimestamp(min(max(time_s, -6e10), 2.5e11), UTC).year
