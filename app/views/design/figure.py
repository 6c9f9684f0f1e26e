"""The error budget as stacked bars: one bar a method, one colour a source, the floor drawn in."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from app.plots import style
from app.plots.plotly_data import PlotlyFigure, figure
from app.plots.units import number
from navcore.design.budget import Budget, MethodBudget
from navcore.foundation.units import ARCMIN, ARCSEC

SOURCES = {
    "gyro_white": ("gyro white noise", "#1F5A91"),
    "gyro_drift": ("gyro drift", "#5B9BD5"),
    "gyro_bias": ("gyro bias", "#A9CCEA"),
    "accel_white": ("accelerometer white noise", "#A03B4C"),
    "accel_drift": ("accelerometer drift", "#D9788A"),
    "accel_bias": ("accelerometer bias", "#F0BCC5"),
    "log_white": ("log white noise", "#1E6B3A"),
    "log_drift": ("log drift", "#5FAE6F"),
    "log_bias": ("log bias", "#B5DDBB"),
    "log_tide": ("tide", "#7A7A18"),
    "initial_tilt": ("initial tilt", "#8A8F98"),
    "initial_heading": ("initial heading", "#5B6169"),
    "initial_velocity": ("initial velocity", "#B4B8BE"),
    "initial_position": ("initial position", "#D5D8DC"),
}
"""A source of `navcore.design` in words, and its colour: blue the gyros, red the accelerometers, green the
log, grey the start. Other sources are shown by their own name."""
_OTHER = "#C9A227"
_LEAST_SHARE = 0.005
"""A source with a smaller part of every bar is left out of the legend and joins the last one."""
QUANTITIES = (
    ("tilt_rad", "Tilt", "arcsec", ARCSEC),
    ("velocity_mps", "Velocity", "m/s", 1.0),
    ("heading_rad", "Heading", "arcmin", ARCMIN),
    ("position_m", "Position", "m", 1.0),
)
_HEADROOM = {1: 1.2, 2: 1.4}
"""Height of an axis over that of its bars, by the lines of text above a bar."""
_ONE_LINE_PX = 112
"""Room a bar needs for its text in one line."""
_LEFT_PX, _RIGHT_PX, _TOP_PX = 62, 12, 52
_NOTE_PX = 26
"""Of the line about the whole figure above the panels, so that it stands clear of their titles."""
_TICKS_PX, _LEGEND_ROW_PX = 34, 21


def budget_figure(
    budget: Budget, aspect: float = 0.46, *, width_px: float = 940.0, note: str = ""
) -> PlotlyFigure:
    """Stacked bars of every quantity.

    The height of a bar is the standard deviation of all sources together; a source takes the part of the
    height that it has of the variance, so that the parts add up.

    Parameters
    ----------
    budget : Budget
        Of the scenario.
    aspect : float
        Height / width of the figure.
    width_px : float
        Expected width on screen.
    note : str
        What else the title says, e.g. that a newer budget is being computed.
    """
    shown = QUANTITIES[:2] if budget.steady else QUANTITIES
    names = _names(budget, [key for key, *_ in shown])
    data: list[dict[str, Any]] = []
    layout = _layout(budget, shown, names, aspect, width_px, note)
    for k, (key, _, _, unit) in enumerate(shown):
        suffix = "" if k == 0 else str(k + 1)
        for name in names:
            data.append(_bars(budget.methods, key, unit, name, suffix, legend=k == 0))
        layout["annotations"] += _tops(budget, key, unit, suffix, _lines(budget, width_px))
        floor = getattr(budget.floor.rms, key)
        if floor is not None:
            layout["shapes"].append(_floor_line(floor / unit, suffix))
    return figure(data, layout)


def _lines(budget: Budget, width_px: float) -> int:
    """Lines of the text above a bar: two where the bars stand close."""
    return 1 if 0.43 * width_px >= _ONE_LINE_PX * len(budget.methods) else 2


def _names(budget: Budget, keys: Sequence[str]) -> list[str]:
    """Sources that make a visible part of some bar, in the order of `SOURCES`."""
    found = set()
    for method in budget.methods:
        for key in keys:
            heights = parts(method, key)
            whole = sum(heights.values())
            found |= {name for name, height in heights.items() if height >= _LEAST_SHARE * whole > 0.0}
    return sorted(found, key=_rank)


def _rank(name: str) -> tuple[int, str]:
    known = list(SOURCES)
    return (known.index(name) if name in known else len(known), name)


def _words(name: str) -> str:
    return SOURCES[name][0] if name in SOURCES else name.replace("_", " ")


def parts(method: MethodBudget, key: str) -> dict[str, float]:
    """Height of each source in a method's bar: the total times the source's part of the variance.

    Empty where the total is not known.
    """
    total = getattr(method.total.rms, key)
    if total is None or not math.isfinite(total):
        return {}
    sizes = {name: getattr(entry.rms, key) or 0.0 for name, entry in method.sources.items()}
    variance = sum(size * size for size in sizes.values())
    if variance == 0.0:
        return {}
    return {name: total * size * size / variance for name, size in sizes.items()}


def _bars(
    methods: Sequence[MethodBudget], key: str, unit: float, name: str, suffix: str, *, legend: bool
) -> dict[str, Any]:
    heights = [parts(method, key).get(name, 0.0) / unit for method in methods]
    color = SOURCES[name][1] if name in SOURCES else _OTHER
    return {
        "type": "bar",
        "name": _words(name),
        "legendgroup": name,
        "showlegend": legend,
        "x": list(range(len(methods))),
        "y": heights,
        "xaxis": f"x{suffix}",
        "yaxis": f"y{suffix}",
        "marker": {"color": color, "line": {"color": "white", "width": 0.5}},
        "hovertemplate": "%{fullData.name}: %{y:.3g}<extra></extra>",
    }


def _tops(budget: Budget, key: str, unit: float, suffix: str, lines: int) -> list[dict[str, Any]]:
    """Text above each bar: its height and how many times the floor that is; without a bar above the floor."""
    found, floor = [], getattr(budget.floor.rms, key) or 0.0
    for i, method in enumerate(budget.methods):
        total = getattr(method.total.rms, key)
        times = budget.times_floor(method).get(key.rsplit("_", 1)[0])
        if total is None:
            text = "no steady state" if method.shown == "steady" else "not in this budget"
        elif times is None:
            text = _short(total / unit)
        else:
            text = f"{_short(total / unit)}{' = ' if lines == 1 else '<br>'}{_short(times)} × floor"
        found.append(
            style.text(
                i,
                (floor if total is None else total) / unit,
                text,
                xref=f"x{suffix}",
                yref=f"y{suffix}",
                yanchor="bottom",
                font={"size": style.FONT_SIZE - 1, "color": style.INK},
            )
        )
    return found


def _short(value: float) -> str:
    """Three significant digits, no exponent for lengths of some kilometres."""
    return f"{value:.0f}" if 1000.0 <= value < 1e6 else number(value, 3)


def _floor_line(value: float, suffix: str) -> dict[str, Any]:
    return {
        "type": "line",
        "xref": f"x{suffix} domain",
        "yref": f"y{suffix}",
        "x0": 0.0,
        "x1": 1.0,
        "y0": value,
        "y1": value,
        "line": {"color": style.INK, "width": 2, "dash": "dash"},
        "layer": "above",
    }


def _layout(
    budget: Budget,
    shown: Sequence[tuple[str, str, str, float]],
    names: Sequence[str],
    aspect: float,
    width_px: float,
    note: str,
) -> dict[str, Any]:
    what = (
        "standard deviation, steady state at rest"
        if budget.steady
        else "standard deviation, RMS over the run"
    )
    if budget.floor.rms.tilt_rad is not None:
        what = f"{what}; the dashed line is the floor"
    columns, rows = 2, (len(shown) + 1) // 2
    legend_px = _LEGEND_ROW_PX * style.legend_rows([_words(name) for name in names], width_px - _LEFT_PX)
    bottom_px = _TICKS_PX + legend_px
    height_px = aspect * width_px - _TOP_PX - bottom_px
    made = style.layout(
        meta={"aspect": aspect},
        barmode="stack",
        bargap=0.35,
        margin={"l": _LEFT_PX, "r": _RIGHT_PX, "t": _TOP_PX, "b": bottom_px},
        legend=style.legend(traceorder="normal"),
        annotations=[],
        shapes=[],
    )
    gap_x, gap_y = 84.0 / width_px, (70.0 / height_px if rows > 1 else 0.0)
    wide, high = (1.0 - gap_x) / columns, (1.0 - gap_y * (rows - 1)) / rows
    methods = [style.plain(method.name) for method in budget.methods]
    for k, (key, title, unit_name, unit) in enumerate(shown):
        suffix = "" if k == 0 else str(k + 1)
        column, row = k % columns, k // columns
        left, top = column * (wide + gap_x), 1.0 - row * (high + gap_y)
        values = [getattr(method.total.rms, key) for method in budget.methods]
        values.append(getattr(budget.floor.rms, key))
        peak = max((v / unit for v in values if v is not None and math.isfinite(v)), default=0.0)
        made[f"xaxis{suffix}"] = style.axis(
            domain=[left, left + wide],
            anchor=f"y{suffix}",
            tickvals=list(range(len(methods))),
            ticktext=methods,
            range=[-0.6, len(methods) - 0.4],
        )
        made[f"yaxis{suffix}"] = style.axis(
            unit_name,
            domain=[max(top - high, 0.0), top],
            anchor=f"x{suffix}",
            range=[0.0, _HEADROOM[_lines(budget, width_px)] * peak if peak > 0.0 else 1.0],
        )
        made["annotations"].append(style.panel_title(title, suffix))
    made["annotations"].append(
        style.text(
            1.0,
            1.0,
            f"{what}{f'; {note}' if note else ''}",
            xref="paper",
            yref="paper",
            xanchor="right",
            yanchor="bottom",
            yshift=_NOTE_PX,
            font={"size": style.FONT_SIZE - 1, "color": style.MUTED},
        )
    )
    return made
