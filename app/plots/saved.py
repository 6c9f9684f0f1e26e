"""Plots as files: their numbers as CSV, and plots over time as one plotly figure, which the page draws."""

import csv
import io
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from navcore.foundation.cells import safe_cell
from navcore.foundation.text import Text
from schuler_bench.plots import style
from schuler_bench.plots.legend import counts
from schuler_bench.plots.plotly_data import PlotlyFigure, figure, packed, values_of
from schuler_bench.plots.uplot import Curve, UplotFigure

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
    names = list(dict.fromkeys(curve.name for plot in plots for curve in _drawn(plot)))
    rows = style.legend_rows(names, width_px - _LEFT - _RIGHT)
    panel_px = _ONLY_PANEL_PX if len(plots) == 1 else _PANEL_PX
    inner_px = len(plots) * panel_px + (len(plots) - 1) * _GAP_PX
    height_px = _TOP + inner_px + _BOTTOM + rows * _ROW_PX
    layout = style.layout(
        margin={"l": _LEFT, "r": _RIGHT, "t": _TOP, "b": _BOTTOM + round(rows * _ROW_PX)},
        showlegend=True,
        legend=style.legend(),
        annotations=[],
        meta={"aspect": height_px / width_px},
    )
    traces: list[dict[str, Any]] = []
    named: set[str] = set()
    for place, plot in enumerate(plots):
        suffix = "" if place == 0 else str(place + 1)
        top = 1.0 - place * (panel_px + _GAP_PX) / inner_px
        across, up = plot.axes()
        lowest = place == len(plots) - 1
        layout[f"xaxis{suffix}"] = style.axis(
            across["label"] if lowest else "",
            anchor=f"y{suffix}",
            range=[float(plot.time[0]), float(np.nanmax(plot.time)) or 1.0] if len(plot.time) else [0.0, 1.0],
            showticklabels=lowest,
        )
        layout[f"yaxis{suffix}"] = style.axis(
            up["label"],
            anchor=f"x{suffix}",
            domain=[max(top - panel_px / inner_px, 0.0), top],
            **_scale(plot, up),
        )
        layout["annotations"].append(style.panel_title(style.plain(plot.title), suffix))
        traces += _traces(plot, suffix, named)
    return figure(traces, layout)


def _drawn(plot: UplotFigure) -> list[Curve]:
    """Curves that are to be seen."""
    return [c for place, c in enumerate(plot.curves) if place not in plot.edges and c.state != "hidden"]


def _traces(plot: UplotFigure, suffix: str, named: set[str]) -> list[dict[str, Any]]:
    """Bands, then curves; a name stands once in the legend of all plots (``named`` is added to)."""
    axes = {"type": "scatter", "mode": "lines", "xaxis": f"x{suffix}", "yaxis": f"y{suffix}"}
    common = axes | {"x": packed(plot.time)}
    traces: list[dict[str, Any]] = []
    for upper, lower, color in plot.bands:
        edge = common | {"line": {"width": 0}, "showlegend": False}
        low, high = (packed(plot.curves[place].values) for place in (lower, upper))
        traces += [edge | {"y": low}, edge | {"y": high, "fill": "tonexty", "fillcolor": _rgba(color)}]
    for curve in _drawn(plot):
        line = {"color": _rgba(curve.series["stroke"]), "width": curve.width}
        if curve.dash:
            line["dash"] = ",".join(f"{part}px" for part in curve.dash)
        traces.append(
            common
            | {
                "y": packed(curve.values),
                "name": style.plain(curve.name),
                "legendgroup": curve.name,
                "showlegend": curve.name not in named,
                "line": line,
            }
        )
        named.add(curve.name)
    return traces


def _rgba(color: str) -> str:
    """``#RRGGBBAA`` as plotly takes it; another colour as it is."""
    if len(color) != 9 or not color.startswith("#"):
        return color
    red, green, blue = style.rgb(color)
    return f"rgba({red},{green},{blue},{int(color[7:], 16) / 255.0:.3f})"


def _scale(plot: UplotFigure, up: dict[str, Any]) -> dict[str, Any]:
    """Range and ticks of the y axis."""
    ticks: dict[str, Any] = {"nticks": 6}
    if "splits" in up:
        ticks = {"tickvals": list(up["splits"]), "ticktext": list(up["values"])}
    if plot.decades is not None:
        return ticks | {"type": "log", "range": list(plot.decades)}
    scaled = [curve for curve in _drawn(plot) if counts(curve.state)] or _drawn(plot)
    scaled += [plot.curves[place] for place in plot.edges]
    values = np.concatenate([[], *(curve.values[np.isfinite(curve.values)] for curve in scaled)])
    low, high = (values.min(), values.max()) if len(values) else (0.0, 0.0)
    pad = _PAD * (high - low) or 0.1
    floor = low - pad if plot.floor is None else plot.floor
    return ticks | {"range": [float(floor), float(high + pad)]}


def time_csv(figures: Sequence[UplotFigure], about: Iterable[str]) -> bytes:
    """Plots on one time axis as CSV: a column a curve, with its unit; nothing where there is no curve.

    Parameters
    ----------
    figures : sequence of UplotFigure
        With the same times.
    about : iterable of str
        Lines of comment above the header.
    """
    first = figures[0]
    columns = [first.time]
    heads: list[str] = [Text("time ({name})", name=first.time_unit.name)]
    for plot in figures:
        unit = Text(" ({name})", name=plot.unit.name) if plot.unit.name else ""
        which = Text("{symbol}: ", symbol=plot.symbol) if len(figures) > 1 else ""
        heads += [
            Text("{which}{name}{unit}", which=which, name=curve.name, unit=unit) for curve in plot.curves
        ]
        columns += [curve.values for curve in plot.curves]
    quantity = Text.joined(
        "; ", (Text("{symbol}: {title}", symbol=plot.symbol, title=plot.title) for plot in figures)
    )
    return _csv([*about, quantity], heads, zip(*(column.tolist() for column in columns), strict=True))


def plotly_csv(figure: PlotlyFigure, about: Iterable[str]) -> bytes:
    """Plotly figure as CSV: a line a point, with its curve's name and the names of its axes.

    Parameters
    ----------
    figure : PlotlyFigure
        Figure; the ``y_title`` of its ``meta`` names the axes that have their title elsewhere.
    about : iterable of str
        Lines of comment above the header.
    """
    rows: list[tuple[Any, ...]] = []
    for trace in figure["data"]:
        if not trace.get("name"):
            continue  # helping lines
        axes = [_axis_title(figure["layout"], trace, which) for which in "xy"]
        pairs = zip(values_of(trace["x"]), values_of(trace["y"]), strict=True)
        rows += [(trace["name"], *axes, x, y) for x, y in pairs if x is not None]
    return _csv(about, ["curve", "x axis", "y axis", "x", "y"], rows)


def _axis_title(layout: dict[str, Any], trace: dict[str, Any], which: str) -> str:
    axis = layout.get(f"{which}axis{trace.get(f'{which}axis', which)[1:]}", {})
    if not axis.get("title", {}).get("text") and axis.get("matches"):
        axis = layout.get(f"{which}axis{axis['matches'][1:]}", {})
    text = axis.get("title", {}).get("text", "") or layout.get("meta", {}).get(f"{which}_title", "")
    return text.replace("<sub>", "").replace("</sub>", "")


def _csv(about: Iterable[str], heads: list[str], rows: Iterable[Sequence[Any]]) -> bytes:
    text = io.StringIO()
    for line in about:
        text.write(f"# {' '.join(line.split())}\n")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(safe_cell(head) for head in heads)
    writer.writerows([safe_cell(cell) for cell in row] for row in rows)
    return text.getvalue().encode()
