"""A plotly figure drawn by matplotlib at the size of a journal's column, for a paper.

What the page shows is drawn once more from the same figure: curves, axes, ticks, titles and helping lines.
Curves differ in their dashes as well as in their colour, so that a print in black and white can be read.
"""

from __future__ import annotations

import html
import re
from collections.abc import Mapping
from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from schuler_bench.plots.plotly_data import PlotlyFigure, values_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLUMN_MM, PAGE_MM = 88.0, 180.0
"""Widths of one column of a journal, and of two."""
NARROWEST_MM, WIDEST_MM = 40.0, 400.0
_INCH_MM = 25.4
_FONT_PT = 7.0
_PANEL_MM, _ONLY_PANEL_MM = 24.0, 50.0
_LEFT_MM, _RIGHT_MM, _TOP_MM, _BOTTOM_MM, _LEGEND_MM = 12.0, 2.5, 5.0, 9.0, 4.0
_LINE_MM = 3.0
_LETTER_MM = 1.4
"""Width of a letter of the legend, on average."""
_LINE_PT, _HELPING_PT = 0.9, 0.5
_PX_PT = 0.54
"""A pixel of the page's figure at the width of two columns, pt."""
_GREY = "#666666"
_DASHES: tuple[Any, ...] = (
    "solid",
    (0, (5, 1.5)),
    (0, (1, 1)),
    (0, (6, 1.5, 1, 1.5)),
    (0, (3, 1, 1, 1, 1, 1)),
)
_WORDS = {"dot": (0, (1, 1.5)), "dash": (0, (4, 2)), "dashdot": (0, (4, 2, 1, 2)), "solid": "solid"}
_MARKERS = {"circle": "o", "x": "x", "cross": "+", "diamond": "D", "square": "s"}
_RGBA = re.compile(r"rgba?\(([^)]*)\)")
_PART = re.compile(r"<(sub|sup)>([^<]*)</\1>")
_TAG = re.compile(r"</?\w[^<>]*>")


def printed_figure(
    figure: PlotlyFigure, width_mm: float | None = None, height_mm: float | None = None
) -> Figure:
    """Draw a plotly figure by matplotlib.

    Parameters
    ----------
    figure : PlotlyFigure
        Of curves; what else it holds is left out.
    width_mm : float, optional
        Of the picture, 40..400 mm; by default one column of a journal, two where panels stand side by side.
    height_mm : float, optional
        Of the picture, mm; by default 24 mm a panel.

    Returns
    -------
    matplotlib.figure.Figure
        It belongs to no window and to no list of open figures: ``figure.savefig("errors.pdf")``.

    Raises
    ------
    InputError
        matplotlib is not installed, or a size is out of its range.
    """
    for name, value in (("width_mm", width_mm), ("height_mm", height_mm)):
        if value is not None and not NARROWEST_MM <= value <= WIDEST_MM:
            allowed = Text("must be {low:g}..{high:g} (mm)", low=NARROWEST_MM, high=WIDEST_MM)
            raise InputError(Fault("", name, value, allowed))
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        why = Text("needs matplotlib, which is not installed: pip install matplotlib")
        raise InputError(Fault("paper_figure", "", None, why)) from None

    layout = figure["layout"]
    if width_mm is None:
        width_mm = COLUMN_MM if _panels(layout, "xaxis") == 1 else PAGE_MM
    names = [_plain(trace["name"]) for trace in figure["data"] if _in_legend(trace, layout)]
    legend_mm = _LEGEND_MM * _legend_rows(names, width_mm)
    tall = _panels(layout, "yaxis")
    below_mm = legend_mm + _BOTTOM_MM + (_LINE_MM if "<br>" in str(_ticks(layout)) else 0.0)
    panels_mm = _ONLY_PANEL_MM if tall == 1 else tall * _PANEL_MM
    height = panels_mm + _TOP_MM + below_mm if height_mm is None else height_mm
    made = Figure(figsize=(width_mm / _INCH_MM, height / _INCH_MM))
    FigureCanvasAgg(made)
    box = (
        _LEFT_MM / width_mm,
        below_mm / height,
        1.0 - (_LEFT_MM + _RIGHT_MM) / width_mm,
        1.0 - (_TOP_MM + below_mm) / height,
    )
    axes = _Panels(made, layout, box)
    _draw_curves(figure["data"], axes)
    for shape in layout.get("shapes", ()):
        _draw_shape(shape, axes)
    for note in layout.get("annotations", ()):
        _draw_note(note, axes)
    axes.finish()
    _draw_legend(made, axes, names, width_mm)
    return made


class _Panels:
    """Axes of the figure by the names that plotly gives them."""

    def __init__(self, made: Figure, layout: dict[str, Any], box: tuple[float, ...]) -> None:
        self._made, self._layout, self._box = made, layout, box
        self._axes: dict[tuple[str, str], Axes] = {}

    def of(self, x: str, y: str) -> Axes:
        """Return the axes of a pair such as ``x2`` and ``y3``; made when they are first asked for."""
        if (x, y) not in self._axes:
            across, up = self._axis(x), self._axis(y)
            left, low, width, height = self._box
            (x0, x1), (y0, y1) = across.get("domain", (0.0, 1.0)), up.get("domain", (0.0, 1.0))
            room = (left + x0 * width, low + y0 * height, (x1 - x0) * width, (y1 - y0) * height)
            self._axes[x, y] = self._made.add_axes(room)
        return self._axes[x, y]

    def beside(self, reference: str) -> Axes | None:
        """Return the axes that a reference such as ``y2 domain`` belongs to; None of the whole figure."""
        name = reference.removesuffix(" domain")
        return next((axes for pair, axes in self._axes.items() if name in pair), None)

    def value(self, reference: str, value: float) -> float:
        """Return a coordinate as matplotlib takes it: plotly's on a logarithmic axis is a power of ten."""
        return 10.0**value if self._axis(reference).get("type") == "log" else value

    def finish(self) -> None:
        """Give the axes their scales, ranges, ticks and titles."""
        for (x, y), axes in self._axes.items():
            _set_axis(axes, "x", self._axis(x), self._axis(x).get("anchor", "y") == y)
            _set_axis(axes, "y", self._axis(y), True)
            axes.grid(True, linewidth=0.3, color="#DDDDDD")
            axes.set_axisbelow(True)
            for side in axes.spines.values():
                side.set_linewidth(0.5)

    def handles(self) -> dict[str, Any]:
        """Return the first curve of each name."""
        found: dict[str, Any] = {}
        for axes in self._axes.values():
            for handle, name in zip(*axes.get_legend_handles_labels(), strict=True):
                found.setdefault(name, handle)
        return found

    def _axis(self, name: str) -> dict[str, Any]:
        return self._layout.get(f"{name[0]}axis{name[1:]}", {})


def _panels(layout: Mapping[str, Any], which: str) -> int:
    """Panels side by side ("xaxis"), or below each other."""
    domains = (layout[key].get("domain", (0.0, 1.0)) for key in layout if key.startswith(which))
    return len({round(float(low), 2) for low, _ in domains}) or 1


def _ticks(layout: Mapping[str, Any]) -> list[Any]:
    return [layout[key].get("ticktext") for key in layout if key.startswith("xaxis")]


def _draw_curves(traces: list[dict[str, Any]], panels: _Panels) -> None:
    dashes: dict[str, Any] = {}
    others = cycle(_DASHES)
    before: dict[Axes, np.ndarray] = {}
    for trace in traces:
        if trace.get("type", "scatter") != "scatter" or trace.get("visible") is False or "x" not in trace:
            continue
        axes = panels.of(trace.get("xaxis", "x"), trace.get("yaxis", "y"))
        x, y = (np.array(values_of(trace[name]), dtype=float) for name in "xy")
        line, mode = trace.get("line", {}), trace.get("mode", "lines")
        name = _plain(trace.get("name") or "")
        if trace.get("fill") == "tonexty" and axes in before:
            axes.fill_between(x, before[axes], y, color=_color(trace.get("fillcolor", "")), linewidth=0.0)
        before[axes] = y
        if line.get("width") == 0:
            continue
        group = str(trace.get("legendgroup") or name)
        if group not in dashes:
            dashes[group] = next(others)
        style = _dash(line["dash"]) if line.get("dash") else dashes[group]
        marker = trace.get("marker", {})
        shown = marker.get("symbol", "circle") if "markers" in mode else None
        axes.plot(
            x,
            y,
            label=name if name and trace.get("showlegend", True) else None,
            color=_color(line.get("color") or marker.get("color") or "black"),
            linewidth=_LINE_PT,
            linestyle=style if "lines" in mode else "none",
            marker=_MARKERS.get(shown.removesuffix("-open"), "o") if isinstance(shown, str) else None,
            markerfacecolor="none" if str(shown).endswith("-open") else None,
            markersize=3.0,
        )


def _draw_shape(shape: Mapping[str, Any], panels: _Panels) -> None:
    """Helping lines; each end may be in numbers of an axis, or in parts of its panel."""
    references = [shape.get(f"{name}ref", name) for name in "xy"]
    axes = next(filter(None, map(panels.beside, references)), None)
    if shape.get("type") != "line" or axes is None:
        return
    from matplotlib.transforms import blended_transform_factory

    parts, ends = [], []
    for name, reference in zip("xy", references, strict=True):
        inside = reference == "paper" or reference.endswith("domain")
        parts.append(axes.transAxes if inside else axes.transData)
        pair = (shape[f"{name}0"], shape[f"{name}1"])
        ends.append(pair)  # in numbers of the axis, also of a logarithmic one
    line = shape.get("line", {})
    axes.plot(
        *ends,
        transform=blended_transform_factory(*parts),
        color=_GREY,
        linewidth=_HELPING_PT,
        linestyle=_dash(line.get("dash", "solid")),
        zorder=0.5,
    )


def _draw_note(note: Mapping[str, Any], panels: _Panels) -> None:
    """Titles of panels, and words beside a helping line."""
    references = [note.get(f"{name}ref", "paper") for name in "xy"]
    axes = next((found for one in references if (found := panels.beside(one)) is not None), None)
    text = _plain(note.get("text", ""))
    if not text:
        return
    if "<b>" in note["text"]:
        axes = panels.of("x", "y") if axes is None else axes
        axes.set_title(text, loc="left", fontsize=_FONT_PT, pad=2.0)
        return
    if axes is None:
        return
    from matplotlib.transforms import blended_transform_factory

    parts, place = [], []
    for name, reference in zip("xy", references, strict=True):
        inside = reference == "paper" or reference.endswith("domain")
        parts.append(axes.transAxes if inside else axes.transData)
        place.append(min(note[name], 0.98) if inside else panels.value(reference, note[name]))
    above = note.get("yanchor") == "top" or place[1] == 0.98  # above a panel stands its title
    axes.annotate(
        text,
        (place[0], place[1]),
        xycoords=blended_transform_factory(*parts),
        xytext=(_PX_PT * note.get("xshift", 0.0), _PX_PT * note.get("yshift", 0.0)),
        textcoords="offset points",
        fontsize=_FONT_PT - 1.0,
        color=_GREY,
        ha={"left": "left", "right": "right"}.get(note.get("xanchor", "center"), "center"),
        va="top" if above else {"bottom": "bottom"}.get(note.get("yanchor", "middle"), "center"),
        annotation_clip=False,
    )


def _set_axis(axes: Axes, which: str, axis: Mapping[str, Any], labelled: bool) -> None:
    log, own = axis.get("type") == "log", getattr(axes, f"{which}axis")
    if axis.get("range"):  # before the scale, which would look for positive numbers
        low, high = (10.0**end if log else end for end in axis["range"])
        getattr(axes, f"set_{which}lim")(low, high)
    if log:
        getattr(axes, f"set_{which}scale")("log")
    if axis.get("tickvals") is not None:
        ticks = [float(one) for one in axis["tickvals"]]
        words = [_plain(str(one)) for one in axis.get("ticktext", ticks)]
        own.set_ticks(ticks, labels=words)
        own.set_minor_locator(_none())
    elif not log:
        own.get_major_locator().set_params(nbins=6 if which == "x" else 4)
    axes.tick_params(axis=which, labelsize=_FONT_PT - 0.5, width=0.5, length=2.0, pad=1.5)  # pyright: ignore[reportArgumentType]
    if axis.get("showticklabels") is False or not labelled:
        own.set_tick_params(labelbottom=False, labelleft=False)
    if not labelled:
        return
    title = axis.get("title", {}).get("text", "") if axis.get("title") else ""
    getattr(axes, f"set_{which}label")(_plain(title), fontsize=_FONT_PT, labelpad=1.5)


def _none() -> Any:
    from matplotlib.ticker import NullLocator

    return NullLocator()


def _in_legend(trace: Mapping[str, Any], layout: Mapping[str, Any]) -> bool:
    return bool(trace.get("name")) and trace.get("showlegend", True) and layout.get("showlegend", True)


def _legend_columns(names: list[str], width_mm: float) -> int:
    longest = max((len(name) for name in names), default=0)
    return max(1, min(len(names), int(width_mm / (_LETTER_MM * longest + 12.0))))


def _legend_rows(names: list[str], width_mm: float) -> int:
    return -(-len(set(names)) // _legend_columns(names, width_mm)) if names else 0


def _draw_legend(made: Figure, panels: _Panels, names: list[str], width_mm: float) -> None:
    found = panels.handles()
    kept = {name: found[name] for name in dict.fromkeys(names) if name in found}
    if kept:
        made.legend(
            [*kept.values()],
            [*kept],
            loc="lower center",
            ncols=_legend_columns(names, width_mm),
            fontsize=_FONT_PT,
            frameon=False,
            borderaxespad=0.2,
            handlelength=2.6,
            columnspacing=1.2,
        )


def _dash(dash: str) -> Any:
    if dash in _WORDS:
        return _WORDS[dash]
    return 0, tuple(float(part.removesuffix("px")) / 1.5 for part in re.split(r"[,\s]+", dash.strip()))


def _color(color: str) -> Any:
    match = _RGBA.fullmatch(color.strip()) if isinstance(color, str) else None
    if match is None:
        return color or "black"
    parts = [float(part) for part in match[1].split(",")]
    return tuple(part / 255.0 for part in parts[:3]) + tuple(parts[3:])


def _plain(text: str) -> str:
    r"""Text of a plotly figure as matplotlib takes it.

    Examples
    --------
    >>> _plain("<b>Open loop &omega;<sub>s</sub></b>")
    'Open loop ω$_{\\mathrm{s}}$'
    """
    text = text.replace("<br>", "\n").replace("$", r"\$")
    text = _PART.sub(
        lambda m: f"$^{{\\mathrm{{{m[2]}}}}}$" if m[1] == "sup" else f"$_{{\\mathrm{{{m[2]}}}}}$", text
    )
    return html.unescape(_TAG.sub("", text))
