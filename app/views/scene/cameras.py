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
"""Scene units east and west of the map for its labels."""
_SOUTH, _NORTH = -HALF_WIDTH - 1.4, HALF_WIDTH + 0.5
"""How far labels and scale bar, and the arrow to the north, reach beyond the map's edges."""
_LABEL_PX = 18
"""Height of the scale bar's label, which is as high from afar."""
_UP_TO = 0.5
"""Part of the way from the view's middle to the horizon that the map may reach up."""
_LEAST_PX = 120
"""Height that the map gets in the smallest view."""
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
    def free(self) -> tuple[float, float]:
        """Lower and upper end of what is left for the map, from the view's middle, over half its height."""
        low = min(self.below + _LABEL_PX, self.height - self.above - _LEAST_PX)
        return 2.0 * low / self.height - 1.0, 1.0 - 2.0 * self.above / self.height


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
        distance = north = tilt = 0.0
        for degrees in _TILT[name]:
            tilt = math.radians(degrees)
            distance, north, wide = _fit(tilt, half, window)
            if wide:
                break
        centre = np.array([0.0, north, 0.0])
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


def _fit(tilt: float, half: float, window: Window) -> tuple[float, float, bool]:
    """Distance of a camera at an elevation (rad), how far north it looks, and whether the width is filled.

    ``half`` is the tangent of half the camera's angle of view. What lies y north of the map's middle is seen
    (y - n) sin(tilt) / (distance + (y - n) cos(tilt)) / half above the view's middle, as a part of half its
    height, n being how far north it looks.
    """
    ends = np.minimum(np.array(window.free) * half, _UP_TO * math.tan(tilt))
    sizes = math.sin(tilt) - ends * math.cos(tilt)  # near and far things look larger and smaller
    low, high = ends / sizes
    upright = float((_NORTH - _SOUTH) / (high - low))
    # With as much room above as below n is ``middle + slope * distance``; the southern edge looks widest.
    weights = sizes**2 / np.sum(sizes**2)
    middle, slope = float(weights @ (_SOUTH, _NORTH)), -float(weights @ (low, high))
    edge = (HALF_WIDTH + _ROOM) * window.height / (half * window.width)
    across = (edge + (HALF_WIDTH + middle) * math.cos(tilt)) / (1.0 - slope * math.cos(tilt))
    distance = max(across, upright)
    return distance, middle + slope * distance, upright <= across
