"""Text typed into a box: lists of roots, numbers or rows, and the unit of a label.

Every number in them is read by `navcore.foundation.numbers`, one with a unit by
`navcore.foundation.with_unit`.
"""

import re
from typing import Any

from navcore.foundation.numbers import MINUS, NotANumber, read_number, unquoted
from navcore.foundation.text import Text
from navcore.foundation.with_unit import read_quoting

_HIDDEN = str.maketrans(",; \n", "\ue000\ue001\ue002\ue003")
_SHOWN = str.maketrans("\ue000\ue001\ue002\ue003", ",; \n")
"""Stand for what separates where it does not: within brackets."""
_MINUS = ("-", *MINUS)
_DECIMALS = 6
"""Zeros behind the point up to which a small number is written without an exponent."""


def unit_of(label: str) -> str:
    """Unit in a control's label; empty without one.

    Examples
    --------
    >>> unit_of("duration (h)"), unit_of("gyro bias x (°/h)"), unit_of("r")
    ('h', '°/h', '')
    """
    match = re.search(r"\(([^()]*)\)$", label)
    return "" if match is None else match[1]


def write_number(value: float) -> str:
    """Write a number into a box: with all its digits, or with 12 where a double's rounding shows.

    Examples
    --------
    >>> [write_number(value) for value in (0.003, 5.0, 1e-5, 0.1 + 0.2, 2e-9)]
    ['0.003', '5', '0.00001', '0.3', '2e-09']
    """
    if isinstance(value, int):
        return str(value)
    text = f"{value:.15g}"
    if float(text) != value:
        text = f"{value:.12g}"
    mantissa, _, power = text.partition("e-")
    if not power or int(power) > _DECIMALS:
        return text
    return f"{value:.{int(power) + len(mantissa.lstrip('-').replace('.', '')) - 1}f}"


def read_roots(text: str) -> list[Any]:
    """Zeros or poles as typed: numbers, complex ones as ``-0.1+0.2j``, or ``[re, im]``; separated as a list.

    Raises
    ------
    NotANumber
        A `ValueError`: a part is neither, or it is not clear where the next one begins.

    Examples
    --------
    >>> read_roots("-8.5e-4, -0.1+0.2j, -0.1-0.2j"), read_roots("[-1, 2], 3"), read_roots(" ")
    ([-0.00085, [-0.1, 0.2], [-0.1, -0.2]], [[-1.0, 2.0], 3.0], [])
    """
    roots: list[Any] = []
    for part in _items(text):
        if part.startswith("["):
            inside = part.removeprefix("[").removesuffix("]")
            both = inside.split(",") if inside.count(",") == 1 else _items(inside)
            if len(both) != 2:
                raise NotANumber(part, Text("must be two numbers, [re, im]"))
            roots.append([read_quoting(number, part) for number in both])
            continue
        roots.append(_root_of(part))
    return roots


def _root_of(part: str) -> Any:
    """Read a real or a complex root."""
    inside = part[1:-1] if part.startswith("(") and part.endswith(")") else part
    bare = re.sub(r"[ \t]", "", inside)
    if bare[-1:] not in ("i", "j"):
        return read_number(part)
    sign = next((at for at in range(len(bare) - 2, -1, -1) if _begins(bare, at)), 0)
    re_part, im_part = bare[:sign], bare[sign:-1]
    im = read_quoting(f"{im_part}1" if im_part in ("", "+", *_MINUS) else im_part, part)
    real = read_quoting(re_part, part) if re_part else 0.0
    return [real, im] if im else real


def _begins(bare: str, at: int) -> bool:
    """Whether the imaginary part begins at a place: with a sign that is none of an exponent."""
    return bare[at] in ("+", *_MINUS) and bare[at - 1 : at] not in ("e", "E", "^", "*", "(", "{")


def read_numbers(text: str) -> list[float]:
    """Coefficients as typed, separated as a list or by blanks; raises `NotANumber`.

    Examples
    --------
    >>> read_numbers("1, 0.5"), read_numbers("1 0.5 2"), read_numbers("1; 0,5; 2")
    ([1.0, 0.5], [1.0, 0.5, 2.0], [1.0, 0.5, 2.0])
    """
    return [read_number(part) for part in _items(text, blanks=True)]


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
    """Rows of a table as typed, ``0: 0.99, 0.5: 0.12``; raises `NotANumber`.

    Examples
    --------
    >>> read_pairs("0: 0.99, 0.5:0.12"), write_pairs([(0.0, 0.99), [0.5, 0.12]])
    ([[0.0, 0.99], [0.5, 0.12]], '0: 0.99, 0.5: 0.12')
    """
    rows = [row.split(":") for row in _items(text)]
    for row in rows:
        if len(row) != 2:
            raise NotANumber(":".join(row), Text("must be two numbers with a colon between them"))
    return [[read_quoting(number, ":".join(row)) for number in row] for row in rows]


def write_pairs(rows: Any) -> str:
    """Inverse of `read_pairs`."""
    return ", ".join(f"{first:.9g}: {second:.9g}" for first, second in rows or ())


def _root(root: Any) -> str:
    re, im = (root.real, root.imag) if not isinstance(root, list | tuple) else root
    return f"{re:.9g}{im:+.9g}j" if im else f"{re:.9g}"


def _items(text: str, *, blanks: bool = False) -> list[str]:
    """Split a list, outside of its brackets: at semicolons where there are any, else at commas.

    A comma between two digits may be a decimal comma: ``0,5`` is refused, as is ``1,234,567``. A comma that
    is followed by a blank, or that stands in what can be no number (``1,2,3``), separates.
    """
    bare = unquoted(text.strip())
    depth, marked = 0, ""
    for letter in bare:  # within brackets nothing separates
        depth += (letter in "[({") - (letter in "])}")
        marked += letter if depth <= 0 else letter.translate(_HIDDEN)
    if depth:
        raise NotANumber(text, Text("has a bracket without its other one"))
    separator = r"[;\n]" if ";" in marked else r"(?:,\s+|\s+,|,$|\n)"
    parts = re.split(rf"{separator}|[ \t\n]+" if blanks else separator, marked)
    items: list[str] = []
    for part in parts:
        row = part.count(":") == 1
        items += [part] if ";" in marked or row or "," not in part else _at_commas(part)
    shown = (item.translate(_SHOWN).strip() for item in items)
    return [item for item in shown if item]


def _at_commas(part: str) -> list[str]:
    """Split at commas without a blank, where they can be no decimal ones."""
    try:
        read_number(part)
        single = True
    except NotANumber as error:
        single = "may mean" in error.allowed
    if single:
        told = Text("may be one number or several: separate them by a semicolon, or by a comma and a blank")
        raise NotANumber(part, told)
    return part.split(",")
