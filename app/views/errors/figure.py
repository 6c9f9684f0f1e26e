"""Error curves over time for uPlot: one small plot a quantity, all methods in each, one common time axis."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from navcore.engine.run import ENDINGS, MethodRun, Run
from navcore.engine.verification import Verification
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR, UNITS
from navcore.quantities import (
    ERRORS,
    NAMES,
    QUANTITIES,
    VECTORS,
    ErrorVector,
    Kind,
    RecordedError,
    components,
)
from schuler_bench.plots import style
from schuler_bench.plots.envelope import Envelope
from schuler_bench.plots.legend import counts
from schuler_bench.plots.lengths import curves_of, on_times
from schuler_bench.plots.pinned import PIN_WIDTH, Pinned, pinned_methods
from schuler_bench.plots.units import (
    AUTO,
    Unit,
    angle_unit,
    length_unit,
    speed_unit,
    time_unit,
    wanted_unit,
)
from schuler_bench.plots.uplot import Curve, Dash, UplotFigure
from schuler_bench.session.display import CURVES, Display
from schuler_bench.session.requirements import LimitLine

_CUT = 3.0
"""A diverged method is drawn up to this many times the largest value of the others."""
_FEWEST_UNITS = 0.02
STRAPDOWN = Text("full strapdown")
_DASH: Dash = (7, 5)
_FAINT = "66"
"""Opacity of curves that belong to an earlier scenario, as colours carry it."""

_SUITABLE: dict[str, Callable[[float], Unit]] = {
    "angle": angle_unit,
    "speed": speed_unit,
    "length": length_unit,
}
"""Unit that suits a peak where the display leaves that of a dimension open."""
_COLUMNS: tuple[tuple[int, RecordedError | ErrorVector], ...] = (
    *enumerate(VECTORS, len(ERRORS)),
    *enumerate(ERRORS),
)
"""Columns of `curves_of` and what they hold, in the order of the plots: a limit is about the lengths."""
_LENGTHS = {*(vector.key for vector in VECTORS), "position"}
"""Keys of errors that have no sign."""
_UNSEEN = "rgba(0,0,0,0)"
_LIMIT_DASH: Dash = (12, 5)
_FEWEST_DECADES, _MOST_DECADES = 3, 8
_BAND = "2E"
"""Opacity of an envelope, as colours carry it."""


RECORDED = {error.key: error.title for error in ERRORS}
"""Titles of the plots of recorded errors by key."""
TITLES = {vector.key: vector.title for vector in VECTORS} | RECORDED
"""Titles of the plots of `error_plots` by key."""

STACKS: dict[str, str] = {
    Text("Attitude"): "attitude",
    Text("Velocity"): "velocity",
    Text("Position"): "position",
}
"""Titles of the groups of `schuler_bench.session.display.CURVES` whose plots stand one above the other."""
GROUPS: dict[str, tuple[str, ...]] = {
    "Overview": ("tilt", "phi_e", "phi_n", "velocity", "dve", "dvn", "position"),
    **{title: CURVES[group] for title, group in STACKS.items()},
}
"""Stacks of plots that belong together: title -> keys of `error_plots`, top to bottom."""


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
    curve : Curve
        How they look.
    method : MethodRun
        Whose they are.
    values : ndarray, shape (m, 10)
        At the times of the plots, SI: the recorded errors, then the lengths of `VECTORS`; NaN where there is
        nothing to show.
    """

    curve: Curve
    method: MethodRun
    values: np.ndarray


def error_plots(
    run: Run,
    overlay: Overlay | None = None,
    *,
    display: Display | None = None,
    pins: Sequence[Pinned] = (),
    envelope: Envelope | None = None,
    limits: Mapping[str, Sequence[LimitLine]] | None = None,
) -> dict[str, UplotFigure]:
    """Error curves of all methods, by the keys of `navcore.quantities.VECTORS` and `ERRORS`.

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
        Key -> limits, drawn as dashed lines that can be dragged.
    """
    display = display or Display()
    time_s = _time_axis(run)
    unit_of_time = time_unit(float(time_s[-1]) if len(time_s) else 0.0, display.time)
    time = np.ascontiguousarray(time_s / unit_of_time.si)
    # A lesson that counts minutes counts swings: 84.4 min.
    in_swings = display.lesson and unit_of_time.si < HOUR
    period = round(math.tau / run.scenario.omega_s / unit_of_time.si, 1) if in_swings else 0.0
    lines = _lines(run, overlay, pins, display, time_s)
    scaled = [line.method for line in lines if counts(line.curve.state)] or [line.method for line in lines]
    deciding = [method for method in scaled if method.status != "diverged"]
    cut = len(deciding) < len(scaled)
    unknown = () if run.against is None else run.against.not_known
    peaks = {error.key: _peak(deciding or scaled, error.name) for error in ERRORS}
    peaks |= {
        vector.key: max(peaks[one.key] for one in ERRORS if one.kind is vector.kind) for vector in VECTORS
    }
    units = _units(peaks, display)
    plots: dict[str, UplotFigure] = {}
    for column, error in _COLUMNS:
        key = error.key
        unit, most = units[key], _CUT * peaks[key] if cut else math.inf
        names = components(error.kind) if isinstance(error, ErrorVector) else (error.name,)
        plot = UplotFigure(
            key=key,
            quantity=error.name if isinstance(error, RecordedError) else error.key,
            title=error.title,
            symbol=_symbol(error.symbol, peaks[key], not set(names).isdisjoint(unknown)),
            unit=unit,
            time_unit=unit_of_time,
            time=time,
            curves=tuple(replace(line.curve, values=_drawn(line, column, unit, most)) for line in lines),
            floor=0.0 if key in _LENGTHS else None,
            period=period,
        )
        if envelope is not None and len(envelope.t_s):
            plot = _with_band(plot, envelope, column, time_s, run)
        for limit in (limits or {}).get(key, ()):
            plot = _with_limit(plot, limit)
        plots[key] = _logarithmic(plot) if display.scale == "log" else plot
    return plots


def _lines(
    run: Run, overlay: Overlay | None, pins: Sequence[Pinned], display: Display, time_s: np.ndarray
) -> list[_Line]:
    none = np.empty(0)
    lines = []
    for method in run.lines:
        state = display.state_of(method.method.name)
        values = np.full((len(time_s), len(_COLUMNS)), np.nan)
        values[: len(method.plot.values)] = curves_of(method)
        curve = Curve(legend_name(method), style.method_color(method.place), none, state=state)
        lines.append(_Line(curve, method, values))
    if overlay is not None:
        for line, method in zip(list(lines), overlay.run.methods, strict=True):
            name, color = legend_name(method), line.curve.color + (_FAINT if overlay.old else "")
            curve = replace(
                line.curve,
                name=Text("{name}: {strapdown}", name=name, strapdown=STRAPDOWN),
                color=color,
                dash=_DASH,
            )
            lines.append(_Line(curve, method, on_times(time_s, method.plot.t_s, curves_of(method))))
    for pin in pinned_methods(pins):
        curve = Curve(pin.label, pin.color, none, pin.dash, PIN_WIDTH, display.state_of(pin.label))
        lines.append(_Line(curve, pin.method, on_times(time_s, pin.method.plot.t_s, curves_of(pin.method))))
    return lines


def _with_band(
    plot: UplotFigure, envelope: Envelope, column: int, time_s: np.ndarray, run: Run
) -> UplotFigure:
    """Put the envelope's edges behind all curves, and a band between each pair."""
    curves, bands = list(plot.curves), []
    shown = run.lines if envelope.with_recorded else run.methods
    count, first = len(shown), len(run.lines) - len(shown)
    edges = zip(envelope.low[:count], envelope.high[:count], strict=True)
    for index, (low, high) in enumerate(edges, start=first):
        if low is None or high is None or curves[index].state == "hidden":
            continue
        bands.append((len(curves), len(curves) + 1, curves[index].color + _BAND))
        for word, values in (("upper", high), ("lower", low)):
            edge = np.interp(time_s, envelope.t_s, values[:, column]) / plot.unit.si
            curves.append(
                Curve(
                    Text("band, {word}: {name}", word=word, name=curves[index].name), _UNSEEN, edge, width=0.0
                )
            )
    return replace(plot, curves=tuple(curves), bands=tuple(bands))


def _with_limit(plot: UplotFigure, limit: LimitLine) -> UplotFigure:
    """Add a line at the largest allowed value, and at its negative where that can be reached."""
    shown = np.where(plot.time * plot.time_unit.si < limit.from_s - 1e-6, np.nan, limit.value / plot.unit.si)
    size = plot.unit.si / UNITS[QUANTITIES[limit.quantity].limit_shown]
    lines = [
        Curve(Text("limit"), style.DANGER, side * shown, _LIMIT_DASH, 1.0, limit=(limit.quantity, size))
        for side in ((1.0,) if plot.floor is not None else (1.0, -1.0))
    ]
    return replace(plot, curves=(*plot.curves, *lines))


def _logarithmic(plot: UplotFigure) -> UplotFigure:
    """Magnitudes on an axis of decades that shows every curve's peak; what is smaller lies on its floor."""
    sizes = [np.abs(curve.values) for curve in plot.curves]
    for upper, lower, _ in plot.bands:
        # between edges of both signs the magnitude comes down to zero
        across = plot.curves[upper].values * plot.curves[lower].values < 0.0
        sizes[upper], sizes[lower] = (
            np.maximum(sizes[upper], sizes[lower]),
            np.where(across, 0.0, np.minimum(sizes[upper], sizes[lower])),
        )
    scaled = [i for i, curve in enumerate(plot.curves) if i not in plot.edges and counts(curve.state)]
    peaks = [peak for i in scaled if (peak := float(np.nanmax(sizes[i], initial=0.0))) > 0.0] or [1.0]
    last = math.ceil(math.log10(max(peaks)))
    first = min(last - _FEWEST_DECADES, math.floor(math.log10(min(peaks))) - 1)
    first = max(first, last - _MOST_DECADES)
    curves = tuple(
        replace(curve, values=np.maximum(size, 10.0**first))
        for curve, size in zip(plot.curves, sizes, strict=True)
    )
    symbol = plot.symbol if plot.floor is not None else f"|{plot.symbol}|"
    return replace(plot, symbol=symbol, curves=curves, decades=(first, last), floor=None)


def _time_axis(run: Run) -> np.ndarray:
    """Times (s) of the method that came furthest; the ends are moved, within their bin, to the run's."""
    method = max(run.methods, key=lambda m: len(m.plot.t_s))
    time_s = method.plot.t_s.copy()
    if len(time_s) > 1 and len(method.t_s):
        time_s[0], time_s[-1] = 0.0, max(time_s[-1], float(method.t_s[-1]))
    return time_s


def _peak(methods: list[MethodRun], name: str) -> float:
    sizes = [method.errors[name]["max_abs"] for method in methods]
    return max([size for size in sizes if not math.isnan(size)], default=0.0)


def _symbol(symbol: str, peak: float, unknown: bool) -> str:
    """Name on the axis: a curve that is 0 all the time, or that no reference tells, says so."""
    if unknown:
        return Text("{symbol} not known", symbol=symbol)
    return symbol if peak > 0.0 else Text("{symbol} = 0", symbol=symbol)


def _units(peaks: dict[str, float], display: Display) -> dict[str, Unit]:
    """Unit of each error: the wanted one, its kind's, or its own where that would leave it no digits."""
    units: dict[str, Unit] = {}
    for _, error in _COLUMNS:
        kind, peak = error.kind, peaks[error.key]
        shared = kind_unit(kind, max(peaks[one.key] for one in ERRORS if one.kind is kind), display)
        legible = peak == 0.0 or peak >= _FEWEST_UNITS * shared.si
        chosen = getattr(display, kind.dimension) != AUTO
        units[error.key] = shared if legible and not chosen else kind_unit(kind, peak, display)
    return units


def kind_unit(kind: Kind, peak: float, display: Display) -> Unit:
    """Unit of one error alone: the wanted one, else what suits its peak (SI)."""
    return wanted_unit(getattr(display, kind.dimension), peak, _SUITABLE[kind.dimension])


def _drawn(line: _Line, column: int, unit: Unit, most: float) -> np.ndarray:
    """Values in ``unit``, NaN once a diverging method has left ``most`` (SI)."""
    values = line.values[:, column]
    if line.method.status == "diverged" and most > 0.0:
        values = np.where(np.maximum.accumulate(~(np.abs(values) <= most)), np.nan, values)
    return np.ascontiguousarray(values / unit.si)


def legend_name(method: MethodRun) -> str:
    """Name of a method, with how it ended if that was not well."""
    name = method.method.name
    return (
        name if method.status == "ok" else Text("{name} ({ending})", name=name, ending=ENDINGS[method.status])
    )


VERIFIED = ("phi_e", "dve", "position")
"""Quantities that are drawn, top to bottom."""


def verification_plots(
    verification: Verification, *, old: bool = False, display: Display | None = None
) -> dict[str, UplotFigure]:
    """Plots of both models and of their difference, in pairs: left, right.

    Parameters
    ----------
    verification : Verification
        Result.
    old : bool
        It is of an earlier scenario: drawn faintly.
    display : Display, optional
        Units and scale.

    Returns
    -------
    dict
        Key -> plot. A difference is strapdown minus linear model at the common output rows, as
        `Verification.differences` measures it.
    """
    display = display or Display()
    both = error_plots(verification.linear, Overlay(verification.strapdown, old), display=display)
    plots: dict[str, UplotFigure] = {}
    for key in VERIFIED:
        plots[f"both_{key}"] = replace(both[key], key=f"both_{key}")
        plots[f"difference_{key}"] = _difference(verification, key, both[key], display)
    return plots


def _difference(verification: Verification, key: str, beside: UplotFigure, display: Display) -> UplotFigure:
    time_s, column = verification.linear.t_s, NAMES.index(beside.quantity)
    differences = np.full((len(verification.linear.methods), len(time_s)), np.nan)
    pairs = zip(verification.strapdown.methods, verification.linear.methods, strict=True)
    for values, (full, simple) in zip(differences, pairs, strict=True):
        rows = min(len(full.t_s), len(simple.t_s), len(time_s))
        values[:rows] = full.rows[:rows, column] - simple.rows[:rows, column]
    unit = kind_unit(ERRORS[column].kind, float(np.nanmax(np.abs(differences), initial=0.0)), display)
    return UplotFigure(
        key=f"difference_{key}",
        quantity=Text("{quantity} difference", quantity=beside.quantity),
        title=Text("{title}: strapdown minus linear model", title=beside.title),
        symbol=f"Δ {beside.symbol.strip('|')}",
        unit=unit,
        time_unit=beside.time_unit,
        time=np.ascontiguousarray(time_s / beside.time_unit.si),
        curves=tuple(
            replace(one, values=values / unit.si, name=method.method.name)
            for one, method, values in zip(
                beside.curves, verification.strapdown.methods, differences, strict=False
            )
        ),
    )
