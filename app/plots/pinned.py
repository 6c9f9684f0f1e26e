"""Pinned runs beside the present one: laid over its figures, and subtracted in the table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol

from app.plots.plotly_data import PlotlyFigure
from app.plots.units import Unit, number
from app.plots.uplot import Dash
from navcore.engine.run import MethodRun, Run

PIN_WIDTH = 1.0
"""Curves of pins are thinner than those of the present run."""
_DASHES: tuple[Dash, ...] = ((6, 3), (2, 3), (10, 3, 2, 3), (12, 4), (2, 6), (6, 3, 2, 3, 2, 3))
_PLOTLY_DASHES = ("dash", "dot", "dashdot", "longdash", "2px,6px", "longdashdot")


class Pinned(Protocol):
    """What a figure needs of a pin; `app.session.pins.Pin` is one."""

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
            f"{pin.name}: {method.method.name}",
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
        )
        for pinned in pinned_methods(pins)
    )
    return replace(run, methods=(*run.methods, *more)) if more else run


def restyled(figure: PlotlyFigure, run: Run, pins: Sequence[Pinned]) -> PlotlyFigure:
    """Draw what belongs to pins in a figure of `together` thinner and in the pins' colours; in place.

    Traces carry their method's place as ``legendgroup``.
    """
    shown = pinned_methods(pins)
    first = len(run.methods)
    for trace in figure["data"]:
        group = str(trace.get("legendgroup", ""))
        if not group.isdigit() or not first <= int(group) < first + len(shown):
            continue
        pinned = shown[int(group) - first]
        if "line" in trace:
            trace["line"] = trace["line"] | {
                "color": pinned.color,
                "width": PIN_WIDTH + 0.2,
                "dash": pinned.plotly_dash,
            }
        if "marker" in trace:
            trace["marker"] = _restyled_marker(trace["marker"], pinned.color)
    notes = figure["layout"].get("annotations")
    if notes:  # notes that carry a method's place as their name are left out: there is room for its own only
        figure["layout"]["annotations"] = [note for note in notes if not _is_pinned(note, first)]
    return figure


def _is_pinned(note: dict[str, Any], first: int) -> bool:
    name = str(note.get("name", ""))
    return name.isdigit() and int(name) >= first


def _restyled_marker(marker: dict[str, Any], color: str) -> dict[str, Any]:
    line = marker.get("line", {})
    if line.get("color") not in (None, "white"):
        line = line | {"color": color, "width": 1.2}
    return marker | {"color": color, "line": line, "size": 0.75 * float(marker.get("size", 10))}


@dataclass(frozen=True)
class Delta:
    """A number of the present run minus that of the baseline.

    Attributes
    ----------
    absolute : float
        Difference, SI.
    percent : float or None
        Part of the baseline's number, %; None where that is zero.
    """

    absolute: float
    percent: float | None

    def text(self, unit: Unit) -> str:
        """Difference in a unit and in per cent, with signs."""
        value = number(self.absolute / unit.si, 3)
        signed = value if value.startswith("-") or self.absolute == 0.0 else f"+{value}"
        if self.percent is None:
            return signed
        return f"{signed} ({self.percent:+.1f} %)" if self.percent else f"{signed} (0 %)"


def deltas(run: Run, baseline: Run, quantity: str, statistic: str) -> tuple[Delta | None, ...]:
    """For every method its number minus that of the baseline's method of the same name; None without one.

    Parameters
    ----------
    run, baseline : Run
        Present and pinned.
    quantity, statistic : str
        Keys of `navcore.engine.run.MethodRun.errors`.
    """
    before = {method.method.name: method for method in baseline.methods}
    found: list[Delta | None] = []
    for method in run.methods:
        other = before.get(method.method.name)
        if other is None:
            found.append(None)
            continue
        old, new = other.errors[quantity][statistic], method.errors[quantity][statistic]
        found.append(Delta(new - old, 100.0 * (new - old) / abs(old) if old else None))
    return tuple(found)
