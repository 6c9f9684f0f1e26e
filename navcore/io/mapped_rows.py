"""Rows of a table that a map describes: its header, and the rows that cannot be read."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from navcore.foundation.text import Text
from navcore.io.cells import is_empty, is_number, is_time
from navcore.io.column_names import UTC
from navcore.io.mapped_times import MappedClock
from navcore.io.rows import split_line

if TYPE_CHECKING:
    from navcore.io.column_map import ColumnMap
    from navcore.io.rows import Rows

_COMMENTS = "#%/ "
_SEPARATORS = ",;\t| "
_MOST_NAMED = 5


def mapped_layout(head: Sequence[str], column_map: ColumnMap) -> tuple[str, str, list[str]]:
    """Separator, header line and header cells: the line that holds most of the columns that the map names."""
    wanted = {name.strip() for name in column_map.names}
    best: tuple[int, str, str, list[str]] = (-1, ",", "", [])
    for line in head:
        for separator in column_map.delimiter or _SEPARATORS:
            cells = split_line(line.lstrip(_COMMENTS), separator)
            count = len(wanted & {cell.strip() for cell in cells})
            if (count, len(cells)) > (best[0], len(best[3])):
                best = count, separator, line, cells
        if best[0] == len(wanted):
            break
    return best[1:]


def skip_bad(rows: Rows, column_map: ColumnMap) -> None:
    """Leave out, in place, the rows with a time or number that cannot be read; say how many and which."""
    clock = MappedClock(column_map.time) if column_map.time.stated else None
    bad: set[int] = set()
    for stem, given in rows.cells.items():
        cells = rows.numerals.pointed(given)
        if stem == UTC:
            bad |= {i for i, cell in enumerate(cells) if not _is_time(clock, cell)}
            continue
        bad |= {i for i, cell in enumerate(cells) if not is_empty(cell) and not is_number(cell)}
    skipped = sorted([*rows.skipped, *(rows.numbers[i] for i in bad)])
    for cells in (*rows.cells.values(), *rows.sides.values()):
        cells[:] = [cell for i, cell in enumerate(cells) if i not in bad]
    rows.numbers[:] = [number for i, number in enumerate(rows.numbers) if i not in bad]
    rows.skipped[:] = skipped
    if skipped:
        rows.warnings.append(skipped_text(skipped))


def skipped_text(rows: Sequence[int]) -> str:
    """Say which rows were left out, the first of many."""
    named = ", ".join(str(row) for row in rows[:_MOST_NAMED]) + (", ..." if len(rows) > _MOST_NAMED else "")
    return Text.plural(
        "{count} row that cannot be read skipped: {named}",
        "{count} rows that cannot be read skipped: {named}",
        count=len(rows),
        named=named,
    )


def _is_time(clock: MappedClock | None, cell: str) -> bool:
    if is_empty(cell):
        return True
    if clock is None:
        return is_time(cell)
    try:
        clock.seconds(cell)
    except (ValueError, OverflowError):
        return False
    return True
