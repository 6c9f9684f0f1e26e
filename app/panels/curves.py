"""Stacks of plots over time in a tab: error curves, and the switching view below one of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from app.background.verifier import Verified
from app.figures import style
from app.figures.errors import GROUPS, Overlay
from app.figures.switching import legend_names, switching_legend
from app.figures.uplot import UplotFigure, stack_heights
from app.page.layout import CHOOSER_PX, Layout
from navcore.run import Run

if TYPE_CHECKING:
    import viser

OVERVIEW = "Overview"
_OVERVIEW_KEYS = ("phi_e", "dve", "phi_n", "dvn", "phi_u", "position")
"""Two abreast: attitude left, velocity and position right."""
_LEGEND_ROW_PX = 23
_LEGEND_MARGIN_PX = 7
_LEGEND_INDENT_PX = 90
_TWO = '<div class="sb-two"></div>'
_FIRST_ABOVE = "dve"
_LEAST_PX = 64


class _Stack:
    """Plots below each other in a tab, kept while only their numbers change."""

    def __init__(self, gui: viser.GuiApi, tab: viser.GuiTabHandle) -> None:
        self._gui, self._tab = gui, tab
        self._held: dict[str, tuple[tuple[Any, ...], viser.GuiUplotHandle]] = {}

    def show(self, figures: Sequence[UplotFigure], heights: Sequence[int], labelled: int) -> None:
        """Show these plots; the last ``labelled`` ones carry the time axis."""
        keys = [figure.key for figure in figures]
        for key in [key for key in self._held if key not in keys]:
            self._held.pop(key)[1].remove()
        for order, (figure, height) in enumerate(zip(figures, heights, strict=True)):
            self._show(figure, order, height, last=order >= len(figures) - labelled)

    def _show(self, figure: UplotFigure, order: int, height: int, *, last: bool) -> None:
        config = (*figure.config_key(), order, height, last)
        held = self._held.get(figure.key)
        if held is not None and held[0] == config:
            held[1].data = figure.data
            return
        if held is not None:
            held[1].remove()
        arguments = figure.kwargs(height=height, time_axis=last, legend=False)
        with self._tab:
            self._held[figure.key] = config, self._gui.add_uplot(**arguments, order=10 + order)


def curves_of(run: Run, verified: Verified | None) -> tuple[Run, Overlay | None]:
    """Run whose curves are drawn, and what is drawn over them.

    The strapdown's noise is that of the linear run made beside it: as long as the scenario is the same, that
    run is drawn, so that what is between two curves is the model's alone.
    """
    if verified is None:
        return run, None
    overlay = Overlay(verified.verification.strapdown, verified.old)
    return (run if verified.old else verified.verification.linear), overlay


class ErrorCurves:
    """Tab "Errors".

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    tab : viser.GuiTabHandle
        Where it stands.
    layout : Layout
        Sizes.
    choose : callable
        ``choose()`` when other curves are wanted.
    """

    def __init__(
        self, gui: viser.GuiApi, tab: viser.GuiTabHandle, layout: Layout, choose: Callable[[], None]
    ) -> None:
        self._layout = layout
        self._stack = _Stack(gui, tab)
        with tab:
            groups = (OVERVIEW, *(name for name in GROUPS if name != OVERVIEW))
            self._group = gui.add_dropdown(
                "curves", groups, hint="Overview: one small plot a quantity; else larger ones.", order=0
            )
            self._legend = gui.add_html("", order=1)
        self._group.on_update(lambda event: choose() if event.client is not None else None)

    def show(self, plots: dict[str, UplotFigure], legend: str, names: list[str]) -> None:
        """Show the chosen ones of `error_plots` below their legend, in which these names stand."""
        room = _room(self._layout, names)
        overview = self._group.value == OVERVIEW
        if overview:
            keys = _OVERVIEW_KEYS
            heights = [each for each in stack_heights(room, len(keys) // 2) for _ in range(2)]
        else:
            keys = GROUPS[self._group.value]
            heights = list(stack_heights(room, len(keys)))
        self._legend.content = (_TWO if overview else "") + legend
        self._stack.show([plots[key] for key in keys], heights, labelled=2 if overview else 1)


class SwitchingView:
    """Tab "Switching": an error curve, and on the same time axis when and why each method damps.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    tab : viser.GuiTabHandle
        Where it stands.
    layout : Layout
        Sizes.
    choose : callable
        ``choose()`` when another curve is wanted.
    """

    def __init__(
        self, gui: viser.GuiApi, tab: viser.GuiTabHandle, layout: Layout, choose: Callable[[], None]
    ) -> None:
        self._layout = layout
        self._stack = _Stack(gui, tab)
        self._titles: dict[str, str] = {}
        with tab:
            self._above: Any = gui.add_dropdown(
                "curve above", ("",), order=0, hint="Error curve over the states and thresholds."
            )
            self._legend = gui.add_html("", order=1)
        self._above.on_update(lambda event: choose() if event.client is not None else None)

    def show(self, plots: dict[str, UplotFigure], switching: Sequence[UplotFigure], run: Run) -> None:
        """Show one of `error_plots` above `switching_plots`."""
        titles = {plot.title: key for key, plot in plots.items()}
        if titles != self._titles:
            self._titles = titles
            self._above.options = tuple(titles)
            self._above.value = plots[_FIRST_ABOVE].title
        figures = [plots[titles[self._above.value]], *switching]
        self._legend.content = switching_legend(run)
        heights = stack_heights(_room(self._layout, legend_names(run)), len(figures), _LEAST_PX)
        self._stack.show(figures, heights, labelled=1)


def _room(layout: Layout, names: list[str]) -> int:
    """Height for plots below a chooser and a legend of these names."""
    rows = style.legend_rows(names, layout.plot_px - _LEGEND_INDENT_PX)
    return layout.room_px - CHOOSER_PX - _LEGEND_MARGIN_PX - rows * _LEGEND_ROW_PX
