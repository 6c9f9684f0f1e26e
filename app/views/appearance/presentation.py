"""Presentation size: the switch, the key, and what makes the page readable from the back of a room.

The panels are enlarged by the style sheet (presentation.css), the plots in them by `app.plots.enlarged`: a
browser that enlarged a drawn plot would blur it, and would miss its cursor. Of the left tabs the one that
leads (`app.shell.view.View.leads`) is shown alone.
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from app.session.display import Display
from app.shell.view import Frame, if_user

PRESENTATION = "presentation size"
"""Label of the switch."""


class PresentationSize:
    """Switch, style, and which of the left tabs stays.

    Parameters
    ----------
    frame : Frame
        Of the page.
    """

    def __init__(self, frame: Frame) -> None:
        self._frame = frame
        self._led = 0
        # Outside all tabs, as the style of the dark page.
        self._style = frame.gui.add_html("", order=4)
        title = "Presentation size on or off"
        frame.commands.register("size", lambda _: self._flip(), title, "L")

    def build(self) -> None:
        """Make the switch, in the present container."""
        self._switch = self._frame.gui.add_checkbox(
            PRESENTATION, False, order=32,
            hint="Large type and wide lines on the whole page, for a projector, and only the controls of the "
            "open lesson or of the method in hand. Key: L.",
        )  # fmt: skip
        self._switch.on_update(if_user(lambda: self._choose(self._switch.value)))

    def show(self, display: Display) -> None:
        """Give the page the display's size."""
        large = display.size == "presentation"
        content = _style(self._frame.layout().scale) if large else ""
        if self._style.content != content:
            self._style.content = content
        self._switch.value = large
        leading = max(self._frame.views(), key=lambda view: view.leads) if large else None
        before, self._led = self._led, 0 if leading is None else leading.leads
        if leading is not None and self._led > before:
            self._frame.commands.ask_page("front", leading.title)

    def _choose(self, large: bool) -> None:
        self._frame.show(size="presentation" if large else "normal")

    def _flip(self) -> None:
        self._choose(self._frame.session.display.size == "normal")


def _style(scale: float) -> str:
    """Mark the page as enlarged, for presentation.css and playback.js."""
    marked = f'<div id="sb-size" hidden data-scale="{scale:g}"></div>'
    return f"{marked}<style>:root{{--sb-scale:{scale:g}}}{_rules()}</style>{_ROW}"


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
