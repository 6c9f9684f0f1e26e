"""Text typed into a box: a number with a unit ("30 min" in hours), and lists of roots, numbers or rows."""

import math
import re
from typing import Any

from navcore.foundation.notation import unit_sign
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
    match = re.search(r"\(([^()]*)\)$", label)
    return "" if match is None else match[1]


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
    match = _FORM.fullmatch(text)
    if match is None:
        raise ValueError("must be a number, with a unit if wanted, such as 30 min")
    value, given = float(match[1]), _SPELLED.get(match[2], match[2])
    mine = _SPELLED.get(unit, unit)
    if not math.isfinite(value):
        raise ValueError("must be a finite number")
    if given in ("", mine):
        return value
    family = next((units for units in _FAMILIES if mine in units), {mine: 1.0} if mine else {})
    if given not in family:
        allowed = Text("takes a number without a unit")
        if family:
            allowed = Text("must be in one of {family}", family=", ".join(map(unit_sign, family)))
        raise ValueError(f"{allowed}, not in {given!r}")
    # Rounded to what a double holds safely: 30 min are 0.5 h, not 0.49999999999999994 h.
    return float(f"{value * family[given] / family[mine]:.14g}")


def read_roots(text: str) -> list[Any]:
    """Zeros or poles as typed: numbers, complex ones as ``-0.1+0.2j``, or ``[re, im]``; separated by commas.

    Raises
    ------
    ValueError
        A part is neither.

    Examples
    --------
    >>> read_roots("-8.5e-4, -0.1+0.2j, -0.1-0.2j"), read_roots("[-1, 2], 3"), read_roots(" ")
    ([-0.00085, [-0.1, 0.2], [-0.1, -0.2]], [[-1.0, 2.0], 3.0], [])
    """
    roots: list[Any] = []
    for part in _parts(text):
        if part.startswith("["):
            re, im = (float(number) for number in part.removeprefix("[").removesuffix("]").split(","))
            roots.append([re, im])
            continue
        root = complex(part.replace(" ", "").replace("i", "j"))
        roots.append([root.real, root.imag] if root.imag else root.real)
    return roots


def read_numbers(text: str) -> list[float]:
    """Coefficients as typed, separated by commas or blanks; raises ValueError."""
    return [float(part) for part in text.replace(",", " ").split()]


def write_roots(roots: Any) -> str:
    """Inverse of `read_roots`.

    Examples
    --------
    >>> write_roots([(-0.00085, 0.0), [-0.1, 0.2], complex(-0.1, -0.2), 3])
    '-0.00085, -0.1+0.2j, -0.1-0.2j, 3'
    """
    return ", ".join(_root(root) for root in roots or ())


def write_numbers(values: Any) -> str:
    """Inverse of `read_numbers`."""
    return ", ".join(f"{value:.9g}" for value in values or ())


def read_pairs(text: str) -> list[list[float]]:
    """Rows of a table as typed, ``0: 0.99, 0.5: 0.12``; raises ValueError.

    Examples
    --------
    >>> read_pairs("0: 0.99, 0.5:0.12"), write_pairs([(0.0, 0.99), [0.5, 0.12]])
    ([[0.0, 0.99], [0.5, 0.12]], '0: 0.99, 0.5: 0.12')
    """
    rows = [[float(number) for number in row.split(":")] for row in text.split(",") if row.strip()]
    if any(len(row) != 2 for row in rows):
        raise ValueError("a row is two numbers with a colon between them")
    return rows


def write_pairs(rows: Any) -> str:
    """Inverse of `read_pairs`."""
    return ", ".join(f"{first:.9g}: {second:.9g}" for first, second in rows or ())


def _root(root: Any) -> str:
    re, im = (root.real, root.imag) if not isinstance(root, list | tuple) else root
    return f"{re:.9g}{im:+.9g}j" if im else f"{re:.9g}"


def _parts(text: str) -> list[str]:
    parts, depth, current = [], 0, ""
    for letter in text.strip():
        depth += (letter == "[") - (letter == "]")
        if letter in ",;" and depth == 0:
            parts.append(current.strip())
            current = ""
        else:
            current += letter
    if depth:
        raise ValueError("a bracket is missing")
    return [part for part in [*parts, current.strip()] if part]
