"""Answers to what the bench is asked: one document for programs, and tables for people.

The text on a terminal, the HTML of a notebook and the tables of the page are made from the same tables.
"""

import math
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from navcore.foundation.latex import latex_table
from navcore.foundation.text import Text
from navcore.foundation.visible import visible

Cell = str | float | None
"""A text, or a number, which its column writes; None where there is none."""


@dataclass(frozen=True)
class Column:
    """One column of a table.

    Attributes
    ----------
    name : str
        Its heading.
    unit : str
        Of its numbers; empty for none.
    digits : int
        Significant digits of its numbers.
    left : bool
        Words that begin at the left; numbers end at the right, and so does a word among them.
    """

    name: str = ""
    unit: str = ""
    digits: int = 4
    left: bool = False


@dataclass(frozen=True)
class Table:
    """A table: its columns, and a cell for each of them in every row.

    Attributes
    ----------
    columns : tuple of Column
        The first is of names.
    rows : tuple of tuple of Cell
        The cells.
    title : str
        Line above it.
    """

    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]
    title: str = ""

    def lines(self) -> list[str]:
        """Lines for a terminal: headings, units where a column has one, then the rows."""
        title = [self.title] if self.title else []
        left = {place for place, column in enumerate(self.columns) if column.left}
        return [*title, *columns([*self._heads(), *self._cells()], left=left)]

    def html(self) -> Text:
        """HTML of the table; its classes are those of the page's tables."""
        heads = [_row(cells, "th") for cells in self._heads()]
        body = [_row(cells, "td") for cells in self._cells()]
        title = Text("<p>{title:html}</p>", title=self.title) if self.title else ""
        return Text(
            '{title}<table class="sb-t"><thead>{head}</thead><tbody>{body}</tbody></table>',
            title=title,
            head=Text.joined("", heads),
            body=Text.joined("", body),
        )

    def latex(self) -> str:
        """LaTeX of the table, a ``tabular`` with the rules of booktabs."""
        left = [place == 0 or column.left for place, column in enumerate(self.columns)]
        return latex_table(self.title, [*self._heads()], [*self._cells()], left)

    def _heads(self) -> Iterator[list[str]]:
        if any(column.name for column in self.columns):
            yield [column.name for column in self.columns]
        if any(column.unit for column in self.columns):
            yield [column.unit for column in self.columns]

    def _cells(self) -> Iterator[list[str]]:
        for row in self.rows:
            yield [
                cell if isinstance(cell, str) else number(cell, column.digits)
                for cell, column in zip(row, self.columns, strict=True)
            ]


class Answer:
    """Base of what a question is answered with.

    Attributes
    ----------
    assumed_zero : tuple of str
        Fields of the scenario that it states in no way, and that count as 0.
    """

    assumed_zero: tuple[str, ...] = ()

    @property
    def complete(self) -> bool:
        """Whether the work came to its end; else it was stopped, and this is what was found by then."""
        return not getattr(self, "stopped", False)

    @property
    def failed(self) -> bool:
        """Whether it has no numbers where it was asked for some, as where a method diverges."""
        return False

    @property
    def so_far(self) -> str:
        """What it is when it was stopped, as the end of a sentence."""
        return Text("this is what was found so far")

    def complaints(self) -> Iterable[str]:
        """Give what went wrong in parts of it, for stderr."""
        return ()

    def document(self) -> dict[str, Any]:
        """Return what ``--json`` prints."""
        raise NotImplementedError

    def rows(self) -> Iterable[Table | str]:
        """Give tables and sentences in the order in which they are read."""
        raise NotImplementedError

    def plays(self) -> tuple[str, ...]:
        """Name what a scenario of the answer's own can show; nothing where there is no such scenario."""
        return ()

    def played(self, place: int) -> dict[str, str]:
        """Return the files that show one of `plays`: text by name, the scenario last."""
        raise NotImplementedError

    def assumptions(self) -> Iterator[str]:
        """Give a sentence on what was assumed; none where nothing was."""
        return assumptions(self.assumed_zero)

    def lines(self) -> list[str]:
        """Lines for a terminal; an empty one stands above each table."""
        lines: list[str] = []
        for part in self.rows():
            if isinstance(part, Table):
                lines += [*([""] if lines else []), *part.lines()]
            else:
                lines.append(part)
        return [*lines, *self.assumptions()]

    def html(self) -> Text:
        """HTML of the tables and sentences."""
        parts = [part.html() if isinstance(part, Table) else _sentence(part) for part in self.rows() if part]
        return Text.joined("", [*parts, *map(_sentence, self.assumptions())])

    def latex(self) -> str:
        """LaTeX of the tables, each a ``tabular`` with the rules of booktabs; without the sentences."""
        return "\n".join(part.latex() for part in self.rows() if isinstance(part, Table))

    def _repr_html_(self) -> str:
        """Tables for a notebook."""
        return str(self.html())


def assumptions(fields: Sequence[str]) -> Iterator[str]:
    """Give a sentence on the fields of a scenario that count as 0; none where there are none."""
    if fields:
        yield Text("note: 0 is assumed for {fields}", fields=", ".join(fields))


def _sentence(text: str) -> Text:
    return Text("<p>{text:html}</p>", text=text)


def _row(cells: Sequence[str], tag: str) -> Text:
    first, rest = f"<{tag}>{{cell:html}}</{tag}>", f'<{tag} class="sb-n">{{cell:html}}</{tag}>'
    made = [Text(rest if place else first, cell=cell) for place, cell in enumerate(cells)]
    return Text("<tr>{cells}</tr>", cells=Text.joined("", made))


def columns(rows: Sequence[Sequence[str]], gap: str = "  ", left: Collection[int] = ()) -> list[str]:
    """Lay rows of equal length out in columns: the first and those that are named left, the others right.

    Examples
    --------
    >>> columns([["method", "m/s"], ["free", "1.25"]])
    ['method   m/s', 'free    1.25']
    """
    rows = [[visible(cell) for cell in row] for row in rows]
    widths = [max(len(cell) for cell in column) for column in zip(*rows, strict=True)]
    lines = []
    for row in rows:
        cells = [
            cell.ljust(width) if place == 0 or place in left else cell.rjust(width)
            for place, (cell, width) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append(gap.join(cells).rstrip())
    return lines


def number(value: float | None, digits: int = 4) -> str:
    """Write a number with so many significant digits; a dash where there is none.

    Examples
    --------
    >>> number(0.72691), number(12345.6), number(None), number(1.2e-7)
    ('0.7269', '12346', '-', '1.2e-07')
    """
    if value is None or not math.isfinite(value):
        return "-"
    if abs(value) >= 10.0**digits:
        return f"{value:.0f}" if abs(value) < 1e9 else f"{value:.{digits - 1}e}"
    return f"{value:.{digits}g}"
