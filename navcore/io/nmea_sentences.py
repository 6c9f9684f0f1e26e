"""The sentences that are used, NMEA 0183 and makers' own, decoded to SI by the places of their fields.

Sentences of one kind are decoded together, field by field: what is not given is NaN, what makes no sense
is infinite. An instrument's own "invalid" gives a reading with ``valid`` False.
"""

import math
from collections import defaultdict
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from navcore.foundation.units import DEG, KNOT
from navcore.io import nmea_values as value
from navcore.io.decimals import decimals
from navcore.io.nmea_lines import Sentences

_KMPH = 1.0 / 3.6
_FASTEST = 1000.0
_QUALITIES = {"6": "dead-reckoned", "7": "manual", "8": "simulated"}


READING = np.dtype(
    [("used", bool), ("sensible", bool), ("invalid", bool), ("time_of_day", float), ("day", float)]
)
"""Of a sentence: whether it is of a kind that is decoded; whether its fields make sense; whether the receiver
calls the whole of it invalid (nothing else is filled in then); its own UTC, s after midnight, and UTC
midnight of its own date, s since 1970; NaN without."""


class Readings(NamedTuple):
    """Readings of n sentences.

    Attributes
    ----------
    rows : ndarray of `READING`, shape (n,)
        Sense and time of each.
    quantities : list of (str, ndarray, ndarray)
        Of each kind: which of the sentences hold a quantity, shape (m,), and its values, shape (m, k).
        ``position``: latitude, longitude (rad), height above the ellipsoid (m, NaN if not given).
        ``velocity``: E, N over the ground, m/s. ``water``, ``ground``: starboard, forward speed (m/s) and
        whether the log calls it valid. ``heading``: rad, from true north.
    doubts : dict
        By sentence: its address, and what the receiver calls a fix that it did not measure (dead-reckoned,
        manual, simulated).
    """

    rows: np.ndarray
    quantities: list[tuple[str, np.ndarray, np.ndarray]]
    doubts: dict[int, tuple[str, str]]


class Fields:
    """Fields of n sentences of one kind, by column; those that a sentence leaves out are empty.

    Parameters
    ----------
    sentences : Sentences
        Among which they are.
    rows : ndarray of int, shape (n,)
        Which they are.

    Attributes
    ----------
    count : ndarray of int, shape (n,)
        How many each sentence has.
    """

    def __init__(self, sentences: Sentences, rows: np.ndarray) -> None:
        self._block, begins = sentences.block, sentences.rows["begin"][rows]
        self._ends = sentences.rows["end"][rows]
        self._stops = np.append(self._block.commas, self._block.letters.size)
        self._first = np.searchsorted(self._block.commas, begins)
        self.count = np.searchsorted(self._block.commas, self._ends) - self._first

    def _places(self, place: int) -> tuple[np.ndarray, np.ndarray]:
        """Where the fields begin and end."""
        begins, ends = (
            np.minimum(self._stops.take(self._first + place + k, mode="clip") + 1 - k, self._ends)
            for k in (0, 1)
        )
        return begins, ends

    def texts(self, place: int) -> list[str]:
        """Fields at a place behind the address."""
        return self._block.texts(*self._places(place))

    def are(self, place: int, text: str) -> np.ndarray:
        """Whether the fields at a place are this text."""
        begins, ends = self._places(place)
        same = ends - begins == len(text)
        for k, letter in enumerate(text):
            same &= self._block.ascii(begins + k) == ord(letter)
        return same

    def of(self, read: Callable[..., float], *places: int) -> np.ndarray:
        """Values of the fields at some places."""
        return np.fromiter(map(read, *(self.texts(place) for place in places)), float, self.count.size)

    def numbers(self, place: int, low: float, high: float) -> np.ndarray:
        """Optional numbers within a range."""
        begins, ends = self._places(place)
        numbers = decimals(self._block.letters, begins, ends)
        for row in np.flatnonzero(np.isnan(numbers) & (begins < ends)).tolist():
            numbers[row] = value.number(self._block.text[begins[row] : ends[row]])
        return np.where((numbers < low) | (numbers > high), math.inf, numbers)

    def speeds(self, place: int, unit: float = KNOT) -> np.ndarray:
        """Optional speeds, m/s."""
        return self.numbers(place, -_FASTEST / unit, _FASTEST / unit) * unit

    def headings(self, place: int) -> np.ndarray:
        """Optional headings in [0, 2 pi), rad."""
        degrees = self.numbers(place, 0.0, 360.0)
        return (np.where(degrees == 360.0, 0.0, degrees) + 0.0) * DEG

    def angles(self, place: int, positive: str, negative: str, most: float) -> np.ndarray:
        """Latitudes or longitudes, ``dddmm.mmmm`` and the side in the next field, rad."""
        begins, ends = self._places(place)
        minutes = self._block.next_of(self._block.points, begins) - 2
        plain = (minutes > begins) & (minutes + 3 < ends)
        for where in (begins, minutes):
            plain &= self._block.ascii(where) - np.uint32(ord("0")) < 10
        whole = decimals(self._block.letters, begins, minutes)
        degrees = whole + decimals(self._block.letters, minutes, ends) / 60.0
        for row in np.flatnonzero(~plain | np.isnan(degrees)).tolist():
            degrees[row] = value.degrees(self._block.text[begins[row] : ends[row]])
        sides = self.are(place + 1, positive), self.are(place + 1, negative)
        signed = np.where(sides[0], degrees, -degrees) * DEG
        return np.where((degrees <= most) & (sides[0] | sides[1]), signed, math.inf)


def _place(fields: Fields, first: int, height: np.ndarray | float = math.nan) -> np.ndarray:
    """Position of both angles with their sides, and the height."""
    latitude = fields.angles(first, "N", "S", 90.0)
    longitude = fields.angles(first + 2, "E", "W", 180.0)
    return np.column_stack([latitude, longitude, np.broadcast_to(height, latitude.shape)])


def _height(fields: Fields, separation: int) -> np.ndarray:
    """Height above the ellipsoid of the altitude and the geoid's separation, m."""
    above, geoid = fields.numbers(8, -1e4, 1e5), fields.numbers(separation, -200.0, 200.0)
    return np.where(np.isinf(geoid), geoid, above + _or_zero(geoid))


def _or_zero(values: np.ndarray) -> np.ndarray:
    return np.where(np.abs(values) > 0.0, values, 0.0)


def _speed(fields: Fields, knots: int, kmph: int) -> np.ndarray:
    """Speed in knots, or in km/h where that is not given."""
    speed = fields.speeds(knots)
    return np.where(np.isnan(speed), fields.speeds(kmph, _KMPH), speed)


def _over_ground(fields: Fields, course: int, speed: np.ndarray) -> np.ndarray:
    """East and north velocity of course and speed; a standing vessel has no course."""
    angle = fields.headings(course)
    senseless = np.isinf(angle) | np.isinf(speed)
    angles = np.where(senseless | (np.isnan(angle) & (speed == 0.0)), 0.0, angle).tolist()
    velocity = np.column_stack([list(map(math.sin, angles)), list(map(math.cos, angles))])
    velocity *= np.where(senseless, 0.0, speed)[:, None]
    velocity[senseless] = math.inf
    return velocity


def _axes(fields: Fields, first: int) -> np.ndarray:
    """Speeds along the ship's axes; a single-axis log has no transverse speed."""
    forward, transverse = fields.speeds(first), fields.speeds(first + 1)
    given, measured = ~np.isnan(forward), fields.are(first + 2, "A")
    axes = np.column_stack([_or_zero(transverse), forward, np.ones_like(forward)])
    axes[~(given & measured)] = 0.0
    axes[np.isinf(forward)] = math.inf
    axes[~given & fields.are(first + 2, "")] = math.nan
    return axes


def _needed(heading: np.ndarray) -> np.ndarray:
    return np.where(np.isnan(heading), math.inf, heading)


Decoded = dict[str, Any]
"""By name: values of the fields, shape (n,) or (n, k), ``valid`` and ``doubt``; see `Readings`."""
Decoder = Callable[[Fields], Decoded]


def _vbw(fields: Fields) -> Decoded:
    return {"water": _axes(fields, 0), "ground": _axes(fields, 3)}


def _vhw(fields: Fields) -> Decoded:
    forward = _speed(fields, 4, 6)
    water = np.column_stack([np.where(np.isnan(forward), math.nan, 0.0), forward, np.ones_like(forward)])
    return {"water": water, "heading": fields.headings(0)}


def _vtg(fields: Fields) -> Decoded:
    velocity = _over_ground(fields, 0, _speed(fields, 4, 6))
    return {"valid": ~fields.are(8, "N"), "velocity": velocity, "doubt": map(value.doubt, fields.texts(8))}


def _rmc(fields: Fields) -> Decoded:
    return {
        "valid": fields.are(1, "A"),
        "time_of_day": fields.of(value.time_of_day, 0),
        "day": fields.of(value.day, 8),
        "position": _place(fields, 2),
        "velocity": _over_ground(fields, 7, fields.speeds(6)),
        "doubt": map(value.doubt, fields.texts(11)),
    }


def _gga(fields: Fields) -> Decoded:
    quality = fields.of(value.quality, 5)
    return {
        "valid": quality != 0.0,
        "time_of_day": np.where(np.isinf(quality), math.inf, fields.of(value.time_of_day, 0)),
        "position": _place(fields, 1, _height(fields, 10)),
        "doubt": (_QUALITIES.get(field, "") for field in fields.texts(5)),
    }


def _hdt(fields: Fields) -> Decoded:
    return {"heading": _needed(fields.headings(0))}


def _gll(fields: Fields) -> Decoded:
    """Place, time and status; the oldest form has the place alone, which does not say that it is invalid."""
    oldest = fields.count == 4
    return {
        "valid": oldest | fields.are(5, "A"),
        "time_of_day": np.where(oldest, math.nan, fields.of(value.time_of_day, 4)),
        "position": _place(fields, 0),
        "doubt": map(value.doubt, fields.texts(6)),
    }


def _gns(fields: Fields) -> Decoded:
    return {
        "valid": fields.of(value.measures, 5) != 0.0,
        "time_of_day": fields.of(value.time_of_day, 0),
        "position": _place(fields, 1, _height(fields, 9)),
        "doubt": map(value.doubt, fields.texts(5)),
    }


def _zda(fields: Fields) -> Decoded:
    return {"time_of_day": fields.of(value.time_of_day, 0), "day": fields.of(value.date, 1, 2, 3)}


def _hdg(fields: Fields) -> Decoded:
    """Magnetic heading with its deviation and variation; without the variation it is no true heading."""
    magnetic, east, west = fields.headings(0), fields.are(4, "E"), fields.are(4, "W")
    deviation, variation = fields.numbers(1, 0.0, 180.0), fields.numbers(3, 0.0, 180.0)
    given = ~np.isnan(magnetic) & ~np.isnan(variation) & (east | west)
    senseless = np.isinf(magnetic) | np.isinf(variation) | (given & np.isinf(deviation))
    turned = _or_zero(deviation) * np.where(fields.are(2, "W"), -1.0, 1.0)
    with np.errstate(invalid="ignore"):  # of what makes no sense
        heading = (magnetic + (variation * np.where(east, 1.0, -1.0) + turned) * DEG) % (2.0 * math.pi)
    return {"heading": np.where(senseless, math.inf, np.where(given, heading, math.nan))}


def _ths(fields: Fields) -> Decoded:
    """True heading and status, which must not be left out: ``THS,77.52,A`` (V: invalid)."""
    heading = np.where(fields.count < 2, math.inf, _needed(fields.headings(0)))
    return {"valid": ~fields.are(1, "V"), "heading": heading}


def _pashr(fields: Fields) -> Decoded:
    """Attitude of Applanix and others: ``PASHR,hhmmss.sss,heading,T,roll,pitch,...``; others say nothing."""
    time_s = fields.of(value.makers_time, 0)
    attitude = (fields.count >= 5) & fields.are(2, "T") & ~np.isnan(time_s)
    return {
        "time_of_day": np.where(attitude, time_s, math.nan),
        "heading": np.where(attitude, fields.headings(1), math.nan),
    }


def _psxn(fields: Fields) -> Decoded:
    """Attitude of a Seapath: ``PSXN,23,roll,pitch,heading,heave``; its other messages say nothing."""
    return {"heading": np.where(fields.are(0, "23"), _needed(fields.headings(3)), math.nan)}


def _prdid(fields: Fields) -> Decoded:
    """Attitude as RD Instruments has it: ``PRDID,pitch,roll,heading``."""
    return {"heading": _needed(fields.headings(2))}


_STANDARD: dict[str, Decoder] = {
    "GGA": _gga,
    "GLL": _gll,
    "GNS": _gns,
    "HDG": _hdg,
    "HDT": _hdt,
    "RMC": _rmc,
    "THS": _ths,
    "VBW": _vbw,
    "VHW": _vhw,
    "VTG": _vtg,
    "ZDA": _zda,
}
"""Decoders by the last letters of the address; an older talker may leave out the last fields."""
_MAKERS: dict[str, Decoder] = {"PASHR": _pashr, "PRDID": _prdid, "PSXN": _psxn}
"""Decoders of makers' own sentences, by the whole address."""
KINDS = ", ".join((*sorted(_STANDARD), *_MAKERS))
"""Sentences that can be read, for messages."""


def _decoder(address: str) -> Decoder | None:
    standard = len(address) == 5 and address[0] != "P"
    return _STANDARD.get(address[2:]) if standard else _MAKERS.get(address)


def is_used(address: str) -> bool:
    """Whether sentences of this address are decoded."""
    return _decoder(address) is not None


def decode(sentences: Sentences) -> Readings:
    """Readings of the sentences of used kinds."""
    nothing = np.array((False, True, False, math.nan, math.nan), READING)
    readings = Readings(np.full(len(sentences.addresses), nothing), [], {})
    decoders = {address: _decoder(address) for address in set(sentences.addresses)}
    rows_of: defaultdict[Decoder | None, list[int]] = defaultdict(list)
    for row, address in enumerate(sentences.addresses):
        rows_of[decoders[address]].append(row)
    for decoder, rows in rows_of.items():
        if decoder is not None:
            fields = Fields(sentences, which := np.array(rows))
            _fill(readings, sentences.addresses, which, fields.count > 0, decoder(fields))
    return readings


def _fill(
    readings: Readings, addresses: list[str], rows: np.ndarray, sensible: np.ndarray, decoded: Decoded
) -> None:
    """Fill in what was decoded of the sentences of one kind."""
    valid = decoded.pop("valid", np.ones(rows.size, bool))
    doubts = decoded.pop("doubt", ())
    columns = {name: values.reshape(rows.size, -1) for name, values in decoded.items()}
    for values in columns.values():
        sensible &= ~(valid & np.isinf(values).any(axis=1))
    filled = valid & sensible
    for name, told in (("used", True), ("sensible", sensible), ("invalid", ~valid)):
        readings.rows[name][rows] = told
    said = zip(rows.tolist(), doubts, filled.tolist(), strict=False)
    readings.doubts.update((row, (addresses[row], doubt)) for row, doubt, counts in said if doubt and counts)
    for name, values in columns.items():
        held = filled & ~np.isnan(values[:, 0])
        if name in ("time_of_day", "day"):
            readings.rows[name][rows[held]] = values[held, 0]
        else:
            readings.quantities.append((name, rows[held], values[held]))
