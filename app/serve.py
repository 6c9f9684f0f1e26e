"""Entry of the dashboard: starts the server at once and warms the kernels behind it."""

from __future__ import annotations

import logging
import threading
from collections.abc import Iterable
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import viser

    from app.http.server import DashboardServer
    from app.page.page import Page
    from app.session.sessions import Sessions

_SCRIPTS = ("widgets", "marks", "page", "commands", "playback", "learn", "access", "pick", "cursor", "export")
PAGE_SCRIPTS = [Path(__file__).parent / "static" / f"{name}.js" for name in _SCRIPTS]
_log = logging.getLogger("schuler.serve")


class Dashboard:
    """Gives every browser that opens the page its `app.page.page.Page`.

    Parameters
    ----------
    state : Path or None
        Folder in which sessions outlive the server; None: they do not.
    """

    def __init__(self, state: Path | None = None) -> None:
        self._state = state
        self._pages: dict[int, Page] = {}
        self._lock = threading.Lock()

    @cached_property
    def sessions(self) -> Sessions:
        """All sessions; made with the first page."""
        from app.session.sessions import Sessions
        from app.session.store import open_store

        return Sessions(store=None if self._state is None else open_store(self._state))

    def warm_up(self) -> threading.Thread:
        """Import what a page needs and load the compiled kernels, in the background."""
        thread = threading.Thread(target=self._warm_up, name="warm-up", daemon=True)
        thread.start()
        return thread

    def _warm_up(self) -> None:
        try:
            import app.page.page  # noqa: F401
            from app.session.sessions import first_scenario
            from navcore.simulation import simulate

            simulate(first_scenario()[0])
        except Exception:
            _log.exception("warming up failed")

    def on_connect(self, client: viser.ClientHandle, session_id: str) -> None:
        """Build the page of a browser."""
        from app.page.page import Page

        with self._lock:
            sessions = self.sessions
        page = Page(client, sessions.get(session_id))
        with self._lock:
            self._pages[client.client_id] = page

    def on_disconnect(self, client: viser.ClientHandle, session_id: str) -> None:
        """Close the page of a browser that has gone."""
        del session_id
        with self._lock:
            page = self._pages.pop(client.client_id, None)
        if page is not None:
            page.close()

    def close(self) -> None:
        """End all sessions and remove what was uploaded and is not kept."""
        if "sessions" in self.__dict__:  # made with the first page
            self.sessions.close()


def open_dashboard(
    host: str = "127.0.0.1",
    port: int = 8080,
    *,
    token: str | None = None,
    allow_origins: Iterable[str] = (),
    state: Path | None = None,
) -> tuple[DashboardServer, Dashboard]:
    """Start the dashboard and return at once.

    Parameters
    ----------
    host, port, token, allow_origins
        See `app.http.server.start`.
    state
        See `Dashboard`.

    Raises
    ------
    InputError
        See `app.http.server.start`.
    """
    from app.http.server import start

    dashboard = Dashboard(state)
    server = start(
        host,
        port,
        token=token,
        allow_origins=allow_origins,
        on_connect=dashboard.on_connect,
        on_disconnect=dashboard.on_disconnect,
        page_scripts=PAGE_SCRIPTS,
    )
    # No axes cross in the middle of the map; they belong to the server's scene.
    server.viser.scene.world_axes.visible = False
    dashboard.warm_up()
    return server, dashboard


def serve(
    host: str = "127.0.0.1",
    port: int = 8080,
    *,
    token: str | None = None,
    allow_origins: Iterable[str] = (),
    open_browser: bool = False,
) -> None:
    """Serve the dashboard until SIGINT or SIGTERM.

    Parameters
    ----------
    host, port, token, allow_origins
        See `app.http.server.start`.
    open_browser : bool
        Open the page in the user's browser.

    Raises
    ------
    InputError
        The address cannot be served.
    """
    from app.session.store import default_folder

    state = default_folder()
    server, dashboard = open_dashboard(host, port, token=token, allow_origins=allow_origins, state=state)
    print(f"Schuler Bench: {server.url}  (Ctrl+C ends it)", flush=True)
    if open_browser:
        import webbrowser

        address = server.url if token is None else f"{server.url}?token={token}"
        threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()
    server.wait()
    dashboard.close()
