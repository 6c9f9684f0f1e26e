"""Numbers typed with a unit, "30 min" into a box in hours, as the value in the field's own unit."""

from __future__ import annotations

import math
import re

from navcore.foundation.notation import unit_sign
from navcore.foundation.units import ARCMIN, ARCSEC, DEG, HOUR, KNOT, MINUTE, NAUTICAL_MILE

_G = 9.80665
_FAMILIES: tuple[dict[str, float], ...] = (
    {"s": 1.0, "min": MINUTE, "h": HOUR, "d": 24.0 * HOUR},
    {"m/s": 1.0, "kn": KNOT, "km/h": 1.0 / 3.6},
    {"rad": 1.0, "mrad": 1e-3, "deg": DEG, "arcmin": ARCMIN, "arcsec": ARCSEC},
    {"m": 1.0, "km": 1e3, "nmi": NAUTICAL_MILE},
    {"rad/s": 1.0, "deg/s": DEG, "deg/h": DEG / HOUR},
    {"m/s^2": 1.0, "g": _G, "mg": 1e-3 * _G, "ug": 1e-6 * _G},
)
"""Units that stand for each other, in SI."""
_SPELLED = {
    "°": "deg", "degrees": "deg", "′": "arcmin", "'": "arcmin", "″": "arcsec", '"': "arcsec",
    "°/h": "deg/h", "°/s": "deg/s", "kt": "kn", "kts": "kn", "knots": "kn", "nm": "nmi",
    "m/s2": "m/s^2", "m/s²": "m/s^2", "µg": "ug", "μg": "ug",
    "sec": "s", "minutes": "min", "hours": "h", "days": "d",
}  # fmt: skip
_FORM = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(\S*)\s*")


def unit_of(label: str) -> str:
    """Unit in a control's label; empty without one.

    Examples
    --------
    >>> unit_of("duration (h)"), unit_of("gyro bias x (°/h)"), unit_of("r")
    ('h', '°/h', '')
    """
    found = re.search(r"\(([^()]*)\)$", label)
    return "" if found is None else found[1]


def read_typed(text: str, unit: str) -> float:
    """Value of a typed number in a field's unit.

    Parameters
    ----------
    text : str
        "30 min", "2kn", "0.5"; without a unit it is in the field's.
    unit : str
        Of the field; empty for a plain number.

    Raises
    ------
    ValueError
        In words: no number, or a unit that does not fit.

    Examples
    --------
    >>> read_typed("30 min", "h"), read_typed("2 kn", "kn"), read_typed("0.5", "")
    (0.5, 2.0, 0.5)
    """
    found = _FORM.fullmatch(text)
    if found is None:
        raise ValueError("must be a number, with a unit if wanted, such as 30 min")
    value, given = float(found[1]), _SPELLED.get(found[2], found[2])
    mine = _SPELLED.get(unit, unit)
    if not math.isfinite(value):
        raise ValueError("must be a finite number")
    if given in ("", mine):
        return value
    family = next((units for units in _FAMILIES if mine in units), {mine: 1.0} if mine else {})
    if given not in family:
        allowed = "takes a number without a unit"
        if family:
            allowed = f"must be in one of {', '.join(map(unit_sign, family))}"
        raise ValueError(f"{allowed}, not in {given!r}")
    # Rounded to what a double holds safely: 30 min are 0.5 h, not 0.49999999999999994 h.
    return float(f"{value * family[given] / family[mine]:.14g}")
