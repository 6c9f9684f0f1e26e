"""Poles and zeros of the closed Schuler loop in units of omega_s: all poles left, the slow ones right."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from app.editing.placing import COMMAND
from app.plots import style
from app.plots.effective import closed_loop_poles, effective_network
from app.plots.plotly_data import PlotlyFigure, figure, packed
from app.plots.units import duration
from app.session.requirements import Requirements, fastest_rate
from app.views.poles.grid import (
    ANYWHERE,
    DAMPING,
    PAPER,
    Allowed,
    Interval,
    damping_lines,
    forbidden,
    settling_labels,
    settling_shapes,
)
from app.views.poles.locus import NO_LOCUS, locus_note, locus_traces
from navcore.engine.run import MethodRun, Run

ZOOM = 1.7
"""Half height of the right panel, units of omega_s."""
_HEIGHTS = (4.0, 6.0, 10.0, 16.0, 25.0, 40.0, 60.0, 100.0, 160.0, 250.0, 400.0, 1e3, 1e4, 1e5)
_RIGHT_SHARE = 0.14
"""Part of a panel's width that shows the right half plane."""
_MARGIN = {"l": 58, "r": 16, "t": 32}
PANELS = (("xaxis", "yaxis"), ("xaxis2", "yaxis2"))
"""Axes of the two panels: all poles, and those near the Schuler frequency."""
_PICK = {"command": COMMAND, "panels": PANELS}
"""What pick.js does with a click: it is a wanted pole, in units of the Schuler frequency."""
_UNSTABLE_PX = 58.0
"""Width of the word."""
_INSIDE = 0.955
"""Part of a panel's width within which the labels of the rays lie."""
_RAY_PX = 27.0
"""Least distance of two labels of rays at one height."""
_KEYS = ("closed-loop pole", "zero of H")
_TITLES = {
    "": ("All closed-loop poles (┊ settling time)", "All closed-loop poles", "All poles"),
    "2": ("Near the Schuler frequency", "Near Schuler"),
}
"""Title of each panel, then shorter ones for smaller panels."""


def poles(
    run: Run,
    aspect: float = 0.46,
    *,
    width_px: float = 940.0,
    selected: int = 0,
    locus: str = NO_LOCUS,
    allowed: Allowed = ANYWHERE,
) -> PlotlyFigure:
    """Closed-loop poles (x) and zeros of H (o) of every method, in units of omega_s.

    Grey rays are lines of equal damping ratio 0.1 .. 0.9, grey arcs lines of equal natural frequency, grey
    upright dashes lines of equal settling time (e^(Re t) = 2 %); the imaginary axis is the stability
    boundary. A zero far beyond all poles is named at the left edge.

    Parameters
    ----------
    run : Run
        Result.
    aspect : float
        Height / width of the figure.
    width_px : float
        Expected width on screen: both panels get equal scales on both axes there.
    selected : int
        Method whose locus is drawn.
    locus : str
        Parameter of its network over which the locus is drawn.
    allowed : Allowed
        What the requirements ask of the poles.
    """
    rows = style.legend_rows([m.method.name for m in run.methods] + list(_KEYS), width_px - 84.0)
    margin = _MARGIN | {"b": 48 + 22 * rows}
    shape = _panel_shape(aspect, width_px, margin)
    marks = [(_scaled(m, closed_loop_poles(m)), _scaled(m, effective_network(m).zeros)) for m in run.methods]
    full = _half_height(np.concatenate([roots for roots, _ in marks]), shape)
    panels = {"": _panel(full, shape), "2": _panel(ZOOM, shape)}
    data: list[dict[str, Any]] = []
    for suffix, (re, im) in panels.items():
        data.append(damping_lines(suffix, re, im))
        data += locus_traces(run, selected, locus, suffix)
        for i, (method, (roots, zeros)) in enumerate(zip(run.methods, marks, strict=True)):
            data += _method_marks(method, i, roots, zeros, suffix)
    data += _key_entries()
    share, width = _column(width_px, margin)
    layout = _layout(panels, margin, aspect, locus_note(run, selected, locus), width, share)
    layout["annotations"] += _far_zeros([zeros for _, zeros in marks], panels[""][0][0])
    for suffix, (re, im) in panels.items():
        layout["annotations"] += settling_labels(suffix, re, run.scenario.omega_s, width)
        layout["shapes"] += settling_shapes(suffix, re, run.scenario.omega_s, width)
        layout["shapes"] += forbidden(suffix, re, im, allowed, run.scenario.omega_s)
    return figure(data, layout)


def _scaled(method: MethodRun, roots: np.ndarray) -> np.ndarray:
    return np.asarray(roots, dtype=np.complex128) / method.network.omega_s


def _panel_shape(aspect: float, width_px: float, margin: dict[str, int]) -> float:
    """Width / height of one panel."""
    height = aspect * width_px - margin["t"] - margin["b"]
    return _column(width_px, margin)[1] / max(height, 1.0)


def _column(width_px: float, margin: dict[str, int]) -> tuple[float, float]:
    """Width of one panel: its part of the room between the margins, and px."""
    inner_px = width_px - margin["l"] - margin["r"]
    share = style.column(inner_px)
    return share, share * inner_px


def _half_height(roots: np.ndarray, shape: float) -> float:
    """Smallest of a fixed set of scales that shows every pole: the picture stands still on a slider."""
    finite = roots[np.isfinite(roots)]
    re, im = np.real(finite), np.imag(finite)
    left = 2.0 * shape * (1.0 - _RIGHT_SHARE)
    right = 2.0 * shape * _RIGHT_SHARE
    need = max(
        float(np.max(np.abs(im), initial=0.0)),
        float(np.max(-re, initial=0.0)) / left,
        float(np.max(re, initial=0.0)) / right,
    )
    return next((h for h in _HEIGHTS if 1.08 * need <= h), 1.08 * need)


def _panel(half_height: float, shape: float) -> tuple[Interval, Interval]:
    """Ranges of the real and imaginary axes."""
    width = 2.0 * half_height * shape
    return (-(1.0 - _RIGHT_SHARE) * width, _RIGHT_SHARE * width), (-half_height, half_height)


def _method_marks(
    method: MethodRun, index: int, roots: np.ndarray, zeros: np.ndarray, suffix: str
) -> list[dict[str, Any]]:
    color, name = style.method_color(index), style.plain(method.method.name)
    common: dict[str, Any] = {
        "type": "scatter",
        "mode": "markers",
        "xaxis": f"x{suffix}",
        "yaxis": f"y{suffix}",
        "legendgroup": str(index),
    }
    cross = common | {
        "name": name,
        "x": packed(np.real(roots)),
        "y": packed(np.imag(roots)),
        "text": [_about_pole(complex(root), method.network.omega_s) for root in roots],
        "hovertemplate": f"<b>{name}</b><br>%{{text}}<extra></extra>",
        "marker": {"symbol": "x-thin", "size": 11, "line": {"color": color, "width": 2.6}, "color": color},
        "showlegend": suffix == "",
    }
    ring = common | {
        "name": f"{name} zeros",
        "x": packed(np.real(zeros)),
        "y": packed(np.imag(zeros)),
        "hovertemplate": f"<b>{name}</b><br>zero of H: %{{x:.4g}} %{{y:+.4g}}j ω<sub>s</sub><extra></extra>",
        "marker": {"symbol": "circle-open", "size": 10, "line": {"color": color, "width": 2}, "color": color},
        "showlegend": False,
    }
    return [cross, ring] if len(zeros) else [cross]


def _about_pole(root: complex, omega_s: float) -> str:
    size = abs(root)
    lines = [f"pole: {root.real:.4g} {root.imag:+.4g}j ω<sub>s</sub>"]
    if size > 0.0:
        period = duration(2.0 * math.pi / (size * omega_s))
        lines.append(f"damping ratio {-root.real / size:.3f}, natural period {period}")
    if root.real != 0.0:
        folding = duration(1.0 / abs(root.real * omega_s))
        lines.append(f"decays to 1/e in {folding}" if root.real < 0.0 else f"grows e-fold in {folding}")
    return "<br>".join(lines)


def _key_entries() -> list[dict[str, Any]]:
    """Legend entries that say what the two marks mean."""
    marks = (("x-thin", 2.6), ("circle-open", 2.0))
    return [
        {
            "type": "scatter",
            "mode": "markers",
            "x": [None],
            "y": [None],
            "name": name,
            "hoverinfo": "skip",
            "marker": {
                "symbol": symbol,
                "size": 10,
                "color": style.MUTED,
                "line": {"color": style.MUTED, "width": width},
            },
        }
        for name, (symbol, width) in zip(_KEYS, marks, strict=True)
    ]


def _layout(
    panels: dict[str, tuple[Interval, Interval]],
    margin: dict[str, int],
    aspect: float,
    locus: str,
    room_px: float,
    share: float,
) -> dict[str, Any]:
    made = style.layout(
        margin=margin, hovermode="closest", legend=style.legend(), meta={"aspect": aspect, "pick": _PICK}
    )
    titles = {suffix: style.fitting(texts, room_px) for suffix, texts in _TITLES.items()}
    shapes: list[dict[str, Any]] = []
    notes: list[dict[str, Any]] = []
    for suffix, (re, im) in panels.items():
        domain = [0.0, share] if suffix == "" else [1.0 - share, 1.0]
        # "domain": else plotly widens the range for a size in which it draws once, and never takes that back
        made[f"xaxis{suffix}"] = style.axis(
            "Re s / ω<sub>s</sub>",
            domain=domain,
            anchor=f"y{suffix}",
            range=list(re),
            constrain="domain",
            showgrid=False,
        )
        made[f"yaxis{suffix}"] = style.axis(
            "Im s / ω<sub>s</sub>",
            anchor=f"x{suffix}",
            range=list(im),
            scaleanchor=f"x{suffix}",
            constrain="domain",
            showgrid=False,
        )
        shapes += _boundary(suffix)
        notes += [style.panel_title(titles[suffix], suffix), *_panel_labels(suffix, re, im, room_px)]
    if locus:
        # in place of the title, in plain letters: those of a parameter's ends take more room
        notes = [note for note in notes if titles["2"] not in note["text"]]
        notes.append(style.panel_title(f'<span style="font-weight:400">{locus}</span>', "2"))
    return made | {"shapes": shapes, "annotations": notes}


def _boundary(suffix: str) -> list[dict[str, Any]]:
    """Imaginary axis, real axis and the shaded right half plane."""
    below: dict[str, Any] = {"xref": f"x{suffix}", "yref": f"y{suffix} domain", "y0": 0.0, "y1": 1.0}
    below |= {"x0": 0.0, "x1": 0.0, "layer": "below"}
    return [
        below | {"type": "rect", "x1": 1e6, "line": {"width": 0}, "fillcolor": "rgba(180,35,24,0.07)"},
        below | {"type": "line", "line": {"color": style.DANGER, "width": 1.4}},
        below
        | {"type": "line", "line": {"color": style.REFERENCE, "width": 1}}
        | {"xref": f"x{suffix} domain", "x1": 1.0, "yref": f"y{suffix}", "y1": 0.0},
    ]


def _panel_labels(suffix: str, re: Interval, im: Interval, width_px: float) -> list[dict[str, Any]]:
    """Name the half plane and every second damping ray, as far as the names have room beside each other."""
    font = {"size": style.FONT_SIZE, "color": style.MUTED}
    notes = [
        style.text(
            1.0,
            0.0,
            "unstable",
            xref=f"x{suffix} domain",
            yref=f"y{suffix} domain",
            xanchor="right",
            yanchor="bottom",
            xshift=-3,
            yshift=3,
            # upright where the half plane is too narrow for it
            textangle=0 if re[1] / (re[1] - re[0]) * width_px >= _UNSTABLE_PX else -90,
            font=font | {"color": style.DANGER},
        )
    ]
    last: tuple[float, float] | None = None
    for ratio in DAMPING[::2]:
        x, y = _ray_end(ratio, re, im)
        if last is not None and last[0] - x < _RAY_PX / width_px * (re[1] - re[0]) and y == last[1]:
            continue
        last = x, y
        content = f"ζ = {ratio:.1f}" if ratio == DAMPING[-1] else f"{ratio:.1f}"
        where = {"xref": f"x{suffix}", "yref": f"y{suffix}", "bgcolor": PAPER, "borderpad": 0}
        if x <= _INSIDE * re[0] + 1e-9:  # centred, a label at the left edge would hang over it
            where |= {"xanchor": "left"}
        notes.append(style.text(x, y, content, font=font, **where))
    name = {"xref": f"x{suffix}", "yref": f"y{suffix}", "xanchor": "right", "yanchor": "top", "xshift": -3}
    if im[1] < 8.0:
        notes.append(style.text(-1.0, 0.0, "ω<sub>s</sub>", font=font, **name))
    return notes


def _ray_end(ratio: float, re: Interval, im: Interval) -> tuple[float, float]:
    """Where a ray in the upper half leaves the panel, a little inside."""
    cosine, sine = ratio, math.sqrt(1.0 - ratio * ratio)
    length = min(_INSIDE * -re[0] / cosine, 0.94 * im[1] / sine)
    return -cosine * length, sine * length


def _far_zeros(zeros: list[np.ndarray], left: float) -> list[dict[str, Any]]:
    """Notes for real zeros so far out that showing them would press all poles together."""
    beyond = [
        (index, float(zero.real))
        for index, found in enumerate(zeros)
        for zero in found
        if zero.real < left and abs(zero.imag) < 1e-6 * abs(zero)
    ]
    return [
        style.text(
            0.0,
            0.0,
            f"◂ zero at {value:.4g}",
            xref="x domain",
            yref="y",
            xanchor="left",
            yanchor="bottom",
            xshift=4,
            yshift=3 + 18 * row,
            font={"size": style.FONT_SIZE, "color": style.method_color(index)},
            name=str(index),
            bgcolor=PAPER,
            borderpad=0,
        )
        for row, (index, value) in enumerate(beyond)
    ]


def allowed_poles(requirements: Requirements) -> Allowed:
    """Where the requirements let poles lie."""
    return Allowed(requirements.damping_ratio, fastest_rate(requirements))
