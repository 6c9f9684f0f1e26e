"""Content of a recording: time series in UTC, and an account of the files they came from."""

from collections.abc import Iterable
from dataclasses import dataclass, field, fields, replace
from datetime import UTC, datetime

import numpy as np

from navcore.foundation.text import Text

GAP_FACTOR = 3.0
"""A gap is a distance of two samples beyond this many median intervals."""
_BURSTS = 20.0
"""Mean intervals; a longer step is a gap, not the pause between bursts."""
_RARE, _FEW = 0.02, 50
_SAME_S = 1e-3
"""Readings no farther apart are at one time."""
LONGEST_REACH_S = 2.0
"""First and last samples of a stream stand for one median interval around them, but never for longer."""


@dataclass(frozen=True)
class Series:
    """One recorded quantity.

    Attributes
    ----------
    time_s : ndarray, shape (n,)
        UTC, s since 1970 (s since the file's own zero if it has no date), strictly increasing.
    values : ndarray, shape (n, k)
        SI and radians; columns as stated in `Recording`.
    valid : ndarray of bool, shape (n,)
        False where the instrument itself called its reading invalid; such values are zero.
    file, what : str
        Name of the file, and the sentences or columns, that it came from.
    dated : bool
        False when the file gives times without a date, so that it cannot be joined with one that has dates.
    tabled : bool
        True for columns of a table; False for sentences, which are printed coarsely.
    """

    time_s: np.ndarray
    values: np.ndarray
    valid: np.ndarray
    file: str
    what: str
    dated: bool = True
    tabled: bool = False

    def __post_init__(self) -> None:
        """Lock the arrays: a cached recording is shared by all who load it."""
        for array in (self.time_s, self.values, self.valid):
            array.flags.writeable = False

    @property
    def source(self) -> str:
        """File and sentences or columns."""
        return Text("{file} {what}", file=self.file, what=self.what)

    @property
    def interval_s(self) -> float:
        """Median distance of the samples, s; 0 for fewer than two."""
        return median_interval(self.time_s)

    @property
    def reach_s(self) -> float:
        """How long before its first and after its last sample the stream is still usable, s."""
        return min(self.interval_s, LONGEST_REACH_S)

    def shifted(self, by_s: float) -> "Series":
        """Return the same readings at times that are later by ``by_s``."""
        return self if by_s == 0.0 else replace(self, time_s=self.time_s + by_s)

    def gaps(self) -> tuple[int, float]:
        """Count of gaps and the longest one, s (0 when there is none)."""
        return gaps_of(self.time_s)


def median_interval(time_s: np.ndarray) -> float:
    """Median distance of increasing times, s; 0 for fewer than two."""
    return float(np.median(np.diff(time_s))) if time_s.size > 1 else 0.0


def rate_of(time_s: np.ndarray) -> float:
    """Rate of increasing times, Hz: intervals over their time, both without the gaps; NaN for fewer than two.

    A gap is a step beyond `GAP_FACTOR` median intervals where these are rare. Where they are not, the stamps
    come in bursts, and the median is not the interval: a gap is then a step beyond 20 mean intervals.
    """
    steps = np.diff(time_s)
    long = steps > GAP_FACTOR * median_interval(time_s)
    if np.count_nonzero(long) <= max(1.0, _RARE * steps.size) or steps.size < _FEW:
        steps = steps[~long]
    else:
        steps = steps[steps <= _BURSTS * steps.mean()]
    return float(steps.size / steps.sum()) if steps.size and steps.sum() > 0.0 else float("nan")


def gaps_of(time_s: np.ndarray) -> tuple[int, float]:
    """Count of gaps (beyond `GAP_FACTOR` median intervals) and the longest one, s."""
    steps = np.diff(time_s)
    gaps = steps[steps > GAP_FACTOR * median_interval(time_s)]
    return int(gaps.size), float(gaps.max(initial=0.0))


def first_of_each_time(time_s: np.ndarray) -> slice | np.ndarray:
    """Places of the times in their order, the first of several within 1 ms."""
    if np.all(np.diff(time_s) > _SAME_S):
        return slice(None)
    order = np.argsort(time_s, kind="stable")
    first = np.ones(time_s.size, dtype=bool)
    first[1:] = np.diff(time_s[order]) > _SAME_S
    return order[first]


def tidy(
    time_s: np.ndarray,
    values: np.ndarray,
    file: str,
    what: str,
    *,
    valid: np.ndarray | None = None,
    dated: bool = True,
    tabled: bool = False,
) -> Series | None:
    """Sort by time and keep the first of several readings at one time (within 1 ms); None when empty."""
    if time_s.size == 0:
        return None
    flags = np.ones(time_s.size, dtype=bool) if valid is None else valid
    chosen = first_of_each_time(time_s)
    kept = values[chosen] if flags.all() else np.where(flags[chosen, None], values[chosen], 0.0)
    return Series(time_s[chosen].copy(), kept, flags[chosen].copy(), file, what, dated, tabled)


@dataclass(frozen=True)
class StreamReport:
    """One kind of sentence or the rows of a table.

    Attributes
    ----------
    name : str
        Sentence address such as ``VDVBW``, or ``rows``.
    count : int
        Intact ones.
    used : bool
        Whether this reader takes anything from it.
    start_s, end_s : float
        UTC of the first and the last one; NaN where unknown.
    rate_hz : float
        Count over the span without its gaps: stamps that jitter, or several of one arrival, do not change it.
    gaps : int
        Distances beyond three median intervals; not counted for kinds that are not used.
    longest_gap_s : float
        The longest of these, s.
    """

    name: str
    count: int
    used: bool
    start_s: float = float("nan")
    end_s: float = float("nan")
    rate_hz: float = float("nan")
    gaps: int = 0
    longest_gap_s: float = 0.0


def stream_report(name: str, count: int, used: bool, times: Iterable[float]) -> StreamReport:
    """Rate, span and gaps of the sorted ``times``."""
    time_s = np.sort(times if isinstance(times, np.ndarray) else np.fromiter(times, dtype=float))
    if time_s.size == 0:
        return StreamReport(name, count, used)
    span = float(time_s[-1] - time_s[0])
    gaps = gaps_of(time_s) if used else (0, 0.0)
    rate = rate_of(time_s) if used else (time_s.size - 1) / span if span > 0.0 else float("nan")
    return StreamReport(name, count, used, float(time_s[0]), float(time_s[-1]), rate, *gaps)


@dataclass(frozen=True)
class LeftOut:
    """Readings, or whole lines, that are not used.

    Attributes
    ----------
    kind : str
        Address of the sentences, or name of the column; empty for lines that are neither.
    field : str
        Quantity of which these sentences say nothing that is used; empty for the whole line.
    why : str
        Reason.
    count : int
        How many.
    """

    kind: str
    field: str
    why: str
    count: int


@dataclass(frozen=True)
class SourceReport:
    """Account of one file.

    Attributes
    ----------
    name : str
        File name.
    kind : str
        What it was read as, e.g. ``NMEA 0183``.
    lines : int
        Lines (rows) that are not empty.
    streams : tuple of StreamReport
        By falling count.
    checksum_faults, unparsable, without_checksum, invalid, untimed, jitter : int
        Lines left out for a wrong checksum or because they make no sense; lines without a checksum (used);
        readings that the instrument flags as invalid; sentences before any known time (left out); times that
        run backwards within the tolerance (sorted).
    warnings : tuple of str
        What the user should know.
    used : int
        Lines of which something is used.
    lines_left_out : tuple of LeftOut
        All others: with ``used`` their counts are ``lines``.
    fields_left_out : tuple of LeftOut
        Readings that are missing in lines of which others are used.
    choices : tuple of str
        Where a quantity has several sources: which is taken, and by how much the others differ.
    """

    name: str
    kind: str
    lines: int
    streams: tuple[StreamReport, ...]
    checksum_faults: int = 0
    unparsable: int = 0
    without_checksum: int = 0
    invalid: int = 0
    untimed: int = 0
    jitter: int = 0
    warnings: tuple[str, ...] = ()
    used: int = 0
    lines_left_out: tuple[LeftOut, ...] = ()
    fields_left_out: tuple[LeftOut, ...] = ()
    choices: tuple[str, ...] = ()


_NO_STREAMS = ("sources", "deviations")


@dataclass(frozen=True)
class Recording:
    """Streams of one or several files; a quantity that none holds is None.

    Attributes
    ----------
    position : Series, columns latitude, longitude (rad), height (m, NaN where unknown)
    velocity : Series, columns E, N, over the ground (m/s)
    water, ground : Series, columns starboard, forward, through the water and over the ground (m/s)
    heading : Series, one column, rad in [0, 2 pi)
    attitude : Series, columns pitch, roll (rad)
    sources : tuple of SourceReport
        One for each file.
    deviations : dict of Series
        Standard deviations that an instrument gives its own readings, by the quantity: of the position north,
        east (m), of the velocity E, N (m/s), of the heading (rad), of the attitude pitch, roll (rad).
    """

    position: Series | None = None
    velocity: Series | None = None
    water: Series | None = None
    ground: Series | None = None
    heading: Series | None = None
    attitude: Series | None = None
    sources: tuple[SourceReport, ...] = field(default=())
    deviations: dict[str, Series] = field(default_factory=dict)

    def quantities(self) -> dict[str, Series]:
        """Return what there is, by attribute name."""
        streams = {f.name: getattr(self, f.name) for f in fields(self) if f.name not in _NO_STREAMS}
        return {name: series for name, series in streams.items() if series is not None}

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings of all files, each with the file's name."""
        return tuple(
            Text("{name}: {warning}", name=s.name, warning=warning)
            for s in self.sources
            for warning in s.warnings
        )


def utc_text(time_s: float) -> str:
    """UTC in ISO 8601 to 0.1 s, e.g. ``2018-12-06T00:00:00.6Z``."""
    tenths = round(time_s * 10.0)
    whole = datetime.fromtimestamp(tenths // 10, UTC)
    return f"{whole:%Y-%m-%dT%H:%M:%S}.{tenths % 10}Z"
