"""From the sentences of an NMEA 0183 log to its quantities, and an account of all its lines."""

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from navcore.foundation.text import Text
from navcore.io.choices import choice_texts
from navcore.io.formats import Candidate
from navcore.io.nmea import QUANTITY_NAMES, NmeaLog, read_nmea
from navcore.io.nmea_lines import looks_like_nmea
from navcore.io.nmea_readings import (
    EMPTY,
    INVALID,
    LATE,
    OTHER,
    REPEATED,
    UNREAD,
    UNSET,
    UNTIMED,
    USED,
    Channel,
    Held,
    Ordered,
)
from navcore.io.nmea_sentences import ALONG_AXES
from navcore.io.series import (
    LeftOut,
    Recording,
    Series,
    SourceReport,
    first_of_each_time,
    stream_report,
    tidy,
)

_HEADINGS = ("HDT", "THS", "PHOCT", "PASHR", "PSXN", "PSAT", "PRDID", "VHW", "HDG")
"""Kinds that give the heading, the better ones first."""
_ATTITUDES = ("PIXSE", "PASHR", "PSXN", "PSAT", "PRDID")
_KINDS = {
    "velocity": ("RMC", "VTG", "PIXSE"), "water": ("VBW", "VHW"), "ground": ("VBW",), "heading": _HEADINGS,
    "attitude": _ATTITUDES,
}  # fmt: skip
_DEVIATIONS = ("position", "velocity", "heading", "attitude")
_PLACES = ("GGA", "GNS", "RMC", "GLL", "PIXSE")
_MOST_REPEATED = 0.01
"""Share of a kind; fewer are told in JSON alone."""
_CHECKSUM = Text("wrong checksum")
_WHY = {
    UNREAD: Text("this kind is not read"),
    INVALID: Text("flagged invalid by the instrument"),
    EMPTY: Text("no reading in its fields"),
    UNTIMED: Text("before the first known time"),
    UNSET: Text("dated before the clock was set"),
    LATE: Text("its time runs backwards"),
    REPEATED: Text("another stands at the same time"),
    OTHER: Text("another source is taken"),
}


class Picked(NamedTuple):
    """Readings of one quantity from one instrument, by the name of their sentences."""

    address: str
    held: Held


def recognises(candidate: Candidate) -> bool:
    """Whether something like a sentence is among the first lines."""
    return looks_like_nmea(candidate.text)


def read(path: Path) -> Recording:
    """Read one NMEA 0183 log; raises `InputError`."""
    log = read_nmea(path)
    tally, fates = log.tally, log.ordered.fates
    found = instruments_of(log.ordered)
    taken = {name: sources[0] for name, sources in found.items() if sources}
    series = {name: series_of(path.name, tally.dated, name, picked) for name, picked in taken.items()}
    apart = _deviations(log.ordered, taken)
    deviations = {name: series_of(path.name, tally.dated, name, picked) for name, picked in apart.items()}
    for picked in (*taken.values(), *apart.values()):
        rows = picked.held.rows
        fates[rows[fates[rows] == OTHER]] = REPEATED
        fates[rows[first_of_each_time(picked.held.time_s)]] = USED
    used = {log.ordered.names[kind] for kind in np.unique(log.ordered.kinds[fates == USED])}
    streams = tuple(
        stream_report(address, count, address in used, log.ordered.times[address])
        for address, count in tally.intact.most_common()
    )
    told, differing = choice_texts(
        (name, [(one.address, one.held.time_s, one.held.values) for one in sources])
        for name, sources in found.items()
    )
    source = SourceReport(
        path.name,
        "NMEA 0183 log",
        tally.lines,
        streams,
        tally.bad.total(),
        tally.unparsable,
        tally.without_checksum,
        tally.invalid,
        tally.untimed.total(),
        tally.jitter,
        (*log.warnings, *_repeated(log), *differing, *(_magnetic(log) if "heading" not in taken else ())),
        int(np.count_nonzero(fates == USED)),
        tuple(_lines_left_out(log)),
        tuple(
            LeftOut(address, QUANTITY_NAMES[quantity], _WHY[INVALID], count)
            for (address, quantity), count in tally.flagged.items()
        ),
        tuple(told),
    )
    known = {name: one for name, one in deviations.items() if one is not None}
    return Recording(**series, sources=(source,), deviations=known)


def _deviations(ordered: Ordered, taken: Mapping[str, Picked]) -> dict[str, Picked]:
    """Standard deviations by the quantity: of the instrument that is taken, or of another sentence."""
    found: dict[str, Picked] = {}
    for name in _DEVIATIONS:
        if name not in taken:
            continue
        own = [
            Picked(channel.address, held[f"{name}_sigma"])
            for channel, held in ordered.readings.items()
            if f"{name}_sigma" in held
        ]
        if own:
            found[name] = min(own, key=lambda one: one.address != taken[name].address)
    return found


def instruments_of(ordered: Ordered) -> dict[str, list[Picked]]:
    """Readings of each quantity by instrument, the one that is taken first."""
    return {
        "position": _positions(ordered),
        **{name: _picked(ordered, name, kinds) for name, kinds in _KINDS.items()},
    }


def _repeated(log: NmeaLog) -> Iterator[str]:
    """Say which kinds have sentences that stand at the time of another one."""
    kinds, fates = log.ordered.kinds, log.ordered.fates
    for kind, count in Counter(kinds[fates == REPEATED].tolist()).items():
        if count > _MOST_REPEATED * np.count_nonzero(kinds == kind):
            yield Text(
                "{count} {kind} repeat another one at the same time: left out",
                count=count,
                kind=log.ordered.names[kind],
            )


def _magnetic(log: NmeaLog) -> Iterator[str]:
    """Say of a log without a true heading that it has a magnetic one."""
    for address, count in log.tally.intact.items():
        if address[2:] in ("HDM", "HDG"):
            yield Text(
                "{count} readings of {address} are magnetic headings without a variation: no true heading, "
                "not used",
                count=count,
                address=address,
            )


def _lines_left_out(log: NmeaLog) -> Iterator[LeftOut]:
    """Lines that are not used, by kind and reason."""
    tally = log.tally
    if log.damaged_lines:
        yield LeftOut("", "", Text("holds NUL bytes"), log.damaged_lines)
    for kind, count in tally.senseless.items():
        if count:
            yield LeftOut(kind, "", Text("makes no sense") if kind else Text("is no sentence"), count)
    for kind, count in tally.cut.items():
        yield LeftOut(kind, "", Text("cut off"), count)
    for kind, count in tally.bad.items():
        yield LeftOut(kind, "", _CHECKSUM, count)
    lost = log.ordered.fates != USED
    found = Counter(zip(log.ordered.kinds[lost].tolist(), log.ordered.fates[lost].tolist(), strict=True))
    for (kind, fate), count in found.most_common():
        yield LeftOut(log.ordered.names[kind], "", _WHY[fate], count)


def _picked(ordered: Ordered, quantity: str, kinds: Iterable[str]) -> list[Picked]:
    """Readings of a quantity by instrument: of the better kind first, of one kind those with most first."""
    found: list[Picked] = []
    for kind in kinds:
        of_kind = [
            Picked(channel.address, held[quantity])
            for channel, held in ordered.readings.items()
            if quantity in held and kind in (channel.address[2:], channel.address)
        ]
        found += sorted(of_kind, key=lambda picked: -len(picked.held.time_s))
    # An instrument all of whose readings are flagged invalid serves only where there is no other.
    return sorted(found, key=lambda picked: quantity in ALONG_AXES and not picked.held.values[:, 2].any())


def series_of(name: str, dated: bool, quantity: str, picked: Picked) -> Series | None:
    """Series of a quantity from one instrument; None where it gives nothing.

    Parameters
    ----------
    name : str
        Of the file.
    dated : bool
        Whether its times have a date.
    quantity : str
        Attribute of `Recording`.
    picked : Picked
        The readings.
    """
    series = tidy(picked.held.time_s, picked.held.values, name, picked.address, dated=dated)
    if series is None or quantity not in ALONG_AXES:
        return series
    valid = series.values[:, 2] != 0.0
    return replace(series, values=np.where(valid[:, None], series.values[:, :2], 0.0), valid=valid)


def _positions(ordered: Ordered) -> list[Picked]:
    """Fixes by receiver, those of the one that gives most first.

    From GGA or GNS, which have the height, and RMC where they are silent; from GLL only where no other is.
    """
    receivers: defaultdict[Channel, dict[str, Held]] = defaultdict(dict)
    for kind in _PLACES:
        for (source, address), held in ordered.readings.items():
            if "position" in held and kind in (address[2:], address):
                receivers[Channel(source, address[:2] if kind != address else "")][kind] = held["position"]
    for kinds in receivers.values():
        if len(kinds) > 1:
            kinds.pop("GLL", None)
    found = [
        Picked(
            talker.address + "+".join(kinds),
            Held(*(np.concatenate(c) for c in zip(*kinds.values(), strict=True))),
        )
        for talker, kinds in receivers.items()
    ]
    return sorted(found, key=lambda picked: -len(picked.held.time_s))
