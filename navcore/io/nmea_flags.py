"""Flags of quality: what each sentence says of its own readings, letter by letter.

A flag that says that a reading is not valid takes the reading out; one that says that it was not measured
(simulated, typed in, dead-reckoned) is told; so is a flag that is in no table.
"""

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np

INVALID = "not valid"
DEAD_RECKONED, MANUAL, SIMULATED = "estimated (dead-reckoned)", "typed in (manual)", "simulated"
REDUCED = "of reduced quality"
NO_SATELLITES = "without satellites"
GYRO_ALONE = "of the gyro alone, without satellites"
OTHER_DATUM = "of a datum other than WGS 84"
CAUTION, UNSAFE = "to be used with caution", "unsafe for navigation"
UNKNOWN = "flagged by a letter that is not known"
_MEANINGS = (
    "",
    REDUCED,
    NO_SATELLITES,
    GYRO_ALONE,
    CAUTION,
    OTHER_DATUM,
    UNSAFE,
    UNKNOWN,
    DEAD_RECKONED,
    MANUAL,
    SIMULATED,
    INVALID,
)
"""Of several flags of one reading the last in this order counts."""

MODES = {letter: "" for letter in ("", *"ADFPR")} | {
    "E": DEAD_RECKONED,
    "M": MANUAL,
    "S": SIMULATED,
    "N": INVALID,
}
"""Mode of a receiver: autonomous, differential, float and fixed RTK, precise; estimated, manual, simulator,
none."""
STATUS = {"A": ""}
"""Status of RMC and GLL: all but A (data valid) is not valid."""
LOG_STATUS = {"A": ""}
"""Status of the speeds of VBW: all but A is not valid."""
QUALITIES = {"0": INVALID, "": INVALID} | dict.fromkeys("123459", "") | {
    "6": DEAD_RECKONED, "7": MANUAL, "8": SIMULATED,
}  # fmt: skip
"""Quality of GGA: none, autonomous, differential, precise, RTK fixed and float, estimated, manual,
simulator; 9 is a fix with corrections of a satellite, by Novatel."""
NAVIGATION = {"": "", "S": "", "V": "", "C": CAUTION, "U": UNSAFE}
"""Navigational status of RMC and GNS since NMEA 4.1; V says that the receiver gives none."""
DATUMS = {"W84": "", "P90": ""}
"""Datum of DTM; that of GLONASS agrees with WGS 84 within centimetres."""
HEADING_MODES = {"A": "", "E": DEAD_RECKONED, "M": MANUAL, "S": SIMULATED, "V": INVALID}
"""Mode of THS."""
SEAPATH = {"0": "", "1": REDUCED, "2": INVALID}
"""Quality of PSXN,20."""
INERTIAL = {"": "", "0": INVALID, "1": ""}
"""Status of the inertial unit of PASHR: off (or not aligned), in order."""
FIXES = {"": "", "0": NO_SATELLITES} | dict.fromkeys("12345", "")
"""Quality of the fix of PASHR."""
HEADING_SOURCES = {"": "", "N": "", "G": GYRO_ALONE}
"""Source of the heading of PSAT,HPR: satellites, or the gyro while they are lost."""


OCTANS = {"00000000": "", "00000001": INVALID, "00000100": REDUCED}
"""Status of PHINF, a word of 32 bits: some of its values. The heading is not valid; a gyro, their light or an
accelerometer fails."""
_HEADING_FAILS, _SENSOR_FAILS = 1 << 0, 0b111_1111 << 8
OCTANS_STATUS = {"T": "", "E": INVALID, "I": INVALID}
"""Status of the heading of PHOCT: valid, invalid, initialising."""


class Flag(NamedTuple):
    """A field that says how good a reading is.

    Attributes
    ----------
    sentence : str
        Last letters of the address, or the whole one of a maker's sentence, with its number if it has one.
    place : int
        Of the field behind the address, from 0.
    quantities : tuple of str
        What it speaks of; ``position``, ``velocity``, ``heading``, ``water``, ``ground``.
    meanings : dict
        Meaning of each letter; empty where the reading is measured.
    otherwise : str
        Meaning of all other letters.
    """

    sentence: str
    place: int
    quantities: tuple[str, ...]
    meanings: dict[str, str]
    otherwise: str = UNKNOWN


FLAGS = (
    Flag("RMC", 1, ("position", "velocity"), STATUS, INVALID),
    Flag("RMC", 11, ("position", "velocity"), MODES),
    Flag("RMC", 12, ("position", "velocity"), NAVIGATION),
    Flag("GLL", 5, ("position",), STATUS, INVALID),
    Flag("GLL", 6, ("position",), MODES),
    Flag("GGA", 5, ("position",), QUALITIES),
    Flag("GNS", 5, ("position",), MODES),
    Flag("GNS", 12, ("position",), NAVIGATION),
    Flag("VTG", 8, ("velocity",), MODES),
    Flag("DTM", 0, ("position",), DATUMS, OTHER_DATUM),
    Flag("THS", 1, ("heading",), HEADING_MODES),
    Flag("VBW", 2, ("water",), LOG_STATUS, INVALID),
    Flag("VBW", 5, ("ground",), LOG_STATUS, INVALID),
    Flag("PASHR", 9, ("heading",), FIXES),
    Flag("PASHR", 10, ("heading",), INERTIAL),
    Flag("PSXN,20", 3, ("heading",), SEAPATH),
    Flag("PSAT,HPR", 5, ("heading",), HEADING_SOURCES),
    Flag("PHOCT", 5, ("heading",), OCTANS_STATUS),
    Flag("PHINF", 0, ("heading",), OCTANS),
)
"""All that are heeded. HDT, HDG, HDM, VHW, PRDID, PIXSE and PSXN,23 have none (PSXN,23 has that of PSXN,20
before it, HEHDT the worse one of the PHINF before and behind it), ZDA speaks of the time alone; ROT, VLW and
all others are not read."""


def meaning(flag: Flag, field: str) -> str:
    """Meaning of a field; of a mode of several systems (GNS) that on which all with a fix agree; of bits."""
    if flag.sentence == "PHINF":
        try:
            bits = int(field, 16)
        except ValueError:
            return flag.otherwise
        return INVALID if bits & _HEADING_FAILS else REDUCED if bits & _SENSOR_FAILS else ""
    if flag.meanings is not MODES or flag.sentence != "GNS":
        return flag.meanings.get(field, flag.otherwise)
    told = {flag.meanings.get(letter, flag.otherwise) for letter in field} - {INVALID}
    if not told:
        return INVALID
    return told.pop() if len(told) == 1 else ""


def flag_of(sentence: str, place: int) -> Flag:
    """Flag of a sentence at a place."""
    return next(flag for flag in FLAGS if (flag.sentence, flag.place) == (sentence, place))


def letters_of(flag: Flag) -> tuple[np.ndarray, int, Callable[[str], int]]:
    """Meanings as numbers: of each ASCII letter, shape (128,), of an empty field, and of a longer one."""
    return _letters(flag.sentence, flag.place)


@cache
def _letters(sentence: str, place: int) -> tuple[np.ndarray, int, Callable[[str], int]]:
    flag = flag_of(sentence, place)

    @cache
    def code_of(field: str) -> int:
        return _MEANINGS.index(meaning(flag, field))

    return np.array([code_of(chr(k)) for k in range(128)], np.int8), code_of(""), code_of


def words_of(code: int) -> str:
    """Meaning of a number."""
    return _MEANINGS[code]


INVALID_CODE = _MEANINGS.index(INVALID)
