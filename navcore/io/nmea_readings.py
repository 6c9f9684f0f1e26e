"""Readings of a whole NMEA 0183 log: its sentences decoded, timed, put in order and told apart by channel."""

from collections import Counter, defaultdict
from itertools import compress
from typing import NamedTuple

import numpy as np

from navcore.foundation.text import Text
from navcore.io.nmea_clock import Clock
from navcore.io.nmea_lines import Sentences, Tally
from navcore.io.nmea_makers import ABOUT_OTHERS, OTHER_MESSAGE
from navcore.io.nmea_sentences import ALONG_AXES, NOT_GIVEN, decode
from navcore.io.times.between import are_doubled, by_kind, coarse, filled, trusted
from navcore.io.times.doubts import trust_of
from navcore.io.times.repeats import there_again
from navcore.io.times.steps import back_advice, without_leap_step

JITTER_S = 0.2
"""A sentence may be this much older than the latest of its kind; more is called time running backwards."""
MOST_SOURCES = 8
"""Words beside the sentences are instruments' names when there are no more different ones."""
UNREAD, INVALID, EMPTY, UNTIMED, UNSET, LATE, REPEATED, OTHER, USED = range(9)
"""What becomes of a sentence: its kind is not read; a flag calls it invalid; its fields say nothing; no time
is known; its date is that of a clock that was not set; its time runs backwards; another stands at its time;
another instrument is taken; it is used."""
_ROW = np.dtype([
    ("time_s", float), ("doubtful", bool), ("own", bool), ("kind", np.int32), ("channel", np.int32),
    ("line", np.int32), ("invalid", bool), ("fate", np.int8), ("id", np.int32),
])  # fmt: skip
"""Of a sentence that makes sense: the time that it gives, NaN without; whether a receiver without a fix gave
it, and whether it is no stamp; a number that is equal for sentences that are the same; the channel is -1
when it says no more than its time."""


class Channel(NamedTuple):
    """Sentences of one address from one instrument (empty when the lines name none)."""

    source: str
    address: str


class Held(NamedTuple):
    """A quantity of one channel: UTC in s, (n,), values, (n, k), and the numbers of its sentences."""

    time_s: np.ndarray
    values: np.ndarray
    rows: np.ndarray


Quantities = dict[str, Held]
"""By name; values as of `navcore.io.nmea_sentences.Readings`."""


class Ordered(NamedTuple):
    """Readings of one file.

    Attributes
    ----------
    readings : dict
        Quantities of each channel.
    times : dict
        By kind, as the tally has it: times of its sentences, s.
    fates : ndarray of int8, shape (n,)
        What becomes of each sentence; those of the readings are `OTHER` until they are taken.
    kinds : ndarray of int, shape (n,)
        Of each sentence: places among the names.
    names : list of str
        Of the kinds.
    lines, time_s : ndarray, shape (n,)
        Line and time (s, NaN without) of each sentence.
    """

    readings: dict[Channel, Quantities]
    times: dict[str, np.ndarray]
    fates: np.ndarray
    kinds: np.ndarray
    names: list[str]
    lines: np.ndarray
    time_s: np.ndarray


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
        self._carried: dict[str, int] = {}
        self._quantities: defaultdict[str, list[tuple[np.ndarray, np.ndarray]]] = defaultdict(list)

    def add(self, sentences: Sentences, clock: Clock) -> None:
        """Decode the next sentences and tell the times that they give."""
        tally, addresses = self._tally, sentences.addresses
        readings = decode(sentences, self._carried)
        sensible, invalid = readings.rows["sensible"], readings.rows["invalid"]
        if not sensible.all():
            cut = readings.rows["cut"]
            tally.count(tally.cut, compress(addresses, cut))
            tally.without_checksum -= int(np.count_nonzero(cut))
            tally.count(tally.senseless, compress(addresses, ~sensible & ~cut))
        tally.doubts.update(dict(sorted(readings.doubts.items())))
        tally.flagged.update(dict(sorted(readings.invalid.items())))
        names = tally.count(tally.intact, compress(addresses, sensible))
        kinds = {address: self._kinds.setdefault(name, len(self._kinds)) for address, name in names.items()}
        time_s, doubtful = clock.times(sentences, readings.rows)
        row_of, telling = self._count - 1 + np.cumsum(sensible), invalid.copy()
        role = readings.rows["role"]
        fates = np.where(readings.rows["used"], np.where(invalid, INVALID, EMPTY), UNREAD).astype(np.int8)
        fates[role == OTHER_MESSAGE], fates[role == ABOUT_OTHERS] = UNREAD, USED
        for name, places, values in readings.quantities:
            telling[places] = True
            fates[places] = OTHER
            if name in ALONG_AXES:
                invalid[places] |= values[:, 2] == 0.0
            self._quantities[name].append((row_of[places], values))
        rows = np.empty(np.count_nonzero(sensible), _ROW)
        rows["time_s"], rows["invalid"] = time_s[sensible], invalid[sensible]
        rows["doubtful"], rows["fate"] = doubtful[sensible], fates[sensible]
        rows["own"] = (~np.isnan(readings.rows["time_of_day"]) & ~(invalid & ~doubtful))[sensible]
        rows["line"] = sentences.rows["line"][sensible]
        rows["id"] = _ids(sentences.rows)[sensible]
        rows["kind"] = [kinds[address] for address in compress(addresses, sensible)]
        rows["channel"] = -1
        told, channels = sensible & telling, self._channels
        rows["channel"][telling[sensible]] = [
            channels.setdefault(channel, len(channels))
            for channel in map(Channel, compress(sentences.sources, told), compress(addresses, told))
        ]
        self._rows.append(rows)
        self._count += len(rows)

    def in_order(self) -> Ordered:
        """Readings by channel; what has no time, or one that cannot be, is left out and counted."""
        rows = np.concatenate(self._rows)
        self._tell_absent(rows)
        self._tell_times(rows)
        channel, fates = rows["channel"], rows["fate"]
        kept = fates >= OTHER
        self._tally.used = int(np.count_nonzero((channel >= 0) & (kept | (fates == INVALID))))
        self._tally.invalid = int(
            np.count_nonzero((channel >= 0) & rows["invalid"] & (kept | (fates == INVALID)))
        )
        timed = ~np.isnan(rows["time_s"]) & (fates != LATE) & (fates != UNSET)
        times = {name: rows["time_s"][timed & (rows["kind"] == kind)] for name, kind in self._kinds.items()}
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
                    part = row[begin:end]
                    readings[name][quantity] = Held(rows["time_s"][part], values[begin:end], part)
        return Ordered(readings, times, fates, rows["kind"], list(self._kinds), rows["line"], rows["time_s"])

    def _tell_absent(self, rows: np.ndarray) -> None:
        """Drop the speeds that a kind of sentence never gives; an empty one of another kind is invalid.

        A log that measures no speed over ground sends empty fields with the flag of an invalid reading.
        """
        names = list(self._kinds)
        for quantity in ALONG_AXES:
            if quantity not in self._quantities:
                continue
            row, values = (
                np.concatenate(columns) for columns in zip(*self._quantities[quantity], strict=True)
            )
            kinds, empty = rows["kind"][row], values[:, 2] == NOT_GIVEN
            absent = np.bincount(kinds, ~empty, len(names))[kinds] == 0
            lost = empty & ~absent
            values[lost, 2] = 0.0
            rows["invalid"][row[lost]] = True
            self._tally.flagged.update((names[kind], quantity) for kind in kinds[lost].tolist())
            self._quantities[quantity] = [(row[~absent], values[~absent])]
            if not absent.any():
                continue
            if quantity == "water":
                self._tally.notes += [
                    Text(
                        "{address} gives no speed through the water: its field is empty in all {count} "
                        "sentences",
                        address=names[kind],
                        count=count,
                    )
                    for kind, count in Counter(kinds[absent].tolist()).items()
                ]
            others = [
                part for name, parts in self._quantities.items() if name != quantity for part, _ in parts
            ]
            alone = np.setdiff1d(row[absent], np.concatenate([row[:0], *others]))
            rows["fate"][alone[rows["fate"][alone] == OTHER]] = EMPTY
        self._quantities = defaultdict(
            list,
            {name: parts for name, parts in self._quantities.items() if any(len(row) for row, _ in parts)},
        )

    def _tell_times(self, rows: np.ndarray) -> None:
        """Give every sentence its time, in place, and mark those that have none or one that cannot be."""
        tally = self._tally
        again = there_again(rows["time_s"], rows["own"], rows["id"], lambda: self._changes(rows))
        rows["time_s"][again] = np.nan
        rows["fate"][again & (rows["fate"] >= OTHER)] = REPEATED
        given = trusted(rows["time_s"], rows["doubtful"])
        rows["time_s"][~given] = np.nan
        clock = given & rows["own"] & ~again
        if tally.dated:
            mended, count, leaps = without_leap_step(rows["time_s"][clock])
            if count:
                rows["time_s"][clock] = mended
                tally.notes.append(
                    Text(
                        "{count} times of the receiver before it knew the leap seconds are {leaps} s ahead "
                        "of UTC: "
                        "taken off",
                        count=count,
                        leaps=leaps,
                    )
                )
        fates, ids = rows["fate"], rows["id"]
        stamps = np.where(rows["own"], np.nan, rows["time_s"])
        finer = coarse(stamps, rows["channel"], ids)
        rows["time_s"][finer] = np.nan
        if are_doubled(np.where(rows["own"], rows["time_s"], np.nan), rows["channel"], ids):
            fates[self._repeated(rows) & (fates >= OTHER)] = REPEATED
        rows["time_s"], tally.spread = filled(rows["time_s"], np.where(fates < OTHER, -1, rows["channel"]))
        # A sentence that says nothing but its time is used as the clock.
        fates[(fates == EMPTY) & clock] = USED
        untimed = np.isnan(rows["time_s"]) & (fates >= OTHER)
        fates[untimed] = UNTIMED
        timed = np.flatnonzero(~np.isnan(rows["time_s"]))
        if tally.dated and timed.size:
            trust = trust_of(rows["time_s"][timed], Text("sentences"))
            unset = timed[~trust.kept]
            fates[unset[fates[unset] >= OTHER]] = UNSET
            rows["time_s"][unset] = np.nan
            tally.notes += trust.warnings
        late = self._late(rows)
        fates[late & (fates >= OTHER)] = LATE
        names = list(self._kinds)
        for counter, fate in ((tally.untimed, UNTIMED), (tally.empty, EMPTY), (tally.late, LATE)):
            found = Counter(rows["kind"][fates == fate].tolist())
            counter.update({names[kind]: count for kind, count in found.items()})

    def _changes(self, rows: np.ndarray) -> np.ndarray:
        """Which sentences have another reading than the one of their channel before."""
        found = np.zeros(len(rows), bool)
        for parts in self._quantities.values():
            row, values = (np.concatenate(columns) for columns in zip(*parts, strict=True))
            order = np.lexsort((row, rows["channel"][row]))
            other = (np.diff(np.nan_to_num(values[order]), axis=0) != 0.0).any(axis=1)
            found[row[order][1:][other & (np.diff(rows["channel"][row[order]]) == 0)]] = True
        return found

    def _repeated(self, rows: np.ndarray) -> np.ndarray:
        """Which sentences without a time are the same as the one of their channel before, at one time."""
        given = ~np.isnan(rows["time_s"])
        turn = np.cumsum(
            given & (np.concatenate([[1.0], np.diff(filled(rows["time_s"], -rows["kind"] - 1)[0])]) != 0.0)
        )
        order = by_kind(rows["channel"])
        same = np.concatenate([[False], np.diff(rows["channel"][order]) == 0])
        for column in (turn, rows["id"]):
            same[1:] &= np.diff(column[order]) == 0
        found = np.zeros(len(rows), bool)
        found[order[same]] = True
        return found & ~given

    def _late(self, rows: np.ndarray) -> np.ndarray:
        """Which times run backwards; they and those within the jitter are counted."""
        order = by_kind(rows["channel"])
        order = order[np.searchsorted(rows["channel"][order], 0) :]
        order = order[~np.isnan(rows["time_s"][order])]
        starts = np.flatnonzero(np.diff(rows["channel"][order])) + 1
        back_s = np.zeros(len(rows))
        for part in np.split(order, starts):
            time_s = rows["time_s"][part]
            back_s[part] = np.maximum.accumulate(time_s) - time_s
        late = back_s > JITTER_S + 1e-3
        self._tally.jitter = int(np.count_nonzero((back_s > 0.0) & ~late))
        if late.any():
            first = int(late.argmax())
            address = list(self._channels)[rows["channel"][first]].address
            of_channel = order[rows["channel"][order] == rows["channel"][first]]
            place = int(np.searchsorted(of_channel, first)) - 1
            advice = back_advice(rows["time_s"][of_channel], place, self._tally.dated)
            self._tally.first_late = int(rows["line"][first]), float(back_s[first]), address, advice
        return late


def _ids(sentences: np.ndarray) -> np.ndarray:
    """Numbers of sentences, equal for those that are the same (by checksum and length), shape (n,)."""
    same = (sentences["checksum"] << 8) + (sentences["end"] - sentences["begin"])
    return np.where(sentences["checksum"] < 0, -sentences["line"], same)


def _of_instruments(channels: list[Channel]) -> list[Channel]:
    """Join what only the words beside the sentences keep apart, when these are no instruments' names."""
    if len({channel.source for channel in channels}) <= MOST_SOURCES:
        return channels
    return [Channel("", channel.address) for channel in channels]
