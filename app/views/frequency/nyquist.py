"""The open loop omega_s^2 H/s^2 of every method: Bode plot left, Nyquist plot right, margins in both."""

import math
from functools import lru_cache
from typing import Any

import numpy as np

from navcore.analysis.frequencies import curve_frequencies
from navcore.analysis.loop import closed_loop_poles
from navcore.analysis.margins import Margins, margins
from navcore.engine.run import MethodRun, Run
from navcore.foundation.text import Text
from schuler_bench.plots import style
from schuler_bench.plots.effective import Loop, loop_of
from schuler_bench.plots.plotly_data import PlotlyFigure, figure, packed
from schuler_bench.plots.units import duration, number

LOW, HIGH = 0.02, 500.0
"""Range of the frequency axis, units of omega_s."""
_EVEN = np.geomspace(LOW, HIGH, 500)
_COLUMN = 0.44
_RIGHT_EDGE = 0.3
_UNIT_CIRCLE = 0.72
"""Half height of the Nyquist panel is the unit circle over this."""
_PAPER = "rgba(255,255,255,0.85)"
_LETTER_PX, _LINE_PX, _MOST_LINES = 6.6, 18, 8
_margins = lru_cache(maxsize=64)(margins)


def margins_of(method: MethodRun) -> Margins | None:
    """Margins of what acts in a method; None where they mean nothing (undamped or unstable)."""
    return _margins(method.network)


@lru_cache(maxsize=64)
def open_loop(loop: Loop) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies x = omega/omega_s and L = omega_s^2 H/s^2 at s = j x omega_s; (H + p G)/p^2 of two outputs.

    Among the frequencies are the extremes of |L| and of |1 + L|, the distance from -1.
    """
    network = loop.network
    poles = np.concatenate([network.poles / network.omega_s, [0.0, 0.0]])
    of_loop, of_distance = np.roots(network.loop_num_p), closed_loop_poles(network)
    ratio = curve_frequencies(_EVEN, (of_loop, poles), (of_distance, poles))
    return ratio, -network.loop_response(ratio * network.omega_s) / ratio**2


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
    names = [method.method.name for method in run.methods]
    layout = style.framed(names, aspect, width_px, {"l": 68, "r": 16, "t": 34, "b": 66}, hovermode="closest")
    column_px = (width_px - 84.0) * _COLUMN
    height_px = max(aspect * width_px - layout["margin"]["t"] - layout["margin"]["b"], 100.0)
    data: list[dict[str, Any]] = []
    words: list[str] = []
    highest: list[float] = []
    for method in run.methods:
        ratio, value = open_loop(loop_of(method))
        level = 20.0 * np.log10(np.maximum(np.abs(value), 1e-12))
        margin = margins_of(method)
        words.append(margin_words(method, margin))
        highest.append(float(np.max(level)))
        data += _curves(method, packed(ratio), level, value)
        data += _marks(method, margin, words[-1])
    layout |= _axes(run, min(*highest, 60.0), column_px, height_px)
    return figure(data, layout | {"shapes": _shapes(), "annotations": _notes(run, words, column_px)})


def margin_words(method: MethodRun, margin: Margins | None) -> str:
    """Margins in one line, or why there are none."""
    if margin is None:
        return (
            Text("unstable")
            if not method.loop.stable and not method.method.undamped
            else Text("no margin: undamped")
        )
    parts = []
    if margin.phase_rad is not None:
        parts.append(Text("phase {phase_rad}°", phase_rad=number(math.degrees(margin.phase_rad), 3)))
    low = "" if margin.gain_down is None else f"×{number(margin.gain_down, 3)}"
    high = "" if margin.gain_up is None else f"×{number(margin.gain_up, 3)}"
    if low or high:
        parts.append(
            Text("gain {low} to {high}", low=low, high=high)
            if low and high
            else Text("gain to {high}", high=high)
            if high
            else Text("gain from {low}", low=low)
        )
    if margin.delay_s is not None:
        parts.append(Text("delay {delay_s}", delay_s=duration(margin.delay_s)))
    return Text.joined(", ", parts)


def _curves(
    method: MethodRun, x: dict[str, str], level: np.ndarray, value: np.ndarray
) -> list[dict[str, Any]]:
    common = style.lines(method.method.name, method.place) | {"showlegend": False}
    bode = common | {"x": x, "xaxis": "x"}
    # -L is H omega_s^2/omega^2: its phase, unwrapped, less 180 degrees
    phase = np.rad2deg(np.unwrap(np.angle(-value))) - 180.0
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
            "hovertemplate": Text(
                "<b>{common}</b><br>ω = %{{customdata:.3g}} ω<sub>s</sub><br>L = %{{x:.3g}} "
                "%{{y:+.3g}}j<extra></extra>",
                common=common["name"],
            ),
        },
    ]


def _marks(method: MethodRun, margin: Margins | None, words: str) -> list[dict[str, Any]]:
    """Dots at the crossover in all three plots, diamonds at the gain margins."""
    name, ring = method.method.name, {"width": 1.5, "color": "white"}
    dots: list[tuple[list[float], list[float]]] = [([], [])] * 3
    gains: list[float] = []
    if margin is not None:
        gains = [-1.0 / g for g in (margin.gain_up, margin.gain_down) if g is not None]
        if margin.crossover_rad_s is not None and margin.phase_rad is not None:
            ratio = margin.crossover_rad_s / method.network.omega_s
            degrees = math.degrees(margin.phase_rad) - 180.0
            unit = [-math.cos(margin.phase_rad)], [-math.sin(margin.phase_rad)]
            dots = [([ratio], [0.0]), ([ratio], [degrees]), unit]
    hover = {
        "hovertemplate": Text("<b>{name}</b><br>{words}<extra></extra>", name=style.plain(name), words=words)
    }
    dot = style.marks(Text("{name} margin", name=name), method.place, "circle", 9, ring) | hover
    diamond = style.marks(Text("{name} gain margin", name=name), method.place, "diamond", 10, ring) | hover
    axes = ("x", "y"), ("x", "y2"), ("x2", "y3")
    return [
        *(
            dot | {"x": x, "y": y, "xaxis": xaxis, "yaxis": yaxis}
            for (x, y), (xaxis, yaxis) in zip(dots, axes, strict=True)
        ),
        diamond | {"x": gains, "y": [0.0] * len(gains), "xaxis": "x2", "yaxis": "y3"},
    ]


def _axes(run: Run, top: float, width_px: float, height_px: float) -> dict[str, Any]:
    """Axes of the three plots; the Nyquist panel has equal scales, and the unit circle whole."""
    decades = range(math.ceil(math.log10(LOW)), math.floor(math.log10(HIGH)) + 1)
    period = 2.0 * math.pi / run.scenario.omega_s
    half = max(1.0 / _UNIT_CIRCLE, 1.35 * height_px / width_px)
    wide = 2.0 * half * width_px / height_px
    right = max(_RIGHT_EDGE * wide, 1.08)
    return {
        "xaxis": style.axis(
            Text("frequency ω/ω<sub>s</sub> and period"),
            type="log",
            domain=[0.0, _COLUMN],
            anchor="y2",
            mirror="all",
            ticks="",
            range=[math.log10(LOW), math.log10(HIGH)],
            tickvals=[10.0**k for k in decades],
            ticktext=[
                Text("{k:g}<br>{duration}", k=10.0**k, duration=duration(period / 10.0**k)) for k in decades
            ],
            minor={"showgrid": True, "dtick": "D1", "gridcolor": style.GRID_FINE},
        ),
        "yaxis": style.axis(
            "|L|  (dB)", domain=[0.53, 1.0], anchor="x", range=[-80.0, top + 5.0], dtick=20.0
        ),
        "yaxis2": style.axis(
            Text("phase (°)"), domain=[0.0, 0.47], anchor="x", range=[-270.0, -90.0], dtick=45.0
        ),
        "xaxis2": style.axis(
            Text("Re L"),
            domain=[1.0 - _COLUMN, 1.0],
            anchor="y3",
            range=[right - wide, right],
            showgrid=False,
        ),
        "yaxis3": style.axis(
            Text("Im L"),
            domain=[0.0, 1.0],
            anchor="x2",
            range=[-half, half],
            scaleanchor="x2",
            showgrid=False,
        ),
    }


def _shapes() -> list[dict[str, Any]]:
    """0 dB, -180 degrees, the unit circle and the axes of the plane."""
    circle = {"type": "circle", "xref": "x2", "yref": "y3", "x0": -1.0, "x1": 1.0, "y0": -1.0, "y1": 1.0}
    thin = {"color": style.GRID, "width": 1, "dash": "solid"}
    return [
        style.across(0.0),
        style.across(-180.0, "y2"),
        style.upright(0.0) | circle,
        style.across(0.0, "y3", "x2 domain", **thin),
        style.upright(0.0, "x2", "y3 domain", **thin),
    ]


def _notes(run: Run, words: list[str], column_px: float) -> list[dict[str, Any]]:
    return [
        style.heading(Text("<b>Open loop L(jω) = ω<sub>s</sub>² H/s²</b>"), 16, "x domain"),
        style.heading(Text("<b>Nyquist plot near −1 (✚)</b>"), 16, "x2 domain"),
        style.text(-1.0, 0.0, "✚", xref="x2", yref="y3", font={"size": 20, "color": style.DANGER}, yshift=0),
        *_listed(run, words, column_px),
    ]


def _listed(run: Run, words: list[str], column_px: float) -> list[dict[str, Any]]:
    """Margins of the methods at the top of the Nyquist panel, where no damped loop runs; named by place."""
    notes: list[dict[str, Any]] = []
    above = 0
    for method, content in zip(run.methods, words, strict=True):
        lines = wrapped(
            Text("{name}: {content}", name=method.method.name, content=content), int(column_px / _LETTER_PX)
        )
        if above + len(lines) > _MOST_LINES:
            break
        note = style.text(
            0.0,
            1.0,
            Text.joined("<br>", (style.plain(line) for line in lines)),
            xref="x2 domain",
            yref="y3 domain",
            xanchor="left",
            yanchor="top",
            align="left",
            xshift=4,
            yshift=-3 - _LINE_PX * above,
            font={"size": style.FONT_SIZE, "color": style.method_color(method.place)},
            bgcolor=_PAPER,
            borderpad=0,
            name=str(method.place),
        )
        notes.append(note)
        above += len(lines)
    return notes


def wrapped(text: str, most: int) -> list[str]:
    """Lines of at most ``most`` letters, broken at commas."""
    lines: list[str] = []
    for part in text.split(", "):
        if lines and len(lines[-1]) + len(part) + 2 <= most:
            lines[-1] += Text(", {part}", part=part)
        else:
            lines.append(part)
    return lines
