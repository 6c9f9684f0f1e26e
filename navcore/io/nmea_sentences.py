"""The sentences that are used, NMEA 0183 and makers' own, decoded to SI by the places of their fields.

A decoder returns a `Reading` or raises ValueError when the fields make no sense; an instrument's own
"invalid" gives a reading with ``valid`` False.
"""

import math
import re
from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

from navcore.foundation.units import DEG, KNOT
from navcore.io.stamps import midnight

_KMPH = 1.0 / 3.6
_FASTEST = 1000.0
_NOTHING = (*(None,) * 5, True)
_LEFT_OUT = [""] * 12
_TIME = re.compile(r"(?:[01]\d|2[0-3])[0-5]\d[0-5]\d(?:\.\d*)?")
_DEGREES = re.compile(r"(\d+)(\d\d\.\d+)")
_remembered = lru_cache(maxsize=4096)
"""Fields repeat: a second stands in several sentences, and instruments round."""
_QUALITIES = {"6": "dead-reckoned", "7": "manual", "8": "simulated"}
_MODES = {"E": "dead-reckoned", "M": "manual", "S": "simulated"}


class Reading(NamedTuple):
    """Reading of one sentence; None where it holds nothing.

    Attributes
    ----------
    time_of_day : float
        Its own UTC, s after midnight.
    day : float
        UTC midnight of its own date, s since 1970.
    position : tuple
        Latitude, longitude (rad), height above the ellipsoid (m, NaN if not given).
    velocity : tuple
        E, N over the ground, m/s.
    water, ground : tuple
        Starboard, forward speed (m/s) and whether the log calls it valid.
    heading : float
        rad, from true north.
    valid : bool
        False when the receiver calls the whole sentence invalid (nothing else is filled in then).
    doubt : str
        What the receiver calls a fix that it did not measure: dead-reckoned, manual, simulated; else empty.
    """

    time_of_day: float | None = None
    day: float | None = None
    position: tuple[float, float, float] | None = None
    velocity: tuple[float, float] | None = None
    water: tuple[float, float, bool] | None = None
    ground: tuple[float, float, bool] | None = None
    heading: float | None = None
    valid: bool = True
    doubt: str = ""

    @property
    def says_nothing(self) -> bool:
        """Whether it holds no more than a time."""
        return self[2:8] == _NOTHING


def _number(value: str, low: float, high: float) -> float | None:
    """Value of an optional numeric field; ValueError when out of range or no number."""
    if value == "":
        return None
    number = float(value)
    if not low <= number <= high:
        raise ValueError(f"{number} is not within {low}..{high}")
    return number


@_remembered
def _speed(value: str, unit: float = KNOT) -> float | None:
    number = _number(value, -_FASTEST / unit, _FASTEST / unit)
    return None if number is None else number * unit


@_remembered
def _heading(value: str) -> float | None:
    degrees = _number(value, 0.0, 360.0)
    return None if degrees is None else (degrees % 360.0) * DEG


def _over_ground(course: str, knots: str, kmph: str = "") -> tuple[float, float] | None:
    """East and north velocity of course and speed; a standing vessel has no course."""
    speed = _speed(knots)
    speed = _speed(kmph, _KMPH) if speed is None else speed
    angle = _heading(course)
    if speed is None or (angle is None and speed != 0.0):
        return None
    angle = angle or 0.0
    return speed * math.sin(angle), speed * math.cos(angle)


def _axes(longitudinal: str, transverse: str, status: str) -> tuple[float, float, bool] | None:
    """Speeds along the ship's axes; a single-axis log has no transverse speed."""
    forward = _speed(longitudinal)
    if status != "A" or forward is None:
        return None if forward is None and status == "" else (0.0, 0.0, False)
    return _speed(transverse) or 0.0, forward, True


def _vbw(fields: list[str]) -> Reading:
    return Reading(water=_axes(*fields[:3]), ground=_axes(*fields[3:6]))


def _vhw(fields: list[str]) -> Reading:
    forward = _speed(fields[4]) if fields[4] else _speed(fields[6], _KMPH)
    return Reading(water=None if forward is None else (0.0, forward, True), heading=_heading(fields[0]))


def _vtg(fields: list[str]) -> Reading:
    if fields[8] == "N":
        return Reading(valid=False)
    return Reading(velocity=_over_ground(fields[0], fields[4], fields[6]), doubt=_doubt(fields[8]))


def _seconds(field: str) -> float:
    """Time ``hhmmss`` or ``hhmmss.sss``, s."""
    return int(field[:2]) * 3600.0 + int(field[2:4]) * 60.0 + float(field[4:])


@_remembered
def _time_of_day(field: str) -> float:
    """UTC of a standard sentence, s: a time that a clock can show."""
    if _TIME.fullmatch(field) is None:
        raise ValueError(f"{field} is no time")
    return _seconds(field)


@_remembered
def _day(field: str) -> float:
    """UTC midnight of ``ddmmyy``, s since 1970."""
    if len(field) != 6 or not field[4:].isdigit():
        raise ValueError(f"{field} is no date")
    return midnight(int(field[4:]), int(field[2:4]), int(field[:2]))


def _angle(field: str, side: str, positive: str, negative: str, most: float) -> float:
    """Degrees and minutes, ``dddmm.mmmm``, in rad."""
    parts = _DEGREES.fullmatch(field)
    degrees = int(parts[1]) + float(parts[2]) / 60.0 if parts else 0.0 if field == "0" else math.inf
    if side not in (positive, negative) or degrees > most:
        raise ValueError("no position")
    return (degrees if side == positive else -degrees) * DEG


@_remembered
def _place(lat: str, north: str, lon: str, east: str) -> tuple[float, float]:
    """Latitude and longitude of both with their sides."""
    return _angle(lat, north, "N", "S", 90.0), _angle(lon, east, "E", "W", 180.0)


@_remembered
def _height(altitude: str, separation: str) -> float:
    """Height above the ellipsoid, m; NaN where it is not given."""
    above, geoid = _number(altitude, -1e4, 1e5), _number(separation, -200.0, 200.0)
    return math.nan if above is None else above + (geoid or 0.0)


@_remembered
def _doubt(modes: str) -> str:
    """What the letters of a receiver's mode, one a system, say of the fix when all agree."""
    said = set(modes) - {"N"}
    return _MODES.get(said.pop(), "") if len(said) == 1 else ""


def _rmc(fields: list[str]) -> Reading:
    if fields[1] != "A":
        return Reading(valid=False)
    return Reading(
        time_of_day=_time_of_day(fields[0]),
        day=_day(fields[8]) if fields[8] else None,
        position=(*_place(*fields[2:6]), math.nan),
        velocity=_over_ground(fields[7], fields[6]),
        doubt=_doubt(fields[11]),
    )


def _gga(fields: list[str]) -> Reading:
    quality = fields[5]
    if not quality or int(quality) == 0:
        return Reading(valid=False)
    position = *_place(*fields[1:5]), _height(fields[8], fields[10])
    doubt = _QUALITIES.get(quality, "")
    return Reading(time_of_day=_time_of_day(fields[0]), position=position, doubt=doubt)


def _hdt(fields: list[str]) -> Reading:
    return _needed_heading(fields[0])


def _gll(fields: list[str]) -> Reading:
    """Place, time and status; the oldest form has the place alone, which does not say that it is invalid."""
    oldest = len(fields) == 4 + len(_LEFT_OUT)
    if fields[5] != "A" and not oldest:
        return Reading(valid=False)
    time_s = None if oldest else _time_of_day(fields[4])
    position = *_place(*fields[:4]), math.nan
    return Reading(time_of_day=time_s, position=position, doubt=_doubt(fields[6]))


def _gns(fields: list[str]) -> Reading:
    if not set(fields[5] or "N") - {"N"}:
        return Reading(valid=False)
    position = *_place(*fields[1:5]), _height(fields[8], fields[9])
    return Reading(time_of_day=_time_of_day(fields[0]), position=position, doubt=_doubt(fields[5]))


def _zda(fields: list[str]) -> Reading:
    return Reading(
        time_of_day=_time_of_day(fields[0]), day=midnight(int(fields[3]), int(fields[2]), int(fields[1]))
    )


def _hdg(fields: list[str]) -> Reading:
    """Magnetic heading with its deviation and variation; without the variation it is no true heading."""
    heading, deviation_deg, deviation_side, variation_deg, variation_side = fields[:5]
    compass, variation = _heading(heading), _number(variation_deg, 0.0, 180.0)
    if compass is None or variation is None or variation_side not in ("E", "W"):
        return Reading()
    deviation = _number(deviation_deg, 0.0, 180.0) or 0.0
    east = variation * (1.0 if variation_side == "E" else -1.0)
    east += deviation * (-1.0 if deviation_side == "W" else 1.0)
    return Reading(heading=(compass + east * DEG) % (2.0 * math.pi))


def _ths(fields: list[str]) -> Reading:
    """True heading and status: ``THS,77.52,A`` (V: invalid)."""
    if fields[1] == "V":
        return Reading(valid=False)
    return _needed_heading(fields[0])


def _pashr(fields: list[str]) -> Reading:
    """Attitude of Applanix and others: ``PASHR,hhmmss.sss,heading,T,roll,pitch,...``; others say nothing."""
    time = fields[0]
    if len(fields) < 5 or fields[2] != "T" or not time[:6].isdigit():
        return Reading()
    return Reading(time_of_day=_seconds(time), heading=_heading(fields[1]))


def _psxn(fields: list[str]) -> Reading:
    """Attitude of a Seapath: ``PSXN,23,roll,pitch,heading,heave``; its other messages say nothing."""
    return _needed_heading(fields[3]) if fields[0] == "23" else Reading()


def _prdid(fields: list[str]) -> Reading:
    """Attitude as RD Instruments has it: ``PRDID,pitch,roll,heading``."""
    return _needed_heading(fields[2])


def _needed_heading(value: str) -> Reading:
    heading = _heading(value)
    if heading is None:
        raise ValueError("no heading")
    return Reading(heading=heading)


_STANDARD: dict[str, Callable[[list[str]], Reading]] = {
    "GGA": _gga,
    "GLL": _gll,
    "GNS": _gns,
    "HDG": _hdg,
    "HDT": _hdt,
    "RMC": _rmc,
    "VBW": _vbw,
    "VHW": _vhw,
    "VTG": _vtg,
    "ZDA": _zda,
}
"""Decoders of kinds whose last fields an older talker may leave out: these are empty then."""
_WHOLE: dict[str, Callable[[list[str]], Reading]] = {"THS": _ths}
"""Decoders of kinds that must have all their fields."""
_MAKERS: dict[str, Callable[[list[str]], Reading]] = {"PASHR": _pashr, "PRDID": _prdid, "PSXN": _psxn}
"""Decoders of makers' own sentences, by the whole address."""
KINDS = ", ".join((*sorted(_STANDARD | _WHOLE), *_MAKERS))
"""Sentences that can be read, for messages."""


@lru_cache(maxsize=1024)
def _decoder(address: str) -> tuple[Callable[[list[str]], Reading], list[str]] | None:
    """Decoder of a used kind, and the fields that may be left out; None for other kinds."""
    kind = address[2:] if len(address) == 5 and address[0] != "P" else ""
    if kind in _STANDARD:
        return _STANDARD[kind], _LEFT_OUT
    found = _MAKERS.get(address) or _WHOLE.get(kind)
    return (found, []) if found else None


def is_used(address: str) -> bool:
    """Whether sentences of this address are decoded."""
    return _decoder(address) is not None


def decode(sentence: str, address: str) -> Reading | None:
    """Reading of a sentence of a used kind; None for other kinds and for nonsense in its fields."""
    found = _decoder(address)
    if found is None:
        return None
    decoder, left_out = found
    fields = sentence.partition("*")[0].split(",")[1:]
    try:
        return decoder(fields + left_out) if fields else None
    except (ValueError, TypeError, LookupError, OverflowError):
        return None
