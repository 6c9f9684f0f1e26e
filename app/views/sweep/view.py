"""Tab "Sweep": one click runs all methods over latitude, error of the log, sensor grade and sea state."""

from typing import Any

from navcore.engine.run import Run
from navcore.foundation.text import Text
from navcore.quantities import QUANTITIES
from schuler_bench.plots.plotly_data import PlotlyFigure
from schuler_bench.session.display import SWEPT
from schuler_bench.session.shown import Shown
from schuler_bench.shell.layout import CHOOSER_PX, TOOLS
from schuler_bench.shell.notices import note
from schuler_bench.shell.plotly_view import PlotlyView
from schuler_bench.shell.searching import SearchControls, show_html
from schuler_bench.shell.view import Frame, if_user
from schuler_bench.views.sweep.figure import refusals, sweep_figure

METRIC = Text("metric")
SWEEP, STOP = Text("Sweep"), Text("Stop sweeping")
_OLD = Text("of an earlier scenario: sweep again")


class SweepView(PlotlyView):
    """Chooser of the metric and the button above four small plots."""

    title = Text("Sweep")
    place = "lower"
    tab = Text("Robustness")
    look_for = Text("How each method performs at other latitudes, log errors, sensor grades and sea states.")
    plots = (title,)
    asks = ("sweep",)
    above_px = 2 * CHOOSER_PX

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._sweeper = frame.session.searches.sweeper
        self._drawn: object = None
        words = Text("Sweep latitude, log, sensors and sea")
        frame.commands.register("sweep", lambda _: self._begin(), words)

    def build_tools(self) -> None:
        """Make the chooser and the controls."""
        gui, words = self.frame.gui, {QUANTITIES[name].label: name for name in SWEPT}
        gui.add_html(TOOLS)
        self._chooser: Any = gui.add_dropdown(
            METRIC, tuple(words), initial_value=QUANTITIES[self.session.display.swept].label,
            hint=Text("Quantity on the upright axis of all four plots."),
        )  # fmt: skip
        self._chooser.on_update(if_user(lambda: self.frame.show(swept=words[str(self._chooser.value)])))
        hint = Text(
            "Runs all methods with the scenario's seed at some latitudes, constant errors of the log, "
            "multiples of all gyro and accelerometer errors, and wave heights, one of them varied at a time."
        )
        self._controls = SearchControls(gui, self._sweeper, self._begin, (SWEEP, STOP), hint)
        self._words = gui.add_html("", visible=False)
        self.follow_jobs()

    def follow_display(self) -> None:
        """Show the display's metric."""
        self._chooser.value = QUANTITIES[self.session.display.swept].label

    def follow_jobs(self) -> None:
        """Show how far the sweep is, or why it ended."""
        self._controls.follow()
        words = (*self._sweeper.words, *refusals(self._sweeper.known))
        show_html(self._words, note(words, "warning"))

    def take_new(self) -> bool:
        """Whether a quantity has just been swept."""
        known = self._sweeper.known
        new, self._drawn = known is not self._drawn, known
        return new

    def figure(self, both: Run, found: Shown) -> PlotlyFigure:
        """Four plots."""
        del both
        swept, known = self._sweeper.swept, self._sweeper.known
        names = found.display.colored(swept or found.run.scenario)
        old = bool(known) and not self._sweeper.fits(found.run.scenario)
        metric, note = found.display.swept, _OLD if old else ""
        return sweep_figure(known, metric, names, self.aspect, width_px=self.width_px, note=note)

    def _begin(self) -> None:
        with self.session.lock:
            self._sweeper.sweep(self.session.scenario)


VIEW = SweepView
