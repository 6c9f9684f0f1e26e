"""Polylines as few segments; lines of latitude and longitude with labels under a scene, and its scale bar.

Each segment costs a renderer the same, long or short: with software rendering a track of a thousand points a
method took longer to paint than everything else on the page.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import shapely

from navcore.foundation.units import ARCMIN, ARCSEC, DEG
from schuler_bench.plots.units import length_unit, number, round_down, round_up


def segments(points: np.ndarray) -> np.ndarray:
    """Polyline, shape (k, 3), as the pairs of points that viser's line segments take, shape (k - 1, 2, 3)."""
    return np.stack([points[:-1], points[1:]], axis=1)


def needed(points: np.ndarray, tolerance: float) -> np.ndarray:
    """Indices of the points with which a line passes all others by at most ``tolerance`` (Douglas-Peucker).

    Parameters
    ----------
    points : ndarray, shape (k, 3)
        The line, seen along its third axis.
    tolerance : float
        In the unit of the points.

    Returns
    -------
    ndarray of int, shape (n,)
        Rising, the first and the last known point included.
    """
    known = np.flatnonzero(np.isfinite(points).all(axis=1))
    if len(known) < 3:
        return known
    numbered = np.column_stack([points[known, :2], known])
    line = shapely.simplify(shapely.linestrings(numbered), tolerance, preserve_topology=False)
    return shapely.get_coordinates(line, include_z=True)[:, 2].astype(int)


def dashes(points: np.ndarray, length: float) -> np.ndarray:
    """Cut a polyline into dashes of a length with gaps as long, bent where the line bends.

    Parameters
    ----------
    points : ndarray of float32, shape (k, 3)
        The line.
    length : float
        Of a dash, in the unit of the points.

    Returns
    -------
    ndarray of float32, shape (n, 2, 3)
        Segments.
    """
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    at = np.union1d(along, np.arange(0.0, along[-1], length))
    cut = np.column_stack([np.interp(at, along, axis) for axis in points.T]).astype(np.float32)
    drawn = np.floor((at[:-1] + at[1:]) / (2.0 * length)).astype(int) % 2 == 0
    return segments(cut)[drawn]


# Steps of the lines, arcsec: 1-2-5 below a minute's 10, 20, 30, then the same in minutes and degrees.
_STEPS_ARCSEC = (
    0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 60.0, 120.0, 300.0, 600.0,
    1200.0, 1800.0, 3600.0, 7200.0, 18000.0, 36000.0, 72000.0, 162000.0,
)  # fmt: skip
_MOST_LINES = 7
MOST_BESIDE = 4
"""Labels of meridians that fit beside each other in a small view: where there are more, some have none."""


class SceneLabel(NamedTuple):
    """A text at a place of the scene: east, north, up."""

    text: str
    position: tuple[float, float, float]


class Graticule(NamedTuple):
    """Grid on the sea: lines, float32, shape (n, 2, 3); latitudes at the western edge, longitudes south."""

    segments: np.ndarray
    labels: tuple[SceneLabel, ...]


@dataclass(frozen=True)
class LocalMap:
    """Equirectangular map of a small part of the Earth; graticule lines are straight and evenly spaced in it.

    Attributes
    ----------
    lat0, lon0 : float
        Point at the scene's origin, rad.
    metres_per_lat, metres_per_lon : float
        Metres per radian there.
    metres_per_unit : float
        Scale of the scene.
    """

    lat0: float
    lon0: float
    metres_per_lat: float
    metres_per_lon: float
    metres_per_unit: float


def graticule(area: LocalMap, half_width: float, beside: int = MOST_BESIDE) -> Graticule:
    """Lines over the square of +-``half_width`` scene units; in metres where an arc-second is too coarse."""
    half_m = half_width * area.metres_per_unit
    lat_step = _step(2.0 * half_m / area.metres_per_lat)
    lon_step = _step(2.0 * half_m / area.metres_per_lon)
    if lat_step is None or lon_step is None:
        return _metre_grid(area, half_width, beside)
    norths = _multiples(area.lat0, half_m / area.metres_per_lat, lat_step)
    norths = norths[np.abs(norths) < 0.5 * math.pi]
    easts = _multiples(area.lon0, min(half_m / area.metres_per_lon, math.pi), lon_step)
    y = (norths - area.lat0) * area.metres_per_lat / area.metres_per_unit
    x = (easts - area.lon0) * area.metres_per_lon / area.metres_per_unit
    lat_texts = [angle_text(value, lat_step, "NS") for value in norths]
    lon_texts = [angle_text(math.remainder(value, 2.0 * math.pi), lon_step, "EW") for value in easts]
    return _assemble(x, lon_texts, y, lat_texts, half_width, beside)


def scale_bar(metres_per_unit: float, half_width: float) -> tuple[np.ndarray, SceneLabel]:
    """Bar of a round length at the south-eastern corner: its segments, shape (3, 2, 3), and its label."""
    unit = length_unit(half_width * metres_per_unit)
    value = round_down(0.4 * half_width * metres_per_unit / unit.si)
    right, y, tick = half_width, -half_width - 0.55, 0.12
    left = right - value * unit.si / metres_per_unit
    bar = [
        [[left, y, 0.0], [right, y, 0.0]],
        [[left, y - tick, 0.0], [left, y + tick, 0.0]],
        [[right, y - tick, 0.0], [right, y + tick, 0.0]],
    ]
    label = SceneLabel(f"{number(value)} {unit.name}", (0.5 * (left + right), y - 0.3, 0.0))
    return np.array(bar, dtype=np.float32), label


def angle_text(value: float, step: float, letters: str) -> str:
    """Latitude or longitude (rad) as finely as lines ``step`` (rad) apart need; ``letters`` as in "NS", "EW".

    Examples
    --------
    >>> angle_text(0.5, 1.0 * DEG, "NS"), angle_text(-0.5, 1.0 * ARCMIN, "EW"), angle_text(0.5, ARCSEC, "NS")
    ('29°N', '28°39′W', '28°38′52″N')
    """
    side = letters[0] if value >= 0.0 else letters[1]
    size = abs(value)
    if step >= DEG * (1.0 - 1e-9):
        return f"{size / DEG:.0f}°{side}"
    if step >= ARCMIN * (1.0 - 1e-9):
        minutes = round(size / ARCMIN)
        return f"{minutes // 60}°{minutes % 60:02d}′{side}"
    decimals = max(0, -math.floor(math.log10(step / ARCSEC * (1.0 + 1e-9))))
    seconds, fraction = divmod(round(size / ARCSEC * 10**decimals), 10**decimals)
    tail = f".{fraction:0{decimals}d}" if decimals else ""
    return f"{seconds // 3600}°{seconds // 60 % 60:02d}′{seconds % 60:02d}{tail}″{side}"


def _step(span_rad: float) -> float | None:
    """Angle between lines, rad; None when even the finest step is too coarse."""
    span = span_rad / ARCSEC
    if span / _STEPS_ARCSEC[0] < 2.0:
        return None
    return next((s for s in _STEPS_ARCSEC if span / s <= _MOST_LINES), _STEPS_ARCSEC[-1]) * ARCSEC


def _multiples(centre: float, half: float, step: float) -> np.ndarray:
    first, last = math.ceil((centre - half) / step), math.floor((centre + half) / step)
    return np.arange(first, last + 1) * step


def _metre_grid(area: LocalMap, half_width: float, beside: int) -> Graticule:
    half_m = half_width * area.metres_per_unit
    offsets = _multiples(0.0, half_m, round_up(2.0 * half_m / _MOST_LINES))
    unit = length_unit(half_m)
    at = offsets / area.metres_per_unit
    values = [f"{number(offset / unit.si, 4)} {unit.name}" for offset in offsets]
    return _assemble(at, [f"E {v}" for v in values], at, [f"N {v}" for v in values], half_width, beside)


def _assemble(
    x: np.ndarray, x_texts: list[str], y: np.ndarray, y_texts: list[str], half_width: float, beside: int
) -> Graticule:
    segments = np.zeros((len(x) + len(y), 2, 3), dtype=np.float32)
    segments[: len(x), :, 0] = x[:, None]
    segments[: len(x), :, 1] = (-half_width, half_width)
    segments[len(x) :, :, 0] = (-half_width, half_width)
    segments[len(x) :, :, 1] = y[:, None]
    apart = max(1, -(-len(x) // beside))
    edge = -half_width - 0.12
    south = list(zip(x_texts, x.tolist(), strict=True))[::apart]
    labels = [SceneLabel(text, (at, edge, 0.0)) for text, at in south]
    labels += [SceneLabel(text, (edge, at, 0.0)) for text, at in zip(y_texts, y.tolist(), strict=True)]
    return Graticule(segments, tuple(labels))
