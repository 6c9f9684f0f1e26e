"""Draws the map of true and computed tracks into a client's 3D view, updating in place what only moved."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from app.figures import style
from app.figures.graticule import SceneLabel
from app.figures.ship import ship_parts
from app.figures.track import HALF_WIDTH, SHIP_LENGTH, TrackScene, segments

if TYPE_CHECKING:
    import viser

Anchor = Literal["top-center", "center-left"]

_LINE = 0.05
_GRID_LINE = 0.015
_TILT = math.radians(66.0)
"""Elevation of the camera above the map."""
_ROOM = 1.1
"""Scene units around the map for its labels."""
_HEADING_LENGTH = 1.6
_LABEL = 0.9
_LEGEND_ROWS = 5


_BAR_SHIFT = np.array([0.0, -0.55, 0.0], dtype=np.float32)
"""Keeps the scale bar and its label (the first of a map's labels) clear of the longitudes."""


class SceneDrawer:
    """The 3D view of one client.

    Parameters
    ----------
    scene : viser.SceneApi
        Of the client.
    """

    def __init__(self, scene: viser.SceneApi) -> None:
        self._scene = scene
        self._nodes: dict[str, Any] = {}
        self._labels: dict[str, tuple[SceneLabel, ...]] = {}
        self._drawn: TrackScene | None = None
        # Shadows and the environment map keep two cores busy under software rendering.
        scene.configure_default_lights(cast_shadow=False)
        scene.configure_environment_map(hdri=None)
        scene.add_light_ambient("/light", intensity=1.4)
        self._make_sea()
        self._make_ship()

    def draw(self, track: TrackScene, time_s: float) -> None:
        """Show a run's map, with the ship where it is at ``time_s``."""
        self._lines("/map/grid", track.graticule.segments, style.rgb("#A9BACA"), _GRID_LINE)
        self._lines("/map/bar", track.bar + _BAR_SHIFT, style.rgb(style.INK), 2 * _GRID_LINE)
        caption = SceneLabel(track.caption, (0.0, -HALF_WIDTH - 2.3, 0.0))
        south = (replace(label, position=_shifted(label)) for label in track.labels[:1])
        self._texts("/map/labels", (*track.graticule.labels, *south, *track.labels[1:]))
        self._texts("/map/caption", (caption,), size=1.0)
        self._lines("/track/truth", track.truth_dashes(), style.rgb(style.TRUTH_COLOR), _LINE)
        for index, method in enumerate(track.methods):
            self._lines(f"/track/method{index}", segments(method.points), method.color, _LINE)
        self._drop_beyond("/track/method", len(track.methods))
        self._drawn = track
        self.move_ship(time_s)

    def move_ship(self, time_s: float) -> None:
        """Put the ship, its heading and the error vectors where they are at a time."""
        track = self._drawn
        if track is None:
            return
        index = track.index_at(time_s)
        ship = self._nodes["/ship"]
        ship.position, ship.wxyz = track.truth[index], track.wxyz[index]
        vectors = track.error_vectors(index)
        for number, (vector, method) in enumerate(zip(vectors, track.methods, strict=True)):
            self._lines(f"/error/method{number}", vector[None], method.color, 0.6 * _LINE)
            self._legend_row(number, len(track.methods), method.color, method.error_text(index))
        for name in ("/error/method", "/legend/line", "/legend/text"):
            self._drop_beyond(name, len(track.methods))

    def _legend_row(self, number: int, count: int, color: tuple[int, int, int], text: str) -> None:
        """A method's line, name and present error, south of the map; many stand in two columns."""
        rows = count if count <= _LEGEND_ROWS else -(-count // 2)
        x = -HALF_WIDTH + (HALF_WIDTH + 0.4) * (number // rows)
        y = -HALF_WIDTH - 3.3 - 0.75 * (number % rows)
        line = np.array([[[x, y, 0.0], [x + 0.7, y, 0.0]]], dtype=np.float32)
        self._lines(f"/legend/line{number}", line, color, _LINE)
        self._text(f"/legend/text{number}", SceneLabel(text, (x + 0.9, y, 0.0)), anchor="center-left")

    def point_camera(self, camera: viser.CameraHandle, aspect: float) -> None:
        """Look at the whole map from the south; ``aspect`` is width / height of the view."""
        half = math.tan(0.5 * camera.fov)
        # The southern edge is nearest to the camera and looks largest.
        nearer = HALF_WIDTH * math.cos(_TILT)
        across = (HALF_WIDTH + _ROOM) / (half * aspect) + nearer
        upright = (HALF_WIDTH * math.sin(_TILT) + _ROOM) / half + nearer
        centre = np.array([0.0, -2.0, 0.0])
        camera.up_direction = (0.0, 0.0, 1.0)
        camera.position = centre + max(across, upright) * np.array([0.0, -math.cos(_TILT), math.sin(_TILT)])
        camera.look_at = centre

    # ------------------------------------------------------------ nodes

    def _make_sea(self) -> None:
        edge = HALF_WIDTH
        corners = np.array([[-edge, -edge, 0], [edge, -edge, 0], [edge, edge, 0], [-edge, edge, 0]]) - [
            0,
            0,
            0.03,
        ]
        self._scene.add_mesh_simple(
            "/map/sea", corners, np.array([[0, 1, 2], [0, 2, 3]]), color=style.rgb("#B9D9F5"), opacity=0.45,
            side="double", cast_shadow=False, receive_shadow=False,
        )  # fmt: skip

    def _make_ship(self) -> None:
        self._nodes["/ship"] = self._scene.add_frame("/ship", show_axes=False)
        for part in ship_parts():
            self._scene.add_mesh_simple(
                f"/ship/{part.name}", part.vertices, part.faces, color=part.color, scale=SHIP_LENGTH,
                flat_shading=True, cast_shadow=False, receive_shadow=False,
            )  # fmt: skip
        ahead = np.array([[[0.0, 0.5 * SHIP_LENGTH, 0.1], [0.0, _HEADING_LENGTH, 0.1]]])
        self._scene.add_arrows(
            "/ship/heading", ahead, style.rgb(style.TRUTH_COLOR), shaft_radius=0.025, head_radius=0.08,
            head_length=0.2,
        )  # fmt: skip

    def _lines(self, name: str, points: np.ndarray, color: tuple[int, int, int], thickness: float) -> None:
        node = self._nodes.get(name)
        if node is not None and len(points) and tuple(node.colors) == color:
            node.points = points
            return
        if node is not None:
            self._nodes.pop(name).remove()
        if len(points):
            self._nodes[name] = self._scene.add_line_segments(name, points, color, thickness=thickness)

    def _texts(self, name: str, labels: tuple[SceneLabel, ...], size: float = _LABEL) -> None:
        for index, label in enumerate(labels):
            self._text(f"{name}{index}", label, size)
        self._drop_beyond(name, len(labels))

    def _text(
        self, name: str, label: SceneLabel, size: float = _LABEL, anchor: Anchor = "top-center"
    ) -> None:
        node = self._nodes.get(name)
        if node is None:
            self._nodes[name] = self._scene.add_label(
                name, label.text, position=label.position, font_screen_scale=size, anchor=anchor
            )
            return
        if node.text != label.text:
            node.text = label.text
        node.position = label.position

    def _drop_beyond(self, name: str, count: int) -> None:
        while (node := self._nodes.pop(f"{name}{count}", None)) is not None:
            node.remove()
            count += 1


def _shifted(label: SceneLabel) -> tuple[float, float, float]:
    x, y, z = (float(a + b) for a, b in zip(label.position, _BAR_SHIFT, strict=True))
    return x, y, z
