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
from navcore.motion.truth import HEADING, LAT, PITCH
from navcore.quantities import LENGTHS as _LENGTHS
from navcore.quantities import NAMES as NAMES

# Columns of the errors `NAMES`, in this order everywhere.
PHI_E, PHI_N, PHI_U, DV_E, DV_N, D_LAT, D_LON, POSITION = range(8)
QUANTITIES = 8
LENGTHS = len(_LENGTHS)
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
    largest=(REAL, (LENGTHS,)),  # squares, in the order of `navcore.quantities.LENGTHS`
    sums=(REAL, (LENGTHS,)),
    opens=REAL,  # position error at its first state, m
    by_step=REAL,  # sum of position error times step, m
    bound=REAL,  # square of a position error, m^2
    broken=COUNT,  # first step at which it is exceeded
)
"""Lengths of the error vectors from a step on, and what becomes of the position error."""
AXES = record_type(cos_lat=REAL, sin_heading=REAL, cos_heading=REAL, sec_pitch=REAL)
"""True latitude and attitude at a step: what turns the misalignment into the ship's axes."""
READING_S = 600.0
"""Interval of the readings of the heading, s: a gyrocompass is read every 20 and every 30 min."""
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
    axes : ndarray of `AXES`, shape (states,) or (1,)
        From `axes_along`, at each state; one where nothing changes.
    readings : ndarray, shape (m, 2)
        Heading error, and the same times cos L, every ``reading_every`` steps; NaN where none is reached.
    reading_every : int
        Steps between two readings.
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
    axes: np.ndarray
    readings: np.ndarray
    reading_every: int
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


def make_recorder(
    steps: int,
    step_s: float,
    output_step_s: float,
    axes: np.ndarray | None = None,
    rows: np.ndarray | None = None,
) -> Recorder:
    """Make the empty arrays for a run of ``steps`` steps.

    Parameters
    ----------
    steps : int
        Steps of the run.
    step_s, output_step_s : float
        Step, and interval of the output rows, s.
    axes : ndarray of `AXES`, shape (steps + 1,) or (1,), optional
        At the steps; without them, as at the equator on a course north.
    rows : ndarray of int, shape (m,), optional
        Steps of the output rows, where they are not those of the interval.
    """
    row_steps = output_steps(steps, step_s, output_step_s) if rows is None else rows
    every = reading_steps(step_s)
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
        axes=axes_along(np.zeros((1, HEADING + 1))) if axes is None else axes,
        readings=no_readings(steps, every),
        reading_every=every,
        cursor=new_record(CURSOR),
    )


def spans_from(marks: Iterable[tuple[int, float]]) -> np.ndarray:
    """Make empty spans: the whole run, and others; at most `MOST_SPANS` - 1 different ones.

    Parameters
    ----------
    marks : iterable of (int, float)
        Step at which a span begins, and the position error (m) that is watched in it; infinite for none.
    """
    spans = np.zeros(MOST_SPANS, SPAN)
    spans["first"][1:], spans["bound"], spans["broken"] = _NEVER, math.inf, _NEVER
    for place, (step, bound) in enumerate(sorted({*marks} - {(0, math.inf)}), 1):
        spans["first"][place], spans["bound"][place] = step, bound * bound
    return spans


def reading_steps(step_s: float) -> int:
    """Steps between two readings, nearest to `READING_S`."""
    return max(1, round(READING_S / step_s))


def no_readings(steps: int, every: int) -> np.ndarray:
    """Make empty readings of a run of ``steps`` steps, shape (m, 2)."""
    return np.full((steps // every + 1, 2), np.nan)


def axes_along(truth: np.ndarray) -> np.ndarray:
    """Axes of the ship along its true states, shape (n, 15) -> (n,) of `AXES`."""
    axes = np.empty(len(truth), AXES)
    axes["cos_lat"], axes["sec_pitch"] = np.cos(truth[:, LAT]), 1.0 / np.cos(truth[:, PITCH])
    axes["sin_heading"], axes["cos_heading"] = np.sin(truth[:, HEADING]), np.cos(truth[:, HEADING])
    return axes


@inlined
def _in_axes(phi_e, phi_n, phi_u, axes):
    """Squares of the heading error times cos L, and of the errors of roll and pitch (theory.md 2)."""
    level = phi_u * axes.cos_lat
    roll = (phi_e * axes.sin_heading + phi_n * axes.cos_heading) * axes.sec_pitch
    pitch = phi_e * axes.cos_heading - phi_n * axes.sin_heading
    return level * level, roll * roll, pitch * pitch


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
def take_lengths(k, errors, position, axes, spans):
    """Take the lengths of the error vectors of step k into the spans of a run; the position error in m."""
    level, roll, pitch = _in_axes(errors.phi_e, errors.phi_n, errors.phi_u, axes)
    squares = (
        errors.phi_e * errors.phi_e + errors.phi_n * errors.phi_n,
        errors.dv_e * errors.dv_e + errors.dv_n * errors.dv_n,
        errors.phi_u * errors.phi_u,
        position * position,
        level,
        roll,
        pitch,
    )
    for w in range(spans.shape[0]):
        span = spans[w]
        if k >= span.first:
            if span.count == 0:
                span.opens = position
            span.count += 1
            span.by_step += k * position
            if squares[3] > span.bound:
                span.broken = min(span.broken, k)
            for v in range(LENGTHS):
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
        if begin < count:
            _flush_span(begin, count, recorder, span)
    _flush_readings(count, recorder)
    recorder.cursor.count += count
    recorder.cursor.buffer = 0


@inlined
def _flush_readings(count, recorder):
    """Take the readings that lie within the buffer."""
    at, every = recorder.cursor.count, recorder.reading_every
    stride = 1 if recorder.axes.shape[0] > 1 else 0
    place = (at + every - 1) // every
    while place * every < at + count and place < recorder.readings.shape[0]:
        heading = recorder.buffer[PHI_U, place * every - at]
        recorder.readings[place, 0] = heading
        recorder.readings[place, 1] = heading * recorder.axes[place * every * stride].cos_lat
        place += 1


@inlined
def _flush_span(begin, count, recorder, span):
    """Take the states ``begin`` to ``count`` of the buffer into a span."""
    buffer, at = recorder.buffer, recorder.cursor.count
    if span.count == 0:
        span.opens = buffer[POSITION, begin]
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
    by_step = span.by_step
    for i in range(begin, count):
        by_step += (at + i) * buffer[POSITION, i]
    span.by_step = by_step
    if span.bound < span.largest[3]:
        for i in range(begin, count):
            if buffer[POSITION, i] * buffer[POSITION, i] > span.bound:
                span.broken = min(span.broken, at + i)
    stride = 1 if recorder.axes.shape[0] > 1 else 0
    sums, most = (
        (span.sums[4], span.sums[5], span.sums[6]),
        (
            span.largest[4],
            span.largest[5],
            span.largest[6],
        ),
    )
    for i in range(begin, count):
        axes = recorder.axes[(at + i) * stride]
        level, roll, pitch = _in_axes(buffer[PHI_E, i], buffer[PHI_N, i], buffer[PHI_U, i], axes)
        sums = sums[0] + level, sums[1] + roll, sums[2] + pitch
        most = max(most[0], level), max(most[1], roll), max(most[2], pitch)
    span.sums[4], span.sums[5], span.sums[6] = sums
    span.largest[4], span.largest[5], span.largest[6] = most
    span.count += count - begin
