"""What a recorded IMU holds, for ``schuler check``: rate, span, size of force and turn, which axis is up."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from navcore.checks.file import Checker, FileReport
from navcore.foundation.units import DEG, DEG_PER_HOUR
from navcore.sensors.recorded_imu import ImuRecord, is_imu_header, is_psins, read_imu, upward_axis

_GRAVITY = 9.76, 9.84
"""From the equator at 5 km to the poles, m/s^2."""
_FORCE_ERROR = 0.02
_SLOWEST_HZ = 10.0


def recognises(path: Path, head: bytes) -> bool:
    """Whether a file that begins so is a recorded IMU: PSINS text, or a CSV that names its quantities."""
    text = head.decode("utf-8", errors="replace")
    return is_psins(text) or is_imu_header(text.lstrip().split("\n", 1)[0])


def check_imu(path: Path) -> FileReport:
    """Read a recorded IMU, its axes as they are; gaps, NaN, time running backwards raise `InputError`."""
    record = read_imu(path)
    kind = "recorded IMU, PSINS" if record.lat is not None else "recorded IMU, CSV"
    details = _details(record)
    return FileReport(str(path), kind, details, tuple(_text(details)), tuple(_warnings(details)))


IMU_CHECKER = Checker(recognises, check_imu)


def _details(record: ImuRecord) -> dict[str, Any]:
    mean = record.increments.mean(axis=0) * record.rate_hz
    force, turn = mean[3:], mean[:3]
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
        "mean_turn_dph": [round(float(value) / DEG_PER_HOUR, 4) for value in turn],
        "mean_turn_size_dph": round(float(np.linalg.norm(turn)) / DEG_PER_HOUR, 4),
        "up_axis": upward_axis(force),
    }


def _text(details: dict[str, Any]) -> list[str]:
    force, turn = details["mean_force_mps2"], details["mean_turn_dph"]
    lines = [
        f"  {details['samples']} samples at {details['rate_hz']:g} Hz, {details['span_s']:.1f} s, "
        "no gaps, no NaN",
        f"  mean specific force {force[0]:g}, {force[1]:g}, {force[2]:g} m/s², "
        f"size {details['mean_force_size_mps2']:g}; the {details['up_axis']} axis looks like up",
        f"  mean turn {turn[0]:g}, {turn[1]:g}, {turn[2]:g} °/h, size {details['mean_turn_size_dph']:g} "
        "(the Earth: 15.041)",
    ]
    if details["place"]:
        place = details["place"]
        lines.append(f"  place {place['lat_deg']:.7g}, {place['lon_deg']:.7g}°, {place['height_m']:g} m")
    return lines


def _warnings(details: dict[str, Any]) -> list[str]:
    found = []
    size, up = details["mean_force_size_mps2"], details["up_axis"]
    low, high = _GRAVITY
    if not low * (1.0 - _FORCE_ERROR) < size < high * (1.0 + _FORCE_ERROR):
        found.append(
            f"the mean specific force is {size:g} m/s², far from gravity: wrong units, scale, or not at rest"
        )
    if up == "-z":
        found.append('the -z axis looks like up: forward, right, down? Then give imu.axes = "frd"')
    elif up != "+z":
        found.append(
            f"the {up} axis looks like up: a run needs x right, y forward, z up (or frd), turn the columns"
        )
    if details["rate_hz"] < _SLOWEST_HZ:
        found.append(
            f"{details['rate_hz']:g} Hz is slow for a strapdown run: only a vehicle at rest can be navigated"
        )
    return found
