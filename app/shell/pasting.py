"""Parts of the scenario by the clipboard, as TOML; a paste is one step of undo (static/paste.js)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.editing.excerpt import disturbances_toml, method_toml, paste
from app.shell import notices
from app.shell.commands import LONGEST_TEXT, Commands

if TYPE_CHECKING:
    import viser

    from app.session.session import Session

COPY_METHOD, COPY_LOG, PASTE = "copy-method-text", "copy-log-text", "paste-text"


class Pasting:
    """Commands that copy a method or the log's events, and that paste them.

    Parameters
    ----------
    client : viser.ClientHandle
        The browser.
    commands : Commands
        Of the page.
    session : Session
        Whose scenario is copied from and changed.
    """

    def __init__(self, client: viser.ClientHandle, commands: Commands, session: Session) -> None:
        self._client, self._session = client, session
        ask, add = commands.ask_page, commands.register
        add(
            COPY_METHOD,
            lambda _: ask("copy", method_toml(session.scenario, session.selected)),
            "Copy the method as TOML",
            watcher=True,
        )
        add(
            COPY_LOG,
            lambda _: ask("copy", disturbances_toml(session.scenario)),
            "Copy the log's events and outages as TOML",
            watcher=True,
        )
        add(
            PASTE, self._paste, "Paste a method, or the log's events and outages (TOML)", longest=LONGEST_TEXT
        )
        self._ask = lambda: ask("paste", "")

    def _paste(self, text: str) -> None:
        """Take over a text; ask the page for one where there is none."""
        if not text.strip():
            self._ask()
            return
        session = self._session
        with session.lock:
            pasted = paste(session.scenario, session.selected, text)
            session.change(pasted.scenario, None, selected=pasted.selected, name=f"paste {pasted.words}")
        notices.tell(self._client, "Pasted", [pasted.words], "info")
