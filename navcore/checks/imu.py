"""Report on a recorded IMU, for ``schuler check``: rate, span, size of force and turn, which axis is up."""

import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from navcore.checks.file import Checker, check_log
from navcore.checks.imu_suspects import (
    force_reason,
    outlier_warnings,
    rocking_warnings,
    still_warnings,
    turn_warnings,
    upward_remedy,
)
from navcore.checks.report import FileReport
from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from navcore.foundation.units import DEG, DEG_PER_HOUR
from navcore.io.column_map import ColumnMap, read_map
from navcore.io.column_names import known_columns
from navcore.io.compressed import head_of
from navcore.io.containers.opening import is_container, open_container
from navcore.io.imu_table import is_imu_names, is_imu_table
from navcore.io.source import require_file
from navcore.io.table_layout import layout
from navcore.sensors.recorded_imu import ImuRecord, is_psins, read_imu, upward_axis

_GRAVITY = 9.76, 9.84
"""From the equator at 5 km to the poles, m/s^2."""
_FORCE_ERROR = 0.02
_SLOWEST_HZ, _FASTEST_HZ = 10.0, 2500.0
_STEADY = 0.8, 1.25
_SNIFFED_BYTES = 8192


def recognises(path: Path, head: bytes) -> bool:
    """Whether a file that begins so is a recorded IMU: PSINS text, or a table that names its quantities."""
    if is_container(head, path):
        return is_imu_names(open_container(path).names)
    text = head.decode("utf-8", errors="replace")
    return (is_psins(text) and _numbers_below(text)) or is_imu_table(text)


def is_imu(file: str | os.PathLike[str], mapped: str | os.PathLike[str] | None = None) -> bool:
    """Whether a file holds a recorded IMU, by itself or by a map; raises `InputError` where it is missing."""
    if mapped is not None:
        return read_map(mapped).is_imu
    path = require_file(file)
    return recognises(path, head_of(path, _SNIFFED_BYTES))


def _numbers_below(text: str) -> bool:
    """Whether numbers alone follow the comments and none names them: other tables begin so too."""
    _, _, header = layout(text)
    lines = (line.strip() for line in text.split("\n"))
    words = next((line for line in lines if line and not line.startswith("%")), "").partition("%")[0].split()
    if len(header) >= len(words) - 1 and {"lat", "lon"} <= known_columns(header).keys():
        return False
    try:
        return all(isinstance(float(word), float) for word in words)
    except ValueError:
        return False


def check_imu(path: Path, column_map: ColumnMap | None = None) -> FileReport:
    """Read a recorded IMU, its axes as they are; gaps, NaN, time running backwards raise `InputError`."""
    record = read_imu(path, column_map=column_map)
    kind = Text("recorded IMU, {kind}", kind=record.kind)
    details = _details(record)
    warnings = (
        *record.warnings,
        *_warnings(details),
        *turn_warnings(details["mean_turn_size_dph"]),
        *still_warnings(record),
        *outlier_warnings(record),
        *rocking_warnings(record),
    )
    return FileReport(str(path), kind, details, tuple(_text(details)), warnings)


IMU_CHECKER = Checker(recognises, check_imu)


def check_mapped(file: str | os.PathLike[str], mapped: str | os.PathLike[str] | ColumnMap) -> FileReport:
    """Say what a table holds by a map, or the file of one: an IMU where it names one, else a log."""
    try:
        column_map = mapped if isinstance(mapped, ColumnMap) else read_map(mapped)
        path = require_file(file)
        report = check_imu(path, column_map) if column_map.is_imu else check_log(path, column_map)
    except InputError as error:
        return FileReport(str(file), "", faults=error.faults)
    if isinstance(mapped, ColumnMap):
        return report
    told = Text("  read by the map {name}", name=Path(mapped).name)
    return replace(report, text=(told, *report.text))


def _details(record: ImuRecord) -> dict[str, Any]:
    mean = record.increments.mean(axis=0) * record.rate_hz
    force, turn = mean[3:], mean[:3]
    sizes = record.increments[:, 3:] * record.rate_hz
    place = None
    if record.lat is not None and record.lon is not None and record.height is not None:
        place = {
            "lat_deg": round(record.lat / DEG, 7),
            "lon_deg": round(record.lon / DEG, 7),
            "height_m": round(record.height, 3),
        }
    return {
        "samples": len(record.increments),
        "rate_hz": round(record.rate_hz, 6),
        "span_s": round(record.duration_s, 4),
        "gaps": 0,
        "place": place,
        "mean_force_mps2": [round(float(value), 5) for value in force],
        "mean_force_size_mps2": round(float(np.linalg.norm(force)), 5),
        "median_force_size_mps2": round(float(np.median(np.linalg.norm(sizes, axis=1))), 5),
        "mean_turn_dph": [round(float(value) / DEG_PER_HOUR, 4) for value in turn],
        "mean_turn_size_dph": round(float(np.linalg.norm(turn)) / DEG_PER_HOUR, 4),
        "up_axis": upward_axis(force),
    }


def _text(details: dict[str, Any]) -> list[str]:
    force, turn = details["mean_force_mps2"], details["mean_turn_dph"]
    lines: list[str] = [
        Text(
            "  {samples} samples at {rate_hz:g} Hz, {span_s:.1f} s, no gaps, no NaN",
            samples=details["samples"],
            rate_hz=details["rate_hz"],
            span_s=details["span_s"],
        ),
        Text(
            "  mean specific force {force:g}, {force_2:g}, {force_3:g} m/s², size "
            "{mean_force_size_mps2:g}; the {up_axis} axis looks like up",
            force=force[0],
            force_2=force[1],
            force_3=force[2],
            mean_force_size_mps2=details["mean_force_size_mps2"],
            up_axis=details["up_axis"],
        ),
        Text(
            "  mean turn {turn:g}, {turn_2:g}, {turn_3:g} °/h, size "
            "{mean_turn_size_dph:g} (the Earth: 15.041)",
            turn=turn[0],
            turn_2=turn[1],
            turn_3=turn[2],
            mean_turn_size_dph=details["mean_turn_size_dph"],
        ),
    ]
    if details["place"]:
        place = details["place"]
        lines.append(
            Text(
                "  place {lat_deg:.7g}, {lon_deg:.7g}°, {height_m:g} m",
                lat_deg=place["lat_deg"],
                lon_deg=place["lon_deg"],
                height_m=place["height_m"],
            )
        )
    return lines


def _warnings(details: dict[str, Any]) -> list[str]:
    warnings = []
    size, up = details["mean_force_size_mps2"], details["up_axis"]
    low, high = _GRAVITY
    if not low * (1.0 - _FORCE_ERROR) < size < high * (1.0 + _FORCE_ERROR):
        warnings.append(
            Text(
                "the mean specific force is {size:g} m/s², far from gravity: wrong units, "
                "scale, or not at rest{reason}",
                size=size,
                reason=force_reason(size),
            )
        )
    if up == "-z":
        warnings.append(Text('the -z axis looks like up: forward, right, down? Then give imu.axes = "frd"'))
    elif up != "+z":
        warnings.append(
            Text(
                "the {up} axis looks like up: a run needs to know where x, y and z point, such as "
                'imu.axes = "{axes}"',
                up=up,
                axes=upward_remedy(up),
            )
        )
    if details["rate_hz"] > _FASTEST_HZ:
        told = Text("{rate_hz:g} Hz is fast for an IMU: is the time in minutes?", rate_hz=details["rate_hz"])
        warnings.append(told)
    middle = details["median_force_size_mps2"]
    if not _STEADY[0] < middle / size < _STEADY[1]:
        warnings.append(
            Text(
                "the size of the specific force is {middle:.4g} m/s² as a median, that of its mean "
                "{size:.4g}: strong shaking, or a wrong unit of one accelerometer",
                middle=middle,
                size=size,
            )
        )
    if details["rate_hz"] < _SLOWEST_HZ:
        warnings.append(
            Text(
                "{rate_hz:g} Hz is slow for a strapdown run: only a vehicle at rest can be navigated",
                rate_hz=details["rate_hz"],
            )
        )
    return warnings
