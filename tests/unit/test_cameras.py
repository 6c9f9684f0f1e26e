"""The cameras of the 3D view show the whole map in what instruments and bar leave free."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from app.views.scene.cameras import CAMERAS, FOLLOW, SIDE, Cameras, Window
from app.views.scene.track import HALF_WIDTH

FOV = math.radians(75.0)
WINDOWS = (
    Window(580, 1080, 285, 132),
    Window(312, 720, 195, 176),
    Window(600, 380, 0, 52),
    Window(1280, 720, 195, 52),
    Window(3000, 600, 195, 132),
)


def seen(camera: Any, window: Window, point: tuple[float, float]) -> tuple[float, float]:
    """Where a place of the map is in the window, px from its upper left corner."""
    position: np.ndarray = np.array(camera.position, dtype=float)
    ahead: np.ndarray = np.array(camera.look_at, dtype=float) - position
    ahead /= np.linalg.norm(ahead)
    right: np.ndarray = np.cross(ahead, np.array(camera.up_direction, dtype=float))
    right /= np.linalg.norm(right)
    away = np.array([*point, 0.0]) - position
    scale = 0.5 * window.height / math.tan(0.5 * FOV) / float(np.dot(away, ahead))
    x, y = (scale * float(np.dot(away, side)) for side in (right, np.cross(ahead, right)))
    return 0.5 * window.width + x, 0.5 * window.height + y


@pytest.mark.parametrize("name", [name for name in CAMERAS if name != FOLLOW])
@pytest.mark.parametrize("window", WINDOWS, ids=lambda window: f"{window.width}x{window.height}")
def test_the_map_fills_what_is_free(name: str, window: Window) -> None:
    camera: Any = SimpleNamespace(fov=FOV, position=None, look_at=None, up_direction=None)
    Cameras(camera).choose(name, window, None)
    edges = [(x, y) for x in (-HALF_WIDTH, HALF_WIDTH) for y in (-HALF_WIDTH, HALF_WIDTH)]
    left, top = np.min([seen(camera, window, edge) for edge in edges], axis=0)
    right, bottom = np.max([seen(camera, window, edge) for edge in edges], axis=0)
    bar = seen(camera, window, (HALF_WIDTH, -HALF_WIDTH - 1.4))[1]
    assert left >= 0.05 * window.width and right <= 0.95 * window.width
    assert top >= window.above - 1 and bar <= window.height - window.below - 17
    # One of the two directions is filled, and what is left of the other is the same on both sides.
    across = (right - left) / window.width
    arrow = seen(camera, window, (-HALF_WIDTH, HALF_WIDTH + 0.5))[1]
    above, below = arrow - window.above, window.height - window.below - 18 - bar
    assert left == pytest.approx(window.width - right)
    if name != SIDE:  # from there the map is low, and its far edge near the horizon
        assert across > 0.79 or above + below < 3.0
        assert abs(above - below) <= 0.2 * (window.height - window.above - window.below)
