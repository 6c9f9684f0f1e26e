"""Where the 3D view is seen from: the map from the south, from above, along the sea, from behind the ship."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from app.views.scene.track import HALF_WIDTH, Place

if TYPE_CHECKING:
    import viser

MAP, FOLLOW, TOP, SIDE = CAMERAS = ("map", "follow", "top", "side")
_TILT = {MAP: (78.0, 72.0, 66.0, 58.0, 50.0), TOP: (90.0,), SIDE: (22.0,)}
"""Elevation of the camera above the map, deg: the first at which the map's width fills the view."""
_ROOM = 1.1
"""Scene units around the map for its labels."""
_SOUTH = -0.7
"""North of the map's middle what is looked at: labels and scale bar stand south of the map."""
_BEHIND, _ABOVE, _AHEAD = 4.2, 2.1, 0.8
"""Of the camera behind the ship, scene units."""


@dataclass(frozen=True)
class Window:
    """The 3D view, px.

    Attributes
    ----------
    width, height : int
        Of all of it.
    above, below : int
        What instruments and bar take of its height.
    """

    width: int
    height: int
    above: int = 0
    below: int = 0

    @property
    def free(self) -> int:
        """Height that is left for the map."""
        return max(self.height - self.above - self.below, 120)

    @property
    def off_middle(self) -> float:
        """How far the middle of what is free lies above that of the view, as a part of half its height."""
        return (self.below - self.above) / self.height


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

    def choose(self, name: str, window: Window, place: Place | None) -> None:
        """Look from one of `CAMERAS`, so that the map fills what is free of the view."""
        if name not in CAMERAS:
            return
        self.chosen = name
        if name == FOLLOW:
            if place is not None:
                self.follow(place)
            return
        half = math.tan(0.5 * self._camera.fov)
        tilt = across = upright = 0.0
        for degrees in _TILT[name]:
            tilt = math.radians(degrees)
            # The southern edge is nearest to the camera and looks largest.
            nearer = HALF_WIDTH * math.cos(tilt)
            across = (HALF_WIDTH + _ROOM) / (half * window.width / window.height) + nearer
            upright = (HALF_WIDTH * math.sin(tilt) + _ROOM + 0.5) / (
                half * window.free / window.height
            ) + nearer
            if upright <= across:
                break
        distance = max(across, upright)
        shift = -window.off_middle * distance * half / math.sin(tilt)
        centre = np.array([0.0, _SOUTH + (shift if name != SIDE else 0.5 * shift), 0.0])
        away = distance * np.array([0.0, -math.cos(tilt), math.sin(tilt)])
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
