"""Polylines as few segments: what a line looks like, without the points that nobody could see.

Each segment costs a renderer the same, long or short: with software rendering a track of a thousand points a
method took longer to paint than everything else on the page.
"""

from __future__ import annotations

import numpy as np
import shapely


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
        Rising, the first and the last point included.
    """
    count = len(points)
    if count < 3:
        return np.arange(count)
    numbered = np.column_stack([points[:, :2], np.arange(count)])
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
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    at = np.union1d(along, np.arange(0.0, along[-1], length))
    cut = np.column_stack([np.interp(at, along, axis) for axis in points.T]).astype(np.float32)
    drawn = np.floor((at[:-1] + at[1:]) / (2.0 * length)).astype(int) % 2 == 0
    return segments(cut)[drawn]
