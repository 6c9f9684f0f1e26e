"""Rows of a text table before their cells are numbers."""

import csv
from dataclasses import dataclass, field

from navcore.io.column_names import Column
from navcore.io.decimal_signs import Signs
from navcore.io.table_flags import TableFlag


def split_line(line: str, separator: str) -> list[str]:
    """Cells of one line; a space as separator stands for any white space."""
    if separator == " ":
        return line.split()
    try:
        return next(csv.reader([line], delimiter=separator), [])
    except csv.Error:
        return line.split(separator)


@dataclass
class Rows:
    """Remains of a table's text: the header, and the cells of the columns that are used."""

    header: list[str]
    columns: dict[str, Column]
    numbers: list[int] = field(default_factory=list)
    cells: dict[str, list[str]] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)
    sides: dict[int, list[str]] = field(default_factory=dict)
    """Cells of columns that may hold a hemisphere."""
    heeded: set[int] = field(default_factory=set)
    """Those that do."""
    numerals: Signs = Signs()
    """Decimal sign of the numbers, and the sign before groups of three digits."""
    signs: dict[str, float] = field(default_factory=dict)
    """Factors of the columns whose numbers a map turns around or scales."""
    skipped: list[int] = field(default_factory=list)
    """Numbers of the rows that a map lets be left out."""
    flags: dict[int, TableFlag] = field(default_factory=dict)
    """Columns that say how good others are, by their places."""
    others: list[Column] = field(default_factory=list)
    """Columns of quantities for which another column is taken."""
    parts: tuple[str, ...] = ()
    """Parts of the time that stand in columns of their own, in the order in which the cells are joined."""
    headers: int = 0
    """Rows that repeat the header, which are left out."""
    others_of_kind: int = 0
    """Rows of other sensors of one kind, which are left out."""
    layout: tuple[str, str] = "", ""
    """Separator and line of the header."""
