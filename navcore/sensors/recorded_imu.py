"""Recorded IMUs: PSINS text (integer counts of increments) and CSV (increments or rates), checked.

Body axes are right, forward, up after reading. PSINS: G. Yan's toolbox; increments of angle in counts of
``gf`` arc-seconds and of velocity in counts of ``af`` ug s.
"""

import math
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import ARCSEC, DEG
from navcore.sensors.even_stamps import interval_of
from navcore.sensors.imu_columns import imu_columns, is_imu_header

Axes = Literal["rfu", "frd"]
_PSINS_GRAVITY = 9.780327
"""The g of PSINS's ug, m/s^2."""
_LARGEST_FORCE_ERROR = 0.02
"""Difference between the mean specific force and gravity, as a part of gravity."""
_LARGEST_TILT = 30.0 * DEG
_LARGEST_FILE = 128 * 1024 * 1024
"""Bytes: a day at 100 Hz."""
_HEADER_LINES = 20
"""Lines at the beginning of a table among which its header is looked for."""
_SEPARATORS = (",", ";", "\t")


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
    jitter_s : float
        Largest distance of a stamp from an even record, s.
    """

    increments: np.ndarray
    rate_hz: float
    source: str
    lat: float | None = None
    lon: float | None = None
    height: float | None = None
    jitter_s: float = 0.0

    @property
    def duration_s(self) -> float:
        """Length of the record, s."""
        return len(self.increments) / self.rate_hz


def read_imu(path: str | os.PathLike[str], axes: Axes = "rfu") -> ImuRecord:
    """Read a recorded IMU: PSINS text (``%`` comments) or CSV with a header.

    CSV columns: ``t_s`` and ``gx_rad_s ... fz_mps2`` (means over the interval that ends at t_s), or
    ``dax_rad ... dvz_mps`` (increments).

    Parameters
    ----------
    path : path
        File.
    axes : {"rfu", "frd"}
        Axes of a CSV: right-forward-up or forward-right-down. PSINS files are right-forward-up.

    Raises
    ------
    InputError
        Unreadable, a gap, NaN, time running backwards, or axes that cannot be right, forward, up.
    """
    file = Path(path)
    try:
        if file.stat().st_size > _LARGEST_FILE:
            allowed = Text(
                "is larger than {largest_file} MB: cut it, a day at 100 Hz is enough",
                largest_file=_LARGEST_FILE >> 20,
            )
            raise InputError(Fault(str(path), "imu.file", None, allowed))
        text = file.read_text("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        binary = isinstance(error, UnicodeDecodeError)
        reason = Text("is not a text file") if binary else (error.strerror or Text("cannot be read"))
        raise InputError(Fault(str(path), "imu.file", None, reason)) from None
    return _psins(text, str(path)) if is_psins(text) else _csv(text, str(path), axes)


def is_psins(text: str) -> bool:
    """Whether a text begins as PSINS files do."""
    return text.lstrip().startswith("%")


def header_of(text: str) -> tuple[int, list[str], str] | None:
    """Line of the header of an IMU's table from 0, its names and the separator; None where there is none."""
    for number, line in enumerate(text.split("\n", _HEADER_LINES)[:_HEADER_LINES]):
        bare = line.strip().lstrip("#").strip()
        for separator in _SEPARATORS:
            names = [name.strip().strip('"') for name in bare.split(separator)]
            if len(names) > 1 and is_imu_header(names):
                return number, names, separator
    return None


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


def _csv(text: str, source: str, axes: Axes) -> ImuRecord:
    found = header_of(text)
    if found is None:
        first = next((line for line in text.splitlines() if line.strip()), "")
        found = 0, [name.strip() for name in first.split(",")], ","
    number, header, separator = found
    columns = imu_columns(header, source)
    table = _table(text, number + 1, header, separator, source)
    try:
        interval, jitter_s = interval_of(table[:, columns.time] * columns.time_s)
    except ValueError as error:
        raise InputError(Fault(source, "imu.file", None, error.args[0])) from None
    values = table[:, columns.places] * np.array(columns.factors) * (1.0 if columns.increments else interval)
    if axes == "frd":
        values = values[:, [1, 0, 2, 4, 3, 5]] * np.array([1.0, 1.0, -1.0, 1.0, 1.0, -1.0])
    return ImuRecord(values, 1.0 / interval, source, jitter_s=jitter_s)


def _table(text: str, skipped: int, names: list[str], separator: str, source: str) -> np.ndarray:
    """Rows of numbers below the header, by pyarrow; what it refuses is read again, to name the line."""
    import pyarrow as pa
    from pyarrow import csv

    columns = [str(place) for place in range(len(names))]
    try:
        read = csv.read_csv(
            pa.BufferReader(text.encode()),
            csv.ReadOptions(skip_rows=skipped, column_names=columns),
            csv.ParseOptions(delimiter=separator),
            csv.ConvertOptions(column_types=dict.fromkeys(columns, pa.float64()), null_values=[]),
        )
        table = np.column_stack([column.to_numpy() for column in read.columns])
        if len(table) > 1 and np.isfinite(table).all():
            return table
    except pa.ArrowInvalid:
        pass
    lines = text.split("\n")
    kept = [line for line in lines[skipped:] if line.strip()]
    return _numbers(kept, len(names), source, first_line=skipped + 1, separator=separator)


def _numbers(
    lines: list[str], columns: int, source: str, first_line: int, separator: str | None
) -> np.ndarray:
    """Rows of numbers; names the first data line that is none."""
    if len(lines) < 2:
        raise InputError(Fault(source, "imu.file", None, Text("holds fewer than two samples")))
    try:
        table = np.loadtxt(lines, delimiter=separator, comments=None, ndmin=2)
        if table.shape[1] != columns:
            raise ValueError
    except ValueError:
        bad = next(i for i, line in enumerate(lines) if not _is_row(line, columns, separator))
        what = Text(
            "data line {bad} is no row of {columns} numbers: {lines}",
            bad=bad + first_line,
            columns=columns,
            lines=lines[bad][:60],
        )
        raise InputError(Fault(source, "imu.file", None, what)) from None
    lost = np.flatnonzero(~np.isfinite(table).all(axis=1))
    if lost.size:
        what = Text(
            "{size} samples are NaN or infinite, the first at sample {lost}", size=lost.size, lost=lost[0] + 1
        )
        raise InputError(Fault(source, "imu.file", None, what))
    return table


def _is_row(line: str, columns: int, separator: str | None) -> bool:
    words = line.split(separator)
    try:
        return len(words) == columns and all(word.strip() and float(word) is not None for word in words)
    except ValueError:
        return False
