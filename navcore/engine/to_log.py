"""Velocity minus log of an INS, as recorded and damped: its natural lines before and after (theory.md 22)."""

import numpy as np

from navcore.averaging.lines import line_amplitudes, line_phases
from navcore.engine.run import MethodRun, Run
from navcore.motion.truth import VE, VN
from navcore.scenario.own_ins import AS_RECORDED
from navcore.sensors.base import ReferenceErrors

AXES = ("ve", "vn")
_KEYS: tuple[str, ...] = ("schuler_mps", "foucault_mps", "earth_mps", "rms_mps")
_LEAST_PERIODS = 1.5
"""Periods of a line that a record needs for its amplitude to be told."""
_PARTED = 0.5
"""Periods by which the two lines of the Foucault effect differ over a record that can tell them apart."""
_FEWEST_ROWS = 16


def recorded_to_log(log: ReferenceErrors, output_s: np.ndarray) -> np.ndarray:
    """Velocity of the INS as recorded minus that of the log, at output rows.

    Parameters
    ----------
    log : ReferenceErrors
        Log minus INS, at the log's epochs.
    output_s : ndarray, shape (m,)
        Times of the output rows, s.

    Returns
    -------
    ndarray, shape (m, 2)
        East and north, m/s; the mean over the readings that lie nearest to a row; NaN where there is none.
    """
    found = np.full((len(output_s), 2), np.nan)
    if not len(output_s) or not np.any(log.valid):
        return found
    time_s, error = log.time_s[log.valid], log.error[log.valid]
    nearest = np.searchsorted(0.5 * (output_s[1:] + output_s[:-1]), time_s)
    count = np.bincount(nearest, minlength=len(output_s))
    held = count > 0
    for axis in range(2):
        total = np.bincount(nearest, error[:, axis], minlength=len(output_s))
        found[held, axis] = -total[held] / count[held]
    return found


def to_log(run: Run, method: MethodRun | None = None) -> np.ndarray:
    """Velocity minus log at the output rows, of a method or, without one, of the INS as it was recorded.

    A log in the ship's axes is turned by the recorded heading: before and after are held against one log.

    Parameters
    ----------
    run : Run
        On ``[ins]``.
    method : MethodRun, optional
        Of it.

    Returns
    -------
    ndarray, shape (k, 2)
        East and north, m/s, at the rows that the method reached; NaN where the log is silent.
    """
    assert run.against is not None
    if method is None or method.output is None:
        return run.against.to_log
    rows = len(method.t_s)
    return run.against.to_log[:rows] + method.output[:, 2:4] - run.truth[:rows, [VE, VN]]


def bridged(values: np.ndarray) -> np.ndarray:
    """Values with straight lines across the rows that are not known; empty where too few are known."""
    known = np.isfinite(values)
    if np.count_nonzero(known) < _FEWEST_ROWS:
        return np.empty(0)
    places = np.arange(len(values))
    return np.interp(places, places[known], values[known])


def lines_to_log(run: Run) -> dict[str, dict[str, dict[str, float | None]]]:
    """Amplitudes of the natural lines in the velocity minus log, as recorded and of each method.

    Parameters
    ----------
    run : Run
        On ``[ins]``.

    Returns
    -------
    dict
        Name -> "ve" or "vn" -> ``schuler_mps`` (both lines that the Foucault effect parts, together),
        ``foucault_mps`` (the smaller of them: the depth of the beat), ``earth_mps`` (24 h) and ``rms_mps``;
        None for what the record is too short to tell.
    """
    named: list[tuple[str, MethodRun | None]] = [(AS_RECORDED, None)]
    named += [(one.method.name, one) for one in run.methods]
    # keys of a document are plain strings
    return {str(name): _lines(run, to_log(run, one)) for name, one in named}


def _lines(run: Run, values: np.ndarray) -> dict[str, dict[str, float | None]]:
    known = np.isfinite(values).all(axis=1)
    empty: dict[str, float | None] = dict.fromkeys(_KEYS)
    if np.count_nonzero(known) < _FEWEST_ROWS:
        return {axis: dict(empty) for axis in AXES}
    phases = line_phases(run.t_s[: len(values)], run.truth[: len(values)], run.scenario.earth)[known]
    plus, minus, earth = np.abs(phases[-1] - phases[0]) / (2.0 * np.pi)
    parted = abs(plus - minus) > _PARTED
    if not parted:
        phases = np.column_stack([0.5 * (phases[:, 0] + phases[:, 1]), phases[:, 2]])
    fitted = line_amplitudes(run.t_s[: len(values)][known], values[known], phases).amplitude
    found: dict[str, dict[str, float | None]] = {}
    for axis, amplitudes, curve in zip(AXES, fitted, values[known].T, strict=True):
        one = dict(empty)
        one["rms_mps"] = float(np.sqrt(np.mean(curve**2)))
        if min(plus, minus) >= _LEAST_PERIODS:
            one["schuler_mps"] = float(np.hypot(*amplitudes[:2]) if parted else amplitudes[0])
            one["foucault_mps"] = float(np.min(amplitudes[:2])) if parted else None
        if earth >= _LEAST_PERIODS:
            one["earth_mps"] = float(amplitudes[-1])
        found[axis] = one
    return found
