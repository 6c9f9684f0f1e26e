"""Curves of the Bode plots, magnitude above phase, and vertical axes as wide as they need."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from app.plots import style
from app.plots.plotly_data import packed

_MOST_DECADES = 8.0
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
    both = common | {"x": NOTHING if curves is None else x, "xaxis": xaxis}
    return [
        both | {"y": y, "yaxis": yaxis, "hovertemplate": text, "showlegend": yaxis == "y"}
        for y, yaxis, text in zip(ys, yaxes, (hover, "%{y:.1f}°"), strict=True)
    ]


def level_axis(title: str, curves: list[np.ndarray]) -> dict[str, Any]:
    """Axis of curves in dB."""
    return _even_axis(title, curves, 160.0, 6.0, (1.0, 2.0, 5.0, 10.0, 20.0, 40.0))


def phase_axis(curves: list[np.ndarray]) -> dict[str, Any]:
    """Axis of phases in degrees."""
    return _even_axis("phase (°)", curves, 1800.0, 40.0, (15.0, 30.0, 45.0, 90.0, 180.0, 360.0))


def _even_axis(
    title: str, curves: list[np.ndarray], widest: float, least: float, steps: tuple[float, ...]
) -> dict[str, Any]:
    low, high = _range(curves, widest=widest, least=least)
    step = _tick_step(high - low, steps)
    return style.axis(title, range=_calm(low, high, step), dtick=step)


def log_axis(title: str, curves: list[np.ndarray]) -> dict[str, Any]:
    """Logarithmic axis of positive curves."""
    low, high = _range([np.log10(c[c > 0.0]) for c in curves], widest=_MOST_DECADES, least=1.0)
    step = int(_tick_step(high - low, (1.0, 2.0, 3.0, 4.0)))
    low, high = _calm(low, high, 0.5)
    decades = [k for k in range(math.ceil(low), math.floor(high) + 1) if k % step == 0]
    return style.axis(
        title,
        type="log",
        range=[low, high],
        tickvals=[10.0**k for k in decades],
        ticktext=[style.power(k) for k in decades],
        minor={"showgrid": True, "dtick": 1, "gridcolor": style.GRID_FINE},
    )


def _tick_step(span: float, steps: tuple[float, ...], most: float = 5.0) -> float:
    return next((step for step in steps if span <= most * step), steps[-1])


def _calm(low: float, high: float, step: float) -> list[float]:
    """Range out to half steps: the axis stands still while a slider moves the curves, and is not laid out."""
    half = 0.5 * step
    return [half * math.floor(low / half), half * math.ceil(high / half)]


def _range(curves: list[np.ndarray], *, widest: float, least: float) -> tuple[float, float]:
    """Range over all finite values: padded, at least ``least``, at most ``widest`` below the top."""
    values = np.concatenate([[], *(curve[np.isfinite(curve)] for curve in curves)])
    if not len(values):
        return -least, least
    top, bottom = float(np.max(values)), float(np.min(values))
    bottom = max(bottom, top - widest)
    pad = max(0.06 * (top - bottom), 0.5 * (least - (top - bottom)))
    return bottom - pad, top + pad
