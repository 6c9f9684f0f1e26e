"""Values that stand for no reading: "not available" of AIS and MAVLink, 0 N 0 E without a fix."""

from dataclasses import replace

import numpy as np

from navcore.foundation.text import Text
from navcore.foundation.units import DEG
from navcore.io.series import Recording, utc_text

_NOT_AVAILABLE = {
    "heading": {"deg": 511.0, "cdeg": 65535.0},
    "sog": {"kn": 102.3, "cms": 65535.0},
    "cog": {"cdeg": 65535.0},
    "lat": {"deg": 91.0},
    "lon": {"deg": 181.0},
}
"""Numbers of AIS (ITU-R M.1371) and MAVLink, by quantity and unit."""
AIS_NO_COURSE = 360.0
"""Also north in other tables: no course only in a table that holds another of AIS's numbers."""
_ZERO = 1e-7 * DEG
_FAR = 0.5 * DEG
_MOST_ZEROS = 0.5


def not_available(stem: str, unit: str, values: np.ndarray) -> np.ndarray:
    """Which values are AIS's or MAVLink's "not available"; arrays of shape (n,)."""
    known = _NOT_AVAILABLE.get(stem, {}).get(unit)
    if known is None:
        return np.zeros(values.size, dtype=bool)
    return np.isclose(values, known, rtol=0.0, atol=1e-6)


def without_zero_places(recording: Recording) -> Recording:
    """Leave out fixes at 0 N 0 E when all others are far from there, and say so.

    Fixes are kept when half of them or more are there, or others are within half a degree.
    """
    position = recording.position
    if position is None:
        return recording
    lat, lon = position.values[:, 0], position.values[:, 1]
    zero = (np.abs(lat) < _ZERO) & (np.abs(lon) < _ZERO)
    if not zero.any() or zero.mean() >= _MOST_ZEROS or np.hypot(lat, lon)[~zero].min() < _FAR:
        return recording
    times = position.time_s[zero]
    told = Text.plural(
        "{count} position at 0 N 0 E left out, far from all others: {first} to {last}",
        "{count} positions at 0 N 0 E left out, far from all others: {first} to {last}",
        count=int(times.size),
        first=utc_text(times[0]) if position.dated else f"{times[0]:g} s",
        last=utc_text(times[-1]) if position.dated else f"{times[-1]:g} s",
    )
    kept = replace(
        position, time_s=position.time_s[~zero], values=position.values[~zero], valid=position.valid[~zero]
    )
    first, *others = recording.sources
    first = replace(first, warnings=(*first.warnings, told))
    return replace(recording, position=kept, sources=(first, *others))
