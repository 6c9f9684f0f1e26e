"""Recorded IMUs: PSINS text (integer counts of increments) and tables (increments or rates), checked.

Body axes are right, forward, up after reading. PSINS: G. Yan's toolbox; increments of angle in counts of
``gf`` arc-seconds and of velocity in counts of ``af`` ug s.
"""

import math
import os
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.inputs import opened, regular
from navcore.foundation.text import Text
from navcore.foundation.units import ARCSEC, DEG
from navcore.io.column_map import ColumnMap
from navcore.io.compressed import unpacked
from navcore.io.containers.opening import is_container, open_container
from navcore.io.imu_table import ImuTable, is_imu_table, read_imu_container, read_imu_table, refuse_lost
from navcore.io.source import as_utf8
from navcore.io.times.coarse_stamps import spread
from navcore.io.times.even_stamps import Evenness, evenness

Axes = Literal[
    "rfu", "frd", "flu", "rbd", "rub", "rdf", "lfd", "lbu", "luf", "ldb", "fur", "fdl",
    "bru", "bld", "bul", "bdr", "urf", "ulb", "ufl", "ubr", "drb", "dlf", "dfr", "dbl",
]  # fmt: skip
"""Directions of x, y and z in the vehicle: right or left, forward or back, up or down; right-handed."""
_PSINS_GRAVITY = 9.780327
"""The g of PSINS's ug, m/s^2."""
_LARGEST_FORCE_ERROR = 0.02
"""Difference between the mean specific force and gravity, as a part of gravity."""
_LARGEST_TILT = 30.0 * DEG
_LARGEST_FILE = 128 * 1024 * 1024
"""Bytes: a day at 100 Hz."""
_HEAD_BYTES = 1 << 16
_UNEVEN = 0.1
"""Share of the sample interval by which stamps may be uneven without a word."""


@dataclass(frozen=True)
class ImuRecord:
    """A recorded IMU.

    Attributes
    ----------
    increments : ndarray, shape (n, 6)
        Angles (rad) and velocities (m/s) in right, forward, up; each over the interval that ends at its time.
    rate_hz : float
        Samples a second.
    source : str
        File it came from.
    lat, lon, height : float or None
        Position if the file gives one, rad, m.
    warnings : tuple of str
        What was assumed of it.
    kind : str
        What the file is, for people.
    """

    increments: np.ndarray
    rate_hz: float
    source: str
    lat: float | None = None
    lon: float | None = None
    height: float | None = None
    warnings: tuple[str, ...] = ()
    kind: str = "PSINS"

    @property
    def duration_s(self) -> float:
        """Length of the record, s."""
        return len(self.increments) / self.rate_hz


def read_imu(
    path: str | os.PathLike[str], axes: Axes = "rfu", column_map: ColumnMap | None = None
) -> ImuRecord:
    """Read a recorded IMU: PSINS text (``%`` comments), CSV with a header, Parquet, MAT or npz.

    Columns: a time, three rates and three forces (means over the interval that ends at their time), or
    three increments of angle and three of velocity, by the names that `navcore.io.imu_columns` knows.

    Parameters
    ----------
    path : path
        File.
    axes : Axes
        Of a table, such as ``rfu`` or ``frd``. PSINS files are right-forward-up.
    column_map : ColumnMap, optional
        What the columns of a table mean.

    Raises
    ------
    InputError
        Unreadable, a gap, NaN, time running backwards, or axes that cannot be right, forward, up.
    """
    file = Path(path)
    try:
        if regular(file).st_size > _LARGEST_FILE:
            allowed = Text(
                "is larger than {largest_file} MB: cut it, a day at 100 Hz is enough",
                largest_file=_LARGEST_FILE >> 20,
            )
            raise InputError(Fault(str(path), "imu.file", None, allowed))
        with opened(file) as stream:
            held = open_container(file) if is_container(stream.read(_HEAD_BYTES), file) else None
        if held is not None:
            return _of_table(read_imu_container(held, str(path), column_map), str(path), axes)
        content = as_utf8(unpacked(file, _LARGEST_FILE, "imu.file"))
        if content is None:
            raise InputError(Fault(str(path), "imu.file", None, Text("is not a text file")))
        text = content[:_HEAD_BYTES].decode(errors="replace")
    except OSError as error:
        reason = error.strerror or Text("cannot be read")
        raise InputError(Fault(str(path), "imu.file", None, reason)) from None
    if column_map is None and is_psins(text) and not is_imu_table(text):
        return _psins(content.decode(), str(path))
    return _of_table(read_imu_table(content, str(path), column_map), str(path), axes)


def is_psins(text: str) -> bool:
    """Whether a text begins as PSINS files do."""
    return text[:_HEAD_BYTES].lstrip().startswith("%")


def upward_axis(force: np.ndarray) -> str:
    """Axis that looks like up in the mean specific force (3,) of a vehicle at rest: "+z", "-x" ..."""
    axis = int(np.argmax(np.abs(force)))
    return ("+" if force[axis] > 0 else "-") + "xyz"[axis]


def check_rest(record: ImuRecord, gravity: float, first_s: float = 0.0, last_s: float | None = None) -> None:
    """Refuse a record whose mean specific force at rest is no gravity, or does not point up.

    Parameters
    ----------
    record : ImuRecord
        The record.
    gravity : float
        At its place, m/s^2.
    first_s, last_s : float
        Window in which the vehicle hardly moves, s.

    Raises
    ------
    InputError
        Says the size of the force, and which axis looks like up.
    """
    n = len(record.increments)
    first, last = int(first_s * record.rate_hz), n if last_s is None else int(last_s * record.rate_hz)
    force = record.increments[first:last, 3:].mean(axis=0) * record.rate_hz
    size = float(np.linalg.norm(force))
    if abs(size - gravity) > _LARGEST_FORCE_ERROR * gravity:
        raise InputError(
            Fault(
                record.source,
                "imu.file",
                None,
                Text(
                    "the mean specific force is {size:.4g} m/s², gravity here is {gravity:.5g}: "
                    "wrong units or scale, or not at rest",
                    size=size,
                    gravity=gravity,
                ),
            )
        )
    if math.acos(min(1.0, max(-1.0, force[2] / size))) > _LARGEST_TILT:
        raise InputError(
            Fault(
                record.source,
                "imu.file",
                None,
                Text(
                    "the {upward_axis} axis looks like up, but z must point up (x right, y "
                    "forward): mean specific force {force:.3f}, {force_2:.3f}, {force_3:.3f} m/s²",
                    upward_axis=upward_axis(force),
                    force=force[0],
                    force_2=force[1],
                    force_3=force[2],
                ),
            )
        )


def _psins(text: str, source: str) -> ImuRecord:
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("%")]
    try:
        head = [[float(word) for word in line.split()] for line in lines[:3]]
        _, place, scale = head
        if len(place) < 6 or len(scale) != 6:
            raise ValueError
    except ValueError:
        expected = Text(
            "needs three lines of numbers after the comments: attitude, velocity; place, interval; scales"
        )
        raise InputError(Fault(source, "imu.file", None, expected)) from None
    counts = _numbers(lines[3:], 6, source, first_line=4, separator=None)
    lat, lon, height, _, interval_ms = place[:5]
    if not interval_ms > 0.0:
        raise InputError(
            Fault(source, "imu.file", interval_ms, Text("the sampling interval must be > 0 (ms)"))
        )
    factors = np.array(scale) * np.repeat([ARCSEC, 1e-6 * (place[5] or _PSINS_GRAVITY)], 3)
    return ImuRecord(counts * factors, 1000.0 / interval_ms, source, lat * DEG, lon * DEG, height)


def _of_table(table: ImuTable, source: str, axes: Axes) -> ImuRecord:
    time_s, _ = spread(table.time_s)
    stamps = _regular(time_s, source)
    interval, told = stamps.interval_s, list(table.warnings)
    if stamps.jitter_s > _UNEVEN * interval:
        told.append(
            Text(
                "the stamps are uneven by up to {jitter:.3g} ms, but no sample is missing: taken as "
                "{rate:.6g} samples a second",
                jitter=1e3 * stamps.jitter_s,
                rate=1.0 / interval,
            )
        )
    values = table.values
    if not table.increments:
        values *= interval
    return ImuRecord(turned(values, axes), 1.0 / interval, source, warnings=tuple(told), kind=table.kind)


def turned(values: np.ndarray, axes: Axes) -> np.ndarray:
    """Angles and velocities, shape (n, 6), from the given axes to right, forward, up."""
    places = [next(i for i, letter in enumerate(axes) if letter in pair) for pair in ("rl", "fb", "ud")]
    signs = [1.0 if axes[i] in "rfu" else -1.0 for i in places]
    if places == [0, 1, 2] and signs == [1.0, 1.0, 1.0]:
        return values
    return values[:, [*places, *(3 + i for i in places)]] * np.array([*signs, *signs])


def _numbers(
    lines: list[str], columns: int, source: str, first_line: int, separator: str | None
) -> np.ndarray:
    """Rows of numbers; names the first data line that is none."""
    if len(lines) < 2:
        raise InputError(Fault(source, "imu.file", None, Text("holds fewer than two samples")))
    try:
        table = _rows(lines, columns, separator)
    except ValueError:
        bad = _first_bad(lines, columns, separator)
        what = Text(
            "data line {bad} is no row of {columns} numbers: {lines}",
            bad=bad + first_line,
            columns=columns,
            lines=lines[bad][:60],
        )
        raise InputError(Fault(source, "imu.file", None, what)) from None
    refuse_lost(source, table)
    return table


def _rows(lines: list[str], columns: int, separator: str | None) -> np.ndarray:
    """Numbers, shape (n, columns); ValueError where a line has others."""
    table = np.loadtxt(lines, delimiter=separator, comments=None, ndmin=2)
    if table.shape[1] != columns:
        raise ValueError(f"{table.shape[1]} columns")
    return table


def _first_bad(lines: list[str], columns: int, separator: str | None) -> int:
    """Place of the first line that is empty, or that the reader refuses; by halves, as lines may be many."""
    begin, end = 0, len(lines)
    while end - begin > 1:
        middle = (begin + end) // 2
        part = lines[begin:middle]
        with suppress(ValueError):
            if all(map(str.strip, part)) and _rows(part, columns, separator).size:
                begin = middle
                continue
        end = middle
    return begin


def _regular(time_s: np.ndarray, source: str) -> Evenness:
    """Stamps of a record without gaps; gaps and time running backwards are refused with their place."""
    back = np.flatnonzero(np.diff(time_s) <= 0.0)
    if back.size:
        what = Text("time stands still or runs backwards at t = {time_s:g} s", time_s=time_s[back[0] + 1])
        raise InputError(Fault(source, "imu.file", None, what))
    stamps = evenness(time_s)
    if stamps.gaps.size:
        what = Text(
            "{size} gaps, the first at t = {time_s:g} s, the longest {longest:g} s",
            size=stamps.gaps.size,
            time_s=time_s[stamps.gaps[0]],
            longest=stamps.longest_s,
        )
        raise InputError(
            Fault(source, "imu.file", None, Text("{what}: a strapdown run needs every sample", what=what))
        )
    return stamps
