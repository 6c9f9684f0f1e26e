"""The whole system: modes of both channels with heading and latitude, and the growth over the latitude."""

from __future__ import annotations

from typing import Any

import numpy as np

from app.plots import style
from app.plots.earth_mode import earth_mode_text
from app.plots.plotly_data import PlotlyFigure, figure, packed
from navcore.analysis.whole_system import (
    EARTH_MODE,
    NETWORK_MODE,
    SCHULER_MODE,
    Mode,
    duration,
    growth_over_latitude,
)
from navcore.engine.run import MethodRun, Run
from navcore.foundation.units import DEG

LATITUDES = np.linspace(0.0, 85.0, 18)
"""Of the curve, deg; north and south are alike."""
_DAY = 86400.0
_SYMBOLS = {EARTH_MODE: "diamond", SCHULER_MODE: "x-thin", NETWORK_MODE: "circle-open"}
_RE, _IM = (-2.2, 0.5), (-0.09, 1.75)
_MARGIN = {"l": 58, "r": 16, "t": 32}
_GAP = 0.11


def whole_system_figure(run: Run, aspect: float = 0.46, *, width_px: float = 940.0) -> PlotlyFigure:
    """Modes near the Schuler frequency (left), and the growth of the 24 h mode over the latitude (right).

    Parameters
    ----------
    run : Run
        Result; the modes are those at its site.
    aspect : float
        Height / width of the figure.
    width_px : float
        Expected width on screen.
    """
    names = [m.method.name for m in run.methods]
    rows = style.legend_rows([*names, *(f"{kind} mode" for kind in _SYMBOLS)], width_px - 84.0)
    margin = _MARGIN | {"b": 56 + 22 * rows}
    data: list[dict[str, Any]] = []
    rates = [_rates(run, method) for method in run.methods]
    for index, method in enumerate(run.methods):
        data += _marks(method, index)
        data += _growth(run, method, index, rates[index])
    data += [_key(name) for name in _SYMBOLS]
    return figure(data, _layout(run, margin, aspect, _growth_range(rates)))


def _marks(method: MethodRun, index: int) -> list[dict[str, Any]]:
    """Modes of one method in units of omega_s, one trace a kind of mode."""
    color, name = style.method_color(index), style.plain(method.method.name)
    made = []
    for kind, symbol in _SYMBOLS.items():
        modes = method.whole.named(kind)
        at = np.array([mode.eigenvalue for mode in modes], dtype=np.complex128) / method.network.omega_s
        made.append(
            {
                "type": "scatter",
                "mode": "markers",
                "name": name if kind == SCHULER_MODE else f"{name} {kind}",
                "legendgroup": str(index),
                "showlegend": kind == SCHULER_MODE,
                "x": packed(np.real(at)),
                "y": packed(np.imag(at)),
                "text": [_about(mode) for mode in modes],
                "hovertemplate": f"<b>{name}</b><br>%{{text}}<extra></extra>",
                "marker": {
                    "symbol": symbol,
                    # The 24 h modes of all methods lie next to each other: the later ones are smaller.
                    "size": max(15 - 4 * index, 5) if kind == EARTH_MODE else 11,
                    "color": color,
                    "line": {"color": color, "width": 2.4},
                },
            }
        )
    return made


def _about(mode: Mode) -> str:
    lines = [f"{mode.name} mode"]
    if mode.eigenvalue.imag > 0.0:
        lines.append(f"period {duration(2.0 * np.pi / mode.eigenvalue.imag)}, ζ {mode.damping_ratio:.3f}")
    if abs(mode.growth) > 1e-12:
        lines.append(earth_mode_text(mode.growth))
    return "<br>".join(lines)


def _rates(run: Run, method: MethodRun) -> np.ndarray:
    """Growth of the 24 h mode at each of `LATITUDES`, 1/day."""
    return _DAY * growth_over_latitude(
        method.network, method.method.damping, LATITUDES * DEG, run.scenario.earth
    )


def _growth_range(rates: list[np.ndarray]) -> list[float]:
    """Range of the axis: all curves and 0, with a margin."""
    found = np.concatenate(rates)
    found = found[np.isfinite(found)]
    low, high = min(0.0, *found), max(0.0, *found)
    margin = max(0.08 * (high - low), 0.01)
    return [low - margin, high + margin]


def _growth(run: Run, method: MethodRun, index: int, rates: np.ndarray) -> list[dict[str, Any]]:
    """Curve of the growth over the latitude, and the point of the site."""
    color, name = style.method_color(index), style.plain(method.method.name)
    here = method.whole.earth_growth
    common: dict[str, Any] = {
        "type": "scatter",
        "xaxis": "x2",
        "yaxis": "y2",
        "legendgroup": str(index),
        "showlegend": False,
    }
    return [
        common
        | {
            "mode": "lines",
            "name": f"{name} growth",
            "x": packed(LATITUDES),
            "y": packed(rates),
            "line": {"color": color, "width": 2},
            "hovertemplate": f"<b>{name}</b><br>%{{x:.0f}}°: %{{y:+.3f}} a day<extra></extra>",
        },
        common
        | {
            "mode": "markers",
            "name": f"{name} at the site",
            "x": [abs(run.scenario.site.lat_deg)],
            "y": [here * _DAY],
            "marker": {"symbol": "diamond", "size": 11, "color": color},
            "text": [f"24 h mode {earth_mode_text(here)}"],
            "hovertemplate": f"<b>{name}</b> at the site<br>%{{text}}<extra></extra>",
        },
    ]


def _key(name: str) -> dict[str, Any]:
    """Legend entry that says what a mark means."""
    marker = {"symbol": _SYMBOLS[name], "size": 10, "color": style.MUTED}
    return {
        "type": "scatter", "mode": "markers", "x": [None], "y": [None], "name": f"{name} mode",
        "hoverinfo": "skip", "marker": marker | {"line": {"color": style.MUTED, "width": 2}},
    }  # fmt: skip


def _layout(run: Run, margin: dict[str, int], aspect: float, growth: list[float]) -> dict[str, Any]:
    made = style.layout(margin=margin, hovermode="closest", legend=style.legend(), meta={"aspect": aspect})
    half = 0.5 * (1.0 - _GAP)
    made["xaxis"] = style.axis("Re s / ω<sub>s</sub>", domain=[0.0, half], range=list(_RE), anchor="y")
    made["yaxis"] = style.axis("Im s / ω<sub>s</sub>", range=list(_IM), anchor="x")
    made["xaxis2"] = style.axis("latitude (°)", domain=[1.0 - half, 1.0], range=[0.0, 90.0], anchor="y2")
    made["yaxis2"] = style.axis("growth, 1/day", anchor="x2", range=growth)
    line = {"type": "line", "line": {"color": style.DANGER, "width": 1.4}, "layer": "below"}
    shapes = [
        line | {"xref": "x", "yref": "y domain", "x0": 0.0, "x1": 0.0, "y0": 0.0, "y1": 1.0},
        line | {"xref": "x2 domain", "yref": "y2", "x0": 0.0, "x1": 1.0, "y0": 0.0, "y1": 0.0},
    ]
    lat = run.scenario.site.lat_deg
    notes = [
        style.panel_title(f"Whole system at {abs(lat):.4g}° {'N' if lat >= 0.0 else 'S'}", ""),
        style.panel_title("Growth of the 24 h mode", "2"),
    ]
    return made | {"shapes": shapes, "annotations": notes}
