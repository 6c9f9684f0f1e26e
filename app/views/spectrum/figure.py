"""Amplitude spectrum of an error over its period, all methods, with the natural periods marked."""

import math
from typing import Any

import numpy as np

from navcore.engine.run import RECORDED_PLACE, MethodRun, Run
from navcore.engine.to_log import bridged, to_log
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.quantities import NAMES
from navcore.scenario.own_ins import AS_RECORDED
from schuler_bench.plots import style
from schuler_bench.plots.plotly_data import PlotlyFigure, figure, packed
from schuler_bench.plots.units import NAMED, Unit, duration, speed_unit, wanted_unit
from schuler_bench.session.display import TO_LOG, Display
from schuler_bench.views.errors.figure import error_plots
from schuler_bench.views.frequency.figure import natural_frequencies

_PADDING = 6
"""Points by which each lobe of the window is drawn: a sine between two shows 99.5 % of its amplitude."""
_MOST_POINTS = 1200
_DECADES = 7.0
_LEAST_ROWS = 16
_MINUTES_BELOW_H = 6.0
FIRST = "dve"
TO_LOG_TITLES: dict[str, str] = dict(
    zip(TO_LOG, (Text("East velocity minus log"), Text("North velocity minus log")), strict=True)
)
_Curve = tuple[str, int, np.ndarray, np.ndarray]
"""Name, place in the palette, times (s) and values (SI) of a curve."""


def spectrum(
    run: Run,
    key: str = "dve",
    aspect: float = 0.46,
    *,
    display: Display | None = None,
    width_px: float = 940.0,
) -> PlotlyFigure:
    """Amplitude spectrum of one error, or of the velocity minus log of a ship's own INS, before and after.

    Parameters
    ----------
    run : Run
        Result; its output rows are transformed.
    key : str
        Of `schuler_bench.views.errors.figure.error_plots`, or of `TO_LOG_TITLES`;
        of a run that is not on an INS the latter give that of `FIRST`.
    aspect : float
        Height / width of the figure.
    display : Display, optional
        Units.
    width_px : float
        Expected width on screen.
    """
    display = display or Display()
    key = drawn_key(run, key)
    title, unit, curves = (_to_log if key in TO_LOG_TITLES else _errors)(run, key, display)
    span_s = float(run.t_s[-1]) if len(run.t_s) else 0.0
    period_unit = _period_unit(display, span_s)
    data, peaks, shortest = [], [], math.inf
    for name, place, t_s, values in curves:
        period_s, amplitude = amplitude_spectrum(t_s, values)
        if not len(period_s):
            continue
        size = amplitude / unit.si
        peaks.append(float(size.max()))
        shortest = min(shortest, float(period_s.min()))
        trace = style.lines(name, place, style.CURVE_WIDTH)
        hover = Text(
            "<b>{method}</b><br>%{{x:.4g}} {period}: %{{y:.4g}} {unit}<extra></extra>",
            method=trace["name"],
            period=period_unit.name,
            unit=unit.name,
        )
        data.append(
            trace | {"x": packed(period_s / period_unit.si), "y": packed(size), "hovertemplate": hover}
        )
    longest_s = max(1.1 * span_s, 3600.0)
    periods_s = {name: 2.0 * math.pi / omega for name, omega in natural_frequencies(run).items()}
    markers = {name: period_s for name, period_s in periods_s.items() if period_s <= longest_s}
    layout = style.framed(
        [name for name, *_ in curves],
        aspect,
        width_px,
        {"l": 68, "r": 16, "t": 46, "b": 48},
        hovermode="closest",
        showlegend=True,
        xaxis=_period_axis(period_unit, max(shortest, 60.0) if data else 60.0, longest_s),
        yaxis=_amplitude_axis(unit, peaks),
        annotations=[
            style.heading(Text("<b>{title}: amplitude</b>", title=title), 34),
            *(_marker_label(name, period_s, period_unit) for name, period_s in markers.items()),
        ],
        shapes=[style.upright(period_s / period_unit.si) for period_s in markers.values()],
    )
    return figure(data, layout)


def drawn_key(run: Run | None, key: str) -> str:
    """Key that is drawn: that of `FIRST` where a run is not on an INS and has no velocity minus log."""
    return FIRST if key in TO_LOG_TITLES and (run is None or run.against is None) else key


def _errors(run: Run, key: str, display: Display) -> tuple[str, Unit, list[_Curve]]:
    """Title, unit and curves of an error."""
    plot = error_plots(run, display=display)[key]
    column = NAMES.index(plot.quantity)
    return (
        plot.title,
        plot.unit,
        [(one.method.name, one.place, one.t_s, one.rows[:, column]) for one in run.lines],
    )


def _to_log(run: Run, key: str, display: Display) -> tuple[str, Unit, list[_Curve]]:
    """Title, unit and curves of the velocity minus log: of the INS as recorded, then of each method."""
    axis = list(TO_LOG_TITLES).index(key)
    named: list[tuple[str, int, MethodRun | None]] = [(AS_RECORDED, RECORDED_PLACE, None)]
    named += [(one.method.name, one.place, one) for one in run.methods if one.output is not None]
    curves = [
        (name, place, run.t_s if one is None else one.t_s, bridged(to_log(run, one)[:, axis]))
        for name, place, one in named
    ]
    peak = max((float(np.max(np.abs(values))) for *_, values in curves if len(values)), default=0.0)
    return TO_LOG_TITLES[key], wanted_unit(display.speed, peak, speed_unit), curves


def amplitude_spectrum(t_s: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Periods (s) and amplitudes (SI) of a curve: a sine of amplitude a that fits the run gives a.

    The mean is taken off and a Hann window laid over the rows; of points that lie closer than the picture
    can show, the largest is kept. Nothing for a run of a few rows.

    Parameters
    ----------
    t_s : ndarray, shape (m,)
        Times of the output rows, evenly spaced but for the last.
    values : ndarray, shape (m,) or (0,)
        The curve.

    Returns
    -------
    ndarray, shape (n,), longest period first, and ndarray, shape (n,).
    """
    count = len(values)
    if count > 2:  # the last row of a thinned run may follow closer
        steps = np.diff(t_s)
        count -= int(not math.isclose(steps[-1], steps[0], rel_tol=1e-6))
    values = values[:count]
    if count < _LEAST_ROWS or not np.isfinite(values).all():
        return np.empty(0), np.empty(0)
    window = np.hanning(count + 1)[:-1]
    length = 2 ** math.ceil(math.log2(_PADDING * count))
    amplitude = 2.0 * np.abs(np.fft.rfft((values - values.mean()) * window, length)) / window.sum()
    frequency = np.arange(len(amplitude)) / (length * (t_s[1] - t_s[0]))
    first = _PADDING  # below one period in the whole run there is only the window
    frequency, amplitude = frequency[first:], amplitude[first:]
    places = np.floor(np.log(frequency / frequency[0]) / np.log(frequency[-1] / frequency[0]) * _MOST_POINTS)
    starts = np.flatnonzero(np.diff(places, prepend=-1.0))
    largest = np.maximum.reduceat(amplitude, starts)
    ends = np.append(starts[1:], len(frequency)) - 1
    middle = np.where(ends == starts, frequency[starts], np.sqrt(frequency[starts] * frequency[ends]))
    return 1.0 / middle, largest


def _period_unit(display: Display, span_s: float) -> Unit:
    if display.time != "auto":
        return NAMED[display.time]
    return NAMED["min" if span_s <= _MINUTES_BELOW_H * HOUR else "h"]


def _period_axis(unit: Unit, shortest_s: float, longest_s: float) -> dict[str, Any]:
    shortest, longest = math.log10(shortest_s / unit.si), math.log10(longest_s / unit.si)
    decades = range(math.floor(shortest), math.ceil(longest) + 1)
    marks = [m * 10.0**k for k in decades for m in (1.0, 2.0, 5.0)]
    marks = [mark for mark in marks if shortest <= math.log10(mark) <= longest]
    return style.axis(
        Text("period ({name})", name=unit.name),
        type="log",
        range=[longest, shortest],  # as in the Bode plots, slow is left
        tickvals=marks,
        ticktext=[f"{mark:g}" for mark in marks],
    )


def _amplitude_axis(unit: Unit, peaks: list[float]) -> dict[str, Any]:
    powers = [math.log10(peak) for peak in peaks if peak > 0.0]
    top = math.log10(1.6 * max(peaks)) if powers else 0.0
    low = max(min(powers, default=top) - 4.0, top - _DECADES)
    decades = range(math.ceil(low), math.floor(top) + 1)
    return style.axis(
        Text("amplitude ({name})", name=unit.name),
        type="log",
        range=[low, top],
        tickvals=[10.0**k for k in decades],
        ticktext=[style.power(k) for k in decades],
        minor={"showgrid": True, "dtick": "D1", "gridcolor": style.GRID_FINE},
    )


def _marker_label(name: str, period_s: float, unit: Unit) -> dict[str, Any]:
    return style.text(
        math.log10(period_s / unit.si),
        1.0,
        name if name == "24 h" else Text("{name} {duration}", name=name, duration=duration(period_s)),
        xref="x",
        yref="paper",
        xanchor={"24 h": "left", "Foucault": "right", "Schuler": "center"}[name],
        yanchor="bottom",
        font={"size": style.FONT_SIZE, "color": style.MUTED},
    )
