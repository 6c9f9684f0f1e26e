"""Small NMEA 0183 logs of a made-up ship, for tests of readers and of runs on recordings."""

import math
from collections.abc import Iterable
from datetime import UTC, datetime, timedelta
from pathlib import Path

START = datetime(2024, 2, 28, 23, 58, 0, tzinfo=UTC)
"""Two minutes before the midnight to a leap day."""


def sentence(body: str) -> str:
    """``$body*checksum``."""
    checksum = 0
    for character in body:
        checksum ^= ord(character)
    return f"${body}*{checksum:02X}"


def stamped(seconds: float, body: str) -> str:
    """Sentence after an ISO 8601 stamp, ``seconds`` after `START`."""
    moment = START + timedelta(seconds=seconds)
    return f"{moment:%Y-%m-%dT%H:%M:%S}.{moment.microsecond // 100:04d}Z {sentence(body)}"


def _angle(degrees: float, width: int, signs: str) -> str:
    whole = int(abs(degrees))
    return f"{whole:0{width}d}{(abs(degrees) - whole) * 60.0:010.7f},{signs[degrees < 0]}"


def rmc(seconds: float, lat: float, lon: float, knots: float, course: float, status: str = "A") -> str:
    """Body of an RMC sentence."""
    moment = START + timedelta(seconds=seconds)
    time = f"{moment:%H%M%S}.{moment.microsecond // 10000:02d}"
    place = f"{_angle(lat, 2, 'NS')},{_angle(lon, 3, 'EW')}"
    return f"GPRMC,{time},{status},{place},{knots:.3f},{course:.2f},{moment:%d%m%y},,,A"


def gga(seconds: float, lat: float, lon: float, height: float, quality: int = 1) -> str:
    """Body of a GGA sentence."""
    moment = START + timedelta(seconds=seconds)
    time = f"{moment:%H%M%S}.{moment.microsecond // 10000:02d}"
    place = f"{_angle(lat, 2, 'NS')},{_angle(lon, 3, 'EW')}"
    return f"GPGGA,{time},{place},{quality},08,1.0,{height:.2f},M,-20.00,M,,"


def vbw(water: tuple[float, float], ground: tuple[float, float], flags: str = "AA") -> str:
    """Body of a VBW sentence; speeds are starboard, forward, kn."""
    return f"VDVBW,{water[1]:.2f},{water[0]:.2f},{flags[0]},{ground[1]:.2f},{ground[0]:.2f},{flags[1]},,V,,V"


def write(path: Path, lines: Iterable[str]) -> Path:
    """Write lines with the line ends of a logger."""
    path.write_bytes("".join(f"{line}\r\n" for line in lines).encode())
    return path


def ship_files(
    folder: Path, seconds: int = 300, knots: float = 10.0, log_from: float = 0.62
) -> dict[str, Path]:
    """Track, gyro and log of a ship on heading 030 at a constant speed, without any error.

    GNSS each 1 s from 0 s, gyro each 0.5 s from 0.01 s, log each 1.1 s from ``log_from``.
    """
    heading, metres_per_degree = math.radians(30.0), 60.0 * 1852.0

    def place(t: float) -> tuple[float, float]:
        along = knots * 1852.0 / 3600.0 * t / metres_per_degree
        lat = 48.0 + along * math.cos(heading)
        return lat, -123.0 + along * math.sin(heading) / math.cos(math.radians(48.0))

    gnss = [stamped(t + 0.15, rmc(t, *place(t), knots, 30.0)) for t in range(seconds + 1)]
    gyro = [stamped(0.01 + 0.5 * k, "HEHDT,30.00,T") for k in range(2 * seconds)]
    count = int((seconds - log_from) / 1.1) + 1
    log = [stamped(log_from + 1.1 * k, vbw((0.5, knots + 1.0), (0.0, knots))) for k in range(count)]
    return {
        "gnss": write(folder / "gnss.txt", gnss),
        "gyro": write(folder / "gyro.txt", gyro),
        "log": write(folder / "log.txt", log),
    }
