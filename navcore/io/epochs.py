"""Numbers of time: which epoch and unit they count from, by the column's name and the size of the numbers."""

import re

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.io.cells import unix_or_elapsed
from navcore.io.column_names import SECONDS, UNIX, Column, plain_name
from navcore.io.times.steps import LEAPS_S

GPS_EPOCH_S = 315964800.0
"""1980-01-06, Unix time."""
_DAY = 86400.0
_GPS = re.compile(r"(?:^|_)(?:gps|gpst)(?:_|$)")
_LAST_GPS_S = 1.6e9
"""GPS time in s up to 2030; larger numbers under such a name are Unix time."""
_DAY_COUNTS = (
    ("1899-12-30", 25569.0, 29221.0, 51500.0),
    ("1858-11-17", 40587.0, 51500.0, 66154.0),
    ("the year 0 of MATLAB", 719529.0, 723181.0, 748000.0),
    ("noon of 4713 BC, Julian", 2440587.5, 2444239.0, 2470000.0),
)
"""Name, value at 1970, and the least and largest number of years about 1980 to 2040."""
_FASTEST_HZ, _SLOWEST_STEP_S = 1440.0, 4.0 * 3600.0


def gps_to_unix(gps_s: np.ndarray) -> np.ndarray:
    """Unix time (UTC) of s since 1980-01-06 that count leap seconds, shape (n,)."""
    unix = gps_s + GPS_EPOCH_S
    leaps = np.searchsorted(LEAPS_S + np.arange(1, LEAPS_S.size + 1), unix, side="right")
    return unix - leaps


def numeric_times(where: str, column: Column, values: np.ndarray) -> tuple[np.ndarray, bool, list[str]]:
    """Times of a column of numbers, s, whether they are dated (since 1970), and what was assumed.

    Raises
    ------
    InputError
        The numbers may be days since an epoch as well as seconds; names the column.
    """
    known = values[~np.isnan(values)]
    if known.size and not column.unit and column.stem not in (SECONDS, UNIX):
        days = _day_count(where, column, known)
        if days is not None:
            name, at_1970 = days
            told = Text("column {name} counts days since {epoch}", name=column.name, epoch=name)
            return (values - at_1970) * _DAY, True, [told]
    seconds, dated = unix_or_elapsed(values, column.unit or ("s" if column.stem == SECONDS else ""))
    dated = dated and column.stem != SECONDS
    if not dated or not _GPS.search(plain_name(column.name)):
        return seconds, dated, []
    if float(np.nanmedian(seconds)) > _LAST_GPS_S:
        told = Text("column {name} is taken as Unix time: as GPS time it lies after 2030", name=column.name)
        return seconds, True, [told]
    told = Text(
        "column {name} is taken as GPS time, s since 1980-01-06: leap seconds removed", name=column.name
    )
    return gps_to_unix(seconds), True, [told]


def _day_count(where: str, column: Column, known: np.ndarray) -> tuple[str, float] | None:
    """Epoch of a count of days; None where the numbers are seconds."""
    middle = float(np.median(known))
    epoch = next(((name, zero) for name, zero, low, high in _DAY_COUNTS if low <= middle < high), None)
    step = float(np.median(np.abs(np.diff(known)))) if known.size > 1 else np.inf
    if epoch is None or not 0.0 < step * _DAY < _SLOWEST_STEP_S:
        return None
    if step < 1.0 / _FASTEST_HZ:
        return epoch
    allowed = Text(
        "may count days since {epoch}, each {step:.3g} s, or seconds, each {step_2:.3g} s: name the unit, "
        "as in time (s), or give ISO 8601",
        epoch=epoch[0],
        step=step * _DAY,
        step_2=step,
    )
    raise InputError(Fault(where, column.name, float(known[0]), allowed))
