"""Recordings in iXblue (Exail) STDBIN: output of the INS with its deviations, and the logs that aid it."""

import calendar
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.inputs import read_bytes
from navcore.foundation.text import Text
from navcore.foundation.units import DEG
from navcore.io.formats import Candidate
from navcore.io.series import LeftOut, Recording, Series, SourceReport, stream_report, tidy
from navcore.io.source import LARGEST_FILE_BYTES
from navcore.io.stdbin_layout import (
    EM_LOG,
    GROUND_SPEED,
    LARGEST_FRAME,
    MARK,
    VERSIONS,
    WATER_SPEED,
    Head,
    head_at,
    layout,
)

MOST_DAMAGED = 0.2
"""A file is refused when more than this share of its frames is damaged."""
_MOST_LOOKED_AT = 1000
"""Damaged frames after which a file that has fewer whole ones is not looked at any further."""
_TICK_S, _DAY = 1e-4, 86400.0
_KIND = Text("iXblue STDBIN")


def recognises(candidate: Candidate) -> bool:
    """Whether the file begins with a frame."""
    head = candidate.head
    return head[:2] == MARK and len(head) > 3 and head[2] in VERSIONS


def read(path: Path) -> Recording:
    """Read a recording of frames.

    Raises
    ------
    InputError
        No whole frame, more than a fifth of them damaged, or nothing in them that is read; names the place.
    """
    data = read_bytes(path, LARGEST_FILE_BYTES)
    frames = _frames(data)
    _refuse(path, frames)
    groups = [_read_group(data, head, places) for head, places in frames.places.items()]
    times = _Times(groups)
    position, velocity = _series(times, "lat lon height"), _series(times, "ve vn")
    heading, attitude = _series(times, "heading"), _series(times, "pitch roll")
    taken = {
        "position": _made(path, times, position, (DEG, DEG, 1.0), "position"),
        "velocity": _made(path, times, velocity, (1.0, 1.0), "speed"),
        "heading": _made(path, times, heading, (DEG,), "heading"),
        "attitude": _made(path, times, attitude, (-DEG, DEG), "attitude"),
        "water": _log(path, times, ((EM_LOG, "EM log"), (WATER_SPEED, "DVL water speed"))),
        "ground": _log(path, times, ((GROUND_SPEED, "DVL ground speed"),)),
    }
    deviations = {
        "position": _made(path, times, _series(times, "north_sigma east_sigma"), (1.0, 1.0), "deviation"),
        "velocity": _made(path, times, _series(times, "ve_sigma vn_sigma"), (1.0, 1.0), "deviation"),
        "heading": _made(path, times, _series(times, "heading_sigma"), (DEG,), "deviation"),
        "attitude": _made(path, times, _series(times, "pitch_sigma roll_sigma"), (DEG, DEG), "deviation"),
    }
    found = {name: one for name, one in taken.items() if one is not None}
    if not found:
        allowed = Text("holds frames of STDBIN, and none of position, speed, attitude, EM log or DVL")
        raise InputError(Fault(path.name, "", None, allowed))
    return Recording(
        **found,
        sources=(_account(path, frames, times, groups),),
        deviations={name: one for name, one in deviations.items() if one is not None},
    )


@dataclass
class _Frames:
    """Where the frames of a file begin, by their heads, and what of it is damaged."""

    places: dict[Head, list[int]] = field(default_factory=lambda: defaultdict(list))
    damaged: list[tuple[int, str]] = field(default_factory=list)
    """Places of damaged frames, and why."""

    @property
    def whole(self) -> int:
        """Count of frames that are whole."""
        return sum(map(len, self.places.values()))


def _frames(data: bytes) -> _Frames:
    """Find all frames; behind a damaged one, the next mark with a head and a right sum."""
    found, place = _Frames(), 0
    layouts: dict[Head, bool] = {}
    while place < len(data):
        head = head_at(data, place)
        if head is None:
            why = Text("no frame begins here")
        elif not layouts.setdefault(head, layout(head) is not None):
            why = Text("its size is not that of the blocks that it names")
        elif place + head.size > len(data):
            why = Text("cut off")
        elif sum(data[place : place + head.size - 4]) & 0xFFFFFFFF != int.from_bytes(
            data[place + head.size - 4 : place + head.size], "big"
        ):
            why = Text("wrong checksum")
        else:
            found.places[head].append(place)
            place += head.size
            continue
        found.damaged.append((place, why))
        if len(found.damaged) > max(_MOST_LOOKED_AT, found.whole):
            break
        following = _next_whole(data, place + 1, layouts)
        if following < 0:
            break
        place = following
    return found


def _next_whole(data: bytes, place: int, layouts: dict[Head, bool]) -> int:
    """Place of the next mark from which a whole frame begins; negative without one."""
    while (place := data.find(MARK, place)) >= 0:
        head = head_at(data, place)
        if head is not None and layouts.setdefault(head, layout(head) is not None):
            return place
        place += 1
    return -1


def _refuse(path: Path, frames: _Frames) -> None:
    whole, damaged = frames.whole, len(frames.damaged)
    if whole and damaged <= MOST_DAMAGED * (whole + damaged):
        return
    place, why = frames.damaged[0]
    allowed = Text(
        "{damaged} of {total} frames of STDBIN are damaged, the first at byte {place} ({why}); at most "
        "{most:.0%} are tolerated",
        damaged=damaged,
        total=whole + damaged,
        place=place,
        why=why,
        most=MOST_DAMAGED,
    )
    raise InputError(Fault(path.name, "", None, allowed))


def _read_group(data: bytes, head: Head, places: list[int]) -> np.ndarray:
    """Frames of one head as records."""
    kind = layout(head)
    assert kind is not None and head.size <= LARGEST_FRAME
    return np.frombuffer(b"".join(data[place : place + head.size] for place in places), kind)


class _Times:
    """UTC of the frames: the time of the day that each gives, and the date where one does.

    Attributes
    ----------
    groups : list of ndarray
        The frames by their heads.
    utc : list of ndarray
        Of each group, s.
    dated : bool
        Whether any frame gives a date.
    """

    def __init__(self, groups: list[np.ndarray]) -> None:
        self.groups = groups
        of_day = [group["validity"] * _TICK_S for group in groups]
        days = [_days(group) for group in groups]
        self.dated = any(np.isfinite(one).any() for one in days)
        if self.dated:
            self._fill(of_day, days)
            self.utc = [day * _DAY + time for day, time in zip(days, of_day, strict=True)]
        else:
            self.utc = of_day

    def _fill(self, of_day: list[np.ndarray], days: list[np.ndarray]) -> None:
        """Give the frames without a date the one that brings them nearest to those with one."""
        known = np.concatenate(days)
        time = np.concatenate(of_day)
        dated = np.isfinite(known)
        near = float(np.median(known[dated] * _DAY + time[dated]))
        for one, times in zip(days, of_day, strict=True):
            missing = ~np.isfinite(one)
            one[missing] = np.rint((near - times[missing]) / _DAY)

    def beside(self, utc: np.ndarray, ticks: np.ndarray) -> np.ndarray:
        """UTC of times of the day (0.1 ms) that frames at ``utc`` carry."""
        time = ticks * _TICK_S
        if not self.dated:
            return time
        return time + _DAY * np.rint((utc - time) / _DAY)


def _days(group: np.ndarray) -> np.ndarray:
    """Days since 1970 that frames give; NaN without a date that a calendar has."""
    days = np.full(len(group), np.nan)
    if "year" not in (group.dtype.names or ()):
        return days
    dates = np.column_stack([group[name].astype(int) for name in ("year", "month", "day")])
    for date in np.unique(dates, axis=0).tolist():
        year, month, day = date
        if 1980 <= year <= 2100 and 1 <= month <= 12 and 1 <= day <= calendar.monthrange(year, month)[1]:
            days[(dates == date).all(axis=1)] = calendar.timegm((year, month, day, 0, 0, 0)) // 86400
    return days


def _series(times: _Times, names: str) -> Iterable[tuple[np.ndarray, np.ndarray]]:
    """Times and values of the frames that hold all of some fields."""
    wanted = names.split()
    for utc, group in zip(times.utc, times.groups, strict=True):
        if set(wanted) <= set(group.dtype.names or ()):
            yield utc, np.column_stack([group[name].astype(float) for name in wanted])


def _made(
    path: Path,
    times: _Times,
    parts: Iterable[tuple[np.ndarray, np.ndarray]],
    factors: tuple[float, ...],
    what: str,
) -> Series | None:
    found = list(parts)
    if not found:
        return None
    time_s, values = (np.concatenate(columns) for columns in zip(*found, strict=True))
    whole = np.isfinite(values).all(axis=1)
    return tidy(
        time_s[whole],
        values[whole] * np.array(factors),
        path.name,
        Text("STDBIN {what}", what=what),
        dated=times.dated,
        tabled=True,
    )


def _log(path: Path, times: _Times, kinds: Iterable[tuple[tuple[int, ...], str]]) -> Series | None:
    """Speeds of the first log that is in the frames: starboard, forward."""
    for bits, what in kinds:
        for number, bit in enumerate(bits, 1):
            parts = list(_log_parts(times, bit))
            series = _made(path, times, parts, (1.0, 1.0), f"{what} {number}")
            if series is not None:
                return series
    return None


def _log_parts(times: _Times, bit: int) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    for utc, group in zip(times.utc, times.groups, strict=True):
        names = group.dtype.names or ()
        if f"log{bit}_forward" not in names:
            continue
        forward = group[f"log{bit}_forward"].astype(float)
        port = group[f"log{bit}_port"].astype(float) if f"log{bit}_port" in names else np.zeros(len(group))
        yield times.beside(utc, group[f"log{bit}_time"].astype(float)), np.column_stack([-port, forward])


def _account(path: Path, frames: _Frames, times: _Times, groups: list[np.ndarray]) -> SourceReport:
    damaged = len(frames.damaged)
    warnings: list[str] = []
    if damaged:
        place, why = frames.damaged[0]
        warnings.append(
            Text(
                "{count} damaged frames left out, the first at byte {place} ({why})",
                count=damaged,
                place=place,
                why=why,
            )
        )
    if not times.dated:
        warnings.append(Text("times of day without a date: it cannot be joined with a dated file"))
    stream = stream_report("frames", frames.whole, True, np.concatenate(times.utc))
    lost = (LeftOut("frame", "", Text("damaged"), damaged),) if damaged else ()
    del groups
    return SourceReport(
        path.name,
        _KIND,
        frames.whole + damaged,
        (stream,),
        sum(str(why) == "wrong checksum" for _, why in frames.damaged),
        warnings=tuple(warnings),
        used=frames.whole,
        lines_left_out=lost,
    )
