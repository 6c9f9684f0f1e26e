"""Amplitude spectrum of an error over its period, all methods, with the natural periods marked."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from app.plots import style
from app.plots.plotly_data import PlotlyFigure, figure, packed
from app.plots.units import HOURS, MINUTES, Unit, duration
from app.session.display import Display
from app.views.errors.figure import error_plots
from app.views.frequency.figure import natural_frequencies
from navcore.engine.run import MethodRun, Run
from navcore.mechanization.recorder import NAMES

_PADDING = 4
"""The window's lobes are drawn by so many points each."""
_MOST_POINTS = 1200
_DECADES = 7.0
_LEAST_ROWS = 16
_MINUTES_BELOW_H = 6.0


def spectrum(
    run: Run,
    key: str = "dve",
    aspect: float = 0.46,
    *,
    display: Display | None = None,
    width_px: float = 940.0,
) -> PlotlyFigure:
    """Amplitude spectrum of one quantity of `app.views.errors.figure.error_plots`.

    Parameters
    ----------
    run : Run
        Result; its output rows are transformed.
    key : str
        The quantity.
    aspect : float
        Height / width of the figure.
    display : Display, optional
        Units.
    width_px : float
        Expected width on screen.
    """
    plot = error_plots(run, display=display)[key]
    column = NAMES.index(plot.quantity)
    span_s = float(run.t_s[-1]) if len(run.t_s) else 0.0
    axis_unit = _period_unit(display or Display(), span_s)
    data, peaks, shortest = [], [], math.inf
    for index, method in enumerate(run.methods):
        period_s, amplitude = amplitude_spectrum(method, column)
        if not len(period_s):
            continue
        size = amplitude / plot.unit.si
        peaks.append(float(size.max()))
        shortest = min(shortest, float(period_s.min()))
        data.append(_trace(method, index, period_s / axis_unit.si, size, axis_unit, plot.unit))
    names = [method.method.name for method in run.methods]
    periods = (max(shortest, 60.0) if math.isfinite(shortest) else 60.0, max(1.1 * span_s, 3600.0))
    return figure(
        data,
        _layout(
            run, f"{plot.title}: amplitude", plot.unit, axis_unit, periods, peaks, names, aspect, width_px
        ),
    )


def amplitude_spectrum(method: MethodRun, column: int) -> tuple[np.ndarray, np.ndarray]:
    """Periods (s) and amplitudes (SI) of one quantity: a sine of amplitude a that fits the run gives a.

    The mean is taken off and a Hann window laid over the rows; of points that lie closer than the picture
    can show, the largest is kept. Nothing for a run of a few rows.

    Parameters
    ----------
    method : MethodRun
        Result, with evenly spaced output rows.
    column : int
        Place in `navcore.mechanization.recorder.NAMES`.

    Returns
    -------
    ndarray, shape (n,), longest period first, and ndarray, shape (n,).
    """
    values = method.rows[:, column]
    count = len(values)
    if count > 2:  # the last row of a thinned run may follow closer
        steps = np.diff(method.t_s)
        count -= int(not math.isclose(steps[-1], steps[0], rel_tol=1e-6))
    values = values[:count]
    if count < _LEAST_ROWS or not np.isfinite(values).all():
        return np.empty(0), np.empty(0)
    window = np.hanning(count + 1)[:-1]
    length = 2 ** math.ceil(math.log2(_PADDING * count))
    amplitude = 2.0 * np.abs(np.fft.rfft((values - values.mean()) * window, length)) / window.sum()
    frequency = np.arange(len(amplitude)) / (length * (method.t_s[1] - method.t_s[0]))
    first = _PADDING  # below one period in the whole run there is only the window
    frequency, amplitude = frequency[first:], amplitude[first:]
    places = np.floor(np.log(frequency / frequency[0]) / np.log(frequency[-1] / frequency[0]) * _MOST_POINTS)
    starts = np.flatnonzero(np.diff(places, prepend=-1.0))
    largest = np.maximum.reduceat(amplitude, starts)
    ends = np.append(starts[1:], len(frequency)) - 1
    single = ends == starts
    middle = np.where(single, frequency[starts], np.sqrt(frequency[starts] * frequency[ends]))
    return 1.0 / middle, largest


def _period_unit(display: Display, span_s: float) -> Unit:
    if display.time != "auto":
        return MINUTES if display.time == "min" else HOURS
    return MINUTES if span_s <= _MINUTES_BELOW_H * HOURS.si else HOURS


def _trace(
    method: MethodRun, index: int, x: np.ndarray, y: np.ndarray, x_unit: Unit, y_unit: Unit
) -> dict[str, Any]:
    name = style.plain(method.method.name)
    return {
        "type": "scatter",
        "mode": "lines",
        "x": packed(x),
        "y": packed(y),
        "name": name,
        "legendgroup": str(index),
        "line": {"color": style.method_color(index), "width": style.CURVE_WIDTH, "simplify": False},
        "hovertemplate": f"<b>{name}</b><br>%{{x:.4g}} {x_unit.name}: %{{y:.4g}} {y_unit.name}"
        "<extra></extra>",
    }


def _layout(
    run: Run,
    title: str,
    unit: Unit,
    period_unit: Unit,
    periods_s: tuple[float, float],
    peaks: list[float],
    names: list[str],
    aspect: float,
    width_px: float,
) -> dict[str, Any]:
    rows = style.legend_rows(names, width_px - 84.0)
    shortest, longest = (math.log10(period / period_unit.si) for period in periods_s)
    top = math.log10(1.6 * max(peaks)) if peaks and max(peaks) > 0.0 else 0.0
    lowest = min((math.log10(peak) for peak in peaks if peak > 0.0), default=top) - 4.0
    decades = range(math.floor(shortest), math.ceil(longest) + 1)
    marks = [m * 10.0**k for k in decades for m in (1.0, 2.0, 5.0)]
    marks = [mark for mark in marks if shortest <= math.log10(mark) <= longest]
    markers = {
        name: 2.0 * math.pi / omega
        for name, omega in natural_frequencies(run).items()
        if 2.0 * math.pi / omega <= periods_s[1]
    }
    low = max(lowest, top - _DECADES)
    powers = range(math.ceil(low), math.floor(top) + 1)
    return style.layout(
        margin={"l": 68, "r": 16, "t": 46, "b": 48 + 22 * rows},
        hovermode="closest",
        showlegend=True,
        legend=style.legend(),
        xaxis=style.axis(
            f"period ({period_unit.name})",
            type="log",
            range=[longest, shortest],  # as in the Bode plots, slow is left
            tickvals=marks,
            ticktext=[f"{mark:g}" for mark in marks],
        ),
        yaxis=style.axis(
            f"amplitude ({unit.name})",
            type="log",
            range=[low, top],
            tickvals=[10.0**k for k in powers],
            ticktext=[f"{10.0**k:g}" if -3 <= k <= 4 else f"10<sup>{k}</sup>" for k in powers],
            minor={"showgrid": True, "dtick": "D1", "gridcolor": style.GRID_FINE},
        ),
        annotations=[
            style.text(
                0.0,
                1.0,
                f"<b>{title}</b>",
                xref="paper",
                yref="paper",
                xanchor="left",
                yanchor="middle",
                yshift=34,
                font={"size": style.TITLE_SIZE, "color": style.INK},
            ),
            *(_marker_label(name, period / period_unit.si, period) for name, period in markers.items()),
        ],
        shapes=[_marker_line(period / period_unit.si) for period in markers.values()],
        meta={"aspect": aspect},
    )


def _marker_line(at: float) -> dict[str, Any]:
    return {
        "type": "line",
        "xref": "x",
        "x0": at,
        "x1": at,
        "yref": "paper",
        "y0": 0.0,
        "y1": 1.0,
        "layer": "below",
        "line": {"color": style.REFERENCE, "width": 1.2, "dash": "dot"},
    }


def _marker_label(name: str, at: float, period_s: float) -> dict[str, Any]:
    anchor = {"24 h": "left", "Foucault": "right", "Schuler": "center"}[name]
    content = name if name == "24 h" else f"{name} {duration(period_s)}"
    return style.text(
        math.log10(at),
        1.0,
        content,
        xref="x",
        yref="paper",
        xanchor=anchor,
        yanchor="bottom",
        font={"size": style.FONT_SIZE, "color": style.MUTED},
    )
