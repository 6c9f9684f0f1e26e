"""Readings of a whole NMEA 0183 log: its sentences decoded, timed, put in order and told apart by channel."""

from collections import defaultdict
from itertools import compress
from typing import NamedTuple

import numpy as np

from navcore.io.nmea_clock import Clock
from navcore.io.nmea_lines import Sentences, Tally
from navcore.io.nmea_sentences import decode

JITTER_S = 0.2
"""A sentence may be this much older than the latest of its kind; more is called time running backwards."""
MOST_SOURCES = 8
"""Words beside the sentences are instruments' names when there are no more different ones."""
_ROW = np.dtype(
    [("time_s", float), ("kind", np.int32), ("channel", np.int32), ("line", np.int32), ("invalid", bool)]
)
"""Of a sentence whose time is known; the channel is -1 when it says no more than that."""


class Channel(NamedTuple):
    """Sentences of one address from one instrument (empty when the lines name none)."""

    source: str
    address: str


Quantities = dict[str, tuple[np.ndarray, np.ndarray]]
"""By name: UTC in s, shape (n,), and values as of `navcore.io.nmea_sentences.Readings`, shape (n, k)."""


class Gathered:
    """Readings of one file, which are given in their order.

    Parameters
    ----------
    tally : Tally
        Told what is counted and what is left out.
    """

    def __init__(self, tally: Tally) -> None:
        self._tally = tally
        self._kinds: dict[str, int] = {}
        self._channels: dict[Channel, int] = {}
        self._rows = [np.empty(0, _ROW)]
        self._count = 0
        self._quantities: defaultdict[str, list[tuple[np.ndarray, np.ndarray]]] = defaultdict(list)

    def add(self, sentences: Sentences, clock: Clock) -> None:
        """Decode the next sentences and tell their times."""
        tally, addresses = self._tally, sentences.addresses
        readings = decode(sentences)
        sensible, invalid = readings.rows["sensible"], readings.rows["invalid"]
        tally.unparsable += int(np.count_nonzero(~sensible))
        tally.doubts.update(doubt for _, doubt in sorted(readings.doubts.items()))
        names = tally.count(tally.intact, compress(addresses, sensible))
        kinds = {address: self._kinds.setdefault(name, len(self._kinds)) for address, name in names.items()}
        time_s = np.fromiter(clock.times(sentences, readings.rows), float, len(addresses))
        timed = ~np.isnan(time_s)
        tally.untimed += int(np.count_nonzero(readings.rows["used"] & sensible & ~timed))
        row_of, telling = self._count - 1 + np.cumsum(timed), invalid.copy()
        for name, places, values in readings.quantities:
            telling[places] = True
            if name in ("water", "ground"):
                invalid[places] |= values[:, 2] == 0.0
            known = timed[places]
            self._quantities[name].append((row_of[places[known]], values[known]))
        rows = np.empty(np.count_nonzero(timed), _ROW)
        rows["time_s"], rows["invalid"] = time_s[timed], invalid[timed]
        rows["line"] = sentences.rows["line"][timed]
        rows["kind"] = [kinds[address] for address in compress(addresses, timed)]
        rows["channel"] = -1
        told, channels = timed & telling, self._channels
        rows["channel"][telling[timed]] = [
            channels.setdefault(channel, len(channels))
            for channel in map(Channel, compress(sentences.sources, told), compress(addresses, told))
        ]
        self._rows.append(rows)
        self._count += len(rows)

    def in_order(self) -> tuple[dict[Channel, Quantities], dict[str, np.ndarray]]:
        """Readings by channel, and the times of the sentences by kind; what runs backwards is left out."""
        rows = np.concatenate(self._rows)
        channel, kept = rows["channel"], ~self._late(rows)
        self._tally.used = int(np.count_nonzero(kept & (channel >= 0)))
        self._tally.invalid = int(np.count_nonzero(kept & (channel >= 0) & rows["invalid"]))
        times = {name: rows["time_s"][kept & (rows["kind"] == kind)] for name, kind in self._kinds.items()}
        names = _of_instruments(list(self._channels))
        codes = {name: code for code, name in enumerate(dict.fromkeys(names))}
        joined = np.array([codes[name] for name in names], int)
        readings: dict[Channel, Quantities] = {name: {} for name in codes}
        for quantity, parts in self._quantities.items():
            row, values = (np.concatenate(columns) for columns in zip(*parts, strict=True))
            row, values = row[kept[row]], values[kept[row]]
            order = np.lexsort((channel[row], joined[channel[row]]))
            row, values = row[order], values[order]
            bounds = np.searchsorted(joined[channel[row]], np.arange(len(codes) + 1))
            for name, begin, end in zip(codes, bounds, bounds[1:], strict=False):
                if begin < end:
                    readings[name][quantity] = rows["time_s"][row[begin:end]], values[begin:end]
        return readings, times

    def _late(self, rows: np.ndarray) -> np.ndarray:
        """Which times run backwards; they and those within the jitter are counted."""
        order = np.argsort(rows["channel"], kind="stable")
        order = order[np.searchsorted(rows["channel"][order], 0) :]
        starts = np.flatnonzero(np.diff(rows["channel"][order])) + 1
        back_s = np.zeros(len(rows))
        for part in np.split(order, starts):
            time_s = rows["time_s"][part]
            back_s[part] = np.maximum.accumulate(time_s) - time_s
        late = back_s > JITTER_S + 1e-3
        self._tally.jitter = int(np.count_nonzero((back_s > 0.0) & ~late))
        self._tally.late = int(np.count_nonzero(late))
        if self._tally.late:
            first = late.argmax()
            address = list(self._channels)[rows["channel"][first]].address
            self._tally.first_late = int(rows["line"][first]), float(back_s[first]), address
        return late


def _of_instruments(channels: list[Channel]) -> list[Channel]:
    """Join what only the words beside the sentences keep apart, when these are no instruments' names."""
    if len({channel.source for channel in channels}) <= MOST_SOURCES:
        return channels
    return [Channel("", channel.address) for channel in channels]
