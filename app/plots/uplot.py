"""A plot over time for uPlot: what it is made of, and how it is drawn in the house style."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from schuler_bench.plots import style
from schuler_bench.plots.legend import FAINT, State
from schuler_bench.plots.units import Unit

SYNC_KEY = "schuler-time"
"""All time plots share their cursor under this key."""
Y_SIZE, LABEL_SIZE = 62, 22
"""Room for the numbers and for the name of a y axis, px."""
_X_SIZE = 30
_LABEL_FONT = f"600 {style.FONT_SIZE}px {style.FONT_FAMILY}"
_TICK_FONT = f"{style.FONT_SIZE}px {style.FONT_FAMILY}"
_TOP, _RIGHT = 8, 18
_LOW_PX = 150
# Steps of the time axis: those that divide an hour or a day, and a few finer ones for zooming in.
_TIME_STEPS = (
    1e-3, 2e-3, 5e-3, 0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 3.0, 6.0,
    12.0, 24.0, 48.0, 96.0, 168.0, 336.0, 720.0, 1440.0,
)  # fmt: skip
_MINUTE_STEPS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 60.0, 120.0)

Dash = tuple[int, ...]
_FLAGS: dict[State, dict[str, bool]] = {
    "shown": {},
    "unscaled": {"auto": False},
    "dimmed": {},
    "hidden": {"show": False, "auto": False},
}


@dataclass(frozen=True, eq=False)
class Curve:
    """One curve of a plot over time.

    Attributes
    ----------
    name : str
        With what the legend says of a method that did not end well.
    color : str
        ``#RRGGBB``, or with an opacity ``#RRGGBBAA``.
    values : ndarray, shape (m,)
        float64, in the unit of the plot; NaN where there is nothing to show.
    dash : tuple of int
        Dash pattern, px; empty: solid.
    width : float
        px.
    state : State
        How it is shown (`schuler_bench.plots.legend`).
    limit : (str, float) or None
        It is the line of a limit: what is limited, and the plot's unit in that of the limit's box.
    """

    name: str
    color: str
    values: np.ndarray
    dash: Dash = ()
    width: float = style.CURVE_WIDTH
    state: State = "shown"
    limit: tuple[str, float] | None = None

    @property
    def series(self) -> dict[str, Any]:
        """Series for uPlot."""
        # lines rounded to whole pixels look like stairs
        return (
            {"points": {"show": False}, "pxAlign": 0, "label": self.name, "width": self.width}
            | {"stroke": self.color[:7] + FAINT if self.state == "dimmed" else self.color}
            | ({"dash": self.dash} if self.dash else {})
            | ({"limit": self.limit} if self.limit else {})
            | _FLAGS[self.state]
        )


@dataclass(frozen=True, eq=False)
class UplotFigure:
    """One plot over time.

    Attributes
    ----------
    key : str
        Names the plot among those shown.
    quantity : str
        What is drawn: a name in `navcore.quantities.NAMES`, say.
    title : str
        What is shown, in words.
    symbol : str
        Short name on the axis.
    unit, time_unit : Unit
        Of the curves and of the time axis.
    time : ndarray, shape (m,)
        Times, float64, in ``time_unit``.
    curves : tuple of Curve
        Drawn in this order.
    floor : float or None
        The y axis begins here, whatever is drawn.
    ticks : tuple of (float, str)
        Places and words on the y axis in the place of numbers.
    decades : tuple of int or None
        The y axis is logarithmic, from and to these powers of ten.
    bands : tuple of (int, int, str)
        Filled areas: places of the upper and the lower curve in ``curves``, colour.
    period : float
        The time axis has its ticks at multiples of it, in ``time_unit``; 0: at round times.
    """

    key: str
    quantity: str
    title: str
    symbol: str
    unit: Unit
    time_unit: Unit
    time: np.ndarray
    curves: tuple[Curve, ...]
    floor: float | None = None
    ticks: tuple[tuple[float, str], ...] = ()
    decades: tuple[int, int] | None = None
    bands: tuple[tuple[int, int, str], ...] = ()
    period: float = 0.0

    @property
    def data(self) -> tuple[np.ndarray, ...]:
        """Time and the curves."""
        return self.time, *(curve.values for curve in self.curves)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the curves."""
        return tuple(curve.name for curve in self.curves)

    @property
    def edges(self) -> frozenset[int]:
        """Places of the curves that are only edges of bands."""
        return frozenset(place for upper, lower, _ in self.bands for place in (upper, lower))

    @property
    def series(self) -> tuple[dict[str, Any], ...]:
        """Series for uPlot: the time, then the curves."""
        return (
            {"label": Text("time ({name})", name=self.time_unit.name)},
            *(curve.series for curve in self.curves),
        )

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
        round_times = _TIME_STEPS if self.time_unit.si == HOUR else _MINUTE_STEPS
        x = common | {
            "scale": "x",
            "incrs": tuple(k * self.period for k in (1, 2, 5, 10, 20, 50)) if self.period else round_times,
            "space": 55,
            "size": _X_SIZE if time_axis else 8,
        }
        if time_axis:
            x |= {
                "label": Text("time ({name})", name=self.time_unit.name),
                "labelSize": LABEL_SIZE,
                "labelGap": 0,
            }
        else:
            x |= {"ticks": {"show": False}, "font": f"1px {style.FONT_FAMILY}", "stroke": "rgba(0,0,0,0)"}
        unit = Text("({name})", name=self.unit.name) if self.unit.name else ""
        y = common | {
            "scale": "y",
            "label": Text.joined(" ", (part for part in (self.symbol, unit) if part)),
            "labelSize": LABEL_SIZE,
            "labelGap": 0,
            "size": Y_SIZE,
            "space": 16 if low else 26,
        }
        ticks = self.ticks or self._powers(low)
        if ticks:
            y |= {"splits": tuple(at for at, _ in ticks), "values": tuple(word for _, word in ticks)}
        return x, y

    def _powers(self, low: bool) -> tuple[tuple[float, str], ...]:
        """Powers of ten on a logarithmic axis; uPlot's own words for them have three decimals."""
        if self.decades is None:
            return ()
        first, last = self.decades
        step = max(1, -(-(last - first) // (4 if low else 6)))
        return tuple(
            (10.0**k, (f"{10.0**k:g}" if -3 <= k <= 4 else f"1e{k}") if (last - k) % step == 0 else "")
            for k in range(first, last + 1)
        )

    @property
    def scales(self) -> dict[str, Any]:
        """Scales for uPlot: time as a plain number, and y padded, or logarithmic."""
        if self.decades is not None:
            first, last = self.decades
            return {
                "x": {"time": False},
                "y": {"distr": 3, "log": 10, "range": (10.0**first, 10.0**last)},
            }
        # soft bounds of mode 2 act only on flat data: zero everywhere shows +-0.1, not +-100
        low: dict[str, Any] = {"pad": 0.08, "soft": -0.1, "mode": 2}
        if self.floor is not None:
            low = {"pad": 0.0, "hard": self.floor}
        high = {"pad": 0.08, "soft": 0.1, "mode": 2}
        return {"x": {"time": False}, "y": {"range": {"min": low, "max": high}}}

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
            "bands": tuple(
                {"series": (upper + 1, lower + 1), "fill": color} for upper, lower, color in self.bands
            )
            or None,
            "scales": self.scales,
            "axes": self.axes(time_axis=time_axis, low=height is not None and height < _LOW_PX),
            "legend": {"show": legend, "live": True},
            "cursor": {
                "sync": {"key": SYNC_KEY, "scales": ("x", None)},
                "lock": True,
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
        looks = tuple((c.name, c.color, c.dash, c.width, c.state, c.limit) for c in self.curves)
        scale = self.floor, self.ticks, self.decades, self.bands, self.period
        return self.key, self.symbol, self.unit.name, self.time_unit.name, looks, scale


def stack_heights(available_px: int, count: int, least_px: int = 84) -> tuple[int, ...]:
    """Heights of ``count`` plots in a column: equal plot areas, the lowest with room for the time labels."""
    extra = _X_SIZE + LABEL_SIZE - 8
    each = max((available_px - extra) // max(count, 1), least_px)
    return tuple(each + (extra if i == count - 1 else 0) for i in range(count))
