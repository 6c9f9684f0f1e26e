"""Error curves over time for uPlot: one small plot a quantity, all methods in each, one common time axis."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.plots import style
from app.plots.envelope import Envelope
from app.plots.legend import State, counts
from app.plots.pinned import PIN_WIDTH, Pinned, pinned_methods
from app.plots.units import (
    AUTO,
    Unit,
    angle_unit,
    length_unit,
    scaled_unit,
    speed_unit,
    time_unit,
    wanted_unit,
)
from app.plots.uplot import Dash, UplotFigure
from app.session.display import Display
from navcore.engine.run import MethodRun, PlotSeries, Run
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

_CUT = 3.0
"""A diverged method is drawn up to this many times the largest value of the others."""
_FEWEST_UNITS = 0.02
STRAPDOWN = "full strapdown"
_DASH: Dash = (7, 5)
_FAINT = "66"
"""Opacity of curves that belong to an earlier scenario, as colours carry it."""

_TILT, _HEADING, _SPEED, _LENGTH = "tilt", "heading", "speed", "length"
_CHOOSERS = {_TILT: angle_unit, _HEADING: angle_unit, _SPEED: speed_unit, _LENGTH: length_unit}
_LIMIT_DASH: Dash = (12, 5)
_FEWEST_DECADES, _MOST_DECADES = 3, 8
_BAND = "2E"
"""Opacity of an envelope, as colours carry it."""

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

QUANTITIES = {key: title for key, (_, _, title, _) in _QUANTITIES.items()}
"""Titles of the plots of `error_plots` by key."""

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


@dataclass(frozen=True)
class _Line:
    """One method's curves in all plots.

    Attributes
    ----------
    own : bool
        It is one of the run's own methods, whose times all curves share.
    state : State
        How it is shown.
    """

    method: MethodRun
    name: str
    color: str
    dash: Dash
    width: float
    own: bool
    state: State


def error_plots(
    run: Run,
    overlay: Overlay | None = None,
    *,
    display: Display | None = None,
    pins: Sequence[Pinned] = (),
    envelope: Envelope | None = None,
    limits: Mapping[str, float] | None = None,
) -> dict[str, UplotFigure]:
    """Error curves of all methods: phi_e, phi_n, phi_u, dve, dvn, dlat, dlon, position.

    Quantities of one family (the tilts, the velocities, the positions) share one unit, so that plots above
    each other compare at a glance; one that is far smaller than its family has a unit of its own.

    Parameters
    ----------
    run : Run
        Result.
    overlay : Overlay, optional
        The same methods as full strapdown, drawn dashed in the same colours.
    display : Display, optional
        Units, and whether the axis is logarithmic: then the magnitudes of the errors are drawn.
    pins : sequence of Pinned
        Runs to lay over: thinner, each in its colour, a dash for each method.
    envelope : Envelope, optional
        Filled bands behind the run's own curves.
    limits : mapping, optional
        Key -> largest allowed magnitude (SI), drawn as dashed lines.
    """
    shown = display or Display()
    longest = _time_axis(run)
    unit_of_time = time_unit(float(longest[-1]) if len(longest) else 0.0, shown.time)
    time = np.ascontiguousarray(longest / unit_of_time.si)
    lines = _lines(run, overlay, pins, shown)
    counted = [line for line in lines if counts(line.state)] or lines
    deciding = [line.method for line in counted if line.method.status != "diverged"]
    cut = len(deciding) < len(counted)
    deciding = deciding or [line.method for line in counted]
    peaks = {key: _peak(deciding, column) for key, (column, *_) in _QUANTITIES.items()}
    units = _units(peaks, shown)
    count = len(run.methods)
    plots: dict[str, UplotFigure] = {}
    for key, (column, symbol, title, _) in _QUANTITIES.items():
        unit, limit = units[key], _CUT * peaks[key] if cut else math.inf
        curves = [
            _curve(line.method, column, len(longest), unit, limit)
            if line.own
            else _curve_on(longest, line.method, column, unit, limit)
            for line in lines
        ]
        made = UplotFigure(
            key=key,
            quantity=NAMES[column],
            title=title,
            symbol=symbol,
            unit=unit,
            time_unit=unit_of_time,
            names=tuple(line.name for line in lines),
            colors=tuple(line.color for line in lines),
            data=(time, *curves),
            dashes=tuple(line.dash for line in lines),
            widths=tuple(line.width for line in lines),
            floor=0.0 if key == "position" else None,
            states=tuple(line.state for line in lines),
        )
        if envelope is not None and len(envelope.t_s):
            made = _with_band(made, envelope, column, longest, count)
        if limits and key in limits:
            made = _with_limit(made, limits[key])
        plots[key] = _logarithmic(made) if shown.scale == "log" else made
    return plots


def _lines(run: Run, overlay: Overlay | None, pins: Sequence[Pinned], display: Display) -> list[_Line]:
    width = style.CURVE_WIDTH
    states: list[State] = [display.state_of(m.method.name) for m in run.methods]
    lines = [
        _Line(m, legend_name(m), style.method_color(i), (), width, True, states[i])
        for i, m in enumerate(run.methods)
    ]
    if overlay is not None:
        faint = _FAINT if overlay.old else ""
        lines += [
            _Line(
                m,
                f"{legend_name(m)}: {STRAPDOWN}",
                style.method_color(i) + faint,
                _DASH,
                width,
                False,
                states[i],
            )
            for i, m in enumerate(overlay.run.methods)
        ]
    lines += [
        _Line(
            found.method,
            found.label,
            found.color,
            found.dash,
            PIN_WIDTH,
            False,
            display.state_of(found.label),
        )
        for found in pinned_methods(pins)
    ]
    return lines


def _with_band(
    plot: UplotFigure, envelope: Envelope, column: int, time_s: np.ndarray, count: int
) -> UplotFigure:
    """Put the envelope's edges behind all curves, and a band between each pair."""
    names, colors, edges, bands = list(plot.names), list(plot.colors), [], []
    for index, (low, high) in enumerate(zip(envelope.low[:count], envelope.high[:count], strict=True)):
        if low is None or high is None or plot.state(index) == "hidden":
            continue
        for word, values in (("upper", high), ("lower", low)):
            edges.append(np.interp(time_s, envelope.t_s, values[:, column]) / plot.unit.si)
            names.append(f"band, {word}: {plot.names[index]}")
            colors.append("rgba(0,0,0,0)")
        bands.append((len(names) - 2, len(names) - 1, style.method_color(index) + _BAND))
    widths = (*plot.widths, *(0.0,) * len(edges))
    data = (*plot.data, *edges)
    return replace(
        plot, names=tuple(names), colors=tuple(colors), widths=widths, data=data, bands=tuple(bands)
    )


def _with_limit(plot: UplotFigure, limit: float) -> UplotFigure:
    """Add a line at the largest allowed value, and at its negative where that can be reached."""
    signs = (1.0,) if plot.floor is not None else (1.0, -1.0)
    count = len(plot.data[0])
    places = len(plot.names) - len(plot.dashes)
    return replace(
        plot,
        names=(*plot.names, *("limit" for _ in signs)),
        colors=(*plot.colors, *(style.DANGER for _ in signs)),
        dashes=(*plot.dashes, *((),) * places, *(_LIMIT_DASH for _ in signs)),
        widths=(*plot.widths, *(1.0 for _ in signs)),
        data=(*plot.data, *(np.full(count, sign * limit / plot.unit.si) for sign in signs)),
    )


def _logarithmic(plot: UplotFigure) -> UplotFigure:
    """Magnitudes on an axis of decades that shows every curve's peak; what is smaller lies on its floor."""
    edges = plot.edges
    sizes = [np.abs(values) for values in plot.data[1:]]
    for upper, lower, _ in plot.bands:
        # between edges of both signs the magnitude comes down to zero
        across = plot.data[1 + upper] * plot.data[1 + lower] < 0.0
        sizes[upper], sizes[lower] = (
            np.maximum(sizes[upper], sizes[lower]),
            np.where(across, 0.0, np.minimum(sizes[upper], sizes[lower])),
        )
    counted = [i for i in range(len(sizes)) if i not in edges and counts(plot.state(i))]
    peaks = [float(np.nanmax(sizes[i], initial=0.0)) for i in counted]
    peaks = [peak for peak in peaks if peak > 0.0] or [1.0]
    last = math.ceil(math.log10(max(peaks)))
    first = min(last - _FEWEST_DECADES, math.floor(math.log10(min(peaks))) - 1)
    first = max(first, last - _MOST_DECADES)
    data = (plot.data[0], *(np.maximum(size, 10.0**first) for size in sizes))
    return replace(plot, symbol=f"|{plot.symbol}|", data=data, decades=(first, last), floor=None)


def _time_axis(run: Run) -> np.ndarray:
    """Times (s) of the method that came furthest; the ends are moved, within their bin, to the run's."""
    method = max(run.methods, key=lambda m: len(m.plot.t_s))
    time_s = method.plot.t_s.copy()
    if len(time_s) > 1 and len(method.t_s):
        time_s[0], time_s[-1] = 0.0, max(time_s[-1], float(method.t_s[-1]))
    return time_s


def _peak(methods: list[MethodRun], column: int) -> float:
    return max((m.errors[NAMES[column]]["max_abs"] for m in methods), default=0.0)


def _units(peaks: dict[str, float], display: Display) -> dict[str, Unit]:
    """Unit of each quantity: the wanted one, its family's, or its own where that would leave it no digits."""
    wanted = {_TILT: display.angle, _HEADING: display.angle, _SPEED: display.speed, _LENGTH: display.length}
    of_family: dict[str, float] = {}
    for key, (_, _, _, family) in _QUANTITIES.items():
        of_family[family] = max(of_family.get(family, 0.0), peaks[key])
    units: dict[str, Unit] = {}
    for key, (_, _, _, family) in _QUANTITIES.items():
        if wanted[family] != AUTO:
            units[key] = scaled_unit(wanted[family], peaks[key])
            continue
        choose = _CHOOSERS[family]
        shared = choose(of_family[family])
        units[key] = (
            shared if peaks[key] >= _FEWEST_UNITS * shared.si or peaks[key] == 0.0 else choose(peaks[key])
        )
    return units


def quantity_unit(key: str, peak: float, display: Display) -> Unit:
    """Unit of one quantity alone: the wanted one, else what suits its peak (SI)."""
    family = _QUANTITIES[key][3]
    wanted = {_TILT: display.angle, _HEADING: display.angle, _SPEED: display.speed, _LENGTH: display.length}
    return wanted_unit(wanted[family], peak, _CHOOSERS[family])


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


def legend_name(method: MethodRun) -> str:
    """Name of a method, with how it ended if that was not well."""
    name = method.method.name
    return name + {"ok": "", "diverged": " (diverged)", "stopped": " (stopped)"}[method.status]
