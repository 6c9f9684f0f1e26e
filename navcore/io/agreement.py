"""Whether a speed log and a heading agree with the motion over ground: scale, sign, and clocks that lag.

A log's scale cannot be told from a current while the ship keeps its course. When it turns, the current keeps
its direction: scale and current come from least squares together. Without a heading a log's clock is told by
the changes of its speed, and nothing else of it (`navcore.io.clocks`).
"""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from navcore.foundation.earth import WGS84
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR, KNOT
from navcore.io.clocks import Lag, lag_between
from navcore.io.courses import SPEED_SLIPS, Way, under_way
from navcore.io.plausible import slip_of
from navcore.io.series import Recording

LARGEST_SCALE_ERROR = 0.07
"""Of a log whose scale is known well; units differ by 10 % and more."""
SHORTEST_LAG_S = 8.0
"""A ship's course follows its heading, and a log smooths its speed, by several seconds; less is not told."""
_FEWEST = 60
_MOST = 400
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
_LEAST_SPEED_MPS = 0.15
_LEG_S = 10.0
"""Between the positions that give a velocity."""
M2_S = 12.4206 * HOUR
"""Period of the principal lunar tide."""
_TIDAL_S = 3.0 * HOUR
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
        return _late("water", _WORDS[0], _speed_lag(recording))
    heading_s, heading = recording.heading.time_s, np.unwrap(recording.heading.values[:, 0])
    course = np.unwrap(np.arctan2(way.east, way.north))
    lag = lag_between(heading_s, heading, way.time_s, course[:, None])
    return _late("heading", Text("the heading"), lag) or _of_log(recording, way, heading_s, heading)


def clock_text(recording: Recording) -> str:
    """Time by which a log without a heading is late by the changes of its speed, or why it cannot be told."""
    if recording.water is None or recording.heading is not None or under_way(recording) is None:
        return ""
    lag = _speed_lag(recording)
    if lag is None:
        return ""
    ground = _ground(recording)
    change = 0.0 if ground is None else float(np.std(np.hypot(ground.east, ground.north)))
    if not lag.related and change < _LEAST_SPEED_MPS:
        return Text(
            "the log's clock cannot be told without a heading: the speed over ground changes by {change:.2f} "
            "m/s (rms), at least {least} are needed",
            change=change,
            least=_LEAST_SPEED_MPS,
        )
    if not lag.related:
        return Text(
            "the log's clock cannot be told without a heading: its speed and that over ground do not change "
            "together"
        )
    return Text(
        "the log is {lag:+.1f} s (± {reach:.1f} s) late by the changes of its speed",
        lag=lag.late_s,
        reach=lag.reach_s,
    )


def _speed_lag(recording: Recording) -> Lag | None:
    """Lag of the speed through the water against that over ground; None without both."""
    ground = _ground(recording)
    if recording.water is None or ground is None:
        return None
    kept = recording.water.valid
    speed = np.hypot(*recording.water.values[kept].T)
    return lag_between(
        recording.water.time_s[kept], speed, ground.time_s, np.hypot(ground.east, ground.north)[:, None]
    )


def _forward_lag(recording: Recording, heading_s: np.ndarray, heading: np.ndarray) -> Lag | None:
    """Lag of the speed forward against that over ground, with a current and a tide that are not known."""
    ground = _ground(recording)
    if recording.water is None or ground is None:
        return None
    kept = recording.water.valid
    inside = (ground.time_s >= heading_s[0]) & (ground.time_s <= heading_s[-1])
    time_s = ground.time_s[inside]
    if time_s.size < _FEWEST:
        return None
    angle = np.interp(time_s, heading_s, heading)
    sine, cosine = np.sin(angle), np.cos(angle)
    columns = [ground.east[inside] * sine + ground.north[inside] * cosine, sine, cosine]
    if time_s[-1] - time_s[0] > _TIDAL_S:
        phase = 2.0 * np.pi * (time_s - time_s[0]) / M2_S
        columns += [axis * wave for axis in (sine, cosine) for wave in (np.sin(phase), np.cos(phase))]
    water = recording.water
    return lag_between(water.time_s[kept], water.values[kept, 1], time_s, np.column_stack(columns))


def _ground(recording: Recording) -> Way | None:
    """Velocity over ground at its full rate and at any speed; by positions over some seconds without it."""
    velocity, position = recording.velocity, recording.position
    if velocity is not None and np.count_nonzero(velocity.valid) >= _FEWEST:
        return Way(velocity.time_s[velocity.valid], *velocity.values[velocity.valid].T)
    if position is None or np.count_nonzero(position.valid) < _FEWEST:
        return None
    time_s, values = position.time_s[position.valid], position.values[position.valid]
    apart = max(1, round(_LEG_S / max(position.interval_s, 1e-3)))
    if time_s.size <= apart + _FEWEST:
        return None
    lat, lon = values[:, 0], np.unwrap(values[:, 1])
    meridian, prime_vertical = WGS84.radii(float(np.median(lat)))
    steps = time_s[apart:] - time_s[:-apart]
    north = (lat[apart:] - lat[:-apart]) * meridian / steps
    east = (lon[apart:] - lon[:-apart]) * prime_vertical * np.cos(lat[:-apart]) / steps
    whole = steps < 2.0 * apart * position.interval_s
    return Way(*(column[whole] for column in (time_s[:-apart] + 0.5 * steps, east, north)))


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

    def fit() -> tuple[np.ndarray, np.ndarray]:
        """Factors of the speeds and their deviations."""
        inside = np.flatnonzero((time_s >= begin) & (time_s <= end))
        inside = inside[:: max(1, inside.size // _MOST)]
        if inside.size < _FEWEST:
            return np.ones(len(used)), np.full(len(used), np.inf)
        at = time_s[inside]
        angle = np.interp(at, heading_s, heading)
        sine, cosine, one, none = np.sin(angle), np.cos(angle), np.ones(at.size), np.zeros(at.size)
        axes = {1: (sine, cosine), 0: (cosine, -sine)}
        columns = [np.concatenate([speeds[inside, k] * part for part in axes[k]]) for k in used]
        design = np.column_stack([*columns, np.concatenate([one, none]), np.concatenate([none, one])])
        ground = np.concatenate([np.interp(at, way.time_s, way.east), np.interp(at, way.time_s, way.north)])
        size = np.linalg.norm(design, axis=0)
        if not size.all() or np.linalg.cond(design / size) > _WORST_CONDITION:
            return np.ones(len(used)), np.full(len(used), np.inf)
        found, _, _, _ = np.linalg.lstsq(design, ground, rcond=None)
        left = float(np.std(ground - design @ found))
        spread = left * np.sqrt(_ALIKE * np.diag(np.linalg.inv(design.T @ design)))
        return found[: len(used)], spread[: len(used)]

    if late := _late("water", _WORDS[0], _forward_lag(recording, heading_s, heading)):
        return late
    factors, spread = fit()
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


def _late(stream: str, what: str, lag: Lag | None) -> list[Finding]:
    """Tell the time by which a stream is late, where the likelihood of its fast changes says so."""
    if lag is None or not lag.shifted or abs(lag.late_s) < SHORTEST_LAG_S:
        return []
    late_s = round(lag.late_s, 1)
    told = Text(
        "{what} is {lag:+.1f} s (± {reach:.1f} s) late against the motion over ground: clocks of two "
        "loggers? Shift its times",
        what=what,
        lag=late_s,
        reach=lag.reach_s,
    )
    return [Finding(told, stream, late_s=late_s)]
