"""Check a log, track or heading file: behind ``schuler check``."""

import math
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from navcore.checks.report import FileReport
from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from navcore.foundation.units import DEG, KNOT
from navcore.io.agreement import agreement_warnings, clock_text
from navcore.io.column_map import ColumnMap
from navcore.io.compressed import head_of
from navcore.io.courses import course_warnings
from navcore.io.plausible import speed_warnings
from navcore.io.recording import read_recording
from navcore.io.series import LeftOut, Recording, Series, SourceReport, StreamReport, utc_text
from navcore.io.source import require_file
from navcore.io.stretches import stretch_warnings
from navcore.io.suspects import suspect_warnings
from navcore.io.times.set_clocks import gap_doubt

_SNIFFED_BYTES = 8192
NAMES = {
    "position": Text("positions"),
    "velocity": Text("velocity over ground (E, N)"),
    "water": Text("speed through water"),
    "ground": Text("speed over ground along axes"),
    "heading": "heading",
    "attitude": Text("pitch and roll"),
}
"""Quantities in words."""


class Checker(NamedTuple):
    """One kind of file: whether a file that begins so is of it, and what it holds.

    ``recognises(path, head)`` gets the first 8 KiB; ``check(path)`` may raise `InputError`.
    """

    recognises: Callable[[Path, bytes], bool]
    check: Callable[[Path], FileReport]


def check_file(path: str | os.PathLike[str], others: Sequence[Checker] = ()) -> FileReport:
    """Say what a file holds.

    Parameters
    ----------
    path : path
        Any file.
    others : sequence of Checker
        Further kinds of files, asked first, in this order; a file that none recognises is read as a log.

    Returns
    -------
    FileReport
        With ``ok`` False and one fault for each thing wrong when it cannot be understood; nothing is raised
        for the content of a file.
    """
    try:
        existing = require_file(path)
        head = head_of(existing, _SNIFFED_BYTES)
        checker = next((c for c in others if c.recognises(existing, head)), None)
        return checker.check(existing) if checker is not None else check_log(existing)
    except InputError as error:
        return FileReport(str(path), "", faults=error.faults)


def check_log(path: Path, column_map: ColumnMap | None = None) -> FileReport:
    """Say what a log, track or heading file holds; raises `InputError`."""
    recording = read_recording(path, column_map)
    source = recording.sources[0]
    quantities = {name: _quantity(name, series) for name, series in recording.quantities().items()}
    details = {
        "lines": source.lines,
        "lines_used": source.used,
        "lines_left_out": [_left_out(one) for one in source.lines_left_out],
        "fields_left_out": [_left_out(one) for one in source.fields_left_out],
        "sentences": {s.name: _stream(s) for s in source.streams},
        "checksum_faults": source.checksum_faults,
        "without_checksum": source.without_checksum,
        "unparsable_lines": source.unparsable,
        "invalid_readings": source.invalid,
        "untimed_sentences": source.untimed,
        "out_of_order": source.jitter,
        "quantities": quantities,
    }
    if recording.deviations:
        details["deviations"] = {name: _deviation(name, one) for name, one in recording.deviations.items()}
    return FileReport(
        str(path),
        source.kind,
        details,
        tuple(_text(source, recording, quantities)),
        _warnings(source, recording),
    )


def _left_out(one: LeftOut) -> dict[str, Any]:
    return {"kind": one.kind, "field": one.field, "why": one.why, "count": one.count}


def _stream(stream: StreamReport) -> dict[str, Any]:
    known = math.isfinite(stream.start_s)
    return {
        "count": stream.count,
        "used": stream.used,
        "start_utc": utc_text(stream.start_s) if known else None,
        "end_utc": utc_text(stream.end_s) if known else None,
        "span_s": round(stream.end_s - stream.start_s, 4) if known else None,
        "rate_hz": round(stream.rate_hz, 4) if math.isfinite(stream.rate_hz) else None,
        "gaps": stream.gaps,
        "longest_gap_s": round(stream.longest_gap_s, 4),
    }


def _quantity(name: str, series: Series) -> dict[str, Any]:
    gaps, longest = series.gaps()
    entry: dict[str, Any] = {
        "source": series.what,
        "count": int(series.time_s.size),
        "valid": int(np.count_nonzero(series.valid)),
        "dated": series.dated,
        "start_utc": utc_text(series.time_s[0]) if series.dated else None,
        "end_utc": utc_text(series.time_s[-1]) if series.dated else None,
        "span_s": round(float(series.time_s[-1] - series.time_s[0]), 4),
        "interval_s": round(series.interval_s, 4),
        "gaps": gaps,
        "longest_gap_s": round(longest, 4),
    }
    values = series.values[series.valid]
    if values.size:
        entry |= _range(name, values)
    return entry


def _range(name: str, values: np.ndarray) -> dict[str, list[float]]:
    """Smallest and largest values in the units users read."""

    def extent(column: np.ndarray, unit: float, digits: int) -> list[float]:
        return [round(float(column.min()) / unit, digits), round(float(column.max()) / unit, digits)]

    if name == "position":
        return {"lat_deg": extent(values[:, 0], DEG, 6), "lon_deg": extent(values[:, 1], DEG, 6)}
    if name == "velocity":
        speed = np.hypot(values[:, 0], values[:, 1])
        return {"speed_mps": extent(speed, 1.0, 3), "speed_kn": extent(speed, KNOT, 2)}
    if name in ("water", "ground"):
        return {
            "forward_mps": extent(values[:, 1], 1.0, 3),
            "forward_kn": extent(values[:, 1], KNOT, 2),
            "starboard_mps": extent(values[:, 0], 1.0, 3),
            "starboard_kn": extent(values[:, 0], KNOT, 2),
        }
    if name == "heading":
        return {"heading_deg": extent(values[:, 0], DEG, 2)}
    return {"pitch_deg": extent(values[:, 0], DEG, 2), "roll_deg": extent(values[:, 1], DEG, 2)}


def _text(source: SourceReport, recording: Recording, quantities: dict[str, Any]) -> list[str]:
    words: list[str] = [
        Text(
            "  {lines} lines, {checksum_faults} checksum faults, {unparsable} "
            "unparsable, {invalid} flagged invalid",
            lines=source.lines,
            checksum_faults=source.checksum_faults,
            unparsable=source.unparsable,
            invalid=source.invalid,
        )
    ]
    for stream in source.streams:
        rate = f", {stream.rate_hz:.3g} Hz" if math.isfinite(stream.rate_hz) else ""
        line = Text("  {count:>7} {name}{rate}", count=stream.count, name=stream.name, rate=rate)
        words.append(line if stream.used else line + Text(" (not used)"))
    series = recording.quantities()
    for name, entry in quantities.items():
        when = f"{entry['start_utc']} to {entry['end_utc']}, " if entry["dated"] else ""
        gaps = (
            Text(
                "{gaps} gaps (longest {longest_gap_s:.1f} s)",
                gaps=entry["gaps"],
                longest_gap_s=entry["longest_gap_s"],
            )
            if entry["gaps"]
            else Text("no gaps")
        )
        every = (
            Text(", each {interval_s:.3g} s", interval_s=entry["interval_s"])
            if series[name].time_s.size > 1
            else ""
        )
        samples = Text(
            "{count} samples{every}, {when}{span_s:.1f} s, {gaps}",
            count=entry["count"],
            every=every,
            when=when,
            span_s=entry["span_s"],
            gaps=gaps,
        )
        words.append(f"  {NAMES[name]} ({entry['source']}): {samples}")
        words += [f"    {_extent(key, entry[key])}" for key in entry if key.endswith(("_deg", "_kn", "_mps"))]
    words += [_deviation_text(name, one) for name, one in recording.deviations.items()]
    words += [Text("  {choice}", choice=choice) for choice in source.choices]
    clock = clock_text(recording)
    return [*words, Text("  {clock}", clock=clock)] if clock else words


def _deviation(name: str, series: Series) -> dict[str, Any]:
    """Source, count and medians of what an instrument says of its own readings."""
    unit, size = DEVIATION_UNITS[name]
    medians = np.median(series.values, axis=0) / size
    return {
        "source": series.what,
        "count": int(series.time_s.size),
        f"median_{unit}": [round(float(one), 6) for one in medians],
    }


DEVIATION_UNITS = {
    "position": ("m", 1.0),
    "velocity": ("mps", 1.0),
    "heading": ("deg", DEG),
    "attitude": ("deg", DEG),
}
"""Unit in which the deviation of a quantity is told, and its size."""


def _deviation_text(name: str, series: Series) -> str:
    unit, size = DEVIATION_UNITS[name]
    medians = np.median(series.values, axis=0) / size
    return Text(
        "  standard deviation, {quantity} ({source}): median {values} {unit}",
        quantity=NAMES[name],
        source=series.what,
        values=" / ".join(f"{one:.3g}" for one in medians.tolist()),
        unit="m/s" if unit == "mps" else unit,
    )


def _extent(key: str, extent: list[float]) -> str:
    stem, unit = key.rsplit("_", 1)
    return f"{stem} {extent[0]:g} to {extent[1]:g} {'m/s' if unit == 'mps' else unit}"


def _warnings(source: SourceReport, recording: Recording) -> tuple[str, ...]:
    existing = [
        *source.warnings,
        *speed_warnings(recording),
        *stretch_warnings(recording.water, recording.ground, recording.velocity),
        *course_warnings(recording),
        *agreement_warnings(recording),
        *suspect_warnings(recording),
    ]
    for name, series in recording.quantities().items():
        gaps, longest = series.gaps()
        doubt = gap_doubt(series, recording.position)
        if doubt:
            existing.append(Text("{names}: {doubt}", names=NAMES[name], doubt=doubt))
        elif gaps:
            existing.append(
                Text(
                    "{names}: {gaps} gaps, the longest {longest:.1f} s",
                    names=NAMES[name],
                    gaps=gaps,
                    longest=longest,
                )
            )
        if series.time_s.size < 2:
            existing.append(Text("{names}: a single sample", names=NAMES[name]))
    return tuple(existing)
