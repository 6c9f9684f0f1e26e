"""Vertical axes of the Bode plots, as wide as their curves need."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from app.plots import style

_MOST_DECADES = 8.0


def level_axis(title: str, curves: list[np.ndarray]) -> dict[str, Any]:
    """Axis of curves in dB."""
    low, high = _range(curves, widest=160.0, least=6.0)
    step = _tick_step(high - low, (1.0, 2.0, 5.0, 10.0, 20.0, 40.0))
    return style.axis(title, range=_calm(low, high, step), dtick=step)


def phase_axis(curves: list[np.ndarray]) -> dict[str, Any]:
    """Axis of phases in degrees."""
    low, high = _range(curves, widest=1800.0, least=40.0)
    step = _tick_step(high - low, (15.0, 30.0, 45.0, 90.0, 180.0, 360.0))
    return style.axis("phase (°)", range=_calm(low, high, step), dtick=step)


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
        ticktext=[f"{10.0**k:g}" if -3 <= k <= 4 else f"10<sup>{k}</sup>" for k in decades],
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
    finite = [c[np.isfinite(c)] for c in curves]
    values = np.concatenate(finite) if finite else np.array([])
    if len(values) == 0:
        return -least, least
    top, bottom = float(np.max(values)), float(np.min(values))
    bottom = max(bottom, top - widest)
    pad = max(0.06 * (top - bottom), 0.5 * (least - (top - bottom)))
    return bottom - pad, top + pad
