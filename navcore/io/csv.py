"""Text tables: comma, semicolon, tab, bar or spaces; a header line; columns known by name.

The standard library's reader and numpy are enough, name the row of a bad cell, and start faster than pandas.
"""

import csv
import io
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.io.cells import numbers
from navcore.io.choices import column_choice
from navcore.io.column_map import ColumnMap
from navcore.io.column_names import (
    QUANTITIES,
    UTC,
    Column,
    has_clock,
    known_columns,
    other_columns,
    plain_name,
    week_columns,
)
from navcore.io.columns import (
    MOST_CELLS,
    MOST_COLUMNS,
    column_warnings,
    limited,
    pair_faults,
    require_columns,
    table_recording,
)
from navcore.io.csv_times import timed, times_of_rows
from navcore.io.decimal_signs import signs_of, signs_of_map
from navcore.io.dialects import dialect_words, instance_place, instance_words
from navcore.io.formats import Candidate
from navcore.io.hemispheres import candidates, signed
from navcore.io.known_files import known_text
from navcore.io.mapped_rows import mapped_layout, skip_bad
from navcore.io.rows import Rows, split_line
from navcore.io.series import LeftOut, Recording
from navcore.io.source import FileText, read_text
from navcore.io.table_flags import flag_columns, heed
from navcore.io.table_layout import COMMENTS, head_of_text, holds_number, is_row, is_units, layout_of
from navcore.io.table_times import Table
from navcore.io.times.parts import part_columns, stamp_columns
from navcore.io.written_units import without_brackets


def recognises(candidate: Candidate) -> bool:
    """Whether a header names a known column, or the lines look like a table of numbers."""
    if known_text(candidate.text) is not None:
        return False
    head = head_of_text(candidate.text)
    separator, header_line, header = layout_of(head)
    if known_columns(header[:MOST_COLUMNS]):
        return True
    rows = head[head.index(header_line) + 1 :] if header_line in head else []
    following = [split_line(line, separator) for line in rows if not line.startswith(COMMENTS)][:5]
    alike = [row for row in following if len(row) == len(header) and holds_number(row, separator)]
    return len(header) > 1 and len(alike) >= max(1, len(following) - 1)


def read(path: Path, column_map: ColumnMap | None = None) -> Recording:
    """Read one table, by a map or by the names of its columns.

    Raises
    ------
    InputError
        Missing columns (names those found), rows of another length, cells that are no finite number in range,
        time out of order, or more cells than are read.
    """
    content, rows, table = laid_out(path, column_map)
    others = ["" if index in rows.heeded else name for index, name in enumerate(rows.header)]
    unused = column_warnings(others, rows.columns)
    told = dialect_words(rows.header) if column_map is None else []
    warnings = (*content.warnings(), *told, *rows.warnings, *unused, *table.warnings)
    return table_recording(replace(table, warnings=warnings))


def laid_out(path: Path, column_map: ColumnMap | None = None) -> tuple[FileText, Rows, Table]:
    """Text of a table, its rows as they are written, and its numbers; raises as `read` does."""
    content = read_text(path)
    rows = _rows(path.name, content.text, column_map)
    if column_map is not None and column_map.skip_bad_rows:
        skip_bad(rows, column_map)
    if not rows.numbers:
        raise InputError(Fault(path.name, "", None, Text("a header but no rows")))
    table = _table(path.name, rows, column_map, lambda: _row_ids(path.name, content.text, rows))
    return content, rows, table


def _rows(where: str, text: str, column_map: ColumnMap | None) -> Rows:
    named: list[str] = []
    if column_map is None:
        separator, header_line, header = layout_of(head_of_text(text))
        if is_row(header, separator) and not known_columns(header[:MOST_COLUMNS]):
            allowed = Text(
                "has no line with the names of the columns above its rows (the first one is {first}): put "
                "one there, "
                "such as utc,lat_deg,lon_deg,heading_deg",
                first=header_line[:80],
            )
            raise InputError(Fault(where, "", None, allowed))
        clock, parts = week_columns(header), dict[str, int]()
        if not clock:
            plain = [plain_name(without_brackets(name)[0]) for name in header[:MOST_COLUMNS]]
            parts = stamp_columns(plain) if has_clock(header[:MOST_COLUMNS]) else part_columns(plain)
            clock = list(parts.values())
        named = [UTC if clock[:1] == [index] else name for index, name in enumerate(header)]
        rows = Rows(header, require_columns(where, named))
        rows.heeded |= set(clock)
        rows.parts = tuple(parts)
    else:
        separator, header_line, header = mapped_layout(head_of_text(text), column_map)
        found = column_map.log_columns(where, header)
        clock = column_map.clocks(where, header)
        rows = Rows(header, {stem: column for stem, (column, _) in found.items()})
        rows.columns[UTC] = Column(clock[0], column_map.time.columns[0], UTC)
        rows.signs = {stem: sign for stem, (_, sign) in found.items() if sign != 1.0}
        if pairs := pair_faults(where, rows.columns):
            raise InputError(pairs)
    rows.layout = separator, header_line
    _refuse_size(where, text, len(rows.columns))
    width, faults = len(header), []
    columns = list(rows.columns.values())
    beside = {index for found in candidates(header, rows.columns).values() for index in found}
    if column_map is None:
        rows.flags, rows.others = flag_columns(header), other_columns(header, rows.columns)
        beside |= rows.flags.keys() | {column.index for column in rows.others}
    instance = instance_place(header) if column_map is None else None
    first = ""
    for number, row in _after_header(where, text, separator, header_line):
        row = _fitted(row, width, separator, rows.columns)
        if row[0] == header[0] and row == header:
            rows.headers += 1
            continue
        if instance is not None and len(row) == width:
            first = first or row[instance].strip()
            if row[instance].strip() != first:
                rows.others_of_kind += 1
                continue
        if len(row) != width and column_map is not None and column_map.skip_bad_rows:
            rows.skipped.append(number)
            continue
        if len(row) != width:
            allowed = Text("has {row} cells, the header {width}", row=len(row), width=width)
            faults.append(Fault(Text("{where}, row {number}", where=where, number=number), "", None, allowed))
            continue
        if not rows.numbers and column_map is None and is_units(row):
            rows.columns = require_columns(where, [f"{n} ({u})" for n, u in zip(named, row, strict=True)])
            columns = list(rows.columns.values())
            continue
        rows.numbers.append(number)
        for column in columns:
            rows.cells.setdefault(column.stem, []).append(row[column.index])
        if len(clock) > 1:
            rows.cells[UTC][-1] = " ".join(row[index].strip() for index in clock)
        for index in beside:
            rows.sides.setdefault(index, []).append(row[index])
    if rows.others_of_kind:
        rows.warnings.append(instance_words(rows.others_of_kind, first))
    if rows.headers:
        rows.warnings.append(
            Text.plural(
                "the header stands in {count} row more: files one behind the other? Left out",
                "the header stands in {count} rows more: files one behind the other? Left out",
                count=rows.headers,
            )
        )
    _tell_numerals(where, rows, column_map)
    if len(faults) == 1 and rows.numbers and "cells" in faults[0].allowed and _is_last(text, faults[0]):
        rows.warnings.append(Text("the last row is cut off: left out"))
        faults = []
    if faults:
        raise InputError(limited(where, faults))
    return rows


def _tell_numerals(where: str, rows: Rows, column_map: ColumnMap | None) -> None:
    """Tell the decimal sign of the numbers, by all columns that are used; raises `InputError`."""
    cells = {rows.columns[stem].name: column for stem, column in rows.cells.items()}
    if column_map is not None:
        stated = "decimal" in column_map.model_fields_set
        rows.numerals = signs_of_map(column_map.decimal, stated, cells)
        return
    rows.numerals = signs_of(where, cells, rows.numbers)
    if told := rows.numerals.told():
        rows.warnings.append(told)


def _refuse_size(where: str, text: str, columns: int) -> None:
    lines = text.count("\n") + 1
    if lines * columns > MOST_CELLS:
        allowed = Text(
            "has {lines} rows of {columns} columns that are used; at most {most_cells} cells are read",
            lines=lines,
            columns=columns,
            most_cells=MOST_CELLS,
        )
        raise InputError(Fault(where, "", None, allowed))


def _after_header(where: str, text: str, separator: str, header: str) -> Iterator[tuple[int, list[str]]]:
    """Rows below the header with their line numbers; empty lines and comments are left out."""
    begun = False
    if separator == " ":
        for number, line in enumerate(text.split("\n"), start=1):
            if begun and line.strip() and not line.startswith(COMMENTS):
                yield number, line.split()
            begun = begun or line == header
        return
    stream = io.StringIO(text, newline="")
    skipped = 0
    for line in stream:
        skipped += 1
        if line.rstrip("\n") == header:
            break
    reader = csv.reader(stream, delimiter=separator, strict=True)
    try:
        for row in reader:
            if any(cell.strip() for cell in row) and not row[0].startswith(COMMENTS):
                yield skipped + reader.line_num, row
    except csv.Error as problem:
        where = Text("{where}, row {skipped}", where=where, skipped=skipped + reader.line_num)
        raise InputError(Fault(where, "", None, Text("not a CSV row ({problem})", problem=problem))) from None


def _fitted(row: list[str], width: int, separator: str, columns: dict[str, Column]) -> list[str]:
    """A row without empty cells too many; a date and a time parted by the separator are joined."""
    if len(row) > width and not any(cell.strip() for cell in row[width:]):
        return row[:width]
    if separator == " " and len(row) == width + 1 and UTC in columns:
        at = columns[UTC].index
        return [*row[:at], Text("{row} {row2}", row=row[at], row2=row[at + 1]), *row[at + 2 :]]
    return row


def _is_last(text: str, fault: Fault) -> bool:
    return fault.where.endswith(f"row {len(text.rstrip().split(chr(10)))}")


def _row_ids(where: str, text: str, rows: Rows) -> dict[int, int]:
    """Numbers of the rows by that of their line: equal for rows that are equal in every cell."""
    seen: dict[tuple[str, ...], int] = {}
    lines = _after_header(where, text, *rows.layout)
    return {number: seen.setdefault(tuple(row), len(seen)) for number, row in lines}


def _table(where: str, rows: Rows, column_map: ColumnMap | None, ids: Callable[[], dict[int, int]]) -> Table:
    faults: list[Fault] = []
    values: dict[str, np.ndarray] = {}
    missing: dict[str, np.ndarray] = {}
    kept, untimed = timed(rows)
    timing = None
    try:
        timing = times_of_rows(where, rows, kept, column_map)
    except InputError as error:
        faults += error.faults
    numbered = [rows.numbers[i] for i in kept] if untimed else rows.numbers
    for stem in (stem for stem in QUANTITIES if stem in rows.columns):
        cells = [rows.cells[stem][i] for i in kept] if untimed else rows.cells[stem]
        cells = rows.numerals.pointed(cells)
        try:
            values[stem], empty = numbers(where, rows.columns[stem].name.lower(), cells, numbered)
        except InputError as error:
            faults += error.faults
            continue
        values[stem] = values[stem] * rows.signs.get(stem, 1.0)
        if empty.any():
            missing[stem] = empty
    hemispheres = _hemispheres(where, rows, kept, numbered, values, missing)
    hemispheres += _heed_flags(rows, kept, values, missing)
    told, differing = _choices(where, rows, kept, numbered, values)
    if faults or timing is None:
        raise InputError(faults)
    time_s, dated, clock = timing
    notes = (
        [
            Text.plural(
                "{count} row without a time left out", "{count} rows without a time left out", count=untimed
            )
        ]
        if untimed
        else []
    )
    return Table(
        where,
        Text("CSV table"),
        rows.columns,
        time_s,
        dated,
        clock,
        values,
        missing,
        numbered,
        (*notes, *hemispheres, *differing),
        tuple(
            LeftOut("rows", "", why, count)
            for why, count in (
                (Text("without a time"), untimed),
                (Text("cannot be read"), len(rows.skipped)),
                (Text("of another sensor of this kind"), rows.others_of_kind),
                (Text("repeats the header"), rows.headers),
            )
            if count
        ),
        lambda: (lambda found: np.array([found[number] for number in numbered]))(ids()),
        tuple(told),
        column_map is not None,
    )


def _heed_flags(
    rows: Rows, kept: list[int], values: dict[str, np.ndarray], missing: dict[str, np.ndarray]
) -> list[str]:
    """Take readings that a column of flags calls invalid as missing; say how many."""
    words: list[str] = []
    for index, flag in rows.flags.items():
        stems = [stem for stem in flag.stems if stem in values]
        found = heed(flag, rows.header[index].strip(), [rows.sides[index][i] for i in kept], stems)
        if found is None:
            continue
        invalid, told = found
        rows.heeded.add(index)
        words += told
        for stem in stems if invalid.any() else ():
            missing[stem] = missing.get(stem, np.zeros(invalid.size, bool)) | invalid
    return words


def _choices(
    where: str, rows: Rows, kept: list[int], numbered: list[int], values: dict[str, np.ndarray]
) -> tuple[list[str], list[str]]:
    """Say of several columns for one quantity which is taken, and by how much the others differ."""
    told: list[str] = []
    differing: list[str] = []
    for column in rows.others:
        taken = rows.columns[column.stem]
        cells = rows.numerals.pointed([rows.sides[column.index][i] for i in kept])
        try:
            found, empty = numbers(where, column.name, cells, numbered)
        except InputError:
            continue
        if column.stem not in values or empty.all():
            continue
        off = found * column.factor - values[column.stem] * taken.factor
        text, plainly = column_choice(column.stem, taken.name, column.name, off[~empty])
        told.append(text)
        differing += [text] if plainly else []
    return told, differing


def _hemispheres(
    where: str,
    rows: Rows,
    kept: list[int],
    numbered: list[int],
    values: dict[str, np.ndarray],
    missing: dict[str, np.ndarray],
) -> list[str]:
    """Give latitude and longitude the sign of a hemisphere in a column of its own; say from which."""
    words: list[str] = []
    for stem, found in candidates(rows.header, rows.columns).items():
        if stem not in values:
            continue
        sides = [(rows.header[index].strip(), [rows.sides[index][i] for i in kept]) for index in found]
        values[stem], absent, name = signed(where, stem, values[stem], sides, numbered)
        if not name:
            continue
        rows.heeded |= {index for index in found if rows.header[index].strip() == name}
        if absent.any():
            missing[stem] = missing.get(stem, np.zeros(absent.size, dtype=bool)) | absent
        told = Text("column {name} gives the sign of {column}", name=name, column=rows.columns[stem].name)
        words.append(told)
    return words
