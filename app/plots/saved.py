"""The plotted numbers as CSV."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Sequence
from typing import Any

from app.plots.plotly_data import PlotlyFigure, values_of
from app.plots.uplot import UplotFigure
from navcore.foundation.text import Text


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
    for figure in figures:
        unit = f" ({figure.unit.name})" if figure.unit.name else ""
        which = f"{figure.symbol}: " if len(figures) > 1 else ""
        heads += [f"{which}{curve.name}{unit}" for curve in figure.curves]
        columns += [curve.values for curve in figure.curves]
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
