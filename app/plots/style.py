"""The one visual language of all pictures: a colour per method, fonts, greys, line styles, the light theme.

A method has a place in the palette by its name (`places`), so that it looks the same in the Bode plot, the
error curves, the 3D scene and the table, and in every scenario. The colours are Okabe and Ito's
colour-blind-safe set where it reads on white, then Tol's muted set.
"""

from collections.abc import Iterable, Sequence
from html import escape
from itertools import chain, product
from typing import Any

from navcore.foundation.text import Text

METHOD_COLORS = (
    "#0072B2",  # blue
    "#D55E00",  # vermilion
    "#009E73",  # green
    "#AA4499",  # purple
    "#C48500",  # ochre: Okabe-Ito orange, darkened to read on white
    "#2F99D0",  # sky blue
    "#882255",  # wine
    "#7A7A18",  # olive
    "#332288",  # indigo
    "#CC6677",  # rose
    "#2F9C93",  # teal
    "#6B6B6B",  # grey
)
STANDING = {
    "free": 0,
    "undamped": 0,
    "classic2": 1,
    "classic3": 2,
    "damped, sigma = 0.0088": 2,
    "complementary": 3,
    "eight copies": 3,
    "external, horizontal": 3,
    "variation + Liu 19": 6,
    "variation + bumpless": 7,
}
"""Names of several presets, which stand in them at different places, and their places in the palette."""
TRUTH_COLOR = "#1F2933"

INK = "#243B53"
"""Text and axis lines."""
MUTED = "#52667A"
"""Secondary text: tick labels, marker labels."""
GRID = "#E1E7ED"
GRID_FINE = "#F1F4F7"
REFERENCE = "#9AA9B8"
"""Reference lines: natural frequencies, damping rays, zero."""
DANGER = "#B42318"
BEST = Text("best of all")
"""Said of the best number of a table's row or column, which ``class="sb-best"`` marks."""
SEA = "#F4F7FA"

# One list for labels, tables, plots and map. The server sends the first one (app/http/page.py); the others
# have what it lacks, such as Chinese, or stand in where a browser refuses it; the last ones have signs.
FONT_FAMILY = (
    'Arimo, -apple-system, BlinkMacSystemFont, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif, '
    '"DejaVu Sans", "Segoe UI Symbol"'
)
SVG_FONT = FONT_FAMILY.replace('"', "'")
"""The same as an attribute of SVG."""
FONT_SIZE = 13

LINE_WIDTH = 2.0
CURVE_WIDTH = 1.5
"""Of time curves: noise drawn any wider hides what lies below it."""

_BOLD_PX = 7.4
"""Mean width of a letter in a panel's title."""
_ROW_PX, _BESIDE_PX = 22, 84.0
"""Height of a row of a legend, and what a figure has beside it."""
_BETWEEN_PX = 32.0
"""Half the room between two columns of plots for the labels of an axis."""

UPLOT_CSS = (
    ".uplot .u-legend{font-size:13px;margin:0;text-align:left;padding-left:58px}"
    ".uplot .u-legend .u-marker{width:14px;height:4px;border-radius:2px;vertical-align:middle}"
    ".uplot .u-legend th{font-weight:500}"
    ".uplot .u-legend .u-value{min-width:6ch;display:inline-block;font-variant-numeric:tabular-nums}"
)
"""For the page to add once: uPlot's legend in the size of all other text (its own is 11 px)."""


def plain(name: str) -> str:
    """Name as plotly must get it to show it letter by letter: it reads a part of HTML."""
    quoted = escape(name, quote=False)
    return name if quoted == name else quoted


def places(names: Iterable[str], kept: Iterable[tuple[str, int]] = ()) -> dict[str, int]:
    """Give the methods of a scenario places in the palette, no two the same one.

    Parameters
    ----------
    names : iterable of str
        Of the methods.
    kept : iterable of (str, int)
        Places that names had before, the latest first: these come first, then `STANDING`, then a method's
        place in the scenario, then the first free one.

    Examples
    --------
    >>> places(["classic2", "Zhao", "mine"]), places(["mine", "Zhao"], [("mine", 2)])
    ({'classic2': 1, 'Zhao': 0, 'mine': 2}, {'mine': 2, 'Zhao': 1})
    """
    names = tuple(names)
    found: dict[str, int] = {}
    own, free = zip(names, range(len(names)), strict=True), product(names, range(len(names)))
    for name, place in chain(kept, STANDING.items(), own, free):
        if name in names and name not in found and place not in found.values():
            found[name] = place
    return {name: found[name] for name in names}


def method_color(place: int) -> str:
    """Colour at a place of the palette, ``#RRGGBB``."""
    return METHOD_COLORS[place % len(METHOD_COLORS)]


def rgb(color: str) -> tuple[int, int, int]:
    """Red, green, blue of ``#RRGGBB``, 0..255."""
    return int(color[1:3], 16), int(color[3:5], 16), int(color[5:7], 16)


def axis(title: str = "", **more: Any) -> dict[str, Any]:
    """A plotly axis in the house style; ``more`` overrides."""
    return {
        "title": {"text": title, "standoff": 6, "font": {"size": FONT_SIZE, "color": INK}},
        "tickfont": {"size": FONT_SIZE, "color": MUTED},
        "gridcolor": GRID,
        "linecolor": REFERENCE,
        "showline": True,
        "mirror": True,
        "ticks": "outside",
        "ticklen": 4,
        "tickcolor": REFERENCE,
        "zeroline": False,
        "automargin": False,
    } | more


def legend(**more: Any) -> dict[str, Any]:
    """A horizontal plotly legend along the lower edge of the figure."""
    return {
        "orientation": "h",
        "x": 0.0,
        "xref": "paper",
        "xanchor": "left",
        "y": 0.0,
        "yref": "container",
        "yanchor": "bottom",
        "font": {"size": FONT_SIZE, "color": INK},
        "itemwidth": 30,
        "bgcolor": "rgba(0,0,0,0)",
        "tracegroupgap": 0,
    } | more


def layout(**more: Any) -> dict[str, Any]:
    """Layout in the house style; ``more`` overrides."""
    return {
        "font": {"family": FONT_FAMILY, "size": FONT_SIZE, "color": INK},
        "paper_bgcolor": "white",
        "plot_bgcolor": "white",
        "hoverlabel": {"font": {"size": FONT_SIZE, "family": FONT_FAMILY}, "bgcolor": "white"},
        "dragmode": "zoom",
        "autosize": True,
    } | more


def text(x: float | str, y: float, content: str, **more: Any) -> dict[str, Any]:
    """A plotly annotation without an arrow; ``more`` overrides."""
    return {
        "x": x,
        "y": y,
        "text": content,
        "showarrow": False,
        "font": {"size": FONT_SIZE, "color": INK},
    } | more


def framed(
    names: Sequence[str], aspect: float, width_px: float, margin: dict[str, int], **more: Any
) -> dict[str, Any]:
    """Layout with a legend of these names along its lower edge, for which ``margin["b"]`` gets room.

    Parameters
    ----------
    names : sequence of str
        In the legend.
    aspect, width_px : float
        Height / width of the figure, and its expected width on screen.
    margin : dict
        ``l``, ``r``, ``t``, ``b`` without the legend, px.
    """
    bottom = margin["b"] + _ROW_PX * legend_rows(names, width_px - _BESIDE_PX)
    return layout(margin=margin | {"b": bottom}, legend=legend(), meta={"aspect": aspect}) | more


def without_legend(figure: Any, names: Sequence[str], width_px: float) -> None:
    """Take entries of these names, and their room, out of the legend of a figure that `framed` laid out.

    Parameters
    ----------
    figure : plotly figure as a dict
        Changed in place.
    names : sequence of str
        As written.
    width_px : float
        Expected width of the figure, as `framed` had it.
    """
    named = [trace for trace in figure["data"] if trace.get("showlegend", True)]
    gone = {plain(name) for name in names}
    left = [trace["name"] for trace in named if trace["name"] not in gone]
    if len(left) == len(named):
        return
    for trace in named:
        trace["showlegend"] = trace["name"] not in gone
    rows = legend_rows([trace["name"] for trace in named], width_px - _BESIDE_PX)
    more = rows - legend_rows(left, width_px - _BESIDE_PX) * bool(left)
    layout = figure["layout"]
    layout["margin"] = layout["margin"] | {"b": layout["margin"]["b"] - _ROW_PX * more}
    # entries of groups stand below each other
    layout["legend"] = layout.get("legend", {}) | {"traceorder": "normal"}


def lines(method: str, place: int, width: float = LINE_WIDTH) -> dict[str, Any]:
    """Make the common part of a method's curves, in all plotly figures."""
    return {
        "type": "scatter",
        "mode": "lines",
        "name": plain(method),
        "legendgroup": str(place),
        "line": {"color": method_color(place), "width": width, "simplify": False},
    }


def marks(method: str, place: int, symbol: str, size: float, line: dict[str, Any]) -> dict[str, Any]:
    """Make the common part of a method's marks; they have no entry in the legend."""
    return {
        "type": "scatter",
        "mode": "markers",
        "name": plain(method),
        "legendgroup": str(place),
        "showlegend": False,
        "marker": {"symbol": symbol, "size": size, "color": method_color(place), "line": line},
    }


def power(exponent: int) -> str:
    """Label of a power of ten on a logarithmic axis."""
    return f"{10.0**exponent:g}" if -3 <= exponent <= 4 else f"10<sup>{exponent}</sup>"


def key(name: str, symbol: str, width: float) -> dict[str, Any]:
    """Legend entry that says what a mark means."""
    marker = {"symbol": symbol, "size": 10, "color": MUTED, "line": {"color": MUTED, "width": width}}
    where = {"type": "scatter", "mode": "markers", "x": [None], "y": [None], "hoverinfo": "skip"}
    return where | {"name": name, "marker": marker}


def upright(at: float, axis: str = "x", yref: str = "paper", **line: Any) -> dict[str, Any]:
    """Line through a whole figure, or through a panel, at a place of an x axis."""
    return {
        "type": "line",
        "xref": axis,
        "x0": at,
        "x1": at,
        "yref": yref,
        "y0": 0.0,
        "y1": 1.0,
        "layer": "below",
        "line": {"color": REFERENCE, "width": 1.2, "dash": "dot"} | line,
    }


def across(at: float, axis: str = "y", xref: str = "x domain", **line: Any) -> dict[str, Any]:
    """Line through a panel at a place of a y axis."""
    return upright(0.0, xref, axis, **line) | {"x1": 1.0, "y0": at, "y1": at}


def heading(content: str, shift_px: float, xref: str = "paper") -> dict[str, Any]:
    """Title above a figure or one of its columns, flush left."""
    return text(
        0.0,
        1.0,
        content,
        xref=xref,
        yref="paper",
        xanchor="left",
        yanchor="middle",
        yshift=shift_px,
        font={"size": FONT_SIZE, "color": INK},
    )


def legend_px(name: str) -> float:
    """Width that a name takes in a legend, estimated from the number of letters."""
    return 52.0 + 7.2 * len(name)


def legend_rows(names: Sequence[str], width_px: float) -> int:
    """Rows that a horizontal plotly legend of these names needs: one name follows the other."""
    rows, used = 1, 0.0
    for need in map(legend_px, names):
        if used and used + need > width_px:
            rows, used = rows + 1, 0.0
        used += need
    return rows


def column(inner_px: float) -> float:
    """Share of a figure's inner width that each of two columns may take: axis labels stand between them."""
    return min(0.44, 0.5 - _BETWEEN_PX / max(inner_px, 4.0 * _BETWEEN_PX))


def fitting(titles: Sequence[str], room_px: float, letter_px: float = _BOLD_PX) -> str:
    """Return the first of some titles, the longest first, that has room; else the last."""
    fits = (title for title in titles if len(title) * letter_px <= room_px)
    return next(fits, titles[-1])


def panel_title(content: str, suffix: str = "", shift_px: float = 13.0) -> dict[str, Any]:
    """Bold title above the subplot with axes ``x<suffix>``, ``y<suffix>``, flush left."""
    title = Text("<b>{content}</b>", content=content)
    return heading(title, shift_px, f"x{suffix} domain") | {"yref": f"y{suffix} domain"}
