"""Whether a speed log and a heading agree with the motion over ground: scale, sign, and clocks that lag.

A log's scale cannot be told from a current while the ship keeps its course. When it turns, the current keeps
its direction: scale and current come from least squares together. Without a heading a log's clock is told by
the changes of its speed, and nothing else of it.
"""

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import numpy as np

from navcore.foundation.text import Text
from navcore.foundation.units import DEG, KNOT
from navcore.io.courses import SPEED_SLIPS, Way, under_way
from navcore.io.plausible import slip_of
from navcore.io.series import Recording, Series

LARGEST_SCALE_ERROR = 0.07
"""Of a log whose scale is known well; units differ by 10 % and more."""
SHORTEST_LAG_S = 12.0
"""A ship's course follows its heading by several seconds; a clock that is off by less is not told."""
_FEWEST = 60
_MOST = 400
_WIDEST_LAG_S = 3700.0
_SHARE = 1.0 / 3.0
"""Of the time that two streams share, by which they are shifted at most."""
_SURE = 4.0
_KNOWN = 0.05
"""Share of a factor up to which it may be unsure; tides and a straight course leave it unsure by more."""
_LEAST_FACTOR = 0.3
"""A factor below, or above its inverse, is offered only where a unit has it."""
_FAR_UNITS = {
    1e3: Text("m/s taken for mm/s, or the reverse"),
    1e-3: Text("m/s taken for mm/s, or the reverse"),
    1e2: Text("m/s taken for cm/s, or the reverse"),
    1e-2: Text("m/s taken for cm/s, or the reverse"),
    100.0 * KNOT: Text("knots taken for cm/s, or the reverse"),
    0.01 / KNOT: Text("knots taken for cm/s, or the reverse"),
    10.0: Text("tenths of the unit"),
    0.1: Text("tenths of the unit"),
}
"""By the speed that is given over the true one."""
_WORST_CONDITION = 30.0
_ALIKE = 30
"""Samples whose residuals are taken for one: currents and steering change slowly."""
_BETTER = 0.5
_LEAST_TURN = 2.0 * DEG
_LEAST_SPEED_MPS = 0.15
_WORDS = (Text("the speed through the water"), Text("the speed to starboard through the water"))


class Finding(NamedTuple):
    """Offset of a stream.

    Attributes
    ----------
    text : str
        What is told.
    stream : str
        ``heading`` or ``water``.
    late_s : float
        Time by which it is late; 0 where its scale is wrong.
    factor : float
        By which its speed forward is to be multiplied; 1 where its times, or another axis, are wrong.
    """

    text: str
    stream: str
    late_s: float = 0.0
    factor: float = 1.0


def agreement_warnings(recording: Recording) -> list[str]:
    """Say by which factor or time a log or a heading is off the motion over ground; see `findings`."""
    return [one.text for one in findings(recording)]


def findings(recording: Recording) -> list[Finding]:
    """By which factor or time a log or a heading is off the motion over ground.

    Parameters
    ----------
    recording : Recording
        With positions or velocity under way, and heading or speed through the water, of one file or joined of
        several.
    """
    way = under_way(recording)
    if way is None or way.time_s.size < _FEWEST:
        return []
    if recording.heading is None:
        speeds = _of_speeds(recording.water, way)
        return [] if speeds is None else _lagging("water", _WORDS[0], speeds[0], _LEAST_SPEED_MPS, speeds[1])
    heading_s, heading = recording.heading.time_s, np.unwrap(recording.heading.values[:, 0])
    course = np.unwrap(np.arctan2(way.east, way.north))
    found = _lagging(
        "heading",
        Text("the heading"),
        lambda lag: _turning(heading_s, heading, way.time_s, course, lag),
        _LEAST_TURN,
        min(heading_s[-1], way.time_s[-1]) - max(heading_s[0], way.time_s[0]),
    )
    return found or _of_log(recording, way, heading_s, heading)


def clock_text(recording: Recording) -> str:
    """Time by which a log without a heading is late by the changes of its speed, or why it cannot be told."""
    way = under_way(recording)
    speeds = None if way is None or recording.heading is not None else _of_speeds(recording.water, way)
    if speeds is None:
        return ""
    misfit, span_s = speeds
    if not misfit(np.inf) > _LEAST_SPEED_MPS:
        return Text(
            "the log's clock cannot be told without a heading: the speed over ground changes by {change:.2f} "
            "m/s (rms), at least {least} are needed",
            change=misfit(np.inf),
            least=_LEAST_SPEED_MPS,
        )
    lag_s, reach_s, left = _shift(misfit, misfit(np.inf), span_s)
    if left > _BETTER * misfit(np.inf):
        return Text(
            "the log's clock cannot be told without a heading: its speed and that over ground do not change "
            "together"
        )
    return Text(
        "the log is {lag:+.0f} s (± {reach:.0f} s) late by the changes of its speed", lag=lag_s, reach=reach_s
    )


def _of_speeds(water: Series | None, way: Way) -> tuple[Callable[[float], float], float] | None:
    """Rest of the changes over ground that the speed through the water leaves, m/s, by the time it is late.

    And the time that both share, s. Each shift leaves its share of what changes while both are there, so that
    a steady part does not fit by itself. A log that is infinitely late says nothing: all changes are left.
    """
    kept = np.flatnonzero(water.valid) if water is not None else np.array([], dtype=int)
    if water is None or kept.size < _FEWEST or way.time_s.size < _FEWEST:
        return None
    time_s, speed = water.time_s[kept], np.hypot(*water.values[kept].T)
    ground = np.hypot(way.east, way.north)
    changes = float(np.std(ground))

    def misfit(lag_s: float) -> float:
        if np.isinf(lag_s):
            return changes
        inside = np.flatnonzero((time_s - lag_s >= way.time_s[0]) & (time_s - lag_s <= way.time_s[-1]))
        inside = inside[:: max(1, inside.size // _MOST)]
        if inside.size < _FEWEST:
            return np.inf
        over = np.interp(time_s[inside] - lag_s, way.time_s, ground)
        own = speed[inside] - speed[inside].mean()
        sizes = np.linalg.norm(own) * np.linalg.norm(over - over.mean())
        alike = max(float(own @ over / sizes), 0.0) if sizes > 0.0 else 0.0
        return changes * np.sqrt(max(1.0 - alike**2, 0.0))

    return misfit, float(min(time_s[-1], way.time_s[-1]) - max(time_s[0], way.time_s[0]))


def _of_log(recording: Recording, way: Way, heading_s: np.ndarray, heading: np.ndarray) -> list[Finding]:
    water = recording.water
    if water is None:
        return []
    kept = np.flatnonzero(water.valid)
    if kept.size < _FEWEST:
        return []
    time_s, speeds = water.time_s[kept], water.values[kept]
    used = [1, 0] if np.abs(speeds[:, 0]).max() > 0.0 else [1]
    begin, end = max(way.time_s[0], heading_s[0]), min(way.time_s[-1], heading_s[-1])

    def fit(lag_s: float) -> tuple[np.ndarray, np.ndarray, float]:
        """Factors of the speeds, their deviations, and the rms of what is left, m/s."""
        inside = np.flatnonzero((time_s - lag_s >= begin) & (time_s - lag_s <= end))
        inside = inside[:: max(1, inside.size // _MOST)]
        if inside.size < _FEWEST:
            return np.ones(len(used)), np.full(len(used), np.inf), np.inf
        at = time_s[inside] - lag_s
        angle = np.interp(at, heading_s, heading)
        sine, cosine, one, none = np.sin(angle), np.cos(angle), np.ones(at.size), np.zeros(at.size)
        axes = {1: (sine, cosine), 0: (cosine, -sine)}
        columns = [np.concatenate([speeds[inside, k] * part for part in axes[k]]) for k in used]
        design = np.column_stack([*columns, np.concatenate([one, none]), np.concatenate([none, one])])
        ground = np.concatenate([np.interp(at, way.time_s, way.east), np.interp(at, way.time_s, way.north)])
        size = np.linalg.norm(design, axis=0)
        if not size.all() or np.linalg.cond(design / size) > _WORST_CONDITION:
            return np.ones(len(used)), np.full(len(used), np.inf), np.inf
        found, _, _, _ = np.linalg.lstsq(design, ground, rcond=None)
        left = float(np.std(ground - design @ found))
        spread = left * np.sqrt(_ALIKE * np.diag(np.linalg.inv(design.T @ design)))
        return found[: len(used)], spread[: len(used)], left

    span_s = min(end, time_s[-1]) - max(begin, time_s[0])
    if late := _lagging("water", _WORDS[0], lambda lag: fit(lag)[2], _LEAST_SPEED_MPS, span_s):
        return late
    factors, spread, _ = fit(0.0)
    return list(_scales(factors, spread))


def _scales(factors: np.ndarray, spread: np.ndarray) -> Iterable[Finding]:
    for what, factor, deviation in zip(_WORDS, factors, spread, strict=False):
        known = deviation < _KNOWN * max(abs(factor), 1.0)
        if not known or abs(factor - 1.0) <= max(LARGEST_SCALE_ERROR, _SURE * deviation):
            continue
        slip = slip_of(1.0 / factor, SPEED_SLIPS | _FAR_UNITS, LARGEST_SCALE_ERROR) if factor > 0.0 else ""
        if not slip and not _LEAST_FACTOR <= abs(factor) <= 1.0 / _LEAST_FACTOR:
            told = Text(
                "{what} agrees with the motion over ground by no factor that a unit or a sign would "
                "explain: is it "
                "another quantity, or does the log or the heading fail?",
                what=what,
            )
            yield Finding(told, "water")
            continue
        slip = slip or (Text("a wrong unit or scale") if factor > 0.0 else Text("the wrong sign"))
        told = Text(
            "{what} agrees with the motion over ground when it is multiplied by {factor:.3g} "
            "± {deviation:.2g} (a steady current is taken off): {slip}?",
            what=what,
            factor=float(factor),
            deviation=float(deviation),
            slip=slip,
        )
        yield Finding(told, "water", factor=float(factor) if what == _WORDS[0] else 1.0)


def _turning(
    heading_s: np.ndarray, heading: np.ndarray, time_s: np.ndarray, course: np.ndarray, lag_s: float
) -> float:
    """Deviation of heading minus course, rad, when the heading's times are ``lag_s`` too late."""
    inside = np.flatnonzero((time_s + lag_s >= heading_s[0]) & (time_s + lag_s <= heading_s[-1]))
    inside = inside[:: max(1, inside.size // _MOST)]
    if inside.size < _FEWEST:
        return np.inf
    off = np.interp(time_s[inside] + lag_s, heading_s, heading) - course[inside]
    middle = np.angle(np.mean(np.exp(1j * off)))
    return float(np.sqrt(np.mean(((off - middle + np.pi) % (2.0 * np.pi) - np.pi) ** 2)))


def _lagging(
    stream: str, what: str, misfit: Callable[[float], float], least: float, span_s: float
) -> list[Finding]:
    """Tell the time by which a stream is late, if shifted by it the stream fits twice as well."""
    now = misfit(0.0)
    if not least < now < np.inf:
        return []
    lag_s, reach_s, left = _shift(misfit, now, span_s)
    if abs(lag_s) < SHORTEST_LAG_S or left > _BETTER * now:
        return []
    late_s = _refined(misfit, lag_s, _step(span_s))
    told = Text(
        "{what} is {lag:+.0f} s (± {reach:.0f} s) late against the motion over ground: clocks of two "
        "loggers? Shift its times",
        what=what,
        lag=late_s,
        reach=reach_s,
    )
    return [Finding(told, stream, late_s=late_s)]


def _step(span_s: float) -> float:
    return max(2.0, min(_WIDEST_LAG_S, _SHARE * span_s) / 100.0)


def _shift(misfit: Callable[[float], float], now: float, span_s: float) -> tuple[float, float, float]:
    """Time on a grid that fits best, by how much it is unsure, and what it leaves."""
    step = _step(span_s)
    count = int(min(_WIDEST_LAG_S, _SHARE * span_s) / step)
    lags = step * np.arange(-count, count + 1)
    sizes = np.array([misfit(float(lag)) for lag in lags])
    best = int(np.argmin(sizes))
    near = lags[sizes <= sizes[best] + 0.1 * (now - sizes[best])]
    return float(lags[best]), 0.5 * float(np.ptp(near)) + step, float(sizes[best])


def _refined(misfit: Callable[[float], float], lag_s: float, step_s: float) -> float:
    """Time within a step of one on the grid that fits best, to whole seconds."""
    from scipy.optimize import minimize_scalar

    near = (lag_s - step_s, lag_s + step_s)
    found: Any = minimize_scalar(misfit, bounds=near, method="bounded", options={"xatol": 0.25})
    return float(round(found.x))
