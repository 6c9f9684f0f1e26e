"""Error curves over time for uPlot: one small plot a quantity, all methods in each, one common time axis."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from html import escape

import numpy as np

from app.figures import style
from app.figures.units import Unit, angle_unit, length_unit, speed_unit, time_unit
from app.figures.uplot import LABEL_SIZE, Y_SIZE, Dash, UplotFigure
from navcore.mechanization.recorder import (
    D_LAT,
    D_LON,
    DV_E,
    DV_N,
    NAMES,
    PHI_E,
    PHI_N,
    PHI_U,
    POSITION,
)
from navcore.run import MethodRun, PlotSeries, Run

_CUT = 3.0
"""A diverged method is drawn up to this many times the largest value of the others."""
_FEWEST_UNITS = 0.02
STRAPDOWN = "full strapdown"
_DASH: Dash = (7, 5)
_FAINT = "66"
"""Opacity of curves that belong to an earlier scenario, as colours carry it."""

_TILT, _HEADING, _SPEED, _LENGTH = "tilt", "heading", "speed", "length"
_CHOOSERS = {_TILT: angle_unit, _HEADING: angle_unit, _SPEED: speed_unit, _LENGTH: length_unit}

# key -> column of the recorder, symbol on the axis, title, family that shares one unit
_QUANTITIES: dict[str, tuple[int, str, str, str]] = {
    "phi_e": (PHI_E, "φE", "Tilt about east φE", _TILT),
    "phi_n": (PHI_N, "φN", "Tilt about north φN", _TILT),
    "phi_u": (PHI_U, "φU", "Heading error φU", _HEADING),
    "dve": (DV_E, "δVE", "Velocity error east δVE", _SPEED),
    "dvn": (DV_N, "δVN", "Velocity error north δVN", _SPEED),
    "dlat": (D_LAT, "δLat", "Latitude error", _LENGTH),
    "dlon": (D_LON, "δLon", "Longitude error", _LENGTH),
    "position": (POSITION, "position", "Position error", _LENGTH),
}

GROUPS: dict[str, tuple[str, ...]] = {
    "Overview": ("phi_e", "phi_n", "dve", "dvn", "position"),
    "Attitude": ("phi_e", "phi_n", "phi_u"),
    "Velocity": ("dve", "dvn"),
    "Position": ("position", "dlat", "dlon"),
}
"""Stacks of plots that belong together: title of a tab -> keys of `error_plots`, top to bottom."""


@dataclass(frozen=True)
class Overlay:
    """The full strapdown's curves beside those of a run.

    Attributes
    ----------
    run : Run
        Of the same methods.
    old : bool
        It belongs to an earlier scenario: drawn faintly.
    """

    run: Run
    old: bool


def error_plots(run: Run, overlay: Overlay | None = None) -> dict[str, UplotFigure]:
    """Error curves of all methods: phi_e, phi_n, phi_u, dve, dvn, dlat, dlon, position.

    Quantities of one family (the tilts, the velocities, the positions) share one unit, so that plots above
    each other compare at a glance; one that is far smaller than its family has a unit of its own.

    Parameters
    ----------
    run : Run
        Result.
    overlay : Overlay, optional
        The same methods as full strapdown, drawn dashed in the same colours.
    """
    longest = _time_axis(run)
    unit_of_time = time_unit(float(longest[-1]) if len(longest) else 0.0)
    time = np.ascontiguousarray(longest / unit_of_time.si)
    over = () if overlay is None else overlay.run.methods
    both = [*run.methods, *over]
    deciding = [m for m in both if m.status != "diverged"] or both
    peaks = {key: _peak(deciding, column) for key, (column, *_) in _QUANTITIES.items()}
    units = _units(peaks)
    names = (*map(_legend_name, run.methods), *(f"{_legend_name(m)}: {STRAPDOWN}" for m in over))
    faint = _FAINT if overlay is not None and overlay.old else ""
    colors = tuple(style.method_color(i) for i in range(len(run.methods)))
    colors += tuple(style.method_color(i) + faint for i in range(len(over)))
    dashes: tuple[Dash, ...] = (*((),) * len(run.methods), *(_DASH,) * len(over))
    cut = len(deciding) < len(both)
    plots: dict[str, UplotFigure] = {}
    for key, (column, symbol, title, _) in _QUANTITIES.items():
        limit = _CUT * peaks[key] if cut else math.inf
        curves = [_curve(m, column, len(longest), units[key], limit) for m in run.methods]
        curves += [_curve_on(longest, m, column, units[key], limit) for m in over]
        plots[key] = UplotFigure(
            key=key,
            quantity=NAMES[column],
            title=title,
            symbol=symbol,
            unit=units[key],
            time_unit=unit_of_time,
            names=names,
            colors=colors,
            data=(time, *curves),
            dashes=dashes,
            floor=0.0 if key == "position" else None,
        )
    return plots


def _time_axis(run: Run) -> np.ndarray:
    """Times (s) of the method that came furthest; the ends are moved, within their bin, to the run's."""
    method = max(run.methods, key=lambda m: len(m.plot.t_s))
    time_s = method.plot.t_s.copy()
    if len(time_s) > 1 and len(method.t_s):
        time_s[0], time_s[-1] = 0.0, max(time_s[-1], float(method.t_s[-1]))
    return time_s


def _peak(methods: list[MethodRun], column: int) -> float:
    return max((m.errors[NAMES[column]]["max_abs"] for m in methods), default=0.0)


def _units(peaks: dict[str, float]) -> dict[str, Unit]:
    """Unit of each quantity: its family's, or its own where that would leave it no digits."""
    of_family: dict[str, float] = {}
    for key, (_, _, _, family) in _QUANTITIES.items():
        of_family[family] = max(of_family.get(family, 0.0), peaks[key])
    units: dict[str, Unit] = {}
    for key, (_, _, _, family) in _QUANTITIES.items():
        choose = _CHOOSERS[family]
        shared = choose(of_family[family])
        units[key] = (
            shared if peaks[key] >= _FEWEST_UNITS * shared.si or peaks[key] == 0.0 else choose(peaks[key])
        )
    return units


def _curve(method: MethodRun, column: int, count: int, unit: Unit, limit: float) -> np.ndarray:
    """One method's curve in ``unit``, NaN once it has ended or, diverging, has left ``limit`` (SI)."""
    values = np.full(count, np.nan)
    found = method.plot.values[:, column]
    np.divide(found, unit.si, out=values[: len(found)])
    if method.status == "diverged" and limit > 0.0:
        beyond = np.flatnonzero(~(np.abs(found) <= limit))
        if len(beyond):
            values[beyond[0] :] = np.nan
    return values


def _curve_on(time_s: np.ndarray, method: MethodRun, column: int, unit: Unit, limit: float) -> np.ndarray:
    """Return the same of a run with other plot bins, on the times of this one: each point the nearest one.

    Of a bin's two extremes the first goes to a first one, so that noise keeps its width on the screen.
    """
    found = method.plot.t_s
    if not len(found) or not len(time_s):
        return np.full(len(time_s), np.nan)
    pairs = 2 if found[0] > 0.0 and len(found) > 2 else 1
    places = np.empty(len(time_s), np.int64)
    for place in range(pairs):
        mine, wanted = found[place::pairs], time_s[place::pairs]
        later = np.clip(np.searchsorted(mine, wanted), 1, max(len(mine) - 1, 1)) if len(mine) > 1 else 0
        nearer = np.where(wanted - mine[later - 1] < mine[later] - wanted, later - 1, later)
        places[place::pairs] = pairs * nearer + place
    plot = PlotSeries(time_s, method.plot.values[places])
    values = _curve(replace(method, plot=plot), column, len(time_s), unit, limit)
    spacing = (found[-1] - found[0]) / max(len(found) - 1, 1)
    values[time_s > found[-1] + pairs * spacing] = np.nan
    return values


def _legend_name(method: MethodRun) -> str:
    name = method.method.name
    return name if method.status == "ok" else f"{name} ({method.status})"


def legend_html(run: Run, overlay: Overlay | None = None) -> str:
    """One legend for a stack of plots: a coloured bar and the name of every method."""
    items = [
        _legend_item(_legend_name(method), f"height:3px;background:{style.method_color(i)}")
        for i, method in enumerate(run.methods)
    ]
    if overlay is not None:
        old = " of an earlier scenario" if overlay.old else ""
        items.append(_legend_item(f"{STRAPDOWN}{old}", f"border-top:3px dashed {style.MUTED}"))
    return (
        f'<div style="display:flex;flex-wrap:wrap;gap:2px 18px;padding:2px 8px 2px {Y_SIZE + LABEL_SIZE}px;'
        f'font-size:{style.FONT_SIZE}px;color:{style.INK}">{"".join(items)}</div>'
    )


def _legend_item(name: str, bar: str) -> str:
    return (
        f'<span style="display:inline-flex;align-items:center;gap:6px;white-space:nowrap">'
        f'<span style="width:18px;border-radius:2px;{bar}"></span>{escape(name)}</span>'
    )
