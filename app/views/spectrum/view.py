"""Tab "Spectrum": amplitude over period of one error."""

from typing import Any

from navcore.engine.run import Run
from navcore.foundation.text import Text
from schuler_bench.plots.plotly_data import PlotlyFigure
from schuler_bench.session.shown import Shown
from schuler_bench.shell.layout import TOOLS
from schuler_bench.shell.plotly_view import PlotlyView
from schuler_bench.shell.view import if_user
from schuler_bench.views.errors.figure import RECORDED
from schuler_bench.views.spectrum.figure import FIRST, TO_LOG_TITLES, drawn_key, spectrum

SPECTRUM_OF = Text("spectrum of")
_KEYS = {title: key for key, title in (RECORDED | TO_LOG_TITLES).items()}
_WORDS = {key: title for title, key in _KEYS.items()}


class SpectrumView(PlotlyView):
    """Chooser of the quantity above the plot."""

    title = Text("Spectrum")
    place = "lower"
    tab = Text("Errors")
    look_for = Text("Peaks at 84 min (Schuler), 24 h and the Foucault period: damping takes the first away.")
    plots = (title,)

    def build_tools(self) -> None:
        """Make the chooser."""
        self.frame.gui.add_html(TOOLS)
        self._chooser: Any = self.frame.gui.add_dropdown(
            SPECTRUM_OF, tuple(RECORDED.values()), initial_value=RECORDED[FIRST],
            hint=Text("Amplitude over period: a sine shows as a peak of its amplitude."),
        )  # fmt: skip
        self._chooser.on_update(if_user(self._choose))
        self.follow_display()

    def _choose(self) -> None:
        if self._chooser.value in _KEYS:
            self.frame.show(spectrum=_KEYS[self._chooser.value])

    def follow_display(self) -> None:
        """Show the display's quantity, and those of a ship's own INS where the run is on one."""
        run, key = self.session.run, self.session.display.spectrum
        own = tuple(TO_LOG_TITLES.values()) if run is not None and run.against is not None else ()
        options = (*RECORDED.values(), *own)
        if tuple(self._chooser.options) != options:
            self._chooser.options = options
        self._chooser.value = _WORDS[drawn_key(run, key)]

    def draw(self, found: Shown) -> None:
        """Offer what the run has, and mark the picture as out of date."""
        self.follow_display()
        super().draw(found)

    def figure(self, both: Run, found: Shown) -> PlotlyFigure:
        """Spectra."""
        display = found.display
        return spectrum(both, display.spectrum, self.aspect, display=display, width_px=self.width_px)


VIEW = SpectrumView
