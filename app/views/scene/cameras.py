"""Where the 3D view is seen from: the map from the south, from above, along the sea, from behind the ship."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from app.views.scene.track import HALF_WIDTH, Place

if TYPE_CHECKING:
    import viser

MAP, FOLLOW, TOP, SIDE = CAMERAS = ("map", "follow", "top", "side")
_TILT = {MAP: math.radians(66.0), TOP: math.radians(90.0), SIDE: math.radians(22.0)}
"""Elevation of the camera above the map."""
_ROOM = 1.1
"""Scene units around the map for its labels."""
_MIDDLE = {MAP: -2.0, TOP: 0.2, SIDE: -1.5}
"""North of the map's middle: the legend stands south of the map, the instruments above it."""
_FARTHER = {MAP: 1.0, TOP: 1.1, SIDE: 1.0}
_BEHIND, _ABOVE, _AHEAD = 4.2, 2.1, 0.8
"""Of the camera behind the ship, scene units."""


class Cameras:
    """The camera of one client.

    Parameters
    ----------
    camera : viser.CameraHandle
        Of the client.
    """

    def __init__(self, camera: viser.CameraHandle) -> None:
        self._camera = camera
        self.chosen = MAP

    def choose(self, name: str, aspect: float, place: Place | None) -> None:
        """Look from one of `CAMERAS`; ``aspect`` is width / height of the view."""
        if name not in CAMERAS:
            return
        self.chosen = name
        if name == FOLLOW:
            if place is not None:
                self.follow(place)
            return
        tilt = _TILT[name]
        half = math.tan(0.5 * self._camera.fov)
        # The southern edge is nearest to the camera and looks largest.
        nearer = HALF_WIDTH * math.cos(tilt)
        across = (HALF_WIDTH + _ROOM) / (half * aspect) + nearer
        upright = (HALF_WIDTH * math.sin(tilt) + _ROOM) / half + nearer
        centre = np.array([0.0, _MIDDLE[name], 0.0])
        away = _FARTHER[name] * max(across, upright) * np.array([0.0, -math.cos(tilt), math.sin(tilt)])
        self._point(centre + away, centre, (0.0, 1.0, 0.0) if name == TOP else (0.0, 0.0, 1.0))

    def follow(self, place: Place) -> None:
        """Stay behind the ship, if that is chosen."""
        if self.chosen != FOLLOW:
            return
        w, x, y, z = place.wxyz
        ahead = np.array([2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 0.0])
        ahead /= max(float(np.linalg.norm(ahead)), 1e-9)
        ship = place.truth.astype(float)
        self._point(ship - _BEHIND * ahead + (0.0, 0.0, _ABOVE), ship + _AHEAD * ahead, (0.0, 0.0, 1.0))

    def _point(self, position: np.ndarray, look_at: np.ndarray, up: tuple[float, float, float]) -> None:
        self._camera.up_direction = up
        self._camera.position = position
        self._camera.look_at = look_at
