"""Lines of a log to sentences: a sentence is found wherever it stands in a line, and every fault is counted.

Before a sentence, or behind it, may stand a time (`navcore.io.stamps`), the name of the instrument, the
number of a record, an NMEA 4 tag block, quotes: whatever loggers and archives put there.
"""

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import reduce
from operator import xor
from typing import NamedTuple

from navcore.foundation.text import Text
from navcore.io.stamps import LONGEST_STAMP, Stamp, StampReader, day_comes_first

LONGEST_LINE = 2048
"""Longer lines are no sentences (an NMEA 0183 sentence has 82 characters) and are left out unread."""
MOST_KINDS = 200
"""Kinds of sentences counted one by one; the others are counted together."""
OTHER_KINDS = "others"
_ADDRESS = re.compile(r"[A-Z0-9]{3,10}")
_CHECKSUM = re.compile(r"[0-9A-Fa-f]{2}")
_PLAIN = re.compile(rf"([^$!]{{0,{LONGEST_STAMP}}})([$!]([A-Z0-9]{{3,10}}),[^$!*]*\*([0-9A-Fa-f]{{2}}))")
"""A line that holds a stamp, if any, and one sentence, as most do."""
_SENTENCE_START = re.compile(r"[$!][A-Z]{2,9},")
_SOURCE = re.compile(r"(?<![A-Za-z])[A-Za-z][A-Za-z_-]{1,30}\d{0,6}")
_WEEKDAYS = frozenset(Text("mon tue wed thu fri sat sun").split())
_FOLDED = 128
_HALVES = (512, 256, 128, 64, 32, 16, 8)
_QUOTES = " \t\"',;"
_LINES_LOOKED_AT = 20_000


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
    late: int = 0
    first_late: tuple[int, float, str] | None = None
    """Line, seconds and address of the first sentence whose time ran backwards."""
    first_bad_line: int = 0
    dated: bool = True
    local_time_s: float = 0.0
    """By how much the stamps are ahead of UTC, s."""
    clock_error_s: float = 0.0
    """By how much the logger's clock is ahead of the sentences' own UTC, s; taken off all its stamps."""
    doubts: Counter[tuple[str, str]] = field(default_factory=Counter)
    """Fixes that are not measured, by kind of sentence and what the receiver calls them."""
    clock_offsets: list[float] = field(default_factory=list)
    times: dict[str, list[float]] = field(default_factory=dict)
    """Times of every intact sentence by address."""

    def count(self, counter: Counter[str], address: str) -> str:
        """Count an address, or one of the many others; return what it was counted as."""
        name = address if address in counter or len(counter) < MOST_KINDS else OTHER_KINDS
        counter[name] += 1
        return name


class Line(NamedTuple):
    """An intact sentence and what stands beside it.

    Attributes
    ----------
    number : int
        Of the line, from 1.
    stamp : Stamp or None
        Time beside the sentence.
    source : str
        Name of the instrument, empty when none is given.
    address : str
        Such as ``GPGGA``.
    sentence : str
        From ``$`` to the checksum.
    """

    number: int
    stamp: Stamp | None
    source: str
    address: str
    sentence: str


def looks_like_nmea(text: str) -> bool:
    """Whether something like a sentence, intact or not, is among the first lines."""
    return _SENTENCE_START.search(text, 0, 8192) is not None


def intact_lines(text: str, tally: Tally) -> Iterator[Line]:
    """Yield the intact sentences in the order in which they stand; count the others."""
    lines = text.split("\n")
    stamps = StampReader(
        bool(day_comes_first(_before(line) for line in lines[:_LINES_LOOKED_AT] if "/" in line))
    )
    for number, raw in enumerate(lines, start=1):
        line = raw.strip()
        if not line or line.startswith("#"):
            continue
        tally.lines += 1
        fields = None if len(line) > LONGEST_LINE else _split(line)
        if fields is None:
            tally.unparsable += 1
            continue
        before, sentences, after = fields
        try:
            stamp, rest = stamps.read(before[-LONGEST_STAMP:]) if before else (None, "")
            if stamp is None and after:
                stamp, _ = stamps.read(after[:LONGEST_STAMP])
        except ValueError:
            tally.unparsable += 1
            continue
        source = _source(rest) if rest else ""
        for address, sentence, checksum in sentences:
            if checksum is None:
                tally.without_checksum += 1
            elif _exclusive_or(sentence[1:-3]) != int(checksum, 16):
                tally.count(tally.bad, address)
                tally.first_bad_line = tally.first_bad_line or number
                continue
            yield Line(number, stamp, source, address, sentence)


def _exclusive_or(body: str) -> int:
    """All characters, folded in halves as one large number: ten times as fast as one after the other."""
    if len(body) > _FOLDED or not body.isascii():
        return reduce(xor, map(ord, body), 0)
    folded = int.from_bytes(body.encode(), "little")
    for bits in _HALVES:
        folded ^= folded >> bits
    return folded & 0xFF


def _before(line: str) -> str:
    return line[: max(0, min(len(line), LONGEST_STAMP, _first_start(line)))]


def _first_start(line: str) -> int:
    starts = [position for position in (line.find("$"), line.find("!")) if position >= 0]
    return min(starts, default=-1)


def _split(line: str) -> tuple[str, list[tuple[str, str, str | None]], str] | None:
    """Text before, (address, sentence, checksum) of each sentence, text behind; None when there is none.

    Of several sentences run together, one without a checksum was cut off and is left out.
    """
    if plain := _PLAIN.fullmatch(line):
        before, sentence, address, checksum = plain.groups()
        return before, [(address, sentence, checksum)], ""
    first = _first_start(line)
    if first < 0:
        return None
    parts = re.split("[$!]", line[first:])[1:]
    position, fields, after = first, [], ""
    for part in parts:
        mark, position = line[position], position + 1 + len(part)
        sentence = _sentence(mark + part, alone=len(parts) == 1)
        if sentence is not None:
            fields.append(sentence[:3])
            after = sentence[3]
    return (line[:first], fields, after) if fields else None


def _sentence(text: str, alone: bool) -> tuple[str, str, str | None, str] | None:
    """Address, sentence, checksum and the text behind it; None when it makes no sense."""
    address, comma, _ = text[1:13].partition(",")
    if not comma or _ADDRESS.fullmatch(address) is None:
        return None
    body, star, rest = text.partition("*")
    if not star:
        return (address, body.rstrip(_QUOTES), None, "") if alone else None
    if _CHECKSUM.match(rest) is None:
        return None
    return address, f"{body}*{rest[:2]}", rest[:2], rest[2:]


def _source(rest: str) -> str:
    for word in _SOURCE.findall(rest):
        if word.lower()[:3] not in _WEEKDAYS or len(word) > 9:
            return word
    return ""
