"""Tab "Frequency": Bode plots of the network and of a transfer, or the open loop's Nyquist plot."""

from navcore.engine.run import Run
from navcore.foundation.text import Text
from schuler_bench.plots.effective import OPEN_LOOP, SHOWN
from schuler_bench.plots.plotly_data import PlotlyFigure
from schuler_bench.session.shown import Shown
from schuler_bench.shell.layout import TOOLS
from schuler_bench.shell.pair_handle import PairHandle
from schuler_bench.shell.plotly_view import PlotlyView
from schuler_bench.shell.view import Frame, if_user
from schuler_bench.views.frequency.curves import optimal_reference
from schuler_bench.views.frequency.figure import HANDLE_PANEL, frequency_view

DISCRETE, OPTIMAL = Text("measured filter"), Text("optimal H")
_IDS = {label: id for id, label in SHOWN.items()}


class FrequencyView(PlotlyView):
    """Chooser of the transfer and switch for the measured filter above the plots."""

    title = Text("Frequency")
    place = "upper"
    tab = Text("Frequency")
    mode = Text("Bode")
    look_for = Text(
        "Below 0 dB an error is damped, above it is amplified. Handle: across frequency, up less damping."
    )
    focus = "bode"
    plots = (title,)

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._handle = PairHandle(frame, "bode", [HANDLE_PANEL])

    def build_tools(self) -> None:
        """Make chooser and switch."""
        gui, display = self.frame.gui, self.session.display
        self._handle.build()
        self._transfer = gui.add_dropdown(
            Text("transfer"), tuple(_IDS), initial_value=SHOWN[display.transfer],
            hint=Text("Shown at the right, beside the network H; or the open loop with its margins."),
        )  # fmt: skip
        gui.add_html(TOOLS)
        self._discrete = gui.add_checkbox(
            DISCRETE, display.discrete,
            hint=Text("Dots on H: gain (dB) and phase (°) of the filter that runs, at the step of the run, "
            "measured by driving it with sines. Gains that act as velocity feedback have no filter."),
        )  # fmt: skip
        self._optimal = gui.add_checkbox(
            OPTIMAL, display.optimal,
            hint=Text("Dashed: the network that is best for the sensors and the log of this scenario (LQG)."),
        )  # fmt: skip
        self._transfer.on_update(if_user(lambda: self.frame.show(transfer=_IDS[self._transfer.value])))
        self._discrete.on_update(if_user(lambda: self.frame.show(discrete=self._discrete.value)))
        self._optimal.on_update(if_user(lambda: self.frame.show(optimal=self._optimal.value)))

    def follow_display(self) -> None:
        """Show the display's choices."""
        display = self.session.display
        self._transfer.value = SHOWN[display.transfer]
        self._discrete.value = display.discrete
        self._optimal.value = display.optimal

    @property
    def of_selected(self) -> bool:
        """The handle is that of the selected method."""
        return self.session.display.transfer != OPEN_LOOP

    def figure(self, both: Run, found: Shown) -> PlotlyFigure:
        """Bode plots, or Nyquist plot."""
        display = found.display
        plot = frequency_view(
            both,
            display.transfer,
            self.aspect,
            width_px=self.width_px,
            discrete=display.discrete,
            reference=optimal_reference(found.run.scenario) if display.optimal else None,
        )
        if display.transfer != OPEN_LOOP:
            plot["layout"]["meta"] |= self._handle.meta(found)
        return plot


VIEW = FrequencyView
