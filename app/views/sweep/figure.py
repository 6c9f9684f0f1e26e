"""Four small plots of one metric: over latitude, error of the log, grade of the sensors and sea state."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from navcore.foundation.text import Text
from navcore.quantities import QUANTITIES
from schuler_bench.plots import style
from schuler_bench.plots.plotly_data import PlotlyFigure, figure
from schuler_bench.plots.varied import SWEPT

if TYPE_CHECKING:
    from navcore.study.sweep import Sweep

_LEFT_PX, _RIGHT_PX, _TOP_PX, _BOTTOM_PX = 68, 18, 58, 46
_BETWEEN_ROWS_PX = 72.0
_WIDE = 20.0
"""Largest over smallest value from which a plot is logarithmic."""
_NOT_VARIED, _LONGEST_WORDS = Text("not varied"), 56
_NOTHING = {"type": "scatter", "x": [None], "y": [None], "showlegend": False, "hoverinfo": "skip"}
_EMPTY = Text("Sweep: one click runs all methods over these four.")


def sweep_figure(
    known: Mapping[str, Sweep],
    metric: str,
    methods: Mapping[str, int],
    aspect: float = 0.46,
    *,
    width_px: float = 940.0,
    note: str = "",
) -> PlotlyFigure:
    """Curves of a metric, one a method; the dotted line is the present scenario.

    Parameters
    ----------
    known : mapping of str to Sweep
        By key; a plot without one is empty.
    metric : str
        One of `navcore.study.model.OF_RUNS`.
    methods : mapping of str to int
        Names of the methods, and the places of their colours.
    aspect, width_px : float
        Height over width of the figure, and its expected width on screen.
    note : str
        What is to be heeded, above the plots.
    """
    row = QUANTITIES[metric]
    title = Text("<b>{label}</b> ({unit})", label=row.label, unit=row.shown)
    margin = {"l": _LEFT_PX, "r": _RIGHT_PX, "t": _TOP_PX, "b": _BOTTOM_PX}
    layout = style.framed(
        [*methods],
        aspect,
        width_px,
        margin,
        hovermode="closest",
        showlegend=True,
        annotations=[style.heading(Text.joined(" · ", filter(None, (title, note))), 40)],
        shapes=[],
    )
    layout["meta"]["y_title"] = Text("{label} ({unit})", label=row.label, unit=row.shown)
    inner_px = width_px - _LEFT_PX - _RIGHT_PX
    gap = _BETWEEN_ROWS_PX / max(aspect * width_px - _TOP_PX - layout["margin"]["b"], 2.0 * _BETWEEN_ROWS_PX)
    share = style.column(inner_px)
    data: list[dict[str, Any]] = []
    for place, key in enumerate(SWEPT):
        suffix = "" if place == 0 else str(place + 1)
        left, upper = place % 2 == 0, place < 2
        domains = (
            [0.0, share] if left else [1.0 - share, 1.0],
            [0.5 + 0.5 * gap, 1.0] if upper else [0.0, 0.5 - 0.5 * gap],
        )
        named = not any(trace["showlegend"] for trace in data)
        data += _panel(layout, known.get(key), key, metric, methods, suffix, domains, named)
    if not known:
        layout["annotations"].append(
            style.text(0.5, 0.5, _EMPTY, xref="paper", yref="paper", font={"size": 14, "color": style.MUTED})
        )
    return figure(data, layout)


def refusals(known: Mapping[str, Sweep]) -> tuple[str, ...]:
    """Reasons why something is not varied that have no room in the plots."""
    return tuple(
        Text("{title} is not varied: {words}", title=SWEPT[key][0], words=found.words)
        for key, found in known.items()
        if len(found.words) > _LONGEST_WORDS
    )


def _panel(
    layout: dict[str, Any],
    found: Sweep | None,
    key: str,
    metric: str,
    methods: Mapping[str, int],
    suffix: str,
    domains: tuple[list[float], list[float]],
    named: bool,
) -> list[dict[str, Any]]:
    """Add the axes, title and present value of a plot to a layout; return its curves."""
    title, label = SWEPT[key]
    layout[f"xaxis{suffix}"] = x = style.axis(label, domain=domains[0], anchor=f"y{suffix}", nticks=7)
    layout[f"yaxis{suffix}"] = y = style.axis(domain=domains[1], anchor=f"x{suffix}", nticks=5)
    if found is None or not found.metrics:
        x.update(showticklabels=False, showgrid=False, range=[0.0, 1.0])
        y.update(showticklabels=False, showgrid=False, range=[0.0, 1.0])
        if found is not None:
            words = Text("not varied: {words}", words=found.words)
            words = words if len(words) <= _LONGEST_WORDS else _NOT_VARIED
            place = {"xref": f"x{suffix} domain", "yref": f"y{suffix} domain"}
            layout["annotations"].append(
                style.text(0.5, 0.5, words, **place, font={"size": 13, "color": style.MUTED})
            )
        layout["annotations"].append(style.panel_title(title, suffix))
        # plotly lays out no axis that has no trace
        return [_NOTHING | {"xaxis": f"x{suffix}", "yaxis": f"y{suffix}"}]
    rows = found.metrics[metric]
    numbers = [value for values in rows for value in values if value is not None]
    positive = [value for value in numbers if value > 0.0]
    if key == "grade":
        marks = [mark for mark in (0.1, 0.3, 1.0, 3.0, 10.0) if found.values[0] <= mark <= found.values[-1]]
        x.update(type="log", tickvals=marks, ticktext=[f"{mark:g}" for mark in marks])
    if positive and len(positive) == len(numbers) and max(positive) > _WIDE * min(positive):
        decades = range(math.floor(math.log10(min(positive))), math.ceil(math.log10(max(positive))) + 1)
        y.update(
            type="log",
            tickvals=[10.0**k for k in decades],
            ticktext=[style.power(k) for k in decades],
        )
    else:
        y.update(rangemode="tozero")
    lost = sum(len(values) for values in rows) - len(numbers)
    if lost:
        title = Text("{title}: {lost} runs without a value", title=title, lost=lost)
    layout["annotations"].append(style.panel_title(title, suffix))
    layout["shapes"].append(style.upright(found.present, f"x{suffix}", f"y{suffix} domain"))
    unit = QUANTITIES[metric].shown
    curves = []
    for (name, place), values in zip(methods.items(), rows, strict=True):
        hover = Text(
            "<b>{method}</b><br>{label} %{{x:.4g}}<br>%{{y:.4g}} {unit}<extra></extra>",
            method=style.plain(name),
            label=SWEPT[key][0],
            unit=unit,
        )
        line = style.lines(name, place) | {"mode": "lines+markers", "marker": {"size": 5}}
        where = {"xaxis": f"x{suffix}", "yaxis": f"y{suffix}"}
        shown = {"x": [*found.values], "y": [*values], "hovertemplate": hover, "showlegend": named}
        curves.append(line | where | shown)
    return curves
