"""Whether heading, course, speed and positions of a recording agree; the likely slip of one that does not."""

from typing import NamedTuple

import numpy as np

from navcore.foundation.earth import WGS84
from navcore.foundation.text import Text
from navcore.foundation.units import DEG, KNOT
from navcore.io.plausible import KNOT_SLIPS, MOST_LEGS, slip_of
from navcore.io.series import Recording, Series

LARGEST_DRIFT = 45.0 * DEG
"""A heading that is farther from the course, as a median, is told."""
LARGEST_COURSE_ERROR = 20.0 * DEG
"""... and a course over ground that is farther from the track."""
LARGEST_SPEED_SHARE = 0.06
"""... and a speed over ground that differs from the track's by more of the larger one."""
_NEAR = 15.0 * DEG
_SLOWEST_MPS = 1.0
_STILL_MPS = 1e-6
_LEAST_OFF_MPS = 0.3
"""Positions and speeds are printed coarsely."""
_LEG_S = 10.0
_FEWEST_LEGS = 8
"""Of a short recording, whose legs are shorter."""
_FEWEST = 3
_RATIO_SLIP = 0.08


class Way(NamedTuple):
    """Times (s) and velocity over ground (m/s, E and N) while under way."""

    time_s: np.ndarray
    east: np.ndarray
    north: np.ndarray


def course_warnings(recording: Recording) -> list[str]:
    """Say that heading or course, speed and positions contradict each other, and by which slip if one fits.

    Parameters
    ----------
    recording : Recording
        With positions or velocity under way; else nothing is said.
    """
    legs, velocity = legs_of(recording.position), _velocity(recording.velocity)
    track = None if legs is None else _moving(legs, np.ones(legs.time_s.size, dtype=bool))
    words: list[str] = []
    if legs is not None and velocity is not None and recording.velocity is not None:
        # Positions in radians hardly move: legs of any speed count.
        words += _speeds(recording.velocity, legs)
    if track is not None and velocity is not None and recording.velocity is not None:
        words += _angles(
            Text("the course over ground"), recording.velocity.time_s,
            np.arctan2(*recording.velocity.values.T), track, LARGEST_COURSE_ERROR,
        )  # fmt: skip
    way = track or velocity
    if recording.heading is not None and way is not None:
        heading = recording.heading
        angle = heading.values[:, 0]
        words += _angles(Text("the heading"), heading.time_s, angle, way, LARGEST_DRIFT)
    return words


def under_way(recording: Recording) -> Way | None:
    """Velocity over ground while under way: the recorded one, else that of the positions."""
    way = _velocity(recording.velocity)
    if way is not None:
        return way
    legs = legs_of(recording.position)
    return None if legs is None else _moving(legs, np.ones(legs.time_s.size, dtype=bool))


def legs_of(position: Series | None) -> Way | None:
    """Velocity of legs of 10 s between positions that share none of the gaps, at any speed."""
    if position is None or position.time_s.size < _FEWEST:
        return None
    time_s = position.time_s
    span_s = float(np.ptp(time_s))
    leg_s = max(min(_LEG_S, span_s / _FEWEST_LEGS), position.interval_s, span_s / MOST_LEGS)
    starts = np.searchsorted(time_s, np.arange(time_s[0], time_s[-1], leg_s))
    starts = np.unique(starts[starts < time_s.size])
    lat, lon = position.values[starts, 0], np.unwrap(position.values[starts, 1])
    steps = np.diff(time_s[starts])
    if steps.size < _FEWEST:
        return None
    meridian, prime_vertical = WGS84.radii(float(np.median(lat)))
    east, north = np.diff(lon) * prime_vertical * np.cos(lat[:-1]) / steps, np.diff(lat) * meridian / steps
    whole = steps < 3.0 * leg_s
    return Way(*(values[whole] for values in (time_s[starts][:-1] + 0.5 * steps, east, north)))


def _velocity(velocity: Series | None) -> Way | None:
    if velocity is None:
        return None
    return _moving(Way(velocity.time_s, *velocity.values.T), velocity.valid)


def _moving(way: Way, usable: np.ndarray) -> Way | None:
    kept = usable & (np.hypot(way.east, way.north) > _SLOWEST_MPS)
    if np.count_nonzero(kept) < _FEWEST:
        return None
    return Way(*(values[kept] for values in way))


def _nearest(time_s: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    after = np.clip(np.searchsorted(time_s, wanted), 1, max(time_s.size - 1, 1))
    after = np.minimum(after, time_s.size - 1)
    before = np.maximum(after - 1, 0)
    return np.where(wanted - time_s[before] < time_s[after] - wanted, before, after)


def _beside(time_s: np.ndarray, way: Way) -> tuple[np.ndarray, np.ndarray] | None:
    """Samples nearest to those of the way that have one within a leg, and which of the way these are."""
    near = _nearest(time_s, way.time_s)
    close = np.abs(time_s[near] - way.time_s) <= _LEG_S
    return (near[close], close) if np.count_nonzero(close) >= _FEWEST else None


def _angles(what: str, time_s: np.ndarray, angle: np.ndarray, way: Way, most: float) -> list[str]:
    beside = _beside(time_s, way)
    if beside is None:
        return []
    near, close = beside
    told, course = angle[near], np.arctan2(way.east, way.north)[close]
    off = angle_off(told, course)
    turned = np.rad2deg(told % (2.0 * np.pi))
    # From 0 to 2 pi, or from -pi to pi.
    radians = any(
        np.abs((np.rad2deg(angle) + turn) % 360.0 - turn).max() <= 2.0 * np.pi + 0.01 for turn in (0.0, 180.0)
    )
    plainly_radians = radians and off > _NEAR and angle_off(_signed_degrees(told), course) < 0.2 * off
    if off <= most and not plainly_radians:
        return []
    slips = (
        (Text("radians taken for degrees"), radians, _signed_degrees(told), course),
        (Text("tenths of a degree taken for degrees"), True, 0.1 * np.deg2rad(turned), course),
        (Text("the wrong sign of the angle or of the longitude"), True, -told, course),
        (Text("the wrong sign (hemisphere) of the latitude"), True, told, np.pi - course),
        (Text("the opposite direction"), True, told + np.pi, course),
        (Text("east and north exchanged"), True, 0.5 * np.pi - told, course),
    )  # fmt: skip
    # A steady course leaves several open.
    likely = [name for name, able, mended, to in slips if able and angle_off(mended, to) < _NEAR]
    reason = Text.joined(Text(" or "), likely) if likely else Text("a wrong unit, sign or zero")
    return [
        Text(
            "{what} (median {told:.1f}°) is {off:.0f}° from the course of the track: {reason}?",
            what=what,
            told=float(np.median(turned)),
            off=off / DEG,
            reason=reason,
        )
    ]


def _signed_degrees(angle: np.ndarray) -> np.ndarray:
    """Degrees from -180 to 180 of angles, which are the radians that were taken for degrees."""
    return (np.rad2deg(angle) + 180.0) % 360.0 - 180.0


def angle_off(angle: np.ndarray, course: np.ndarray) -> float:
    """Median size of the difference of two angles, rad; arrays of shape (n,)."""
    return float(np.median(np.abs((angle - course + np.pi) % (2.0 * np.pi) - np.pi)))


SPEED_SLIPS = KNOT_SLIPS | {
    3.6: Text("m/s taken for km/h, or the reverse"),
    1.0 / 3.6: Text("m/s taken for km/h, or the reverse"),
    1.852: Text("knots taken for km/h, or the reverse"),
    1.0 / 1.852: Text("knots taken for km/h, or the reverse"),
    1.0 / DEG: Text("positions in radians"),
    1.1508: Text("knots taken for mph, or the reverse"),
    1.0 / 1.1508: Text("knots taken for mph, or the reverse"),
}
"""By the speed that is given over the speed of the track."""


def _speeds(velocity: Series, track: Way) -> list[str]:
    beside = _beside(velocity.time_s, track)
    if beside is None:
        return []
    near, close = beside
    given = float(np.median(np.hypot(*velocity.values[near].T)))
    moved = float(np.median(np.hypot(track.east, track.north)[close]))
    if abs(given - moved) <= max(_LEAST_OFF_MPS, LARGEST_SPEED_SHARE * max(given, moved)):
        return []
    slip = slip_of(given / max(moved, _STILL_MPS), SPEED_SLIPS, _RATIO_SLIP) or Text("a wrong unit or scale")
    return [
        Text(
            "the speed over ground (median {given:.1f} kn, {source}) is not that of the positions "
            "({moved:.1f} kn): {reason}?",
            given=given / KNOT,
            source=velocity.source,
            moved=moved / KNOT,
            reason=slip,
        )
    ]
