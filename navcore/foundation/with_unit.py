"""A number with a unit: "30 min" in hours, "1 nmi" in metres.

The number is read by `navcore.foundation.numbers`. A unit of another dimension is refused.
"""

import re

from navcore.foundation.notation import unit_sign
from navcore.foundation.numbers import NotANumber, read_number, read_whole, unquoted
from navcore.foundation.text import Text
from navcore.foundation.units import (
    ARCMIN,
    ARCSEC,
    DEG,
    HOUR,
    KNOT,
    MICRO_G,
    MINUTE,
    NAUTICAL_MILE,
    STANDARD_GRAVITY,
)

_FAMILIES: tuple[dict[str, float], ...] = (
    {"s": 1.0, "min": MINUTE, "h": HOUR, "d": 24.0 * HOUR},
    {"m/s": 1.0, "kn": KNOT, "km/h": 1.0 / 3.6},
    {"rad": 1.0, "mrad": 1e-3, "deg": DEG, "arcmin": ARCMIN, "arcsec": ARCSEC},
    {"m": 1.0, "km": 1e3, "nmi": NAUTICAL_MILE},
    {"rad/s": 1.0, "deg/s": DEG, "deg/h": DEG / HOUR},
    {"m/s^2": 1.0, "g": STANDARD_GRAVITY, "mg": 1e-3 * STANDARD_GRAVITY, "ug": MICRO_G},
)
"""Units that stand for each other, in SI."""
_SPELLED = {
    "°": "deg", "degrees": "deg", "′": "arcmin", "'": "arcmin", "″": "arcsec", '"': "arcsec",
    "°/h": "deg/h", "°/s": "deg/s", "kt": "kn", "kts": "kn", "knots": "kn",
    "nm": "nmi", "NM": "nmi", "nmi/h": "kn",
    "m/s2": "m/s^2", "m/s²": "m/s^2", "µg": "ug", "μg": "ug",
    "sec": "s", "minutes": "min", "hours": "h", "days": "d",
}  # fmt: skip
_UNITS = sorted({*_SPELLED, *(unit for family in _FAMILIES for unit in family)}, key=len, reverse=True)
_UNKNOWN_UNIT = re.compile(r"(.*[\d.,])\s*([^\d\s.,+-][^\d]*)", re.DOTALL)


def read_with_unit(text: str, unit: str, *, whole: bool = False) -> float:
    """Value of a number with a unit, in the unit of its field.

    Parameters
    ----------
    text : str
        "30 min", "2kn", "0,5", "2·10^-4 °/h"; without a unit it is in the field's.
    unit : str
        Of the field; empty for a plain number.
    whole : bool
        It must be a whole number, and is an `int`.

    Raises
    ------
    NotANumber
        A `ValueError` in words: no number, or a unit that does not fit.

    Examples
    --------
    >>> read_with_unit("30 min", "h"), read_with_unit("2 kn", "kn"), read_with_unit("0,5", "")
    (0.5, 2.0, 0.5)
    """
    number, given = _parted(unquoted(text.strip()))
    mine = _SPELLED.get(unit, unit)
    if given in ("", mine):
        return read_quoting(number, text, whole=whole)
    family = next((units for units in _FAMILIES if mine in units), {mine: 1.0} if mine else {})
    if given not in family:
        read_quoting(number, text)  # what is no number either is refused as such
        if not family:
            raise NotANumber(text, Text("must be a number without a unit"))
        units = ", ".join(map(unit_sign, family))
        raise NotANumber(text, Text("must be in one of {units}, not in {given!r}", units=units, given=given))
    # Rounded to what a double holds safely: 30 min are 0.5 h, not 0.49999999999999994 h.
    value = f"{read_quoting(number, text) * family[given] / family[mine]:.14g}"
    return read_whole(value) if whole else float(value)


def _parted(text: str) -> tuple[str, str]:
    """Return a number and its unit, as `_FAMILIES` spells it; the unit is empty where there is none."""
    try:
        read_number(text)
    except NotANumber:
        pass
    else:
        return text, ""
    for unit in _UNITS:
        number = text.removesuffix(unit).rstrip()
        if number != text and number[-1:].isdecimal() | (number[-1:] in "⁰¹²³⁴⁵⁶⁷⁸⁹.)}"):
            return number, _SPELLED.get(unit, unit)
    unknown = _UNKNOWN_UNIT.fullmatch(text)
    return (text, "") if unknown is None else (unknown[1], unknown[2].strip())


def read_quoting(number: str, text: str, *, whole: bool = False) -> float:
    """Read a number that is a part of a text; a fault quotes the whole text.

    Raises
    ------
    NotANumber
        A `ValueError` in words.
    """
    try:
        return read_whole(number) if whole else read_number(number)
    except NotANumber as error:
        raise NotANumber(text, error.allowed) from None
