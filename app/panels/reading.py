"""Tab "View" of the left column: units, axes and envelope of the plots over time, and export of any plot."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, get_args

from app.background.envelopes import SEEDS
from app.page import notices
from app.session.display import Display
from app.session.session import Session

if TYPE_CHECKING:
    import viser

VIEW = "View"
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
ENVELOPE = "envelope"
_ENVELOPES = {"none": "none", f"{SEEDS} seeds, 5 to 95 %": "seeds"}
EXPORT, FORMAT = "export plot", "export as"
FORMATS = ("CSV", "SVG", "PNG")


class ReadingPanel:
    """How the plots are read, and what is taken from them.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    tab : viser.GuiTabHandle
        Where it stands.
    session : Session
        Whose display is changed.
    plots : tuple of str
        Titles of the plots that can be exported.
    export : callable
        ``export(title, format)``.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        tab: viser.GuiTabHandle,
        session: Session,
        plots: tuple[str, ...],
        export: Callable[[str, str], None],
    ) -> None:
        self._session = session
        self._choosers: dict[str, Any] = {}
        with tab:
            gui.add_html(notices.heading("Units and axes"), order=0)
            for order, (label, (field, hint)) in enumerate(_CHOICES.items(), start=1):
                options = get_args(Display.model_fields[field].annotation)
                self._choosers[field] = self._chooser(gui, label, options, field, hint, order)
            gui.add_html(notices.heading("Envelope of the error curves"), order=10)
            self._envelope: Any = gui.add_dropdown(
                ENVELOPE, tuple(_ENVELOPES), order=11,
                hint=f"Runs the scenario with {SEEDS} other seeds, and fills where 90 % of them lie.",
            )  # fmt: skip
            self._progress = gui.add_progress_bar(0.0, visible=False, order=12)
            self._words = gui.add_html("", visible=False, order=13)
            gui.add_html(notices.heading("Export a plot"), order=20)
            self._plot: Any = gui.add_dropdown(
                EXPORT, plots, order=21, hint="Plot to save: as it is shown, with its units and curves."
            )
            self._format: Any = gui.add_button_group(
                FORMAT, FORMATS, order=22, hint="CSV: the plotted numbers in full. SVG, PNG: the picture."
            )
        self._envelope.on_update(
            lambda event: (
                session.show(None, envelope=_ENVELOPES[self._envelope.value]) if event.client else None
            )
        )
        self._format.on_click(
            lambda event: export(self._plot.value, event.target.value) if event.client is not None else None
        )
        self.show()

    def _chooser(
        self, gui: viser.GuiApi, label: str, options: tuple[str, ...], field: str, hint: str, order: int
    ) -> Any:
        made: Any = gui.add_dropdown(label, options, order=order, hint=hint)

        def choose(event: Any) -> None:
            if event.client is not None:
                self._session.show(None, **{field: made.value})

        made.on_update(choose)
        return made

    def show(self) -> None:
        """Show the session's choices."""
        display = self._session.display
        for field, chooser in self._choosers.items():
            chooser.value = getattr(display, field)
        self._envelope.value = next(word for word, key in _ENVELOPES.items() if key == display.envelope)
        self.show_progress()

    def show_progress(self) -> None:
        """Show how far the envelope is, or why there is none."""
        fraction, words = self._session.envelopes.fraction, self._session.envelopes.words
        self._progress.visible = fraction is not None
        self._progress.value = round(100.0 * (fraction or 0.0), 1)
        self._words.content, self._words.visible = (
            notices.note([words] if words else [], "warning"),
            bool(words),
        )
