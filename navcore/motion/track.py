"""Motion `track`: a recorded track, smoothed so that position, velocity and acceleration belong together."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from navcore.foundation.earth import WGS84, Earth
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.parameters import FileName, quantity
from navcore.foundation.stage_cache import kept, recorded_state
from navcore.foundation.text import Text
from navcore.foundation.units import DEG
from navcore.io.column_map import map_field
from navcore.io.recording import MOST_BRIDGED, Window, load, require_cover, require_no_gap, shared_window
from navcore.io.series import LONGEST_REACH_S, Recording, Series, utc_text
from navcore.io.suspects import place_words
from navcore.io.times.set_clocks import gap_doubt
from navcore.motion.base import MotionParameters, Streams
from navcore.motion.filling import sample
from navcore.motion.kinematics import PIECES, Kinematics
from navcore.motion.pieces import (
    PIECE_HEADING,
    PIECE_HEIGHT,
    PIECE_LAT,
    PIECE_LON,
    PIECE_PITCH,
    PIECE_ROLL,
    shared_pieces,
)
from navcore.motion.smoothing import FEWEST_FIXES, Polynomials, Spline, clamped, smoothed_columns
from navcore.motion.static import rest_at
from navcore.motion.truth import COLUMNS, HEIGHT, Site, Truth

OUTLIER_M = 10.0
"""A fix nearer than this to the line between its neighbours is never called an outlier."""
OUTLIER_ACCELERATION = 5.0
"""... nor one that a vehicle within this acceleration (m/s^2) could have reached."""
_MOST_FAULTS = 5
LARGEST_VELOCITY_DIFFERENCE = 0.5
"""Recorded velocities further (median, m/s) from the rate of the positions do not belong to them."""
LONGEST_VELOCITY_GAP_S = 10.0
"""Recorded velocities with longer gaps are not integrated, s."""


class TrackMotion(MotionParameters):
    """The vehicle moves along recorded positions with the recorded heading.

    Positions (and heading, and pitch and roll when recorded) are smoothed by a cubic smoothing spline, which
    passes a motion of angular frequency w by 1 / (1 + (w smoothing_s)^4). Velocity and acceleration are the
    derivatives of the smoothed position, so that the truth is consistent; velocity columns of a table are
    smoothed together with the positions. The vehicle stays level at the
    median recorded height (0 if none is recorded). t = 0 is the first epoch that all streams share.
    """

    recorded: ClassVar[bool] = True
    carries_recorded_imu: ClassVar[bool] = True
    kind: Literal["track"] = "track"
    file: FileName | tuple[FileName, ...] | None = Field(
        default=None,
        description=Text(
            "Recorded positions and heading: NMEA 0183 (RMC or GGA, HDT or VHW), CSV, Parquet or MAT "
            "with lat_deg, lon_deg, heading_deg and utc or t_s. Several files are joined by UTC; "
            "each quantity "
            "comes from the first that holds it."
        ),
        json_schema_extra={"label": Text("track files")},
    )
    map: FileName | None = map_field()
    pitch_deg: float = quantity(
        0.0,
        unit="deg",
        ge=-80.0,
        le=80.0,
        slider=(-30.0, 30.0),
        label=Text("pitch"),
        help=Text("Constant pitch, bow up positive; for recordings without pitch and roll."),
    )
    roll_deg: float = quantity(
        0.0,
        unit="deg",
        ge=-180.0,
        le=180.0,
        slider=(-30.0, 30.0),
        label=Text("roll"),
        help=Text("Constant roll, starboard down positive; for recordings without pitch and roll."),
    )
    smoothing_s: float = quantity(
        5.0,
        unit="s",
        ge=0.0,
        le=600.0,
        slider=(0.0, 60.0),
        label=Text("smoothing"),
        help=Text(
            "Time constant of the smoothing of positions and angles: periods above 2π times this pass."
        ),
    )

    heading_clock_s: float = quantity(
        0.0,
        unit="s",
        ge=-86400.0,
        le=86400.0,
        slider=(-120.0, 120.0),
        label=Text("clock correction of the heading"),
        help=Text("Added to the times of the recorded heading, whose logger has a clock of its own."),
    )

    def recording(self) -> Recording:
        """Files of the track, the clock of the heading put right; raises `InputError` with field ``file``."""
        recording = load(self.file or (), field="file", map_file=self.map)
        if recording.heading is None:
            return recording
        return replace(recording, heading=recording.heading.shifted(self.heading_clock_s))

    def streams(self) -> Streams:
        """Positions and angles of the recording; raises `InputError` if positions or heading are missing."""
        return _streams(self.recording(), self.file)

    def notices(self) -> Iterator[str]:
        """Yield the reader's warnings, gaps that the smoothing bridges, and fields without effect."""
        streams = self.streams()
        yield from streams.recording.warnings
        for series in streams.series():
            count, longest = series.gaps()
            own = streams.recording.position
            doubt = gap_doubt(series, own if own is not None and own.file == series.file else None)
            if doubt:
                yield Text("{source}: {doubt}", source=series.source, doubt=doubt)
            elif count:
                yield Text(
                    "{source}: {count} gaps (longest {longest:.1f} s) bridged by the smoothing",
                    source=series.source,
                    count=count,
                    longest=longest,
                )
        if streams.attitude is not None and (self.pitch_deg or self.roll_deg):
            yield Text("motion.pitch_deg and roll_deg are not used: the recording holds pitch and roll")

    def window(self) -> Window:
        """Time that positions and heading share."""
        return shared_window(self.streams().series())

    def before_start(self, true_row: np.ndarray, duration_s: float) -> MotionParameters:
        """Return rest at the attitude of t = 0."""
        return rest_at(true_row)

    def truth(
        self, count: int, step_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> Truth:
        """Return the smoothed track at ``count`` times; the site is not used.

        Raises
        ------
        InputError
            No position or heading, a fix far off its neighbours, or a run longer than the record.
        """
        return Truth(step_s, self.rows(count, step_s, site, earth, start_utc))

    def rows(
        self, count: int, step_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> np.ndarray:
        """Rows of truth at 0, step_s, ...; shape (count, 15)."""
        del site
        track = self._covering((count - 1) * step_s, start_utc)
        return sample(self._kinematics(track, start_utc, np.arange(count) * step_s), count, step_s, earth)

    def kinematics(
        self, end_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> Kinematics:
        """Return the pieces of the splines; an IMU's few samples beyond the record prolong the last one."""
        del site, earth, end_s
        return self._kinematics(self._smoothed(), start_utc)

    def _kinematics(
        self, track: _Smoothed, start_utc: float | None, times_s: np.ndarray | None = None
    ) -> Kinematics:
        rest = np.zeros(COLUMNS)
        rest[HEIGHT] = track.path.height
        return Kinematics(PIECES, rest, legs=self._pieces(track, start_utc, times_s))

    def _covering(self, span_s: float, start_utc: float | None) -> _Smoothed:
        track = self._smoothed()
        start = track.window.start_s if start_utc is None else start_utc
        require_cover(track.window, start, span_s, Text("the track"), self.file)
        require_no_gap(self.streams().series(), start, span_s, MOST_BRIDGED, self.file)
        return track

    def _pieces(self, track: _Smoothed, start_utc: float | None, times_s: np.ndarray | None) -> np.ndarray:
        """Shared pieces of all splines; t = 0 at ``start_utc``, else at the start of the own window."""
        start = track.window.start_s if start_utc is None else start_utc
        lat, lon = track.path.columns(start)
        splines = {PIECE_LAT: lat, PIECE_LON: lon, PIECE_HEADING: track.heading.column(0, start)}
        constants = {PIECE_HEIGHT: track.path.height}
        if track.attitude is None:
            constants |= {PIECE_PITCH: self.pitch_deg * DEG, PIECE_ROLL: self.roll_deg * DEG}
        else:
            splines[PIECE_PITCH] = track.attitude.column(0, start)
            splines[PIECE_ROLL] = track.attitude.column(1, start)
        return shared_pieces(splines, constants, times_s)

    def _smoothed(self) -> _Smoothed:
        files = (self.file,) if isinstance(self.file, str) else self.file or ()
        key = "smoothed track", recorded_state(self), self
        return kept(key, lambda: smooth_streams(self.streams(), files, self.smoothing_s))


@dataclass(frozen=True)
class _Smoothed:
    """Splines through the streams of one track."""

    window: Window
    path: _Path
    heading: Spline
    attitude: Spline | None


def position_of(recording: Recording, file: object) -> Series:
    """Positions of a recording; raises `InputError` (field ``file``) where there are none."""
    if recording.position is None:
        raise InputError(_missing(file, *_NO_POSITION))
    return recording.position


def _missing(file: object, what: str, remedy: str) -> Fault:
    return Fault(
        "", "file", file, Text("holds no {what}: add a file with {remedy}", what=what, remedy=remedy)
    )


_NO_POSITION = (Text("position"), Text("RMC or GGA sentences or lat_deg and lon_deg"))
_NO_HEADING = (Text("heading"), Text("HDT or VHW sentences or heading_deg"))


def _streams(recording: Recording, file: object) -> Streams:
    if recording.position is None or recording.heading is None:
        streams = ((_NO_POSITION, recording.position), (_NO_HEADING, recording.heading))
        raise InputError(_missing(file, *words) for words, series in streams if series is None)
    return Streams(recording, recording.position, recording.heading, recording.attitude)


def smooth_streams(streams: Streams, files: tuple[str, ...], smoothing_s: float) -> _Smoothed:
    """Fit the splines: 10 h at 1 Hz take most of a second."""
    return _Smoothed(
        shared_window(streams.series()),
        _Path(streams.position, smoothing_s, streams.recording.velocity),
        _angles(streams.heading, smoothing_s),
        None if streams.attitude is None else _angles(streams.attitude, smoothing_s),
    )


def _angles(series: Series, smoothing_s: float) -> Spline:
    return smoothed_columns(series.time_s, np.unwrap(series.values, axis=0), smoothing_s)


class _Path:
    """Smoothed latitude and longitude as functions of UTC."""

    def __init__(self, position: Series, smoothing_s: float, velocity: Series | None = None) -> None:
        if position.time_s.size < FEWEST_FIXES:
            gap = Text("only {size} positions ({source})", size=position.time_s.size, source=position.source)
            raise InputError(
                Fault(
                    "",
                    "file",
                    None,
                    Text("{found}; at least {fewest_fixes} are needed", found=gap, fewest_fixes=FEWEST_FIXES),
                )
            )
        self._origin, self._metres, metres = in_metres(position)
        _refuse_outliers(position, metres)
        self._spline = smoothed_columns(position.time_s, metres, smoothing_s)
        if velocity is not None and velocity.tabled and smoothing_s > 0.0:
            self._spline = self._with_velocity(position, metres, velocity, smoothing_s)
        heights = position.values[np.isfinite(position.values[:, 2]), 2]
        self.height = float(np.median(heights)) if heights.size else 0.0

    def _with_velocity(
        self, position: Series, metres: np.ndarray, velocity: Series, smoothing_s: float
    ) -> Spline:
        """Spline of positions and recorded velocities together; that of the positions where these differ.

        The smoothed velocity is integrated, and only the rest of the positions is smoothed. At the ends of
        the record a spline of positions alone knows no acceleration: its velocity is off by about the
        acceleration times the smoothing time, 0.1 m/s in a turn. (A receiver's own sentences are printed too
        coarsely for this, and follow the roll of the antenna.)
        """
        times = position.time_s
        reach = max(LONGEST_REACH_S, 2.0 * velocity.interval_s)
        kept = velocity.valid
        if np.count_nonzero(kept) < FEWEST_FIXES or velocity.dated != position.dated:
            return self._spline
        known = velocity.time_s[kept]
        covers = known[0] <= times[0] + reach and known[-1] >= times[-1] - reach
        if not covers or np.diff(known).max() > max(LONGEST_VELOCITY_GAP_S, 2.0 * smoothing_s):
            return self._spline
        smooth = smoothed_columns(
            known, self._in_metres(velocity.values[kept, :2], known, position), smoothing_s
        )
        moved, speed = smooth.integral(times), smooth.at(times)
        rest = smoothed_columns(times, metres - moved, smoothing_s)
        differing = np.median(np.abs(speed - self._spline.rate(times)), axis=0).max()
        if differing > LARGEST_VELOCITY_DIFFERENCE:
            return self._spline
        ends = (speed + rest.rate(times))[[0, -1]]
        return clamped(times, moved + rest.at(times), ends)

    def _in_metres(self, velocity: np.ndarray, time_s: np.ndarray, position: Series) -> np.ndarray:
        """Rates of the two coordinates of the path (north, east at the first fix) of velocities E, N."""
        lat = np.interp(time_s, position.time_s, position.values[:, 0])
        # M goes with w^-1.5, N with w^-0.5, w = 1 - e^2 sin^2 L.
        w = (1.0 - WGS84.e2 * np.sin(lat) ** 2) / (1.0 - WGS84.e2 * np.sin(self._origin[0]) ** 2)
        shorter = np.sqrt(w) * np.cos(self._origin[0]) / np.cos(lat)
        return np.column_stack([velocity[:, 1] * w**1.5, velocity[:, 0] * shorter])

    def columns(self, start_s: float) -> Iterator[Polynomials]:
        """Latitude and longitude (rad) as functions of the time since ``start_s``."""
        for j in range(2):
            breaks, coefficients = self._spline.column(j, start_s)
            coefficients = coefficients / self._metres[j]
            coefficients[3] += self._origin[j]
            yield breaks, coefficients


def in_metres(position: Series) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Fixes as north and east of the first one, with that one (rad) and the metres of a radian of each."""
    lat, lon = position.values[:, 0], np.unwrap(position.values[:, 1])
    origin = np.array([lat[0], lon[0]])
    meridian, prime_vertical = WGS84.radii(lat[0])
    radii = np.array([meridian, prime_vertical * np.cos(lat[0])])
    return origin, radii, (np.column_stack([lat, lon]) - origin) * radii


def outliers(position: Series, metres: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Find fixes that lie off the line between their neighbours by more than a vehicle can move.

    Parameters
    ----------
    position : Series
        Fixes.
    metres : ndarray, shape (n, 2)
        The same in metres.

    Returns
    -------
    places : ndarray of int
        Of the fixes; the worst of each neighbourhood, for one bad fix also throws its neighbours off.
    distance : ndarray, shape (places,)
        From the line, m.
    """
    before, after = np.diff(position.time_s)[:-1], np.diff(position.time_s)[1:]
    share = (before / (before + after))[:, None]
    distance = np.hypot(*(metres[1:-1] - metres[:-2] - share * (metres[2:] - metres[:-2])).T)
    reachable = np.maximum(OUTLIER_M, 0.5 * OUTLIER_ACCELERATION * before * after)
    excess = np.where(distance > reachable, distance / reachable, 0.0)
    padded = np.pad(excess, 1)
    worst = np.flatnonzero((excess > 0.0) & (excess >= padded[:-2]) & (excess >= padded[2:]))
    return worst + 1, distance[worst]


def _refuse_outliers(position: Series, metres: np.ndarray) -> None:
    """Refuse fixes that lie off the line between their neighbours by more than a vehicle can move."""
    worst, distance = outliers(position, metres)
    if worst.size == 0:
        return
    if words := place_words(position):
        raise InputError([Fault("", "file", position.source, one) for one in words])
    faults = [
        Fault(
            "",
            "file",
            position.source,
            Text(
                "the position at {utc_text} lies {distance:.0f} m off its neighbours: leave it out",
                utc_text=utc_text(float(position.time_s[place])),
                distance=far,
            ),
        )
        for place, far in zip(worst[:_MOST_FAULTS], distance, strict=False)
    ]
    if worst.size > _MOST_FAULTS:
        faults.append(
            Fault(
                "",
                "file",
                position.source,
                Text("and {size} more such positions", size=worst.size - _MOST_FAULTS),
            )
        )
    raise InputError(faults)
