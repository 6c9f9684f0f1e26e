"""From the states of the copies to one method's record: means by group, rows, statistics and plot bins."""

from collections.abc import Sequence

import numpy as np

from navcore.averaging.copies import Copies
from navcore.foundation.compiled import kernel
from navcore.mechanization.recorder import (
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


def capturing(recorder: Recorder, first: int, count: int) -> Recorder:
    """Return a copy's recorder so that it keeps each of ``count`` states from ``first`` on as a row."""
    recorder.cursor["row"] = 0
    return recorder._replace(row_steps=np.arange(first, first + count), rows=np.empty((count, ROW_COLUMNS)))


def captured(recorder: Recorder) -> np.ndarray:
    """Rows kept since `capturing`."""
    return recorder.rows[: int(recorder.cursor["row"])]


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
def _gather(first, values, recorder):
    cursor, last = recorder.cursor, first + values.shape[0] - 1
    for i in range(values.shape[0]):
        k, place = first + i, cursor.buffer
        for q in range(QUANTITIES):
            recorder.buffer[q, place] = values[i, q]
        cursor.buffer = place + 1
        row = cursor.row
        if row < recorder.row_steps.shape[0] and recorder.row_steps[row] == k:
            for q in range(values.shape[1]):
                recorder.rows[row, q] = values[i, q]
            cursor.row = row + 1
        if (k + 1) % recorder.bin_width == 0 or k == last:
            flush(recorder)


def gather(recorder: Recorder, first: int, values: np.ndarray) -> None:
    """Record the states first, first + 1, ... whose averaged rows are ``values``."""
    _gather(first, np.ascontiguousarray(values), recorder)
