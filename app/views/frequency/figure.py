"""Bode plots: the networks H and Y on the left, a transfer of the closed loop right, of all methods."""

import math
from functools import partial
from typing import Any

import numpy as np

from navcore.engine.run import MethodRun, Run
from navcore.foundation.earth import EARTH_RATE
from navcore.foundation.text import Text
from navcore.foundation.units import DEG
from schuler_bench.plots import style
from schuler_bench.plots.effective import (
    OMEGA_MAX,
    OMEGA_MIN,
    OPEN_LOOP,
    VIEWS,
    FrequencyCurve,
    TransferView,
    azimuth_curve,
    curve_of_loop,
    loop_key,
    loop_of,
    network_curve,
    transfer_curve,
)
from schuler_bench.plots.plotly_data import PlotlyFigure, figure, packed
from schuler_bench.plots.units import duration
from schuler_bench.views.frequency.curves import (
    Reference,
    decibel,
    law_step_s,
    level_axis,
    log_axis,
    measured_gain,
    pair,
    phase,
    phase_axis,
)
from schuler_bench.views.frequency.nyquist import nyquist

HANDLE_PANEL = ("xaxis2", "yaxis3")
"""Axes of the magnitude of the closed loop's transfer, where the handle of its pair stands."""
_BOLD_PX = 7.8
"""Mean width of a letter in a title."""
_LONGEST_SILENCE = 22
_LEAST_COLUMN_PX, _SMALL_COLUMN_PX, _SMALLEST_COLUMN_PX = 240.0, 200.0, 160.0
_OMEGA_TITLES = (Text("frequency ω (rad/s) and period"), "ω (rad/s)")
_LETTER_PX, _BESIDE_PX = 6.0, 32.0
"""Mean width of a letter of an axis title, and how much wider than its column it may be."""
_REFERENCE = style.lines("", 0) | {
    "legendgroup": "reference",
    "line": {"color": style.INK, "width": style.LINE_WIDTH, "dash": "dash", "simplify": False},
}
_H = (Text("Damping network H(jω)"), "H(jω)")
_HY = (Text("Networks H(jω) and, dotted, Y(jω) of the azimuth"), Text("H(jω) and, dotted, Y(jω)"), "H, Y")
"""Titles of the left column, longest first."""
_MUTED_FONT = {"size": style.FONT_SIZE, "color": style.MUTED}


def natural_frequencies(run: Run) -> dict[str, float]:
    """Schuler, Foucault and Earth frequencies at the site, rad/s; Foucault only where the axis reaches it."""
    frequencies = {"24 h": EARTH_RATE, Text("Schuler"): run.scenario.omega_s}
    foucault = EARTH_RATE * abs(math.sin(run.scenario.site.lat_deg * DEG))
    if foucault > OMEGA_MIN:
        frequencies["Foucault"] = foucault
    return frequencies


def frequency_view(
    run: Run,
    shown: str,
    aspect: float = 0.46,
    *,
    width_px: float = 940.0,
    discrete: bool = False,
    reference: Reference | None = None,
) -> PlotlyFigure:
    """Draw `bode` with a transfer, or `nyquist`, as the chooser of the frequency side asks.

    Parameters
    ----------
    run : Run
        Result.
    shown : str
        Key of `schuler_bench.plots.effective.SHOWN`.
    aspect, width_px, discrete, reference
        See `bode`.
    """
    if shown == OPEN_LOOP:
        return nyquist(run, aspect, width_px=width_px)
    return bode(run, shown, aspect, width_px=width_px, discrete=discrete, reference=reference)


def bode(
    run: Run,
    transfer_id: str = "phi/dv_r",
    aspect: float = 0.46,
    *,
    width_px: float = 940.0,
    discrete: bool = False,
    reference: Reference | None = None,
) -> PlotlyFigure:
    """Bode plots of H and of one transfer for all methods.

    Parameters
    ----------
    run : Run
        Result; only its networks are used.
    transfer_id : str
        Key of `schuler_bench.plots.effective.TRANSFERS`.
    discrete : bool
        Measure the filters that run, and draw what they do as dots on H.
    aspect : float
        Height / width of the figure.
    width_px : float
        Expected width on screen, for room for the legend.
    reference : Reference, optional
        A network that is drawn dashed beside those of the methods, as if it damped with the log.
    """
    view = VIEWS[transfer_id]
    transfer_hover = "%{y:.2f} dB" if _in_decibel(view) else "%{y:.4g} " + view.unit
    data: list[dict[str, Any]] = []
    drawn: dict[str, list[np.ndarray]] = {"y": [], "y2": [], "y3": [], "y4": []}
    lines: list[tuple[dict[str, Any], FrequencyCurve | None, FrequencyCurve | None]] = [
        (
            style.lines(method.method.name, method.place),
            network_curve(loop_of(method)),
            transfer_curve(method, view.source, view.output),
        )
        for method in run.methods
    ]
    names = [method.method.name for method in run.methods]
    silent = [name for name, (_, _, value) in zip(names, lines, strict=True) if value is None]
    if reference is not None:
        lines.append((_REFERENCE | {"name": reference.label}, *_of_reference(reference, view)))
        names.append(reference.label)
    for line, h, value in lines:
        columns = (
            ("x", ("y", "y2"), "%{y:.2f} dB", h, decibel),
            ("x2", ("y3", "y4"), transfer_hover, value, partial(_magnitude, view=view)),
        )
        for xaxis, yaxes, hover, curve, size in columns:
            curves = None if curve is None else (size(curve.value), phase(curve.value))
            data += pair(line, None if curve is None else curve.omega, curves, xaxis, yaxes, hover)
            if curve is not None and curves is not None:  # an undamped resonance leaves its axis
                drawn[yaxes[0]].append(curves[0][curve.finite])
                drawn[yaxes[1]].append(curves[1])
    slow = [azimuth_curve(method) for method in run.methods]
    for method, y in zip(run.methods, slow, strict=True):
        if y is not None:
            line = style.lines(method.method.name, method.place)
            line |= {"line": line["line"] | {"dash": "dot"}}
            curves = decibel(y.value), phase(y.value)
            traces = pair(line, y.omega, curves, "x", ("y", "y2"), Text("%{{y:.2f}} dB, Y"))
            data += [trace | {"showlegend": False} for trace in traces]
            for axis, curve in zip(("y", "y2"), (curves[0][y.finite], curves[1]), strict=True):
                drawn[axis].append(curve)
    if discrete:
        data += [dots for method in run.methods for dots in _discrete_dots(run, method)]
    title = _HY if any(y is not None for y in slow) else _H
    return figure(data, _layout(run, view, drawn, silent, names, aspect, width_px, title))


def _of_reference(
    reference: Reference, view: TransferView
) -> tuple[FrequencyCurve | None, FrequencyCurve | None]:
    """H and the transfer under external damping; none of them where there is no network."""
    if reference.network is None:
        return None, None
    loop = loop_key(reference.network)
    enters = view.source != "acceleration"
    form = reference.network.realisation
    return network_curve(loop), curve_of_loop(loop, form, view.source, view.output) if enters else None


def _magnitude(value: np.ndarray, view: TransferView) -> np.ndarray:
    return decibel(value * view.scale) if _in_decibel(view) else np.abs(value) * view.scale


def _discrete_dots(run: Run, method: MethodRun) -> list[dict[str, Any]]:
    """Gain and phase of the running filter; the phase is that turn of it which lies next to the curve."""
    measured = measured_gain(method, law_step_s(run))
    if measured is None:
        return []
    omega, gain = measured
    h = network_curve(loop_of(method))
    beside = np.interp(np.log(omega), np.log(h.omega), phase(h.value))
    angle = beside + np.rad2deg(np.angle(gain * np.exp(-1j * np.deg2rad(beside))))
    ring = {"color": style.method_color(method.place), "width": 2}
    dots = style.marks(Text("{name} measured", name=method.method.name), method.place, "circle", 8, ring)
    dots |= {"x": packed(omega), "xaxis": "x", "marker": dots["marker"] | {"color": "white"}}
    return [
        dots | {"y": packed(decibel(gain)), "yaxis": "y", "hovertemplate": Text("%{{y:.3f}} dB measured")},
        dots | {"y": packed(angle), "yaxis": "y2", "hovertemplate": "%{y:.2f}° measured"},
    ]


def _in_decibel(view: TransferView) -> bool:
    return view.unit.startswith("dB")


def _layout(
    run: Run,
    view: TransferView,
    drawn: dict[str, list[np.ndarray]],
    silent: list[str],
    names: list[str],
    aspect: float,
    width_px: float,
    title: tuple[str, ...],
) -> dict[str, Any]:
    share = style.column(width_px - 84.0)
    column_px = share * (width_px - 84.0)
    annotations = [
        style.heading(Text("<b>{title}</b>", title=style.fitting(title, column_px)), 48, "x domain"),
        style.heading(_transfer_title(view, silent, column_px), 48, "x2 domain"),
        *(note for axis in ("x", "x2") for note in _marker_labels(run, axis, column_px)),
    ]
    if len(silent) == len(run.methods):
        annotations.append(
            style.text(
                0.5, 0.5, Text("no method reacts"), xref="x2 domain", yref="y3 domain", font=_MUTED_FONT
            )
        )
    upper, lower = {"domain": [0.53, 1.0]}, {"domain": [0.0, 0.47]}
    size_axis = level_axis if _in_decibel(view) else log_axis
    return style.framed(
        names,
        aspect,
        width_px,
        {"l": 68, "r": 16, "t": 62, "b": 66},
        hovermode="x unified",
        xaxis=_omega_axis("y2", [0.0, share], column_px),
        xaxis2=_omega_axis("y4", [1.0 - share, 1.0], column_px),
        yaxis=level_axis("|H|  (dB)", drawn["y"]) | upper | {"anchor": "x"},
        yaxis2=phase_axis(drawn["y2"]) | lower | {"anchor": "x"},
        yaxis3=size_axis(view.unit, drawn["y3"]) | upper | {"anchor": "x2"},
        yaxis4=phase_axis(drawn["y4"]) | lower | {"anchor": "x2"},
        annotations=annotations,
        shapes=[
            style.upright(omega, axis) for axis in ("x", "x2") for omega in natural_frequencies(run).values()
        ],
    )


def _omega_axis(anchor: str, domain: list[float], column_px: float) -> dict[str, Any]:
    steps = {_LEAST_COLUMN_PX: range(-5, 0), _SMALLEST_COLUMN_PX: (-5, -3, -1), 0.0: (-4, -2)}
    decades = next(decades for least_px, decades in steps.items() if column_px >= least_px)
    return style.axis(
        style.fitting(_OMEGA_TITLES, column_px + _BESIDE_PX, _LETTER_PX),
        type="log",
        domain=domain,
        anchor=anchor,
        mirror="all",
        ticks="",
        range=[math.log10(OMEGA_MIN), math.log10(OMEGA_MAX)],
        tickvals=[10.0**k for k in decades],
        ticktext=[
            Text("10<sup>{k}</sup><br>{duration}", k=k, duration=duration(2.0 * math.pi / 10.0**k))
            for k in decades
        ],
        minor={"showgrid": True, "dtick": "D1", "gridcolor": style.GRID_FINE},
        unifiedhovertitle={"text": Text("ω = %{{x:.3e}} rad/s")},
    )


def _marker_labels(run: Run, axis: str, column_px: float) -> list[dict[str, Any]]:
    """Labels above the plots; Foucault always lies left of 24 h, so it is written to the left."""
    notes = []
    for name, omega in natural_frequencies(run).items():
        if name == "24 h" and column_px < _SMALL_COLUMN_PX:
            continue  # no room between the two others
        anchor, shift = {
            "24 h": ("left", 1),
            Text("Foucault"): ("right", -1),
            Text("Schuler"): ("center", 0),
        }[name]
        notes.append(
            style.text(
                math.log10(omega),
                1.0,
                name
                if name == "24 h"
                else Text("{name}<br>{duration}", name=name, duration=duration(2.0 * math.pi / omega)),
                xref=axis,
                yref="paper",
                xanchor=anchor,
                yanchor="bottom",
                xshift=shift,
                align=anchor,
                font=_MUTED_FONT,
            )
        )
    return notes


def _transfer_title(view: TransferView, silent: list[str], column_px: float) -> str:
    """Title of the right column, as much as there is room for; it also says which methods have no curve."""
    room = column_px / _BOLD_PX
    full = Text("{symbol}: {title}", symbol=view.symbol, title=view.title)
    letters = len(view.symbol.replace("<sub>", "").replace("</sub>", "")) + 2 + len(view.title)
    title = (
        Text("<b>{full}</b>", full=full) if letters <= room else Text("<b>{symbol}</b>", symbol=view.symbol)
    )
    if not silent:
        return title
    who = Text.joined(", ", silent)
    who = style.plain(who) if len(who) <= _LONGEST_SILENCE else Text("{silent} methods", silent=len(silent))
    note = (
        Text("(no log in: {who})", who=who)
        if view.source == "dv_r"
        else Text("(no own acceleration in: {who})", who=who)
    )
    fits = letters + len(note) <= room
    return (
        Text('{title} <span style="color:{muted}">{note}</span>', title=title, muted=style.MUTED, note=note)
        if fits
        else title
    )
