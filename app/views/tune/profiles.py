"""The objective over each parameter of a method, beside each other: before a search."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from navcore.design.profile import Profile
from navcore.foundation.text import Text
from navcore.quantities import QUANTITIES
from navcore.scenario.method import Method
from schuler_bench.editing import form
from schuler_bench.plots import style
from schuler_bench.plots.plotly_data import PlotlyFigure, figure, packed

_MOST_ABREAST = 3
_MARGIN = {"l": 48, "r": 14, "t": 32, "b": 48}
_BETWEEN, _BELOW = 0.05, 0.2
"""Parts of the figure between two panels, and between two rows of them."""


def profiles_figure(
    found: Sequence[Profile], objective: str, method: Method, color: int, aspect: float
) -> PlotlyFigure:
    """Small panels with one axis for the objective, which is logarithmic where it spans a decade.

    Its name stands above the first panel: beside a low one there is no room for it.

    Parameters
    ----------
    found : sequence of Profile
        One a panel; at least one.
    objective : str
        Key of `navcore.quantities.QUANTITIES`.
    method : Method
        Whose parameters they are.
    color : int
        Place of the method's colour.
    aspect : float
        Height / width of the figure.
    """
    quantity = QUANTITIES[objective]
    labels = {spec.path[-1]: spec.label for spec in form.fields(type(method.network), ("network",))}
    wanted = np.concatenate([one.found for one in found])
    wanted = wanted[np.isfinite(wanted) & (wanted > 0.0)]
    up = "log" if wanted.size and wanted.max() > 10.0 * wanted.min() else "linear"
    title = Text("{label} ({shown})", label=quantity.label, shown=quantity.shown)
    abreast = min(len(found), _MOST_ABREAST)
    rows = -(-len(found) // abreast)
    data: list[dict[str, Any]] = []
    axes: dict[str, Any] = {}
    for place, one in enumerate(found):
        name = str(place + 1) if place else ""
        row, column = divmod(place, abreast)
        left, top = column / abreast, 1.0 - row / rows
        across = [left, left + 1.0 / abreast - (_BETWEEN if column + 1 < abreast else 0.0)]
        down = [top - 1.0 / rows + (_BELOW if row + 1 < rows else 0.0), top]
        axes[f"xaxis{name}"] = style.axis(
            labels[one.field.rsplit(".", 1)[-1]],
            domain=across,
            anchor=f"y{name}",
            **(_logarithmic(one) if one.log else {"nticks": 5}),
        )
        axes[f"yaxis{name}"] = style.axis(
            domain=down,
            anchor=f"x{name}",
            type=up,
            showticklabels=not column,
        ) | ({"matches": "y"} if place else {})
        where = {"xaxis": f"x{name}", "yaxis": f"y{name}", "showlegend": False}
        curve = {"x": packed(np.array(one.values)), "y": packed(np.array(one.found) / quantity.size)}
        data.append(style.lines(method.name, color) | curve | where)
        if one.now is not None:
            dot = {"x": [one.now[0]], "y": [one.now[1] / quantity.size]}
            edge = {"color": "white", "width": 1.5}
            data.append(style.marks(method.name, color, "circle", 11, edge) | dot | where)
    layout = style.layout(
        meta={"aspect": aspect, "y_title": title},
        margin=_MARGIN,
        showlegend=False,
        hovermode="closest",
        annotations=[style.panel_title(title)],
        **axes,
    )
    return figure(data, layout)


def _logarithmic(one: Profile) -> dict[str, Any]:
    """Axis with ticks at 1, 2 and 5, or at powers of ten where there are many of those."""
    low, high = one.values[0], one.values[-1]
    steps = (1.0, 2.0, 5.0) if high < 300.0 * low else (1.0,)
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    ticks = [step * 10.0**power for power in powers for step in steps]
    ticks = [tick for tick in ticks if low <= tick * (1.0 + 1e-9) and tick <= high * (1.0 + 1e-9)]
    return {"type": "log", "tickvals": ticks, "ticktext": [f"{tick:.6g}" for tick in ticks]}
