"""Rows of a recorded IMU's text table: pyarrow's CSV reader reads the numbers; what is no row is named."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.io.column_map import ColumnMap
from navcore.io.column_names import Column
from navcore.io.containers.base import refusing
from navcore.io.imu_columns import ImuColumn

if TYPE_CHECKING:
    import pyarrow

FIELD = "imu.file"
"""Field that faults name."""
HEAD_BYTES = 65536
"""A header stands within so many."""
COMMENTS = ("#", "%", "//")


class Header(NamedTuple):
    """Where the header stands, and what it says."""

    line: int
    separator: str
    names: list[str]


class Wanted(NamedTuple):
    """The column of time, the places of all of its parts, the six others, and the map that says so."""

    clock: Column
    clocks: list[int]
    columns: list[ImuColumn]
    increments: bool
    column_map: ColumnMap | None

    @property
    def places(self) -> list[int]:
        """Places of the six columns."""
        return [column.index for column in self.columns]

    @property
    def decimal(self) -> str:
        """Decimal point of the numbers."""
        return "." if self.column_map is None else self.column_map.decimal


def read_rows(
    content: bytes, header: Header, wanted: Wanted, source: str
) -> tuple[list[np.ndarray], np.ndarray, list[int]]:
    """Columns of time, the six others, shape (n, 6), and the numbers of the rows that were skipped."""
    begin = 0
    for _ in range(header.line + 1):
        begin = content.find(b"\n", begin) + 1 or len(content)
    raw = content[begin:]
    if raw.count(b"\n", 0, HEAD_BYTES) <= 2 and len(unix_text(raw).strip().splitlines()) < 2:
        raise InputError(Fault(source, FIELD, None, Text("holds fewer than two samples")))
    if header.separator == " ":
        raw = "\n".join(" ".join(line.split()) for line in unix_text(raw).split("\n")).encode()
    skipped: list[int] = []
    try:
        table = _parsed(raw, header, wanted, clock_text=False)
    except ValueError:
        first, body = header.line + 2, unix_text(raw)
        bad = _bad_rows(body, header, wanted)
        if bad and (wanted.column_map is None or not wanted.column_map.skip_bad_rows):
            what = Text(
                "data line {bad} is no row of {columns} numbers: {lines}",
                bad=bad[0] + first,
                columns=len(header.names),
                lines=body.split("\n")[bad[0]][:60],
            )
            raise InputError(Fault(source, FIELD, None, what)) from None
        left_out = set(bad)
        body = "\n".join(line for i, line in enumerate(body.split("\n")) if i not in left_out)
        skipped = [number + first for number in bad]
        with refusing(source, "CSV"):
            table = _parsed(body.encode(), header, wanted, clock_text=True)
    arrays = [np.asarray(column.to_numpy()) for column in table.columns]
    clocks = len(wanted.clocks)
    return arrays[:clocks], np.column_stack(arrays[clocks:]), skipped


def unix_text(content: bytes) -> str:
    """Text with the line ends of Unix."""
    return content.decode("utf-8", "replace").replace("\r\n", "\n")


def _parsed(body: bytes, header: Header, wanted: Wanted, *, clock_text: bool) -> pyarrow.Table:
    """Read by pyarrow; raises ValueError for a row that does not fit."""
    import pyarrow
    from pyarrow import csv

    def rest(row: csv.InvalidRow) -> Literal["skip", "error"]:
        return "skip" if row.text.lstrip().startswith(COMMENTS) else "error"

    number, text = pyarrow.float64(), pyarrow.string()
    types = {str(index): number for index in wanted.places}
    if clock_text or len(wanted.clocks) > 1:
        types |= {str(index): text for index in wanted.clocks}
    return csv.read_csv(
        pyarrow.BufferReader(body),
        read_options=csv.ReadOptions(
            column_names=[str(i) for i in range(len(header.names))], use_threads=False
        ),
        parse_options=csv.ParseOptions(delimiter=header.separator, invalid_row_handler=rest),
        convert_options=csv.ConvertOptions(
            include_columns=[str(index) for index in (*wanted.clocks, *wanted.places)],
            column_types=types,
            null_values=["nan", "NaN", "NAN"],
            timestamp_parsers=["\0"],
            decimal_point=wanted.decimal,
        ),
    )


def _is_number(cell: str) -> bool:
    """Whether pyarrow reads a cell as a number: it knows neither ``1_0`` nor digits of other scripts."""
    try:
        float(cell)
    except ValueError:
        return False
    return cell.isascii() and "_" not in cell


def _bad_rows(body: str, header: Header, wanted: Wanted) -> list[int]:
    """Numbers (from 0) of the lines that are no rows; only the first one where a row may not be skipped."""
    skip = wanted.column_map is not None and wanted.column_map.skip_bad_rows
    bad: list[int] = []
    for number, line in enumerate(body.split("\n")):
        if not line.strip() or line.lstrip().startswith(COMMENTS):
            continue
        words = line.split(None if header.separator == " " else header.separator)
        if len(words) == len(header.names) and all(
            _is_number(words[i].replace(wanted.decimal, ".")) for i in wanted.places
        ):
            continue
        bad.append(number)
        if not skip:
            break
    return bad
