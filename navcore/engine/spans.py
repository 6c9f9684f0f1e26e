"""What a run keeps of its errors from a time to the end: lengths, position error, readings of the heading."""

import math
from dataclasses import dataclass, replace

import numpy as np

from navcore.mechanization.recorder import axes_along, reading_steps
from navcore.quantities import NAMES


@dataclass(frozen=True)
class Span:
    """Lengths of the error vectors from a time to the end of a run, on the mechanization's own steps, SI.

    Attributes
    ----------
    from_s : float
        Time of the first step, s.
    largest : tuple of float
        Largest value of each of `navcore.quantities.LENGTHS`.
    rms : tuple of float
        Root mean squares of the same.
    opens_m : float
        Position error at its first step, m.
    rate_mps : float
        Slope of the least-squares line through the origin of the position error over time, m/s.
    bound_m : float
        Position error that was watched, m; infinite for none.
    held_s : float
        Last time up to which the position error stayed within it, s; infinite where it always did.
    readings : tuple of (float, float)
        Heading error, and the same times cos L, every ``reading_s``, rad; of the whole run alone.
    reading_s : float
        Interval of the readings, s.
    """

    from_s: float
    largest: tuple[float, ...]
    rms: tuple[float, ...]
    opens_m: float = math.inf
    rate_mps: float = math.inf
    bound_m: float = math.inf
    held_s: float = math.inf
    readings: tuple[tuple[float, float], ...] = ()
    reading_s: float = 0.0


def spans(records: np.ndarray, step_s: float, readings: np.ndarray | None = None) -> tuple[Span, ...]:
    """Lengths of the error vectors over each span that has a state.

    Parameters
    ----------
    records : ndarray of `navcore.mechanization.recorder.SPAN`, shape (n,)
        The first is of the whole run.
    step_s : float
        Step, s.
    readings : ndarray, shape (m, 2), optional
        Of the heading, as of the recorder; they go with the first span.
    """
    made = [_span(span, step_s) for span in records[records["count"] > 0]]
    if made and readings is not None:
        taken = readings[~np.isnan(readings[:, 0])]
        pairs = tuple(map(tuple, taken.tolist()))
        made[0] = replace(made[0], readings=pairs, reading_s=reading_steps(step_s) * step_s)
    return tuple(made)


def _span(span: np.void, step_s: float) -> Span:
    first, count = int(span["first"]), int(span["count"])
    last = first + count - 1
    squares = _sum_of_squares(last) - _sum_of_squares(first - 1)
    broken = int(span["broken"])
    return Span(
        from_s=first * step_s,
        largest=tuple(np.sqrt(span["largest"]).tolist()),
        rms=tuple(np.sqrt(span["sums"] / count).tolist()),
        opens_m=float(span["opens"]),
        rate_mps=float(span["by_step"]) / (squares * step_s) if squares else 0.0,
        bound_m=math.sqrt(span["bound"]),
        held_s=max(broken - 1, 0) * step_s if broken <= last else math.inf,
    )


def _sum_of_squares(last: int) -> float:
    """Sum of k^2 for k = 0..last."""
    return last * (last + 1) * (2 * last + 1) / 6.0 if last > 0 else 0.0


def span_of(t_s: np.ndarray, rows: np.ndarray, truth: np.ndarray) -> Span:
    """Lengths of the error vectors in output rows of a part of a run.

    Parameters
    ----------
    t_s : ndarray, shape (m,)
        Times of the rows, s.
    rows : ndarray, shape (m, 8) or with more columns
        Errors, columns of `navcore.quantities.NAMES`.
    truth : ndarray, shape (m, 15)
        True motion there.
    """
    phi_e, phi_n, phi_u, dv_e, dv_n = rows[:, :5].T
    position, axes = rows[:, len(NAMES) - 1], axes_along(truth)
    roll = (phi_e * axes["sin_heading"] + phi_n * axes["cos_heading"]) * axes["sec_pitch"]
    pitch = phi_e * axes["cos_heading"] - phi_n * axes["sin_heading"]
    level = phi_u * axes["cos_lat"]
    squares = np.array(
        [phi_e**2 + phi_n**2, dv_e**2 + dv_n**2, phi_u**2, position**2, level**2, roll**2, pitch**2]
    )
    largest, rms = np.sqrt(squares.max(axis=1)), np.sqrt(squares.mean(axis=1))
    times = float(t_s @ t_s)
    return Span(
        0.0,
        tuple(largest.tolist()),
        tuple(rms.tolist()),
        opens_m=float(position[0]),
        rate_mps=float(t_s @ position) / times if times else 0.0,
    )
