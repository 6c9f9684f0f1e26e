"""Measures of the claims on a run: attitude errors, settling, peaks, spreads, intervals over seeds."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from navcore.engine.run import MethodRun, Run
from navcore.foundation.units import HOUR
from navcore.mechanization.recorder import PHI_E, PHI_N, PHI_U
from navcore.motion.truth import HEADING, PITCH
from tools.papers.claim import number
from tools.papers.estimate import interval


def hours(run: MethodRun) -> np.ndarray:
    """Times of the output rows, h."""
    return run.t_s / HOUR


def attitude_error(run: Run, method: MethodRun) -> np.ndarray:
    """Errors of pitch, roll, heading (computed minus true, rad) at the output rows, shape (m, 3)."""
    phi = method.rows[:, [PHI_E, PHI_N, PHI_U]]
    return as_attitude(phi, run.truth[: len(method.t_s)])


def as_attitude(phi: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """Errors of pitch, roll, heading (rad) of a misalignment E, N, U and rows of truth, shape (m, 3)."""
    phi_e, phi_n, phi_u = phi.T
    sine, cosine = np.sin(truth[:, HEADING]), np.cos(truth[:, HEADING])
    along, across = phi_e * sine + phi_n * cosine, phi_e * cosine - phi_n * sine
    pitch = truth[:, PITCH]
    return np.stack([-across, -along / np.cos(pitch), phi_u - np.tan(pitch) * along], axis=1)


def last_above(time_s: np.ndarray, response: np.ndarray, fraction: float, final: float = 0.0) -> float:
    """Last time at which a response is further than a fraction of its peak from its final value, s."""
    departure = np.abs(response - final)
    return float(time_s[np.flatnonzero(departure > fraction * np.max(departure))[-1]])


def peak(time_s: np.ndarray, values: np.ndarray, begin_s: float, end_s: float = np.inf) -> float:
    """Largest magnitude within a span of time."""
    inside = (time_s >= begin_s) & (time_s <= end_s)
    return float(np.max(np.abs(values[inside])))


def departure(time_s: np.ndarray, values: np.ndarray, begin_s: float, end_s: float = np.inf) -> float:
    """Largest departure from the value at the beginning of a span of time."""
    inside = values[(time_s >= begin_s) & (time_s <= end_s)]
    return float(np.max(np.abs(inside - inside[0])))


def spread(time_s: np.ndarray, values: np.ndarray, begin_s: float = 0.0) -> float:
    """Standard deviation from a time on."""
    return float(np.std(values[time_s >= begin_s]))


def peak_gain(gain: Callable[[np.ndarray], np.ndarray], grid: np.ndarray) -> float:
    """Largest value of a gain over frequency, found between the points of a grid and not only on them.

    Parameters
    ----------
    gain : callable
        Gain at frequencies, an array of the same shape.
    grid : ndarray
        Rising frequencies, > 0, so close that the peak lies beside the largest of them.
    """
    from scipy.optimize import minimize_scalar

    on_grid = gain(grid)
    k = int(np.clip(np.argmax(on_grid), 1, len(grid) - 2))
    ends = np.log(grid[k - 1]), np.log(grid[k + 1])
    found: Any = minimize_scalar(
        lambda x: -float(gain(np.array([np.exp(x)]))[0]),
        bounds=ends,
        method="bounded",
        options={"xatol": 1e-9},
    )
    return max(-float(found.fun), float(np.max(on_grid)))


def rms(values: np.ndarray) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(np.square(values))))


def mean_and_interval(samples: Sequence[float] | np.ndarray, digits: int = 3) -> str:
    """Text "mean +- half width" of the 95 % confidence interval."""
    mean, half = interval(samples)
    return f"{number(mean, digits)} +- {number(half, 2)}"
