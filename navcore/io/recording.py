"""Loading recorded streams: each file read once (cached), then joined by UTC."""

import math
import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from navcore.foundation import guarded
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.stage_cache import kept
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.io.choices import Source, choice_texts
from navcore.io.column_map import ColumnMap, map_beside, read_map
from navcore.io.formats import format_of, mapped_format
from navcore.io.placeholders import without_zero_places
from navcore.io.series import GAP_FACTOR, LONGEST_REACH_S, Recording, Series, SourceReport, utc_text
from navcore.io.source import require_file
from navcore.io.times.doubts import span_text
from navcore.io.times.steps import reason_of

PathLike = str | os.PathLike[str]
NO_TABLE = Text("describes a table (CSV, Parquet, MAT or npz), and this is none")
_SLACK_S = 0.01
_MIXED_DATES = Text("some files give times without a date and some with one: they cannot be joined")


@dataclass(frozen=True)
class Window:
    """Time that several streams share.

    Attributes
    ----------
    start_s, end_s : float
        UTC, s; t = 0 of the navigation is ``start_s``, the first epoch of any stream that all of them cover.
    cover_s : float
        UTC from which on all streams are usable, s; at most one interval of a stream before ``start_s``.
    """

    start_s: float
    end_s: float
    cover_s: float

    @property
    def span_s(self) -> float:
        """Length, s."""
        return self.end_s - self.start_s

    def covers(self, start_s: float, duration_s: float) -> bool:
        """Whether a run of this duration from this start lies within, to 10 ms."""
        return start_s >= self.cover_s - _SLACK_S and start_s + duration_s <= self.end_s + _SLACK_S


FileKey = tuple[str, int, int]
"""Resolved path, time of the last change (ns) and size: what the caches go by."""


def load(
    paths: PathLike | Sequence[PathLike], where: str = "", field: str = "", map_file: PathLike | None = None
) -> Recording:
    """Read one or several files; each quantity comes from the first file of the list that holds it.

    Of a quantity that several files hold, the warnings say which is taken and by how much the others differ.

    Parameters
    ----------
    paths : path or sequence of paths
        NMEA 0183 or CSV text, Parquet, MAT or npz, told apart by content.
    where, field : str
        Place and field that faults about the files name.
    map_file : path, optional
        Map that says what the columns of the tables among the files mean; else the one beside each
        (`map_beside`).

    Returns
    -------
    Recording

    Raises
    ------
    InputError
        A file is missing or refused, or dated and undated files are mixed.
    """
    parts: list[Recording] = []
    faults: list[Fault] = []
    taken = 0
    for key in file_keys(paths, where, field):
        path = Path(key[0])
        try:
            map_key, column_map = _map_of(key, map_file, where)
            taken += column_map is not None
            parts.append(
                kept(
                    ("recording", key, map_key),
                    lambda path=path, mapped=column_map: guarded.call(
                        path.name, read_recording, path, mapped
                    ),
                )
            )
        except InputError as error:
            faults += [replace(fault, field=fault.field or field) for fault in error.faults]
    if map_file is not None and not taken and not faults:
        faults.append(Fault(where, "map", str(map_file), NO_TABLE))
    if faults:
        raise InputError(faults)
    quantities: dict[str, Series] = {}
    deviations: dict[str, Series] = {}
    for part in parts:
        own = part.quantities()
        deviations |= {name: one for name, one in part.deviations.items() if name not in quantities}
        quantities = own | quantities
    if len({series.dated for series in quantities.values()}) > 1:
        raise InputError(Fault(where, field, None, _MIXED_DATES))
    return Recording(**quantities, sources=_with_choices(parts), deviations=deviations)


def _with_choices(parts: list[Recording]) -> tuple[SourceReport, ...]:
    """Account of the files, the last with what is said of quantities that several of them hold."""
    distinct = list({id(part): part for part in parts}.values())
    held: dict[str, list[Source]] = {}
    for part in distinct if len(distinct) > 1 else ():
        for name, series in part.quantities().items():
            valid = series.valid
            held.setdefault(name, []).append((series.source, series.time_s[valid], series.values[valid]))
    told, _ = choice_texts(held.items())
    *others, last = [source for part in parts for source in part.sources]
    return (*others, replace(last, warnings=(*last.warnings, *told), choices=(*last.choices, *told)))


def _map_of(key: FileKey, map_file: PathLike | None, where: str) -> tuple[FileKey | None, ColumnMap | None]:
    """Map of a file with its state: the one that is given, or the one beside it."""
    path = Path(key[0])
    named = map_file or map_beside(path)
    if named is None or not kept(("takes map", key), lambda: guarded.call(path.name, takes_map, path)):
        return None, None
    return file_keys(named, where, "map")[0], read_map(named)


def file_keys(paths: PathLike | Sequence[PathLike], where: str = "", field: str = "") -> tuple[FileKey, ...]:
    """State of each file; raises `InputError` when none is named or one cannot be read."""
    listed = [paths] if isinstance(paths, str | os.PathLike) else list(paths)
    if not listed or any(not str(path) for path in listed):
        raise InputError(Fault(where, field, None, Text("name at least one file")))
    keys: list[FileKey] = []
    faults: list[Fault] = []
    for path in listed:
        try:
            existing = require_file(path, where, field)
        except InputError as error:
            faults += error.faults
            continue
        status = existing.stat()
        keys.append((str(existing.resolve()), status.st_mtime_ns, status.st_size))
    if faults:
        raise InputError(faults)
    return tuple(keys)


def read_recording(path: Path, column_map: ColumnMap | None = None) -> Recording:
    """Read one file by its content, or a table by a map, without the cache; raises `InputError`."""
    if column_map is None:
        return without_zero_places(format_of(path).read(path))
    found = mapped_format(path)
    if found is None:
        raise InputError(Fault(path.name, "map", None, NO_TABLE))
    return without_zero_places(found.read(path, column_map))


def takes_map(path: Path) -> bool:
    """Whether a file is a table, which a map may describe; raises `InputError` for a binary file."""
    return mapped_format(path) is not None


def shared_window(series: Iterable[Series], field: str = "file") -> Window:
    """Time that all streams share; t = 0 is the first epoch of any of them within it.

    A stream covers one median interval (at most 2 s) before its first and after its last sample: a sample
    stands for its interval.

    Raises
    ------
    InputError
        The streams do not overlap, or dated and undated ones are mixed.
    """
    streams = list(series)
    if len({stream.dated for stream in streams}) > 1:
        raise InputError(Fault("", field, None, _MIXED_DATES))
    begin = max(stream.time_s[0] - stream.reach_s for stream in streams)
    end = min(stream.time_s[-1] + stream.reach_s for stream in streams)
    epochs = [
        stream.time_s[np.searchsorted(stream.time_s, begin)]
        for stream in streams
        if begin <= stream.time_s[-1]
    ]
    start = min(epochs, default=math.inf)
    if not start < end:
        spans = Text.joined(
            "; ",
            (
                Text(
                    "{source} {utc_text} to {utc_text2}",
                    source=s.source,
                    utc_text=utc_text(s.time_s[0]),
                    utc_text2=utc_text(s.time_s[-1]),
                )
                for s in streams
            ),
        )
        share = Text("the streams share no time: {spans}{hint}", spans=spans, hint=_apart(streams))
        raise InputError(Fault("", field, None, share))
    return Window(float(start), float(end), float(begin))


def _apart(streams: list[Series]) -> str:
    """Hint at the known time by which streams lie apart: weeks of a counter, a day, hours; or empty."""
    first, last = (pick(s.time_s[0] for s in streams) for pick in (min, max))
    reach = max(s.time_s[-1] - s.time_s[0] for s in streams) + 2.0 * LONGEST_REACH_S
    reason = reason_of(last - first, reach, last if streams[0].dated else 0.0)
    return Text("; they lie apart by {reason}", reason=reason) if reason else ""


MOST_BRIDGED = 0.1
"""Share of a run up to which a gap of its track or heading is bridged by the smoothing."""


def require_no_gap(
    streams: Iterable[Series], start_s: float, duration_s: float, most: float, file: object
) -> None:
    """Refuse a run in which a stream is silent for more than a share of it.

    Parameters
    ----------
    streams : iterable of Series
    start_s, duration_s : float
        UTC of t = 0 and length of the run, s.
    most : float
        Share of the run.
    file : object
        Value that the fault names, of the field ``file``.

    Raises
    ------
    InputError
        Says the gap, its share, and which part of the recording has no such gap.
    """
    faults: list[Fault] = []
    for stream in streams:
        edges = np.clip(stream.time_s, start_s, start_s + duration_s)
        steps = np.diff(edges) if stream.time_s.size > 1 else np.zeros(1)
        at = int(np.argmax(steps))
        longest = float(steps[at])
        usual = GAP_FACTOR * stream.interval_s
        if longest <= max(most * duration_s, usual):
            continue
        whole = np.diff(stream.time_s)
        breaks = np.flatnonzero(whole > max(most * duration_s, usual))
        bounds = np.concatenate([[0], breaks + 1, [stream.time_s.size]])
        pieces = [(float(stream.time_s[e - 1] - stream.time_s[b]), float(stream.time_s[b]))
                  for b, e in zip(bounds, bounds[1:], strict=False)]  # fmt: skip
        length, begin = max(pieces)
        allowed = Text(
            "{source}: a gap of {gap} from {first} to {last} is {share:.0%} of the run; at most {most:.0%} "
            "are bridged: "
            "was the clock set there? The longest piece without such a gap begins at {begin} and lasts "
            "{length}: cut "
            "the rest off, or shorten the run",
            source=stream.source,
            gap=span_text(float(whole[at])),
            first=utc_text(stream.time_s[at]),
            last=utc_text(stream.time_s[at + 1]),
            share=longest / duration_s,
            most=most,
            begin=utc_text(begin),
            length=span_text(length),
        )
        faults.append(Fault("", "file", file, allowed))
    if faults:
        raise InputError(faults)


def require_cover(window: Window, start_s: float, duration_s: float, what: str, file: object) -> None:
    """Raise `InputError` (field ``file``) for a run that is longer than the record, naming what there is."""
    if window.covers(start_s, duration_s):
        return
    span = max(window.end_s - start_s, 0.0)
    hours = math.floor(span / HOUR * 1e4) / 1e4
    allowed = Text(
        "{what} lasts {span:.1f} s = {hours:.4f} h from {utc_text}, the run "
        "{duration_s:.1f} s: run.duration_h must be <= {hours:.4f}",
        what=what,
        span=span,
        hours=hours,
        utc_text=utc_text(start_s),
        duration_s=duration_s,
    )
    raise InputError(Fault("", "file", file, allowed))
