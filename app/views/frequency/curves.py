"""One frequency response as two traces, magnitude above phase."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from app.plots.plotly_data import packed

NOTHING = packed(np.array([]))


def decibel(value: np.ndarray) -> np.ndarray:
    """Magnitude in dB; -inf for 0."""
    size = np.abs(value)
    return 20.0 * np.log10(size, out=np.full(size.shape, -np.inf), where=size > 0.0)


def phase(value: np.ndarray) -> np.ndarray:
    """Continuous phase in deg that starts within (-180, 180]; numpy's unwrap takes five times as long."""
    turns = np.angle(value) / (2.0 * math.pi)
    turns[1:] -= np.cumsum(np.rint(np.diff(turns)))
    return 360.0 * turns


def pair(
    common: dict[str, Any],
    x: dict[str, str],
    curves: tuple[np.ndarray, np.ndarray] | None,
    xaxis: str,
    yaxes: tuple[str, str],
    hover: str,
) -> list[dict[str, Any]]:
    """Magnitude and phase traces in one column; empty ones keep their place in the legend.

    Parameters
    ----------
    common : dict
        What both traces share: name, group, line.
    x : dict
        Packed frequencies, rad/s.
    curves : (ndarray, ndarray) or None
        Magnitude in the axis's unit, and phase in deg.
    xaxis : str
        Of the column; the legend stands in the first one's magnitude.
    yaxes : (str, str)
        Of magnitude and phase.
    hover : str
        How the magnitude is told.
    """
    ys = (NOTHING, NOTHING) if curves is None else tuple(packed(curve) for curve in curves)
    both = {"type": "scatter", "mode": "lines", "x": NOTHING if curves is None else x, "xaxis": xaxis}
    return [
        common | both | {"y": y, "yaxis": yaxis, "hovertemplate": text, "showlegend": yaxis == "y"}
        for y, yaxis, text in zip(ys, yaxes, (hover, "%{y:.1f}°"), strict=True)
    ]
