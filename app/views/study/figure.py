"""Pictures of a study: a metric over its grid, and what moves it most."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from navcore.foundation.text import Text
from navcore.quantities import QUANTITIES
from schuler_bench.plots import style
from schuler_bench.plots.plotly_data import PlotlyFigure, figure
from schuler_bench.plots.units import number
from schuler_bench.plots.varied import value_text, varied_label

MET = "met"
"""In the place of a metric: the share of runs that meets all limits."""
_MARGIN = {"l": 72, "r": 20, "t": 44, "b": 48}
_LIGHT, _DARK = (235, 242, 250), (8, 64, 129)
_WIDE = 20.0
"""Largest over smallest value from which colours, or an axis, are logarithmic."""
_MAP_SHARE, _GAP = 0.58, 0.06
_MOST_FACTORS, _BELOW = 6, 0.14
"""Factors that are shown, and how far below the middle of its row a bar stands: its name is above it."""
_BAR = "#7FA8CC"
_LETTER_PX = 7.0


def label_of(metric: str) -> str:
    """Name and unit of what is shown."""
    if metric == MET:
        return Text("runs that meet all limits (%)")
    row = QUANTITIES[metric]
    return Text("{label} ({unit})", label=row.label, unit=row.shown)


def study_figure(
    document: dict[str, Any],
    metric: str,
    method: str,
    aspect: float,
    *,
    kept: Sequence[tuple[str, int]] = (),
    width_px: float = 940.0,
    note: str = "",
) -> PlotlyFigure:
    """Left the metric over the grid of the study; right the factors that move it, the strongest above.

    Parameters
    ----------
    document : dict
        The study's summary, with at least one method.
    metric : str
        One of its metrics, or `MET`.
    method : str
        Whose map and factors are shown; curves are those of all methods.
    aspect, width_px : float
        Height over width of the figure, and its expected width on screen.
    kept : sequence of (str, int)
        Places of names in the palette, as of `schuler_bench.plots.style.places`.
    note : str
        What is to be heeded, above the pictures.
    """
    names = [one["name"] for one in document["methods"]]
    place = names.index(method)
    right = _factors(document["methods"][place], metric)
    share = _MAP_SHARE if right else 1.0
    layout = style.framed(
        names, aspect, width_px, _MARGIN, hovermode="closest", showlegend=False, annotations=[], shapes=[]
    )
    cells = document.get("cells", [])
    columns = [*cells[0]["factors"]] if cells else []
    title = Text("{label}, median", label=label_of(metric)) if metric != MET else label_of(metric)
    if len(columns) >= 2:
        data = _map(layout, cells, columns, metric, method, share * width_px)
        told = [title, method]
        if len(columns) > 2:
            told.append(Text("mean over {factors}", factors=", ".join(map(varied_label, columns[2:]))))
    else:
        data = _curves(
            layout,
            cells or [document | {"factors": {}}],
            columns,
            metric,
            style.places(names, kept),
            label_of(metric),
        )
        told = [title, Text("bars: 5 to 95 % of the runs") if metric != MET else Text("bars: 95 % interval")]
    layout["xaxis"]["domain"] = [0.0, share]
    layout["annotations"].append(style.panel_title(Text.joined(" · ", (*told, *filter(None, (note,))))))
    if right:
        data += _tornado(layout, right, [share + _GAP, 1.0], width_px)
    return figure(data, layout)


def series_figure(
    document: dict[str, Any],
    name: str,
    aspect: float,
    *,
    width_px: float = 940.0,
    kept: Sequence[tuple[str, int]] = (),
) -> PlotlyFigure:
    """Median of an error over time, and the band between its quantiles of 5 and 95 %, of every method."""
    names = [one["name"] for one in document["methods"]]
    layout = style.framed(names, aspect, width_px, _MARGIN, hovermode="closest", annotations=[])
    layout["xaxis"] = style.axis(Text("time (h)"), anchor="y")
    layout["yaxis"] = style.axis(anchor="x")
    layout["annotations"].append(style.panel_title(Text("{name}, median and 5 to 95 %", name=name)))
    data: list[dict[str, Any]] = []
    places = style.places(names, kept)
    for one in document["methods"]:
        found, hours = one["series"][name], document["epochs_h"]
        place = places[one["name"]]
        red, green, blue = style.rgb(style.method_color(place))
        band = {"type": "scatter", "mode": "lines", "line": {"width": 0}, "hoverinfo": "skip",
                "showlegend": False, "name": style.plain(one["name"]), "legendgroup": str(place)}  # fmt: skip
        data.append(band | {"x": hours, "y": found["q05"]})
        fill = f"rgba({red},{green},{blue},0.15)"
        data.append(band | {"x": hours, "y": found["q95"], "fill": "tonexty", "fillcolor": fill})
        data.append(style.lines(one["name"], place) | {"x": hours, "y": found["median"]})
    return figure(data, layout)


def _value(method: dict[str, Any], metric: str) -> tuple[float | None, float | None, float | None]:
    """Least, middle and largest: quantiles of a metric, or the share that meets the limits."""
    if metric == MET:
        share = method[MET]
        return 100.0 * share["low"], 100.0 * share["share"], 100.0 * share["high"]
    found = method["metrics"][metric]
    return found["q05"], found["median"], found["q95"]


# ------------------------------------------------------------ the grid


def _map(
    layout: dict[str, Any],
    cells: Sequence[dict[str, Any]],
    columns: Sequence[str],
    metric: str,
    method: str,
    width_px: float,
) -> list[dict[str, Any]]:
    """Add a heat map over the first two factors to a layout; return what a pointer reads."""
    across, up = ([*dict.fromkeys(cell["factors"][name] for cell in cells)] for name in columns[:2])
    sums: dict[tuple[int, int], list[float | None]] = {}
    for cell in cells:
        where = across.index(cell["factors"][columns[0]]), up.index(cell["factors"][columns[1]])
        found = next((one for one in cell["methods"] if one["name"] == method), None)
        sums.setdefault(where, []).append(None if found is None else _value(found, metric)[1])
    values = {
        where: sum(one for one in some if one is not None) / len(some) if None not in some else None
        for where, some in sums.items()
    }
    numbers = [value for value in values.values() if value is not None]
    shade = _shade(numbers)
    ticks = {"showgrid": False, "ticks": "", "zeroline": False, "fixedrange": True}
    for key, named, column in (("x", across, columns[0]), ("y", up, columns[1])):
        layout[f"{key}axis"] = style.axis(
            varied_label(column),
            tickvals=[*range(len(named))],
            ticktext=[*map(value_text, named)],
            range=[-0.5, len(named) - 0.5],
            anchor="y" if key == "x" else "x",
            **ticks,
        )
    room_px = (width_px - _MARGIN["l"] - _MARGIN["r"]) / len(across)
    points: dict[str, list[Any]] = {"x": [], "y": [], "text": []}
    for (x, y), value in values.items():
        written = Text("none") if value is None else number(value, 3)
        dark = 0.0 if value is None else shade(value)
        layout["shapes"].append(
            {
                "type": "rect",
                "layer": "below",
                "x0": x - 0.5,
                "x1": x + 0.5,
                "y0": y - 0.5,
                "y1": y + 0.5,
                "fillcolor": "#ffffff" if value is None else _color(dark),
                "line": {"color": "white", "width": 1},
            }
        )
        if len(written) * _LETTER_PX < room_px:
            color = "white" if dark > 0.58 else style.TRUTH_COLOR
            layout["annotations"].append(style.text(x, y, written, font={"size": 13, "color": color}))
        points["x"].append(x)
        points["y"].append(y)
        points["text"].append(
            Text(
                "{across} {x}<br>{up} {y}<br><b>{value}</b>",
                across=varied_label(columns[0]),
                x=value_text(across[x]),
                up=varied_label(columns[1]),
                y=value_text(up[y]),
                value=written,
            )
        )
    marker = {"size": 24, "opacity": 0.0, "symbol": "square"}
    shown = {"type": "scatter", "mode": "markers", "hoverinfo": "text", "showlegend": False}
    return [shown | points | {"marker": marker, "name": style.plain(method)}]


def _shade(numbers: Sequence[float]) -> Any:
    """Give the place 0 to 1 of a value between the least and the largest one; in equal ratios if wide."""
    least, largest = (min(numbers), max(numbers)) if numbers else (0.0, 0.0)
    if least > 0.0 and largest > _WIDE * least:
        span = math.log(largest / least)
        return lambda value: math.log(value / least) / span
    span = largest - least
    return lambda value: (value - least) / span if span else 0.3


def _color(place: float) -> str:
    parts = (round(light + place * (dark - light)) for light, dark in zip(_LIGHT, _DARK, strict=True))
    return "#{:02X}{:02X}{:02X}".format(*parts)


def _curves(
    layout: dict[str, Any],
    cells: Sequence[dict[str, Any]],
    columns: Sequence[str],
    metric: str,
    names: Mapping[str, int],
    label: str,
) -> list[dict[str, Any]]:
    """Add the axes of curves over one factor, or of one point a method; return the curves."""
    layout["showlegend"] = True
    values = [cell["factors"][columns[0]] for cell in cells] if columns else []
    layout["yaxis"] = style.axis(label, anchor="x", rangemode="tozero", nticks=6)
    ticks = {"tickvals": [*range(len(values))], "ticktext": [*map(value_text, values)]}
    layout["xaxis"] = style.axis(varied_label(columns[0]), anchor="y", **ticks) if columns else style.axis(
        anchor="y", tickvals=[*range(len(names))], ticktext=[*map(style.plain, names)]
    )  # fmt: skip
    data, every = [], []
    for index, (name, place) in enumerate(names.items()):
        rows = [next((one for one in cell["methods"] if one["name"] == name), None) for cell in cells]
        found = [(None, None, None) if one is None else _value(one, metric) for one in rows]
        lows, middles, highs = ([one[part] for one in found] for part in range(3))
        every += [value for one in found for value in one if value is not None]
        error = {
            "type": "data",
            "symmetric": False,
            "array": [_beyond(high, middle) for high, middle in zip(highs, middles, strict=True)],
            "arrayminus": [_beyond(middle, low) for middle, low in zip(middles, lows, strict=True)],
            "thickness": 1.2,
            "width": 4,
            "color": style.method_color(place),
        }
        beside = 0.04 * (index - 0.5 * (len(names) - 1))
        line = style.lines(name, place) | {"mode": "lines+markers", "marker": {"size": 6}}
        at = [k + beside for k in range(len(rows))] if columns else [index]
        hover = Text("<b>{name}</b><br>%{{y:.4g}}<extra></extra>", name=style.plain(name))
        data.append(line | {"x": at, "y": middles, "error_y": error, "hovertemplate": hover})
    if every and min(every) > 0.0 and max(every) > _WIDE * min(every):
        layout["yaxis"] |= {"type": "log", "rangemode": "normal", "nticks": 5}
    return data


def _beyond(value: float | None, other: float | None) -> float | None:
    return None if value is None or other is None else value - other


# ------------------------------------------------------------ what counts


def _factors(method: dict[str, Any], metric: str) -> dict[str, Any]:
    """Tornado and Sobol indices of a metric, where the study has them."""
    return {name: found for name in ("tornado", "sobol") if (found := method.get(name, {}).get(metric))}


def _tornado(
    layout: dict[str, Any], found: dict[str, Any], domain: list[float], width_px: float
) -> list[dict[str, Any]]:
    """Add the panels of the tornado, and below it of the Sobol indices, to a layout; return their bars."""
    both = len(found) == 2
    data: list[dict[str, Any]] = []
    if "tornado" in found:
        rows = found["tornado"][:_MOST_FACTORS][::-1]
        layout["xaxis2"] = style.axis(domain=domain, anchor="y2", nticks=4)
        _name_rows(layout, rows, [0.62, 1.0] if both else [0.0, 1.0], "2")
        layout["annotations"].append(style.panel_title(Text("median, by factor"), "2"))
        hovers = [
            Text(
                "<b>{factor}</b><br>{least} at {at_least}<br>{largest} at {at_largest}<extra></extra>",
                factor=varied_label(one["factor"]),
                least=number(one["least"], 3),
                at_least=value_text(one["at_least"]),
                largest=number(one["largest"], 3),
                at_largest=value_text(one["at_largest"]),
            )
            for one in rows
        ]
        data.append(
            {
                "type": "bar",
                "orientation": "h",
                "base": [one["least"] for one in rows],
                "x": [one["largest"] - one["least"] for one in rows],
                "y": [place - _BELOW for place in range(len(rows))],
                "width": [0.36] * len(rows),
                "marker": {"color": _BAR},
                "hovertemplate": hovers,
                "showlegend": False,
                "name": Text("median"),
                "xaxis": "x2",
                "yaxis": "y2",
            }
        )
        for place, one in enumerate(rows):
            for end, anchor in (("least", "right"), ("largest", "left")):
                written = value_text(one[f"at_{end}"])
                layout["annotations"].append(
                    style.text(
                        one[end], place - _BELOW, written, xref="x2", yref="y2", xanchor=anchor,
                        xshift=-3 if end == "least" else 3, font={"size": 12, "color": style.MUTED},
                    )
                )  # fmt: skip
        ends = [one[end] for one in rows for end in ("least", "largest")]
        inner_px = (domain[1] - domain[0]) * (width_px - _MARGIN["l"] - _MARGIN["r"])
        beside = 0.5 * (max(ends) - min(ends)) * min(1.0, 120.0 / inner_px) or 0.1
        layout["xaxis2"]["range"] = [min(ends) - beside, max(ends) + beside]
    if "sobol" in found:
        number_ = "3" if both else "2"
        rows = found["sobol"][:_MOST_FACTORS][::-1]
        layout[f"xaxis{number_}"] = style.axis(
            Text("Sobol index: ● first order, ○ total"),
            domain=domain,
            anchor=f"y{number_}",
            range=[-0.05, 1.1],
        )
        _name_rows(layout, rows, [0.0, 0.38] if both else [0.0, 1.0], number_)
        for order, symbol, beside in (("first", "circle", 0.12), ("total", "circle-open", -0.12)):
            ones = [one[order] for one in rows]
            error = {
                "type": "data",
                "symmetric": False,
                "array": [one["high"] - one["value"] for one in ones],
                "arrayminus": [one["value"] - one["low"] for one in ones],
                "thickness": 1.2,
                "width": 4,
                "color": style.MUTED,
            }
            data.append(
                style.key(order, symbol, 1.5)
                | {
                    "x": [one["value"] for one in ones],
                    "y": [k - _BELOW + beside for k in range(len(ones))],
                    "error_x": error,
                    "showlegend": False,
                    "hoverinfo": "x",
                    "xaxis": f"x{number_}",
                    "yaxis": f"y{number_}",
                }
            )
    return data


def _name_rows(
    layout: dict[str, Any], rows: Sequence[dict[str, Any]], domain: list[float], suffix: str
) -> None:
    """Add the upright axis of a panel with a row a factor, whose name stands above its bar."""
    layout[f"yaxis{suffix}"] = style.axis(
        domain=domain,
        anchor=f"x{suffix}",
        range=[-0.6, len(rows) - 0.4],
        showgrid=False,
        showticklabels=False,
        ticks="",
    )
    for place, one in enumerate(rows):
        layout["annotations"].append(
            style.text(
                0.0,
                place + 0.26,
                varied_label(one["factor"]),
                xref=f"x{suffix} domain",
                yref=f"y{suffix}",
                xanchor="left",
                xshift=4,
            )
        )
