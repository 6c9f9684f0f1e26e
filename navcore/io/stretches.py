"""Stretches of a recorded speed that no ship has, or far off those before and after: a log that fails."""

from collections.abc import Iterator

import numpy as np

from navcore.foundation.text import Text
from navcore.foundation.units import KNOT
from navcore.io.series import Series, utc_text

_JUMP_MPS, _WITHIN_S = 3.0, 10.0
"""A ship does not change its speed by so much between two samples no farther apart."""
_LONGEST_S = 600.0
FASTEST_MPS = 36.0
"""About 70 kn: no ship with a log is faster."""
_MOST_TOLD, _MOST_JUMPS = 3, 2000


def stretch_warnings(*streams: Series | None) -> list[str]:
    """Name recorded speeds that begin and end by a jump, far off their surroundings, or that no ship has.

    Parameters
    ----------
    *streams : Series or None
        Of which the first two columns are a velocity, m/s.
    """
    return [text for series in streams if series is not None for text in _of(series)]


def _of(series: Series) -> list[str]:
    kept = np.flatnonzero(series.valid)
    if len(kept) < 3:
        return []
    time_s, speed = series.time_s[kept], np.hypot(*series.values[kept, :2].T)
    found = stretches(time_s, speed)
    told = [*_too_fast(series, time_s, speed, found)]
    for first, last in found[:_MOST_TOLD]:
        told.append(
            Text(
                "{source}: {count} samples from {begin} for {length:.0f} s reach {most:.1f} kn, beside "
                "{beside:.1f} kn before and after: leave them out, or state an outage of the log",
                source=series.source,
                count=last - first,
                begin=_moment(series, float(time_s[first])),
                length=float(time_s[last] - time_s[first]),
                most=_extreme(speed[first:last], speed[first - 1]) / KNOT,
                beside=float(speed[first - 1]) / KNOT,
            )
        )
    if len(found) > _MOST_TOLD:
        more = len(found) - _MOST_TOLD
        told.append(Text("{source}: {more} more stretches like these", source=series.source, more=more))
    return told


def _too_fast(
    series: Series, time_s: np.ndarray, speed: np.ndarray, found: list[tuple[int, int]]
) -> Iterator[str]:
    """Yield a sentence on speeds that no ship has, outside of the stretches that are named anyway."""
    fast = speed > FASTEST_MPS
    for first, last in found:
        fast[first:last] = False
    at = np.flatnonzero(fast)
    if len(at):
        yield Text(
            "{source}: {count} samples from {begin} on are faster than {fastest:.0f} kn "
            "(up to {most:.1f} kn), which no ship is: leave them out, or state an outage of the log",
            source=series.source,
            count=len(at),
            begin=_moment(series, float(time_s[at[0]])),
            fastest=FASTEST_MPS / KNOT,
            most=float(np.max(speed[at])) / KNOT,
        )


def _moment(series: Series, time_s: float) -> str:
    return utc_text(time_s) if series.dated else Text("t = {time_s:.1f} s", time_s=time_s)


def _extreme(values: np.ndarray, beside: float) -> float:
    return float(values[np.argmax(np.abs(values - beside))])


def stretches(time_s: np.ndarray, speed: np.ndarray) -> list[tuple[int, int]]:
    """First sample of each stretch and the first one after it.

    Parameters
    ----------
    time_s, speed : ndarray, shape (n,)
        s, m/s.

    Examples
    --------
    >>> stretches(np.arange(6.0), np.array([5.0, 5.0, 50.0, 51.0, 5.1, 5.0]))
    [(2, 4)]
    """
    jumps = np.flatnonzero((np.abs(np.diff(speed)) > _JUMP_MPS) & (np.diff(time_s) <= _WITHIN_S)) + 1
    found, after = [], 0
    if len(jumps) > _MOST_JUMPS:  # such a log is noise, not a log that fails now and then
        return found
    for k, first in enumerate(jumps.tolist()):
        if first < after:
            continue
        for last in jumps[k + 1 :].tolist():
            if time_s[last] - time_s[first] > _LONGEST_S:
                break
            off = np.abs(speed[first:last] - speed[first - 1])
            if abs(speed[last] - speed[first - 1]) < 0.5 * _JUMP_MPS and np.min(off) > 0.5 * _JUMP_MPS:
                found.append((first, last))
                after = last
                break
    return found
