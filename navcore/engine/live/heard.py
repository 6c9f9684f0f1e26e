"""The newest sentences of a stream, read as a recording is."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from navcore.foundation.text import Text
from navcore.io.nmea import QUANTITY_NAMES, read_sentences
from navcore.io.nmea_lines import Tally
from navcore.io.nmea_readings import Ordered
from navcore.io.nmea_recording import Picked, instruments_of, series_of
from navcore.io.series import Recording, Series

NAME = Text("live")
"""Stands for the name of a file."""
MOST_CHARACTERS = 2 << 20
"""Of the lines that are kept at hand; the oldest go before the newest."""
_DAY = 86400.0
_BACK_S = 30.0
"""Times that run back by more begin a new stream: the sender was started again, or its clock was set."""


@dataclass
class Counts:
    """What became of the lines of a stream.

    Attributes
    ----------
    lines : int
        That are not empty.
    sentences : int
        With a right checksum, or without one.
    malformed : int
        Lines that are no sentence, make no sense, are cut off or have a wrong checksum.
    """

    lines: int = 0
    sentences: int = 0
    malformed: int = 0

    def add(self, tally: Tally) -> None:
        """Count further lines by their account."""
        self.sentences += tally.intact.total()
        self.malformed += tally.bad.total() + tally.unparsable
        self.lines += tally.lines


@dataclass(frozen=True)
class Reading:
    """What the newest part of a stream holds.

    Attributes
    ----------
    recording : Recording
        Of the instruments that were taken first.
    text : str
        The sentences.
    ordered : Ordered
        Their times.
    shift_s : float
        Added to the times of the sentences: whole days, where they have no date.
    """

    recording: Recording
    text: str
    ordered: Ordered
    shift_s: float

    @property
    def newest_s(self) -> float:
        """UTC of the newest position, s; minus infinity without one."""
        position = self.recording.position
        return -math.inf if position is None else float(position.time_s[-1])


@dataclass
class Heard:
    """Sentences of a stream back to a time, and which instrument gives each quantity.

    The instrument that gives a quantity first gives it for good: a second receiver on the same line does not
    take its place where sentences are lost.

    Attributes
    ----------
    counts : Counts
        Of all lines so far.
    pinned : dict
        Sentences that give each quantity.
    ran_back : bool
        The times of the last lines lay well before what was heard, which was dropped.
    """

    counts: Counts = field(default_factory=Counts)
    pinned: dict[str, str] = field(default_factory=dict)
    ran_back: bool = False
    _parts: list[tuple[str, float]] = field(default_factory=list)
    _newest_s: float = -math.inf

    def add(self, text: str) -> Reading | None:
        """Take further whole lines, and read what is at hand; None while nothing has a time.

        Parameters
        ----------
        text : str
            Each line ends with a line feed.
        """
        alone, tally = read_sentences(text, NAME)
        self.counts.add(tally)
        self.ran_back = self._runs_back(alone, tally)
        if self.ran_back:
            self.begin_anew()
        self._parts.append((text[-MOST_CHARACTERS:], math.inf))
        while self.size > MOST_CHARACTERS:
            self._parts.pop(0)
        whole = "".join(part for part, _ in self._parts)
        ordered, tally = read_sentences(whole, NAME)
        found = instruments_of(ordered)
        shift_s = 0.0 if tally.dated else self._days(found)
        self._pin(found)
        series = {
            name: one
            for name, sources in found.items()
            for picked in sources
            if _source(name, picked) == self.pinned.get(name)
            and (one := series_of(NAME, tally.dated, name, picked)) is not None
        }
        shifted: dict[str, Series] = {name: one.shifted(shift_s) for name, one in series.items()}
        recording = Recording(**shifted, sources=(), deviations={})
        reading = Reading(recording, whole, ordered, shift_s)
        if math.isfinite(reading.newest_s):
            self._newest_s = max(self._newest_s, reading.newest_s)
        self._parts[-1] = text, self._newest_s
        return reading if series else None

    @property
    def size(self) -> int:
        """Characters of the lines that are kept at hand."""
        return sum(len(part) for part, _ in self._parts)

    def _pin(self, found: Mapping[str, list[Picked]]) -> None:
        for name, sources in found.items():
            if sources and name not in self.pinned:
                self.pinned[name] = _source(name, sources[0])

    def _days(self, found: Mapping[str, list[Picked]]) -> float:
        """Whole days that bring times without a date to where the stream is."""
        newest = [float(picked.held.time_s[-1]) for sources in found.values() for picked in sources[:1]]
        if not newest or not math.isfinite(self._newest_s):
            return 0.0
        return _DAY * round((self._newest_s - max(newest)) / _DAY)

    def _runs_back(self, ordered: Ordered, tally: Tally) -> bool:
        """Whether further lines are of times that lie well before what was heard."""
        time_s = ordered.time_s[np.isfinite(ordered.time_s)]
        if not time_s.size or not math.isfinite(self._newest_s):
            return False
        back_s = self._newest_s - float(time_s.max())
        if not tally.dated:
            back_s -= _DAY * round(back_s / _DAY)
        return back_s > _BACK_S

    def forget_before(self, time_s: float) -> None:
        """Drop what is no longer needed: lines older than a time, UTC in s."""
        while len(self._parts) > 1 and self._parts[0][1] < time_s:
            self._parts.pop(0)

    def begin_anew(self) -> None:
        """Drop all lines, as when the sender was started again; the counts go on."""
        self._parts.clear()
        self._newest_s = -math.inf

    @property
    def described(self) -> str:
        """Name what gives each quantity."""
        named = [
            Text("{quantity} {sentences}", quantity=QUANTITY_NAMES[name], sentences=source)
            for name, source in self.pinned.items()
        ]
        return Text.joined(", ", named)


def _source(name: str, picked: Picked) -> str:
    """What stays the same of an instrument: a receiver gives its positions in several kinds of sentences."""
    return picked.address[:2] if name == "position" else picked.address
