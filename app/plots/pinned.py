"""Pinned runs beside the present one: laid over its figures, and subtracted in the table."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

from navcore.engine.run import MethodRun, Run
from navcore.foundation.text import Text
from schuler_bench.plots.plotly_data import PlotlyFigure
from schuler_bench.plots.units import Unit, number, relative
from schuler_bench.plots.uplot import Dash

PIN_WIDTH = 1.0
"""Curves of pins are thinner than those of the present run."""
_FIRST = 100
"""Place from which on `together` gives places to the methods of pins: beyond those of all others."""
_DASHES: tuple[Dash, ...] = ((6, 3), (2, 3), (10, 3, 2, 3), (12, 4), (2, 6), (6, 3, 2, 3, 2, 3))
_PLOTLY_DASHES = ("dash", "dot", "dashdot", "longdash", "2px,6px", "longdashdot")


class Pinned(Protocol):
    """Pin as figures need it; `schuler_bench.session.pins.Pin` is one."""

    @property
    def name(self) -> str:
        """As the user calls it."""
        ...

    @property
    def hex(self) -> str:
        """Colour, ``#RRGGBB``."""
        ...

    @property
    def run(self) -> Run | None:
        """The run; None while it is not known."""
        ...


@dataclass(frozen=True)
class PinnedMethod:
    """One method of a pinned run, as a picture shows it: the pin's colour, a dash for its place.

    Attributes
    ----------
    label : str
        ``pin: method``.
    color : str
        ``#RRGGBB``.
    dash : tuple of int
        For uPlot, px.
    plotly_dash : str
        The same for plotly.
    method : MethodRun
        Its result.
    """

    label: str
    color: str
    dash: Dash
    plotly_dash: str
    method: MethodRun


def pinned_methods(pins: Sequence[Pinned]) -> tuple[PinnedMethod, ...]:
    """All methods of all pins whose runs are known."""
    return tuple(
        PinnedMethod(
            Text("{pin}: {method}", pin=pin.name, method=method.method.name),
            pin.hex,
            _DASHES[place % len(_DASHES)],
            _PLOTLY_DASHES[place % len(_PLOTLY_DASHES)],
            method,
        )
        for pin in pins
        if pin.run is not None
        for place, method in enumerate(pin.run.methods)
    )


def together(run: Run, pins: Sequence[Pinned]) -> Run:
    """One run that holds the methods of all pins too, behind its own, named ``pin: method``.

    For figures that draw loops and networks: units, ranges and legends then fit everything that is shown.
    What belongs to the run as a whole (truth, times) stays the present one's.
    """
    more = tuple(
        replace(
            pinned.method,
            method=pinned.method.method.model_copy(update={"name": pinned.label}),
            place=place,
        )
        for place, pinned in enumerate(pinned_methods(pins), start=_FIRST)
    )
    return replace(run, methods=(*run.methods, *more)) if more else run


def restyled(figure: PlotlyFigure, pins: Sequence[Pinned]) -> PlotlyFigure:
    """Draw what belongs to pins in a figure of `together` thinner and in the pins' colours; in place.

    Traces carry their method's place as ``legendgroup``.
    """
    pinned = {str(place): each for place, each in enumerate(pinned_methods(pins), start=_FIRST)}
    for trace in figure["data"]:
        pin = pinned.get(str(trace.get("legendgroup", "")))
        if pin is None:
            continue
        if "line" in trace:
            line = {"color": pin.color, "width": PIN_WIDTH + 0.2, "dash": pin.plotly_dash}
            trace["line"] = trace["line"] | line
        if "marker" in trace:
            marker = trace["marker"]
            edge = marker.get("line", {})
            if edge.get("color") not in (None, "white"):
                edge = edge | {"color": pin.color, "width": 1.2}
            size = 0.75 * float(marker.get("size", 10))
            trace["marker"] = marker | {"color": pin.color, "line": edge, "size": size}
    # notes that carry a method's place as their name are left out: there is room for the run's own only
    notes = figure["layout"].get("annotations", ())
    figure["layout"]["annotations"] = [note for note in notes if note.get("name") not in pinned]
    return figure


def without_hidden(figure: PlotlyFigure, places: Iterable[int]) -> None:
    """Leave out the curves and notes of methods that are hidden, by their places; in place."""
    gone = set(map(str, places))
    for trace in figure["data"]:
        if trace.get("legendgroup") in gone:
            trace["visible"] = False
    notes = figure["layout"].get("annotations", ())
    figure["layout"]["annotations"] = [note for note in notes if note.get("name") not in gone]


def difference_text(new: float, old: float, unit: Unit) -> str:
    """Difference of two numbers (SI) in a unit and, with its sign, in per cent of the old one."""
    value = number((new - old) / unit.si, 3)
    signed = value if value.startswith("-") or new == old else f"+{value}"
    if not old:
        return signed
    return f"{signed} ({relative(new, old, 1) or '0 %'})"
