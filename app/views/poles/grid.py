"""Background of the pole map: rays, settling lines, regions without poles, and the root locus."""

import math
from collections.abc import Mapping
from functools import lru_cache
from typing import Any

import numpy as np

from navcore.analysis.locus import Locus, root_locus
from navcore.analysis.settling import LEVEL
from navcore.design.vary import network_not_in_force
from navcore.engine.run import Run
from navcore.foundation.notation import symbol, unit_sign
from navcore.foundation.parameters import extra_of
from navcore.foundation.text import Text
from navcore.foundation.units import MINUTE
from navcore.scenario.method import Method
from schuler_bench.editing import form
from schuler_bench.editing.placing import Block
from schuler_bench.plots import style
from schuler_bench.plots.plotly_data import packed
from schuler_bench.plots.units import number

NO_LOCUS = ""
_COUNT = 161


def locus_fields(method: Method, block: Block = "network") -> dict[str, str]:
    """Parameters of a method's network over which a locus can be drawn: field -> label with its unit.

    They have a slider, and the method's policy does not set them.
    """
    return {
        name: form.full_label(name, info)
        for name, info in type(getattr(method, block)).model_fields.items()
        if "slider" in (extra := extra_of(info)) and "elements" not in extra
        if not network_not_in_force(method, f"{block}.{name}")
    }


def locus_of(run: Run, index: int, field: str) -> Locus | None:
    """Locus of a method's loop over the range of a parameter's slider; None where there is none."""
    if not field or not 0 <= index < len(run.methods):
        return None
    method = run.methods[index]
    if field not in locus_fields(method.method):
        return None
    locus = _computed(_giving(run, index, field), field, method.network.omega_s)
    return locus if len(locus.values) > 1 else None


def _giving(run: Run, index: int, field: str) -> Any:
    """The network given by that parameter, at the low end of its slider: one for all its values.

    Sigma and xi become the gains when one of them is to move.
    """
    from schuler_bench.editing.edits import network_values, with_value

    parameters = run.scenario.method[index].network
    value = network_values(run.scenario, index).get(field)
    if getattr(parameters, field) is None and value is not None:
        parameters = (
            with_value(run.scenario, ("method", index, "network", field), value).method[index].network
        )
    low, _ = extra_of(type(parameters).model_fields[field])["slider"]
    return parameters.model_copy(update={field: low})


@lru_cache(maxsize=32)
def _computed(parameters: Any, field: str, omega_s: float) -> Locus:
    extra = extra_of(type(parameters).model_fields[field])
    spaced = np.geomspace if extra.get("log") else np.linspace
    low, high = extra["slider"]
    return root_locus(parameters, field, spaced(low, high, _COUNT), omega_s)


def locus_traces(run: Run, index: int, field: str, suffix: str) -> list[dict[str, Any]]:
    """Branches of the locus in one panel of the pole map, with marks at both ends; empty without one."""
    locus = locus_of(run, index, field)
    if locus is None:
        return []
    method = run.methods[index]
    scaled = locus.poles / method.network.omega_s
    place, name, count = method.place, method.method.name, scaled.shape[1]
    label = locus_fields(method.method)[field]
    line = np.concatenate([scaled, np.full((1, count), complex(math.nan, math.nan))]).T.ravel()
    ends = np.concatenate([scaled[0], scaled[-1]])
    common: dict[str, Any] = {
        "xaxis": f"x{suffix}",
        "yaxis": f"y{suffix}",
        "showlegend": False,
        "hovertemplate": Text(
            "<b>{name}</b><br>{label} = %{{customdata:.4g}}<extra></extra>",
            name=style.plain(name),
            label=label,
        ),
    }
    branches = style.lines(Text("{name} locus", name=name), place) | common
    branches |= {
        "x": packed(np.real(line)),
        "y": packed(np.imag(line)),
        "customdata": packed(np.tile(np.append(locus.values, math.nan), count)),
        "line": {"color": style.method_color(place), "width": 1.6, "dash": "dot"},
    }
    edge = {"width": 1.5, "color": style.method_color(place)}
    marks = style.marks(Text("{name} locus ends", name=name), place, "", 7, edge) | common
    marks |= {
        "x": packed(np.real(ends)),
        "y": packed(np.imag(ends)),
        "customdata": packed(np.repeat(locus.values[[0, -1]], count)),
        "marker": marks["marker"] | {"symbol": ["circle-open"] * count + ["square-open"] * count},
    }
    return [branches, marks]


def locus_note(run: Run, index: int, field: str) -> str:
    """Say what moves along the branches, from which end to which, and where it is; empty without a locus."""
    from schuler_bench.editing.edits import network_values

    locus = locus_of(run, index, field)
    if locus is None:
        return ""
    extra = extra_of(type(run.methods[index].method.network).model_fields[field])
    first, last = (number(float(value), 3) for value in locus.values[[0, -1]])
    now = network_values(run.scenario, index).get(field)
    present = "" if now is None else f", ✕ {number(float(now), 3)}"
    unit = f" {unit_sign(extra['unit'])}" if extra.get("unit") else ""
    return Text(
        "over {symbol}: ○ {first} … □ {last}{present}{unit}",
        symbol=symbol(field),
        first=first,
        last=last,
        present=present,
        unit=unit,
    )


DAMPING = tuple(k / 10.0 for k in range(1, 10))
"""Damping ratios of the rays."""
PAPER = "rgba(255,255,255,0.85)"
"""Behind words that stand over lines."""
_TO_SETTLE = math.log(50.0)
"""Time constants after which 2 % are left."""
_SETTLING_MIN = (
    10080.0, 2880.0, 1440.0, 720.0, 480.0, 360.0, 240.0, 180.0, 120.0, 90.0, 60.0,
    45.0, 30.0, 20.0, 15.0, 10.0, 5.0, 3.0, 2.0, 1.0, 0.5,
)  # fmt: skip
_LABEL_PX = 62.0
"""Least distance of two settling lines: room for a label."""
_BEYOND = 1e3
"""Extent of the shaded region in sizes of the panel."""
FORBIDDEN = "rgba(180,35,24,0.09)"
"""Shade of what the requirements rule out."""

Interval = tuple[float, float]


def damping_lines(suffix: str, re: Interval, im: Interval) -> dict[str, Any]:
    """Rays of equal damping ratio and arcs of equal natural frequency in one panel, as one trace."""
    x, y = _ray_points(re, im)
    return {
        "type": "scatter",
        "mode": "lines",
        "x": packed(x),
        "y": packed(y),
        "xaxis": f"x{suffix}",
        "yaxis": f"y{suffix}",
        "line": {"color": "#CBD5E0", "width": 1},
        "hoverinfo": "skip",
        "showlegend": False,
    }


@lru_cache(maxsize=32)
def _ray_points(re: Interval, im: Interval) -> tuple[np.ndarray, np.ndarray]:
    """Rays of equal damping ratio and arcs of equal natural frequency, parted by NaN."""
    gap = [math.nan]
    xs: list[np.ndarray | list[float]] = []
    ys: list[np.ndarray | list[float]] = []
    far = 3.0 * math.hypot(re[0], im[1])
    for ratio in DAMPING:
        x, y = -ratio * far, math.sqrt(1.0 - ratio * ratio) * far
        xs += [[x, 0.0, x], gap]
        ys += [[y, 0.0, -y], gap]
    angle = np.linspace(0.5 * math.pi, 1.5 * math.pi, 91)
    for radius in _circles(im[1]):
        xs += [radius * np.cos(angle), gap]
        ys += [radius * np.sin(angle), gap]
    return np.concatenate(xs), np.concatenate(ys)


def _circles(half_height: float) -> list[float]:
    """Radii of the frequency arcs: omega_s itself, and a few even ones over the panel."""
    steps = (m * 10.0**k for k in range(-2, 8) for m in (1.0, 2.0, 5.0))
    step = next(s for s in steps if 4.0 * s >= 1.5 * half_height)
    return sorted({1.0, *(step * k for k in range(1, 9))})


def settling_lines(left: float, omega_s: float, width_px: float, span: float) -> dict[float, float]:
    """Lines of equal settling time that fit a panel: minutes -> Re s / omega_s.

    Parameters
    ----------
    left : float
        Left edge of the panel, units of omega_s.
    omega_s : float
        Schuler frequency, rad/s.
    width_px, span : float
        Width of the panel on screen and in units of omega_s.
    """
    lines: dict[float, float] = {}
    last, apart = 0.0, _LABEL_PX / width_px * span
    for minutes in _SETTLING_MIN:
        at = -_TO_SETTLE / (minutes * MINUTE * omega_s)
        if at > left + apart and last - at >= apart:
            lines[minutes] = last = at
    return lines


def settling_shapes(suffix: str, re: Interval, omega_s: float, width_px: float) -> list[dict[str, Any]]:
    """Draw the lines of `settling_lines` upright through one panel."""
    return [
        style.upright(at, f"x{suffix}", f"y{suffix} domain", color="#CBD5E0", width=1, dash="dash")
        for at in settling_lines(re[0], omega_s, width_px, re[1] - re[0]).values()
    ]


def settling_labels(suffix: str, re: Interval, omega_s: float, width_px: float) -> list[dict[str, Any]]:
    """Write the settling time at the foot of each line."""
    lines = settling_lines(re[0], omega_s, width_px, re[1] - re[0])
    return [
        style.text(
            at,
            0.0,
            Text("{minutes:g} min", minutes=minutes) if minutes < 120.0 else f"{minutes / 60.0:g} h",
            xref=f"x{suffix}",
            yref=f"y{suffix} domain",
            xanchor="right",
            yanchor="bottom",
            xshift=-1,
            yshift=3,
            font={"size": style.FONT_SIZE, "color": style.MUTED},
            bgcolor=PAPER,
            borderpad=0,
        )
        for minutes, at in lines.items()
    ]


def forbidden(
    suffix: str, re: Interval, im: Interval, limits: Mapping[str, float], omega_s: float
) -> list[dict[str, Any]]:
    """Shade where the requirements do not let poles lie: too little damped, or too slow."""
    axes: dict[str, Any] = {"xref": f"x{suffix}", "yref": f"y{suffix}", "layer": "below"}
    fill = axes | {"type": "path", "fillcolor": FORBIDDEN, "line": {"width": 0}}
    edge = axes | {"type": "line", "line": {"color": style.DANGER, "width": 1.2, "dash": "dash"}}
    # Far beyond whatever a zoom can show: only the limit itself is an edge.
    far = _BEYOND * math.hypot(re[0], im[1])
    shapes: list[dict[str, Any]] = []
    if "damping_ratio" in limits:
        ratio = limits["damping_ratio"]
        x, y = -ratio * far, math.sqrt(1.0 - ratio**2) * far
        path = f"M {x} {y} L 0 0 L {x} {-y} L {far} {-y} L {far} {y} Z"
        shapes.append(fill | {"name": "damping", "path": path})
        shapes += [edge | {"x0": 0.0, "y0": 0.0, "x1": x, "y1": side} for side in (y, -y)]
    if limits.get("settling_s"):
        at = math.log(LEVEL) / limits["settling_s"] / omega_s
        path = f"M {at} {-far} L {at} {far} L {far} {far} L {far} {-far} Z"
        shapes.append(fill | {"name": "settling", "path": path})
        shapes.append(edge | {"x0": at, "y0": -far, "x1": at, "y1": far})
    return shapes
