"""Standard deviations that a ship's INS gives its own output, as those of the errors of a run."""

import numpy as np

from navcore.engine.reference_errors import D_LAT, D_LON, DV_E, DV_N, PHI_E, PHI_N, PHI_U
from navcore.io.series import Recording, Series
from navcore.quantities import COMPONENTS

_COLUMNS = {"position": (D_LAT, D_LON), "velocity": (DV_E, DV_N), "heading": (PHI_U,)}


def own_deviations(recording: Recording, utc_s: np.ndarray, heading: np.ndarray) -> np.ndarray | None:
    """Deviations of the errors at some times; None where the INS gives none.

    Those of pitch and roll are turned to east and north as if they were independent.

    Parameters
    ----------
    recording : Recording
        Output of the INS.
    utc_s : ndarray, shape (m,)
        Times, s.
    heading : ndarray, shape (m,)
        Of the ship, rad.

    Returns
    -------
    ndarray, shape (m, 7)
        Of `navcore.quantities.COMPONENTS`, SI; NaN of what is not given, and beside its first and last time.
    """
    given = recording.deviations
    if not given:
        return None
    found = np.full((len(utc_s), len(COMPONENTS)), np.nan)
    for name, places in _COLUMNS.items():
        if name in given:
            found[:, list(places)] = _at(given[name], utc_s)
    if "attitude" in given:
        pitch, roll = _at(given["attitude"], utc_s).T
        sine, cosine = np.sin(heading), np.cos(heading)
        found[:, PHI_E] = np.hypot(pitch * cosine, roll * sine)
        found[:, PHI_N] = np.hypot(pitch * sine, roll * cosine)
    return found


def _at(series: Series, utc_s: np.ndarray) -> np.ndarray:
    reach = series.reach_s + 1e-6
    columns = [np.interp(utc_s, series.time_s, column) for column in series.values.T]
    outside = (utc_s < series.time_s[0] - reach) | (utc_s > series.time_s[-1] + reach)
    return np.where(outside[:, None], np.nan, np.column_stack(columns))
