"""The right column: frequency, poles, step, error curves, metrics and the scenario as text."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

from app import notices
from app.figures import style
from app.figures.errors import GROUPS, UplotFigure, error_plots, legend_html, stack_heights
from app.figures.frequency import TRANSFERS, bode
from app.figures.plotly_data import PlotlyFigure
from app.figures.poles import poles
from app.figures.step import step
from app.figures.table import metrics_html
from app.figures.warnings import notices_for, severity, warnings_for
from app.layout import CHOOSER_PX, Layout
from navcore.run import Run

if TYPE_CHECKING:
    import viser

FREQUENCY, POLES, STEP, ERRORS, METRICS, SCENARIO = (
    "Frequency",
    "Poles",
    "Step",
    "Errors",
    "Metrics",
    "Scenario",
)
TABS: tuple[str, ...] = (FREQUENCY, POLES, STEP, ERRORS, METRICS, SCENARIO)
OVERVIEW = "Overview"
_OVERVIEW_KEYS = ("phi_e", "dve", "phi_n", "dvn", "phi_u", "position")
"""Two abreast: attitude left, velocity and position right."""
_LEGEND_ROW_PX = 23
_LEGEND_MARGIN_PX = 7
_LEGEND_INDENT_PX = 90
_METHOD_PX = {True: 215, False: 187}
"""Width of a method in the table of metrics: in the large print of a wide window, in the small one."""
_ROW_NAME_PX = 110
_TWO = '<div class="sb-two"></div>'


@dataclass(frozen=True)
class Pictures:
    """Figures of a run for the tabs in front, made before anything is sent.

    Attributes
    ----------
    run : Run
        The run.
    plotly : dict
        Tab -> figure.
    curves : dict
        Key -> plot over time; empty when they are not in front.
    """

    run: Run
    plotly: dict[str, PlotlyFigure]
    curves: dict[str, UplotFigure]
    table: str
    toml: str


class ResultsPanel:
    """Tabs of figures in one or two panels.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    layout : Layout
        Sizes.
    transfer : str
        Transfer to show first.
    choose_transfer : callable
        ``choose_transfer(id)``.
    choose_group : callable
        ``choose_group()`` when other error curves are wanted.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        layout: Layout,
        transfer: str,
        choose_transfer: Callable[[str], None],
        choose_group: Callable[[], None],
    ) -> None:
        self._gui = gui
        self.layout = layout
        self._panels = self._place(gui, layout)
        upper, lower = self._panels[0], self._panels[-1]
        tabs = {name: (upper if name in TABS[:3] else lower).add_tab(name) for name in TABS}
        self._labels = {label: id for id, label in TRANSFERS.items()}
        with tabs[FREQUENCY]:
            self._transfer = gui.add_dropdown(
                "transfer", tuple(self._labels), initial_value=TRANSFERS[transfer],
                hint="Shown at the right, beside the network H.",
            )  # fmt: skip
            self._transfer.on_update(
                lambda event: choose_transfer(self._labels[self._transfer.value]) if event.client else None
            )
        self._plots: dict[str, viser.GuiPlotlyHandle] = {}
        self._tabs = tabs
        self._curves: dict[str, tuple[tuple[Any, ...], viser.GuiUplotHandle]] = {}
        with tabs[ERRORS]:
            groups = (OVERVIEW, *(name for name in GROUPS if name != OVERVIEW))
            self._group = gui.add_dropdown(
                "curves", groups, hint="Overview: one small plot a quantity; else larger ones.", order=0
            )
            self._legend = gui.add_html("", order=1)
        self._group.on_update(lambda event: choose_group() if event.client is not None else None)
        with tabs[METRICS]:
            self._table = gui.add_html("")
            self._warnings = gui.add_html("")
        with tabs[SCENARIO]:
            self._toml = gui.add_html("")

    @staticmethod
    def _place(gui: viser.GuiApi, layout: Layout) -> list[viser.PanelHandle]:
        upper = gui.add_panel()
        upper.dock_right()
        panels = [upper]
        if layout.wide:
            lower = gui.add_panel()
            lower.dock_below(upper)
            panels.append(lower)
        upper.set_width(layout.right_px)
        return panels

    def remove(self) -> None:
        """Take the panels off the page."""
        for panel in self._panels:
            panel.remove()

    # ------------------------------------------------------------ making

    def make(self, run: Run, number: int, transfer: str, wanted: set[str]) -> Pictures:
        """Make the figures of the wanted tabs; each plotly figure carries the run's number in its layout."""
        below_chooser, full = self.layout.aspect(CHOOSER_PX), self.layout.aspect()
        width = float(self.layout.plot_px)
        makers: dict[str, Callable[[], PlotlyFigure]] = {
            FREQUENCY: lambda: bode(run, transfer, below_chooser, width_px=width),
            POLES: lambda: poles(run, full, width_px=width),
            STEP: lambda: step(run, full, width_px=width),
        }
        from navcore.scenario_file import to_toml

        plotly = {tab: make() for tab, make in makers.items() if tab in wanted}
        for figure in plotly.values():
            figure["layout"]["meta"] = {"run": number}
        return Pictures(
            run=run,
            plotly=plotly,
            curves=error_plots(run) if ERRORS in wanted else {},
            table=self._make_table(run) if METRICS in wanted else "",
            toml=to_toml(run.scenario) if SCENARIO in wanted else "",
        )

    def _make_table(self, run: Run) -> str:
        """Metrics of all methods, in as many tables below each other as the width asks for."""
        most = max((self.layout.plot_px - _ROW_NAME_PX) // _METHOD_PX[self.layout.wide], 1)
        count = len(run.methods)
        tables = -(-count // most)
        each = -(-count // tables)
        parts = (range(first, min(first + each, count)) for first in range(0, count, each))
        return "".join(f'<div style="margin-bottom:14px">{metrics_html(run, part)}</div>' for part in parts)

    # ------------------------------------------------------------ showing

    def show(self, pictures: Pictures) -> None:
        """Send the figures."""
        for tab, figure in pictures.plotly.items():
            plot = self._plots.get(tab)
            if plot is None:
                aspect = self.layout.aspect(CHOOSER_PX if tab == FREQUENCY else 0)
                with self._tabs[tab]:
                    self._plots[tab] = self._gui.add_plotly(figure, aspect=aspect)  # pyright: ignore[reportArgumentType]
            else:
                plot.figure = figure  # pyright: ignore[reportAttributeAccessIssue]
        if pictures.curves:
            self._show_curves(pictures)
        if pictures.table:
            narrow = "" if self.layout.wide else " sb-narrow"
            self._table.content = (
                f'<div class="sb-table{narrow}" style="padding:4px 10px">{pictures.table}</div>'
            )
            self._warnings.content = _warnings_html(pictures.run)
        if pictures.toml:
            self._toml.content = (
                f'<pre style="margin:4px 12px;font-size:12.5px;line-height:1.4;white-space:pre-wrap">'
                f"{escape(pictures.toml)}</pre>"
            )

    def _show_curves(self, pictures: Pictures) -> None:
        keys, heights = self._wanted_curves([m.method.name for m in pictures.run.methods])
        for key in [key for key in self._curves if key not in keys]:
            self._curves.pop(key)[1].remove()
        two = len(keys) == len(_OVERVIEW_KEYS)
        self._legend.content = (_TWO if two else "") + legend_html(pictures.run)
        for order, (key, height) in enumerate(zip(keys, heights, strict=True)):
            self._show_curve(pictures.curves[key], order, height, last=order >= len(keys) - (2 if two else 1))

    def _wanted_curves(self, names: list[str]) -> tuple[tuple[str, ...], tuple[int, ...]]:
        rows = style.legend_rows(names, self.layout.plot_px - _LEGEND_INDENT_PX)
        room = self.layout.room_px - CHOOSER_PX - _LEGEND_MARGIN_PX - rows * _LEGEND_ROW_PX
        if self._group.value == OVERVIEW:
            each = stack_heights(room, len(_OVERVIEW_KEYS) // 2)
            return _OVERVIEW_KEYS, tuple(height for height in each for _ in range(2))
        keys = GROUPS[self._group.value]
        return keys, stack_heights(room, len(keys))

    def _show_curve(self, figure: UplotFigure, order: int, height: int, *, last: bool) -> None:
        config = (*figure.config_key(), height, last)
        held = self._curves.get(figure.key)
        if held is not None and held[0] == config:
            held[1].data = figure.data
            return
        if held is not None:
            held[1].remove()
        arguments = figure.kwargs(height=height, time_axis=last, legend=False)
        with self._tabs[ERRORS]:
            self._curves[figure.key] = config, self._gui.add_uplot(**arguments, order=10 + order)


def _warnings_html(run: Run) -> str:
    parts = [notices.note(notices_for(run), "info")]
    for index, texts in warnings_for(run).items():
        name = run.methods[index].method.name
        parts.append(notices.note([f"{name}: {text}" for text in texts], severity(run, index) or "warning"))
    return f'<div style="padding-top:10px;color:{style.INK}">{"".join(parts)}</div>'
