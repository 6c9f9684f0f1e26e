"""Clocks that were set forward within a file: told from gaps by the ship's motion, or by a known size."""

import numpy as np

from navcore.foundation.earth import WGS84
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.io.series import GAP_FACTOR, Series, utc_text
from navcore.io.times.doubts import span_text
from navcore.io.times.steps import reason_of

_NEAR = 20
"""Samples on each side whose speed is compared with the way across the gap."""
_SLOWEST_MPS = 0.5
_PLAIN_M = 30.0
"""A ship that sails a shorter way in the time of the gap says nothing about it."""
_WITHIN_S = 1.5


def gap_doubt(series: Series, position: Series | None) -> str:
    """Doubt of the longest gap of a stream: that its clock was set there; empty where it is a plain gap.

    Parameters
    ----------
    series : Series
        The stream.
    position : Series, optional
        Positions by the same clock. Where they move across the gap as in one interval, the clock was set.
        Where they move as in the whole time, it was not. Without them, only a gap is doubted that is a known
        time and one interval, or longer than all the rest.
    """
    if series.time_s.size < 3:
        return ""
    steps = np.diff(series.time_s)
    at, usual = int(np.argmax(steps)), series.interval_s
    longest = float(steps[at])
    if longest <= GAP_FACTOR * usual:
        return ""
    ran_on = None if position is None else _ran_on(position, series.time_s[at], series.time_s[at + 1])
    if ran_on is False:
        return ""
    rest = float(steps.sum()) - longest
    longer = series.dated and longest > rest and longest >= HOUR
    within = max(1.0, usual) if longer else min(0.5 * usual + 0.1, _WITHIN_S)
    reason = reason_of(longest - usual, within, float(series.time_s[at]) if series.dated else 0.0)
    if not (ran_on or reason or longer):
        return ""
    ends = [utc_text(t) if series.dated else f"{t:g} s" for t in series.time_s[at : at + 2]]
    told = Text("a gap of {gap} from {begin} to {end}", gap=span_text(longest), begin=ends[0], end=ends[1])
    told = Text("{gap} is longer than all the rest", gap=told) if longer else told
    told = Text("{gap}: was the clock set there?", gap=told)
    if ran_on:
        told = Text(
            "{told} The positions move on across it as in one interval: it was, forward by {size}; take "
            "that off the times behind, or add it to those before.",
            told=told,
            size=span_text(longest - usual),
        )
    return Text("{told} It is an interval and {reason}", told=told, reason=reason) if reason else told


def _ran_on(position: Series, begin_s: float, end_s: float) -> bool | None:
    """Whether positions cross a gap as in one interval; False as in its time, None where it is not plain."""
    time_s, usual = position.time_s, position.interval_s
    last = int(np.searchsorted(time_s, begin_s + 0.5 * usual, side="right")) - 1
    first = last + 1
    if last < 1 or first >= time_s.size - 1:
        return None
    gap_s = float(time_s[first] - time_s[last])
    if gap_s < max(GAP_FACTOR * usual, 0.5 * (end_s - begin_s)):
        return None
    before = slice(max(0, last - _NEAR), last + 1)
    after = slice(first, first + _NEAR + 1)
    speeds = [_way(position, part).sum() / np.ptp(time_s[part]) for part in (before, after)]
    speed = float(min(speeds))
    if speed < _SLOWEST_MPS or speed * (gap_s - usual) < _PLAIN_M:
        return None
    way = float(_way(position, slice(last, first + 1)).sum())
    if way < 0.25 * speed * gap_s and way < 3.0 * max(speeds) * usual + 0.5 * _PLAIN_M:
        return True
    return False if way > 0.5 * speed * gap_s else None


def _way(position: Series, part: slice) -> np.ndarray:
    """Distances of neighbouring positions, m."""
    lat, lon = position.values[part, 0], position.values[part, 1]
    meridian, prime_vertical = WGS84.radii(float(lat[0]))
    east = (np.diff(lon) + np.pi) % (2.0 * np.pi) - np.pi
    return np.hypot(meridian * np.diff(lat), prime_vertical * np.cos(float(lat[0])) * east)
