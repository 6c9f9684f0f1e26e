"""Sentences of an INS with other readings in them: the same fields and decimals, and a new checksum."""

import math
import re
from collections.abc import Callable
from functools import reduce

from navcore.foundation.units import DEG, KNOT
from navcore.io.nmea_values import degrees
from navcore.io.rewritten import Moved, wrapped, written_like

_SENTENCE = re.compile(r"([$!])([A-Z0-9]{3,10},[^*$!\r\n]*)(\*[0-9A-Fa-f]{2})?")
_KMPH = 1.0 / 3.6
Fields = list[str]


def rewritten_line(line: str, moved: Moved) -> str:
    """Return a line with the readings of its sentences moved; what is not moved stays as it is.

    Parameters
    ----------
    line : str
        With one sentence or several, and whatever a logger puts beside them.
    moved : Moved
        At the time of the line, of one row.
    """

    def one(found: re.Match[str]) -> str:
        body = rewritten(found[2], moved)
        if body == found[2]:
            return found[0]
        return f"{found[1]}{body}*{checksum(body)}" if found[3] else f"{found[1]}{body}"

    return _SENTENCE.sub(one, line)


def checksum(body: str) -> str:
    """Checksum of a sentence without its mark.

    Examples
    --------
    >>> checksum("GPGLL,4916.45,N,12311.12,W,225444,A,")
    '1D'
    """
    return f"{reduce(lambda sum, letter: sum ^ ord(letter), body, 0):02X}"


def rewritten(body: str, moved: Moved) -> str:
    """Return a sentence, from the address to its last field, with its readings moved."""
    address, *fields = body.split(",")
    move = _MOVES.get(address) or (_MOVES.get(address[2:]) if len(address) == 5 else None)
    if move is None:
        return body
    move(fields, moved)
    return ",".join((address, *fields))


def _number(fields: Fields, place: int) -> float | None:
    try:
        return float(fields[place])
    except (IndexError, ValueError):
        return None


def _add(fields: Fields, place: int, change: float, low: float = -math.inf) -> None:
    """Add to a plain number; of an angle in degrees that begins at ``low`` within a turn."""
    value = _number(fields, place)
    if value is None:
        return
    value += change
    text = written_like(fields[place], value if math.isinf(low) else wrapped(value, low, 360.0))
    if not math.isinf(low) and float(text) >= low + 360.0:  # rounded up to a whole turn
        text = written_like(fields[place], low)
    fields[place] = text


def _heading(fields: Fields, place: int, moved: Moved) -> None:
    _add(fields, place, float(moved.turn[0]) / DEG, 0.0)


def _angle(fields: Fields, place: int, change: float, sides: str, most: float) -> None:
    """Add to ``dddmm.mmmm`` with its side in the next field."""
    if place + 1 >= len(fields) or fields[place + 1] not in tuple(sides):
        return
    size = degrees(fields[place])
    if not math.isfinite(size):
        return
    value = (size if fields[place + 1] == sides[0] else -size) + change / DEG
    value = wrapped(value, -180.0, 360.0) if most == 180.0 else value
    decimals = len(fields[place].partition(".")[2])
    minutes = round(abs(value) * 60.0, decimals)  # rounded first: 60 minutes are a degree more
    whole = int(minutes // 60.0)
    width = (3 if most == 180.0 else 2) + 2 + (decimals + 1 if decimals else 0)
    text = f"{100 * whole + minutes - 60.0 * whole:.{decimals}f}"
    fields[place] = text.zfill(width)
    fields[place + 1] = sides[0] if value >= 0.0 else sides[1]


def _place(fields: Fields, first: int, moved: Moved) -> None:
    _angle(fields, first, float(moved.place[0, 0]), "NS", 90.0)
    _angle(fields, first + 2, float(moved.place[0, 1]), "EW", 180.0)


def _course(
    fields: Fields, moved: Moved, true: int, speeds: dict[int, float], magnetic: int | None = None
) -> None:
    """Move the velocity that a course and a speed give, in each unit in which it stands."""
    unit_of = next((place for place in speeds if _number(fields, place) is not None), None)
    if unit_of is None:
        return
    speed, course = (_number(fields, unit_of) or 0.0) * speeds[unit_of], _number(fields, true)
    if course is None and speed:
        return
    angle = (course or 0.0) * DEG
    east = speed * math.sin(angle) + float(moved.velocity[0, 0])
    north = speed * math.cos(angle) + float(moved.velocity[0, 1])
    for place, unit in speeds.items():
        if _number(fields, place) is not None:
            fields[place] = written_like(fields[place], math.hypot(east, north) / unit)
    if course is not None:
        turned = math.atan2(east, north) / DEG - course
        for place in (true, *([] if magnetic is None else [magnetic])):
            _add(fields, place, turned, 0.0)


def _lean(fields: Fields, moved: Moved, pitch: int, roll: int, sense: float = 1.0) -> None:
    """Move pitch and roll; ``sense`` is -1 where pitch counts bow down."""
    value = _number(fields, pitch)
    changes = moved.leaning(0.0 if value is None else value * DEG)
    _add(fields, pitch, sense * float(changes[0][0]) / DEG)
    _add(fields, roll, float(changes[1][0]) / DEG)


def _rmc(fields: Fields, moved: Moved) -> None:
    _place(fields, 2, moved)
    _course(fields, moved, 7, {6: KNOT})


def _vtg(fields: Fields, moved: Moved) -> None:
    _course(fields, moved, 0, {4: KNOT, 6: _KMPH}, 2)


def _vhw(fields: Fields, moved: Moved) -> None:
    _heading(fields, 0, moved)
    _heading(fields, 2, moved)


def _pashr(fields: Fields, moved: Moved) -> None:
    if len(fields) > 4 and fields[2] == "T":
        _heading(fields, 1, moved)
        _lean(fields, moved, 4, 3)


def _psat(fields: Fields, moved: Moved) -> None:
    if fields[:1] == ["HPR"]:
        _heading(fields, 2, moved)
        _lean(fields, moved, 3, 4)


def _psxn(fields: Fields, moved: Moved) -> None:
    if fields[:1] == ["23"]:
        _heading(fields, 3, moved)
        _lean(fields, moved, 2, 1)


def _prdid(fields: Fields, moved: Moved) -> None:
    _heading(fields, 2, moved)
    _lean(fields, moved, 0, 1)


def _pixse(fields: Fields, moved: Moved) -> None:
    kind = fields[0] if fields else ""
    if kind == "POSITI":
        _add(fields, 1, float(moved.place[0, 0]) / DEG)
        longitude = _number(fields, 2) or 0.0
        _add(fields, 2, float(moved.place[0, 1]) / DEG, 0.0 if longitude >= 0.0 else -180.0)
    elif kind == "SPEED_":
        _add(fields, 1, float(moved.velocity[0, 0]))
        _add(fields, 2, float(moved.velocity[0, 1]))
    elif kind == "ATITUD":
        _lean(fields, moved, 2, 1, -1.0)


_MOVES: dict[str, Callable[[Fields, Moved], None]] = {
    "GGA": lambda fields, moved: _place(fields, 1, moved),
    "GLL": lambda fields, moved: _place(fields, 0, moved),
    "GNS": lambda fields, moved: _place(fields, 1, moved),
    "HDG": lambda fields, moved: _heading(fields, 0, moved),
    "HDT": lambda fields, moved: _heading(fields, 0, moved),
    "RMC": _rmc,
    "THS": lambda fields, moved: _heading(fields, 0, moved),
    "VHW": _vhw,
    "VTG": _vtg,
    "PASHR": _pashr,
    "PHOCT": lambda fields, moved: _heading(fields, 4, moved),
    "PIXSE": _pixse,
    "PRDID": _prdid,
    "PSAT": _psat,
    "PSXN": _psxn,
}
"""What is moved in each kind of sentence that `navcore.io.nmea_sentences` reads."""
