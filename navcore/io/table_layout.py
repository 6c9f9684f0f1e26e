"""Where the header of a text table stands, what parts its cells, and which rows are numbers."""

import re

from navcore.io.cells import is_empty
from navcore.io.column_names import CLOCK, QUANTITIES, SECONDS, UNIX, UTC, known_columns
from navcore.io.columns import MOST_COLUMNS
from navcore.io.rows import split_line
from navcore.io.written_units import UNITS, written

COMMENTS = ("#", "%", "//")
_DECIMAL_COMMA = re.compile(r"(?<=\d),(?=\d)")
_SEPARATORS = ",;\t|"
_HEAD_BYTES = 65536
_HEAD_LINES = 60
"""A header stands within so many lines; before it may stand what a logger says about the cruise."""


def head_of_text(text: str) -> list[str]:
    """First lines that are not empty."""
    return [line for line in text[:_HEAD_BYTES].splitlines() if line.strip()][:_HEAD_LINES]


def _separator(line: str) -> str:
    if any(sign in line for sign in ";\t|"):
        line = _DECIMAL_COMMA.sub("", line)
    best = max(_SEPARATORS, key=line.count)
    return best if line.count(best) else " "


def layout_of(head: list[str]) -> tuple[str, str, list[str]]:
    """Separator, header line and header cells.

    The header is the first line that names a time and a quantity, be it a comment; else the line before the
    first row of numbers, as long as the row; else the first line that is no comment.
    """
    plain = next((line for line in head if not line.startswith(COMMENTS)), "")
    for line in head:
        bare = line.lstrip("#%/ ") if line.startswith(COMMENTS) else line
        separator = _separator(bare)
        cells = split_line(bare, separator)
        known = known_columns(cells[:MOST_COLUMNS])
        if known.keys() & QUANTITIES.keys() and {UTC, UNIX, SECONDS, CLOCK} & known.keys():
            return separator, line, cells
    above = _above_the_rows(head)
    if above is not None:
        return above
    return _separator(plain), plain, split_line(plain, _separator(plain))


def _above_the_rows(head: list[str]) -> tuple[str, str, list[str]] | None:
    """Separator, line and cells of the line before the first row; None where there is none.

    Of two lines that may be it, the lower one gives the units of the upper one.
    """
    for at, line in enumerate(head):
        separator = _separator(line)
        cells = split_line(line, separator)
        below = [split_line(one, separator) for one in head[at + 1 : at + 2]]
        alone = any(len(one) != len(cells) or not is_row(one, separator) for one in below)
        if line.startswith(COMMENTS) or alone or not is_row(cells, separator):
            continue
        found: list[tuple[str, str, list[str]]] = []
        for above in reversed(head[max(0, at - 2) : at]):
            names = split_line(above.lstrip("#%/ "), separator)
            if len(names) != len(cells) or is_row(names, separator):
                break
            found.append((separator, above, names))
        units = (
            len(found) > 1
            and is_units(found[0][2])
            and not known_columns(found[0][2]).keys() & QUANTITIES.keys()
        )
        return found[1] if units else found[0] if found else None
    return None


def is_row(cells: list[str], separator: str) -> bool:
    """Whether at least half of two cells or more are numbers."""
    given = [cell if separator == "," else cell.replace(",", ".") for cell in cells if cell.strip()]
    return len(cells) > 1 and 2 * sum(map(_is_number, given)) >= max(len(given), 1) and bool(given)


def layout(text: str) -> tuple[str, str, list[str]]:
    """Separator, header line and header cells of a text."""
    return layout_of(head_of_text(text))


def holds_number(row: list[str], separator: str) -> bool:
    """Whether a cell is a number, also with a decimal comma."""
    return any(_is_number(cell if separator == "," else cell.replace(",", ".")) for cell in row)


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def is_units(row: list[str]) -> bool:
    """Whether a row below the header gives units: none of its cells is a number, and most are units.

    A quantity without a unit, and the time, may have an empty cell.
    """
    given = [cell.strip() for cell in row if not is_empty(cell)]
    if not given or any(cell[:1] in "+-.0123456789" or _is_number(cell) for cell in given):
        return False
    units = [cell for cell in given if any(written([cell.strip("()[] ")], d).unit for d in UNITS)]
    return bool(units) and (len(given) == len(row) or 2 * len(units) > len(given))
