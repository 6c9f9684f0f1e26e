"""Presentation size: what makes the page readable from the back of a room.

The panels are enlarged by the style sheet (presentation.css), the plots in them by `app.plots.enlarged`: a
browser that enlarged a drawn plot would blur it, and would miss its cursor. Of the left tabs the one that
leads (`app.shell.view.View.leads`) is shown alone.
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from app.session.display import Display
from app.shell.view import Frame
from app.views.appearance.look import Look

PRESENTATION = "presentation size"


class PresentationSize(Look):
    """Normal size, or presentation size with the left tab that leads in front."""

    label, order = PRESENTATION, 32
    hint = (
        "Large type and wide lines on the whole page, for a projector, and only the controls of the "
        "open lesson or of the method in hand. Key: L."
    )
    command = "size", "Presentation size on or off", "L"
    field, values = "size", ("normal", "presentation")

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._led = 0

    def show(self, display: Display) -> None:
        """Give the page its size, and bring the tab to the front that leads since."""
        super().show(display)
        leading = max(self._frame.views(), key=lambda view: view.leads) if self.on(display) else None
        before, self._led = self._led, 0 if leading is None else leading.leads
        if leading is not None and self._led > before:
            self._frame.commands.ask_page("front", leading.title)

    def style(self, display: Display) -> str:
        """Rules and scale of the enlarged page, marked for presentation.css and playback.js."""
        if not self.on(display):
            return ""
        scale = f"{self._frame.layout().scale:g}"
        marked = f'<div id="sb-size" hidden data-scale="{scale}"></div>'
        return f"{marked}<style>:root{{--sb-scale:{scale}}}{_rules()}</style>{_ROW}"


_ROW = (
    '<div class="sb-row sb-lecture" role="toolbar" aria-label="Presentation">'
    '<button class="sb-do" data-command="size" aria-pressed="true" '
    'title="Back to the page with all its controls (L)">Normal size</button>'
    '<button class="sb-do" data-command="tab Learn" title="Lessons of five minutes">Learn</button>'
    '<button class="sb-do" data-command="tab Method" title="The method in hand">Method</button></div>'
)


@lru_cache(maxsize=1)
def _rules() -> str:
    return (Path(__file__).parent / "static" / "presentation.css").read_text(encoding="utf-8")
