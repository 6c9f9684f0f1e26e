"""NMEA 0183 logs: lines to sentences to a `Recording`, and every fault of a line counted.

A line is a sentence with or without an ISO 8601 UTC stamp before it. Time is, in this order: the sentence's
own UTC (RMC, GGA; the stamp says which day), the line's stamp, the last time known. Only whole sentences with
a right checksum are used; a file in which too many are wrong is refused rather than used in part.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path

from navcore.errors import Fault, InputError
from navcore.io.nmea_sentences import DECODERS, Reading
from navcore.io.source import read_text

MOST_BAD_CHECKSUMS = 0.2
"""A file is refused when more than this share of its sentences (or of one kind used) has a wrong checksum."""
JITTER_S = 0.2
"""A sentence may be this much older than the latest of its kind; more is called time running backwards."""
_DAY = 86400.0
_CLOCK_WARNING_S = 5.0
_LINE = re.compile(
    r"(?:(?P<stamp>\d{4}-\d\d-\d\d[T ]\d\d:\d\d:\d\d(?:[.,]\d+)?(?:Z|[+-]\d\d:?\d\d)?)[\s,;]+)?"
    r"(?P<sentence>[$!](?P<address>[A-Z0-9]{3,10}),[^$!*]*(?:\*(?P<checksum>[0-9A-Fa-f]{2}))?)"
)
_SENTENCE_START = re.compile(r"[$!][A-Z]{2,9},")
_RMC_TIME = re.compile(r"\$..RMC,(\d{6}(?:\.\d+)?),A,[^*\n]*?,(\d\d)(\d\d)(\d\d),")


@dataclass
class Tally:
    """Running account of one file while its lines are read."""

    lines: int = 0
    intact: Counter[str] = field(default_factory=Counter)
    bad: Counter[str] = field(default_factory=Counter)
    unparsable: int = 0
    without_checksum: int = 0
    untimed: int = 0
    jitter: int = 0
    first_bad_line: int = 0
    dated: bool = True
    clock_offsets: list[float] = field(default_factory=list)
    times: dict[str, list[float]] = field(default_factory=dict)
    """Times of every intact sentence by address."""


@dataclass(frozen=True)
class NmeaLog:
    """What the lines of one file said.

    Attributes
    ----------
    readings : dict
        By sentence address (``GNRMC``): list of (UTC in s, reading).
    tally : Tally
        Counts of lines and faults.
    """

    readings: dict[str, list[tuple[float, Reading]]]
    tally: Tally


def looks_like_nmea(text: str) -> bool:
    """Whether something like a sentence, intact or not, is among the first lines."""
    return _SENTENCE_START.search(text, 0, 8192) is not None


def read_nmea(path: Path) -> NmeaLog:
    """Read one log.

    Raises
    ------
    InputError
        Empty or binary file, no usable sentence, no time, time running backwards, too many wrong checksums.
    """
    text = read_text(path)
    tally = Tally()
    readings: dict[str, list[tuple[float, Reading]]] = {}
    clock = _Clock(text, tally)
    latest: dict[str, float] = {}
    for number, stamp, sentence, address in _intact_sentences(text, tally):
        reading = _decode(sentence, address)
        if reading is None and _is_used(address):
            tally.unparsable += 1
            continue
        tally.intact[address] += 1
        time_s = clock.time_of(stamp, reading)
        if time_s is None:
            tally.untimed += reading is not None
            continue
        _require_forward(path, number, address, time_s, latest, tally)
        tally.times.setdefault(address, []).append(time_s)
        if reading is not None:
            readings.setdefault(address, []).append((time_s, reading))
    _refuse_unusable(path, tally, readings)
    return NmeaLog(readings, tally)


def _intact_sentences(text: str, tally: Tally) -> Iterator[tuple[int, float | None, str, str]]:
    """Yield (line number, UTC of the stamp, sentence, address) of intact lines; count the others."""
    from pynmea2 import NMEASentence

    for number, raw in enumerate(text.split("\n"), start=1):
        line = raw.strip()
        if not line or line.startswith("#"):
            continue
        tally.lines += 1
        match = _LINE.fullmatch(line)
        stamp = _stamp_seconds(match["stamp"]) if match is not None else None
        if match is None or (match["stamp"] is not None and stamp is None):
            tally.unparsable += 1
            continue
        sentence, address, checksum = match["sentence"], match["address"], match["checksum"]
        if checksum is None:
            tally.without_checksum += 1
        elif NMEASentence.checksum(sentence[1:-3]) != int(checksum, 16):
            tally.bad[address] += 1
            tally.first_bad_line = tally.first_bad_line or number
            continue
        yield number, stamp, sentence, address


def _is_used(address: str) -> bool:
    return len(address) == 5 and address[0] != "P" and address[2:] in DECODERS


def _decode(sentence: str, address: str) -> Reading | None:
    """Reading of a sentence of a used kind; None for other kinds and for nonsense in its fields."""
    if not _is_used(address):
        return None
    from pynmea2 import ParseError, parse

    try:
        return DECODERS[address[2:]](parse(sentence))
    except (ParseError, ValueError, TypeError, ArithmeticError, AttributeError):
        return None


class _Clock:
    """UTC of each line, from the stamps and from the sentences' own times."""

    def __init__(self, text: str, tally: Tally) -> None:
        self._tally = tally
        self._now: float | None = None
        first = _RMC_TIME.search(text)
        self._date: float | None = None
        if first is not None:
            day, month, year = (int(part) for part in first.groups()[1:])
            try:
                self._date = datetime(_full_year(year), month, day, tzinfo=UTC).timestamp()
            except ValueError:
                self._date = None

    def time_of(self, near: float | None, reading: Reading | None) -> float | None:
        own = reading.time_of_day if reading is not None else None
        if own is None:
            if near is not None:
                self._now = near
            return self._now
        if near is not None:
            self._now = _nearest_day(own, near)
            self._tally.clock_offsets.append(near - self._now)
        else:
            self._now = self._without_stamp(own, reading.day if reading is not None else None)
        return self._now

    def _without_stamp(self, own: float, day: float | None) -> float:
        if day is not None:
            return day + own
        if self._now is not None:
            return _nearest_day(own, self._now)
        self._tally.dated = self._date is not None
        return (self._date or 0.0) + own


def _full_year(two_digits: int) -> int:
    return two_digits + (1900 if two_digits >= 80 else 2000)


def _nearest_day(time_of_day: float, near: float) -> float:
    return time_of_day + _DAY * round((near - time_of_day) / _DAY)


def _stamp_seconds(stamp: str | None) -> float | None:
    if stamp is None:
        return None
    try:
        moment = datetime.fromisoformat(stamp)
    except ValueError:
        return None
    return (moment if moment.tzinfo else moment.replace(tzinfo=UTC)).timestamp()


def _require_forward(
    path: Path, number: int, address: str, time_s: float, latest: dict[str, float], tally: Tally
) -> None:
    before = latest.get(address)
    if before is None or time_s >= before:
        latest[address] = time_s
        return
    if before - time_s > JITTER_S + 1e-3:
        back = f"time runs backwards by {before - time_s:.1f} s ({address})"
        allowed = f"{back}: put the lines in order or split the file"
        raise InputError(Fault(f"{path.name}, line {number}", "", None, allowed))
    tally.jitter += 1


def _refuse_unusable(path: Path, tally: Tally, readings: dict[str, list[tuple[float, Reading]]]) -> None:
    def refuse(allowed: str) -> InputError:
        return InputError(Fault(path.name, "", None, allowed))

    total, bad = sum(tally.intact.values()) + tally.bad.total(), tally.bad.total()
    worst = [
        f"{address} {count} of {count + tally.intact[address]}"
        for address, count in tally.bad.items()
        if _is_used(address) and count > MOST_BAD_CHECKSUMS * (count + tally.intact[address])
    ]
    if bad > MOST_BAD_CHECKSUMS * total or worst:
        detail = f" ({', '.join(worst)})" if worst else ""
        raise refuse(
            f"{bad} of {total} sentences have a wrong checksum{detail}, the first in line "
            f"{tally.first_bad_line}; at most {MOST_BAD_CHECKSUMS:.0%} are tolerated"
        )
    if any(readings.values()):
        return
    if tally.untimed:
        raise refuse("no time: neither UTC stamps before the sentences nor an RMC or GGA sentence")
    kinds = ", ".join(sorted(DECODERS))
    if not total:
        raise refuse(f"not a log this reader knows: expected NMEA 0183 sentences ({kinds}) or a CSV table")
    found = ", ".join(sorted(tally.intact)) or "none intact"
    raise refuse(f"no usable sentence among {total} (found: {found}); expected {kinds}")


def nmea_warnings(tally: Tally) -> list[str]:
    """Plain words for what was left out or looks odd."""
    words: list[str] = []
    if tally.bad:
        words.append(
            f"{tally.bad.total()} sentences with a wrong checksum left out "
            f"(first: line {tally.first_bad_line})"
        )
    if tally.unparsable:
        words.append(f"{tally.unparsable} lines that are no sentence or make no sense left out")
    if tally.without_checksum:
        words.append(f"{tally.without_checksum} sentences without a checksum used unchecked")
    if tally.untimed:
        words.append(f"{tally.untimed} sentences before the first known time left out")
    if tally.jitter:
        words.append(f"{tally.jitter} sentences up to {JITTER_S} s out of order, sorted")
    if not tally.dated:
        words.append("times of day without a date: it cannot be joined with a dated file")
    if tally.clock_offsets:
        offset = sorted(tally.clock_offsets)[len(tally.clock_offsets) // 2]
        if abs(offset) > _CLOCK_WARNING_S:
            words.append(
                f"the stamps before the lines differ from the sentences' UTC by {offset:.0f} s (median)"
            )
    return words
