"""The sentences that are used, NMEA 0183 and makers' own, decoded to SI by the places of their fields.

Sentences of one kind are decoded together, field by field: what is not given is NaN, what makes no sense
is infinite. An instrument's own "invalid" gives a reading with ``valid`` False.
"""

import math
from collections import Counter, defaultdict
from typing import NamedTuple

import numpy as np

from navcore.foundation.units import DEG
from navcore.io import nmea_values as value
from navcore.io.nmea_fields import Fields
from navcore.io.nmea_flags import INVALID_CODE, Flag, flag_of, words_of
from navcore.io.nmea_lines import Sentences
from navcore.io.nmea_makers import ABOUT_OTHERS, MAKERS, Decoded, Decoder

_KMPH = 1.0 / 3.6


READING = np.dtype(
    [
        ("used", bool),
        ("sensible", bool),
        ("cut", bool),
        ("invalid", bool),
        ("role", np.int8),
        ("time_of_day", float),
        ("day", float),
    ]
)
"""Of a sentence: whether it is of a kind that is decoded; whether its fields make sense; whether it is cut
off (it makes no sense then); whether the receiver calls the whole of it invalid (no quantity is filled in
then); whether it is a reading (0), another message of its maker (`OTHER_MESSAGE`) or one that speaks of
others (`ABOUT_OTHERS`); its own UTC, s after midnight, and UTC midnight of its own date, s since 1970; NaN
without."""


ALONG_AXES = ("water", "ground")
"""Quantities whose last value says whether the log calls them valid."""
NOT_GIVEN = -1.0
"""In its place: the field is empty, though a flag stands beside it."""


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
        whether the log calls it valid (1 or 0, `NOT_GIVEN` for an empty one). ``heading``: rad, from true
        north.
    doubts, invalid : Counter
        Readings by their address and by what a flag says of them (simulated, manual, dead-reckoned); those
        that a flag calls invalid by their address and quantity.
    """

    rows: np.ndarray
    quantities: list[tuple[str, np.ndarray, np.ndarray]]
    doubts: Counter[tuple[str, str]]
    invalid: Counter[tuple[str, str]]


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
    given, measured = ~np.isnan(forward), fields.codes(flag_of("VBW", first + 2)) != INVALID_CODE
    axes = np.column_stack([_or_zero(transverse), forward, np.ones_like(forward)])
    axes[~(given & measured)] = 0.0
    axes[~given, 2] = NOT_GIVEN
    axes[np.isinf(forward)] = math.inf
    axes[~given & fields.are(first + 2, "")] = math.nan
    return axes


def _vbw(fields: Fields) -> Decoded:
    return {"water": _axes(fields, 0), "ground": _axes(fields, 3)}


def _vhw(fields: Fields) -> Decoded:
    forward = _speed(fields, 4, 6)
    water = np.column_stack([np.where(np.isnan(forward), math.nan, 0.0), forward, np.ones_like(forward)])
    return {"water": water, "heading": fields.headings(0)}


def _vtg(fields: Fields) -> Decoded:
    velocity = _over_ground(fields, 0, _speed(fields, 4, 6))
    return {"flags": fields.codes(flag_of("VTG", 8)), "velocity": velocity}


def _with_status(fields: Fields, sentence: str, *flags: Flag) -> np.ndarray:
    """Flags with the navigational status, which only NMEA 4.1 has."""
    told = (*flags, flag_of(sentence, 12)) if fields.count.max(initial=0) > 12 else flags
    return fields.codes(*told)


def _rmc(fields: Fields) -> Decoded:
    return {
        "flags": _with_status(fields, "RMC", flag_of("RMC", 1), flag_of("RMC", 11)),
        "time_of_day": fields.of(value.time_of_day, 0),
        "day": fields.of(value.day, 8),
        "position": _place(fields, 2),
        "velocity": _over_ground(fields, 7, fields.speeds(6)),
    }


def _gga(fields: Fields) -> Decoded:
    return {
        "flags": fields.codes(flag_of("GGA", 5)),
        "time_of_day": fields.of(value.time_of_day, 0),
        "position": _place(fields, 1, _height(fields, 10)),
    }


def _hdt(fields: Fields) -> Decoded:
    return {"heading": fields.headings(0)}


def _gll(fields: Fields) -> Decoded:
    """Place, time and status; older forms have no status or the place alone: that does not say invalid."""
    oldest = fields.count == 4
    return {
        "flags": np.where(fields.count < 6, 0, fields.codes(flag_of("GLL", 5), flag_of("GLL", 6))),
        "time_of_day": np.where(oldest, math.nan, fields.of(value.time_of_day, 4)),
        "position": _place(fields, 0),
    }


def _gns(fields: Fields) -> Decoded:
    return {
        "flags": _with_status(fields, "GNS", flag_of("GNS", 5)),
        "time_of_day": fields.of(value.time_of_day, 0),
        "position": _place(fields, 1, _height(fields, 9)),
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
    heading = np.where(fields.count < 2, math.inf, fields.headings(0))
    return {"flags": fields.codes(flag_of("THS", 1)), "heading": heading}


def _dtm(fields: Fields) -> Decoded:
    """Datum of the positions beside it."""
    return {"role": np.full(fields.count.size, ABOUT_OTHERS), "flags": fields.codes(flag_of("DTM", 0))}


_STANDARD: dict[str, Decoder] = {
    "DTM": _dtm,
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
KINDS = ", ".join((*sorted(_STANDARD), *MAKERS))
"""Sentences that can be read, for messages."""


_FEWEST = {
    "GGA": (12,), "GLL": (6, 4), "GNS": (12,), "HDG": (5,), "HDT": (2,), "RMC": (9,), "THS": (2,),
    "VBW": (10, 6), "VHW": (8,), "VTG": (8,), "ZDA": (6,),
    "PHINF": (1,), "PHOCT": (19,), "PRDID": (3,), "PSAT,HPR": (6,), "PSXN,20": (5,), "PSXN,23": (5,),
}  # fmt: skip
"""Fields that a kind has at least, and how many an older form has, the last one filled in. A checksum proves
that a sentence is whole; one that has neither was cut off, as by a full buffer, perhaps within a number."""


def _kind(address: str) -> str:
    """Last letters of a standard address; the whole one of a maker's sentence."""
    return address[2:] if len(address) == 5 and address[0] != "P" else address


def _decoder(address: str) -> Decoder | None:
    return _STANDARD.get(_kind(address)) or MAKERS.get(address)


def _are_cut(kind: str, fields: Fields) -> np.ndarray:
    """Which sentences of a kind have neither a checksum nor all of their fields."""
    cut = np.zeros(fields.count.size, bool)
    for name, (fewest, *older) in _FEWEST.items():
        own, _, number = name.partition(",")
        if own == kind:
            short = ~fields.proven & (fields.count < fewest)
            for count in older:
                short &= (fields.count != count) | fields.are(count - 1, "")
            cut |= short & fields.are(0, number) if number else short
    return cut


def is_used(address: str) -> bool:
    """Whether sentences of this address are decoded."""
    return _decoder(address) is not None


def decode(sentences: Sentences, carried: dict[str, int] | None = None) -> Readings:
    """Readings of the sentences of used kinds; ``carried`` keeps flags from one block to the next."""
    nothing = np.array((False, True, False, False, 0, math.nan, math.nan), READING)
    carried = {} if carried is None else carried
    readings = Readings(np.full(len(sentences.addresses), nothing), [], Counter(), Counter())
    kinds = {address: _kind(address) for address in set(sentences.addresses) if is_used(address)}
    rows_of: defaultdict[str, list[int]] = defaultdict(list)
    for row, address in enumerate(sentences.addresses):
        rows_of[kinds.get(address, "")].append(row)
    status = _status_of_others(sentences, rows_of["PHINF"], carried)
    for kind, rows in rows_of.items():
        decoder = _STANDARD.get(kind) or MAKERS.get(kind)
        if decoder is not None:
            fields = Fields(sentences, which := np.array(rows, int), carried)
            cut, decoded = _are_cut(kind, fields), decoder(fields)
            readings.rows["cut"][which] = cut
            if kind == "HDT" and status is not None:
                decoded["flags"] = status[which]
            _fill(readings, sentences.addresses, which, (fields.count > 0) & ~cut, decoded)
    return readings


def _status_of_others(sentences: Sentences, rows: list[int], carried: dict[str, int]) -> np.ndarray | None:
    """What the PHINF of an instrument say of its HEHDT, as numbers of flags, shape (n,); None without any.

    PHINF stands behind the sentences of which it speaks, and is slower than they are: the worse one of the
    last before and the next behind counts. Of the next block of lines nothing is known yet.
    """
    if not rows and not carried:
        return None
    which = np.array(rows, int)
    told = Fields(sentences, which, carried).codes(flag_of("PHINF", 0))
    sources, status = sentences.sources, np.zeros(len(sentences.addresses), np.int8)
    spoken_of = [row for row, address in enumerate(sentences.addresses) if address == "HEHDT"]
    for source in {sources[row] for row in (*rows, *spoken_of)}:
        key = f"PHINF {source}"
        own = np.flatnonzero([sources[row] == source for row in rows])
        at = np.array([row for row in spoken_of if sources[row] == source], int)
        codes = np.concatenate([[carried.get(key, 0)], told[own], [0]])
        behind = np.searchsorted(which[own], at) + 1
        status[at] = np.maximum(codes[behind - 1], codes[behind])
        carried[key] = int(codes[-2])
    return status


def _fill(
    readings: Readings, addresses: list[str], rows: np.ndarray, sensible: np.ndarray, decoded: Decoded
) -> None:
    """Fill in what was decoded of the sentences of one kind.

    A time counts in an invalid sentence too: a receiver without a fix still has a clock.
    """
    flags = decoded.pop("flags", np.zeros(rows.size, np.int8))
    readings.rows["role"][rows] = decoded.pop("role", 0)
    valid = flags != INVALID_CODE
    columns = {name: values.reshape(rows.size, -1) for name, values in decoded.items()}
    for values in columns.values():
        sensible &= ~(valid & np.isinf(values).any(axis=1))
    filled = valid & sensible
    for name, told in (("used", True), ("sensible", sensible), ("invalid", ~valid)):
        readings.rows[name][rows] = told
    for name, values in columns.items():
        known = np.isfinite(values[:, 0])
        if name in ("time_of_day", "day"):
            held = sensible & known
            readings.rows[name][rows[held]] = values[held, 0]
            continue
        held = filled & known
        readings.quantities.append((name, rows[held], values[held]))
        lost = sensible & ~valid
        if name in ALONG_AXES:
            lost |= held & (values[:, 2] == 0.0)
        if lost.any():
            readings.invalid.update((addresses[row], name) for row in rows[lost].tolist())
    doubtful = np.flatnonzero(filled & (flags != 0))
    readings.doubts.update((addresses[rows[row]], words_of(flags[row])) for row in doubtful.tolist())
