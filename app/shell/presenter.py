"""One page drives, the others watch: what that means for each page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.bridge.controls import lock_controls
from app.session.session import Session
from app.session.view import View

if TYPE_CHECKING:
    import viser

    from app.shell.commands import Commands


class PresenterLock:
    """Holds a page's controls while another page of the session presents.

    Parameters
    ----------
    client : viser.ClientHandle
        The browser.
    session : Session
        Knows who presents.
    view : View
        The page.
    commands : Commands
        Of the page: while it watches, only those for watchers are carried out.
    free : callable
        Gives the ids of the controls that a watcher may use: those through which the page reports.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        session: Session,
        view: View,
        commands: Commands,
        free: frozenset[str],
    ) -> None:
        self._client, self._session, self._view, self._commands = client, session, view, commands
        self._free = free

    @property
    def drives(self) -> bool:
        """Whether the page presents."""
        return self._session.presenter is self._view

    @property
    def watches(self) -> bool:
        """Whether another page presents."""
        return self._session.presenter not in (None, self._view)

    def apply(self) -> None:
        """Lock or free the controls as the session says now; those that were made meanwhile too."""
        was_watching = self._commands.watching
        self._commands.watching = self.watches
        if self.watches or was_watching:
            lock_controls(self._client, self._free if self.watches else None)

    def toggle(self) -> bool:
        """Begin or end to present; False when another page presents."""
        return self._session.present(None if self.drives else self._view)

    @property
    def banner(self) -> str:
        """What stands over the page; empty while nobody presents."""
        if self.watches:
            return "Another page presents: you watch"
        if not self.drives:
            return ""
        watching = self._session.open_pages - 1
        pages = "no other page is open" if watching == 0 else f"{watching} watch{'es' * (watching == 1)}"
        return f"You present: {pages}"
