"""Lines of a log to sentences: a sentence is found wherever it stands in a line, and every fault is counted.

Before a sentence, or behind it, may stand a time (`navcore.io.stamps`), the name of the instrument, the
number of a record, an NMEA 4 tag block, quotes: whatever loggers and archives put there.
"""

import math
import re
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import compress, repeat
from typing import Any, NamedTuple

import numpy as np

from navcore.foundation.text import Text
from navcore.io.iso_stamps import iso_seconds
from navcore.io.nmea_plain import LONGEST_LINE, Block, lines_of
from navcore.io.stamps import LONGEST_STAMP, StampReader, day_comes_first

MOST_KINDS = 200
"""Kinds of sentences counted one by one; the others are counted together."""
OTHER_KINDS = "others"
_ADDRESS = re.compile(r"[A-Z0-9]{3,10}")
_CHECKSUM = re.compile(r"[0-9A-Fa-f]{2}")
_SENTENCE_START = re.compile(r"[$!][A-Z]{2,9},")
_SOURCE = re.compile(r"(?<![A-Za-z])[A-Za-z][A-Za-z_-]{1,30}\d{0,6}")
_WEEKDAYS = frozenset(Text("mon tue wed thu fri sat sun").split())
_QUOTE = re.compile("[\"']")
_LINES_LOOKED_AT = 20_000
_BLOCK = 1 << 18
"""Characters of a block: as many lines as are worth an array, and few enough to bound the memory."""


@dataclass
class Tally:
    """Running account of one file while its lines are read."""

    lines: int = 0
    intact: Counter[str] = field(default_factory=Counter)
    bad: Counter[str] = field(default_factory=Counter)
    senseless: Counter[str] = field(default_factory=Counter)
    """Lines that make no sense by their address; without one, those that are no sentence."""
    cut: Counter[str] = field(default_factory=Counter)
    """Sentences that are cut off: no whole checksum, or neither that nor all fields of their kind."""
    without_checksum: int = 0
    untimed: Counter[str] = field(default_factory=Counter)
    empty: Counter[str] = field(default_factory=Counter)
    """Sentences whose fields say nothing."""
    spread: int = 0
    """Sentences without a time of their own that share the time between two others."""
    jitter: int = 0
    late: Counter[str] = field(default_factory=Counter)
    first_late: tuple[int, float, str, str] | None = None
    """Line, seconds and address of the first sentence whose time ran backwards, and what to do about it."""
    first_bad_line: int = 0
    dated: bool = True
    local_time_s: float = 0.0
    """By how much the stamps are ahead of UTC, s."""
    clock_error_s: float = 0.0
    """By how much the logger's clock is ahead of the sentences' own UTC, s; taken off all its stamps."""
    doubts: Counter[tuple[str, str]] = field(default_factory=Counter)
    """Fixes that are not measured, by kind of sentence and what the receiver calls them."""
    clock_offsets: list[float] = field(default_factory=list)
    used: int = 0
    """Readings."""
    invalid: int = 0
    """Sentences of which the instrument calls a reading invalid."""
    flagged: Counter[tuple[str, str]] = field(default_factory=Counter)
    """These readings by address and quantity."""
    notes: list[str] = field(default_factory=list)
    """What was found of the times."""

    @property
    def unparsable(self) -> int:
        """Lines that are no sentence, make no sense or are cut off."""
        return self.senseless.total() + self.cut.total()

    def count(self, counter: Counter[str], addresses: Iterable[str]) -> dict[str, str]:
        """Count addresses, each or as one of the many others; return what they were counted as."""
        names: dict[str, str] = {}
        for address, times in Counter(addresses).items():
            name = address if address in counter or len(counter) < MOST_KINDS else OTHER_KINDS
            counter[name] += times
            names[address] = name
        return names


SENTENCE = np.dtype(
    [("line", int), ("begin", int), ("end", int), ("checksum", int), ("stamp_s", float), ("dated", bool)]
)
"""Of a sentence: the number of its line, from 1; its place, from the address to the checksum; the checksum
that is written, negative without one; the time beside it, NaN without one, and whether that has a date (UTC,
s since 1970, else s after midnight)."""


class Sentences(NamedTuple):
    """n intact sentences of successive lines.

    Attributes
    ----------
    block : Block
        In which they stand.
    rows : ndarray of `SENTENCE`, shape (n,)
        Their places and stamps.
    sources : list of str
        Name of the instrument, empty when none is given.
    addresses : list of str
        Such as ``GPGGA``.
    """

    block: Block
    rows: np.ndarray
    sources: list[str]
    addresses: list[str]


def looks_like_nmea(text: str) -> bool:
    """Whether something like a sentence, intact or not, is among the first lines."""
    return _SENTENCE_START.search(text, 0, 8192) is not None


def intact_sentences(text: str, tally: Tally) -> Iterator[Sentences]:
    """Yield blocks of the intact sentences in the order in which they stand; count the others."""
    head = text.split("\n", _LINES_LOOKED_AT)[:_LINES_LOOKED_AT]
    stamps = StampReader(bool(day_comes_first(_before(line) for line in head if "/" in line)))
    begin, number = 0, 1
    while begin < len(text):
        end = text.rfind("\n", begin, begin + _BLOCK) + 1 or text.find("\n", begin) + 1 or len(text)
        lines = text[begin:end]
        if len(lines) > _BLOCK:  # one line
            lines = f"{lines.strip()[: LONGEST_LINE + 1]}\n"
        yield _intact(Block(lines), number, stamps, tally)
        begin, number = end, number + lines.count("\n")


def _intact(block: Block, first: int, stamps: StampReader, tally: Tally) -> Sentences:
    """Sentences of a block whose first line has a number; those with a wrong checksum are left out."""
    lines = lines_of(block)
    stamp_s = iso_seconds(block.letters, lines["begin"], lines["mark"])
    regular = lines["plain"] & (lines["star"] + 3 == lines["end"])
    regular &= (lines["mark"] == lines["begin"]) | ~np.isnan(stamp_s)
    row, odd = np.flatnonzero(regular), np.flatnonzero(~regular & (lines["begin"] < lines["end"]))
    others = list(_others(block.text, zip(odd.tolist(), lines[odd].tolist(), strict=True), stamps, tally))
    tally.lines += row.size
    rows = np.empty(row.size + len(others), SENTENCE)
    plain = lines[row]
    columns = row, plain["mark"] + 1, plain["star"], plain["checksum"], stamp_s[row], True
    for name, column in zip(SENTENCE.names or (), columns, strict=True):
        rows[name][: row.size] = column
    rows[row.size :] = [values for _, values in others]
    sources = [*repeat("", row.size), *(source for source, _ in others)]
    order = np.argsort(rows["line"], kind="stable")
    rows = rows[order]
    rows["line"] += first
    addresses = block.texts(
        rows["begin"], np.minimum(block.next_of(block.commas, rows["begin"]), rows["end"])
    )
    sums = np.append(np.uint32(0), np.bitwise_xor.accumulate(block.letters))
    proven = rows["checksum"] >= 0
    wrong = proven & (sums[rows["end"]] ^ sums[rows["begin"]] != rows["checksum"])
    tally.without_checksum += int(np.count_nonzero(~proven))
    if wrong.any():
        tally.count(tally.bad, compress(addresses, wrong))
        tally.first_bad_line = tally.first_bad_line or int(rows["line"][wrong.argmax()])
        rows, order, addresses = rows[~wrong], order[~wrong], list(compress(addresses, ~wrong))
    return Sentences(block, rows, [sources[row] for row in order.tolist()], addresses)


def _others(
    text: str, lines: Iterable[tuple[int, tuple[Any, ...]]], stamps: StampReader, tally: Tally
) -> Iterator[tuple[str, tuple[Any, ...]]]:
    """Instruments and rows of the lines that hold more than an ISO 8601 stamp and one sentence."""
    for line, (begin, end, plain, mark, star, checksum) in lines:
        if plain:
            before, sentences, after = text[begin:mark], [(mark + 1, star, checksum)], text[star + 3 : end]
            cut: list[str] = []
        else:
            content = text[begin:end].lstrip()
            begin, content = end - len(content), content.rstrip()
            if not content or content[0] == "#":
                continue
            before, sentences, after, cut = _split(content, begin)
            tally.count(tally.cut, cut)
        tally.lines += max(1, len(sentences) + len(cut))
        stamp, rest = None, ""
        try:
            if before:
                stamp, rest = stamps.read(before[-LONGEST_STAMP:])
            if stamp is None and after:
                stamp, _ = stamps.read(after.rstrip()[:LONGEST_STAMP])
        except ValueError:
            tally.count(tally.senseless, (text[begin : begin + 5] for begin, _, _ in sentences))
            sentences = []
        else:
            tally.senseless[""] += not sentences and not cut
        source = _source(rest) if rest else ""
        seconds, dated = stamp or (math.nan, True)
        for sentence in sentences:
            yield source, (line, *sentence, seconds, dated)


def _before(line: str) -> str:
    return line[: max(0, min(len(line), LONGEST_STAMP, _first_start(line)))]


def _first_start(line: str) -> int:
    starts = [position for position in (line.find("$"), line.find("!")) if position >= 0]
    return min(starts, default=-1)


def _split(line: str, place: int) -> tuple[str, list[tuple[int, int, int]], str, list[str]]:
    """Text before, (begin, end, checksum) of each sentence of a line that stands at a place, text behind.

    The last value are the addresses of those that are cut off: within their checksum, or, of several
    sentences run together, without one.
    """
    first = _first_start(line)
    if first < 0 or len(line) > LONGEST_LINE:
        return "", [], "", []
    parts = re.split("[$!]", line[first:])[1:]
    begin, sentences, after = place + first + 1, list[tuple[int, int, int]](), ""
    cut: list[str] = []
    for part in parts:
        found = _sentence(part, alone=len(parts) == 1)
        if found is not None:
            size, checksum, after = found
            sentences.append((begin, begin + size, checksum))
        elif _address(part):
            cut.append(_address(part))
        begin += 1 + len(part)
    return (line[:first] if sentences else ""), sentences, after, cut


def _sentence(text: str, alone: bool) -> tuple[int, int, str] | None:
    """Length from the address to the checksum, checksum, and the text behind it; None without sense."""
    if not _address(text):
        return None
    body, star, rest = text.partition("*")
    if not star:
        # Commas at the end are empty fields, by which a whole sentence is told from one that is cut off.
        return (len(_QUOTE.split(body, maxsplit=1)[0].rstrip(" \t;")), -1, "") if alone else None
    if _CHECKSUM.match(rest) is None:
        return None
    return len(body), int(rest[:2], 16), rest[2:]


def _address(text: str) -> str:
    """Address with which a text begins; empty where it does not."""
    address, comma, _ = text[:12].partition(",")
    return address if comma and _ADDRESS.fullmatch(address) else ""


def _source(rest: str) -> str:
    for word in _SOURCE.findall(rest):
        if word.lower()[:3] not in _WEEKDAYS or len(word) > 9:
            return word
    return ""
