"""Light or dark page: the switch, the key, and the style that the page gets."""

from __future__ import annotations

from app.session.display import Display
from app.shell import notices
from app.shell.view import Frame, if_user
from app.views.appearance import theme

DARK = "dark page"


class DarkPage:
    """Switch and style.

    Parameters
    ----------
    frame : Frame
        Of the page.
    """

    def __init__(self, frame: Frame) -> None:
        self._frame = frame
        # Outside all tabs: what stands in a tab is on the page only while the tab is in front.
        self._style = frame.gui.add_html("", order=4)
        frame.commands.register("theme", lambda _: self._flip(), "Dark or light page", "D")

    def build(self) -> None:
        """Make the switch, in the present container."""
        gui = self._frame.gui
        gui.add_html(notices.heading("Page"), order=30)
        told = "Dark: for a dim room. Light: for a projector and print. Key: D."
        self._switch = gui.add_checkbox(DARK, False, hint=told, order=31)
        self._switch.on_update(if_user(lambda: self._choose(self._switch.value)))

    def show(self, display: Display) -> None:
        """Give the page the display's theme."""
        style = theme.css(display.theme)
        content = f'<div id="sb-theme" hidden data-theme="{display.theme}"></div><style>{style}</style>'
        if self._style.content != content:
            self._style.content = content
        self._switch.value = display.theme == "dark"

    def _choose(self, dark: bool) -> None:
        self._frame.show(theme="dark" if dark else "light")

    def _flip(self) -> None:
        self._choose(self._frame.session.display.theme != "dark")
