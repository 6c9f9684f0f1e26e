"""Sentences of a ship's own INS and its log, from the columns of a recording."""

import csv
import math
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path

from tests.nmea import sentence

BEGIN = datetime(2025, 3, 1, 23, 48, 0, tzinfo=UTC)
KNOT = 1852.0 / 3600.0


def place(degrees: float, width: int, sides: str) -> str:
    """``dddmm.mmmmmmm,S``."""
    whole = int(abs(degrees))
    return f"{whole:0{width}d}{(abs(degrees) - whole) * 60.0:010.7f},{sides[degrees < 0.0]}"


RECORDINGS = Path(__file__).parents[2] / "shared" / "data" / "own_ins" / "north"
SECONDS = 1200


def seconds(count: int) -> list[list[str]]:
    """Sentences of so many seconds: of a recording, where it is at hand, else of a ship that is made up."""
    return list(of_ins(RECORDINGS, count)) if RECORDINGS.is_dir() else list(made_up(count))


def made_up(count: int) -> Iterator[list[str]]:
    """Sentences of each second of an INS that swings beside a straight course, and of its log."""
    lat, lon = 54.3, 7.9
    for k in range(count):
        east, north = -4.5 + 0.4 * math.sin(k * 1.24e-3), 3.8 + 0.3 * math.cos(k * 1.24e-3)
        yield _second(float(k), lat, lon, east, north, 310.0, 6.02, 0.0)
        lat += north / 111_300.0
        lon += east / (111_300.0 * math.cos(math.radians(lat)))


def of_ins(folder: Path, seconds: int) -> Iterator[list[str]]:
    """Sentences of each second of ``ins.csv`` and ``log.csv``: IN RMC, VTG, HDT and VD VBW."""
    with (folder / "ins.csv").open() as ins, (folder / "log.csv").open() as log:
        rows = zip(csv.DictReader(ins), csv.DictReader(log), strict=False)
        for k, (own, heard) in enumerate(rows):
            if k >= seconds:
                return
            t_s = float(own["t_s"])
            assert abs(float(heard["t_s"]) - t_s) < 1e-3
            yield _second(
                t_s,
                *(float(own[name]) for name in ("lat_deg", "lon_deg", "ve_mps", "vn_mps", "heading_deg")),
                *(float(heard[name]) for name in ("speed_mps", "speed_starboard_mps")),
            )


def _second(
    t_s: float, lat: float, lon: float, east: float, north: float, heading: float, ahead: float, aside: float
) -> list[str]:
    moment = BEGIN + timedelta(seconds=t_s)
    knots, course = math.hypot(east, north) / KNOT, math.degrees(math.atan2(east, north)) % 360.0
    where = f"{place(lat, 2, 'NS')},{place(lon, 3, 'EW')}"
    time = f"{moment:%H%M%S}.{moment.microsecond // 10000:02d}"
    return [
        sentence(f"INRMC,{time},A,{where},{knots:.5f},{course:.5f},{moment:%d%m%y},,,A"),
        sentence(f"INVTG,{course:.5f},T,,M,{knots:.5f},N,{knots * 1.852:.5f},K,A"),
        sentence(f"INHDT,{heading:.5f},T"),
        sentence(f"VDVBW,{ahead / KNOT:.5f},{aside / KNOT:.5f},A,,,V,,V,,V"),
    ]
