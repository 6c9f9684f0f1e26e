"""Rows of a text table before their cells are numbers."""

from dataclasses import dataclass, field

from navcore.io.column_names import Column


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
    decimal: str = "."
    signs: dict[str, float] = field(default_factory=dict)
    """-1 for the columns whose numbers a map turns around."""
    skipped: list[int] = field(default_factory=list)
    """Numbers of the rows that a map lets be left out."""
