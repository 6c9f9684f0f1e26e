"""Plots as files: the plotted numbers as CSV, and plots over time as SVG or PNG."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from app.plots import style
from app.plots.fonts import picture_fonts
from app.plots.plotly_data import PlotlyFigure, values_of
from app.plots.uplot import UplotFigure

_WIDTH_IN, _HEIGHT_IN, _DPI = 9.0, 2.6, 160


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
    several = len(figures) > 1
    columns, heads = [first.data[0]], [f"time ({first.time_unit.name})"]
    for figure in figures:
        for name, values in zip(figure.names, figure.data[1:], strict=True):
            unit = f" ({figure.unit.name})" if figure.unit.name else ""
            heads.append(f"{figure.symbol}: {name}{unit}" if several else f"{name}{unit}")
            columns.append(values)
    quantity = "; ".join(f"{figure.symbol}: {figure.title}" for figure in figures)
    return _csv([*about, quantity], heads, zip(*(column.tolist() for column in columns), strict=True))


def plotly_csv(figure: PlotlyFigure, about: Iterable[str]) -> bytes:
    """Plotly figure as CSV: a line a point, with its curve's name and the names of its axes.

    Parameters
    ----------
    figure : PlotlyFigure
        Figure.
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
    text = axis.get("title", {}).get("text", "")
    return text.replace("<sub>", "").replace("</sub>", "")


def _csv(about: Iterable[str], heads: list[str], rows: Iterable[Sequence[Any]]) -> bytes:
    text = io.StringIO()
    for line in about:
        text.write(f"# {' '.join(line.split())}\n")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(_safe(head) for head in heads)
    writer.writerows([_safe(cell) for cell in row] for row in rows)
    return text.getvalue().encode()


def _safe(cell: Any) -> Any:
    """Cell as a table program takes it: gaps empty, and no text that it would carry out as a formula."""
    if isinstance(cell, float):
        return "" if not math.isfinite(cell) else repr(cell)
    if isinstance(cell, str) and cell[:1] in ("=", "+", "-", "@", "\t"):
        return f"'{cell}"
    return cell


def time_picture(figures: Sequence[UplotFigure], format: str, title: str) -> bytes:
    """Plots over time as a picture, below each other on one time axis.

    Parameters
    ----------
    figures : sequence of UplotFigure
        With the same times.
    format : {"svg", "png"}
        Of the file.
    title : str
        Above the plots.
    """
    settings: dict[Any, Any] = {"font.size": 9, "svg.fonttype": "none", "svg.hashsalt": "schuler"}
    with picture_fonts(settings):
        return _time_picture(figures, format, title)


def _time_picture(figures: Sequence[UplotFigure], format: str, title: str) -> bytes:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    height = _HEIGHT_IN * (1.0 if len(figures) > 1 else 1.5) * len(figures)
    picture = Figure(figsize=(_WIDTH_IN, height), layout="constrained")
    FigureCanvasAgg(picture)
    axes = picture.subplots(len(figures), 1, sharex=True, squeeze=False)[:, 0]
    picture.suptitle(_plain(title), fontsize=10)
    for axis, figure in zip(axes, figures, strict=True):
        _draw(axis, figure)
    axes[-1].set_xlabel(f"time ({figures[-1].time_unit.name})")
    made = io.BytesIO()
    picture.savefig(made, format=format, dpi=_DPI, metadata={"Date": None} if format == "svg" else None)
    return made.getvalue()


def _draw(axis: Any, figure: UplotFigure) -> None:
    time, edges = figure.data[0], figure.edges
    for upper, lower, color in figure.bands:
        shade = color[:7], int(color[7:9], 16) / 255.0
        axis.fill_between(
            time, figure.data[1 + lower], figure.data[1 + upper], color=shade[0], alpha=shade[1], linewidth=0
        )
    for place, (name, color) in enumerate(zip(figure.names, figure.colors, strict=True)):
        if place in edges or figure.state(place) == "hidden":
            continue
        dash = figure.dashes[place] if place < len(figure.dashes) else ()
        width = figure.widths[place] if place < len(figure.widths) else style.CURVE_WIDTH
        pattern = (0, tuple(0.75 * part for part in dash)) if dash else "-"
        axis.plot(
            time,
            figure.data[1 + place],
            color=color,
            linewidth=0.75 * width,
            linestyle=pattern,
            label=_plain(name),
        )
    if figure.decades is not None:
        axis.set_yscale("log")
        axis.set_ylim(10.0 ** figure.decades[0], 10.0 ** figure.decades[1])
    if figure.ticks:
        axis.set_yticks([at for at, _ in figure.ticks], [word for _, word in figure.ticks])
    if figure.floor is not None:
        axis.set_ylim(bottom=figure.floor)
    if len(time):
        axis.set_xlim(float(time[0]), float(np.nanmax(time)) or 1.0)
    unit = f" ({figure.unit.name})" if figure.unit.name else ""
    axis.set_ylabel(f"{_plain(figure.symbol)}{unit}")
    axis.grid(color=style.GRID, linewidth=0.6)
    axis.legend(fontsize=8, frameon=False, ncols=2, loc="best")


def _plain(text: str) -> str:
    """Text in which matplotlib sees no formula."""
    return text.replace("$", r"\$")
