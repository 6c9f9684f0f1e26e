"""The open loop omega_s^2 H/s^2 of every method: Bode plot left, Nyquist plot right, margins in both."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

import numpy as np

from app.plots import style
from app.plots.effective import effective_network
from app.plots.plotly_data import PlotlyFigure, figure, packed
from app.plots.units import duration, number
from navcore.analysis.margins import Margins, margins
from navcore.engine.run import MethodRun, Run
from navcore.networks.base import LinearNetwork

LOW, HIGH = 0.02, 500.0
"""Range of the frequency axis, units of omega_s."""
_POINTS = 500
_COLUMN = 0.44
_RIGHT_EDGE = 0.3
_UNIT_CIRCLE = 0.72
"""Half height of the Nyquist panel is the unit circle over this."""
_PAPER = "rgba(255,255,255,0.85)"
_LETTER_PX, _LINE_PX, _MOST_LINES = 6.6, 18, 8


@dataclass(frozen=True)
class _Loop:
    num: bytes
    den: bytes
    network: LinearNetwork = field(compare=False)


@lru_cache(maxsize=64)
def _margins(loop: _Loop) -> Margins | None:
    return margins(loop.network)


def margins_of(method: MethodRun) -> Margins | None:
    """Margins of what acts in a method; None where they mean nothing (undamped or unstable)."""
    network = effective_network(method)
    return _margins(_Loop(network.loop_num_p.tobytes(), network.den_p.tobytes(), network))


@lru_cache(maxsize=1)
def _grid() -> np.ndarray:
    grid = np.geomspace(LOW, HIGH, _POINTS)
    grid.setflags(write=False)
    return grid


def open_loop(method: MethodRun, ratio: np.ndarray) -> np.ndarray:
    """L = omega_s^2 H/s^2 at s = j ratio omega_s, (H + p G)/p^2 for a network with two outputs."""
    network = effective_network(method)
    return -network.loop_response(ratio * network.omega_s) / ratio**2


def nyquist(run: Run, aspect: float = 0.46, *, width_px: float = 940.0) -> PlotlyFigure:
    """Open loop of every method, with its margins.

    Left: gain and phase, with a dot where the gain is 1. Right: Nyquist plot near -1 with the unit circle;
    a dot where the curve crosses the circle (phase margin), diamonds where it crosses the real axis (gain
    margins). Undamped loops run through -1, unstable ones have no margin.

    Parameters
    ----------
    run : Run
        Result; only its networks are used.
    aspect : float
        Height / width of the figure.
    width_px : float
        Expected width on screen.
    """
    rows = style.legend_rows([m.method.name for m in run.methods], width_px - 84.0)
    margin = {"l": 68, "r": 16, "t": 34, "b": 66 + 22 * rows}
    ratio = _grid()
    x = packed(ratio)
    data: list[dict[str, Any]] = []
    words: list[str] = []
    levels: list[np.ndarray] = []
    for i, method in enumerate(run.methods):
        value = open_loop(method, ratio)
        level = 20.0 * np.log10(np.maximum(np.abs(value), 1e-12))
        # -L is H omega_s^2/omega^2: its phase, unwrapped, less 180 degrees
        phase = np.rad2deg(np.unwrap(np.angle(-value))) - 180.0
        levels.append(level)
        found = margins_of(method)
        words.append(margin_words(method, found))
        data += _curves(method, i, x, level, phase, value)
        data += _marks(method, i, found, words[-1])
    re, im = _window(aspect, width_px, margin)
    column_px = (width_px - margin["l"] - margin["r"]) * _COLUMN
    return figure(data, _layout(run, words, levels, (re, im), margin, (aspect, column_px)))


def margin_words(method: MethodRun, found: Margins | None) -> str:
    """Margins in one line, or why there are none."""
    if found is None:
        return "unstable" if not method.loop.stable and not method.method.undamped else "no margin: undamped"
    parts = []
    if found.phase_rad is not None:
        parts.append(f"phase {number(math.degrees(found.phase_rad), 3)}°")
    low = "" if found.gain_down is None else f"×{number(found.gain_down, 3)}"
    high = "" if found.gain_up is None else f"×{number(found.gain_up, 3)}"
    if low or high:
        parts.append(
            f"gain {low} to {high}" if low and high else f"gain to {high}" if high else f"gain from {low}"
        )
    if found.delay_s is not None:
        parts.append(f"delay {duration(found.delay_s)}")
    return ", ".join(parts)


def _curves(
    method: MethodRun, index: int, x: dict[str, str], level: np.ndarray, phase: np.ndarray, value: np.ndarray
) -> list[dict[str, Any]]:
    name = style.plain(method.method.name)
    common: dict[str, Any] = {
        "type": "scatter",
        "mode": "lines",
        "name": name,
        "legendgroup": str(index),
        "line": {"color": style.method_color(index), "width": style.LINE_WIDTH, "simplify": False},
        "showlegend": False,
    }
    bode = common | {"x": x, "xaxis": "x"}
    return [
        bode | {"y": packed(level), "yaxis": "y", "hovertemplate": "%{y:.2f} dB", "showlegend": True},
        bode | {"y": packed(phase), "yaxis": "y2", "hovertemplate": "%{y:.1f}°"},
        common
        | {
            "x": packed(np.real(value)),
            "y": packed(np.imag(value)),
            "xaxis": "x2",
            "yaxis": "y3",
            "customdata": x,
            "hovertemplate": f"<b>{name}</b><br>ω = %{{customdata:.3g}} ω<sub>s</sub><br>"
            "L = %{x:.3g} %{y:+.3g}j<extra></extra>",
        },
    ]


def _marks(method: MethodRun, index: int, found: Margins | None, words: str) -> list[dict[str, Any]]:
    """Dots at the crossover in all three plots, diamonds at the gain margins."""
    name, color = style.plain(method.method.name), style.method_color(index)
    dots: dict[str, tuple[list[float], list[float]]] = {"y": ([], []), "y2": ([], []), "y3": ([], [])}
    gains: list[float] = []
    if found is not None:
        gains = [-1.0 / g for g in (found.gain_up, found.gain_down) if g is not None]
        if found.crossover_rad_s is not None and found.phase_rad is not None:
            ratio = found.crossover_rad_s / method.network.omega_s
            dots = {
                "y": ([ratio], [0.0]),
                "y2": ([ratio], [math.degrees(found.phase_rad) - 180.0]),
                "y3": ([-math.cos(found.phase_rad)], [-math.sin(found.phase_rad)]),
            }
    common: dict[str, Any] = {
        "type": "scatter",
        "mode": "markers",
        "legendgroup": str(index),
        "showlegend": False,
        "hovertemplate": f"<b>{name}</b><br>{words}<extra></extra>",
    }
    ring = {"width": 1.5, "color": "white"}
    made = [
        common
        | {
            "name": f"{name} margin",
            "x": x,
            "y": y,
            "xaxis": "x2" if axis == "y3" else "x",
            "yaxis": axis,
            "marker": {"symbol": "circle", "size": 9, "color": color, "line": ring},
        }
        for axis, (x, y) in dots.items()
    ]
    diamonds = {"symbol": "diamond", "size": 10, "color": color, "line": ring}
    return [
        *made,
        common
        | {"name": f"{name} gain margin", "x": gains, "y": [0.0] * len(gains), "xaxis": "x2", "yaxis": "y3"}
        | {"marker": diamonds},
    ]


def _window(
    aspect: float, width_px: float, margin: dict[str, int]
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Ranges of the Nyquist panel: equal scales, the unit circle whole."""
    height = max(aspect * width_px - margin["t"] - margin["b"], 100.0)
    width = (width_px - margin["l"] - margin["r"]) * _COLUMN
    half = max(1.0 / _UNIT_CIRCLE, 1.35 * height / width)
    wide = 2.0 * half * width / height
    right = max(_RIGHT_EDGE * wide, 1.08)
    return (right - wide, right), (-half, half)


def _layout(
    run: Run,
    words: list[str],
    levels: list[np.ndarray],
    window: tuple[tuple[float, float], tuple[float, float]],
    margin: dict[str, int],
    shape: tuple[float, float],
) -> dict[str, Any]:
    (re, im), (aspect, column_px) = window, shape
    decades = range(math.ceil(math.log10(LOW)), math.floor(math.log10(HIGH)) + 1)
    period = 2.0 * math.pi / run.scenario.omega_s
    top = min(max(float(np.max(level)) for level in levels), 60.0)
    made = style.layout(
        margin=margin,
        hovermode="closest",
        legend=style.legend(),
        meta={"aspect": aspect},
        xaxis=style.axis(
            "frequency ω/ω<sub>s</sub> and period",
            type="log",
            domain=[0.0, _COLUMN],
            anchor="y2",
            mirror="all",
            ticks="",
            range=[math.log10(LOW), math.log10(HIGH)],
            tickvals=[10.0**k for k in decades],
            ticktext=[f"{10.0**k:g}<br>{duration(period / 10.0**k)}" for k in decades],
            minor={"showgrid": True, "dtick": "D1", "gridcolor": style.GRID_FINE},
        ),
        yaxis=style.axis("|L|  (dB)", domain=[0.53, 1.0], anchor="x", range=[-80.0, top + 5.0], dtick=20.0),
        yaxis2=style.axis("phase (°)", domain=[0.0, 0.47], anchor="x", range=[-270.0, -90.0], dtick=45.0),
        xaxis2=style.axis("Re L", domain=[1.0 - _COLUMN, 1.0], anchor="y3", range=list(re), showgrid=False),
        yaxis3=style.axis(
            "Im L", domain=[0.0, 1.0], anchor="x2", range=list(im), scaleanchor="x2", showgrid=False
        ),
    )
    return made | {"shapes": _shapes(), "annotations": _notes(run, words, column_px)}


def _shapes() -> list[dict[str, Any]]:
    """0 dB, -180 degrees, the unit circle and the axes of the plane."""
    line = {"color": style.REFERENCE, "width": 1.2, "dash": "dot"}
    across = {"type": "line", "xref": "x domain", "x0": 0.0, "x1": 1.0, "layer": "below", "line": line}
    plane = {"type": "line", "xref": "x2", "yref": "y3", "layer": "below"}
    thin = {"color": style.GRID, "width": 1}
    return [
        across | {"yref": "y", "y0": 0.0, "y1": 0.0},
        across | {"yref": "y2", "y0": -180.0, "y1": -180.0},
        plane | {"type": "circle", "x0": -1.0, "x1": 1.0, "y0": -1.0, "y1": 1.0, "line": line},
        plane | {"xref": "x2 domain", "x0": 0.0, "x1": 1.0, "y0": 0.0, "y1": 0.0, "line": thin},
        plane | {"yref": "y3 domain", "x0": 0.0, "x1": 0.0, "y0": 0.0, "y1": 1.0, "line": thin},
    ]


def _notes(run: Run, words: list[str], column_px: float) -> list[dict[str, Any]]:
    title = {"size": style.TITLE_SIZE, "color": style.INK}
    titles = [
        style.text(
            0.0,
            1.0,
            f"<b>{content}</b>",
            xref=xref,
            yref="paper",
            xanchor="left",
            yanchor="middle",
            yshift=16,
            font=title,
        )
        for xref, content in (
            ("x domain", "Open loop L(jω) = ω<sub>s</sub>² H/s²"),
            ("x2 domain", "Nyquist plot near −1 (✚)"),
        )
    ]
    critical = style.text(
        -1.0, 0.0, "✚", xref="x2", yref="y3", font={"size": 20, "color": style.DANGER}, yshift=0
    )
    return [*titles, critical, *_listed(run, words, column_px)]


def _listed(run: Run, words: list[str], column_px: float) -> list[dict[str, Any]]:
    """Margins of the methods at the top of the Nyquist panel, where no damped loop runs; named by place."""
    notes: list[dict[str, Any]] = []
    above = 0
    for index, (method, content) in enumerate(zip(run.methods, words, strict=True)):
        lines = wrapped(f"{method.method.name}: {content}", int(column_px / _LETTER_PX))
        if above + len(lines) > _MOST_LINES:
            break
        note = style.text(
            0.0,
            1.0,
            "<br>".join(style.plain(line) for line in lines),
            xref="x2 domain",
            yref="y3 domain",
            xanchor="left",
            yanchor="top",
            align="left",
            xshift=4,
            yshift=-3 - _LINE_PX * above,
            font={"size": style.FONT_SIZE, "color": style.method_color(index)},
            bgcolor=_PAPER,
            borderpad=0,
            name=str(index),
        )
        notes.append(note)
        above += len(lines)
    return notes


def wrapped(text: str, most: int) -> list[str]:
    """Lines of at most ``most`` letters, broken at commas."""
    lines: list[str] = []
    for part in text.split(", "):
        if lines and len(lines[-1]) + len(part) + 2 <= most:
            lines[-1] += f", {part}"
        else:
            lines.append(part)
    return lines
