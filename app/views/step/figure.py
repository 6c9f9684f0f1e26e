"""Step responses of the loop and of the network, by the linear theory of one level channel."""

import math
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from navcore.analysis.settling import LEVEL
from navcore.analysis.transfers import Output, Source
from navcore.engine.run import MethodRun, Run
from navcore.foundation.text import Text
from navcore.foundation.units import DEG_PER_HOUR, MINUTE
from schuler_bench.plots import style
from schuler_bench.plots.effective import network_step, reacts, response, time_grid
from schuler_bench.plots.plotly_data import PlotlyFigure, figure, packed
from schuler_bench.plots.units import Unit, angle_unit, speed_unit
from schuler_bench.views.poles.grid import FORBIDDEN

POINTS = 400
_SPANS_MIN = (5, 10, 20, 30, 45, 60, 90, 120, 180, 240, 360)
_LONGEST_MIN = 360.0
_UNDAMPED_MIN = 180.0
_TICK_PX = 28.0
"""Least distance of two ticks of time."""
_NO_UNIT = Unit("", 1.0)

Curves = list[np.ndarray | None]


class _Disturbance(NamedTuple):
    """Disturbance of the lower panels: source, its size (SI), in words, and their short titles."""

    source: Source
    size: float
    words: str
    short: tuple[str, str]


_LOG = _Disturbance(
    "dv_r", 1.0, Text("a log step of 1 m/s"), (Text("Velocity error, log step"), Text("Tilt, log step"))
)
_GYRO = _Disturbance(
    "eps",
    0.01 * DEG_PER_HOUR,
    Text("a gyro step of 0.01 °/h"),
    (Text("Velocity error, gyro step"), Text("Tilt, gyro step")),
)
_TILT = (
    Text("Tilt after an initial tilt (◆ settled to 2 %)"),
    Text("Tilt (◆ settled to 2 %)"),
    Text("Tilt (◆ settled)"),
)
_NETWORK = Text("Step response of H itself"), Text("Step response of H")
"""Titles, shorter ones for smaller panels."""


class _Panel(NamedTuple):
    """Axes' suffix, time shown (s), curves (SI), unit, titles, and name of the y axis."""

    suffix: str
    span_s: float
    curves: Curves
    unit: Unit
    titles: tuple[str, ...]
    y_title: str


def step(
    run: Run, aspect: float = 0.46, *, width_px: float = 940.0, limits: Mapping[str, float] | None = None
) -> PlotlyFigure:
    """Responses of every method: tilt to an initial tilt, H itself, velocity error and tilt to a log step.

    Where no method uses the log, the lower plots show the response to a gyro step instead.

    Parameters
    ----------
    run : Run
        Result; only its networks are used.
    aspect : float
        Height / width of the figure.
    width_px : float
        Expected width on screen, for room for the legend.
    limits : mapping of str to float, optional
        `schuler_bench.session.requirements.Requirements.limits`: what they rule out is shaded.
    """
    loop_s, network_s = _loop_span(run), _network_span(run)
    cause = _LOG if any(reacts(m, "dv_r") for m in run.methods) else _GYRO

    def responses(source: Source, output: Output, size: float) -> Curves:
        curves = [response(method, source, output, loop_s, POINTS) for method in run.methods]
        return [None if curve is None else size * curve for curve in curves]

    stable = [method.loop.stable for method in run.methods]
    tilt = responses("initial_tilt", "phi", 1.0)
    velocity, caused_tilt = (responses(cause.source, output, cause.size) for output in ("dv", "phi"))
    speed, angle = speed_unit(_peak(velocity, stable)), angle_unit(_peak(caused_tilt, stable))
    network: Curves = [network_step(method, network_s, POINTS) for method in run.methods]
    of_velocity = Text("Velocity error after {words}", words=cause.words), cause.short[0]
    of_tilt = Text("Tilt after {words}", words=cause.words), cause.short[1]
    panels = (
        _Panel("", loop_s, tilt, _NO_UNIT, _TILT, "φ/φ<sub>0</sub>"),
        _Panel("2", network_s, network, _NO_UNIT, _NETWORK, Text("output / step")),
        _Panel("3", loop_s, velocity, speed, of_velocity, f"δV ({speed.name})"),
        _Panel("4", loop_s, caused_tilt, angle, of_tilt, f"φ ({angle.name})"),
    )
    data = [_trace(method, i, panel) for panel in panels for i, method in enumerate(run.methods)]
    data += [_settled_mark(method, own, loop_s) for method, own in zip(run.methods, tilt, strict=True)]
    layout = _layout(run, panels, stable, aspect, width_px)
    layout["shapes"] += _forbidden(limits or {}, loop_s, angle, cause)
    return figure(data, layout)


def _loop_span(run: Run) -> float:
    """Time shown, s: until the slowest method has settled, within reason."""
    need = 0.0
    for method in run.methods:
        settles = method.loop.settling_s
        minutes = _UNDAMPED_MIN if settles is None else 1.25 * settles / MINUTE
        need = max(need, min(minutes, _LONGEST_MIN))
    return _round_up(need) * MINUTE


def _network_span(run: Run) -> float:
    """Time shown for H alone, s: six time constants of its slowest pole."""
    slowest = math.inf
    for method in run.methods:
        rates = -np.real(method.network.poles)
        slowest = min([slowest, *(float(rate) for rate in rates if rate > 0.0)])
    return _round_up(6.0 / slowest / MINUTE if math.isfinite(slowest) else 30.0) * MINUTE


def _round_up(minutes: float) -> float:
    return float(next((span for span in _SPANS_MIN if minutes <= span), _SPANS_MIN[-1]))


@lru_cache(maxsize=16)
def _minutes(span_s: float) -> dict[str, str]:
    return packed(time_grid(span_s, POINTS) / MINUTE)


def _deciding(curves: Curves, stable: list[bool]) -> list[np.ndarray]:
    """Curves that decide units and ranges: an unstable one leaves the plot, not to flatten the rest."""
    present = [(c, ok) for c, ok in zip(curves, stable, strict=True) if c is not None]
    return [c for c, ok in present if ok] or [c for c, _ in present]


def _peak(curves: Curves, stable: list[bool]) -> float:
    return max((float(np.max(np.abs(c))) for c in _deciding(curves, stable)), default=0.0)


def _range(curves: list[np.ndarray], unit: Unit) -> list[float]:
    if not curves:
        return [-1.0, 1.0]
    low = min(0.0, *(float(np.min(c)) / unit.si for c in curves))
    high = max(0.0, *(float(np.max(c)) / unit.si for c in curves))
    pad = 0.06 * (high - low) or 1.0
    return [low - pad, high + pad]


def _trace(method: MethodRun, index: int, panel: _Panel) -> dict[str, Any]:
    values = panel.curves[index]
    return style.lines(method.method.name, method.place) | {
        "x": [] if values is None else _minutes(panel.span_s),
        "y": [] if values is None else packed(values / panel.unit.si),
        "xaxis": f"x{panel.suffix}",
        "yaxis": f"y{panel.suffix}",
        "showlegend": panel.suffix == "",
        "hovertemplate": f"%{{y:.4g}} {panel.unit.name}".rstrip(),
    }


def _settled_mark(method: MethodRun, tilt: np.ndarray | None, span_s: float) -> dict[str, Any]:
    """Diamond where the response to an initial tilt has come to rest; no point where it does not here."""
    settles = None if method.method.undamped else method.loop.settling_s
    x, y = [], []
    if settles is not None and tilt is not None and settles <= span_s:
        x, y = [settles / MINUTE], [float(np.interp(settles, time_grid(span_s, POINTS), tilt))]
    edge = {"width": 1.5, "color": "white"}
    mark = style.marks(Text("{name} settled", name=method.method.name), method.place, "diamond", 11, edge)
    hover = Text("settled to 2 % at %{{x:.4g}} min<extra></extra>")
    return mark | {"x": x, "y": y, "xaxis": "x", "yaxis": "y", "hovertemplate": hover}


def _layout(
    run: Run, panels: Sequence[_Panel], stable: list[bool], aspect: float, width_px: float
) -> dict[str, Any]:
    names = [method.method.name for method in run.methods]
    margin = {"l": 68, "r": 18, "t": 30, "b": 46}
    layout = style.framed(names, aspect, width_px, margin, hovermode="x unified", annotations=[])
    # room between the rows for tick labels, axis title and the title of the lower plot
    gap = 72.0 / max(aspect * width_px - 30 - layout["margin"]["b"], 150.0)
    share = style.column(width_px - 86)
    domains = [(x, y) for y in ([0.5 + 0.5 * gap, 1.0], [0.0, 0.5 - 0.5 * gap])
               for x in ([0.0, share], [1.0 - share, 1.0])]  # fmt: skip
    for panel, (column, row) in zip(panels, domains, strict=True):
        suffix, span_min = panel.suffix, panel.span_s / MINUTE
        layout[f"xaxis{suffix}"] = style.axis(
            Text("time (min)"),
            domain=column,
            anchor=f"y{suffix}",
            range=[0.0, span_min],
            tickangle=0,
            dtick=_tick(span_min, share * (width_px - 86)),
            unifiedhovertitle={"text": Text("%{{x:.1f}} min")},
        )
        layout[f"yaxis{suffix}"] = style.axis(
            panel.y_title,
            domain=row,
            anchor=f"x{suffix}",
            range=_range(_deciding(panel.curves, stable), panel.unit),
            nticks=6,
            zeroline=True,
            zerolinecolor=style.REFERENCE,
            zerolinewidth=1,
        )
        title = style.fitting(panel.titles, share * (width_px - 86))
        layout["annotations"].append(style.panel_title(title, suffix))
    settled = {"type": "rect", "y0": -LEVEL, "y1": LEVEL}  # in which a response counts as settled
    look = {"line": {"width": 0}, "fillcolor": "rgba(154,169,184,0.3)"}
    return layout | {"shapes": [style.across(0.0) | settled | look]}


def _tick(span_min: float, room_px: float) -> float:
    most = max(min(6.5, room_px / _TICK_PX), 1.5)
    return next(s for s in (1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 60.0, 120.0, 240.0) if span_min <= most * s)


def _forbidden(
    limits: Mapping[str, float], span_s: float, unit: Unit, cause: _Disturbance
) -> list[dict[str, Any]]:
    """Shade what the requirements rule out: beyond any height that a plot shows."""
    far, span_min = 1e6, span_s / MINUTE
    boxes: list[tuple[str, str, float, float, float]] = []
    if "tilt_overshoot" in limits:
        boxes.append(("overshoot", "", 0.0, -far, -limits["tilt_overshoot"]))
    if limits.get("settling_s", span_s) < span_s:
        at = limits["settling_s"] / MINUTE
        boxes += [("settling", "", at, LEVEL, far), ("settling", "", at, -far, -LEVEL)]
    if "log_tilt" in limits and cause is _LOG:
        size = limits["log_tilt"] / unit.si
        boxes += [(Text("log tilt"), "4", 0.0, size, far), (Text("log tilt"), "4", 0.0, -far, -size)]
    return [
        {
            "type": "rect",
            "name": name,
            "xref": f"x{suffix}",
            "yref": f"y{suffix}",
            "x0": start,
            "x1": span_min,
            "y0": low,
            "y1": high,
            "layer": "below",
            "fillcolor": FORBIDDEN,
            "line": {"color": style.DANGER, "width": 1.2, "dash": "dash"},
        }
        for name, suffix, start, low, high in boxes
    ]
