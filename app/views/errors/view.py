"""Tab "Errors": the error curves of a run, in small plots of all quantities or larger ones of a few."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import accumulate
from typing import Any

import numpy as np

from navcore.engine.run import Run
from navcore.foundation.text import Text, quoted
from schuler_bench.plots import style
from schuler_bench.plots.envelope import Envelope
from schuler_bench.plots.legend import COMMAND, entry
from schuler_bench.plots.pinned import Pinned, pinned_methods
from schuler_bench.plots.table import cell
from schuler_bench.plots.uplot import LABEL_SIZE, Y_SIZE, Dash, UplotFigure, stack_heights
from schuler_bench.session.display import CURVES, Display
from schuler_bench.session.requirements import error_limits
from schuler_bench.session.shown import Shown, Verified
from schuler_bench.shell import notices
from schuler_bench.shell.layout import TOOLS
from schuler_bench.shell.stack import Stack, room_px
from schuler_bench.shell.view import Figures, Frame, PictureView, Tab, if_user
from schuler_bench.views.errors.figure import (
    STACKS,
    STRAPDOWN,
    TITLES,
    VERIFIED,
    Overlay,
    error_plots,
    legend_name,
    verification_plots,
)


def legend_html(
    run: Run,
    overlay: Overlay | None = None,
    pins: Sequence[Pinned] = (),
    envelope: Envelope | None = None,
    display: Display | None = None,
    *,
    methods: bool = True,
) -> str:
    """One legend for a stack of plots: a bar and a name each; a click dims or hides a curve.

    Without ``methods`` it leaves out those of the run itself, which the strip of results names; "" where that
    leaves nothing.
    """
    state_of = (display or Display()).state_of
    items = [
        entry(
            method.method.name,
            legend_name(method),
            f"height:3px;background:{style.method_color(method.place)}",
            state_of(method.method.name),
        )
        for method in run.lines
        if methods
    ]
    if overlay is not None:
        old = Text(" of an earlier scenario") if overlay.old else ""
        items.append(
            _legend_item(
                Text("{strapdown}{old}", strapdown=STRAPDOWN, old=old),
                f"border-top:3px dashed {style.MUTED}",
            )
        )
    items += [
        entry(pin.label, pin.label, css_dash(pin.dash, pin.color), state_of(pin.label))
        for pin in pinned_methods(pins)
    ]
    if envelope is not None:
        bar = f"height:10px;background:{style.MUTED}{'22' if envelope.old else '55'}"
        items.append(_legend_item(envelope.label, bar, Text.joined(" ", envelope.details)))
    if not items:
        return ""
    return Text(
        '<div class="sb-legend" role="group" aria-label="legend" style="padding-left:{y_size}px">'
        "{items}</div>",
        y_size=Y_SIZE + LABEL_SIZE,
        items=Text.joined("", items),
    )


def css_dash(dash: Dash, color: str) -> str:
    """Style of a short bar that shows a dash pattern."""
    ends = [0, *accumulate(dash)]
    shades = (color if place % 2 == 0 else "transparent" for place in range(len(dash)))
    stops = (f"{shade} {start}px {end}px" for shade, start, end in zip(shades, ends, ends[1:], strict=False))
    return f"height:2px;background:repeating-linear-gradient(90deg,{','.join(stops)})"


def _legend_item(name: str, bar: str, title: str = "") -> str:
    return cell(
        cell("", "sb-line", tag="span", style=bar) + quoted(name), "sb-entry", tag="span", title=title
    )


OVERVIEW = Text("Overview")
VERIFICATION = Text("Verification")
NOT_VERIFIED = Text('There is nothing to compare yet: press "Verify with full strapdown".')
OWN_NOISE = Text(
    "Left: the linear model (solid) and the full strapdown (dashed) on the noise of the verification, "
    "which is another draw than the run's. Right: strapdown minus linear model."
)
ALL = Text("All errors, small")
_GROUPS: dict[str, str] = {
    OVERVIEW: "overview",
    ALL: "all",
    **STACKS,
    VERIFICATION: "verification",
}
"""Titles of the groups of `schuler_bench.session.display.CURVES`."""
_OF_THE_STEP = Text("Those of the lesson")
_MOST_STACKED = 3
"""More plots than these stand two abreast."""
_TWO = '<div class="sb-two"></div>'
_KEYS: dict[str, str] = {Text("Errors: {title}", title=title): key for key, title in TITLES.items()}
_VERIFIED_KEYS: dict[str, str] = {
    Text("{verification}: {titles}{part}", verification=VERIFICATION, titles=TITLES[key], part=part): Text(
        "{which}_{key}", which=which, key=key
    )
    for key in VERIFIED
    for which, part in (("both", ""), ("difference", Text(", difference")))
}


@dataclass(frozen=True)
class ErrorCurves:
    """Plots of error quantities, with their legend.

    Attributes
    ----------
    plots : dict
        Key -> plot over time, in the order in which they are shown.
    legend : str
        HTML of their legend.
    two_abreast : bool
        The plots stand in two columns.
    """

    plots: dict[str, UplotFigure]
    legend: str
    two_abreast: bool = False


class ErrorsView(PictureView[ErrorCurves]):
    """Chooser of the quantities, legend and plots."""

    title = Text("Errors")
    place = "lower"
    tab = Text("Errors")
    mode = Text("Time")
    look_for = Text(
        "Look for curves that stay small, and for what the switch-on and the manoeuvres leave behind. "
        "A click with Shift sets a second cursor: then the plots tell differences."
    )
    focus = "errors"
    plots = (*_KEYS, *_VERIFIED_KEYS)

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        frame.commands.register(COMMAND, self._clicked)

    def _clicked(self, key: str) -> None:
        """Show a curve otherwise: its entry in a legend was clicked."""
        self.frame.show(legend=self.session.display.clicked(key))

    def build(self, tab: Tab) -> None:
        """Make chooser and legend."""
        gui = self.frame.gui
        self._stack = Stack(gui, tab)
        with tab:
            self._group: Any = gui.add_dropdown(
                Text("curves"),
                tuple(_GROUPS),
                hint=Text(
                    "Overview: length of tilt and velocity error, tilt about east, position error. All "
                    "errors: every component. Attitude, Velocity, Position: larger plots of a few. "
                    "A limit is a dashed line: drag it to set the limit. Verification: the full "
                    "strapdown beside the linear model, and their difference."
                ),
                order=0,
            )
            gui.add_html(TOOLS, order=0)
            self._legend = gui.add_html("", order=1)
        self._group.on_update(if_user(self._choose))
        self.follow_display()

    def _choose(self) -> None:
        if self._group.value in _GROUPS:
            self.frame.show(curves=_GROUPS[self._group.value])

    def follow_display(self) -> None:
        """Show which curves the display has."""
        curves = self.session.display.curves
        title = next((title for title, group in _GROUPS.items() if group == curves), _OF_THE_STEP)
        options = (*_GROUPS, *([_OF_THE_STEP] if title is _OF_THE_STEP else []))
        if tuple(self._group.options) != options:
            self._group.options = options
        self._group.value = title

    def picture(self, found: Shown) -> ErrorCurves:
        """Make the plots of the chosen quantities."""
        display = found.display
        methods = self.frame.layout().alone
        if display.curves == "verification":
            return _verified_curves(found.verified, display, methods=methods)
        curves = error_curves(found, display.chosen_curves, methods=methods)
        plots = moving(curves.plots) if display.lesson else curves.plots
        return replace(curves, plots=plots, two_abreast=len(plots) > _MOST_STACKED)

    def show(self, picture: ErrorCurves) -> None:
        """Show the plots that are chosen, below their legend."""
        layout, plots = self.frame.layout(), list(picture.plots.values())
        room = room_px(layout)
        abreast = 2 if picture.two_abreast else 1
        heights = [each for each in stack_heights(room, -(-len(plots) // abreast)) for _ in range(abreast)]
        heights = heights[: len(plots)]
        self._legend.content = (_TWO if picture.two_abreast else "") + picture.legend
        self._stack.show(plots, heights, labelled=abreast, scale=layout.scale)

    def figures(self, found: Shown, plot: str) -> Figures:
        """Make the plot of one quantity: of the run, or of its verification."""
        if plot in _VERIFIED_KEYS:
            if found.verified is None:
                raise LookupError(NOT_VERIFIED)
            return None, [_verified_curves(found.verified, found.display).plots[_VERIFIED_KEYS[plot]]]
        return None, [error_curves(found).plots[_KEYS[plot]]]

    def sheet(self, found: Shown) -> list[tuple[str, Figures]]:
        """Attitude, velocity and position, each in one picture; both models of a verification."""
        plots = error_curves(found).plots
        pictures: list[tuple[str, Figures]] = [
            (Text("Errors: {name}", name=name), (None, [plots[key] for key in CURVES[group]]))
            for name, group in STACKS.items()
        ]
        if found.verified is not None:
            both = _verified_curves(found.verified, found.display).plots
            pictures.append((VERIFICATION, (None, [both[f"both_{key}"] for key in VERIFIED])))
        return pictures


def error_curves(found: Shown, keys: Sequence[str] = tuple(TITLES), *, methods: bool = True) -> ErrorCurves:
    """Error curves of what is shown, with pins, envelope and limits."""
    plots = error_plots(
        found.run,
        display=found.display,
        pins=found.pins,
        envelope=found.envelope,
        limits=error_limits(found.run.scenario.requirement, found.run),
    )
    legend = legend_html(found.run, None, found.pins, found.envelope, found.display, methods=methods)
    return ErrorCurves({key: plots[key] for key in keys}, legend)


def moving(plots: dict[str, UplotFigure]) -> dict[str, UplotFigure]:
    """Plots of a lesson's step: those without a curve that is not zero throughout are left out."""
    return {
        key: plot
        for key, plot in plots.items()
        if any(np.any(np.nan_to_num(curve.values)) for curve in plot.curves)
    } or plots


def _verified_curves(verified: Verified | None, display: Display, *, methods: bool = True) -> ErrorCurves:
    """Both models on the verification's noise, beside their difference; without a verification no plot."""
    if verified is None:
        return ErrorCurves({}, notices.note([NOT_VERIFIED], "info"))
    verification = verified.verification
    overlay = Overlay(verification.strapdown, verified.old)
    return ErrorCurves(
        verification_plots(verification, old=verified.old, display=display),
        notices.note([OWN_NOISE], "info")
        + legend_html(verification.linear, overlay, display=display, methods=methods),
        two_abreast=True,
    )


VIEW = ErrorsView
