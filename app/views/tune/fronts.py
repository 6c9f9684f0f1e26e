"""Pareto fronts of all networks in one picture: the present design as a star, the floor shaded."""

import math
from typing import Any

from navcore.design.fronts import Pareto, Point
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.notation import symbol
from navcore.foundation.text import Text
from navcore.quantities import QUANTITIES
from schuler_bench.plots import style
from schuler_bench.plots.effective import earth_mode_text, growth_text
from schuler_bench.plots.plotly_data import PlotlyFigure, figure
from schuler_bench.plots.units import number

COMMAND = "front-point"
"""Command with which a click asks for a point: ``front-point x y``, in the units of the axes."""
_SYMBOLS = ("circle", "square", "diamond", "triangle-up", "cross", "pentagon", "hexagon", "triangle-down")
_STANDS = Text("does not grow")
_NEAR = 0.05
"""A click takes the nearest point within this part of both axes."""
_PAD = 0.06
_LEFT_PX, _RIGHT_PX, _TOP_PX, _TICKS_PX, _LEGEND_ROW_PX = 66, 14, 44, 48, 21
_EMPTY = Text("Find the fronts: the best of every network in place of this one.")
_OFF = Text("The present design is not shown: an objective of 0 has no place on a logarithmic axis.")
_FEW_TICKS, _MANY_TICKS = (1.0, 2.0, 5.0), (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0)
_FINEST_DECADES = 0.12
"""Below this range plotly's own, even ticks are finer."""
_ALONE = 0.5
"""Decades on both sides of a present design that stands alone."""
_NETWORK_COLORS = 1
"""The first colour of the methods that a network has."""
Pair = tuple[float, float]


def setting_text(network: dict[str, Any]) -> str:
    """Parameters of a network block, short.

    Examples
    --------
    >>> setting_text({"id": "compass", "sigma": 0.002945, "xi": 2.79, "realisation": "network"})
    'σ = 0.002945, ζ = 2.79'
    """
    numbers = (
        Text("{symbol} = {v}", symbol=symbol(k), v=number(v, 4))
        for k, v in network.items()
        if isinstance(v, int | float)
    )
    return Text.joined(", ", numbers) or Text("no parameter")


def fronts_figure(
    found: Pareto | None,
    objectives: tuple[str, str],
    present: Pair | None,
    method: str,
    aspect: float = 0.46,
    *,
    width_px: float = 940.0,
    note: str = "",
    growth: float | None = None,
) -> PlotlyFigure:
    """Fronts on logarithmic axes.

    Parameters
    ----------
    found : Pareto or None
        Fronts; None before a search.
    objectives : (str, str)
        On the axes: keys of `navcore.quantities.QUANTITIES`.
    present : (float, float) or None
        Both objectives of the present design, SI.
    method : str
        Name of the method.
    aspect, width_px : float
        Height over width of the figure, and its expected width on screen.
    note : str
        What is to be heeded, above the plot.
    growth : float or None
        Of the present whole system, 1/s.
    """
    across, up = (QUANTITIES[name] for name in objectives)
    sizes = across.size, up.size
    if present is not None and not all(map(_on_axis, present)):
        note, present = note or _OFF, None
    fronts = {} if found is None else found.fronts
    data = [
        _front(name, points, k, sizes)
        for k, (name, points) in enumerate(fronts.items(), start=_NETWORK_COLORS)
    ]
    grows = growth_text(growth)
    now = style.plain(
        Text("now: {method}, {grows}", method=method, grows=grows)
        if grows
        else Text("now: {method}", method=method)
    )
    if present is not None:
        data.append(_present(now, present, sizes))
    ranges = _ranges(found, present, sizes)
    names = [*fronts, *([now] if present is not None else [])]
    legend_px = _LEGEND_ROW_PX * style.legend_rows(names, width_px - _LEFT_PX - _RIGHT_PX)
    layout = style.layout(
        meta={"aspect": aspect, "pick": {"command": COMMAND, "panels": (("xaxis", "yaxis"),)}},
        hovermode="closest",
        margin={"l": _LEFT_PX, "r": _RIGHT_PX, "t": _TOP_PX, "b": _TICKS_PX + legend_px},
        legend=style.legend(traceorder="normal"),
        showlegend=True,
        xaxis=_axis(Text("{label} ({shown})", label=across.label, shown=across.shown), ranges[0]),
        yaxis=_axis(Text("{label} ({shown})", label=up.label, shown=up.shown), ranges[1]),
        annotations=[_above(note)] if note else [],
        shapes=[],
    )
    if found is None:
        layout["annotations"].append(_middle(_EMPTY))
    else:
        _add_floor(layout, found, ranges, sizes)
        _add_key(layout, found)
    return figure(data, layout)


def nearest(found: Pareto, x: float, y: float) -> tuple[str, Point]:
    """Network and point next to a place of the picture, given in the units of the axes.

    Raises
    ------
    InputError
        There is no point near it.
    """
    sizes = QUANTITIES[found.objectives[0]].size, QUANTITIES[found.objectives[1]].size
    spans = [
        math.log10(high / low) if high > low else 1.0 for low, high in _ranges(found, found.present, sizes)
    ]
    best: tuple[float, str, Point] | None = None
    for name, points in found.fronts.items():
        for point in points:
            place = zip(point.values, (x, y), sizes, spans, strict=True)
            away = max(
                abs(math.log10(value / size / at)) / span if min(at, value) > 0.0 else math.inf
                for value, at, size, span in place
            )
            if best is None or away < best[0]:
                best = away, name, point
    if best is None or best[0] > _NEAR:
        raise InputError(Fault("", "point", f"{x:.4g} {y:.4g}", Text("must be near a point of a front")))
    return best[1], best[2]


def _front(name: str, points: tuple[Point, ...], index: int, sizes: Pair) -> dict[str, Any]:
    color = style.method_color(index)
    full = _SYMBOLS[index % len(_SYMBOLS)]
    return {
        "type": "scatter",
        "mode": "lines+markers",
        "name": name,
        "x": [point.values[0] / sizes[0] for point in points],
        "y": [point.values[1] / sizes[1] for point in points],
        "text": [
            Text(
                "{name}: {setting_text}<br>24 h mode {earth_mode_text}<br>whole system {growth}",
                name=name,
                setting_text=setting_text(point.network),
                earth_mode_text=earth_mode_text(point.earth_growth),
                growth=growth_text(point.growth_per_s) or _STANDS,
            )
            for point in points
        ],
        "hovertemplate": "%{text}<br>%{x:.4g}, %{y:.4g}<extra></extra>",
        "line": {"color": color, "width": 1.2},
        "marker": {
            "color": color,
            "size": 9,
            "symbol": [f"{full}-open" if _grows(point) else full for point in points],
        },
    }


def _grows(point: Point) -> bool:
    """Whether the whole system grows with it, as the law is sampled or its 24 h mode alone."""
    return point.growth_per_s > 0.0 or point.earth_growth > 0.0


def _present(name: str, present: Pair, sizes: Pair) -> dict[str, Any]:
    return {
        "type": "scatter",
        "mode": "markers",
        "name": name,
        "x": [present[0] / sizes[0]],
        "y": [present[1] / sizes[1]],
        "hovertemplate": Text("{name}<br>%{{x:.4g}}, %{{y:.4g}}<extra></extra>", name=name),
        "marker": {
            "color": "white",
            "size": 17,
            "symbol": "star",
            "line": {"color": style.INK, "width": 2},
        },
    }


def _ranges(found: Pareto | None, present: Pair | None, sizes: Pair) -> tuple[Pair, Pair]:
    """Ends of both axes, in their units: all points, the present design and the floor."""
    ends = []
    for axis in (0, 1):
        values = [] if present is None else [present[axis]]
        if found is not None:
            values += [point.values[axis] for points in found.fronts.values() for point in points]
            floor = found.floor[axis]
            values += [floor] if floor else []
        logs = [math.log10(value / sizes[axis]) for value in values if _on_axis(value)] or [0.0, 1.0]
        low, high = min(logs), max(logs)
        pad = max(_PAD * (high - low), 0.03 if found is not None else _ALONE)
        ends.append((10.0 ** (low - pad), 10.0 ** (high + pad)))
    return ends[0], ends[1]


def _on_axis(value: float) -> bool:
    """Whether a logarithmic axis can show a value."""
    return 0.0 < value < math.inf


def _axis(title: str, ends: Pair) -> dict[str, Any]:
    """Logarithmic axis; its ticks are written in full, where plotly leaves out the power of ten."""
    low, high = (math.log10(end) for end in ends)
    axis = style.axis(title, type="log", range=[low, high])
    steps = _FEW_TICKS if high - low > 1.0 else _MANY_TICKS
    ticks = [step * 10.0**k for k in range(math.floor(low), math.ceil(high) + 1) for step in steps]
    if high - low > _FINEST_DECADES:
        axis |= {"tickvals": ticks, "ticktext": [f"{tick:.6g}" for tick in ticks]}
    return axis


def _add_floor(layout: dict[str, Any], found: Pareto, ranges: tuple[Pair, Pair], sizes: Pair) -> None:
    """Shade what no causal linear damping can reach."""
    for axis, name in enumerate("xy"):
        floor = found.floor[axis]
        if not floor:
            continue
        other = "y" if name == "x" else "x"
        level = floor / sizes[axis]
        layout["shapes"] += [
            {
                "type": "rect",
                **{f"{name}ref": name, f"{name}0": ranges[axis][0] / 10.0, f"{name}1": level},
                **{f"{other}ref": f"{other} domain", f"{other}0": 0.0, f"{other}1": 1.0},
                "fillcolor": style.GRID,
                "line": {"width": 0},
                "layer": "below",
            },
            {
                "type": "line",
                **{f"{name}ref": name, f"{name}0": level, f"{name}1": level},
                **{f"{other}ref": f"{other} domain", f"{other}0": 0.0, f"{other}1": 1.0},
                "line": {"color": style.INK, "width": 1.5, "dash": "dash"},
                "layer": "below",
            },
        ]


def _add_key(layout: dict[str, Any], found: Pareto) -> None:
    """Say above the plot what the open marks and the grey stand for."""
    points = [point for front in found.fronts.values() for point in front]
    said = [Text("open mark: its whole system grows")] if any(map(_grows, points)) else []
    if any(found.floor):
        said.append(Text("grey: below the floor, out of reach of any causal linear damping with the log"))
    if said:
        layout["annotations"].append(
            style.text(
                1.0, 1.0, Text.joined("<br>", said), xref="x domain", yref="paper", xanchor="right",
                yanchor="bottom", align="right", font={"size": style.FONT_SIZE - 1, "color": style.MUTED},
            )
        )  # fmt: skip


def _above(note: str) -> dict[str, Any]:
    font = {"size": style.FONT_SIZE - 1, "color": style.DANGER}
    return style.text(
        0.0, 1.0, style.plain(note), xref="paper", yref="paper", xanchor="left", yanchor="bottom", font=font
    )


def _middle(words: str) -> dict[str, Any]:
    font = {"size": style.FONT_SIZE, "color": style.MUTED}
    return style.text(0.5, 0.85, words, xref="paper", yref="paper", font=font)
