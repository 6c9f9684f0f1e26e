"""The whole system: modes of both channels with heading and latitude, and the growth over the latitude."""

from typing import Any

import numpy as np

from navcore.analysis.whole_system import (
    CANCELLED_MODE,
    EARTH_MODE,
    NETWORK_MODE,
    SCHULER_MODE,
    Mode,
    duration,
    growth_over_latitude,
)
from navcore.engine.run import MethodRun, Run
from navcore.foundation.text import Text
from navcore.foundation.units import DEG
from schuler_bench.plots import style
from schuler_bench.plots.effective import earth_mode_text
from schuler_bench.plots.plotly_data import PlotlyFigure, figure, packed

LATITUDES = np.linspace(0.0, 85.0, 18)
"""Of the curve, deg; north and south are alike."""
_DAY = 86400.0
_SYMBOLS = {
    EARTH_MODE: "diamond",
    SCHULER_MODE: "x-thin",
    NETWORK_MODE: "circle-open",
    CANCELLED_MODE: "circle-x-open",
}
_GAP = 0.11


def whole_system_figure(run: Run, aspect: float = 0.46, *, width_px: float = 940.0) -> PlotlyFigure:
    """Modes near the Schuler frequency (left), and the growth of the 24 h mode over the latitude (right).

    Parameters
    ----------
    run : Run
        Result; the modes are those at its site.
    aspect : float
        Height / width of the figure.
    width_px : float
        Expected width on screen.
    """
    names = [*(m.method.name for m in run.methods), *(Text("{kind} mode", kind=kind) for kind in _SYMBOLS)]
    data: list[dict[str, Any]] = []
    rates = []
    for rank, method in enumerate(run.methods):
        kind = method.method.kind
        acting, azimuth = kind.acting(method.network), kind.azimuth(method.method, method.network.omega_s)
        growth = growth_over_latitude(acting, LATITUDES * DEG, run.scenario.earth, azimuth)
        rates.append(_DAY * growth)
        data += _marks(method, rank)
        data += _growth(run, method, rates[-1])
    data += [style.key(Text("{kind} mode", kind=kind), symbol, 2) for kind, symbol in _SYMBOLS.items()]
    finite = np.concatenate([[0.0], *rates])
    finite = finite[np.isfinite(finite)]
    low, high = float(finite.min()), float(finite.max())
    pad = max(0.08 * (high - low), 0.01)
    half = 0.5 * (1.0 - _GAP)
    lat = run.scenario.site.lat_deg
    danger = {"color": style.DANGER, "width": 1.4, "dash": "solid"}
    layout = style.framed(
        names,
        aspect,
        width_px,
        {"l": 58, "r": 16, "t": 32, "b": 56},
        hovermode="closest",
        xaxis=style.axis(Text("Re s / ω<sub>s</sub>"), domain=[0.0, half], range=[-2.2, 0.5], anchor="y"),
        yaxis=style.axis(Text("Im s / ω<sub>s</sub>"), range=[-0.09, 1.75], anchor="x"),
        xaxis2=style.axis(Text("latitude (°)"), domain=[1.0 - half, 1.0], range=[0.0, 90.0], anchor="y2"),
        yaxis2=style.axis(Text("growth, 1/day"), anchor="x2", range=[low - pad, high + pad]),
        shapes=[
            style.upright(0.0, "x", "y domain", **danger),
            style.across(0.0, "y2", "x2 domain", **danger),
        ],
        annotations=[
            style.panel_title(
                (
                    Text("Whole system at {lat:.4g}° N", lat=abs(lat))
                    if lat >= 0.0
                    else Text("Whole system at {lat:.4g}° S", lat=abs(lat))
                ),
                "",
            ),
            style.panel_title(Text("Growth of the 24 h mode"), "2"),
        ],
    )
    return figure(data, layout)


def _marks(method: MethodRun, rank: int) -> list[dict[str, Any]]:
    """Modes of one method in units of omega_s, one trace a kind of mode."""
    name, traces = method.method.name, []
    edge = {"color": style.method_color(method.place), "width": 2.4}
    for kind, symbol in _SYMBOLS.items():
        modes, main = method.whole.named(kind), kind == SCHULER_MODE
        at = np.array([mode.eigenvalue for mode in modes], dtype=np.complex128) / method.network.omega_s
        # The 24 h modes of all methods lie next to each other: the later ones are smaller.
        size = max(15 - 4 * rank, 5) if kind == EARTH_MODE else 11
        traces.append(
            style.marks(
                name if main else Text("{name} {kind}", name=name, kind=kind),
                method.place,
                symbol,
                size,
                edge,
            )
            | {
                "showlegend": main,
                "x": packed(np.real(at)),
                "y": packed(np.imag(at)),
                "text": [_about(mode) for mode in modes],
                "hovertemplate": Text("<b>{name}</b><br>%{{text}}<extra></extra>", name=style.plain(name)),
            }
        )
    return traces


def _about(mode: Mode) -> str:
    lines: list[str] = [Text("{name} mode", name=mode.name)]
    if mode.eigenvalue.imag > 0.0:
        lines.append(
            Text(
                "period {pi}, ζ {damping_ratio:.3f}",
                pi=duration(2.0 * np.pi / mode.eigenvalue.imag),
                damping_ratio=mode.damping_ratio,
            )
        )
    if abs(mode.growth) > 1e-12:
        lines.append(earth_mode_text(mode.growth))
    return Text.joined("<br>", lines)


def _growth(run: Run, method: MethodRun, rates: np.ndarray) -> list[dict[str, Any]]:
    """Curve of the growth over the latitude, and the point of the site."""
    name, here = method.method.name, method.whole.earth_growth
    plain = style.plain(name)
    common = {"xaxis": "x2", "yaxis": "y2", "showlegend": False}
    curve = style.lines(Text("{name} growth", name=name), method.place) | common
    site = style.marks(Text("{name} at the site", name=name), method.place, "diamond", 11, {}) | common
    return [
        curve
        | {
            "x": packed(LATITUDES),
            "y": packed(rates),
            "line": {"color": style.method_color(method.place), "width": 2},
            "hovertemplate": Text(
                "<b>{plain}</b><br>%{{x:.0f}}°: %{{y:+.3f}} a day<extra></extra>", plain=plain
            ),
        },
        site
        | {
            "x": [abs(run.scenario.site.lat_deg)],
            "y": [here * _DAY],
            "text": [Text("24 h mode {earth_mode_text}", earth_mode_text=earth_mode_text(here))],
            "hovertemplate": Text("<b>{plain}</b> at the site<br>%{{text}}<extra></extra>", plain=plain),
        },
    ]
