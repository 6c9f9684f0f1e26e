"""The sentences that are used, decoded to SI: NMEA 0183 by pynmea2, and makers' own by their places.

A decoder returns a `Reading` or raises ValueError when the fields make no sense; an instrument's own
"invalid" gives a reading with ``valid`` False.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

from navcore.foundation.units import DEG, KNOT

_KMPH = 1.0 / 3.6
_FASTEST = 1000.0


@dataclass(frozen=True, slots=True)
class Reading:
    """What one sentence says; None where it says nothing.

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
    """

    time_of_day: float | None = None
    day: float | None = None
    position: tuple[float, float, float] | None = None
    velocity: tuple[float, float] | None = None
    water: tuple[float, float, bool] | None = None
    ground: tuple[float, float, bool] | None = None
    heading: float | None = None
    valid: bool = True

    @property
    def says_nothing(self) -> bool:
        """Whether it holds no more than a time."""
        quantities = (self.position, self.velocity, self.water, self.ground, self.heading)
        return self.valid and all(quantity is None for quantity in quantities)


def _number(value: Any, low: float, high: float) -> float | None:
    """Value of an optional numeric field; ValueError when out of range or no number."""
    if value is None or value == "":
        return None
    number = float(value)
    if not low <= number <= high:
        raise ValueError(f"{number} is not within {low}..{high}")
    return number


def _speed(value: Any, unit: float = KNOT) -> float | None:
    number = _number(value, -_FASTEST / unit, _FASTEST / unit)
    return None if number is None else number * unit


def _heading(value: Any) -> float | None:
    degrees = _number(value, 0.0, 360.0)
    return None if degrees is None else (degrees % 360.0) * DEG


def _over_ground(course: Any, knots: Any, kmph: Any = None) -> tuple[float, float] | None:
    """East and north velocity of course and speed; a standing vessel has no course."""
    speed = _speed(knots)
    speed = _speed(kmph, _KMPH) if speed is None else speed
    angle = _heading(course)
    if speed is None or (angle is None and speed != 0.0):
        return None
    angle = angle or 0.0
    return speed * math.sin(angle), speed * math.cos(angle)


def _axes(transverse: Any, longitudinal: Any, status: str) -> tuple[float, float, bool] | None:
    """Speeds along the ship's axes; a single-axis log has no transverse speed."""
    forward = _speed(longitudinal)
    if status != "A" or forward is None:
        return None if forward is None and status == "" else (0.0, 0.0, False)
    return _speed(transverse) or 0.0, forward, True


def _vbw(sentence: Any) -> Reading:
    return Reading(
        water=_axes(sentence.trans_water_spd, sentence.lon_water_spd, sentence.data_validity_water_spd),
        ground=_axes(sentence.trans_grnd_spd, sentence.lon_grnd_spd, sentence.data_validity_grnd_spd),
    )


def _vhw(sentence: Any) -> Reading:
    forward = _speed(sentence.water_speed_knots)
    forward = _speed(sentence.water_speed_km, _KMPH) if forward is None else forward
    return Reading(
        water=None if forward is None else (0.0, forward, True), heading=_heading(sentence.heading_true)
    )


def _vtg(sentence: Any) -> Reading:
    if getattr(sentence, "faa_mode", "") == "N":
        return Reading(valid=False)
    course, knots, kmph = sentence.true_track, sentence.spd_over_grnd_kts, sentence.spd_over_grnd_kmph
    return Reading(velocity=_over_ground(course, knots, kmph))


def _seconds_of_day(moment: Any) -> float:
    return moment.hour * 3600.0 + moment.minute * 60.0 + moment.second + moment.microsecond * 1e-6


def _place(sentence: Any, height: float) -> tuple[float, float, float]:
    if not sentence.lat or not sentence.lon or sentence.lat_dir not in "NS" or sentence.lon_dir not in "EW":
        raise ValueError("no position")
    latitude, longitude = _number(sentence.latitude, -90.0, 90.0), _number(sentence.longitude, -180.0, 180.0)
    if latitude is None or longitude is None:
        raise ValueError("no position")
    return latitude * DEG, longitude * DEG, height


def _rmc(sentence: Any) -> Reading:
    if sentence.status != "A":
        return Reading(valid=False)
    date = sentence.datestamp
    day = datetime(date.year, date.month, date.day, tzinfo=UTC).timestamp() if date else None
    return Reading(
        time_of_day=_seconds_of_day(sentence.timestamp),
        day=day,
        position=_place(sentence, math.nan),
        velocity=_over_ground(sentence.true_course, sentence.spd_over_grnd),
    )


def _gga(sentence: Any) -> Reading:
    if not sentence.gps_qual:
        return Reading(valid=False)
    altitude = _number(sentence.altitude, -1e4, 1e5)
    separation = _number(sentence.geo_sep, -200.0, 200.0)
    height = math.nan if altitude is None else altitude + (separation or 0.0)
    return Reading(time_of_day=_seconds_of_day(sentence.timestamp), position=_place(sentence, height))


def _hdt(sentence: Any) -> Reading:
    heading = _heading(sentence.heading)
    if heading is None:
        raise ValueError("no heading")
    return Reading(heading=heading)


def _gll(sentence: Any) -> Reading:
    if sentence.status != "A":
        return Reading(valid=False)
    return Reading(time_of_day=_seconds_of_day(sentence.timestamp), position=_place(sentence, math.nan))


def _gns(sentence: Any) -> Reading:
    if not set(sentence.mode_indicator or "N") - {"N"}:
        return Reading(valid=False)
    altitude = _number(sentence.altitude, -1e4, 1e5)
    separation = _number(sentence.geo_sep, -200.0, 200.0)
    height = math.nan if altitude is None else altitude + (separation or 0.0)
    return Reading(time_of_day=_seconds_of_day(sentence.timestamp), position=_place(sentence, height))


def _zda(sentence: Any) -> Reading:
    midnight = datetime(int(sentence.year), int(sentence.month), int(sentence.day), tzinfo=UTC)
    return Reading(time_of_day=_seconds_of_day(sentence.timestamp), day=midnight.timestamp())


def _hdg(sentence: Any) -> Reading:
    """Magnetic heading with its deviation and variation; without the variation it is no true heading."""
    compass, variation = _heading(sentence.heading), _number(sentence.variation, 0.0, 180.0)
    if compass is None or variation is None or sentence.var_dir not in ("E", "W"):
        return Reading()
    deviation = _number(sentence.deviation, 0.0, 180.0) or 0.0
    east = variation * (1.0 if sentence.var_dir == "E" else -1.0)
    east += deviation * (-1.0 if sentence.dev_dir == "W" else 1.0)
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
    seconds = int(time[:2]) * 3600.0 + int(time[2:4]) * 60.0 + float(time[4:])
    return Reading(time_of_day=seconds, heading=_heading(fields[1]))


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


_BY_NAME: dict[str, Callable[[Any], Reading]] = {
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
"""Decoders of kinds that pynmea2 names the fields of."""
_BY_PLACE: dict[str, Callable[[list[str]], Reading]] = {"THS": _ths}
"""Decoders of kinds that are read by the places of their fields."""
_MAKERS: dict[str, Callable[[list[str]], Reading]] = {"PASHR": _pashr, "PRDID": _prdid, "PSXN": _psxn}
"""Decoders of makers' own sentences, by the whole address."""
KINDS = ", ".join((*sorted(_BY_NAME | _BY_PLACE), *_MAKERS))
"""What a person is told can be read."""


def is_used(address: str) -> bool:
    """Whether sentences of this address are decoded."""
    kind = address[2:]
    standard = len(address) == 5 and address[0] != "P" and (kind in _BY_NAME or kind in _BY_PLACE)
    return standard or address in _MAKERS


def decode(sentence: str, address: str) -> Reading | None:
    """Reading of a sentence of a used kind; None for other kinds and for nonsense in its fields."""
    if not is_used(address):
        return None
    from pynmea2 import ParseError, parse

    kind = address[2:]
    try:
        if address not in _MAKERS and kind in _BY_NAME:
            return _BY_NAME[kind](parse(sentence))
        fields = sentence.partition("*")[0].split(",")[1:]
        return (_MAKERS.get(address) or _BY_PLACE[kind])(fields)
    except (ParseError, ValueError, TypeError, ArithmeticError, AttributeError, LookupError):
        return None
