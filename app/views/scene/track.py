"""True and computed trajectories as a small map: metres scaled to scene units, errors exaggerated."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from navcore.engine.run import MethodRun, Run
from navcore.foundation.text import Text
from navcore.mechanization.recorder import D_LAT, D_LON
from navcore.motion.truth import HEADING, HEIGHT, LAT, LON, PITCH, ROLL
from schuler_bench.plots import style
from schuler_bench.plots.legend import State, counts
from schuler_bench.plots.pinned import Pinned, pinned_methods
from schuler_bench.plots.units import length_unit, number, round_down, round_up, rounded
from schuler_bench.views.scene.graticule import (
    MOST_BESIDE,
    Graticule,
    LocalMap,
    SceneLabel,
    dashes,
    graticule,
    needed,
    scale_bar,
    segments,
)

MAX_POINTS = 1000
"""Points of a track: at this density the ship moves smoothly along 24 h."""
LINE_WIDTH = 0.05
"""Scene units."""
_UNSEEN = 0.2 * LINE_WIDTH
"""A line may leave out points that would move it by less, scene units."""
HALF_WIDTH = 5.0
"""Half width of the map in scene units."""
SHIP_LENGTH = 1.4
"""Scene units; the ship is a symbol, not to scale."""
_STATIC_M = 20.0
_VISIBLE = 0.35
"""Exaggerated errors reach at most this part of the track's size."""
_FILL = 0.9
_CUT = 3.0
_DASH = 0.16
_LIFT = 0.02
_SCALES = (1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.0, 8.5)


@dataclass(frozen=True, eq=False)
class MethodTrack:
    """Track that one method computed.

    Attributes
    ----------
    name : str
        The method's.
    color : (int, int, int)
        The method's, as in every plot.
    points : ndarray of float32, shape (k, 3)
        Computed track, error exaggerated, scene units; shorter than the truth when the method ended early.
    error_m : ndarray, shape (k, 2)
        True size of the error at these points, east and north, m.
    line : ndarray of int, shape (n,)
        Indices of the points that drawing the line needs.
    state : State
        How it is shown; what is off the scale ends at the map's edge.
    """

    name: str
    color: tuple[int, int, int]
    points: np.ndarray
    error_m: np.ndarray
    line: np.ndarray
    state: State = "shown"

    def drawn(self, before: int | None = None) -> np.ndarray:
        """Segments of the line, float32, shape (n, 2, 3): all, or as far as the point ``before``."""
        if before is None:
            return self.visible(segments(self.points[self.line]))
        last = min(before, len(self.points) - 1)
        return self.visible(segments(self.points[[*self.line[self.line < last], last]]))

    def visible(self, parts: np.ndarray) -> np.ndarray:
        """Those of some segments that are to be seen: none of what is hidden."""
        if self.state == "hidden":
            return parts[:0]
        if self.state == "unscaled":
            return parts[(np.abs(parts[:, :, :2]) <= HALF_WIDTH).all(axis=(1, 2))]
        return parts

    def error_size_m(self, index: int) -> float:
        """Size of the error at a point, m."""
        return math.hypot(*self.error_m[min(index, len(self.error_m) - 1)])


def error_texts(tracks: Sequence[MethodTrack], index: int) -> list[str]:
    """Size of each track's error at a point, all in one unit, e.g. ``3.21 km`` beside ``0.12 km``."""
    sizes = [track.error_size_m(index) for track in tracks]
    unit = length_unit(max(sizes, default=0.0))
    return [f"{rounded(size / unit.si)} {unit.name}" for size in sizes]


class PinnedTrack(NamedTuple):
    """Way that a method of a pinned run would compute beside the present one's truth.

    ``segments`` float32, shape (n, 2, 3): its error exaggerated like all others, scene units.
    """

    label: str
    color: tuple[int, int, int]
    segments: np.ndarray
    state: State = "shown"


@dataclass(frozen=True, eq=False)
class Place:
    """Where ship and computed ships are at a time.

    Attributes
    ----------
    index : int
        The last point of the lines not later than it.
    truth : ndarray of float32, shape (3,)
        The ship, scene units.
    wxyz : ndarray, shape (4,)
        Its attitude.
    computed : ndarray of float32, shape (methods, 3)
        Where each method takes it to be, error exaggerated; the last point of one that ended.
    """

    index: int
    truth: np.ndarray
    wxyz: np.ndarray
    computed: np.ndarray

    def error_vectors(self) -> np.ndarray:
        """True position to computed one for every method, float32, shape (methods, 2, 3)."""
        return np.stack([np.broadcast_to(self.truth, self.computed.shape), self.computed], axis=1)


@dataclass(frozen=True, eq=False)
class TrackScene:
    """Everything the 3D view shows; scene units east, north, up, origin at the middle of the map.

    Attributes
    ----------
    t_s : ndarray, shape (k,)
        Times of the points, s.
    truth : ndarray of float32, shape (k, 3)
        True track.
    wxyz : ndarray, shape (k, 4)
        Attitude of the ship: body to scene quaternion, w first.
    methods : tuple of MethodTrack
        Computed tracks in the scenario's order.
    pinned : tuple of PinnedTrack
        Those of pinned runs.
    exaggeration : float
        Factor by which the position errors are drawn larger.
    metres_per_unit : float
        Scale of the map.
    static : bool
        The vehicle stays where it is: the map is as large as the errors.
    graticule : Graticule
        Lines of latitude and longitude.
    bar : ndarray of float32, shape (3, 2, 3)
        Scale bar.
    labels : tuple of SceneLabel
        Of the scale bar and of north.
    caption : str
        Exaggeration and scale in words.
    """

    t_s: np.ndarray
    truth: np.ndarray
    wxyz: np.ndarray
    methods: tuple[MethodTrack, ...]
    pinned: tuple[PinnedTrack, ...]
    exaggeration: float
    metres_per_unit: float
    static: bool
    graticule: Graticule
    bar: np.ndarray
    labels: tuple[SceneLabel, ...]
    caption: str

    def place(self, t_s: float) -> Place:
        """Where everything is at a time, between the points of the lines too."""
        index = int(np.clip(np.searchsorted(self.t_s, t_s, side="right") - 1, 0, len(self.t_s) - 1))
        after = min(index + 1, len(self.t_s) - 1)
        span = self.t_s[after] - self.t_s[index]
        part = min(max((t_s - self.t_s[index]) / span, 0.0), 1.0) if span > 0.0 else 0.0
        turned = self.wxyz[after] * math.copysign(1.0, self.wxyz[index] @ self.wxyz[after])
        wxyz = (1.0 - part) * self.wxyz[index] + part * turned
        computed = [_between(method.points, index, part) for method in self.methods]
        return Place(
            index=index,
            truth=_between(self.truth, index, part),
            wxyz=wxyz / np.linalg.norm(wxyz),
            computed=np.array(computed, dtype=np.float32).reshape(-1, 3),
        )

    def truth_dashes(self) -> np.ndarray:
        """Truth as dashes, float32, shape (n, 2, 3): what is true is dashed, what is computed is solid."""
        return dashes(self.truth[needed(self.truth, _UNSEEN)], _DASH)


def track(
    run: Run,
    exaggeration: float | None = None,
    pins: Sequence[Pinned] = (),
    state_of: Callable[[str], State] = lambda _: "shown",
    beside: int = MOST_BESIDE,
) -> TrackScene:
    """Map of the run.

    Parameters
    ----------
    run : Run
        Result.
    exaggeration : float, optional
        Factor on the position errors; chosen from 1, 2, 5, 10, ... so that they show when None.
    pins : sequence of Pinned
        Runs whose position errors are laid over it.
    state_of : callable
        ``state_of(key)``: how a method, or a pin by its label, is shown.
    beside : int
        Longitudes whose labels have room beside each other.
    """
    pinned = [other for other in pinned_methods(pins) if state_of(other.label) != "hidden"]
    states: list[State] = [state_of(method.method.name) for method in run.methods]
    others: list[State] = [state_of(other.label) for other in pinned]
    chosen = _chosen(len(run.t_s))
    t_s, rows = run.t_s[chosen], run.truth[chosen]
    lat, lon = rows[:, LAT], np.unwrap(rows[:, LON])
    lat0, lon0 = 0.5 * (lat.min() + lat.max()), 0.5 * (lon.min() + lon.max())
    meridian, prime_vertical = run.scenario.earth.radii(float(lat0))
    height = float(np.mean(rows[:, HEIGHT]))
    per_lon = (prime_vertical + height) * math.cos(lat0)
    true_m = np.column_stack([(lon - lon0) * per_lon, (lat - lat0) * (meridian + height)])
    half_m = float(np.max(np.abs(true_m), initial=0.0))
    static = half_m < _STATIC_M
    # what the map's scale is chosen for: all that is off it counts only where nothing else is there
    own = [counts(state) for state in states]
    scaled = [*(own if any(own) else (True for _ in own)), *(counts(state) for state in others)]
    methods = [*run.methods, *(other.method for other in pinned)]
    peak = _peak([method for method, counted in zip(methods, scaled, strict=True) if counted])
    errors = [_errors(method, t_s, peak) for method in methods]
    factor = exaggeration or (1.0 if static else _exaggeration(half_m, peak))
    tracks_m = [true_m[: len(error)] + factor * error for error in errors]
    within = [points for points, counted in zip(tracks_m, scaled, strict=True) if counted]
    middle, metres = _frame([true_m, *within], static)
    area = LocalMap(
        lat0=float(lat0 + middle[1] / meridian),
        lon0=float(lon0 + middle[0] / per_lon),
        metres_per_lat=meridian,
        metres_per_lon=per_lon,
        metres_per_unit=metres,
    )
    bar, bar_label = scale_bar(metres, HALF_WIDTH)
    lines = [_scene(points, middle, metres, _LIFT) for points in tracks_m]
    return TrackScene(
        t_s=t_s,
        truth=_scene(true_m, middle, metres, 2.0 * _LIFT),
        wxyz=attitude_quaternions(rows[:, PITCH], rows[:, ROLL], rows[:, HEADING]),
        methods=tuple(
            MethodTrack(
                name=method.method.name,
                color=style.rgb(style.method_color(method.place)),
                points=lines[i],
                error_m=errors[i],
                line=needed(lines[i], _UNSEEN),
                state=states[i],
            )
            for i, method in enumerate(run.methods)
        ),
        pinned=tuple(
            PinnedTrack(other.label, style.rgb(other.color), segments(line[needed(line, _UNSEEN)]), state)
            for other, line, state in zip(pinned, lines[len(run.methods) :], others, strict=True)
        ),
        exaggeration=factor,
        metres_per_unit=metres,
        static=static,
        graticule=graticule(area, HALF_WIDTH, beside),
        bar=bar,
        labels=(bar_label, SceneLabel("▲ N", (-HALF_WIDTH, HALF_WIDTH + 0.45, 0.0))),
        caption=_caption(factor, static),
    )


def attitude_quaternions(pitch: np.ndarray, roll: np.ndarray, heading: np.ndarray) -> np.ndarray:
    """Quaternions (w, x, y, z) of C_b^n = Rz(-heading) Rx(pitch) Ry(roll), angles in rad, shape (k, 4)."""
    cp, sp = np.cos(0.5 * pitch), np.sin(0.5 * pitch)
    cr, sr = np.cos(0.5 * roll), np.sin(0.5 * roll)
    ch, sh = np.cos(0.5 * heading), -np.sin(0.5 * heading)
    a, b, c, d = cp * cr, sp * cr, cp * sr, sp * sr
    return np.column_stack([ch * a - sh * d, ch * b - sh * c, ch * c + sh * b, ch * d + sh * a])


def _between(points: np.ndarray, index: int, part: float) -> np.ndarray:
    """Point of a line between two of its points; its last one where it ended before."""
    before, after = min(index, len(points) - 1), min(index + 1, len(points) - 1)
    return (1.0 - part) * points[before] + part * points[after]


def _chosen(count: int) -> np.ndarray:
    """Indices of the output rows that are drawn: evenly spread, first and last included."""
    return np.unique(np.linspace(0, max(count - 1, 0), min(count, MAX_POINTS)).round().astype(int))


def _peak(methods: Sequence[MethodRun]) -> float:
    """Largest position error of the methods that did not diverge (else of all), m."""
    good = [m for m in methods if m.status != "diverged"] or methods
    return max((m.errors["position_m"]["max_abs"] for m in good), default=0.0)


def _errors(method: MethodRun, t_s: np.ndarray, peak_m: float) -> np.ndarray:
    """Position error east and north at the drawn times, m, as far as the method came and stays on the map."""
    if len(method.t_s) == 0:
        return np.zeros((1, 2))
    reached = t_s[t_s <= method.t_s[-1]]
    error = np.column_stack([np.interp(reached, method.t_s, method.rows[:, at]) for at in (D_LON, D_LAT)])
    if method.status == "diverged" and peak_m > 0.0:
        beyond = np.flatnonzero(~(np.hypot(error[:, 0], error[:, 1]) <= _CUT * peak_m))
        error = error[: beyond[0]] if len(beyond) else error
    known = np.flatnonzero(np.isfinite(error).all(axis=1))
    if not len(known):  # of an INS without a reference of its position
        return np.zeros((1, 2))
    return error[np.maximum(np.arange(known[-1] + 1), known[0])]


def _exaggeration(track_half_m: float, peak_m: float) -> float:
    if peak_m <= 0.0:
        return 1.0
    return max(1.0, round_down(_VISIBLE * 2.0 * track_half_m / peak_m))


def _frame(parts: list[np.ndarray], static: bool) -> tuple[np.ndarray, float]:
    """Middle of the map (m) and metres per scene unit, from a coarse series so that the map stands still."""
    everything = np.concatenate(parts)
    everything = everything[np.isfinite(everything).all(axis=1)]
    low, high = everything.min(axis=0), everything.max(axis=0)
    middle = np.zeros(2) if static else 0.5 * (low + high)
    half = float(np.max(np.maximum(high - middle, middle - low)))
    if half <= 0.0:
        return middle, 1.0
    return middle, round_up(half / (_FILL * HALF_WIDTH), _SCALES)


def _scene(points_m: np.ndarray, middle: np.ndarray, metres_per_unit: float, lift: float) -> np.ndarray:
    lifted = np.full(len(points_m), lift)
    return np.column_stack([(points_m - middle) / metres_per_unit, lifted]).astype(np.float32)


def _caption(factor: float, static: bool) -> str:
    if static:
        return (
            Text("position errors to scale")
            if factor == 1.0
            else Text("position errors x {factor}", factor=number(factor))
        )
    how = Text("to scale") if factor == 1.0 else Text("drawn x {factor}", factor=number(factor))
    return Text("position errors {how}; ship not to scale", how=how)
