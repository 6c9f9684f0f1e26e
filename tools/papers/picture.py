"""Pictures of the report: one style, and files that come out the same every time."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from navcore.foundation.notation import in_symbols
from schuler_bench.plots.style import GRID, INK, MUTED, REFERENCE, method_color

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH_IN = 8.0
_MOST_POINTS = 1200
_NUMBERS = re.compile(r"(\.\d\d)\d+")
_PATHS = re.compile(r'\bd="[^"]*"|translate\([^)]*\)')

STYLE: dict[Any, Any] = {
    "axes.edgecolor": REFERENCE,
    "axes.grid": True,
    "axes.labelcolor": INK,
    "axes.titlecolor": INK,
    "axes.titlesize": 10.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 9.0,
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "grid.color": GRID,
    "grid.linewidth": 0.6,
    "legend.fontsize": 8.0,
    "legend.edgecolor": "none",
    "legend.framealpha": 0.85,
    "lines.linewidth": 1.2,
    "text.color": INK,
    "xtick.color": MUTED,
    "ytick.color": MUTED,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "savefig.facecolor": "white",
    "svg.fonttype": "path",
    "svg.hashsalt": "schuler-bench",
}


def save(path: Path, height: float, draw: Callable[[Figure], None]) -> None:
    """Draw a figure and write it as SVG, without dates and with coordinates to 0.01 point."""
    import matplotlib
    from matplotlib.figure import Figure

    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(WIDTH_IN, height), layout="constrained")
        draw(figure)
        figure.savefig(path, format="svg", metadata={"Date": None, "Creator": None})
    text = _PATHS.sub(lambda found: _NUMBERS.sub(r"\1", found[0]), path.read_text("utf-8"))
    path.write_text("\n".join(line.rstrip() for line in text.splitlines()) + "\n", "utf-8")


def curve(axes: Axes, x: np.ndarray, y: np.ndarray, label: str, index: int, **more: Any) -> None:
    """Draw one curve in the colour of a method's place, thinned to what the picture can show."""
    x, y = _thinned(np.asarray(x), np.asarray(y))
    options: dict[str, Any] = {"color": method_color(index)} | more
    axes.plot(x, y, label=in_symbols(label), **options)


def _thinned(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Minimum and maximum of each bin in the order in which they came."""
    width = -(-2 * len(x) // _MOST_POINTS)
    if width <= 1 or len(x) <= _MOST_POINTS:
        return x, y
    kept: list[int] = []
    for start in range(0, len(y), width):
        part = y[start : start + width]
        kept.extend(sorted({start + int(np.argmin(part)), start + int(np.argmax(part))}))
    return x[kept], y[kept]


def panel(axes: Axes, title: str, x: str, y: str, legend: bool = True) -> None:
    """Title, labels and legend of one panel."""
    axes.set_title(in_symbols(title))
    axes.set_xlabel(in_symbols(x))
    axes.set_ylabel(in_symbols(y))
    if legend:
        axes.legend(loc="best")
