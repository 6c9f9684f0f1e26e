"""A plotly figure as the plain dict that plotly.js reads: no validation, no deep copies, arrays packed."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np

# Sent with every figure, since the page's own way to set it re-parses the whole figure each time.
CONFIG: dict[str, Any] = {"displayModeBar": False, "doubleClick": "reset", "responsive": False}


class PlotlyFigure(dict[str, Any]):
    """Keys ``data``, ``layout`` and ``config`` as plotly.js reads them.

    It stands in for `plotly.graph_objects.Figure` where only `to_json` is asked for, which takes about a
    hundredth of the time.
    """

    @property
    def aspect(self) -> float:
        """Height / width the layout was made for, to be given to viser's ``add_plotly`` too."""
        return self["layout"]["meta"]["aspect"]

    def to_json(self) -> str:
        """JSON text of the figure."""
        import orjson

        return orjson.dumps(self, option=orjson.OPT_SERIALIZE_NUMPY).decode()


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


def unpacked(value: dict[str, str]) -> np.ndarray:
    """Inverse of `packed`, float32."""
    return np.frombuffer(base64.b64decode(value["bdata"]), dtype="<f4")
