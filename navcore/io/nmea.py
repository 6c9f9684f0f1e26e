"""NMEA 0183 logs: sentences with their times, and the refusal of a file that cannot be trusted.

Only whole sentences with a right checksum are used; a file in which too many are wrong, or whose time runs
backwards, is refused rather than used in part.
"""

from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.io.known_files import refuse_known_text
from navcore.io.nmea_clock import Clock
from navcore.io.nmea_lines import OTHER_KINDS, Tally, intact_sentences
from navcore.io.nmea_readings import JITTER_S, Gathered, Ordered
from navcore.io.nmea_sentences import KINDS, is_used
from navcore.io.source import read_text

MOST_BAD_CHECKSUMS = 0.2
"""A file is refused when more than this share of its sentences (or of one kind used) has a wrong checksum."""
MOST_LATE = 0.01
"""A file is refused when the time of more than this share of its used sentences runs backwards."""
QUANTITY_NAMES = {
    "position": Text("position"),
    "velocity": Text("velocity over ground"),
    "water": Text("speed through the water"),
    "ground": Text("speed over ground along axes"),
    "heading": Text("heading"),
    "attitude": Text("pitch and roll"),
    "position_sigma": Text("deviation of the position"),
    "velocity_sigma": Text("deviation of the velocity"),
    "heading_sigma": Text("deviation of the heading"),
    "attitude_sigma": Text("deviation of pitch and roll"),
}
"""Names of what sentences hold."""
_CLOCK_WARNING_S = 5.0
_MOST_NAMED = 12


@dataclass(frozen=True)
class NmeaLog:
    """Content of the lines of one file.

    Attributes
    ----------
    ordered : Ordered
        Quantities of each channel, and what becomes of each sentence.
    tally : Tally
        Counts of lines and faults.
    damaged_lines : int
        Lines that were left out for what they hold.
    warnings : tuple of str
        What was left out or looks odd.
    text : str
        Of the file.
    """

    ordered: Ordered
    tally: Tally
    damaged_lines: int
    warnings: tuple[str, ...]
    text: str = ""


def read_nmea(path: Path) -> NmeaLog:
    """Read one log.

    Raises
    ------
    InputError
        Empty or binary file, no usable sentence, no time, time running backwards, too many wrong checksums.
    """
    content = read_text(path)
    ordered, tally = read_sentences(content.text, path.name)
    tally.lines += content.damaged_lines
    _refuse_unusable(path, tally, content.text)
    return NmeaLog(
        ordered, tally, content.damaged_lines, (*content.warnings(), *_warnings(tally)), content.text
    )


def read_sentences(text: str, name: str) -> tuple[Ordered, Tally]:
    """Read the sentences of a text, whatever it holds.

    Parameters
    ----------
    text : str
        Lines that end with a line feed.
    name : str
        Of the file; some loggers put the year there.

    Returns
    -------
    ordered : Ordered
        Quantities of each channel, and what becomes of each sentence.
    tally : Tally
        Counts of lines and faults.
    """
    tally = Tally()
    clock = Clock(text, name, tally)
    gathered = Gathered(tally)
    for sentences in intact_sentences(text, tally):
        gathered.add(sentences, clock)
    return gathered.in_order(), tally


def _refuse_unusable(path: Path, tally: Tally, text: str) -> None:
    def refuse(allowed: str, line: int = 0) -> InputError:
        where = Text("{name}, line {line}", name=path.name, line=line) if line else path.name
        return InputError(Fault(where, "", None, allowed))

    late = tally.late.total()
    if tally.first_late is not None and late > MOST_LATE * (tally.used + late):
        line, seconds, address, advice = tally.first_late
        back = Text("time runs backwards by {seconds:.1f} s ({address})", seconds=seconds, address=address)
        raise refuse(Text("{back}: {advice}", back=back, advice=advice), line)
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
    if tally.used:
        return
    if tally.untimed:
        raise refuse(
            Text("no time: neither a time beside the sentences nor one with its own (RMC, GGA, ZDA)")
        )
    if not total:
        refuse_known_text(path.name, text)
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


def _counted(kinds: Counter[str]) -> str:
    """Kinds with their counts, the most frequent first, in brackets."""
    named = [f"{count} {kind}" for kind, count in kinds.most_common(_MOST_NAMED) if kind]
    return f" ({', '.join(named)})" if named else ""


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
    if tally.senseless.total():
        words.append(
            Text(
                "{unparsable} lines that are no sentence or make no sense left out{kinds}",
                unparsable=tally.senseless.total(),
                kinds=_counted(tally.senseless),
            )
        )
    if tally.cut:
        words.append(
            Text.plural(
                "{count} sentence that is cut off left out{kinds}: its checksum, or fields and checksum, are "
                "missing",
                "{count} sentences that are cut off left out{kinds}: their checksum, or fields and checksum, "
                "are missing",
                count=tally.cut.total(),
                kinds=_counted(tally.cut),
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
        words.append(
            Text(
                "{untimed} sentences before the first known time left out{kinds}",
                untimed=tally.untimed.total(),
                kinds=_counted(tally.untimed),
            )
        )
    if tally.empty:
        words.append(
            Text.plural(
                "{count} sentence without a reading in its fields left out{kinds}",
                "{count} sentences without a reading in their fields left out{kinds}",
                count=tally.empty.total(),
                kinds=_counted(tally.empty),
            )
        )
    words += [
        Text(
            "{count} readings of the {quantity} ({address}) flagged invalid by the instrument",
            count=count,
            quantity=QUANTITY_NAMES[quantity],
            address=address,
        )
        for (address, quantity), count in tally.flagged.items()
    ]
    if tally.spread:
        words.append(
            Text(
                "{spread} sentences without a time of their own lie between two known times: spread evenly "
                "between "
                "them",
                spread=tally.spread,
            )
        )
    words += tally.notes
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
                count=tally.late.total(),
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
