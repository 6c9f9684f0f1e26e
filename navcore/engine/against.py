"""Results of a run on a ship's own INS: the damped output, and its errors against a reference."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from navcore.engine.reference_errors import D_LAT, D_LON, DV_E, DV_N, PHI_U, RecordedErrors
from navcore.engine.run import MethodRun, PlotSeries
from navcore.engine.spans import Span, span_of
from navcore.mechanization.recorder import MAX_BINS, POSITION, QUANTITIES, READING_S, XI_COLUMN
from navcore.motion.truth import LAT
from navcore.quantities import COMPONENTS, NAMES

Watch = tuple[float, float]
OUTPUT = ("lat_rad", "lon_rad", "ve_mps", "vn_mps", "heading_rad")
"""Columns of the damped output."""


def rows_of(recorded: RecordedErrors, output_steps: np.ndarray, step_s: float, steps: int) -> np.ndarray:
    """Steps at which a method's state is needed: those of the output, and those beside each epoch."""
    places = recorded.time_s / step_s
    beside = np.concatenate([np.floor(places + 1e-6), np.ceil(places - 1e-6)])
    return np.unique(np.concatenate([output_steps, np.clip(beside, 0, steps).astype(np.int64)]))


def against_reference(
    run: MethodRun,
    recorded: RecordedErrors,
    output_s: np.ndarray,
    truth: np.ndarray,
    watched: Sequence[Watch],
) -> MethodRun:
    """Return a method's result with its errors against the reference.

    Parameters
    ----------
    run : MethodRun
        Of damped minus recorded, at the steps of `rows_of`.
    recorded : RecordedErrors
        Of the INS as it was recorded.
    output_s : ndarray, shape (m,)
        Times of the output rows, s.
    truth : ndarray, shape (n, 15)
        Motion of the output at the epochs, columns of `navcore.motion.truth`.
    watched : sequence of (float, float)
        Times from which requirements count (s), and position errors that they watch (m).
    """
    reached = run.t_s[-1] if len(run.t_s) else 0.0
    epochs = recorded.time_s[recorded.time_s <= reached + 1e-6]
    errors = np.full((len(epochs), QUANTITIES), np.nan)
    for place in range(len(COMPONENTS)):
        moved = np.interp(epochs, run.t_s, run.rows[:, place])
        errors[:, place] = recorded.values[: len(epochs), place] + moved
    errors[:, -1] = np.hypot(errors[:, D_LAT], errors[:, D_LON])
    times = output_s[output_s <= reached + 1e-6]
    at = np.searchsorted(run.t_s, times - 1e-6)
    rows = run.rows[at].copy()
    rows[:, :QUANTITIES] = recorded.between(times, errors)
    rows[:, QUANTITIES - 1] = np.hypot(rows[:, D_LAT], rows[:, D_LON])
    return replace(
        run,
        t_s=times,
        rows=rows,
        law_series=run.law_series[at],
        output=None if run.output is None else run.output[at],
        moved=None if run.moved is None else run.moved[at],
        errors=_statistics(errors),
        plot=_plot(epochs, errors),
        spans=_spans(epochs, errors, truth[: len(epochs)], watched),
    )


def damped_output(rows: np.ndarray, output: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """Output of the INS as it would be with the damping.

    Parameters
    ----------
    rows : ndarray, shape (m, 8) or more columns
        Damped minus recorded.
    output : ndarray, shape (m, 5)
        Recorded, columns `OUTPUT`.
    radii : ndarray, shape (m, 2)
        Metres of a radian of latitude and of longitude.
    """
    moved = [
        rows[:, D_LAT] / radii[:, 0],
        rows[:, D_LON] / radii[:, 1],
        rows[:, DV_E],
        rows[:, DV_N],
        rows[:, PHI_U],
    ]
    return output + np.column_stack(moved)


def _statistics(errors: np.ndarray) -> dict[str, dict[str, float]]:
    """Mean, standard deviation, RMS, largest magnitude and last value of each quantity; NaN where unknown."""
    if not len(errors):
        return {name: dict.fromkeys(("mean", "std", "rms", "max_abs", "final"), math.nan) for name in NAMES}
    out = {}
    for name, column in zip(NAMES, errors.T, strict=True):
        out[name] = {
            "mean": float(np.mean(column)),
            "std": float(np.std(column)),
            "rms": float(np.sqrt(np.mean(column**2))),
            "max_abs": float(np.max(np.abs(column))),
            "final": float(column[-1]),
        }
    return out


def _plot(time_s: np.ndarray, errors: np.ndarray) -> PlotSeries:
    """Curves that keep every extreme, two points a bin where the epochs are many."""
    if len(time_s) <= 2 * MAX_BINS:
        return PlotSeries(time_s, errors)
    width = math.ceil(len(time_s) / MAX_BINS)
    room = -len(time_s) % width
    times = np.pad(time_s, (0, room), mode="edge").reshape(-1, width)
    binned = np.pad(errors, ((0, room), (0, 0)), mode="edge").reshape(-1, width, errors.shape[1])
    places = np.sort([binned.argmin(axis=1), binned.argmax(axis=1)], axis=0)
    both = np.take_along_axis(binned, np.moveaxis(places, 0, 1), axis=1)
    length = times[:, -1] - times[:, 0]
    at = np.column_stack([times[:, 0] + 0.25 * length, times[:, 0] + 0.75 * length])
    return PlotSeries(at.ravel(), both.reshape(-1, errors.shape[1]))


def _spans(
    time_s: np.ndarray, errors: np.ndarray, truth: np.ndarray, watched: Sequence[Watch]
) -> tuple[Span, ...]:
    """Lengths of the error vectors at the epochs: of the whole run, and of what requirements watch."""
    if not len(time_s):
        return ()
    found = [
        replace(
            span_of(time_s, errors, truth), readings=_readings(time_s, errors, truth), reading_s=READING_S
        )
    ]
    for begin, bound in sorted({*watched} - {(0.0, math.inf)}):
        part = time_s >= begin - 1e-6
        if not np.any(part):
            continue
        beyond = np.flatnonzero(part & (errors[:, POSITION] > bound))
        held_s = float(time_s[max(beyond[0] - 1, 0)]) if beyond.size else math.inf
        span = span_of(time_s[part], errors[part], truth[part])
        found.append(replace(span, from_s=begin, bound_m=bound, held_s=held_s))
    return tuple(found)


def _readings(time_s: np.ndarray, errors: np.ndarray, truth: np.ndarray) -> tuple[tuple[float, float], ...]:
    """Heading error, and the same times cos L, at the intervals of a gyrocompass's readings."""
    at = np.arange(0.0, time_s[-1] + 1e-6, READING_S)
    heading = np.interp(at, time_s, errors[:, PHI_U])
    level = heading * np.cos(np.interp(at, time_s, truth[:, LAT]))
    return tuple(zip(heading.tolist(), level.tolist(), strict=True))


def as_recorded(like: MethodRun, watched: np.ndarray | None) -> MethodRun:
    """Return the INS as it was recorded as a method's result before the reference: nothing is moved.

    Parameters
    ----------
    like : MethodRun
        Judged as the INS's own method, at the same steps.
    watched : ndarray, shape (m, 4), or None
        What its own law did at these steps; None where it ran free.
    """
    rows = np.zeros((len(like.t_s), XI_COLUMN + 1))
    law = np.zeros((len(like.t_s), 4))
    if watched is not None:
        law = watched
        rows[:, QUANTITIES], rows[:, XI_COLUMN] = watched[:, 1], watched[:, 2]
    return replace(like, rows=rows, law_series=law)
