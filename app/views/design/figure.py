"""The error budget as stacked bars: one row a method, one colour a source, the floor drawn in."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from navcore.analysis.whole_system import duration
from navcore.design.budget import Budget, MethodBudget
from navcore.foundation.text import Text
from navcore.quantities import Kind, budgeted
from schuler_bench.plots import style
from schuler_bench.plots.plotly_data import PlotlyFigure, figure
from schuler_bench.plots.units import number

SOURCES = {
    "gyro_white": (Text("gyro white noise"), "#1F5A91"),
    "gyro_drift": (Text("gyro drift"), "#5B9BD5"),
    "gyro_bias": (Text("gyro bias"), "#A9CCEA"),
    "accel_white": (Text("accelerometer white noise"), "#A03B4C"),
    "accel_drift": (Text("accelerometer drift"), "#D9788A"),
    "accel_bias": (Text("accelerometer bias"), "#F0BCC5"),
    "log_white": (Text("log white noise"), "#1E6B3A"),
    "log_drift": (Text("log drift"), "#5FAE6F"),
    "log_bias": (Text("log bias"), "#B5DDBB"),
    "log_resolution": (Text("log resolution"), "#8FBF5A"),
    "log_tide": ("tide", "#7A7A18"),
    "initial_tilt": (Text("initial tilt"), "#8A8F98"),
    "initial_heading": (Text("initial heading"), "#5B6169"),
    "initial_velocity": (Text("initial velocity"), "#B4B8BE"),
    "initial_position": (Text("initial position"), "#D5D8DC"),
}
"""A source of `navcore.design` in words, and its colour: blue the gyros, red the accelerometers, green the
log, grey the start. Other sources are shown by their own name."""
_OTHER = "#C9A227"
_GROWS = "↗"
"""Stands at a method whose whole system grows."""
_LEAST_SHARE = 0.005
"""A source with a smaller part of every bar is left out of the legend and joins the last one."""
_LETTER_PX, _LONGEST = 7.0, 18
"""Width of a letter of a method's name, and how many of them are shown."""
_NOTE_LETTER_PX = 6.0
"""Mean width of a letter of the note above the panels."""
_LONG_PX, _SHORT_PX = 128, 80
"""Room right of a bar for "12.3 = 45.6 × floor", and for "12.3, 45.6×" where that is too much of a panel."""
_LEAST_BAR_PX, _LEAST_ROW_PX = 130, 22
"""Widths of the longest bar, and height of a row, below which the panels are arranged otherwise."""
_TITLE_LETTER_PX = 7.2
"""Mean width of a letter of an axis title, in a wide font."""
_GAP_PX, _RIGHT_PX, _TOP_PX = 18, 12, 52
_NOTE_PX = 26
"""Of the line about the whole figure above the panels, so that it stands clear of their titles."""
_TICKS_PX, _LEGEND_ROW_PX = 46, 21
NOTHING = {
    True: Text(
        "At rest, in the steady state, no sensor makes a random error here.<br>The budget of this run has "
        "the constant errors and those of the start."
    ),
    False: Text("No source makes an error in this run."),
}
"""In place of the bars where there are none: of the steady budget, and of that of a run."""


def budget_figure(
    budget: Budget,
    aspect: float = 0.46,
    *,
    width_px: float = 940.0,
    note: str = "",
    growth: Sequence[float | None] = (),
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
    growth : sequence of float or None
        Of each method's whole system, 1/s; what grows is marked at its name.
    """
    shown = budgeted(budget.steady)
    names = _names(budget, [kind.figure for kind in shown])
    if not names:
        return _without_bars(budget, aspect)
    labels = _labels(budget, growth)
    grid = _grid(labels, len(shown), names, aspect, width_px)
    data: list[dict[str, Any]] = []
    layout = _layout(budget, labels, shown, grid, aspect, width_px, note)
    for k, kind in enumerate(shown):
        suffix = "" if k == 0 else str(k + 1)
        for name in names:
            data.append(_bars(budget.methods, kind, name, suffix, legend=k == 0))
        layout["annotations"] += _ends(budget, kind, suffix, grid)
        floor = getattr(budget.floor.rms, kind.figure)
        if floor is not None:
            layout["shapes"] += [
                _floor_line(floor / kind.size, suffix, row)
                for row, method in enumerate(budget.methods)
                if method.reads_log
            ]
    return figure(data, layout)


@dataclass(frozen=True)
class _Grid:
    """Where the panels stand, px: their columns and rows, their inner sizes, and what is beside them."""

    columns: int
    rows: int
    wide: float
    high: float
    left: float
    bottom: float

    @property
    def long(self) -> bool:
        """Whether a bar has room for the longer text at its end."""
        return self.wide - _LONG_PX >= _LEAST_BAR_PX

    @property
    def headroom(self) -> float:
        """Length of an axis over that of its longest bar."""
        return self.wide / max(self.wide - (_LONG_PX if self.long else _SHORT_PX), 20.0)


def _labels(budget: Budget, growth: Sequence[float | None]) -> list[str]:
    """Names of the methods; behind that of a growing one the time in which it grows by e."""
    labels = []
    for k, method in enumerate(budget.methods):
        rate, name = growth[k] if k < len(growth) else None, _cut(method.name)
        if rate is not None and rate > 0.0:
            name = Text("{name} {sign}{every}", name=name, sign=_GROWS, every=duration(1.0 / rate))
        labels.append(name)
    return labels


def _grid(labels: Sequence[str], panels: int, names: Sequence[str], aspect: float, width_px: float) -> _Grid:
    """Two panels to a row; all of them where the rows of the methods would be too low."""
    left = 22.0 + _LETTER_PX * max(map(len, labels))
    legend_px = _LEGEND_ROW_PX * style.legend_rows([_words(name) for name in names], width_px - left)
    bottom = _TICKS_PX + legend_px

    def made(columns: int) -> _Grid:
        rows = panels // columns
        wide = (width_px - left - _RIGHT_PX - _GAP_PX * (columns - 1)) / columns
        between = (_TICKS_PX + _NOTE_PX) * (rows - 1)
        high = (aspect * width_px - _TOP_PX - bottom - between) / rows
        return _Grid(columns, rows, wide, high, left, bottom)

    two = made(2)
    return two if panels == 2 or two.high >= _LEAST_ROW_PX * len(labels) else made(panels)


def _without_bars(budget: Budget, aspect: float) -> PlotlyFigure:
    """Say that no source makes an error, in place of empty frames."""
    text = style.text(0.5, 0.5, NOTHING[budget.steady], xref="paper", yref="paper")
    hidden = {"visible": False}
    layout = style.layout(meta={"aspect": aspect}, annotations=[text], shapes=[], xaxis=hidden, yaxis=hidden)
    return figure([], layout)


def _names(budget: Budget, keys: Sequence[str]) -> list[str]:
    """Sources that make a visible part of some bar, in the order of `SOURCES`."""
    names = set()
    for method in budget.methods:
        for key in keys:
            heights = parts(method, key)
            whole = sum(heights.values())
            names |= {name for name, height in heights.items() if height >= _LEAST_SHARE * whole > 0.0}
    return sorted(names, key=_rank)


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
    methods: Sequence[MethodBudget], kind: Kind, name: str, suffix: str, *, legend: bool
) -> dict[str, Any]:
    lengths = [parts(method, kind.figure).get(name, 0.0) / kind.size for method in methods]
    color = SOURCES[name][1] if name in SOURCES else _OTHER
    return {
        "type": "bar",
        "name": _words(name),
        "legendgroup": name,
        "showlegend": legend,
        "orientation": "h",
        "x": lengths,
        "y": list(range(len(methods))),
        "xaxis": f"x{suffix}",
        "yaxis": f"y{suffix}",
        "marker": {"color": color, "line": {"color": "white", "width": 0.5}},
        "hovertemplate": "%{fullData.name}: %{x:.3g}<extra></extra>",
    }


def _ends(budget: Budget, kind: Kind, suffix: str, grid: _Grid) -> list[dict[str, Any]]:
    """Text at the end of each bar: its length and how many times the floor that is."""
    texts = []
    for i, method in enumerate(budget.methods):
        total = getattr(method.total.rms, kind.figure)
        times = budget.times_floor(method)[kind.name]
        if total is None:
            text = Text("no steady state") if method.shown == "steady" else Text("not in this budget")
        elif times is None:
            text = _short(total / kind.size)
        else:
            value, over = _short(total / kind.size), _short(times)
            text = (
                Text("{value} = {over} × floor", value=value, over=over)
                if grid.long
                else Text("{value}, {over}×", value=value, over=over)
            )
        texts.append(
            style.text(
                (total or 0.0) / kind.size,
                i,
                text,
                xref=f"x{suffix}",
                yref=f"y{suffix}",
                xanchor="left",
                xshift=2,
                borderpad=0,
                bgcolor="white" if total is None else "rgba(0,0,0,0)",
                font={"size": style.FONT_SIZE - 1, "color": style.INK},
            )
        )
    return texts


def _short(value: float) -> str:
    """Three significant digits, no exponent for lengths of some kilometres."""
    return f"{value:.0f}" if 1000.0 <= value < 1e6 else number(value, 3)


def _floor_line(value: float, suffix: str, row: int) -> dict[str, Any]:
    """Line across the row of one method: beside the others, which do without the log, there is no floor."""
    return {
        "type": "line",
        "xref": f"x{suffix}",
        "yref": f"y{suffix}",
        "x0": value,
        "x1": value,
        "y0": row - 0.5,
        "y1": row + 0.5,
        "line": {"color": style.INK, "width": 2, "dash": "dash"},
        "layer": "above",
    }


def _together(*notes: str) -> str:
    return Text.joined("; ", filter(None, notes))


def _layout(
    budget: Budget,
    labels: Sequence[str],
    shown: Sequence[Kind],
    grid: _Grid,
    aspect: float,
    width_px: float,
    note: str,
) -> dict[str, Any]:
    if any(_GROWS in label for label in labels):
        note = _together(Text("{sign} grows by e in this time", sign=_GROWS), note)
    what = (
        Text("standard deviation, steady state at rest")
        if budget.steady
        else Text("standard deviation, RMS over the run")
    )
    if budget.floor.rms.tilt_rad is not None:
        what = Text("{what}; the dashed line is the floor", what=what)
        if not grid.long:
            what = Text("{what}, × how many times it", what=what)
            if _NOTE_LETTER_PX * len(_together(what, note)) > width_px - _RIGHT_PX:
                what = Text("the dashed line is the floor, × how many times it")
    if any(_unit_title(kind.unit, grid.wide) == kind.unit for kind in shown):
        what = Text("{what}; parts by variance", what=what)
    layout = style.layout(
        meta={"aspect": aspect},
        barmode="stack",
        bargap=0.3,
        margin={"l": grid.left, "r": _RIGHT_PX, "t": _TOP_PX, "b": grid.bottom},
        legend=style.legend(traceorder="normal"),
        annotations=[],
        shapes=[],
    )
    inner_w = width_px - grid.left - _RIGHT_PX
    inner_h = max(aspect * width_px - _TOP_PX - grid.bottom, 1.0)
    methods = [style.plain(label) for label in labels]
    for k, kind in enumerate(shown):
        suffix = "" if k == 0 else str(k + 1)
        column, row = k % grid.columns, k // grid.columns
        left = column * (grid.wide + _GAP_PX) / inner_w
        top = 1.0 - row * (grid.high + _TICKS_PX + _NOTE_PX) / inner_h
        values = [getattr(method.total.rms, kind.figure) for method in budget.methods]
        values.append(getattr(budget.floor.rms, kind.figure))
        peak = max((v / kind.size for v in values if v is not None and math.isfinite(v)), default=0.0)
        layout[f"xaxis{suffix}"] = style.axis(
            _unit_title(kind.unit, grid.wide),
            domain=[left, left + grid.wide / inner_w],
            anchor=f"y{suffix}",
            range=[0.0, grid.headroom * peak if peak > 0.0 else 1.0],
            nticks=max(3, int(grid.wide / 60)),
        )
        layout[f"yaxis{suffix}"] = style.axis(
            domain=[max(top - grid.high / inner_h, 0.0), top],
            anchor=f"x{suffix}",
            tickvals=list(range(len(methods))),
            ticktext=methods,
            showticklabels=column == 0,
            ticks="outside" if column == 0 else "",
            range=[len(methods) - 0.4, -0.6],
            showgrid=False,
        )
        layout["annotations"].append(style.panel_title(kind.title, suffix))
    layout["annotations"].append(
        style.text(
            1.0,
            1.0,
            _together(what, note),
            xref="paper",
            yref="paper",
            xanchor="right",
            yanchor="bottom",
            yshift=_NOTE_PX,
            font={"size": style.FONT_SIZE - 1, "color": style.MUTED},
        )
    )
    return layout


def _unit_title(unit: str, wide: float) -> str:
    """Unit and, where it has room, what the parts of a bar are."""
    titles = (
        Text("{unit}; parts: shares of variance", unit=unit),
        Text("{unit}, parts by variance", unit=unit),
        unit,
    )
    return style.fitting(titles, wide, _TITLE_LETTER_PX)


def _cut(name: str) -> str:
    return name if len(name) <= _LONGEST else f"{name[: _LONGEST - 1]}…"
