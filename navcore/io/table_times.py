"""Columns of numbers as a table, and its times: of one clock, each row once, in order."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from navcore.foundation.errors import Fault
from navcore.foundation.text import Text
from navcore.io.column_names import Column
from navcore.io.series import LeftOut
from navcore.io.times.coarse_stamps import spread, spread_bursts
from navcore.io.times.counts import FASTEST_HZ
from navcore.io.times.doubts import trust_of
from navcore.io.times.repeats import first_of_equals, ids_of
from navcore.io.times.steps import back_advice, sorting_mends, without_leap_step

_FEWEST_ROWS = 3


@dataclass(frozen=True)
class Table:
    """Columns of numbers.

    Attributes
    ----------
    where, kind : str
        File name, and what it was read as.
    columns : dict
        Columns by what they hold.
    time_s : ndarray, shape (n,)
        UTC in s since 1970, or s since the file's own zero.
    dated : bool
        Which of the two.
    clock : str
        Name of the column of time.
    values : dict
        By what they hold, arrays of shape (n,), in the columns' units.
    missing : dict
        By what they hold, arrays of bool of shape (n,): empty cells; absent when there are none.
    rows : sequence of int
        Row numbers for faults.
    warnings : tuple of str
        Passed on.
    left_out : tuple of LeftOut
        Rows that are not among these.
    ids : callable, optional
        Numbers of the rows, shape (n,), which are equal for rows that are equal in every cell; else those of
        the columns that are used are compared.
    choices : tuple of str
        Which of several columns for one quantity is taken.
    units_stated : bool
        Whether a map or the format says in which units all columns are.
    """

    where: str
    kind: str
    columns: dict[str, Column]
    time_s: np.ndarray
    dated: bool
    clock: str
    values: dict[str, np.ndarray]
    missing: dict[str, np.ndarray]
    rows: Sequence[int] | np.ndarray
    warnings: tuple[str, ...] = ()
    left_out: tuple[LeftOut, ...] = ()
    ids: Callable[[], np.ndarray] | None = None
    choices: tuple[str, ...] = ()
    units_stated: bool = False


def of_one_clock(table: Table) -> Table:
    """Rows whose times can be, each once, those of one stamp spread over its interval.

    In this order: rows before the clock was set, rows that are there twice, leap seconds that a receiver
    learns on its way, stamps coarser than the data.
    """
    if table.dated and not np.isnan(table.time_s).any():
        trust = trust_of(table.time_s, Text("rows"))
        table = _kept(table, trust.kept, Text("dated before the clock was set"), trust.warnings)
    if table.time_s.size > 1 and not np.all(np.diff(table.time_s) > 0.0):
        ids = table.ids() if table.ids is not None else ids_of(all_columns(table))
        kept = first_of_equals(ids, table.time_s)
        told = Text.plural(
            "{count} row is identical to an earlier one in every cell: left out",
            "{count} rows are identical to earlier ones in every cell: left out",
            count=int(np.count_nonzero(~kept)),
        )
        table = _kept(table, kept, Text("repeats an earlier row"), [] if kept.all() else [told])
    if table.dated:
        time_s, count, leaps = without_leap_step(table.time_s)
        told = Text(
            "{count} rows before the receiver knew the leap seconds are {leaps} s ahead of UTC: taken off",
            count=count,
            leaps=leaps,
        )
        table = replace(table, time_s=time_s, warnings=(*table.warnings, *([told] if count else [])))
    time_s, rows = spread(table.time_s)
    told = Text(
        "{rows} rows bear the same time, too coarse for them: spread over its interval, as they stand",
        rows=rows,
    )
    if rows == 1 and not any(gone.any() for gone in table.missing.values()):
        time_s, rows = spread_bursts(table.time_s)
        told = Text(
            "the rows come in bursts of {rows}, as a host stamps them on arrival: spread over the time "
            "between two bursts, the last of each at its stamp",
            rows=rows,
        )
    if rows == 1:
        return table
    return replace(table, time_s=time_s, warnings=(*table.warnings, told))


def all_columns(table: Table) -> np.ndarray:
    """Times and values beside each other, shape (n, k)."""
    return np.column_stack([table.time_s, *table.values.values()])


def _kept(table: Table, kept: np.ndarray, why: str, told: Sequence[str]) -> Table:
    """Table with some of its rows; the others are counted."""
    if kept.all():
        return replace(table, warnings=(*table.warnings, *told))
    ids = table.ids
    return replace(
        table,
        time_s=table.time_s[kept],
        values={stem: values[kept] for stem, values in table.values.items()},
        missing={stem: gone[kept] for stem, gone in table.missing.items()},
        rows=np.asarray(table.rows)[kept],
        warnings=(*table.warnings, *told),
        left_out=(*table.left_out, LeftOut("rows", "", why, int(np.count_nonzero(~kept)))),
        ids=None if ids is None else lambda: ids()[kept],
    )


def order_faults(table: Table) -> list[Fault]:
    """A fault where times run backwards or are the same: what would mend it."""
    steps = np.diff(table.time_s)
    back, same = np.flatnonzero(steps < 0.0), np.flatnonzero(steps == 0.0)
    if back.size == same.size == 0:
        return []
    first = int(back[0] if back.size else same[0])
    where = Text("{where}, row {rows}", where=table.where, rows=table.rows[first + 1])
    if back.size:
        more = Text(" ({size} such rows)", size=back.size) if back.size > 1 else ""
        advice = (
            Text("put the rows in order")
            if sorting_mends(spread(np.sort(table.time_s))[0])
            else back_advice(table.time_s, first, table.dated)
        )
        allowed = Text(
            "time runs backwards by {steps:g} s{more}; {advice}",
            steps=-steps[first],
            more=more,
            advice=advice,
        )
    else:
        allowed = Text(
            "time is the same as in the row before, with other values ({size} such rows; {times} times of "
            "{rows} rows): "
            "the stamps are too coarse or rounded; give finer ones, or another column of time",
            size=same.size,
            times=np.unique(table.time_s).size,
            rows=table.time_s.size,
        )
    return [Fault(where, table.clock, None, allowed)]


def rate_faults(table: Table) -> list[Fault]:
    """A fault where the rows lie closer together than those of any log, as days taken for seconds do."""
    span = float(np.ptp(table.time_s)) if table.time_s.size else 0.0
    if table.time_s.size < _FEWEST_ROWS or span * FASTEST_HZ >= table.time_s.size - 1:
        return []
    allowed = Text(
        "{rows} rows within {span:.3g} s: is the time counted in another unit, such as days or years? Name "
        "it, "
        "as in time (day), or by a map",
        rows=table.time_s.size,
        span=span,
    )
    return [Fault(table.where, table.clock, float(table.time_s[0]), allowed)]
