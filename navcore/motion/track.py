"""Motion `track`: a recorded track, smoothed so that position, velocity and acceleration belong together."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
from pydantic import Field

from navcore.earth import WGS84, Earth
from navcore.errors import Fault, InputError
from navcore.io.recording import FileKey, Window, file_keys, load, require_cover, shared_window
from navcore.io.series import Recording, Series, utc_text
from navcore.motion.base import COLUMNS, HEIGHT, LAT, LON, MotionParameters, Site, Truth
from navcore.motion.kinematics import TRACK, Kinematics
from navcore.motion.pieces import (
    PIECE_HEADING,
    PIECE_LAT,
    PIECE_LON,
    PIECE_PITCH,
    PIECE_ROLL,
    sample_track,
    shared_pieces,
)
from navcore.parameters import FileName, quantity
from navcore.units import DEG

FEWEST_FIXES = 5
OUTLIER_M = 10.0
"""A fix nearer than this to the line between its neighbours is never called an outlier."""
OUTLIER_ACCELERATION = 5.0
"""... nor one that a vehicle within this acceleration (m/s^2) could have reached."""
_MOST_FAULTS = 5
Polynomials = tuple[np.ndarray, np.ndarray]
"""Breakpoints (n + 1,) and coefficients (4, n), highest power first."""


@dataclass(frozen=True)
class Streams:
    """What a track needs of a recording: positions, heading, and pitch and roll if recorded."""

    position: Series
    heading: Series
    attitude: Series | None

    def series(self) -> list[Series]:
        """All streams there are."""
        return [s for s in (self.position, self.heading, self.attitude) if s is not None]


class TrackMotion(MotionParameters):
    """The vehicle moves along recorded positions with the recorded heading.

    Positions (and heading, and pitch and roll when recorded) are smoothed by a cubic smoothing spline, which
    passes a motion of angular frequency w by 1 / (1 + (w smoothing_s)^4). Velocity and acceleration are the
    derivatives of the smoothed position, so that the truth is consistent. The vehicle stays level at the
    median recorded height (0 if none is recorded). t = 0 is the first epoch that all streams share.
    """

    kind: Literal["track"] = "track"
    file: FileName | tuple[FileName, ...] | None = Field(
        default=None,
        description="Recorded positions and heading: NMEA 0183 (RMC or GGA, HDT or VHW), CSV, Parquet or MAT "
        "with lat_deg, lon_deg, heading_deg and utc or t_s. Several files are joined by UTC; each quantity "
        "comes from the first that holds it.",
        json_schema_extra={"label": "track files"},
    )
    pitch_deg: float = quantity(
        0.0, unit="deg", ge=-80.0, le=80.0, slider=(-30.0, 30.0), label="pitch",
        help="Constant pitch, bow up positive; for recordings without pitch and roll.",
    )  # fmt: skip
    roll_deg: float = quantity(
        0.0, unit="deg", ge=-180.0, le=180.0, slider=(-30.0, 30.0), label="roll",
        help="Constant roll, starboard down positive; for recordings without pitch and roll.",
    )  # fmt: skip
    smoothing_s: float = quantity(
        5.0, unit="s", ge=0.0, le=600.0, slider=(0.0, 60.0), label="smoothing",
        help="Time constant of the smoothing of positions and angles: periods above 2 pi times this pass.",
    )  # fmt: skip

    def recording(self) -> Recording:
        """Read (or take from the cache) the files; raises `InputError` with field ``file``."""
        return load(self.file or (), field="file")

    def streams(self) -> Streams:
        """Positions and angles of the recording; raises `InputError` if positions or heading are missing."""
        return _streams(self.recording(), self.file)

    def window(self) -> Window:
        """Time that positions and heading share."""
        return shared_window(self.streams().series())

    @property
    def recorded_span_s(self) -> float:
        """Length of the recorded track, s."""
        return self.window().span_s

    def recorded_start(self, start_utc: float | None = None) -> Site:
        """Smoothed position at t = 0 (``start_utc``, else the start of the own window)."""
        track = self._smoothed()
        row = sample_track(self._pieces(track, start_utc), 1, 1.0, track.path.height, WGS84.e2)[0]
        return Site(float(row[LAT]), float(row[LON]), track.path.height)

    def truth(
        self, count: int, step_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> Truth:
        """Return the smoothed track at ``count`` times; the site is not used.

        Parameters
        ----------
        count, step_s, site, earth
            As for every motion.
        start_utc : float, optional
            UTC (s) of t = 0 when another recording shares it; default: start of the own window.

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
        return sample_track(self._pieces(track, start_utc), count, step_s, track.path.height, earth.e2)

    def kinematics(
        self, end_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> Kinematics:
        """Return the pieces of the splines; an IMU's few samples beyond the record prolong the last one."""
        del site, earth, end_s
        track, rest = self._smoothed(), np.zeros(COLUMNS)
        rest[HEIGHT] = track.path.height
        return Kinematics(TRACK, rest, legs=self._pieces(track, start_utc))

    def _covering(self, span_s: float, start_utc: float | None) -> _Smoothed:
        track = self._smoothed()
        start = track.window.start_s if start_utc is None else start_utc
        require_cover(track.window, start, span_s, "the track", self.file)
        return track

    def _pieces(self, track: _Smoothed, start_utc: float | None) -> np.ndarray:
        """All splines on shared pieces; t = 0 at ``start_utc``, else at the start of the own window."""
        start = track.window.start_s if start_utc is None else start_utc
        lat, lon = track.path.columns(start)
        splines = {PIECE_LAT: lat, PIECE_LON: lon, PIECE_HEADING: track.heading.column(0, start)}
        if track.attitude is None:
            return shared_pieces(
                splines, {PIECE_PITCH: self.pitch_deg * DEG, PIECE_ROLL: self.roll_deg * DEG}
            )
        splines[PIECE_PITCH] = track.attitude.column(0, start)
        splines[PIECE_ROLL] = track.attitude.column(1, start)
        return shared_pieces(splines, {})

    def _smoothed(self) -> _Smoothed:
        files = (self.file,) if isinstance(self.file, str) else self.file or ()
        return _smooth(files, file_keys(files, "", "file"), self.smoothing_s)


@dataclass(frozen=True)
class _Smoothed:
    """Splines through the streams of one track."""

    window: Window
    path: _Path
    heading: _Spline
    attitude: _Spline | None


def _streams(recording: Recording, file: object) -> Streams:
    if recording.position is None or recording.heading is None:
        raise InputError(
            Fault("", "file", file, f"holds no {what}: add a file with {remedy}")
            for what, remedy, series in (
                ("position", "RMC or GGA sentences or lat_deg and lon_deg", recording.position),
                ("heading", "HDT or VHW sentences or heading_deg", recording.heading),
            )
            if series is None
        )
    return Streams(recording.position, recording.heading, recording.attitude)


@lru_cache(maxsize=4)
def _smooth(files: tuple[str, ...], state: tuple[FileKey, ...], smoothing_s: float) -> _Smoothed:
    """Fit the splines, once for one state of the files: 10 h at 1 Hz take most of a second."""
    del state
    streams = _streams(load(files, field="file"), files)
    return _Smoothed(
        shared_window(streams.series()),
        _Path(streams.position, smoothing_s),
        _angles(streams.heading, smoothing_s),
        None if streams.attitude is None else _angles(streams.attitude, smoothing_s),
    )


def _angles(series: Series, smoothing_s: float) -> _Spline:
    return _smoothed_columns(series.time_s, np.unwrap(series.values, axis=0), smoothing_s)


class _Path:
    """Smoothed latitude and longitude as functions of UTC."""

    def __init__(self, position: Series, smoothing_s: float) -> None:
        if position.time_s.size < FEWEST_FIXES:
            found = f"only {position.time_s.size} positions ({position.source})"
            raise InputError(Fault("", "file", None, f"{found}; at least {FEWEST_FIXES} are needed"))
        lat, lon = position.values[:, 0], np.unwrap(position.values[:, 1])
        self._origin = np.array([lat[0], lon[0]])
        meridian, prime_vertical = WGS84.radii(lat[0])
        self._metres = np.array([meridian, prime_vertical * np.cos(lat[0])])
        metres = (np.column_stack([lat, lon]) - self._origin) * self._metres
        _refuse_outliers(position, metres)
        self._spline = _smoothed_columns(position.time_s, metres, smoothing_s)
        heights = position.values[np.isfinite(position.values[:, 2]), 2]
        self.height = float(np.median(heights)) if heights.size else 0.0

    def columns(self, start_s: float) -> Iterator[Polynomials]:
        """Latitude and longitude (rad) as functions of the time since ``start_s``."""
        for j in range(2):
            breaks, coefficients = self._spline.column(j, start_s)
            coefficients = coefficients / self._metres[j]
            coefficients[3] += self._origin[j]
            yield breaks, coefficients


class _Spline:
    """Cubic spline in time from its first knot, which keeps UTC's large numbers out of the polynomials."""

    def __init__(self, start_s: float, breaks: np.ndarray, coefficients: np.ndarray) -> None:
        self._start_s, self._breaks, self._coefficients = start_s, breaks, coefficients

    def column(self, j: int, start_s: float) -> Polynomials:
        """Breakpoints since ``start_s`` and coefficients of column j."""
        return self._breaks + (self._start_s - start_s), self._coefficients[:, :, j]


def _smoothed_columns(time_s: np.ndarray, values: np.ndarray, smoothing_s: float) -> _Spline:
    """Smoothing spline of the columns; the penalty makes its cut-off 1 / smoothing_s at the median rate."""
    from scipy.interpolate import CubicSpline, make_smoothing_spline

    elapsed = time_s - time_s[0]
    if smoothing_s == 0.0 or elapsed.size < FEWEST_FIXES:
        spline = CubicSpline(elapsed, values, bc_type="natural")
    else:
        penalty = smoothing_s**4 / float(np.median(np.diff(elapsed)))
        spline = make_smoothing_spline(elapsed, values, lam=penalty)
    starts = elapsed[:-1]
    coefficients = np.stack(
        [spline(starts, 3) / 6.0, spline(starts, 2) / 2.0, spline(starts, 1), spline(starts)]
    )
    return _Spline(time_s[0], elapsed, coefficients)


def _refuse_outliers(position: Series, metres: np.ndarray) -> None:
    """Refuse fixes that lie off the line between their neighbours by more than a vehicle can move."""
    before, after = np.diff(position.time_s)[:-1], np.diff(position.time_s)[1:]
    share = (before / (before + after))[:, None]
    distance = np.hypot(*(metres[1:-1] - metres[:-2] - share * (metres[2:] - metres[:-2])).T)
    reachable = np.maximum(OUTLIER_M, 0.5 * OUTLIER_ACCELERATION * before * after)
    excess = np.where(distance > reachable, distance / reachable, 0.0)
    # One bad fix also throws its neighbours off; the worst of each neighbourhood is the one to name.
    padded = np.pad(excess, 1)
    worst = np.flatnonzero((excess > 0.0) & (excess >= padded[:-2]) & (excess >= padded[2:]))
    if worst.size == 0:
        return
    faults = [
        Fault(
            "", "file", position.source,
            f"the position at {utc_text(float(position.time_s[i + 1]))} lies {distance[i]:.0f} m "
            "off its neighbours: leave it out",
        )
        for i in worst[:_MOST_FAULTS]
    ]  # fmt: skip
    if worst.size > _MOST_FAULTS:
        faults.append(
            Fault("", "file", position.source, f"and {worst.size - _MOST_FAULTS} more such positions")
        )
    raise InputError(faults)
