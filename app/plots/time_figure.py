"""Plots over time as one plotly figure, which the page's script turns into a file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from app.plots import style
from app.plots.legend import counts
from app.plots.plotly_data import PlotlyFigure, figure, packed
from app.plots.uplot import UplotFigure

WIDTH_PX = 900.0
_PANEL_PX, _ONLY_PANEL_PX = 150.0, 300.0
_GAP_PX, _ROW_PX = 34.0, 22.0
_LEFT, _RIGHT, _TOP, _BOTTOM = 78, 18, 30, 46
_PAD = 0.06


def time_figure(plots: Sequence[UplotFigure], *, width_px: float = WIDTH_PX) -> PlotlyFigure:
    """Plots over time as a plotly figure, below each other on one time axis, with one legend.

    Parameters
    ----------
    plots : sequence of UplotFigure
        With the same times; at least one.
    width_px : float
        Width of the picture.
    """
    names = list(dict.fromkeys(name for plot in plots for name in _drawn_names(plot)))
    rows = style.legend_rows(names, width_px - _LEFT - _RIGHT)
    panel_px = _ONLY_PANEL_PX if len(plots) == 1 else _PANEL_PX
    inner_px = len(plots) * panel_px + (len(plots) - 1) * _GAP_PX
    height_px = _TOP + inner_px + _BOTTOM + rows * _ROW_PX
    made = style.layout(
        margin={"l": _LEFT, "r": _RIGHT, "t": _TOP, "b": _BOTTOM + round(rows * _ROW_PX)},
        showlegend=True,
        legend=style.legend(),
        annotations=[],
        meta={"aspect": height_px / width_px},
    )
    traces: list[dict[str, Any]] = []
    shown: set[str] = set()
    for place, plot in enumerate(plots):
        suffix = "" if place == 0 else str(place + 1)
        top = 1.0 - place * (panel_px + _GAP_PX) / inner_px
        across, up = plot.axes()
        lowest = place == len(plots) - 1
        time = plot.data[0]
        made[f"xaxis{suffix}"] = style.axis(
            across["label"] if lowest else "",
            anchor=f"y{suffix}",
            range=[float(time[0]), float(np.nanmax(time)) or 1.0] if len(time) else [0.0, 1.0],
            showticklabels=lowest,
        )
        made[f"yaxis{suffix}"] = style.axis(
            up["label"],
            anchor=f"x{suffix}",
            domain=[max(top - panel_px / inner_px, 0.0), top],
            **_scale(plot, up),
        )
        made["annotations"].append(style.panel_title(style.plain(plot.title), suffix))
        traces += _traces(plot, suffix, shown)
    return figure(traces, made)


def _drawn(plot: UplotFigure) -> list[int]:
    """Places of the curves that are to be seen."""
    return [at for at in range(len(plot.names)) if at not in plot.edges and plot.state(at) != "hidden"]


def _drawn_names(plot: UplotFigure) -> list[str]:
    return [plot.names[at] for at in _drawn(plot)]


def _traces(plot: UplotFigure, suffix: str, shown: set[str]) -> list[dict[str, Any]]:
    """Bands, then curves; a name stands once in the legend of all plots (``shown`` is added to)."""
    axes = {"type": "scatter", "mode": "lines", "xaxis": f"x{suffix}", "yaxis": f"y{suffix}"}
    time = packed(plot.data[0])
    made: list[dict[str, Any]] = []
    for upper, lower, color in plot.bands:
        edge = axes | {"x": time, "line": {"width": 0}, "showlegend": False}
        filled = {"fill": "tonexty", "fillcolor": _rgba(color)}
        made += [
            edge | {"y": packed(plot.data[1 + lower])},
            edge | {"y": packed(plot.data[1 + upper])} | filled,
        ]
    series = plot.series[1:]
    for at in _drawn(plot):
        line = {"color": _rgba(series[at]["stroke"]), "width": series[at]["width"]}
        if "dash" in series[at]:
            line["dash"] = ",".join(f"{part}px" for part in series[at]["dash"])
        name = plot.names[at]
        made.append(
            axes
            | {
                "x": time,
                "y": packed(plot.data[1 + at]),
                "name": style.plain(name),
                "legendgroup": name,
                "showlegend": name not in shown,
                "line": line,
            }
        )
        shown.add(name)
    return made


def _rgba(color: str) -> str:
    """``#RRGGBBAA`` as plotly takes it; another colour as it is."""
    if len(color) != 9 or not color.startswith("#"):
        return color
    red, green, blue = style.rgb(color)
    return f"rgba({red},{green},{blue},{int(color[7:], 16) / 255.0:.3f})"


def _scale(plot: UplotFigure, up: dict[str, Any]) -> dict[str, Any]:
    """Range and ticks of the y axis."""
    made: dict[str, Any] = {"nticks": 6}
    if "splits" in up:
        made = {"tickvals": list(up["splits"]), "ticktext": list(up["values"])}
    if plot.decades is not None:
        return made | {"type": "log", "range": list(plot.decades)}
    scaled = [at for at in _drawn(plot) if counts(plot.state(at))] or _drawn(plot)
    scaled += [at for at in plot.edges]
    values = [found for at in scaled if len(found := _finite(plot.data[1 + at]))]
    low, high = (min(map(np.min, values)), max(map(np.max, values))) if values else (0.0, 0.0)
    pad = _PAD * (high - low) or 0.1
    floor = low - pad if plot.floor is None else plot.floor
    return made | {"range": [float(floor), float(high + pad)]}


def _finite(values: np.ndarray) -> np.ndarray:
    return values[np.isfinite(values)]
