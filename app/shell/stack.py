"""Plots over time below each other in a tab."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from schuler_bench.bridge.controls import in_single, show_numbers
from schuler_bench.plots.plotly_data import enlarged_time_plot
from schuler_bench.plots.uplot import UplotFigure
from schuler_bench.shell.layout import CHOOSER_PX, Layout
from schuler_bench.shell.view import Tab

if TYPE_CHECKING:
    import viser

_LEGEND_PX = {False: 30, True: 47}
"""Height of a legend of one row for a mouse, and for a finger."""


class Stack:
    """Plots below each other in a tab, kept while only their numbers change."""

    def __init__(self, gui: viser.GuiApi, tab: Tab) -> None:
        self._gui, self._tab = gui, tab
        self._held: dict[str, tuple[tuple[Any, ...], viser.GuiUplotHandle]] = {}

    def show(
        self, figures: Sequence[UplotFigure], heights: Sequence[int], labelled: int, scale: float = 1.0
    ) -> None:
        """Show these plots, enlarged by ``scale``; the last ``labelled`` ones carry the time axis."""
        keys = [figure.key for figure in figures]
        for key in [key for key in self._held if key not in keys]:
            self._held.pop(key)[1].remove()
        for order, (figure, height) in enumerate(zip(figures, heights, strict=True)):
            self._show(figure, order, height, scale, last=order >= len(figures) - labelled)

    def _show(self, figure: UplotFigure, order: int, height: int, scale: float, *, last: bool) -> None:
        config = (*figure.config_key(), order, height, last, scale)
        held = self._held.get(figure.key)
        if held is not None and held[0] == config:
            show_numbers(held[1], figure.data)
            return
        if held is not None:
            held[1].remove()
        arguments = enlarged_time_plot(figure.kwargs(height=height, time_axis=last, legend=False), scale)
        arguments["data"] = in_single(figure.data)
        with self._tab:
            self._held[figure.key] = config, self._gui.add_uplot(**arguments, order=10 + order)


def room_px(layout: Layout) -> int:
    """Height for plots below a chooser, which a view alone does not have, and a legend of one row.

    The page lets them fill what the texts leave (static/room.js).
    """
    chooser = 0 if layout.alone else CHOOSER_PX
    return layout.room_px - chooser - _LEGEND_PX[layout.touch]
