"""What a kernel keeps of a run: output rows, statistics on every step, and minima and maxima for the plots.

A 24 h run has 86,401 states; only the output rows are stored. Statistics and the extremes of each plot bin
are formed on the way, so that a peak of one second is neither lost in the metrics nor on the screen.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from navcore.compiled import inlined

# Recorded quantities, in this order everywhere.
PHI_E, PHI_N, PHI_U, DV_E, DV_N, D_LAT, D_LON, POSITION = range(8)
QUANTITIES = 8
NAMES = ("phi_e_rad", "phi_n_rad", "phi_u_rad", "dve_mps", "dvn_mps", "dlat_m", "dlon_m", "position_m")
DAMPED_COLUMN, XI_COLUMN, WANTED_COLUMN, MEASURE_COLUMN = 8, 9, 10, 11
ROW_COLUMNS = 12
LAW_COLUMNS = (WANTED_COLUMN, DAMPED_COLUMN, XI_COLUMN, MEASURE_COLUMN)
"""What the switching view draws: the policy's wish, the state, xi in force, what the policy measured."""

SUM, SUM_SQUARES, MAX_ABS, FINAL = range(4)
STATISTICS = 4
CURSOR_ROW, CURSOR_COUNT, CURSOR_BUFFER = 0, 1, 2

MAX_BINS = 1000


@dataclass
class Recorder:
    """Arrays that a kernel fills.

    Attributes
    ----------
    row_steps : ndarray of int, shape (m,)
        Steps at which an output row is taken, increasing.
    rows : ndarray, shape (m, 12)
        The eight quantities (rad, m/s, m), damped (0/1), xi, wanted (0/1), measure of the policy.
    stats : ndarray, shape (8, 4)
        Sum, sum of squares, largest magnitude and last value, over all steps so far.
    bin_width : int
        Steps a plot bin.
    bin_low, bin_high : ndarray, shape (bins, 8)
        Extremes in each bin.
    bin_order : ndarray of int8, shape (bins, 8)
        1 where the maximum came after the minimum.
    buffer : ndarray, shape (8, bin_width)
        Quantities of the steps since the last flush.
    cursor : ndarray of int, shape (3,)
        Rows written; states counted; states in the buffer.
    """

    row_steps: np.ndarray
    rows: np.ndarray
    stats: np.ndarray
    bin_width: int
    bin_low: np.ndarray
    bin_high: np.ndarray
    bin_order: np.ndarray
    buffer: np.ndarray
    cursor: np.ndarray


def output_steps(steps: int, step_s: float, output_step_s: float) -> np.ndarray:
    """Steps nearest to 0, output_step_s, ... and the last one; int64, strictly increasing."""
    every = max(output_step_s / step_s, 1.0)
    wanted = np.rint(np.arange(int(steps / every + 1e-9) + 1) * every).astype(np.int64)
    return wanted if wanted[-1] == steps else np.append(wanted, steps)


def make_recorder(steps: int, step_s: float, output_step_s: float) -> Recorder:
    """Make the empty arrays for a run of ``steps`` steps."""
    row_steps = output_steps(steps, step_s, output_step_s)
    width = max(1, math.ceil((steps + 1) / MAX_BINS)) if steps + 1 > 2 * MAX_BINS else 1
    bins = math.ceil((steps + 1) / width)
    return Recorder(
        row_steps=row_steps,
        rows=np.zeros((len(row_steps), ROW_COLUMNS)),
        stats=np.zeros((QUANTITIES, STATISTICS)),
        bin_width=width,
        bin_low=np.full((bins, QUANTITIES), np.inf),
        bin_high=np.full((bins, QUANTITIES), -np.inf),
        bin_order=np.zeros((bins, QUANTITIES), np.int8),
        buffer=np.zeros((QUANTITIES, width)),
        cursor=np.zeros(3, np.int64),
    )


@inlined
def record(k, x, m, n_cos, damped, xi, wanted, measure, row_steps, rows, buffer, cursor):
    """Take the error state x (order: dV_E, dV_N, dL, dlambda, phi) and the law's state of step k.

    The law's values come as numbers: handed over as an array they cost a sixth of the integration.
    """
    d_lat, d_lon = m * x[2], n_cos * x[3]
    position = math.sqrt(d_lat * d_lat + d_lon * d_lon)
    i = cursor[CURSOR_BUFFER]
    buffer[0, i], buffer[1, i], buffer[2, i], buffer[3, i], buffer[4, i] = x[4], x[5], x[6], x[0], x[1]
    buffer[5, i], buffer[6, i], buffer[7, i] = d_lat, d_lon, position
    cursor[CURSOR_BUFFER] = i + 1
    j = cursor[CURSOR_ROW]
    if j < row_steps.shape[0] and row_steps[j] == k:
        for q in range(QUANTITIES):
            rows[j, q] = buffer[q, i]
        rows[j, DAMPED_COLUMN], rows[j, XI_COLUMN] = damped, xi
        rows[j, WANTED_COLUMN], rows[j, MEASURE_COLUMN] = wanted, measure
        cursor[CURSOR_ROW] = j + 1


@inlined
def flush(k, bin_width, buffer, stats, bin_low, bin_high, bin_order, cursor):
    """Empty the buffer, whose last entry is step k, into the statistics and the bin of step k.

    One quantity at a time: with all eight in one pass every sum goes through memory, which took three times
    as long as the integration itself.
    """
    b, count = k // bin_width, cursor[CURSOR_BUFFER]
    for q in range(QUANTITIES):
        total, squares, largest = stats[q, SUM], stats[q, SUM_SQUARES], stats[q, MAX_ABS]
        low, high, order = bin_low[b, q], bin_high[b, q], bin_order[b, q]
        for i in range(count):
            value = buffer[q, i]
            total += value
            squares += value * value
            largest = max(largest, abs(value))
            if value < low:
                low, order = value, 0
            if value > high:
                high, order = value, 1
        stats[q, SUM], stats[q, SUM_SQUARES], stats[q, MAX_ABS] = total, squares, largest
        if count > 0:
            stats[q, FINAL] = buffer[q, count - 1]
        bin_low[b, q], bin_high[b, q], bin_order[b, q] = low, high, order
    cursor[CURSOR_COUNT] += count
    cursor[CURSOR_BUFFER] = 0
