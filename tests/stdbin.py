"""Frames of iXblue STDBIN, written with `struct` from their makers' description, apart from the reader."""

import struct
from typing import Any


def frame(
    blocks: dict[int, bytes],
    sensors: dict[int, bytes] | None = None,
    *,
    tenths_ms: int = 0,
    version: int = 3,
    extended: dict[int, bytes] | None = None,
    counter: int = 1,
) -> bytes:
    """One frame: the blocks by their bits, the header of its version, and the sum of its bytes."""
    sensors, extended = sensors or {}, extended or {}

    def mask(parts: dict[int, bytes]) -> int:
        return sum(1 << bit for bit in parts)

    body = b"".join(parts[bit] for parts in (blocks, extended, sensors) for bit in sorted(parts))
    size = {2: 21, 3: 25, 4: 27, 5: 27}[version] + len(body) + 4
    head = b"IX" + bytes([version]) + struct.pack(">I", mask(blocks))
    head += struct.pack(">I", mask(extended)) if version > 2 else b""
    head += struct.pack(">I", mask(sensors))
    inside = sum(map(len, blocks.values())) + sum(map(len, extended.values()))
    head += struct.pack(">H", inside) if version > 3 else b""
    head += struct.pack(">HII", size, tenths_ms, counter)
    return head + body + struct.pack(">I", sum(head + body))


def navigation(**values: Any) -> dict[int, bytes]:
    """Attitude, position, speed, their deviations and the date."""
    of = {
        "heading": 0.0, "roll": 0.0, "pitch": 0.0, "lat": 0.0, "lon": 0.0, "height": 0.0, "ve": 0.0,
        "vn": 0.0,
        "date": (1, 1, 2024), "sigma": (0.1, 0.02, 0.03, 5.0, 4.0, 0.3, 0.2),
    } | values  # fmt: skip
    heading, roll, pitch, north, east, vn, ve = of["sigma"]
    return {
        0: struct.pack(">3f", of["heading"], of["roll"], of["pitch"]),
        1: struct.pack(">3f", heading, roll, pitch),
        2: bytes(16),
        7: struct.pack(">ddBf", of["lat"], of["lon"], 1, of["height"]),
        8: struct.pack(">4f", north, east, 0.1, 2.0),
        9: struct.pack(">3f", of["vn"], of["ve"], 0.0),
        10: struct.pack(">3f", vn, ve, 0.1),
        13: struct.pack(">BBH", *of["date"]),
    }


def em_log(tenths_ms: int, forward: float) -> bytes:
    """Block of an EM log."""
    return struct.pack(">iBff", tenths_ms, 0, forward, 0.1)


def dvl_ground(tenths_ms: int, forward: float, port: float) -> bytes:
    """Block of a DVL over ground."""
    return struct.pack(">iB8f", tenths_ms, 0, forward, port, 0.0, 1500.0, 30.0, 0.1, 0.1, 0.1)
