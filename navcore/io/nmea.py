"""NMEA 0183 logs: sentences with their times, and the refusal of a file that cannot be trusted.

Only whole sentences with a right checksum are used; a file in which too many are wrong, or whose time runs
backwards, is refused rather than used in part.
"""

from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.io.nmea_clock import Clock
from navcore.io.nmea_lines import OTHER_KINDS, Tally, intact_lines
from navcore.io.nmea_sentences import KINDS, decode, is_used
from navcore.io.source import read_text

MOST_BAD_CHECKSUMS = 0.2
"""A file is refused when more than this share of its sentences (or of one kind used) has a wrong checksum."""
JITTER_S = 0.2
"""A sentence may be this much older than the latest of its kind; more is called time running backwards."""
MOST_LATE = 0.01
"""A file is refused when the time of more than this share of its used sentences runs backwards."""
MOST_SOURCES = 8
"""Words beside the sentences are instruments' names when there are no more different ones."""
_CLOCK_WARNING_S = 5.0
_MOST_NAMED = 12
_LOGGED_DAY = "UNIXD"


Row = tuple[Any, ...]


class Channel(NamedTuple):
    """Sentences of one address from one instrument (empty when the lines name none)."""

    source: str
    address: str


@dataclass(frozen=True)
class NmeaLog:
    """Content of the lines of one file.

    Attributes
    ----------
    readings : dict
        By channel: list of UTC in s and the fields of a `Reading`, as plain tuples, which the collector of
        garbage need not look through.
    tally : Tally
        Counts of lines and faults.
    warnings : tuple of str
        What was left out or looks odd.
    """

    readings: dict[Channel, list[Row]]
    tally: Tally
    warnings: tuple[str, ...]


def read_nmea(path: Path) -> NmeaLog:
    """Read one log.

    Raises
    ------
    InputError
        Empty or binary file, no usable sentence, no time, time running backwards, too many wrong checksums.
    """
    content = read_text(path)
    tally = Tally()
    readings: defaultdict[Channel, list[Row]] = defaultdict(list)
    clock = Clock(content.text, path.name, tally)
    latest: dict[Channel, float] = {}
    for number, stamp, source, address, sentence in intact_lines(content.text, tally):
        if address == _LOGGED_DAY:
            clock.logged(sentence)
        reading = decode(sentence, address)
        if reading is None and is_used(address):
            tally.unparsable += 1
            continue
        name = tally.count(tally.intact, address)
        if reading is not None and reading.doubt:
            tally.doubts[address, reading.doubt] += 1
        time_s = clock.time_of(stamp, reading)
        if time_s is None:
            tally.untimed += reading is not None
            continue
        if reading is None or reading.says_nothing:
            tally.times[name].append(time_s)
        elif _in_order(number, channel := Channel(source, address), time_s, latest, tally):
            tally.times[name].append(time_s)
            readings[channel].append((time_s, *reading))
    _refuse_unusable(path, tally, readings)
    warnings = (*content.warnings(), *_warnings(tally))
    return NmeaLog(_of_instruments(readings), tally, warnings)


def _in_order(
    number: int, channel: Channel, time_s: float, latest: dict[Channel, float], tally: Tally
) -> bool:
    before = latest.get(channel)
    if before is None or time_s >= before:
        latest[channel] = time_s
        return True
    if before - time_s <= JITTER_S + 1e-3:
        tally.jitter += 1
        return True
    tally.late += 1
    if tally.first_late is None:
        tally.first_late = (number, before - time_s, channel.address)
    return False


def _of_instruments(readings: dict[Channel, list[Row]]) -> dict[Channel, list[Row]]:
    """Join what only the words beside the sentences keep apart, when these are no instruments' names."""
    if len({channel.source for channel in readings}) <= MOST_SOURCES:
        return readings
    joined: dict[Channel, list[Row]] = {}
    for channel, rows in readings.items():
        joined.setdefault(Channel("", channel.address), []).extend(rows)
    return joined


def _refuse_unusable(path: Path, tally: Tally, readings: dict[Channel, list[Row]]) -> None:
    def refuse(allowed: str, line: int = 0) -> InputError:
        where = Text("{name}, line {line}", name=path.name, line=line) if line else path.name
        return InputError(Fault(where, "", None, allowed))

    used = sum(len(rows) for rows in readings.values())
    if tally.first_late is not None and tally.late > MOST_LATE * (used + tally.late):
        line, seconds, address = tally.first_late
        back = Text("time runs backwards by {seconds:.1f} s ({address})", seconds=seconds, address=address)
        raise refuse(Text("{back}: put the lines in order or split the file", back=back), line)
    total, bad = tally.intact.total() + tally.bad.total(), tally.bad.total()
    worst = [
        f"{address} {count}/{count + tally.intact[address]}"
        for address, count in tally.bad.items()
        if is_used(address) and count > MOST_BAD_CHECKSUMS * (count + tally.intact[address])
    ]
    if bad > MOST_BAD_CHECKSUMS * total or worst:
        detail = Text(" ({worst})", worst=", ".join(worst)) if worst else ""
        raise refuse(
            Text(
                "{bad} of {total} sentences have a wrong checksum{detail}, the first in line "
                "{first_bad_line}; at most {most_bad_checksums:.0%} are tolerated",
                bad=bad,
                total=total,
                detail=detail,
                first_bad_line=tally.first_bad_line,
                most_bad_checksums=MOST_BAD_CHECKSUMS,
            )
        )
    if used:
        return
    if tally.untimed:
        raise refuse(
            Text("no time: neither a time beside the sentences nor one with its own (RMC, GGA, ZDA)")
        )
    if not total:
        raise refuse(
            Text(
                "not a log this reader knows: expected NMEA 0183 sentences ({kinds}) or a CSV table",
                kinds=KINDS,
            )
        )
    addresses = _named(sorted(tally.intact)) or Text("none intact")
    raise refuse(
        Text(
            "no usable sentence among {total} (found: {found}); expected {kinds}",
            total=total,
            found=addresses,
            kinds=KINDS,
        )
    )


def _named(names: list[str]) -> str:
    more = Text(" and {names} more kinds", names=len(names) - _MOST_NAMED) if len(names) > _MOST_NAMED else ""
    return ", ".join(names[:_MOST_NAMED]) + more


def _warnings(tally: Tally) -> list[str]:
    """Say what was left out or looks odd."""
    words: list[str] = []
    if tally.bad:
        words.append(
            Text.plural(
                "{count} sentence with a wrong checksum left out (first: line {first_bad_line})",
                "{count} sentences with a wrong checksum left out (first: line {first_bad_line})",
                count=tally.bad.total(),
                first_bad_line=tally.first_bad_line,
            )
        )
    if tally.unparsable:
        words.append(
            Text(
                "{unparsable} lines that are no sentence or make no sense left out",
                unparsable=tally.unparsable,
            )
        )
    if tally.without_checksum:
        words.append(
            Text(
                "{without_checksum} sentences without a checksum used unchecked",
                without_checksum=tally.without_checksum,
            )
        )
    if tally.untimed:
        words.append(Text("{untimed} sentences before the first known time left out", untimed=tally.untimed))
    if tally.jitter:
        words.append(
            Text(
                "{jitter} sentences up to {jitter_s} s out of order, sorted",
                jitter=tally.jitter,
                jitter_s=JITTER_S,
            )
        )
    if tally.first_late is not None:
        words.append(
            Text.plural(
                "{count} sentence whose time runs backwards left out (first: line {first_late})",
                "{count} sentences whose time runs backwards left out (first: line {first_late})",
                count=tally.late,
                first_late=tally.first_late[0],
            )
        )
    if OTHER_KINDS in tally.intact:
        words.append(
            Text(
                "{intact} sentences of many further kinds counted together", intact=tally.intact[OTHER_KINDS]
            )
        )
    words += [
        Text(
            "{count} readings of {address} are {doubt}, by the receiver's own quality or mode: "
            "no truth to judge by",
            count=count, address=address, doubt=doubt,
        )
        for (address, doubt), count in tally.doubts.items()
    ]  # fmt: skip
    if not tally.dated:
        words.append(Text("times of day without a date: it cannot be joined with a dated file"))
    if tally.local_time_s:
        ahead = tally.local_time_s / HOUR
        words.append(
            Text(
                "the times beside the sentences are local time, {ahead:+g} h from UTC: "
                "corrected by the sentences' own UTC",
                ahead=ahead,
            )
        )
    if tally.clock_error_s:
        words.append(
            Text(
                "the logger's clock is {ahead:+.1f} s from the sentences' own UTC: taken off all its stamps",
                ahead=tally.clock_error_s,
            )
        )
    if tally.clock_offsets:
        offset = sorted(tally.clock_offsets)[len(tally.clock_offsets) // 2]
        if abs(offset) > _CLOCK_WARNING_S:
            words.append(
                Text(
                    "the stamps before the lines differ from the sentences' UTC by {offset:.0f} s (median)",
                    offset=offset,
                )
            )
    return words
