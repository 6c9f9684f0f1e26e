"""A small ship for the 3D scene, made in code: hull, deck, superstructure, funnel and mast in body axes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

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
    starts = range(0, len(edges) - 2, 2)
    faces = [face for a in starts for face in ((a, a + 2, a + 1), (a + 2, a + 3, a + 1))]
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
