"""Lines of a log to sentences: a sentence is found wherever it stands in a line, and every fault is counted.

Before a sentence, or behind it, may stand a time (`navcore.io.stamps`), the name of the instrument, the
number of a record, an NMEA 4 tag block, quotes: whatever loggers and archives put there.
"""

import re
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import reduce
from operator import xor

import numpy as np

from navcore.foundation.text import Text
from navcore.io.stamps import LONGEST_STAMP, Stamp, StampReader, day_comes_first

LONGEST_LINE = 2048
"""Longer lines are no sentences (an NMEA 0183 sentence has 82 characters) and are left out unread."""
MOST_KINDS = 200
"""Kinds of sentences counted one by one; the others are counted together."""
OTHER_KINDS = "others"
_ADDRESS = re.compile(r"[A-Z0-9]{3,10}")
_CHECKSUM = re.compile(r"[0-9A-Fa-f]{2}")
_PLAIN = re.compile(
    rf"([^$!]{{0,{LONGEST_STAMP}}})([$!]([A-Z0-9]{{3,10}}),[^$!*]*\*([0-9A-Fa-f]{{2}}))([^$!]*)"
)
"""A line that holds one sentence with a checksum and a stamp, if any, as most do."""
_SENTENCE_START = re.compile(r"[$!][A-Z]{2,9},")
_SOURCE = re.compile(r"(?<![A-Za-z])[A-Za-z][A-Za-z_-]{1,30}\d{0,6}")
_WEEKDAYS = frozenset(Text("mon tue wed thu fri sat sun").split())
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
    times: defaultdict[str, list[float]] = field(default_factory=lambda: defaultdict(list))
    """Times of every intact sentence by address."""

    def count(self, counter: Counter[str], address: str) -> str:
        """Count an address, or one of the many others; return what it was counted as."""
        name = address if address in counter or len(counter) < MOST_KINDS else OTHER_KINDS
        counter[name] += 1
        return name


Line = tuple[int, Stamp | None, str, str, str]
"""Number of the line, from 1; time beside the sentence; name of the instrument, empty when none is given;
address, such as ``GPGGA``; the intact sentence, from ``$`` to the checksum."""


def looks_like_nmea(text: str) -> bool:
    """Whether something like a sentence, intact or not, is among the first lines."""
    return _SENTENCE_START.search(text, 0, 8192) is not None


def intact_lines(text: str, tally: Tally) -> Iterator[Line]:
    """Yield the intact sentences in the order in which they stand; count the others."""
    lines = text.split("\n")
    stamps = StampReader(
        bool(day_comes_first(_before(line) for line in lines[:_LINES_LOOKED_AT] if "/" in line))
    )
    sums, end = _running_sums(text), -1
    for number, raw in enumerate(lines, start=1):
        begin, end = end + 1, end + 1 + len(raw)
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
        if line is not raw:
            begin += raw.index(line)
        for place, address, sentence, checksum in sentences:
            first = begin + place + 1
            if checksum is None:
                tally.without_checksum += 1
            elif _exclusive_or(sentence, sums, first) != int(checksum, 16):
                tally.count(tally.bad, address)
                tally.first_bad_line = tally.first_bad_line or number
                continue
            yield number, stamp, source, address, sentence


def _running_sums(text: str) -> bytes:
    """Exclusive or of all characters before each place: two of them give that of any sentence."""
    characters = np.frombuffer(text.encode("latin-1", "replace"), np.uint8)
    return b"\0" + np.bitwise_xor.accumulate(characters).tobytes()


def _exclusive_or(sentence: str, sums: bytes, first: int) -> int:
    """Of the characters between ``$`` and ``*``, the first of which stands at a place of the text."""
    if not sentence.isascii():  # the sums know no letter beyond Latin-1
        return reduce(xor, map(ord, sentence[1:-3]), 0)
    return sums[first] ^ sums[first + len(sentence) - 4]


def _before(line: str) -> str:
    return line[: max(0, min(len(line), LONGEST_STAMP, _first_start(line)))]


def _first_start(line: str) -> int:
    starts = [position for position in (line.find("$"), line.find("!")) if position >= 0]
    return min(starts, default=-1)


def _split(line: str) -> tuple[str, list[tuple[int, str, str, str | None]], str] | None:
    """Text before, (place, address, sentence, checksum) of each sentence, text behind; None without one.

    Of several sentences run together, one without a checksum was cut off and is left out.
    """
    if plain := _PLAIN.fullmatch(line):
        before, sentence, address, checksum, after = plain.groups()
        return before, [(len(before), address, sentence, checksum)], after
    first = _first_start(line)
    if first < 0:
        return None
    parts = re.split("[$!]", line[first:])[1:]
    position, fields, after = first, [], ""
    for part in parts:
        sentence = _sentence(line[position] + part, alone=len(parts) == 1)
        if sentence is not None:
            fields.append((position, *sentence[:3]))
            after = sentence[3]
        position += 1 + len(part)
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
