"""A plotly figure as the plain dict that plotly.js reads (no validation, no deep copies), and enlarged plots.

In an enlarged plot what counts pixels grows; its numbers and proportions stay.
"""

from __future__ import annotations

import base64
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from navcore.foundation.text import Text

_PLOTLY_PX = frozenset(
    {"size", "standoff", "ticklen", "tickwidth", "linewidth", "gridwidth", "zerolinewidth", "xshift",
     "yshift", "itemwidth", "tracegroupgap", "borderpad", "borderwidth", "ax", "ay"}
)  # fmt: skip
_PLOTLY_INSIDE = {"margin": frozenset("lrtb"), "line": frozenset({"width"})}
"""Names that count pixels only within these."""
_KEPT = frozenset({"x", "y", "text", "customdata", "meta"})
_UPLOT_PX = frozenset(
    {"size", "labelSize", "labelGap", "gap", "width", "space", "prox", "height", "padding", "dash"}
)
_FONT_PX = re.compile(r"(?<![0-9.])([0-9.]+)px")


def enlarged(figure: PlotlyFigure, scale: float) -> PlotlyFigure:
    """Plotly figure for a place ``scale`` times as wide and high, in which everything is larger by that.

    Parameters
    ----------
    figure : PlotlyFigure
        Made for the smaller place.
    scale : float
        1: the figure itself.
    """
    if scale == 1.0:
        return figure
    return PlotlyFigure(figure | {part: _larger(figure[part], scale, "") for part in ("data", "layout")})


def enlarged_time_plot(arguments: dict[str, Any], scale: float) -> dict[str, Any]:
    """Return the same of what `schuler_bench.plots.uplot.UplotFigure.kwargs` gives."""
    if scale == 1.0:
        return arguments
    larger = {
        key: value if key == "data" else _larger_time(value, scale, key) for key, value in arguments.items()
    }
    return larger | {"height": round(larger["height"])} if larger.get("height") else larger


def _larger(value: Any, scale: float, inside: str) -> Any:
    if isinstance(value, list | tuple):
        return [_larger(each, scale, inside) for each in value]
    if not isinstance(value, Mapping) or "bdata" in value:
        return value
    own = _PLOTLY_INSIDE.get(inside, frozenset())
    return {
        key: each
        if key in _KEPT
        else _times(each, scale)
        if key in _PLOTLY_PX or key in own
        else _larger(each, scale, key)
        for key, each in value.items()
    }


def _larger_time(value: Any, scale: float, key: str) -> Any:
    if key in _UPLOT_PX:
        return _times(value, scale)
    if isinstance(value, str) and key in ("font", "labelFont"):
        return _FONT_PX.sub(lambda match: f"{float(match[1]) * scale:g}px", value)
    if isinstance(value, Mapping):
        return {name: _larger_time(each, scale, name) for name, each in value.items()}
    if isinstance(value, tuple) and key in ("series", "axes"):
        return tuple(_larger_time(each, scale, "") for each in value)
    return value


def _times(value: Any, scale: float) -> Any:
    if isinstance(value, list | tuple):
        return type(value)(_times(each, scale) for each in value)
    return (
        round(value * scale, 2) if isinstance(value, int | float) and not isinstance(value, bool) else value
    )


# Sent with every figure, since the page's own way to set it re-parses the whole figure each time.
CONFIG: dict[str, Any] = {"displayModeBar": False, "doubleClick": "reset", "responsive": False}


class FigureJson(str):
    """JSON text of a figure.

    Attributes
    ----------
    texts : dict of str to Text
        Texts with values in it, by their English.
    """

    texts: dict[str, Text]


class PlotlyFigure(dict[str, Any]):
    """Keys ``data``, ``layout`` and ``config`` as plotly.js reads them.

    It stands in for `plotly.graph_objects.Figure` where only `to_json` is asked for, which takes about a
    hundredth of the time.
    """

    @property
    def aspect(self) -> float:
        """Height / width the layout was made for, to be given to viser's ``add_plotly`` too."""
        return self["layout"]["meta"]["aspect"]

    def to_json(self) -> FigureJson:
        """JSON text of the figure."""
        import orjson

        texts: dict[str, Text] = {}

        def plain(value: Any) -> Any:
            if isinstance(value, str):
                if isinstance(value, Text):
                    texts[str(value)] = value
                return str(value)
            return dict(value)

        options = orjson.OPT_SERIALIZE_NUMPY | orjson.OPT_PASSTHROUGH_SUBCLASS
        json = FigureJson(orjson.dumps(self, plain, options).decode())
        json.texts = texts
        return json


def figure(data: list[dict[str, Any]], layout: dict[str, Any]) -> PlotlyFigure:
    """Make a figure from traces and layout."""
    return PlotlyFigure(data=data, layout=layout, config=CONFIG)


class Packed(dict[str, str]):
    """A packed array, which remembers its numbers in full for who wants to save them.

    Attributes
    ----------
    full : ndarray
        As they were given.
    """

    full: np.ndarray


def packed(values: np.ndarray) -> Packed:
    """Array as plotly.js takes it in binary: float32, base64. Infinite values become gaps."""
    single = np.asarray(values, dtype="<f4")
    finite = np.where(np.isfinite(single), single, np.float32("nan"))
    array = Packed(dtype="f4", bdata=base64.b64encode(finite.tobytes()).decode("ascii"))
    array.full = np.asarray(values)
    return array


def values_of(value: Any) -> list[float | None]:
    """Numbers of a trace, packed or listed, in full."""
    if isinstance(value, Packed):
        return [float(number) for number in value.full]
    return list(value)
