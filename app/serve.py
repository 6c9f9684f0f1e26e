"""Entry of the dashboard: starts the server at once and warms the kernels behind it."""

from __future__ import annotations

import logging
import os
import threading
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import quote

from navcore.foundation import guarded
from navcore.foundation.errors import InputError
from schuler_bench.dashboard import Dashboard
from schuler_bench.jobs import helper, kernels
from schuler_bench.languages import LANGUAGE_SCRIPTS
from schuler_bench.logs import begin_logging
from schuler_bench.memory import bound_arenas
from schuler_bench.session.keeping import NO_HOME, NotKept
from schuler_bench.views import VIEWS, scripts

if TYPE_CHECKING:
    from schuler_bench.http.limits import Limits
    from schuler_bench.http.server import DashboardServer, Inner
    from schuler_bench.session.classroom import Classroom

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
    "tabs",
    "folds",
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
    classroom: Classroom | None = None,
    tell: Callable[[str], None] = lambda line: None,
) -> tuple[DashboardServer, Dashboard]:
    """Start the dashboard and return at once.

    Parameters
    ----------
    host, port, token, allow_origins, frame_origins
        See `schuler_bench.http.server.start`.
    inner, limits
        See `schuler_bench.http.server.start`.
    state, views, classroom
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
    dashboard = Dashboard(state, views, classroom)
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
    as_class: bool = False,
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
    as_class : bool
        The visitors form a class; the code with which one of them leads it is printed.

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
    from schuler_bench.session.classroom import Classroom
    from schuler_bench.session.store import checked_folder

    begin_logging()
    check_address(cluster)
    away_seconds(os.environ)
    bound_arenas()
    state = checked_folder()
    room = Classroom() if as_class else None
    server, dashboard = open_dashboard(
        host, port, token=token, allow_origins=allow_origins, frame_origins=frame_origins, state=state,
        classroom=room, tell=partial(print, flush=True),
    )  # fmt: skip
    use_cluster(cluster)
    link = link_with(server.url, token)
    print(f"Schuler Bench: {link if show_token else server.url}  (Ctrl+C ends it)", flush=True)
    if room is not None:
        print(f"Schuler Bench: lead the class in the tab Learn with the code {room.code}", flush=True)
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
