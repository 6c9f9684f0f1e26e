"""Draws the map of true and computed tracks into a client's 3D view, updating in place what only moved."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from schuler_bench.plots import style
from schuler_bench.views.scene.graticule import SceneLabel, segments
from schuler_bench.views.scene.track import (
    HALF_WIDTH,
    LINE_WIDTH,
    SHIP_LENGTH,
    MethodTrack,
    Place,
    TrackScene,
)

if TYPE_CHECKING:
    import viser

_GRID_LINE = 0.02
_PINNED_LINE = 0.5 * LINE_WIDTH
_FAINT = 0.6
"""Width of what lies ahead of the ship."""
_TIP_POINTS = 60
_HEADING_LENGTH = 1.6
_LABEL = 0.9
_UNSHADOWED: dict[str, Any] = {"cast_shadow": False, "receive_shadow": False}


_BAR_SHIFT = np.array([0.0, -0.55, 0.0], dtype=np.float32)
"""Keeps the scale bar and its label (the first of a map's labels) clear of the longitudes."""


# Stations of the hull from the stern to the bow, in ship lengths: y forward, half beam at the deck and at the
# keel, height of the deck. Waterline z = 0, keel at _KEEL.
_STATIONS = (
    (-0.50, 0.070, 0.040, 0.062),
    (-0.38, 0.084, 0.058, 0.058),
    (-0.10, 0.090, 0.066, 0.055),
    (0.15, 0.088, 0.062, 0.058),
    (0.30, 0.072, 0.040, 0.066),
    (0.42, 0.040, 0.014, 0.078),
    (0.50, 0.002, 0.001, 0.090),
)
_KEEL = -0.03

_HULL, _DECK, _HOUSE, _ACCENT = (58, 98, 150), (176, 184, 192), (246, 248, 250), (222, 110, 20)


@dataclass(frozen=True, eq=False)
class ShipPart:
    """A part in one colour.

    Attributes
    ----------
    name : str
        For the scene tree.
    vertices : ndarray of float32, shape (v, 3)
        Body axes: x starboard, y forward, z up; the ship is one unit long, its middle at the origin.
    faces : ndarray of uint32, shape (f, 3)
        Triangles, outward normals by the right-hand rule.
    color : (int, int, int)
        Red, green, blue.
    """

    name: str
    vertices: np.ndarray
    faces: np.ndarray
    color: tuple[int, int, int]


@lru_cache(maxsize=1)
def ship_parts() -> tuple[ShipPart, ...]:
    """Parts of the ship, one unit long."""
    house = ((-0.068, 0.068, -0.22, 0.16, 0.055, 0.115), (-0.060, 0.060, -0.06, 0.14, 0.115, 0.165))
    bridge = ((-0.080, 0.080, 0.06, 0.13, 0.165, 0.200),)
    funnel_and_mast = ((-0.026, 0.026, -0.18, -0.10, 0.115, 0.215), (-0.006, 0.006, 0.07, 0.085, 0.2, 0.3))
    return (
        _hull(),
        _deck(),
        _boxes("house", _HOUSE, house),
        _boxes("bridge", _HOUSE, bridge),
        _boxes("funnel", _ACCENT, funnel_and_mast),
    )


def _hull() -> ShipPart:
    """Shell: starboard deck edge, starboard keel, port keel, port deck edge at each station."""
    rings = [
        point
        for y, deck, keel, top in _STATIONS
        for point in ((deck, y, top), (keel, y, _KEEL), (-keel, y, _KEEL), (-deck, y, top))
    ]
    last = len(rings) - 4
    faces = [(0, 3, 2), (0, 2, 1), (last, last + 1, last + 2), (last, last + 2, last + 3)]
    for a in (4 * i + k for i in range(len(_STATIONS) - 1) for k in range(3)):
        faces += [(a, a + 1, a + 4), (a + 1, a + 5, a + 4)]
    return _part("hull", rings, faces, _HULL)


def _deck() -> ShipPart:
    edges = [(side * beam, y, top - 0.004) for y, beam, _, top in _STATIONS for side in (1, -1)]
    faces = [face for a in range(0, len(edges) - 2, 2) for face in ((a, a + 2, a + 1), (a + 2, a + 3, a + 1))]
    return _part("deck", edges, faces, _DECK)


def _boxes(name: str, color: tuple[int, int, int], boxes: tuple[tuple[float, ...], ...]) -> ShipPart:
    """Boxes given as x0, x1, y0, y1, z0, z1."""
    points: list[tuple[float, float, float]] = []
    faces: list[tuple[int, int, int]] = []
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    for x0, x1, y0, y1, z0, z1 in boxes:
        start = len(points)
        points += [(x, y, z) for z in (z0, z1) for y in (y0, y1) for x in (x0, x1)]
        for a, b, c, d in quads:
            faces += [(start + a, start + b, start + c), (start + a, start + c, start + d)]
    return _part(name, points, faces, color)


def _part(
    name: str,
    points: list[tuple[float, float, float]],
    faces: list[tuple[int, int, int]],
    color: tuple[int, int, int],
) -> ShipPart:
    triangles = np.array(faces, dtype=np.uint32)
    vertices = np.array(points, dtype=np.float32)
    vertices.setflags(write=False)
    triangles.setflags(write=False)
    return ShipPart(name, vertices, triangles, color)


class SceneDrawer:
    """The 3D view of one client.

    Parameters
    ----------
    scene : viser.SceneApi
        Of the client.

    Attributes
    ----------
    place : Place or None
        Where the ships are.
    drawn : TrackScene or None
        What is shown.
    """

    def __init__(self, scene: viser.SceneApi) -> None:
        self._scene = scene
        self._nodes: dict[str, Any] = {}
        self.drawn: TrackScene | None = None
        self._selected = 0
        self._past: dict[str, tuple[object, int]] = {}
        self._ghost: tuple[int, int, int] | None = None
        self._scale = 1.0
        self.place: Place | None = None
        # Shadows and the environment map keep two cores busy under software rendering.
        scene.configure_default_lights(cast_shadow=False)
        scene.configure_environment_map(hdri=None)
        scene.add_light_ambient("/light", intensity=1.4)

    def enlarge(self, scale: float) -> None:
        """Write labels larger by ``scale``, and draw lines wider, from the next `draw` on."""
        if scale == self._scale:
            return
        self._scale = scale
        for name in [name for name in self._nodes if name.count("/") > 1]:
            self._nodes.pop(name).remove()
        self._past.clear()

    def draw(self, track: TrackScene, time_s: float, selected: int = 0) -> None:
        """Show a run's map, the ships where they are at ``time_s``; ``selected`` has a computed one."""
        if self.drawn is None:
            self._make_sea()
            self._nodes["/ship"] = self._make_ship("/ship")
            self._make_heading()
        self._lines("/map/grid", track.graticule.segments, style.rgb("#FFFFFF"), _GRID_LINE)
        self._lines("/map/bar", track.bar + _BAR_SHIFT, style.rgb(style.INK), 2 * _GRID_LINE)
        (scale, (x, y, z)), *others = track.labels
        below = SceneLabel(scale, (x, y + float(_BAR_SHIFT[1]), z))
        self._texts("/map/labels", (*track.graticule.labels, below, *others))
        self._lines("/track/truth", track.truth_dashes(), style.rgb(style.TRUTH_COLOR), LINE_WIDTH)
        for number, pinned in enumerate(track.pinned):
            color = _paler(pinned.color) if pinned.state == "dimmed" else pinned.color
            self._lines(f"/track/pinned{number}", pinned.segments, color, _PINNED_LINE)
        self._drop_beyond("/track/pinned", len(track.pinned))
        self.drawn, self._selected = track, min(selected, len(track.methods) - 1)
        self._past.clear()
        self.move_ship(time_s)
        self._drop_beyond("/track/method", len(track.methods))

    def move_ship(self, time_s: float) -> None:
        """Put ships, error vectors and trails where they are at a time."""
        track = self.drawn
        if track is None:
            return
        place = self.place = track.place(time_s)
        ship = self._nodes["/ship"]
        ship.position, ship.wxyz = place.truth, place.wxyz
        self._place_computed()
        under_way = time_s < track.t_s[-1]
        for number, (vector, method) in enumerate(zip(place.error_vectors(), track.methods, strict=True)):
            self._whole(number, method, faint=under_way)
            self._trail(number, method, place, under_way=under_way)
            seen = method.visible(vector[None])
            self._lines(f"/error/method{number}", seen, _color(method), 0.6 * LINE_WIDTH)
        for name in ("/error/method", "/trail/past", "/trail/tip"):
            self._drop_beyond(name, len(track.methods))

    def select(self, method: int) -> bool:
        """Let another method have the computed ship; False when it has it already."""
        if self.drawn is None:
            return False
        before, self._selected = self._selected, min(method, len(self.drawn.methods) - 1)
        self._place_computed()
        return before != self._selected

    def _whole(self, number: int, method: MethodTrack, *, faint: bool) -> None:
        """The whole computed track; pale while what lies ahead is not yet past."""
        color = _paler(method.color) if faint else _color(method)
        name = f"/track/method{number}"
        if self._past.get(name) != (color, id(self.drawn)):
            self._lines(name, method.drawn(), color, (_FAINT if faint else 1.0) * LINE_WIDTH)
            self._past[name] = color, id(self.drawn)

    def _trail(self, number: int, method: MethodTrack, place: Place, *, under_way: bool) -> None:
        """The part of a track that is past: only its last few points are sent anew at each moment."""
        past, tip = f"/trail/past{number}", f"/trail/tip{number}"
        if not under_way:
            for name in (past, tip):
                self._lines(name, np.empty((0, 2, 3), dtype=np.float32), _color(method), LINE_WIDTH)
            self._past.pop(past, None)
            return
        whole = place.index // _TIP_POINTS * _TIP_POINTS
        if self._past.get(past) != (whole, id(self.drawn)):
            self._lines(past, method.drawn(whole), _color(method), LINE_WIDTH)
            self._past[past] = whole, id(self.drawn)
        recent = method.points[whole : place.index + 1]
        here = place.computed[number][None] if place.index < len(method.points) else recent[:0]
        self._lines(tip, method.visible(segments(np.concatenate([recent, here]))), _color(method), LINE_WIDTH)

    # ------------------------------------------------------------ nodes

    def _make_sea(self) -> None:
        corners = [[x * HALF_WIDTH, y * HALF_WIDTH, -0.03] for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        faces = np.array([[0, 1, 2], [0, 2, 3]])
        self._scene.add_mesh_simple(
            "/map/sea", np.array(corners), faces, color=style.rgb("#BCDCF4"), side="double", **_UNSHADOWED
        )

    def _make_ship(self, name: str, color: tuple[int, int, int] | None = None) -> Any:
        """A ship; a translucent one in a method's colour."""
        frame = self._scene.add_frame(name, show_axes=False)
        for part in ship_parts():
            self._scene.add_mesh_simple(
                f"{name}/{part.name}",
                part.vertices,
                part.faces,
                color=color or part.color,
                scale=SHIP_LENGTH,
                opacity=0.38 if color else None,
                flat_shading=True,
                **_UNSHADOWED,
            )
        return frame

    def _make_heading(self) -> None:
        ahead = np.array([[[0.0, 0.5 * SHIP_LENGTH, 0.1], [0.0, _HEADING_LENGTH, 0.1]]])
        size: dict[str, Any] = {"shaft_radius": 0.025, "head_radius": 0.08, "head_length": 0.2}
        self._scene.add_arrows("/ship/heading", ahead, style.rgb(style.TRUTH_COLOR), **size)

    def _place_computed(self) -> None:
        """Put a ship in the colour of the selected method where that takes it to be."""
        if self.drawn is None or self.place is None:
            return
        color = self.drawn.methods[self._selected].color
        if self._ghost != color:
            self._ghost = color
            if "/computed" in self._nodes:
                self._nodes.pop("/computed").remove()
            self._nodes["/computed"] = self._make_ship("/computed", color)
        computed = self._nodes["/computed"]
        computed.position, computed.wxyz = self.place.computed[self._selected], self.place.wxyz

    def _lines(self, name: str, points: np.ndarray, color: tuple[int, int, int], thickness: float) -> None:
        node = self._nodes.get(name)
        if node is not None and len(points) and tuple(node.colors) == color:
            node.points = points
            return
        if node is not None:
            self._nodes.pop(name).remove()
        if len(points):
            wide = thickness * self._scale**0.5  # the map itself is smaller on an enlarged page
            self._nodes[name] = self._scene.add_line_segments(name, points, color, thickness=wide)

    def _texts(self, name: str, labels: tuple[SceneLabel, ...]) -> None:
        for index, label in enumerate(labels):
            node = self._nodes.get(f"{name}{index}")
            if node is None:
                size = _LABEL * self._scale
                self._nodes[f"{name}{index}"] = self._scene.add_label(
                    f"{name}{index}", label.text, position=label.position, font_screen_scale=size,
                    anchor="top-center",
                )  # fmt: skip
            else:
                node.position = label.position
                if node.text != label.text:
                    node.text = label.text
        self._drop_beyond(name, len(labels))

    def _drop_beyond(self, name: str, count: int) -> None:
        while (node := self._nodes.pop(f"{name}{count}", None)) is not None:
            node.remove()
            count += 1


def _color(method: MethodTrack) -> tuple[int, int, int]:
    return _paler(method.color) if method.state == "dimmed" else method.color


def _paler(color: tuple[int, int, int]) -> tuple[int, int, int]:
    red, green, blue = (round(255 - 0.35 * (255 - part)) for part in color)
    return red, green, blue
