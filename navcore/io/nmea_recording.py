"""From the sentences of an NMEA 0183 log to its quantities: the best instrument of each."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np

from navcore.foundation.text import Text
from navcore.io.formats import Candidate
from navcore.io.nmea import Channel, NmeaLog, read_nmea
from navcore.io.nmea_lines import looks_like_nmea
from navcore.io.nmea_sentences import Reading
from navcore.io.series import Recording, Series, SourceReport, stream_report, tidy

Rows = list[tuple[float, tuple[float, ...]]]


def recognises(candidate: Candidate) -> bool:
    """Whether something like a sentence is among the first lines."""
    return looks_like_nmea(candidate.text)


def read(path: Path) -> Recording:
    """Read one NMEA 0183 log; raises `InputError`."""
    log = read_nmea(path)
    tally = log.tally
    used = {channel.address for channel in log.readings}
    streams = tuple(
        stream_report(address, count, address in used, tally.times.get(address, ()))
        for address, count in tally.intact.most_common()
    )
    invalid = sum(
        not valid or (water is not None and not water[2]) or (ground is not None and not ground[2])
        for rows in log.readings.values()
        for _, _, _, _, _, water, ground, _, valid, _ in rows
    )
    flagged = (
        [Text("{invalid} readings flagged invalid by the instrument", invalid=invalid)] if invalid else []
    )
    series = {
        "position": _positions(path, log),
        "velocity": _series(path, log, *_pick(log, ("RMC", "VTG"), "velocity")),
        "water": _along_axes(path, log, *_pick(log, ("VBW", "VHW"), "water")),
        "ground": _along_axes(path, log, *_pick(log, ("VBW",), "ground")),
        "heading": _series(path, log, *_pick(log, _HEADINGS, "heading")),
    }
    source = SourceReport(
        path.name,
        "NMEA 0183 log",
        tally.lines,
        streams,
        tally.bad.total(),
        tally.unparsable,
        tally.without_checksum,
        invalid,
        tally.untimed,
        tally.jitter,
        (*log.warnings, *flagged),
    )
    return Recording(**series, sources=(source,))


_HEADINGS = ("HDT", "THS", "PASHR", "PSXN", "PRDID", "VHW", "HDG")
"""Kinds that give the heading, the better ones first."""


def _rows(log: NmeaLog, channel: Channel, quantity: str) -> Rows:
    place, rows = 1 + Reading._fields.index(quantity), log.readings[channel]
    return [(r[0], v if isinstance(v, tuple) else (v,)) for r in rows if (v := r[place]) is not None]


def _pick(log: NmeaLog, kinds: Iterable[str], quantity: str) -> tuple[str, Rows]:
    """Address and rows of the first kind that has the quantity; of several instruments the one with most."""
    for kind in kinds:
        rows = {c: _rows(log, c, quantity) for c in log.readings if kind in (c.address[2:], c.address)}
        channel = max(rows, key=lambda c: len(rows[c]), default=None)
        if channel is not None and rows[channel]:
            return channel.address, rows[channel]
    return "", []


def _series(path: Path, log: NmeaLog, address: str, rows: Rows) -> Series | None:
    time_s = np.array([time for time, _ in rows])
    values = np.array([value for _, value in rows], dtype=float)
    return tidy(time_s, values, path.name, address, dated=log.tally.dated)


def _along_axes(path: Path, log: NmeaLog, address: str, rows: Rows) -> Series | None:
    """Series of starboard and forward speeds whose third value is the log's own valid flag."""
    series = _series(path, log, address, rows)
    if series is None:
        return None
    valid = series.values[:, 2] != 0.0
    return replace(series, values=np.where(valid[:, None], series.values[:, :2], 0.0), valid=valid)


def _positions(path: Path, log: NmeaLog) -> Series | None:
    """Fixes of the receiver that gives most.

    From GGA or GNS, which have the height, and RMC where they are silent; from GLL only where no other is.
    """
    receivers: dict[Channel, dict[str, Rows]] = {}
    for kind in ("GGA", "GNS", "RMC", "GLL"):
        for channel in log.readings:
            rows = _rows(log, channel, "position") if channel.address[2:] == kind else []
            if rows:
                talker = Channel(channel.source, channel.address[:2])
                receivers.setdefault(talker, {})[kind] = rows
    for kinds in receivers.values():
        if len(kinds) > 1:
            kinds.pop("GLL", None)
    best = max(receivers, key=lambda talker: sum(map(len, receivers[talker].values())), default=None)
    if best is None:
        return None
    kinds = receivers[best]
    rows = [row for kind in kinds.values() for row in kind]
    return _series(path, log, best.address + "+".join(kinds), rows)
