"""A misprint's two forms in one plot, and what they are in words and numbers."""

import math
from collections.abc import Sequence
from itertools import repeat
from typing import Any, Literal, get_args

import numpy as np

from navcore.foundation.notation import with_unit
from navcore.foundation.text import Text, quoted
from navcore.foundation.units import HOUR, MINUTE
from schuler_bench.misprints import Axis, Comparison, Curve, Misprint, Number
from schuler_bench.plots import style
from schuler_bench.plots.plotly_data import PlotlyFigure, figure, packed
from schuler_bench.plots.table import cell, row, table
from schuler_bench.plots.units import Unit, angle_unit, length_unit, number, speed_unit

Shown = Literal["both", "as printed", "corrected"]
SHOWN: tuple[Shown, ...] = get_args(Shown)
FORMS: dict[str, tuple[str, ...]] = {
    Text("both"): ("printed", "corrected"),
    "as printed": ("printed",),
    "corrected": ("corrected",),
}
_COLORS = {"printed": "#D55E00", "corrected": "#0072B2"}
_DASHES = {"printed": ("6px,4px", "2px,3px"), "corrected": ("solid", "dot", "dashdot")}
_MOST_TICKS = 6
_LETTER_PX = 7.0
"""Width of a letter of an axis' title."""
_LEAVES = 12.0
"""A printed curve that many times as large as the corrected one leaves the plot, not to flatten the other."""
_SECONDS = (Unit("s", 1.0), Unit("min", MINUTE), Unit("h", HOUR))


def comparison_plot(
    comparison: Comparison, shown: Shown = "both", aspect: float = 0.4, *, width_px: float = 940.0
) -> PlotlyFigure:
    """Curves of a misprint as printed (dashed) and corrected (solid).

    Parameters
    ----------
    comparison : Comparison
        From `Misprint.compute`.
    shown : {"both", "as printed", "corrected"}
        Which curves are drawn.
    aspect : float
        Height / width of the figure.
    width_px : float
        Expected width on screen, for room for the legend.
    """
    curves = [curve for curve in comparison.curves if curve.form in FORMS[shown]]
    x_axis, y_axis = comparison.x_axis, comparison.y_axis
    low, high, leaves = _range(curves, log=y_axis.log)
    x_unit = _unit(x_axis, float(np.max(np.abs(comparison.x[np.isfinite(comparison.x)]), initial=0.0)))
    y_unit = _unit(y_axis, max(abs(low), abs(high)))
    margin = {"l": 76, "r": 18, "t": 30 if leaves else 12, "b": 46}
    names = [curve.label for curve in curves]
    layout = style.framed(names, aspect, width_px, margin, hovermode="x unified", showlegend=True)
    height = aspect * width_px - margin["t"] - layout["margin"]["b"]
    zero = {"zeroline": not y_axis.log, "zerolinecolor": style.REFERENCE, "zerolinewidth": 1, "nticks": 7}
    layout["xaxis"] = _axis(x_axis, x_unit, 1)
    layout["yaxis"] = _axis(y_axis, y_unit, _decades([curve.y for curve in curves]), height) | zero
    if not y_axis.log and high > low:
        pad = 0.06 * (high - low)
        layout["yaxis"]["range"] = [(low - pad) / y_unit.si, (high + pad) / y_unit.si]
    layout["annotations"] = [style.panel_title(Text("The printed form leaves the plot"))] if leaves else []
    return figure(_traces(curves, packed(comparison.x / x_unit.si), y_unit), layout)


def _range(curves: list[Curve], *, log: bool) -> tuple[float, float, bool]:
    """Lowest and highest value that the plot shows, SI, and whether a printed curve is cut off."""
    extents = {form: _span([c.y for c in curves if c.form == form]) for form in _COLORS}
    present = [span for span in extents.values() if span is not None]
    if not present:
        return 0.0, 0.0, False
    low, high = min(span[0] for span in present), max(span[1] for span in present)
    printed, corrected = extents["printed"], extents["corrected"]
    if printed is None or corrected is None or log:
        return low, high, False
    width = corrected[1] - corrected[0]
    if width == 0.0 or printed[1] - printed[0] <= _LEAVES * width:
        return low, high, False
    return max(low, corrected[0] - width), min(high, corrected[1] + width), True


def _span(values: list[np.ndarray]) -> tuple[float, float] | None:
    finite = np.concatenate([[], *(y[np.isfinite(y)] for y in values)])
    return (float(finite.min()), float(finite.max())) if len(finite) else None


def _traces(curves: list[Curve], x: dict[str, str], unit: Unit) -> list[dict[str, Any]]:
    """Curves of one form have dashes of their own."""
    dashes = {form: [*kinds, *repeat(kinds[-1], len(curves))] for form, kinds in _DASHES.items()}
    return [
        {
            "type": "scatter",
            "mode": "lines",
            "x": x,
            "y": packed(curve.y / unit.si),
            "name": style.plain(curve.label),
            "hovertemplate": f"%{{y:.4g}} {unit.name}".rstrip(),
            "line": {
                "color": _COLORS[curve.form],
                "dash": dashes[curve.form].pop(0),
                "width": style.LINE_WIDTH,
                "simplify": False,
            },
        }
        for curve in curves
    ]


def _decades(values: Sequence[np.ndarray]) -> int:
    """Decades between two ticks of a logarithmic axis, so that they stay apart."""
    span = _span([np.where(v > 0.0, v, np.nan) for v in values])
    spanned = 1.0 if span is None else math.log10(span[1] / span[0])
    return max(1, math.ceil(spanned / _MOST_TICKS))


def _axis(axis: Axis, unit: Unit, decades: int, room_px: float = math.inf) -> dict[str, Any]:
    parts = [axis.label, *([f"({unit.name})"] if unit.name else [])]
    long = len(" ".join(parts)) * _LETTER_PX > room_px
    title = Text.joined("<br>" if long else " ", map(style.plain, parts))
    if not axis.log:
        return style.axis(title)
    small = {"size": style.FONT_SIZE - 1, "color": style.MUTED}
    return style.axis(title, type="log", exponentformat="power", dtick=decades, tickfont=small)


def _unit(axis: Axis | Number, peak: float) -> Unit:
    """Unit on screen: readable for times, angles, speeds and lengths, the given one for the rest."""
    if axis.unit == "s" and isinstance(axis, Axis) and axis.log:
        return _SECONDS[0]
    if axis.unit == "s":
        return _SECONDS[0] if peak < 300.0 else _SECONDS[1] if peak < 3.0 * HOUR else _SECONDS[2]
    choose = {"rad": angle_unit, "m/s": speed_unit, "m": length_unit}.get(axis.unit)
    return choose(peak) if choose is not None else Unit(axis.unit, 1.0)


def words_html(misprint: Misprint, comparison: Comparison) -> str:
    """Write what is printed, what is right, what follows, and the numbers of both forms side by side."""
    printed, corrected = _COLORS["printed"], _COLORS["corrected"]
    sentences = (
        (Text("printed"), misprint.printed, printed),
        (Text("right"), misprint.right, corrected),
        (Text("so"), comparison.words or misprint.consequence, style.INK),
    )
    lines = Text.joined(
        "",
        (
            Text(
                '<div><b style="color:{color}"><span>{name}:</span></b> {text:html}</div>',
                color=color,
                name=name,
                text=text,
            )
            for name, text, color in sentences
            if text
        ),
    )
    head = row(
        [
            cell(),
            cell(Text("as printed"), "sb-n", tag="th", style=f"border-color:{printed}"),
            cell("corrected", "sb-n", tag="th", style=f"border-color:{corrected}"),
        ]
    )
    rows = (
        row([cell(quoted(n.name), "sb-m"), *(cell(_number(n, v), "sb-n") for v in (n.printed, n.corrected))])
        for n in comparison.numbers
    )
    return Text(
        '<div class="sb-misprint"><div>{lines}</div>{table}</div>', lines=lines, table=table([head], rows)
    )


def _number(of: Number, value: float | None) -> str:
    if value is None:
        return "none"
    # each in its own unit: 0.03 s beside 84 min reads better than 0.0005 min
    unit = _unit(of, abs(value))
    return quoted(with_unit(number(value / unit.si, 4), unit.name))
