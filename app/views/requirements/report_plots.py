"""Error curves of a report as SVG: tilt, velocity, heading and position of every method."""

import math
from collections.abc import Sequence

import numpy as np

from navcore.engine.run import Run
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.quantities import HEADING, KINDS, NAMES, POSITION, Kind, components
from schuler_bench.plots import style
from schuler_bench.plots.svg_axes import Box, Curve, axes, key, word

_WIDTH, _HEIGHT = 760.0, 230.0
_BOX = Box(70.0, 34.0, 675.0, 150.0)
_MOST_POINTS = 1200


def error_svgs(run: Run) -> list[str]:
    """Make a plot of each kind of error over time."""
    shown = [kind for kind in KINDS if run.scenario.run.fidelity != "channel" or kind is not HEADING]
    return [_plot(run, kind) for kind in shown]


def _plot(run: Run, kind: Kind) -> str:
    curves = []
    for method in run.methods:
        t_h, length = _thinned(method.t_s / HOUR, _length(method.rows, kind) / kind.size)
        if len(t_h):
            curves.append(Curve(t_h, length, style.method_color(method.place)))
    title = Text("{title} ({unit})", title=kind.title, unit=kind.unit)
    names = [(style.method_color(one.place), one.method.name) for one in run.methods]
    end = float(run.t_s[-1]) / HOUR if len(run.t_s) else 1.0
    head, foot = Text("{title:html}", title=title), Text("time (h)")
    drawn = axes(_BOX, curves, least=1e-6, ends=(0.0, max(end, 1e-6))) if curves else ""
    return Text(
        '<svg viewBox="0 0 {width:g} {height:g}" role="img" aria-label="{title:html}" font-family="{font}" '
        'font-size="12" fill="{ink}" xmlns="http://www.w3.org/2000/svg">{head}{drawn}{foot}{legend}</svg>',
        width=_WIDTH,
        height=_HEIGHT,
        title=title,
        font=style.SVG_FONT,
        ink=style.INK,
        head=word(_BOX.left, 20.0, head),
        drawn=drawn,
        foot=word(_BOX.left + _BOX.width, _BOX.top + _BOX.height + 15.0, foot, "end"),
        legend=_legend(names),
    )


def _legend(names: Sequence[tuple[str, str]]) -> str:
    room = _BOX.width / max(len(names), 1)
    entries = (
        key(_BOX.left + k * room, _HEIGHT - 10.0, color, Text("{name:html}", name=name))
        for k, (color, name) in enumerate(names)
    )
    return Text.joined("", entries)


def _length(rows: np.ndarray, kind: Kind) -> np.ndarray:
    """Magnitude of an error of two axes, else the error."""
    columns = [NAMES.index(name) for name in components(kind)]
    if kind is POSITION or len(columns) > 1:
        return np.sqrt(np.sum(rows[:, columns] ** 2, axis=1))
    return rows[:, columns[0]]


def _thinned(t: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Curve with at most so many points that a printer can show, its extremes kept."""
    every = math.ceil(len(t) / (_MOST_POINTS // 2))
    if every <= 1:
        return t, values
    kept = []
    for first in range(0, len(t), every):
        part = values[first : first + every]
        kept += sorted({first + int(np.argmin(part)), first + int(np.argmax(part))})
    return t[kept], values[kept]
