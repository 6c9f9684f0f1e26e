"""Columns of a table that say how good others are: flags of NMEA 0183, ROS and RTKLIB."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from navcore.foundation.text import Text
from navcore.io.column_names import plain_name
from navcore.io.dialects import meant
from navcore.io.nmea_flags import DEAD_RECKONED, HEADING_MODES, INVALID, MODES, QUALITIES, STATUS

_FIX = ("lat", "lon", "height", "sog", "cog", "ve", "vn")
_ROS = {"-1": INVALID} | dict.fromkeys("012", "")
_RTKLIB = {"0": INVALID, "7": DEAD_RECKONED} | dict.fromkeys("123456", "")
_WORDS = dict.fromkeys(("VALID", "OK", "GOOD"), "") | dict.fromkeys(
    ("INVALID", "NOT VALID", "BAD", "FAULT", "FAILED", "ERROR"), INVALID
)
_VALID = STATUS | {"V": INVALID} | _WORDS
_TRUE = {"1": "", "TRUE": "", "YES": "", "0": INVALID, "FALSE": INVALID, "NO": INVALID} | _WORDS
_FIX_TYPES = {"0": INVALID, "1": INVALID} | dict.fromkeys("2345678", "")
"""Of MAVLink (PX4, ArduPilot) and UBX: 2 and more are fixes in two or three dimensions."""


class TableFlag(NamedTuple):
    """A kind of column.

    Attributes
    ----------
    names : tuple of str
        Plain names, or their last words.
    stems : tuple of str
        Quantities that it speaks of.
    meanings : dict
        Meaning of each cell; a column with other cells is none of this kind.
    """

    names: tuple[str, ...]
    stems: tuple[str, ...]
    meanings: dict[str, str]


_KINDS: tuple[tuple[str, tuple[str, ...], dict[str, str]], ...] = (
    ("fix_quality gps_quality gga_quality quality_indicator gps_qual fix_qual", _FIX, QUALITIES),
    ("mode_indicator faa_mode pos_mode positioning_mode rmc_mode vtg_mode", _FIX, MODES),
    (
        "rmc_status gll_status gps_status position_status pos_status nav_status fix_status status",
        _FIX,
        _VALID,
    ),
    (
        "heading_mode ths_mode heading_status heading_quality heading_flag hdg_status gyro_status",
        ("heading",),
        HEADING_MODES | _VALID,
    ),
    ("water_status log_status stw_status water_speed_status", ("speed", "speed_starboard"), _VALID),
    ("ground_status ground_speed_status", ("ground", "ground_starboard"), _VALID),
    ("status_status", _FIX, _ROS),
    ("fix_type gps_fix_type gnss_fix_type", _FIX, _FIX_TYPES),
    ("position_valid pos_valid fix_valid gps_valid gnss_valid position_ok", _FIX, _TRUE),
    ("heading_valid hdg_valid gyro_valid heading_ok", ("heading",), _TRUE),
    ("water_valid stw_valid log_valid speed_valid log_ok", ("speed", "speed_starboard"), _TRUE),
    ("q", _FIX, _RTKLIB),
)
TABLE_FLAGS = tuple(TableFlag(tuple(names.split()), stems, meanings) for names, stems, meanings in _KINDS)
"""All that are heeded."""


def flag_columns(names: Sequence[str]) -> dict[int, TableFlag]:
    """Columns of a header that are flags, by their places."""
    found: dict[int, TableFlag] = {}
    for index, name in enumerate(meant(names)):
        plain = plain_name(name)
        for flag in TABLE_FLAGS:
            if plain in flag.names or (flag.names == ("status_status",) and plain.endswith("status_status")):
                found[index] = flag
                break
    return found


def heed(
    flag: TableFlag, name: str, cells: Sequence[str], stems: Sequence[str]
) -> tuple[np.ndarray, list[str]] | None:
    """Invalid rows by a column of flags, shape (n,), and what to say; None where it is no flag."""
    plain = [cell.strip().upper().removesuffix(".0") for cell in cells]
    if not stems or not set(plain) <= flag.meanings.keys() | {""}:
        return None
    said = np.array([flag.meanings.get(cell, "") for cell in plain])
    invalid = said == INVALID
    told: list[str] = [
        Text(
            "column {name}: {count} readings are {doubt}: no truth to judge by",
            name=name,
            count=count,
            doubt=doubt,
        )
        for doubt in sorted(set(said.tolist()) - {"", INVALID})
        if (count := int(np.count_nonzero(said == doubt)))
    ]
    if invalid.any():
        words = Text(
            "column {name}: {count} rows of {stems} flagged invalid: left out",
            name=name,
            count=int(np.count_nonzero(invalid)),
            stems=", ".join(stems),
        )
        told.insert(0, words)
    return invalid, told
