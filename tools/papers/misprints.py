"""Section of the printed errors that change a result, printed and corrected (`schuler_bench.misprints`)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from schuler_bench.misprints import MISPRINTS, Comparison, Misprint
from tools.papers.claim import Exhibit, Paper, Table, number
from tools.papers.picture import panel
from tools.papers.runs import Runs

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_STYLES = {"printed": ("#D55E00", "--"), "corrected": ("#0072B2", "-")}


def comparison(runs: Runs, item: Misprint) -> Comparison:
    """Both forms of a misprint, computed once."""
    return runs.keep(("misprint", item.id), item.compute)


def _number(value: float | None) -> str:
    return "none" if value is None else number(value)


def _table(runs: Runs, remarks: bool = False) -> Table:
    rows = []
    for item in MISPRINTS.values():
        if item.remark != remarks:
            continue
        for i, shown in enumerate(comparison(runs, item).numbers):
            where = f"{item.paper}, {item.where}" if i == 0 else ""
            texts = (item.printed, item.right) if i == 0 else ("", "")
            name = f"{shown.name}, {shown.unit}" if shown.unit else shown.name
            rows.append((where, *texts, name, _number(shown.printed), _number(shown.corrected)))
    rows = [tuple(text.replace("|", "\\|") for text in row) for row in rows]
    if remarks:
        caption = "No misprints: printed rightly, or a statement of a figure, with what it costs:"
        return Table(
            caption, ("where", "printed", "in its place", "number", "as printed", "other"), tuple(rows)
        )
    head = ("where", "printed", "right", "number", "as printed", "corrected")
    return Table("", head, tuple(rows))


def _remarks(runs: Runs) -> Table:
    return _table(runs, remarks=True)


def window(both: Comparison) -> tuple[float, float] | None:
    """Part of the y axis on which both forms can be judged; None: all of it.

    A form that diverges would press the other one flat: the window is three times the corrected curves' own
    span, as far as the printed ones reach.
    """
    right = np.concatenate([curve.y for curve in both.curves if curve.form == "corrected"])
    every = np.concatenate([curve.y for curve in both.curves])
    low, high = float(np.nanmin(right)), float(np.nanmax(right))
    if both.y_axis.log or low == high:
        return None
    least, most = float(np.nanmin(every)), float(np.nanmax(every))
    ends = max(least, 2.0 * low - high), min(most, 2.0 * high - low)
    return None if ends == (least, most) else ends


def _draw(runs: Runs, figure: Figure) -> None:
    items = list(MISPRINTS.values())
    axes = figure.subplots(-(-len(items) // 2), 2, squeeze=False).flat
    for axis, item in zip(axes, items, strict=False):
        found = comparison(runs, item)
        for one in found.curves:
            color, dash = _STYLES[one.form]
            axis.plot(found.x, one.y, color=color, linestyle=dash, label=one.label)
        ends = window(found)
        if ends is not None:
            axis.set_ylim(*ends)
        axis.set_xscale("log" if found.x_axis.log else "linear")
        axis.set_yscale("log" if found.y_axis.log else "linear")
        x, y = (f"{a.label}, {a.unit}" if a.unit else a.label for a in (found.x_axis, found.y_axis))
        panel(axis, f"{item.paper}, {item.where}", x, y)
    for axis in list(axes)[len(items) :]:
        axis.set_axis_off()


PAPER = Paper(
    "Misprints",
    "What the papers print wrongly where it changes a result; both forms computed by the same code.",
    (
        Exhibit(
            name="misprints",
            title="As printed and corrected",
            presets=(),
            setting="Dashed: as printed.",
            tables=(_table, _remarks),
            draw=_draw,
            height=2.3 * -(-len(MISPRINTS) // 2),
        ),
    ),
)
