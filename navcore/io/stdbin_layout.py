"""Layout of an iXblue (Exail) STDBIN frame, as its makers' open decoder has it; all numbers are big-endian.

A frame is ``IX``, version, masks of its blocks, size, time and counter, then the blocks of its masks by
rising bit, then the sum of all bytes before it. Axes: XV1 forward, XV2 to port, XV3 up.
"""

from typing import NamedTuple

import numpy as np

MARK = b"IX"
VERSIONS = (2, 3, 4, 5)
CHECKSUM_BYTES = 4
LARGEST_FRAME = 4096
"""Bytes; all blocks together have fewer."""

_FLOATS3 = 12
NAVIGATION = (
    12, 12, 16, 8, 12, 12, 12, 21, 16, 12, 12, 8, 8, 4, 8, 16, 12, 4, 4, 12, 4, 12, 12, 12, 8, 12, 16, 12, 12,
    12, 12,
)  # fmt: skip
"""Bytes of the blocks of the first mask, by bit."""
EXTENDED = (12, 12, 12, 12, 12, 21, 16)
"""Of the second one, from version 3 on."""
EXTERNAL = (
    5, 46, 46, 46, 13, 13, 49, 49, 49, 12, 37, 33, 8, 8, 41, 41, 41, 41, 9, 9, 9, 37, 33, 0, 16, 17, 17, 12,
)  # fmt: skip
"""Of the sensors that the INS is aided by; 0: no block has this bit."""

ATTITUDE, ATTITUDE_SIGMA, POSITION, POSITION_SIGMA, VELOCITY, VELOCITY_SIGMA, DATE = 0, 1, 7, 8, 9, 10, 13
"""Bits of the first mask."""
EM_LOG, GROUND_SPEED, WATER_SPEED = (4, 5), (10, 21), (11, 22)
"""Bits of the sensors: the first and the second of each kind."""

FIELDS = {
    ATTITUDE: [("heading", ">f4"), ("roll", ">f4"), ("pitch", ">f4")],
    ATTITUDE_SIGMA: [("heading_sigma", ">f4"), ("roll_sigma", ">f4"), ("pitch_sigma", ">f4")],
    POSITION: [("lat", ">f8"), ("lon", ">f8"), ("reference", "u1"), ("height", ">f4")],
    POSITION_SIGMA: [("north_sigma", ">f4"), ("east_sigma", ">f4")],
    VELOCITY: [("vn", ">f4"), ("ve", ">f4")],
    VELOCITY_SIGMA: [("vn_sigma", ">f4"), ("ve_sigma", ">f4")],
    DATE: [("day", "u1"), ("month", "u1"), ("year", ">u2")],
}
"""Fields of the blocks of the first mask that are read, in order: degrees, m, m/s."""
OF_LOGS = {
    **dict.fromkeys(EM_LOG, [("time", ">i4"), ("id", "u1"), ("forward", ">f4")]),
    **dict.fromkeys(
        (*GROUND_SPEED, *WATER_SPEED), [("time", ">i4"), ("id", "u1"), ("forward", ">f4"), ("port", ">f4")]
    ),
}
"""Of the logs; their own time is in steps of 0.1 ms of the day."""


class Head(NamedTuple):
    """Head of a frame: what tells the layout of the rest.

    Attributes
    ----------
    version : int
        2 to 5.
    masks : tuple of int
        Of the navigation, its extension and the sensors.
    size : int
        Bytes of the whole frame.
    """

    version: int
    masks: tuple[int, int, int]
    size: int

    @property
    def head_bytes(self) -> int:
        """Bytes before the blocks."""
        return (21, 25, 27, 27)[self.version - 2]


def head_at(data: bytes, place: int) -> Head | None:
    """Head of the frame that begins at a place; None where none does, or it is of an unknown version."""
    if data[place : place + 2] != MARK or place + 27 > len(data) or data[place + 2] not in VERSIONS:
        return None
    version, at = data[place + 2], place + 3

    def number(size: int) -> int:
        nonlocal at
        at += size
        return int.from_bytes(data[at - size : at], "big")

    navigation = number(4)
    extended = number(4) if version > 2 else 0
    external = number(4)
    if version > 3:
        number(2)
    head = Head(version, (navigation, extended, external), number(2))
    return head if head.head_bytes + CHECKSUM_BYTES <= head.size <= LARGEST_FRAME else None


def layout(head: Head) -> np.dtype | None:
    """Type of a frame, with the fields that are read; None where its size is not that of its blocks."""
    names, formats, offsets = ["validity"], [">u4"], [head.head_bytes - 8]
    place = head.head_bytes
    tables = ((NAVIGATION, FIELDS, ""), (EXTENDED, {}, "x"), (EXTERNAL, OF_LOGS, "log"))
    for mask, (sizes, fields, prefix) in zip(head.masks, tables, strict=True):
        for bit in range(32):
            if not mask >> bit & 1:
                continue
            if bit >= len(sizes) or not sizes[bit]:
                return None
            at = place
            for name, form in fields.get(bit, ()):
                names.append(f"{prefix}{bit}_{name}" if prefix else name)
                formats.append(form)
                offsets.append(at)
                at += np.dtype(form).itemsize
            place += sizes[bit]
    if place + CHECKSUM_BYTES != head.size:
        return None
    return np.dtype(
        {
            "names": [*names, "checksum"],
            "formats": [*formats, ">u4"],
            "offsets": [*offsets, place],
            "itemsize": head.size,
        }
    )
