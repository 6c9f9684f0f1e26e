"""The error of a log: constant between its changes, or linear where its rate is bounded."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from navcore.design.worst.rate import worst_within_rate

Axis = tuple[np.ndarray, np.ndarray]
"""Times of one axis, increasing, s, and the errors there, m/s."""


@dataclass(frozen=True, eq=False)
class LogError:
    """Error of both axes of a log.

    Attributes
    ----------
    axes : (Axis, Axis)
        East and north; of a log in the ship's axes starboard and forward.
    ramps : bool
        It is linear between the times, else constant from each time on.
    """

    axes: tuple[Axis, Axis]
    ramps: bool

    def at(self, time_s: np.ndarray) -> np.ndarray:
        """Error at each time, m/s, shape (m, 2)."""
        return np.stack([self._axis(time_s, *axis) for axis in self.axes], axis=1)

    def _axis(self, time_s: np.ndarray, times: np.ndarray, errors: np.ndarray) -> np.ndarray:
        if self.ramps:
            return np.interp(time_s, times, errors)
        return errors[np.maximum(np.searchsorted(times, time_s + 1e-6, side="right") - 1, 0)]


def worst_log(
    weights: np.ndarray, begin_s: np.ndarray, log_max: float, log_rate: float | None
) -> tuple[float, LogError]:
    """Largest error that a bounded log makes, and the log.

    Parameters
    ----------
    weights : ndarray, shape (m, 2)
        Of one error by the log's error in each cell, per m/s.
    begin_s : ndarray, shape (m,)
        Begin of each cell, s.
    log_max : float
        Largest error of each axis, m/s.
    log_rate : float or None
        Largest change of it, m/s^2; None: any.
    """
    if log_rate is None:
        axes = tuple(_signs(axis, begin_s, log_max) for axis in weights.T)
        return log_max * float(np.abs(weights).sum()), LogError((axes[0], axes[1]), False)
    found, value = [], 0.0
    for axis in weights.T:
        times, errors = worst_within_rate(axis, begin_s, log_rate / log_max)
        found.append((times, log_max * errors))
        value += float(axis @ np.interp(begin_s, *found[-1]))
    return value, LogError((found[0], found[1]), True)


def _signs(weights: np.ndarray, begin_s: np.ndarray, log_max: float) -> Axis:
    signs = np.sign(weights)
    kept = np.concatenate([[True], np.diff(signs) != 0.0])
    return begin_s[kept], log_max * signs[kept]


def steps(times: np.ndarray, levels: np.ndarray, log_rate: float | None) -> Axis:
    """Axis that goes to another level at each time, at once or with a bounded rate.

    Parameters
    ----------
    times : ndarray, shape (n,)
        Increasing, the first 0, s.
    levels : ndarray, shape (n,)
        m/s.
    log_rate : float or None
        m/s^2.
    """
    if log_rate is None:
        return times, levels
    at, value, made = times.tolist(), float(levels[0]), [(float(times[0]), float(levels[0]))]
    for k in range(1, len(at)):
        made.append((at[k], value))
        whole = abs(float(levels[k]) - value) / log_rate
        lasts = min(whole, at[k + 1] - at[k]) if k + 1 < len(at) else whole
        value += float(np.clip(levels[k] - value, -log_rate * lasts, log_rate * lasts))
        made.append((at[k] + lasts, value))
    nodes = np.array(made)
    first = np.concatenate([[True], np.diff(nodes[:, 0]) > 0.0])
    return nodes[first, 0], nodes[first, 1]
