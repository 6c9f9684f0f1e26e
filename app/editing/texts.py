"""Lists as one text in a box: roots, coefficients, rows of a table; read as typed, written as read."""

from __future__ import annotations

from typing import Any


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
