"""From the states of the copies to one method's record: means by group, rows, statistics and plot bins."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from navcore.averaging.copies import Copies
from navcore.compiled import kernel
from navcore.mechanization.recorder import (
    CURSOR_BUFFER,
    CURSOR_ROW,
    D_LAT,
    D_LON,
    DV_E,
    DV_N,
    PHI_E,
    PHI_N,
    PHI_U,
    POSITION,
    QUANTITIES,
    ROW_COLUMNS,
    Recorder,
    flush,
)

LEVEL = [PHI_E, PHI_N, DV_E, DV_N]
"""Recorded quantities that the level group gives."""
SLOW = [PHI_U, D_LAT, D_LON]
"""Recorded quantities that the slow group gives."""


def capture(recorder: Recorder, first: int, count: int) -> None:
    """Make a copy's recorder keep each of ``count`` states from ``first`` on as a row."""
    recorder.row_steps = np.arange(first, first + count)
    recorder.rows = np.empty((count, ROW_COLUMNS))
    recorder.cursor[CURSOR_ROW] = 0


def captured(recorder: Recorder) -> np.ndarray:
    """Rows kept since `capture`."""
    return recorder.rows[: int(recorder.cursor[CURSOR_ROW])]


def averaged_rows(rows: Sequence[np.ndarray], copies: Copies) -> np.ndarray:
    """Means of the copies' rows, shape (n, columns of a row), as long as the shortest of them.

    Errors are small differences of angles to the truth, so that no mean crosses 360 or 180 deg.

    Parameters
    ----------
    rows : sequence of ndarray
        One a copy, columns of `navcore.mechanization.recorder`.
    copies : Copies
        Which of them are averaged for which output.
    """
    count = min(len(part) for part in rows)
    out = rows[0][:count].copy()
    for group, columns in ((copies.level, LEVEL), (copies.slow, SLOW)):
        for column in columns:
            out[:, column] = sum(rows[i][:count, column] for i in group) / len(group)
    out[:, POSITION] = np.hypot(out[:, D_LAT], out[:, D_LON])
    return out


@kernel
def _gather(first, values, row_steps, rows, stats, bin_width, bin_low, bin_high, bin_order,
            buffer, cursor):  # fmt: skip
    last = first + values.shape[0] - 1
    for i in range(values.shape[0]):
        k, place = first + i, cursor[CURSOR_BUFFER]
        for q in range(QUANTITIES):
            buffer[q, place] = values[i, q]
        cursor[CURSOR_BUFFER] = place + 1
        row = cursor[CURSOR_ROW]
        if row < row_steps.shape[0] and row_steps[row] == k:
            for q in range(values.shape[1]):
                rows[row, q] = values[i, q]
            cursor[CURSOR_ROW] = row + 1
        if (k + 1) % bin_width == 0 or k == last:
            flush(k, bin_width, buffer, stats, bin_low, bin_high, bin_order, cursor)


def gather(recorder: Recorder, first: int, values: np.ndarray) -> None:
    """Record the states first, first + 1, ... whose averaged rows are ``values``."""
    r = recorder
    _gather(
        first, np.ascontiguousarray(values), r.row_steps, r.rows, r.stats, r.bin_width, r.bin_low,
        r.bin_high, r.bin_order, r.buffer, r.cursor,
    )  # fmt: skip
