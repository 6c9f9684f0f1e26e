"""The right column: what the networks do, the misprints, the curves of a run, its numbers and text."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

from app.background.verifier import Verified
from app.figures import style
from app.figures.compare import restyled, together
from app.figures.errors import QUANTITIES, error_plots, legend_html, legend_names
from app.figures.frequency import SHOWN, frequency_view
from app.figures.plotly_data import PlotlyFigure
from app.figures.poles import poles
from app.figures.requirements import allowed_poles, requirements_html, step_limits
from app.figures.spectrum import spectrum
from app.figures.step import step
from app.figures.switching import switched_methods, switching_plots
from app.figures.table import metrics_html, verdict
from app.figures.uplot import UplotFigure
from app.figures.warnings import notices_for, severity, warnings_for
from app.page import notices
from app.page.layout import CHOOSER_PX, Layout
from app.panels.compare import COMPARE, ComparePanel, Comparing
from app.panels.curves import ErrorCurves, SwitchingView, curves_of
from app.panels.laboratory import Laboratory
from app.panels.requirements import REQUIREMENTS, RequirementsPanel
from app.panels.workbench import FrequencyTools, PoleTools, Tools
from app.session.display import Display
from app.session.requirements import error_limits
from app.session.shown import Shown
from navcore.run import Run
from navcore.scenario import Method

if TYPE_CHECKING:
    import viser

FREQUENCY, POLES, STEP, MISPRINTS = "Frequency", "Poles", "Step", "Misprints"
ERRORS, METRICS, SCENARIO, SWITCHING = "Errors", "Metrics", "Scenario", "Switching"
SPECTRUM, SPECTRUM_OF = "Spectrum", "spectrum of"
_UPPER = (FREQUENCY, POLES, STEP, MISPRINTS)
TABS: tuple[str, ...] = (*_UPPER, ERRORS, METRICS, COMPARE, SPECTRUM, REQUIREMENTS, SCENARIO)
"""Tabs that are always there; `SWITCHING` stands beside the errors while a method switches."""
PICTURED = {*TABS, SWITCHING} - {MISPRINTS, COMPARE}
"""Tabs whose contents follow the run."""
_METHOD_PX = {True: 215, False: 187}
"""Width of a method in the table of metrics: in the large print of a wide window, in the small one."""
_ABOVE_PX = {STEP: 0, POLES: CHOOSER_PX + 10}
"""Room for what stands above a plot; elsewhere a chooser."""
_DELTA_PX = {True: 150, False: 125}
_ROW_NAME_PX = 110


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
    legend : str
        HTML of their legend.
    legend_names : list of str
        Texts in it.
    switching : tuple of UplotFigure
        Measures, states and xi of the methods that switch; empty when they are not in front.
    switches : bool
        A method of the run switches.
    table, toml, requirements : str
        HTML of the metrics, text of the scenario, HTML of the verdicts; empty when they are not in front.
    verified : Verified or None
        Verification of the same methods.
    """

    run: Run
    plotly: dict[str, PlotlyFigure]
    curves: dict[str, UplotFigure]
    legend: str
    legend_names: list[str]
    switching: tuple[UplotFigure, ...]
    switches: bool
    table: str
    toml: str
    requirements: str
    verified: Verified | None


class ResultsPanel:
    """Tabs of figures in one or two panels.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    layout : Layout
        Sizes.
    display : Display
        What is to be shown first.
    tools : Tools
        What the workbench's controls do.
    choose_transfer : callable
        ``choose_transfer(id)``.
    choose_curves : callable
        ``choose_curves()`` when other curves are wanted.
    comparing : Comparing
        What is done with pins.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        layout: Layout,
        display: Display,
        tools: Tools,
        choose_transfer: Callable[[str], None],
        choose_curves: Callable[[], None],
        comparing: Comparing,
    ) -> None:
        self._gui = gui
        self.layout = layout
        self._panels = self._place(gui, layout)
        self._choose_curves = choose_curves
        upper, lower = self._panels[0], self._panels[-1]
        tabs = {name: (upper if name in _UPPER else lower).add_tab(name) for name in TABS}
        self._labels = {label: id for id, label in SHOWN.items()}
        with tabs[FREQUENCY]:
            self._transfer = gui.add_dropdown(
                "transfer", tuple(self._labels), initial_value=SHOWN[display.transfer],
                hint="Shown at the right, beside the network H; or the open loop with its margins.",
            )  # fmt: skip
            self._frequency_tools = FrequencyTools(gui, tools, display)
            self._transfer.on_update(
                lambda event: choose_transfer(self._labels[self._transfer.value]) if event.client else None
            )
        with tabs[POLES]:
            self._pole_tools = PoleTools(gui, tools, display)
        self.requirements = RequirementsPanel(gui, tabs[REQUIREMENTS], layout, display, tools)
        self._plots: dict[str, viser.GuiPlotlyHandle] = {}
        self._tabs = tabs
        self.laboratory = Laboratory(gui, tabs[MISPRINTS], layout)
        self._errors = ErrorCurves(gui, tabs[ERRORS], layout, choose_curves)
        self._switching: SwitchingView | None = None
        self.compare = ComparePanel(gui, tabs[COMPARE], comparing)
        titles = {title: key for key, title in QUANTITIES.items()}
        with tabs[SPECTRUM]:
            self._spectrum: Any = gui.add_dropdown(
                SPECTRUM_OF, tuple(titles), initial_value=QUANTITIES[display.spectrum],
                hint="Amplitude over period: a sine shows as a peak of its amplitude.",
            )  # fmt: skip
        self._spectrum.on_update(
            lambda event: tools.show(spectrum=titles[self._spectrum.value]) if event.client else None
        )
        with tabs[METRICS]:
            self._table = gui.add_html("")
            self._why = gui.add_html("")
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

    def follow(self, display: Display, method: Method) -> None:
        """Let the choosers show what is drawn; ``method`` is the one that the controls edit."""
        self._transfer.value = SHOWN[display.transfer]
        self._frequency_tools.follow(display)
        self._pole_tools.follow(display, method)
        self.requirements.follow(display)
        self._spectrum.value = QUANTITIES[display.spectrum]
        self.compare.show()

    def show_why(self, html: str) -> None:
        """Say below the metrics what dominates them."""
        if self._why.content != html:
            self._why.content = html

    def remove(self) -> None:
        """Take the panels off the page."""
        for panel in self._panels:
            panel.remove()

    # ------------------------------------------------------------ making

    def make(self, found: Shown, wanted: set[str], selected: int = 0) -> Pictures:
        """Make the figures of the wanted tabs; each plotly figure carries the run's number and its tab."""
        run, display, verified, pins = found.run, found.display, found.verified, found.pins
        both = together(run, pins)
        width, asked = float(self.layout.plot_px), display.requirements
        makers: dict[str, Callable[[], PlotlyFigure]] = {
            FREQUENCY: lambda: frequency_view(
                both, display.transfer, self._aspect(FREQUENCY), width_px=width, discrete=display.discrete
            ),
            POLES: lambda: poles(
                both,
                self._aspect(POLES),
                width_px=width,
                selected=selected,
                locus=display.locus,
                allowed=allowed_poles(asked),
            ),
            SPECTRUM: lambda: spectrum(
                both, display.spectrum, self._aspect(SPECTRUM), display=display, width_px=width
            ),
            STEP: lambda: step(both, self._aspect(STEP), width_px=width, limits=step_limits(asked)),
        }
        from navcore.scenario_file import to_toml

        plotly = {tab: make() for tab, make in makers.items() if tab in wanted}
        for tab, figure in plotly.items():
            restyled(figure, run, pins)
            figure["layout"]["meta"] = figure["layout"]["meta"] | {"run": found.number, "view": tab}
        drawn, overlay = curves_of(run, verified)
        return Pictures(
            run=run,
            plotly=plotly,
            curves=error_plots(
                drawn,
                overlay,
                display=display,
                pins=pins,
                envelope=found.envelope,
                limits=error_limits(asked, run),
            )
            if wanted & {ERRORS, SWITCHING}
            else {},
            legend=legend_html(drawn, overlay, pins, found.envelope),
            legend_names=legend_names(drawn, overlay, pins, found.envelope),
            switching=switching_plots(drawn, display.time) if SWITCHING in wanted else (),
            switches=bool(switched_methods(run)),
            table=self._make_table(found) if METRICS in wanted else "",
            toml=to_toml(run.scenario) if SCENARIO in wanted else "",
            requirements=requirements_html(run, asked) if REQUIREMENTS in wanted else "",
            verified=verified,
        )

    def _aspect(self, tab: str) -> float:
        """Width over height of a tab's plot, below what stands above it."""
        return self.layout.aspect(_ABOVE_PX.get(tab, CHOOSER_PX))

    def _make_table(self, found: Shown) -> str:
        """Metrics of all methods, in as many tables below each other as the width asks for."""
        run, verified, wide = found.run, found.verified, self.layout.wide
        each_px = _METHOD_PX[wide] + (0 if found.baseline is None else _DELTA_PX[wide])
        most = max((self.layout.plot_px - _ROW_NAME_PX) // each_px, 1)
        count = len(run.methods)
        tables = -(-count // most)
        each = -(-count // tables)
        parts = (range(first, min(first + each, count)) for first in range(0, count, each))
        beside = None if verified is None else verified.verification
        old = verified is not None and verified.old
        return "".join(
            '<div style="margin-bottom:14px">'
            + metrics_html(run, part, beside, old=old, display=found.display, baseline=found.baseline)
            + "</div>"
            for part in parts
        )

    # ------------------------------------------------------------ showing

    def show(self, pictures: Pictures) -> None:
        """Send the figures."""
        for tab, figure in pictures.plotly.items():
            plot = self._plots.get(tab)
            if plot is None:
                with self._tabs[tab]:
                    self._plots[tab] = self._gui.add_plotly(figure, aspect=self._aspect(tab))  # pyright: ignore[reportArgumentType]
            else:
                plot.figure = figure  # pyright: ignore[reportAttributeAccessIssue]
        self._place_switching(pictures.switches)
        if pictures.curves:
            self._errors.show(pictures.curves, pictures.legend, pictures.legend_names)
        if pictures.switching and self._switching is not None:
            self._switching.show(pictures.curves, pictures.switching, pictures.run)
        if pictures.table:
            narrow = "" if self.layout.wide else " sb-narrow"
            self._table.content = (
                f'<div class="sb-table{narrow}" style="padding:4px 10px">{pictures.table}</div>'
            )
            self._warnings.content = _warnings_html(pictures.run, pictures.verified)
        if pictures.requirements:
            self.requirements.show(pictures.requirements)
        if pictures.toml:
            self._toml.content = (
                f'<pre style="margin:4px 12px;font-size:12.5px;line-height:1.4;white-space:pre-wrap">'
                f"{escape(pictures.toml)}</pre>"
            )

    def _place_switching(self, switches: bool) -> None:
        """Let the tab "Switching" be there exactly while a method switches."""
        tab = self._tabs.get(SWITCHING)
        if switches and tab is None:
            tab = self._tabs[SWITCHING] = self._panels[-1].add_tab(SWITCHING)
            self._switching = SwitchingView(self._gui, tab, self.layout, self._choose_curves)
        elif not switches and tab is not None:
            self._tabs.pop(SWITCHING).remove()
            self._switching = None


def _warnings_html(run: Run, verified: Verified | None) -> str:
    parts = [notices.note(notices_for(run), "info")]
    if verified is not None and not verified.old:
        parts.append(notices.note([verdict(verified.verification)], "info"))
        parts.append(notices.note(verified.verification.statements, "warning"))
    for index, texts in warnings_for(run).items():
        name = run.methods[index].method.name
        parts.append(notices.note([f"{name}: {text}" for text in texts], severity(run, index) or "warning"))
    return f'<div style="padding-top:10px;color:{style.INK}">{"".join(parts)}</div>'
