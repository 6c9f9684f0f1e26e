"""Tables of a recorded IMU: header, columns, units and time found."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import STANDARD_GRAVITY
from navcore.io.cells import times
from navcore.io.column_map import ColumnMap
from navcore.io.column_names import QUANTITIES, SECONDS, UNIX, UTC, Column, known_columns, plain_name
from navcore.io.columns import MOST_COLUMNS, listed
from navcore.io.containers.base import MOST_UNPACKED_BYTES, Container
from navcore.io.dialects import dialect_words, instance_place, instance_words
from navcore.io.epochs import numeric_times
from navcore.io.imu_columns import AXES, DIMENSIONS, FORCE, PAIRS, ImuColumn, imu_columns
from navcore.io.imu_rows import COMMENTS, FIELD, HEAD_BYTES, Header, Wanted, read_rows, unix_text
from navcore.io.mapped_rows import mapped_layout, skipped_text
from navcore.io.mapped_times import MappedClock
from navcore.io.written_units import UNITS

_SEPARATORS = ",;\t|"
_HEAD_LINES = 60
_CLOCKS = (SECONDS, UNIX, UTC)
_FEWEST_NAMED = 2
_FEWEST_SAMPLES = 2
_INTERVALS = frozenset("dt dt_s ts interval interval_s sample_time sampling_interval".split())
"""Names of a number that stands for the times of all samples."""
_SLOWEST_S = 2.0
"""A column of time without a unit whose steps are longer may be in ms, us or ns."""
_DATED_FROM_S = 1e8
_GRAVITY_SHARE = 0.05
_LARGEST = 1e20
_FORCE_UNITS = {unit: UNITS["force"][unit] for unit in ("mps2", "g", "mg")}


class ImuTable(NamedTuple):
    """Numbers of a table.

    Attributes
    ----------
    time_s : ndarray, shape (n,)
        s, from the file's own zero; dated ones from the first sample.
    values : ndarray, shape (n, 6)
        Rates (rad/s) and forces (m/s^2), or increments (rad, m/s), in the table's axes.
    increments : bool
        Which of the two.
    warnings : tuple of str
        What was assumed.
    kind : str
        What the file is, for people.
    """

    time_s: np.ndarray
    values: np.ndarray
    increments: bool
    warnings: tuple[str, ...]
    kind: str = "CSV"


def is_imu_table(head: str) -> bool:
    """Whether the first lines of a text hold a header that names an IMU's quantities."""
    return is_imu_names(_header(head).names)


def is_imu_names(names: Sequence[str]) -> bool:
    """Whether the names of a table's columns are an IMU's."""
    found = imu_columns(names)
    if _kinds(found) is not None:
        return True
    return len(found) >= _FEWEST_NAMED and not known_columns(names).keys() & QUANTITIES.keys()


def read_imu_table(content: bytes, source: str, column_map: ColumnMap | None = None) -> ImuTable:
    """Read a table in UTF-8 whose header may stand in a comment or below a title; by a map, or by its names.

    Raises
    ------
    InputError
        A column is missing or its unit is not known (names the columns found), or a row is no row of numbers.
    """
    head = unix_text(content[:HEAD_BYTES])
    header = _header(head) if column_map is None else _mapped_header(head, column_map)
    wanted = _wanted(source, header.names, column_map)
    told = dialect_words(header.names) if column_map is None else []
    place = instance_place(header.names) if column_map is None else None
    if place is not None:
        content, others = _of_one_instance(content, header, place)
        told += others
    cells, raw, skipped = read_rows(content, header, wanted, source)
    found = _of_numbers(source, wanted, cells, raw, skipped)
    return found._replace(warnings=(*told, *found.warnings))


def read_imu_container(held: Container, source: str, column_map: ColumnMap | None = None) -> ImuTable:
    """Read a Parquet, MAT or npz file as `read_imu_table` does; a single number as time is the interval."""
    wanted = _wanted(source, held.names, column_map)
    places = wanted.places
    try:
        read = held.fetch(places, wanted.clocks, most_cells=MOST_UNPACKED_BYTES // 8)
    except InputError as error:
        raise InputError([Fault(f.where, FIELD, f.field or None, f.allowed) for f in error.faults]) from None
    sizes = {read[place][0].size for place in places}
    cells = [read[place][0] for place in wanted.clocks]
    if len(sizes) != 1 or {cell.size for cell in cells} - sizes - {1}:
        raise InputError(Fault(source, FIELD, None, Text("the columns differ in length")))
    size = sizes.pop()
    if len(cells) == 1 and cells[0].size == 1 and cells[0].dtype.kind in "iuf":
        cells = [float(cells[0][0]) * np.arange(1, size + 1)]
    raw = np.column_stack([read[place][0].astype(float, copy=False) for place in places])
    found = _of_numbers(source, wanted, cells, raw, [])
    told = dialect_words(held.names) if column_map is None else []
    return found._replace(kind=held.kind, warnings=(*told, *found.warnings))


def _wanted(source: str, names: Sequence[str], column_map: ColumnMap | None) -> Wanted:
    """Columns of time and of the quantities; raises `InputError` where one is missing."""
    found = imu_columns(names) if column_map is None else column_map.imu_columns(source, list(names))
    kinds, clock = _kinds(found), _clock(names, column_map)
    if kinds is None or clock is None:
        raise _missing(source, names, found)
    columns = [found[kind, axis] for kind in kinds for axis in AXES]
    _refuse_unknown(source, [*columns, clock])
    clocks = [clock.index] if column_map is None else column_map.clocks(source, list(names))
    return Wanted(clock, clocks, columns, kinds != PAIRS[0], column_map)


def _of_numbers(
    source: str, wanted: Wanted, cells: list[np.ndarray], raw: np.ndarray, skipped: list[int]
) -> ImuTable:
    """Columns of time and the six others, shape (n, 6), turned to SI in place."""
    if len(raw) < _FEWEST_SAMPLES:
        raise InputError(Fault(source, FIELD, None, Text("holds fewer than two samples")))
    if wanted.column_map is not None and wanted.column_map.time.stated:
        time_s, told = _mapped_seconds(cells, wanted.column_map, source)
    else:
        time_s, told = _seconds(cells[0], wanted.clock, source)
    refuse_lost(source, raw, time_s)
    told += [skipped_text(skipped)] if skipped else []
    factors, guessed = _factors(wanted.columns, raw, source)
    if abs(time_s[0]) >= _DATED_FROM_S:
        time_s = time_s - time_s[0]
    raw *= factors
    return ImuTable(time_s, raw, wanted.increments, (*told, *guessed))


def _of_one_instance(content: bytes, header: Header, place: int) -> tuple[bytes, list[str]]:
    """Rows of the first of several sensors whose messages stand between each other, and what to say."""
    lines = content.splitlines(keepends=True)
    head, body = lines[: header.line + 1], lines[header.line + 1 :]
    mark = header.separator.encode()
    cells = [
        line.split(mark, place + 1)[place].strip() if line.count(mark) >= place else b"" for line in body
    ]
    first = next((cell for cell in cells if cell), b"")
    kept = [line for line, cell in zip(body, cells, strict=True) if cell in (first, b"")]
    others = len(body) - len(kept)
    told = [instance_words(others, first.decode("ascii", "replace"))] if others else []
    return b"".join([*head, *kept]) if others else content, told


def refuse_lost(source: str, *arrays: np.ndarray) -> None:
    """Refuse samples, the rows of arrays of numbers, that are NaN or larger than any reading."""
    if all(values.size and values.min() > -_LARGEST and values.max() < _LARGEST for values in arrays):
        return
    known = [np.abs(values.reshape(len(values), -1)) < _LARGEST for values in arrays]
    lost = np.flatnonzero(~np.column_stack(known).all(axis=1))
    what = Text(
        "{size} samples are NaN or infinite, the first at sample {lost} (1e20 and more counts as infinite)",
        size=lost.size,
        lost=lost[0] + 1,
    )
    raise InputError(Fault(source, FIELD, None, what))


def imu_layout(text: str) -> tuple[str, str, list[str]]:
    """Separator, header line and header cells of a text."""
    header = _header(text)
    return header.separator, text[:HEAD_BYTES].split("\n")[header.line], header.names


def _header(text: str) -> Header:
    """The line among the first that names most of an IMU's columns; else the first one that is no comment."""
    best, most = None, 0
    plain = None
    for at, line in enumerate(text[:HEAD_BYTES].split("\n")[:_HEAD_LINES]):
        bare = line.strip().lstrip("#%/ ") if line.lstrip().startswith(COMMENTS) else line.strip()
        separator = max(_SEPARATORS, key=bare.count)
        separator = separator if bare.count(separator) else " "
        names = [name.strip().strip('"') for name in bare.split(None if separator == " " else separator)]
        header = Header(at, separator, names[:MOST_COLUMNS])
        if plain is None and bare:
            plain = header
        count = len(imu_columns(header.names))
        if count > most:
            best, most = header, count
    return best or plain or Header(0, ",", [])


def _kinds(found: dict[tuple[str, str], ImuColumn]) -> tuple[str, str] | None:
    """The pair of kinds whose six columns are all there."""
    return next((p for p in PAIRS if all((kind, axis) in found for kind in p for axis in AXES)), None)


def _mapped_header(text: str, column_map: ColumnMap) -> Header:
    lines = text[:HEAD_BYTES].split("\n")[:_HEAD_LINES]
    separator, line, names = mapped_layout(lines, column_map)
    return Header(lines.index(line) if line else 0, separator, [name.strip() for name in names])


def _clock(names: Sequence[str], column_map: ColumnMap | None) -> Column | None:
    if column_map is not None:
        return Column(0, column_map.time.columns[0], UTC)
    known = known_columns(names)
    intervals = (
        Column(index, name, SECONDS) for index, name in enumerate(names) if plain_name(name) in _INTERVALS
    )
    return next((known[stem] for stem in _CLOCKS if stem in known), next(intervals, None))


def _missing(source: str, names: Sequence[str], found: dict[tuple[str, str], ImuColumn]) -> InputError:
    known = ", ".join(column.name for column in found.values()) or Text("none")
    allowed = Text(
        "needs a header with t_s and gx_rad_s, gy_rad_s, gz_rad_s, fx_mps2, fy_mps2, fz_mps2 (rates and "
        "forces, in any unit that the names give), or dax_rad ... dvz_mps (increments); columns found: "
        "{held}; of an IMU: {known}",
        held=listed(names),
        known=known,
    )
    return InputError(Fault(source, FIELD, None, allowed))


def _refuse_unknown(source: str, columns: Sequence[ImuColumn | Column]) -> None:
    faults = [
        Fault(
            source,
            FIELD,
            column.name,
            Text("gives a unit that is not understood: {unknown}", unknown=column.unknown),
        )
        for column in columns
        if column.unknown
    ]
    if faults:
        raise InputError(faults)


def _factors(columns: list[ImuColumn], raw: np.ndarray, source: str) -> tuple[np.ndarray, tuple[str, ...]]:
    """SI over the unit of each column; forces without a unit have the one in which they are gravity."""
    bare = [column for column in columns if not column.unit]
    if not bare:
        return np.array([column.factor for column in columns]), ()
    size = float(np.linalg.norm(raw[:, 3:].mean(axis=0)))
    unit = next(
        (u for u, si in _FORCE_UNITS.items() if abs(size * si / STANDARD_GRAVITY - 1.0) < _GRAVITY_SHARE), ""
    )
    unsure = [column for column in bare if column.kind != FORCE or not unit]
    if unsure:
        needed = ", ".join(UNITS[DIMENSIONS[unsure[0].kind]])
        allowed = Text(
            "names no unit: name one, as in gyro_x (rad/s); known: {needed}; columns without: {columns}",
            needed=needed,
            columns=", ".join(column.name for column in unsure),
        )
        raise InputError(Fault(source, FIELD, unsure[0].name, allowed))
    told = Text(
        "columns {columns} name no unit: taken as {unit}, in which their mean size is gravity",
        columns=", ".join(column.name for column in bare),
        unit={"mps2": "m/s²"}.get(unit, unit),
    )
    given = [column.sign * _FORCE_UNITS[unit] if column in bare else column.factor for column in columns]
    return np.array(given), (told,)


def _mapped_seconds(
    cells: list[np.ndarray], column_map: ColumnMap, source: str
) -> tuple[np.ndarray, list[str]]:
    """Times in s from the first sample, by a map."""
    clock = MappedClock(column_map.time, column_map.decimal)
    unit = column_map.time.numeric
    if unit and cells[0].dtype.kind in "iuf":
        return (cells[0] - cells[0][0]).astype(float) * UNITS["time"][unit], []
    texts = [" ".join(row) for row in zip(*(map(str, column.tolist()) for column in cells), strict=True)]
    time_s, _ = clock.read(source, texts, range(1, len(texts) + 1))
    return time_s, clock.warnings()


def _seconds(cells: np.ndarray, clock: Column, source: str) -> tuple[np.ndarray, list[str]]:
    """Times in s, and what was assumed of them."""
    if cells.dtype.kind not in "iuf":
        texts = [str(cell) for cell in cells.tolist()]
        try:
            return times(source, clock.name, texts, range(1, len(texts) + 1))[0], []
        except InputError as error:
            raise InputError([Fault(f.where, FIELD, f.value, f.allowed) for f in error.faults]) from None
    whole = cells.dtype.kind in "iu"
    if whole and cells.size and abs(int(cells[0])) >= _DATED_FROM_S:
        # A count of ns since 1970 has more digits than a float: its differences are what is needed.
        ends, _, told = numeric_times(source, clock, np.array([cells[0], cells[-1]], dtype=float))
        span = float(cells[-1] - cells[0])
        scale = (ends[1] - ends[0]) / span if span else 1.0
        numbers = (cells - cells[0]).astype(float) * float(f"{scale:.3g}")
    else:
        numbers, _, told = numeric_times(source, clock, cells.astype(float, copy=False))
    if clock.unit or clock.stem == SECONDS or numbers.size < _FEWEST_SAMPLES:
        return numbers, told
    step = float(np.median(np.diff(numbers)))
    if step > _SLOWEST_S:
        allowed = Text("has steps of {step:g}: s, ms, us or ns? Name the unit, as in time (ms)", step=step)
        raise InputError(Fault(source, FIELD, clock.name, allowed))
    return numbers, told
