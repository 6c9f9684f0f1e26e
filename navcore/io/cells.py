"""Cells of a text table to numbers and times; a fault for each that makes no sense."""

import math
import re
from collections.abc import Sequence
from datetime import UTC, datetime

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.numbers import NotANumber, read_number
from navcore.foundation.text import Text
from navcore.io.columns import limited
from navcore.io.stamps import StampReader, day_comes_first
from navcore.io.times.counts import Ambiguous, read_counts
from navcore.io.written_units import unaccented

_EMPTY = frozenset(("", "-", "--", "na", "n/a", "null", "none"))
_HEMISPHERE = re.compile(r"[\d.]{1,20}[ \d.'\"°:]{0,30} ?[NSEWnsew]")
_NUMBER = re.compile(r"\d{1,9}(?:\.\d{0,15})?")
_DAY = 86400.0
_SAYS_NOTHING = re.compile(
    r"(?<![^\W\d_])(?:(?:mon|tue|wed|thu|fri|sat|sun|mo|di|mi|do|fr|sa|so|lun|mar|mer|jeu|ven|sam|dim|mie|jue|"
    r"vie|sab|dom)[^\W\d_]{0,9}|utc|gmt|z|t|um|uhr|at|on|à|le)(?![^\W\d_])"
)
"""Words beside a time that do not change it: days of the week, and UTC, which is taken anyway."""
_UNREAD = re.compile(r"[a-z0-9]")
"""What is left of a cell holds none of these: a zone such as EDT shifts the time, a number may be a date."""


def is_empty(cell: str) -> bool:
    """Whether a cell stands for no reading."""
    return cell.strip().lower() in _EMPTY


def is_number(cell: str) -> bool:
    """Whether a cell is a number, or degrees with a hemisphere."""
    try:
        float(cell)
    except ValueError:
        return _degrees(cell.strip()) is not None
    return True


def is_time(cell: str) -> bool:
    """Whether a cell is a number or a time that `times` reads."""
    try:
        return math.isfinite(float(cell))
    except ValueError:
        return _moment(cell.strip(), StampReader()) is not None


def numbers(
    where: str, name: str, cells: Sequence[str], rows: Sequence[int]
) -> tuple[np.ndarray, np.ndarray]:
    """Numbers of a column and which cells are empty (0 there).

    Raises
    ------
    InputError
        A cell is neither empty nor a number nor degrees with a hemisphere; names row and column.
    """
    try:
        return np.array(cells, dtype=float), np.zeros(len(cells), dtype=bool)
    except ValueError:
        pass
    values, empty = np.zeros(len(cells)), np.zeros(len(cells), dtype=bool)
    faults: list[Fault] = []
    for index, cell in enumerate(cells):
        try:
            values[index] = float(cell)
        except ValueError:
            degrees = None
            if is_empty(cell):
                empty[index] = True
            elif (degrees := _degrees(cell.strip())) is not None:
                values[index] = degrees
            elif "," not in cell and (number := _typed(cell)) is not None:
                values[index] = number
            else:
                hint = Text(" (decimal comma? Say so by decimal of a map)") if "," in cell else ""
                allowed = Text("is not a number{hint}", hint=hint)
                faults.append(
                    Fault(Text("{where}, row {rows}", where=where, rows=rows[index]), name, cell, allowed)
                )
    if faults:
        raise InputError(limited(where, faults))
    return values, empty


def _typed(cell: str) -> float | None:
    """Number with another minus sign, spaces between its digits or quotes; None for others."""
    try:
        return read_number(cell)
    except NotANumber:
        return None


def _degrees(cell: str) -> float | None:
    """Degrees of ``59.2 N``, ``59 12.3' N``, ``5912.3N`` (degrees and minutes run together); else None."""
    if len(cell) > 40 or _HEMISPHERE.fullmatch(cell) is None:
        return None
    parts = [float(part) for part in _NUMBER.findall(cell)]
    if len(parts) == 1 and len(cell.split(".")[0].strip("NSEWnsew ")) >= 4:
        parts = [parts[0] // 100.0, parts[0] % 100.0]
    if not 1 <= len(parts) <= 3 or any(part >= 60.0 for part in parts[1:]):
        return None
    value = sum(part / 60.0**k for k, part in enumerate(parts))
    return -value if cell[-1] in "SWsw" else value


def times(where: str, name: str, cells: Sequence[str], rows: Sequence[int]) -> tuple[np.ndarray, bool]:
    """Times of a column, s, and whether they are dated (since 1970) or of the file's own zero.

    Taken are ISO 8601 (no zone means UTC), what `navcore.io.stamps` reads, Unix time in s or ms, and times of
    day alone, which are undated.

    Raises
    ------
    InputError
        A cell is none of these; names the row.
    """
    try:
        parsed = np.array(cells, dtype=float)
    except ValueError:
        return _written_times(where, name, cells, rows)
    try:
        found = read_counts(parsed)
    except Ambiguous as either:
        allowed = Text("may count {either}: give ISO 8601, or say time.unit by a map", either=str(either))
        raise InputError(Fault(where, name, cells[0], allowed)) from None
    return found.time_s, found.dated


def _written_times(
    where: str, name: str, cells: Sequence[str], rows: Sequence[int]
) -> tuple[np.ndarray, bool]:
    day_first = day_comes_first(cell for cell in cells if "/" in cell)
    if day_first is None:
        at = next(index for index, cell in enumerate(cells) if "/" in cell)
        allowed = Text(
            "may begin with the day or with the month: say which by a map, with time.unit = "
            "'%d/%m/%Y %H:%M:%S' (day first) or '%m/%d/%Y %H:%M:%S' (month first)"
        )
        row = Text("{where}, row {rows}", where=where, rows=rows[at])
        raise InputError(Fault(row, name, cells[at].strip(), allowed))
    reader = StampReader(day_first)
    seconds, dated = np.empty(len(cells)), np.ones(len(cells), dtype=bool)
    faults: list[Fault] = []
    for index, cell in enumerate(cells):
        moment = _moment(cell.strip(), reader)
        if moment is None:
            faults.append(
                Fault(
                    Text("{where}, row {rows}", where=where, rows=rows[index]),
                    name,
                    cell,
                    Text(
                        "is not an ISO 8601 time, nor one of a logger that is understood whole: write it as "
                        "in 2024-05-17T09:30:00+02:00, or say time.unit and time.zone by a map"
                    ),
                )
            )
        else:
            seconds[index], dated[index] = moment
    if faults:
        raise InputError(limited(where, faults))
    if dated.all():
        return seconds, True
    if dated.any():
        allowed = Text("some rows have a date and some have none")
        raise InputError(
            Fault(
                Text("{where}, row {rows}", where=where, rows=rows[int(np.argmin(dated))]),
                name,
                None,
                allowed,
            )
        )
    nights = np.cumsum(np.diff(seconds, prepend=seconds[0]) < -0.5 * _DAY)
    return seconds + _DAY * nights, False


def _moment(cell: str, reader: StampReader) -> tuple[float, bool] | None:
    try:
        moment = datetime.fromisoformat(cell)
        return (moment if moment.tzinfo else moment.replace(tzinfo=UTC)).timestamp(), True
    except (ValueError, OverflowError):
        pass
    try:
        stamp, rest = reader.read(cell[:80])
    except ValueError:
        return None
    if stamp is None or rest.strip() and _UNREAD.search(unaccented(_SAYS_NOTHING.sub(" ", rest.lower()))):
        return None
    return stamp.seconds, stamp.dated
