"""Commas and points of the numbers of a table: which one is the decimal sign, and whether the other groups.

One answer holds for the whole table. Where commas and points both stand in it, one of them must stand before
groups of three digits everywhere; else the table is refused by the name of a column.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from typing import NamedTuple

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text

_LOOKED_AT = 1000
"""Cells at the beginning of a column, and at its end: counts grow, and have groups only later on."""
_PLAIN = re.compile(r"[-+]?(?:\d{1,40}[.,]\d{0,40}|[.,]\d{1,40})(?:[eE][-+]?\d{1,3})?")
"""Numbers with one sign; a date such as 17.05.2024 is none."""
_COMMA = re.compile(r"[-+]?\d*,\d+(?:[eE][-+]?\d+)?")
_GROUPED = {
    sign: re.compile(rf"[-+]?[1-9]\d{{0,2}}(?:{re.escape(sign)}\d{{3}})+(?:{re.escape(other)}\d{{0,30}})?")
    for sign, other in ((",", "."), (".", ","))
}
"""Numbers whose digits a sign parts into groups of three, by that sign."""
_SPACED = re.compile("[-+]?\\d{1,3}(?:[\u00a0\u2007\u2009\u202f'’]\\d{3})+(?:[.,]\\d{0,40})?")
"""Numbers whose groups no-break or thin spaces or apostrophes part, which no decimal sign is taken for."""
_SPACES = str.maketrans(dict.fromkeys("\u00a0\u2007\u2009\u202f'’", ""))


class Signs(NamedTuple):
    """Decimal sign of a table, and the sign before groups of three digits; empty where none is used."""

    decimal: str = "."
    groups: str = ""

    def told(self) -> str:
        """What is assumed, for people; empty for plain numbers."""
        if self.groups == ",":
            return Text("numbers have commas before groups of three digits")
        if self.groups:
            return Text("numbers have decimal commas, and points before groups of three digits")
        return Text("numbers have decimal commas") if self.decimal == "," else ""

    def pointed(self, cells: Sequence[str]) -> Sequence[str]:
        """Cells with decimal points and without groups; what is no number stays as it is."""
        if self == Signs():
            return cells
        sign = self.groups or ","
        return [self._plain(cell) if sign in cell or "," in cell else cell for cell in cells]

    def _plain(self, cell: str) -> str:
        bare = _unspaced(cell)
        if self.groups and _GROUPED[self.groups].fullmatch(bare):
            bare = bare.replace(self.groups, "")
        return bare.replace(",", ".") if self.decimal == "," and _COMMA.fullmatch(bare) else bare


def signs_of(where: str, columns: Mapping[str, Sequence[str]], rows: Sequence[int]) -> Signs:
    """Signs of the numbers of a table.

    Parameters
    ----------
    where : str
        File name, for faults.
    columns : dict
        Cells by the names of their columns.
    rows : sequence of int
        Row numbers, for faults.

    Raises
    ------
    InputError
        Commas and points stand in the numbers, and neither stands before groups of three everywhere.
    """
    looked = {
        name: {at: _unspaced(cells[at]) for at in _looked_at(len(cells))} for name, cells in columns.items()
    }
    if not any("," in cell or cell.count(".") > 1 for held in looked.values() for cell in held.values()):
        return Signs()
    commas, points = (
        _Cells(
            {
                name: found
                for name, held in looked.items()
                if (found := {at: cell for at, cell in held.items() if sign in cell and _is_number(cell)})
            }
        )
        for sign in ",."
    )
    if not commas.by_column:
        return Signs(",", ".") if points.several(".") and points.grouped(".") else Signs()
    if not points.by_column:
        return Signs(".", ",") if commas.grouped(",") and commas.surely(",", columns) else Signs(",")
    if commas.grouped(","):
        return Signs(".", ",")
    if points.grouped(".") and points.surely(".", columns):
        return Signs(",", ".")
    raise InputError(_mixed(where, commas, points, rows))


def decimal_of(columns: Mapping[str, Sequence[str]]) -> str:
    """Decimal sign of a few rows of a table; a comma where commas and points do not go together."""
    try:
        return signs_of("", columns, range(max(map(len, columns.values()), default=0))).decimal
    except InputError:
        return ","


def signs_of_map(decimal: str, stated: bool, columns: Mapping[str, Sequence[str]]) -> Signs:
    """Signs of a table whose map gives the decimal sign, or has the usual one because it states none."""
    try:
        found = signs_of("", columns, range(max(map(len, columns.values()), default=0)))
    except InputError:
        found = Signs()
    return found if found.decimal == decimal else Signs(decimal, "," if stated and decimal == "." else "")


class _Cells(NamedTuple):
    """Numbers that hold a sign, by their columns and places."""

    by_column: dict[str, dict[int, str]]

    @property
    def all(self) -> list[str]:
        return [cell for held in self.by_column.values() for cell in held.values()]

    def grouped(self, sign: str) -> bool:
        """Whether the sign stands before groups of three digits in each."""
        return all(_GROUPED[sign].fullmatch(cell) for cell in self.all)

    def several(self, sign: str) -> bool:
        """Whether one of them holds the sign more than once, as no decimal sign does."""
        return any(cell.count(sign) > 1 for cell in self.all)

    def surely(self, sign: str, columns: Mapping[str, Sequence[str]]) -> bool:
        """Whether the sign of numbers such as ``1,000`` groups.

        One has it twice, or the other sign behind it; or others of its column have none: decimals of a fixed
        number would all have one, and decimals as short as may be would not end with 0.
        """
        other = "." if sign == "," else ","
        if self.several(sign) or any(other in cell for cell in self.all):
            return True
        return any(
            any(cell.endswith("0") for cell in held.values())
            and any(
                at not in held and columns[name][at].strip().isdecimal()
                for at in _looked_at(len(columns[name]))
            )
            for name, held in self.by_column.items()
        )

    def first(self) -> tuple[str, int, str]:
        """Column, place and text of the first."""
        name, held = next(iter(self.by_column.items()))
        return name, *next(iter(held.items()))


def _is_number(cell: str) -> bool:
    return any(form.fullmatch(cell) for form in (_PLAIN, *_GROUPED.values()))


def _unspaced(cell: str) -> str:
    bare = cell.strip()
    return bare.translate(_SPACES) if not bare.isdecimal() and _SPACED.fullmatch(bare) else bare


def _looked_at(size: int) -> Iterable[int]:
    return chain(range(min(_LOOKED_AT, size)), range(max(_LOOKED_AT, size - _LOOKED_AT), size))


def _mixed(where: str, commas: _Cells, points: _Cells, rows: Sequence[int]) -> Fault:
    name, at, cell = next(
        (name, at, cell)
        for name, held in commas.by_column.items()
        for at, cell in held.items()
        if not _GROUPED[","].fullmatch(cell)
    )
    other, beside, pointed = points.first()
    allowed = Text(
        "has a decimal comma, and {other} = {pointed} in row {row} a decimal point: write all numbers with "
        'one sign (decimal of a map, ",", reads both as decimal signs)',
        other=other,
        pointed=pointed,
        row=rows[beside],
    )
    return Fault(Text("{where}, row {rows}", where=where, rows=rows[at]), name, cell, allowed)
