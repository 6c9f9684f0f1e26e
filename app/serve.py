"""Entry of the dashboard: starts the server at once and warms the kernels behind it."""

from __future__ import annotations

import logging
import os
import threading
from collections.abc import Callable, Iterable, Sequence
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import quote

from navcore.foundation import guarded
from navcore.foundation.errors import InputError
from schuler_bench.jobs import helper, kernels
from schuler_bench.jobs.words import what_failed
from schuler_bench.languages import LANGUAGE_SCRIPTS
from schuler_bench.logs import begin_logging
from schuler_bench.memory import GiveBack, bound_arenas, collect_seldom
from schuler_bench.session.keeping import NO_HOME, Keeping, NotKept
from schuler_bench.session.saving import AGAIN_AFTER_S
from schuler_bench.views import VIEWS, load, scripts

if TYPE_CHECKING:
    import viser

    from schuler_bench.http.limits import Limits
    from schuler_bench.http.metrics import Metrics
    from schuler_bench.http.server import DashboardServer, Inner
    from schuler_bench.session.sessions import Sessions
    from schuler_bench.session.store import Store
    from schuler_bench.shell.page import Page

_STATIC = Path(__file__).parent / "shell" / "static"
_SCRIPTS = (
    "veil",
    "redraw",
    "strokes",
    "touch",
    "widgets",
    "paths",
    "drawn",
    "marks",
    "groups",
    "room",
    "alone",
    "columns",
    "page",
    "commands",
    "front",
    "boxes",
    "paste",
    "access",
    "play",
    "cursor",
    "pick",
    "handle",
    "place",
    "lost",
)
_log = logging.getLogger("schuler.serve")
_READERS = (
    "schuler_bench.session.uploads",
    "navcore.checks.file",
    "navcore.checks.imu",
    "navcore.checks.map_guess",
    "h5py",
    "navcore.io.csv",
    "navcore.io.gpx",
    "navcore.io.nmea_recording",
    "navcore.io.stdbin",
    "navcore.io.tables",
    "navcore.scenario.file",
    "pyarrow.csv",
    "pyarrow.parquet",
    "scipy.io",
)
"""Modules that read uploaded files: imported once by the helper from which its child processes are forked."""


class Dashboard:
    """Gives every browser that opens the page its `schuler_bench.shell.page.Page`.

    Parameters
    ----------
    state : Path or None
        Folder in which sessions outlive the server; None: they do not.
    views : sequence of str
        Packages of the views, in the order of their tabs.

    Attributes
    ----------
    keeping : Keeping
        Whether sessions are kept at present.
    """

    def __init__(self, state: Path | None = None, views: Sequence[str] = VIEWS) -> None:
        self._state, self._views = state, views
        self.keeping = Keeping()
        self._memory = GiveBack(self._forget)
        self._pages: dict[int, Page] = {}
        self._lock = threading.Lock()
        self._ended = threading.Event()

    @cached_property
    def sessions(self) -> Sessions:
        """All sessions; made with the first page."""
        from schuler_bench.session.sessions import Sessions

        return Sessions(
            store=self.store,
            on_answer=lambda seconds: self.metrics.answers.observe(seconds),
            keeping=self.keeping,
        )

    @cached_property
    def store(self) -> Store | None:
        """Where sessions are kept; None: nowhere, and `keeping` says why."""
        from schuler_bench.session.store import open_store

        return None if self._state is None else open_store(self._state, self.keeping)

    def _open_later(self) -> None:
        """Try again, until it works or the server ends, to keep what could not be kept at the start."""
        from schuler_bench.session.store import open_store

        assert self._state is not None
        while not self._ended.wait(AGAIN_AFTER_S):
            store = open_store(self._state, self.keeping)
            if store is None:
                continue
            with self._lock:
                self.__dict__["store"] = store
                sessions = self.__dict__.get("sessions")
            if self._ended.is_set():
                store.close()
                return
            if sessions is not None:
                sessions.keep_in(store)
            self.keeping.becomes(None)
            return

    @cached_property
    def metrics(self) -> Metrics:
        """Figures of the server, for ``/metrics``."""
        from schuler_bench.http.metrics import Metrics
        from schuler_bench.jobs.elsewhere import cluster_figures
        from schuler_bench.jobs.scheduler import scheduler

        metrics = Metrics()
        metrics.sources += [lambda: scheduler().figures(), cluster_figures, self._figures]
        return metrics

    def _figures(self) -> dict[str, float]:
        with self._lock:
            pages, sessions = len(self._pages), self.__dict__.get("sessions")
        return {"pages_built": float(pages)} | ({} if sessions is None else sessions.figures())

    def knows(self, session_id: str) -> bool:
        """Whether a session with that id is kept here."""
        with self._lock:
            sessions = self.sessions
        return sessions.knows(session_id)

    def warm_up(
        self,
        prepare: Callable[[], None],
        failed: Callable[[str], None],
        compile_kernels: Callable[[], None] = lambda: None,
    ) -> threading.Thread:
        """Do in the background what the first page would have to wait for.

        Import what it needs, load the compiled kernels, run the scenario that a new visitor sees, and
        ``prepare()`` the files that browsers load; ``failed(reason)`` when that cannot be done. First
        ``compile_kernels()`` begins what takes longest.
        """
        given = prepare, failed, compile_kernels
        thread = threading.Thread(target=self._warm_up, args=given, name="warm-up", daemon=True)
        thread.start()
        return thread

    def _warm_up(
        self,
        prepare: Callable[[], None],
        failed: Callable[[str], None],
        compile_kernels: Callable[[], None],
    ) -> None:
        try:
            with self._lock:
                kept = self.store  # the first thing that is said: whether anything is kept
            if kept is None and self._state is not None:
                threading.Thread(target=self._open_later, name="store-later", daemon=True).start()
            compile_kernels()
            prepare()
            import schuler_bench.shell.page  # noqa: F401
            from navcore.engine.simulation import simulate
            from schuler_bench.session.sessions import first_scenario

            load(self._views)
            guarded.warm()
            with self._lock:
                sessions = self.sessions
            sessions.prepared = kernels.when_there(lambda: simulate(first_scenario()[0]))
            collect_seldom()
        except InputError as error:
            _log.error("no scenario can be run: %s", error)
            failed(what_failed(error))
        except Exception as error:
            _log.exception("warming up failed")
            failed(what_failed(error))

    def on_connect(self, client: viser.ClientHandle, session_id: str) -> None:
        """Build the page of a browser."""
        from schuler_bench.shell.page import Page

        with self._lock:
            sessions = self.sessions
        page = Page(client, sessions.get(session_id), load(self._views))
        with self._lock:
            self._pages[client.client_id] = page

    def on_disconnect(self, client: viser.ClientHandle, session_id: str) -> None:
        """Close the page of a browser that has gone."""
        del session_id
        with self._lock:
            page = self._pages.pop(client.client_id, None)
        if page is not None:
            page.close()
        self._memory.soon()

    def _forget(self) -> None:
        """Drop what was computed for visitors who have gone."""
        with self._lock:
            sessions = self.__dict__.get("sessions")
        if sessions is not None:
            from navcore.foundation.stage_cache import keep_only

            sessions.forget_idle()
            keep_only(sessions.names_with_pages)

    def close(self) -> None:
        """End all sessions and remove what was uploaded and is not kept."""
        self._ended.set()
        helper.stop()
        kernels.stop()
        if "sessions" in self.__dict__:  # made with the first page
            self.sessions.close()
        elif (store := self.__dict__.get("store")) is not None:
            store.close()


def open_dashboard(
    host: str = "127.0.0.1",
    port: int = 8080,
    *,
    token: str | None = None,
    allow_origins: Iterable[str] = (),
    frame_origins: Iterable[str] = (),
    state: Path | None = None,
    inner: Inner | None = None,
    limits: Limits | None = None,
    views: Sequence[str] = VIEWS,
    tell: Callable[[str], None] = lambda line: None,
) -> tuple[DashboardServer, Dashboard]:
    """Start the dashboard and return at once.

    Parameters
    ----------
    host, port, token, allow_origins, frame_origins
        See `schuler_bench.http.server.start`.
    inner, limits
        See `schuler_bench.http.server.start`.
    state, views
        See `Dashboard`.
    tell : callable
        Told how far the kernels are, while they are compiled.

    Raises
    ------
    InputError
        See `schuler_bench.http.server.start`.
    """
    from schuler_bench.http.ids import SessionIds
    from schuler_bench.http.server import start
    from schuler_bench.session.store import session_key

    if inner is None:
        kernels.begin()
    guarded.start(_READERS)
    helper.start()
    dashboard = Dashboard(state, views)
    try:
        server = start(
            host,
            port,
            token=token,
            allow_origins=allow_origins,
            frame_origins=frame_origins,
            on_connect=dashboard.on_connect,
            on_disconnect=dashboard.on_disconnect,
            page_scripts=[
                *LANGUAGE_SCRIPTS,
                *(_STATIC / f"{name}.js" for name in _SCRIPTS),
                *scripts(views),
            ],
            limits=limits,
            inner=inner,
            metrics=lambda: dashboard.metrics,
            session_ids=SessionIds(session_key(state), dashboard.knows),
        )
    except InputError:
        kernels.stop()
        raise
    # No axes cross in the middle of the map; they belong to the server's scene.
    server.viser.scene.world_axes.visible = False
    dashboard.keeping.watch(
        lambda fault: server.keeps_nothing(fault and (str(fault.reason), str(fault.remedy)))
    )
    dashboard.warm_up(server.prepare, server.fail, partial(kernels.prepare, start=inner is None, tell=tell))
    return server, dashboard


def _say_whether_kept(fault: NotKept | None) -> None:
    """Tell whoever has started the server, on the terminal."""
    said = "sessions are kept again" if fault is None else f"nothing is kept: {fault.reason}. {fault.remedy}"
    print(f"Schuler Bench: {said}", flush=True)


def link_with(url: str, token: str | None) -> str:
    """Address that lets its reader in."""
    return url if token is None else f"{url}?token={quote(token, safe='')}"


def serve(
    host: str = "127.0.0.1",
    port: int = 8080,
    *,
    token: str | None = None,
    allow_origins: Iterable[str] = (),
    frame_origins: Iterable[str] = (),
    show_token: bool = False,
    open_browser: bool = False,
    cluster: str | None = None,
) -> None:
    """Serve the dashboard until SIGINT or SIGTERM.

    Parameters
    ----------
    host, port, token, allow_origins, frame_origins
        See `schuler_bench.http.server.start`.
    show_token : bool
        Print the address with the token in it, once: it was generated, and nobody knows it yet.
    open_browser : bool
        Open the page in the user's browser.
    cluster : str or None
        Address of the scheduler of a Dask cluster that computes heavy jobs.

    Raises
    ------
    InputError
        The address cannot be served; that of the cluster is none, or the extra it needs is not installed;
        a setting in the environment is none;
        something else is in the place of something of ours in the state folder.
    """
    from schuler_bench.jobs.away import away_seconds
    from schuler_bench.jobs.cluster import check_address
    from schuler_bench.jobs.elsewhere import leave_cluster, use_cluster
    from schuler_bench.session.store import checked_folder

    begin_logging()
    check_address(cluster)
    away_seconds(os.environ)
    bound_arenas()
    state = checked_folder()
    server, dashboard = open_dashboard(
        host, port, token=token, allow_origins=allow_origins, frame_origins=frame_origins, state=state,
        tell=partial(print, flush=True),
    )  # fmt: skip
    use_cluster(cluster)
    link = link_with(server.url, token)
    print(f"Schuler Bench: {link if show_token else server.url}  (Ctrl+C ends it)", flush=True)
    dashboard.keeping.watch(_say_whether_kept)
    if state is None:
        dashboard.keeping.becomes(NO_HOME)
    if open_browser:
        import webbrowser

        address = link
        threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()
    server.wait()
    leave_cluster()
    dashboard.close()
