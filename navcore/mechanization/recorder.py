"""Recorder of a run: output rows, statistics on every step, and minima and maxima for the plots.

A 24 h run has 86,401 states; only the output rows are stored. Statistics and the extremes of each plot bin
are formed on the way, so that a peak of one second is neither lost in the metrics nor on the screen.
"""

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from navcore.foundation.compiled import inlined
from navcore.foundation.records import COUNT, REAL, new_record, record_type
from navcore.quantities import NAMES as NAMES

# Columns of the errors `NAMES`, in this order everywhere.
PHI_E, PHI_N, PHI_U, DV_E, DV_N, D_LAT, D_LON, POSITION = range(8)
QUANTITIES = 8
DAMPED_COLUMN, XI_COLUMN, WANTED_COLUMN, MEASURE_COLUMN = 8, 9, 10, 11
ROW_COLUMNS = 12
LAW_COLUMNS = (WANTED_COLUMN, DAMPED_COLUMN, XI_COLUMN, MEASURE_COLUMN)
"""Columns of the switching view: the policy's wish, the state, xi in force, the policy's measure."""

SUM, SUM_SQUARES, MAX_ABS, FINAL = range(4)
STATISTICS = 4
CURSOR = record_type(
    row=COUNT,  # rows written
    count=COUNT,  # states counted
    buffer=COUNT,  # states in the buffer
)

MAX_BINS = 1000
MOST_SPANS = 24
SPAN = record_type(
    first=COUNT,  # step at which it begins
    count=COUNT,  # states in it
    largest=(REAL, (4,)),  # squares of tilt, velocity, heading, position: tilt and velocity as vectors
    sums=(REAL, (4,)),
)
"""Lengths of the error vectors from a step on."""
_NEVER = 2**62


class Recorder(NamedTuple):
    """Arrays that a kernel fills; given to it as a whole.

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
    spans : ndarray of `SPAN`, shape (MOST_SPANS,)
        From `spans_from`: the first is the whole run.
    cursor : record
        `CURSOR`: how far all this is filled.
    """

    row_steps: np.ndarray
    rows: np.ndarray
    stats: np.ndarray
    bin_width: int
    bin_low: np.ndarray
    bin_high: np.ndarray
    bin_order: np.ndarray
    buffer: np.ndarray
    spans: np.ndarray
    cursor: np.void


class Errors(NamedTuple):
    """Error state of a navigation, SI: dV_E, dV_N, dL, dlambda, phi_E, phi_N, phi_U."""

    dv_e: float
    dv_n: float
    d_lat: float
    d_lon: float
    phi_e: float
    phi_n: float
    phi_u: float


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
        spans=spans_from(()),
        cursor=new_record(CURSOR),
    )


def spans_from(first_steps: Iterable[int]) -> np.ndarray:
    """Make empty spans: the whole run, and from further steps on; at most `MOST_SPANS` - 1 different ones."""
    spans = np.zeros(MOST_SPANS, SPAN)
    spans["first"][1:] = _NEVER
    for place, step in enumerate(sorted({*first_steps} - {0}), 1):
        spans["first"][place] = step
    return spans


@inlined
def given_out(x, s):
    """Errors of what the system gives out: of the computed velocity less what the law takes off."""
    dv_e, dv_n = x.dv_e - s.output[0], x.dv_n - s.output[1]
    return Errors(dv_e, dv_n, x.d_lat, x.d_lon, x.phi_e, x.phi_n, x.phi_u)


@inlined
def record(k, x, m, n_cos, watched, recorder):
    """Take the `Errors` x and the law's `Watched` values of step k; m, n_cos turn angles into metres.

    The law's values come as numbers: handed over as an array they cost a sixth of the integration.
    """
    buffer, cursor = recorder.buffer, recorder.cursor
    d_lat, d_lon = m * x.d_lat, n_cos * x.d_lon
    i = cursor.buffer
    buffer[0, i], buffer[1, i], buffer[2, i], buffer[3, i], buffer[4, i] = (
        x.phi_e, x.phi_n, x.phi_u, x.dv_e, x.dv_n,
    )  # fmt: skip
    buffer[5, i], buffer[6, i], buffer[7, i] = d_lat, d_lon, math.sqrt(d_lat * d_lat + d_lon * d_lon)
    cursor.buffer = i + 1
    j = cursor.row
    if j < recorder.row_steps.shape[0] and recorder.row_steps[j] == k:
        rows = recorder.rows
        for q in range(QUANTITIES):
            rows[j, q] = buffer[q, i]
        rows[j, DAMPED_COLUMN], rows[j, XI_COLUMN] = watched.damped, watched.xi
        rows[j, WANTED_COLUMN], rows[j, MEASURE_COLUMN] = watched.wanted, watched.measure
        cursor.row = j + 1


@inlined
def take_lengths(k, errors, position, spans):
    """Take the lengths of the error vectors of step k into the spans of a run; the position error in m."""
    squares = (
        errors.phi_e * errors.phi_e + errors.phi_n * errors.phi_n,
        errors.dv_e * errors.dv_e + errors.dv_n * errors.dv_n,
        errors.phi_u * errors.phi_u,
        position * position,
    )
    for w in range(spans.shape[0]):
        span = spans[w]
        if k >= span.first:
            span.count += 1
            for v in range(4):
                span.sums[v] += squares[v]
                span.largest[v] = max(span.largest[v], squares[v])


@inlined
def flush(recorder):
    """Empty the buffer into the statistics and the bin of its steps, the present one.

    One quantity at a time: with all eight in one pass every sum goes through memory, which took three times
    as long as the integration itself.
    """
    count = recorder.cursor.buffer
    if count == 0:
        return
    b = recorder.cursor.count // recorder.bin_width
    buffer, stats = recorder.buffer, recorder.stats
    for q in range(QUANTITIES):
        total, squares, largest = stats[q, SUM], stats[q, SUM_SQUARES], stats[q, MAX_ABS]
        low, high = recorder.bin_low[b, q], recorder.bin_high[b, q]
        order = recorder.bin_order[b, q]
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
        stats[q, FINAL] = buffer[q, count - 1]
        recorder.bin_low[b, q], recorder.bin_high[b, q] = low, high
        recorder.bin_order[b, q] = order
    for w in range(recorder.spans.shape[0]):
        span = recorder.spans[w]
        begin = max(0, span.first - recorder.cursor.count)
        if begin >= count:
            continue
        for v in range(4):
            total, largest = span.sums[v], span.largest[v]
            if v == 0 or v == 1:
                a, b = (PHI_E, PHI_N) if v == 0 else (DV_E, DV_N)
                for i in range(begin, count):
                    square = buffer[a, i] * buffer[a, i] + buffer[b, i] * buffer[b, i]
                    total += square
                    largest = max(largest, square)
            else:
                a = PHI_U if v == 2 else POSITION
                for i in range(begin, count):
                    square = buffer[a, i] * buffer[a, i]
                    total += square
                    largest = max(largest, square)
            span.sums[v], span.largest[v] = total, largest
        span.count += count - begin
    recorder.cursor.count += count
    recorder.cursor.buffer = 0
