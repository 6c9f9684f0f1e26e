"""Tab "View": units, axes and bands of the plots, export of any plot, language, look and size of the page."""

from __future__ import annotations

from typing import Any, get_args

from app.jobs.envelopes import SEEDS
from app.session.display import Display
from app.shell import notices
from app.shell.view import Frame, Tab, View, if_user
from app.views.appearance.document import Sheet
from app.views.appearance.export import FORMATS, Export
from app.views.appearance.look import Looks, PageLanguage
from navcore.foundation.notation import unit_sign
from navcore.foundation.text import Text

_CHOICES = {
    "angles in": ("angle", "Unit of tilts and headings in the plots over time, the spectrum and the table."),
    "lengths in": ("length", "Unit of position errors."),
    "velocities in": ("speed", "Unit of velocity errors."),
    "times in": ("time", "Unit of the time axis, and of the spectrum's periods."),
    "error axis": (
        "scale",
        "log: magnitudes of the errors, on an axis of decades. Linear: with their signs.",
    ),
}
BANDS = "bands"
_BANDS = {
    "off": "none",
    "±1σ by covariance": "covariance",
    Text("{seeds} seeds, 5 to 95 %", seeds=SEEDS): "seeds",
}
EXPORT, FORMAT = "export plot", "export as"
_PAGE_HINT = (
    "Numbers, verdicts, pins, warnings, all plots and the scenario on one page: it needs no server, and "
    "prints on A4."
)
_OVERVIEW_HINT = "All plots side by side, also those whose tabs are not in front."
_SESSION = (
    '<div class="sb-export"><div class="sb-row">'
    f'<button class="sb-do" data-command="save-page" title="{_PAGE_HINT}">Save as one page (HTML)</button>'
    f'<button class="sb-do" data-command="save-overview" title="{_OVERVIEW_HINT}">Save all plots (PNG)'
    "</button>"
    '</div><div class="sb-making" role="status"></div></div>'
)


class AppearanceView(View):
    """How the plots are read, and what is taken from them."""

    title = "View"
    place = "edit"

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._export = Export(frame)
        Sheet(frame, self._export)

    def build(self, tab: Tab) -> None:
        """Make the widgets."""
        gui, export = self.frame.gui, self._export
        self._looks, language = Looks(self.frame), PageLanguage(self.frame)
        self._choosers: dict[str, Any] = {}
        with tab:
            gui.add_html(notices.heading("Units and axes"), order=0)
            for order, (label, (field, hint)) in enumerate(_CHOICES.items(), start=1):
                self._choosers[field] = self._chooser(label, field, hint, order)
            gui.add_html(notices.heading("Bands behind the error curves"), order=10)
            self._bands: Any = gui.add_dropdown(
                BANDS, tuple(_BANDS), order=11,
                hint=Text("Covariance: one standard deviation of all modelled errors together, for "
"laws that do not look at the data. Seeds: runs the scenario with {seeds} "
"other seeds, and fills where 90 % of them lie.", seeds=SEEDS),
            )  # fmt: skip
            self._progress = gui.add_progress_bar(0.0, visible=False, order=12)
            self._words = gui.add_html("", visible=False, order=13)
            gui.add_html(notices.heading("Export a plot"), order=20)
            plot: Any = gui.add_dropdown(
                EXPORT,
                export.plots,
                order=21,
                hint="Plot to save: as it is shown, with its units and curves.",
            )
            format: Any = gui.add_button_group(
                FORMAT, FORMATS, order=22, hint="CSV: the plotted numbers in full. SVG, PNG: the picture."
            )
            gui.add_html(notices.heading("Export the whole session"), order=23)
            gui.add_html(_SESSION, order=24)
            gui.add_html(notices.heading("Page"), order=30)
            language.build()
            self._looks.build()
        self._bands.on_update(if_user(lambda: self.frame.show(envelope=_BANDS[self._bands.value])))
        format.on_click(
            lambda event: export.save(plot.value, event.target.value) if event.client is not None else None
        )

    def _chooser(self, label: str, field: str, hint: str, order: int) -> Any:
        options = {unit_sign(key): key for key in get_args(Display.model_fields[field].annotation)}
        chooser: Any = self.frame.gui.add_dropdown(label, tuple(options), order=order, hint=hint)
        chooser.on_update(if_user(lambda: self.frame.show(**{field: options[chooser.value]})))
        return chooser

    def follow_display(self) -> None:
        """Show the session's choices."""
        display = self.session.display
        for field, chooser in self._choosers.items():
            chooser.value = unit_sign(getattr(display, field))
        self._bands.value = next(word for word, key in _BANDS.items() if key == display.envelope)
        self._looks.show(display)
        self.follow_jobs()

    def follow_scenario(self) -> None:
        """Let the tab that leads now stand alone in presentation size: a lesson may have been opened."""
        self._looks.show(self.session.display)

    def follow_jobs(self) -> None:
        """Show how far the bands are, or why there are none."""
        fraction, words = self.session.envelopes.fraction, self.session.envelopes.words
        self._progress.visible = fraction is not None
        self._progress.value = round(100.0 * (fraction or 0.0), 1)
        self._words.content, self._words.visible = (
            notices.note(words, "warning"),
            bool(words),
        )


VIEW = AppearanceView
