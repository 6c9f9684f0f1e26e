"""Hemispheres in columns of their own: ``33.9, S`` beside each other, found by cells and names."""

import re
from collections.abc import Sequence

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.io.column_names import Column, plain_name
from navcore.io.written_units import unaccented

_WORDS_OF_SIDES = {
    ("lat", 1.0): "n north nord norte",
    ("lat", -1.0): "s south sud sued sur sul",
    ("lon", 1.0): "e east est este leste ost",
    ("lon", -1.0): "w west ouest oeste ovest",
}
_SIDES = {
    stem: {
        word: sign for (of, sign), words in _WORDS_OF_SIDES.items() if of == stem for word in words.split()
    }
    for stem in ("lat", "lon")
}
_EITHER = "o"
"""East in German (Ost), west in French, Spanish and Italian (Ouest, Oeste, Ovest)."""
_STEMS = {"lat": "lat|latitude", "lon": "lon|long|lng|longitude"}
_WORDS = "dir|direction|hem|hemi|hemisphere|side|sign|ref|ns|ew|n_s|e_w|indicator"
_NAMED = {
    "lat": re.compile(rf"\w{{0,20}}?(?:{_STEMS['lat']})_?(?:{_WORDS})"),
    "lon": re.compile(rf"\w{{0,20}}?(?:{_STEMS['lon']})_?(?:{_WORDS})"),
}


_MAY_BE = {
    "lat": frozenset(("ns", "n_s", "ns_indicator")),
    "lon": frozenset(("ew", "e_w", "ew_indicator", "ow", "o_w", "eo", "e_o")),
}
"""Names that the cells must confirm: ``ns`` is also a number of satellites."""


def is_named(name: str, stem: str) -> bool:
    """Whether a name says that the column holds the hemisphere of ``lat`` or ``lon``."""
    return _NAMED[stem].fullmatch(plain_name(name)) is not None


def candidates(names: Sequence[str], columns: dict[str, Column]) -> dict[str, list[int]]:
    """Columns that may hold the hemisphere of latitude and longitude: so named first, then the next one."""
    used = {column.index for column in columns.values()}
    found: dict[str, list[int]] = {}
    for stem in (stem for stem in _SIDES if stem in columns):
        named = [
            i
            for i, name in enumerate(names)
            if i not in used and (is_named(name, stem) or plain_name(name) in _MAY_BE[stem])
        ]
        after = columns[stem].index + 1
        beside = [after] if after < len(names) and after not in used and after not in named else []
        found[stem] = named + beside
    return found


def signed(
    where: str,
    stem: str,
    values: np.ndarray,
    sides: Sequence[tuple[str, Sequence[str]]],
    rows: Sequence[int],
) -> tuple[np.ndarray, np.ndarray, str]:
    """Values with the sign of their hemisphere, which of them have none, and the column's name.

    Parameters
    ----------
    where : str
        File name, for faults.
    stem : str
        ``lat`` or ``lon``.
    values : ndarray, shape (n,)
        Unsigned, or with the same sign.
    sides : sequence of (str, sequence of str)
        Name and cells of the candidates.
    rows : sequence of int
        Row numbers, for faults.

    Returns
    -------
    signed : ndarray, shape (n,)
    absent : ndarray of bool, shape (n,)
    name : str
        Empty when no candidate is a column of hemispheres.

    Raises
    ------
    InputError
        A column is named a hemisphere and holds something else, or a value has the other sign; an O that may
        be east or west.
    """
    for name, cells in sides:
        lowered = [unaccented(cell.strip().lower()) for cell in cells]
        known = _SIDES[stem] | _meaning_of_o(stem, name, lowered)
        strange = next((i for i, cell in enumerate(lowered) if cell and cell not in known), None)
        if strange is not None and stem == "lon" and set(lowered) <= {*known, _EITHER, ""}:
            at = Text("{where}, row {rows}", where=where, rows=rows[strange])
            allowed = Text("may mean east (Ost) or west (Ouest, Oeste, Ovest): write E or W")
            raise InputError(Fault(at, name, cells[strange], allowed))
        if strange is not None and is_named(name, stem):
            at = Text("{where}, row {rows}", where=where, rows=rows[strange])
            allowed = Text(
                "must be {sides}: a hemisphere", sides=" or ".join(k.upper() for k in known if len(k) == 1)
            )
            raise InputError(Fault(at, name, cells[strange], allowed))
        if strange is not None or not any(lowered):
            continue
        sign = np.array([known.get(cell, 0.0) for cell in lowered])
        against = np.flatnonzero((values < 0.0) & (sign > 0.0))
        if against.size:
            at = Text("{where}, row {rows}", where=where, rows=rows[against[0]])
            allowed = Text("contradicts the negative number beside it")
            raise InputError(Fault(at, name, cells[against[0]], allowed))
        return np.abs(values) * sign, sign == 0.0, name
    return values, np.zeros(values.size, dtype=bool), ""


def _meaning_of_o(stem: str, name: str, cells: Sequence[str]) -> dict[str, float]:
    """Which side an O is, by the letter beside it in the name or the cells; empty if none does."""
    if stem != "lon":
        return {}
    words = plain_name(name).split("_")
    beside = {*words, *cells, *(letter for word in words if word in ("ow", "eo") for letter in word)}
    if {"e", "w"} <= beside:
        return {}
    return {_EITHER: 1.0} if "w" in beside else {_EITHER: -1.0} if "e" in beside else {}
