"""Poles and zeros of the closed Schuler loop in units of omega_s: all poles left, the slow ones right."""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from navcore.engine.run import MethodRun, Run
from navcore.foundation.text import Text
from schuler_bench.editing.placing import COMMAND, Block, unit_frequency
from schuler_bench.plots import style
from schuler_bench.plots.plotly_data import PlotlyFigure, figure, packed
from schuler_bench.plots.units import duration
from schuler_bench.views.poles.grid import (
    DAMPING,
    NO_LOCUS,
    PAPER,
    Interval,
    damping_lines,
    forbidden,
    locus_note,
    locus_traces,
    settling_labels,
    settling_shapes,
)

ZOOM = 1.7
"""Half height of the right panel, units of omega_s."""
_HEIGHTS = (4.0, 6.0, 10.0, 16.0, 25.0, 40.0, 60.0, 100.0, 160.0, 250.0, 400.0, 1e3, 1e4, 1e5)
_RIGHT_SHARE = 0.14
"""Part of a panel's width that shows the right half plane."""
PANELS = (("xaxis", "yaxis"), ("xaxis2", "yaxis2"))
"""Axes of the two panels: all poles, and those near the Schuler frequency."""
_PICK = {"command": COMMAND, "panels": PANELS}
"""Action of pick.js on a click: it is a wanted pole, in units of the Schuler frequency."""
_UNSTABLE_PX = 58.0
"""Width of the word."""
_INSIDE = 0.955
"""Part of a panel's width within which the labels of the rays lie."""
_RAY_PX = 27.0, 18.0
"""Room of the label of a ray, across and up."""
_KEYS = {Text("closed-loop pole"): ("x-thin", 2.6), Text("zero of H"): ("circle-open", 2.0)}
"""Legend entries that say what the two marks mean."""
_ALL = Text("All closed-loop poles (┊ settling time)"), Text("All closed-loop poles"), Text("All poles")


class _Unit(NamedTuple):
    """In what a pole map is drawn: sign of its unit, name of the network, and titles, longest first."""

    sign: str
    network: str
    titles: dict[str, tuple[str, ...]]


_UNITS: dict[Block, _Unit] = {
    "network": _Unit(
        "ω<sub>s</sub>", "H", {"": _ALL, "2": (Text("Near the Schuler frequency"), Text("Near Schuler"))}
    ),
    "azimuth": _Unit("Ω", "Y", {"": _ALL, "2": (Text("Near the Earth's rate"), Text("Near Ω"))}),
}


def poles(
    run: Run,
    aspect: float = 0.46,
    *,
    width_px: float = 940.0,
    selected: int = 0,
    locus: str = NO_LOCUS,
    limits: Mapping[str, float] | None = None,
    block: Block = "network",
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
    limits : mapping of str to float, optional
        `schuler_bench.session.requirements.Requirements.limits`: what they rule out is shaded.
    block : {"network", "azimuth"}
        Whose loops the run holds: "azimuth" for one of `schuler_bench.views.poles.azimuth.azimuth_loops`.
    """
    names = [*(method.method.name for method in run.methods), *_KEYS]
    layout = style.framed(names, aspect, width_px, {"l": 58, "r": 16, "t": 32, "b": 48}, hovermode="closest")
    margin = layout["margin"]
    inner_px = width_px - margin["l"] - margin["r"]
    share = style.column(inner_px)
    panel_px = share * inner_px
    shape = panel_px / max(aspect * width_px - margin["t"] - margin["b"], 1.0)
    marks = [(_scaled(m, m.loop.poles), _scaled(m, m.network.zeros)) for m in run.methods]
    full = _half_height(np.concatenate([roots for roots, _ in marks]), shape)
    note, omega_s = locus_note(run, selected, locus), unit_frequency(run.scenario, block)
    unit = _UNITS[block]
    panels = (("", full, [0.0, share]), ("2", ZOOM, [1.0 - share, 1.0]))
    data, shapes = [], []
    notes: list[dict[str, Any]] = []
    for suffix, half, domain in panels:
        re, im = _panel(half, shape)
        data.append(damping_lines(suffix, re, im))
        data += locus_traces(run, selected, locus, suffix)
        for method, own in zip(run.methods, marks, strict=True):
            data += _method_marks(method, own, suffix, unit)
        layout |= _axes(suffix, re, im, domain, unit.sign)
        title = Text("<b>{titles}</b>", titles=style.fitting(unit.titles[suffix], panel_px))
        if suffix and note:  # in plain letters: those of a parameter's ends take more room
            title = Text('<b><span style="font-weight:400">{note}</span></b>', note=note)
        notes.append(style.heading(title, 13.0, f"x{suffix} domain") | {"yref": f"y{suffix} domain"})
        notes += _panel_labels(suffix, re, im, panel_px, unit.sign)
        notes += settling_labels(suffix, re, omega_s, panel_px)
        shapes += _boundary(suffix)
        shapes += settling_shapes(suffix, re, omega_s, panel_px)
        shapes += forbidden(suffix, re, im, limits or {}, omega_s)
    notes += _far_zeros(
        {one.place: zeros for one, (_, zeros) in zip(run.methods, marks, strict=True)},
        _panel(full, shape)[0][0],
    )
    data += [style.key(name, symbol, width) for name, (symbol, width) in _KEYS.items()]
    layout["meta"] |= {"pick": _PICK}
    return figure(data, layout | {"shapes": shapes, "annotations": notes})


def _scaled(method: MethodRun, roots: np.ndarray) -> np.ndarray:
    return np.asarray(roots, dtype=np.complex128) / method.network.omega_s


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
    method: MethodRun, marks: tuple[np.ndarray, np.ndarray], suffix: str, unit: _Unit
) -> list[dict[str, Any]]:
    roots, zeros = marks
    color, name, place = style.method_color(method.place), method.method.name, method.place
    axes = {"xaxis": f"x{suffix}", "yaxis": f"y{suffix}"}
    plain = style.plain(name)
    cross = style.marks(name, place, "x-thin", 11, {"color": color, "width": 2.6}) | axes
    cross |= {
        "x": packed(np.real(roots)),
        "y": packed(np.imag(roots)),
        "text": [_about_pole(complex(root), method.network.omega_s, unit.sign) for root in roots],
        "hovertemplate": Text("<b>{plain}</b><br>%{{text}}<extra></extra>", plain=plain),
        "showlegend": suffix == "",
    }
    if not len(zeros):
        return [cross]
    ring = (
        style.marks(Text("{name} zeros", name=name), place, "circle-open", 10, {"color": color, "width": 2})
        | axes
    )
    ring |= {
        "x": packed(np.real(zeros)),
        "y": packed(np.imag(zeros)),
        "hovertemplate": Text(
            "<b>{plain}</b><br>zero of {of}: %{{x:.4g}} %{{y:+.4g}}j {sign}<extra></extra>",
            plain=plain,
            of=unit.network,
            sign=unit.sign,
        ),
    }
    return [cross, ring]


def _about_pole(root: complex, omega_s: float, sign: str) -> str:
    size = abs(root)
    lines = [Text("pole: {real:.4g} {imag:+.4g}j {sign}", real=root.real, imag=root.imag, sign=sign)]
    if size > 0.0:
        period = duration(2.0 * math.pi / (size * omega_s))
        lines.append(
            Text("damping ratio {real:.3f}, natural period {period}", real=-root.real / size, period=period)
        )
    if root.real != 0.0:
        folding = duration(1.0 / abs(root.real * omega_s))
        lines.append(
            Text("decays to 1/e in {folding}", folding=folding)
            if root.real < 0.0
            else Text("grows e-fold in {folding}", folding=folding)
        )
    return Text.joined("<br>", lines)


def _axes(suffix: str, re: Interval, im: Interval, domain: list[float], sign: str) -> dict[str, Any]:
    # "domain": else plotly widens the range for a size in which it draws once, and never takes that back
    common = {"constrain": "domain", "showgrid": False}
    across = {"domain": domain, "anchor": f"y{suffix}", "range": list(re), "tickangle": 0}
    up = {"anchor": f"x{suffix}", "range": list(im), "scaleanchor": f"x{suffix}"}
    return {
        f"xaxis{suffix}": style.axis(Text("Re s / {sign}", sign=sign), **common, **across),
        f"yaxis{suffix}": style.axis(Text("Im s / {sign}", sign=sign), **common, **up),
    }


def _boundary(suffix: str) -> list[dict[str, Any]]:
    """Imaginary axis, real axis and the shaded right half plane."""
    axes = f"x{suffix}", f"y{suffix} domain"
    unstable = {"type": "rect", "x1": 1e6, "line": {"width": 0}, "fillcolor": "rgba(180,35,24,0.07)"}
    return [
        style.upright(0.0, *axes) | unstable,
        style.upright(0.0, *axes, color=style.DANGER, width=1.4, dash="solid"),
        style.across(0.0, f"y{suffix}", f"x{suffix} domain", width=1, dash="solid"),
    ]


def _panel_labels(
    suffix: str, re: Interval, im: Interval, width_px: float, sign: str
) -> list[dict[str, Any]]:
    """Name the half plane and every second damping ray, as far as the names have room beside each other."""
    font = {"size": style.FONT_SIZE, "color": style.MUTED}
    where = {"xref": f"x{suffix}", "yref": f"y{suffix}", "font": font}
    notes = [
        style.text(
            1.0,
            0.0,
            Text("unstable"),
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
    last, unit_px = (math.inf, math.inf), width_px / (re[1] - re[0])
    for ratio in DAMPING[::2]:
        x, y = _ray_end(ratio, re, im)
        if all(abs(a - b) * unit_px < room for a, b, room in zip(last, (x, y), _RAY_PX, strict=True)):
            continue
        last = x, y
        content = f"ζ = {ratio:.1f}" if ratio == DAMPING[-1] else f"{ratio:.1f}"
        # centred, a label at the left edge would hang over it
        side = {"xanchor": "left"} if x <= _INSIDE * re[0] + 1e-9 else {}
        notes.append(style.text(x, y, content, **where, bgcolor=PAPER, borderpad=0, **side))
    if im[1] < 8.0:
        notes.append(style.text(-1.0, 0.0, sign, **where, xanchor="right", yanchor="top", xshift=-3))
    return notes


def _ray_end(ratio: float, re: Interval, im: Interval) -> tuple[float, float]:
    """Where a ray in the upper half leaves the panel, a little inside."""
    cosine, sine = ratio, math.sqrt(1.0 - ratio * ratio)
    length = min(_INSIDE * -re[0] / cosine, 0.94 * im[1] / sine)
    return -cosine * length, sine * length


def _far_zeros(zeros: dict[int, np.ndarray], left: float) -> list[dict[str, Any]]:
    """Notes for real zeros so far out that showing them would press all poles together."""
    beyond = [
        (place, float(zero.real))
        for place, own in zeros.items()
        for zero in own
        if zero.real < left and abs(zero.imag) < 1e-6 * abs(zero)
    ]
    return [
        style.text(
            0.0,
            0.0,
            Text("◂ zero at {value:.4g}", value=value),
            xref="x domain",
            yref="y",
            xanchor="left",
            yanchor="bottom",
            xshift=4,
            yshift=3 + 18 * row,
            font={"size": style.FONT_SIZE, "color": style.method_color(place)},
            name=str(place),
            bgcolor=PAPER,
            borderpad=0,
        )
        for row, (place, value) in enumerate(beyond)
    ]
