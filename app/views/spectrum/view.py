"""Tab "Spectrum": amplitude over period of one error."""

from typing import Any

from navcore.engine.run import Run
from navcore.foundation.text import Text
from schuler_bench.plots.plotly_data import PlotlyFigure
from schuler_bench.session.shown import Shown
from schuler_bench.shell.layout import TOOLS
from schuler_bench.shell.plotly_view import PlotlyView
from schuler_bench.shell.view import if_user
from schuler_bench.views.errors.figure import TITLES
from schuler_bench.views.spectrum.figure import spectrum

SPECTRUM_OF = Text("spectrum of")
_KEYS = {title: key for key, title in TITLES.items()}


class SpectrumView(PlotlyView):
    """Chooser of the quantity above the plot."""

    title = Text("Spectrum")
    place = "lower"
    group = "run"
    look_for = Text("Peaks at 84 min (Schuler), 24 h and the Foucault period: damping takes the first away.")
    plots = (title,)

    def build_tools(self) -> None:
        """Make the chooser."""
        self.frame.gui.add_html(TOOLS)
        self._chooser: Any = self.frame.gui.add_dropdown(
            SPECTRUM_OF, tuple(_KEYS), initial_value=TITLES[self.session.display.spectrum],
            hint=Text("Amplitude over period: a sine shows as a peak of its amplitude."),
        )  # fmt: skip
        self._chooser.on_update(if_user(lambda: self.frame.show(spectrum=_KEYS[self._chooser.value])))

    def follow_display(self) -> None:
        """Show the display's quantity."""
        self._chooser.value = TITLES[self.session.display.spectrum]

    def figure(self, both: Run, found: Shown) -> PlotlyFigure:
        """Spectra."""
        display = found.display
        return spectrum(both, display.spectrum, self.aspect, display=display, width_px=self.width_px)


VIEW = SpectrumView
