"""From the sentences of an NMEA 0183 log to its quantities: the best instrument of each."""

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np

from navcore.foundation.text import Text
from navcore.io.formats import Candidate
from navcore.io.nmea import NmeaLog, read_nmea
from navcore.io.nmea_lines import looks_like_nmea
from navcore.io.nmea_readings import Channel
from navcore.io.series import Recording, Series, SourceReport, stream_report, tidy

Picked = tuple[str, np.ndarray, np.ndarray]
"""Source, UTC in s, shape (n,), and values, shape (n, k)."""


def recognises(candidate: Candidate) -> bool:
    """Whether something like a sentence is among the first lines."""
    return looks_like_nmea(candidate.text)


def read(path: Path) -> Recording:
    """Read one NMEA 0183 log; raises `InputError`."""
    log = read_nmea(path)
    tally = log.tally
    used = {channel.address for channel in log.readings}
    streams = tuple(
        stream_report(address, count, address in used, log.times[address])
        for address, count in tally.intact.most_common()
    )
    flagged = (
        [Text("{invalid} readings flagged invalid by the instrument", invalid=tally.invalid)]
        if tally.invalid
        else []
    )
    series = {
        "position": _positions(path, log),
        "velocity": _series(path, log, _pick(log, ("RMC", "VTG"), "velocity")),
        "water": _along_axes(path, log, _pick(log, ("VBW", "VHW"), "water")),
        "ground": _along_axes(path, log, _pick(log, ("VBW",), "ground")),
        "heading": _series(path, log, _pick(log, _HEADINGS, "heading")),
    }
    source = SourceReport(
        path.name,
        "NMEA 0183 log",
        tally.lines,
        streams,
        tally.bad.total(),
        tally.unparsable,
        tally.without_checksum,
        tally.invalid,
        tally.untimed,
        tally.jitter,
        (*log.warnings, *flagged),
    )
    return Recording(**series, sources=(source,))


_HEADINGS = ("HDT", "THS", "PASHR", "PSXN", "PRDID", "VHW", "HDG")
"""Kinds that give the heading, the better ones first."""


def _pick(log: NmeaLog, kinds: Iterable[str], quantity: str) -> Picked | None:
    """Readings of the first kind that has the quantity; of several instruments the one with most."""
    for kind in kinds:
        found = [
            (channel.address, *held[quantity])
            for channel, held in log.readings.items()
            if quantity in held and kind in (channel.address[2:], channel.address)
        ]
        if found:
            return max(found, key=lambda picked: len(picked[1]))
    return None


def _series(path: Path, log: NmeaLog, picked: Picked | None) -> Series | None:
    if picked is None:
        return None
    address, time_s, values = picked
    return tidy(time_s, values, path.name, address, dated=log.tally.dated)


def _along_axes(path: Path, log: NmeaLog, picked: Picked | None) -> Series | None:
    """Series of starboard and forward speeds whose third value is the log's own valid flag."""
    series = _series(path, log, picked)
    if series is None:
        return None
    valid = series.values[:, 2] != 0.0
    return replace(series, values=np.where(valid[:, None], series.values[:, :2], 0.0), valid=valid)


def _positions(path: Path, log: NmeaLog) -> Series | None:
    """Fixes of the receiver that gives most.

    From GGA or GNS, which have the height, and RMC where they are silent; from GLL only where no other is.
    """
    receivers: defaultdict[Channel, dict[str, tuple[np.ndarray, np.ndarray]]] = defaultdict(dict)
    for kind in ("GGA", "GNS", "RMC", "GLL"):
        for (source, address), held in log.readings.items():
            if "position" in held and address[2:] == kind:
                receivers[Channel(source, address[:2])][kind] = held["position"]
    for kinds in receivers.values():
        if len(kinds) > 1:
            kinds.pop("GLL", None)
    best = max(receivers, key=lambda talker: sum(len(t) for t, _ in receivers[talker].values()), default=None)
    if best is None:
        return None
    time_s, values = (np.concatenate(columns) for columns in zip(*receivers[best].values(), strict=True))
    return _series(path, log, (best.address + "+".join(receivers[best]), time_s, values))
