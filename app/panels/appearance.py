"""Light or dark page: the switch in the left column, and the style that it puts on."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.page import notices, theme
from app.page.commands import Commands
from app.session.display import Display
from app.session.session import Session

if TYPE_CHECKING:
    import viser

DARK = "dark page"


class Appearance:
    """Switch and style.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    session : Session
        Whose display is changed.
    commands : Commands
        Where the key is told.
    tab : viser.GuiTabHandle
        Where the switch stands.
    """

    def __init__(
        self, gui: viser.GuiApi, session: Session, commands: Commands, tab: viser.GuiTabHandle
    ) -> None:
        self._session = session
        self._style = gui.add_html("", order=4)
        with tab:
            gui.add_html(notices.heading("Page"), order=30)
            told = "Dark: for a dim room. Light: for a projector and print. Key: D. Larger print: Ctrl and +."
            self._switch = gui.add_checkbox(DARK, False, hint=told, order=31)
        self._switch.on_update(lambda event: self._choose() if event.client is not None else None)
        commands.register("theme", self._flip, "Dark or light page", "D")
        self.show(session.display)

    def show(self, display: Display) -> None:
        """Give the page the display's theme."""
        style = theme.css(display.theme)
        content = f'<div id="sb-theme" hidden data-theme="{display.theme}"></div><style>{style}</style>'
        if self._style.content != content:
            self._style.content = content
        self._switch.value = display.theme == "dark"

    def _choose(self) -> None:
        self._session.show(None, theme="dark" if self._switch.value else "light")

    def _flip(self, argument: str) -> None:
        del argument
        dark = self._session.display.theme == "dark"
        self._session.show(None, theme="light" if dark else "dark")
