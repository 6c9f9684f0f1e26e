"""Error curves over time for uPlot: one small plot a quantity, all methods in each, one common time axis."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from app.figures import style
from app.figures.units import Unit, angle_unit, length_unit, speed_unit, time_unit
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
from navcore.run import MethodRun, Run
from navcore.units import HOUR

SYNC_KEY = "schuler-time"
"""All time plots share their cursor under this key."""
_CUT = 3.0
"""A diverged method is drawn up to this many times the largest value of the others."""
_FEWEST_UNITS = 0.02
_LABEL_FONT = f"600 {style.FONT_SIZE}px {style.FONT_FAMILY}"
_TICK_FONT = f"{style.FONT_SIZE}px {style.FONT_FAMILY}"
_Y_SIZE = 62
_X_SIZE = 30
_LABEL_SIZE = 22
_TOP, _RIGHT = 8, 18
_LOW_PX = 150
# Steps of the time axis: those that divide an hour or a day, and a few finer ones for zooming in.
_TIME_STEPS = (
    1e-3, 2e-3, 5e-3, 0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 3.0, 6.0, 12.0, 24.0, 48.0, 96.0, 168.0,
    336.0, 720.0, 1440.0,
)  # fmt: skip
_MINUTE_STEPS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 60.0, 120.0)

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


@dataclass(frozen=True, eq=False)
class UplotFigure:
    """One plot over time.

    Attributes
    ----------
    key : str
        Key in `error_plots`.
    quantity : str
        Name in `navcore.mechanization.recorder.NAMES` and `MethodRun.errors`.
    title : str
        What is shown, in words.
    symbol : str
        Short name on the axis.
    unit, time_unit : Unit
        Of the curves and of the time axis.
    names : tuple of str
        Of the curves, with what the legend says of a method that did not end well.
    colors : tuple of str
        Of the curves.
    data : tuple of ndarray, each shape (m,)
        Time and one curve a method, float64, in the units above; NaN after a method has ended.
    """

    key: str
    quantity: str
    title: str
    symbol: str
    unit: Unit
    time_unit: Unit
    names: tuple[str, ...]
    colors: tuple[str, ...]
    data: tuple[np.ndarray, ...]

    @property
    def series(self) -> tuple[dict[str, Any], ...]:
        """Series for uPlot: the time, then the methods."""
        # lines rounded to whole pixels look like stairs
        common = {"width": style.CURVE_WIDTH, "points": {"show": False}, "pxAlign": 0}
        lines = (
            common | {"label": name, "stroke": color}
            for name, color in zip(self.names, self.colors, strict=True)
        )
        return ({"label": f"time ({self.time_unit.name})"}, *lines)

    def axes(self, *, time_axis: bool = True, low: bool = False) -> tuple[dict[str, Any], ...]:
        """Axes for uPlot.

        Parameters
        ----------
        time_axis : bool
            False leaves the time labels to the plot below.
        low : bool
            The plot is so low that its ticks must stand closer.
        """
        line = {"stroke": style.GRID, "width": 1}
        tick = {"stroke": style.REFERENCE, "width": 1, "size": 4}
        common: dict[str, Any] = {
            "stroke": style.MUTED,
            "font": _TICK_FONT,
            "labelFont": _LABEL_FONT,
            "grid": line,
            "ticks": tick,
            "gap": 3,
            "border": {"show": True, "stroke": style.REFERENCE, "width": 1},
        }
        in_hours = self.time_unit.si == HOUR
        x = common | {
            "scale": "x",
            "incrs": _TIME_STEPS if in_hours else _MINUTE_STEPS,
            "space": 55,
            "size": _X_SIZE if time_axis else 8,
        }
        if time_axis:
            x |= {"label": f"time ({self.time_unit.name})", "labelSize": _LABEL_SIZE, "labelGap": 0}
        else:
            x |= {"ticks": {"show": False}, "font": f"1px {style.FONT_FAMILY}", "stroke": "rgba(0,0,0,0)"}
        y = common | {
            "scale": "y",
            "label": f"{self.symbol} ({self.unit.name})",
            "labelSize": _LABEL_SIZE,
            "labelGap": 0,
            "size": _Y_SIZE,
            "space": 16 if low else 26,
        }
        return x, y

    @property
    def scales(self) -> dict[str, Any]:
        """Scales for uPlot: time as a plain number, and y padded."""
        # soft bounds of mode 2 act only on flat data: zero everywhere shows +-0.1, not +-100
        low: dict[str, Any] = {"pad": 0.08, "soft": -0.1, "mode": 2}
        if self.key == "position":
            low = {"pad": 0.0, "hard": 0.0}
        return {
            "x": {"time": False},
            "y": {"range": {"min": low, "max": {"pad": 0.08, "soft": 0.1, "mode": 2}}},
        }

    def kwargs(
        self,
        *,
        height: int | None = None,
        aspect: float = 4.0,
        time_axis: bool = True,
        legend: bool = True,
    ) -> dict[str, Any]:
        """Keyword arguments of viser's ``gui.add_uplot``.

        Parameters
        ----------
        height : int, optional
            Height in px; else ``aspect`` counts.
        aspect : float
            Width / height.
        time_axis : bool
            Label the time axis (the lowest plot of a stack).
        legend : bool
            Names of the methods and their values at the cursor, below the plot.
        """
        return {
            "data": self.data,
            "series": self.series,
            "scales": self.scales,
            "axes": self.axes(time_axis=time_axis, low=height is not None and height < _LOW_PX),
            "legend": {"show": legend, "live": True},
            "cursor": {
                "sync": {"key": SYNC_KEY, "scales": ("x", None)},
                "drag": {"x": True, "y": False, "setScale": True},
                "points": {"size": 7},
                "focus": {"prox": 24},
            },
            "focus": {"alpha": 0.35},
            "padding": (_TOP, _RIGHT, 0, 0),
            "height": height,
            "aspect": aspect,
        }

    def config_key(self) -> tuple[Any, ...]:
        """Compare equal while only the numbers changed: then sending ``data`` alone is enough."""
        return self.key, self.unit.name, self.time_unit.name, self.names, self.colors


def error_plots(run: Run) -> dict[str, UplotFigure]:
    """Error curves of all methods: phi_e, phi_n, phi_u, dve, dvn, dlat, dlon, position.

    Quantities of one family (the tilts, the velocities, the positions) share one unit, so that plots above
    each other compare at a glance; one that is far smaller than its family has a unit of its own.

    Parameters
    ----------
    run : Run
        Result.
    """
    longest = _time_axis(run)
    unit_of_time = time_unit(float(longest[-1]) if len(longest) else 0.0)
    time = np.ascontiguousarray(longest / unit_of_time.si)
    deciding = [m for m in run.methods if m.status != "diverged"] or list(run.methods)
    peaks = {key: _peak(deciding, column) for key, (column, *_) in _QUANTITIES.items()}
    units = _units(peaks)
    names = tuple(_legend_name(m) for m in run.methods)
    colors = tuple(style.method_color(i) for i in range(len(run.methods)))
    cut = len(deciding) < len(run.methods)
    plots: dict[str, UplotFigure] = {}
    for key, (column, symbol, title, _) in _QUANTITIES.items():
        limit = _CUT * peaks[key] if cut else math.inf
        curves = (_curve(m, column, len(longest), units[key], limit) for m in run.methods)
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


def _legend_name(method: MethodRun) -> str:
    name = method.method.name
    return name if method.status == "ok" else f"{name} ({method.status})"


def legend_html(run: Run) -> str:
    """One legend for a stack of plots: a coloured bar and the name of every method."""
    from html import escape

    items = "".join(
        f'<span style="display:inline-flex;align-items:center;gap:6px;white-space:nowrap">'
        f'<span style="width:18px;height:3px;border-radius:2px;background:{style.method_color(i)}"></span>'
        f"{escape(_legend_name(method))}</span>"
        for i, method in enumerate(run.methods)
    )
    return (
        f'<div style="display:flex;flex-wrap:wrap;gap:2px 18px;padding:2px 8px 2px {_Y_SIZE + _LABEL_SIZE}px;'
        f'font-size:{style.FONT_SIZE}px;color:{style.INK}">{items}</div>'
    )


def stack_heights(available_px: int, count: int, least_px: int = 84) -> tuple[int, ...]:
    """Heights of ``count`` plots in a column: equal plot areas, the lowest with room for the time labels."""
    extra = _X_SIZE + _LABEL_SIZE - 8
    each = max((available_px - extra) // max(count, 1), least_px)
    return tuple(each + (extra if i == count - 1 else 0) for i in range(count))
