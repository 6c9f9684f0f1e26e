"""Start and stop the dashboard's server: viser, wrapped."""

from __future__ import annotations

import asyncio
import logging
import os
import signal
import socket
import threading
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from app.http.access import access_rules
from app.http.address import authority, is_loopback, listen, parse_origins
from app.http.limits import Limits

if TYPE_CHECKING:
    import viser

    from app.http.access import Throttle
    from app.http.connection import Connection
    from app.http.ids import SessionIds
    from app.http.metrics import Metrics
    from app.http.places import Door, Places
    from app.http.site import Site

SessionCallback = Callable[["viser.ClientHandle", str], None]

_TITLE = "Schuler Bench"
_EXIT_WITHIN_S = 3.0
_log = logging.getLogger("schuler.http")


@dataclass(frozen=True)
class Inner:
    """What stands behind a door that other processes share (`app.workers`).

    Attributes
    ----------
    listener : socket.socket
        Bound to this machine; the door connects to it.
    loopback : bool
        Only this machine can reach the door.
    """

    listener: socket.socket
    loopback: bool


@dataclass
class _Visit:
    session_id: str
    shown: Future[None] | None = None


@dataclass
class DashboardServer:
    """A running dashboard.

    Attributes
    ----------
    viser : viser.ViserServer
        The server whose clients are handed to `on_connect`.
    host : str
        As asked for.
    port : int
        The port that was bound.
    url : str
        Where to open it, without the token.
    prepare : callable
        Makes the page's files before they are asked for; from any thread.
    """

    viser: viser.ViserServer
    host: str
    port: int
    url: str
    prepare: Callable[[], None]
    _callbacks: ThreadPoolExecutor
    _stopping: threading.Lock = field(default_factory=threading.Lock)
    _stopped: bool = False

    def stop(self) -> None:
        """Close every connection and stop serving; does nothing the second time."""
        with self._stopping:
            if self._stopped:
                return
            self._stopped = True
        self.viser.stop()
        self._callbacks.shutdown(wait=False, cancel_futures=True)

    def wait(self) -> None:
        """Block until SIGINT or SIGTERM, then stop. To be called from the main thread.

        Callbacks that still compute are not waited for: the process ends within 5 s of the signal, at once on
        the second one, with exit code 0.
        """
        asked = threading.Event()

        def leave(*_: object) -> None:
            if asked.is_set():
                os._exit(0)
            asked.set()

        signals = (signal.SIGINT, signal.SIGTERM)
        previous = [signal.signal(number, leave) for number in signals]
        asked.wait()
        # Python waits for every pool thread at exit, however long it computes.
        hard_end = threading.Timer(_EXIT_WITHIN_S, os._exit, (0,))
        hard_end.daemon = True
        hard_end.start()
        self.stop()
        for number, handler in zip(signals, previous, strict=True):
            signal.signal(number, handler)


def start(
    host: str = "127.0.0.1",
    port: int = 8080,
    *,
    token: str | None = None,
    allow_origins: Iterable[str] = (),
    frame_origins: Iterable[str] = (),
    on_connect: SessionCallback,
    on_disconnect: SessionCallback,
    page_scripts: Sequence[Path] = (),
    limits: Limits | None = None,
    session_ids: SessionIds | None = None,
    metrics: Callable[[], Metrics] | None = None,
    inner: Inner | None = None,
) -> DashboardServer:
    """Serve the dashboard.

    Parameters
    ----------
    host : str
        Name or address of this machine.
    port : int
        0 takes any free port.
    token : str or None
        What a visitor must know; compulsory when others than this machine can reach the address.
    allow_origins : iterable of str
        Further addresses under which the page may be opened, for example behind a reverse proxy.
    frame_origins : iterable of str
        Origins whose pages may show a single view (``?view=bode``) in a frame.
    on_connect : callable
        ``on_connect(client, session_id)``, in a worker thread, when a page has opened or was reloaded.
    on_disconnect : callable
        The same when it has gone; for one client never before `on_connect` has returned.
    page_scripts : sequence of pathlib.Path
        JavaScript files of ours, run in the page before viser's own.
    limits : Limits or None
        Bounds; None for the usual ones.
    session_ids : SessionIds or None
        Makes and recognises the ids of sessions; None for a key of this process.
    metrics : callable or None
        Makes the figures for ``/metrics`` when they are first asked for; None: there are none.
    inner : Inner or None
        Of a worker: where the door that listens at ``host`` and ``port`` passes requests on to.

    Raises
    ------
    InputError
        The address cannot be bound, the token is missing, an origin is malformed, or viser is another
        version.
    """
    origins, framed_by = parse_origins(allow_origins), parse_origins(frame_origins, "--frame-origin")
    listener = listen(host, port) if inner is None else inner.listener
    try:
        bound_port = listener.getsockname()[1] if inner is None else port
        loopback = is_loopback(listener) if inner is None else inner.loopback
        access = access_rules(host, bound_port, loopback=loopback, token=token, origins=origins)
        access = replace(access, framed_by=framed_by)
        # Only now: what is refused above is refused without the half second that importing viser takes.
        from app.bridge import server as bridge
        from app.bridge.mends import pool_of
        from app.http.access import Throttle
        from app.http.ids import SessionIds
        from app.http.page import FIRST_SCRIPTS, PLOTLY, build_page
        from app.http.places import Door, Places
        from app.http.site import Site
        from navcore.foundation.version import __version__

        bridge.require_known_version()
        limits = limits or Limits()
        places = Places(limits)
        site = Site(
            access=access,
            ids=session_ids or SessionIds(),
            places=places,
            forwarded=inner is not None,
            throttle=Throttle(limits.token_guesses, limits.token_refill_s),
            version=__version__,
            load_page=lambda: build_page([*FIRST_SCRIPTS, *page_scripts], [PLOTLY], _TITLE),
        )
        door = Door(limits)
        serve = partial(_serve, listener=listener, site=site, limits=limits, door=door, places=places)
        server = bridge.make_server(serve, _TITLE)
    except BaseException:
        listener.close()
        raise
    if metrics is not None:
        throttle, pool = site.throttle, pool_of(server)
        site.metrics = _metrics_of(metrics, lambda: _figures(places, door, throttle, pool))
    callbacks = ThreadPoolExecutor(max_workers=8, thread_name_prefix="session")
    _follow_visits(server, limits, callbacks, on_connect, on_disconnect)
    bridge.plotly_is_on_the_page(server)
    server.gui.configure_theme(show_share_button=False)
    site.ready.set()
    shown = {"0.0.0.0": "127.0.0.1", "::": "::1"}.get(host, host)
    return DashboardServer(
        server, host, bound_port, f"http://{authority(shown, bound_port)}/", site.prepare, callbacks
    )


def _serve(
    handler: Callable[[Any], Any],
    host: str,
    port: int,
    *,
    listener: socket.socket,
    site: Site,
    limits: Limits,
    door: Door,
    places: Places,
    **keywords: Any,
) -> Any:
    """Stand in for websockets' ``serve`` in viser: its arguments, our socket, answers and checks."""
    import websockets.asyncio.server

    from app.http.connection import Connection

    del host, port

    async def placed(connection: Any) -> None:
        door.leave(connection)
        try:
            await handler(connection)
        finally:
            places.leave(connection)

    ours = {
        "process_request": site.process_request,
        "process_response": site.process_response,
        "server_header": None,
        "open_timeout": limits.request_s,
        "max_size": limits.frame_bytes,
        "max_queue": limits.frames_waiting,
        "ping_interval": limits.ping_s,
        "ping_timeout": limits.ping_s,
        "close_timeout": limits.close_s,
        "logger": _quiet_log(),
        "create_connection": partial(Connection, limits=limits, door=door, places=places),
    }
    return websockets.asyncio.server.serve(placed, sock=listener, **{**keywords, **ours})


def _metrics_of(make: Callable[[], Metrics], own: Callable[[], dict[str, float]]) -> Callable[[], bytes]:
    made: list[Metrics] = []

    def text() -> bytes:
        if not made:
            made.append(make())
            made[0].sources.append(own)
        return made[0].text()

    return text


def _figures(places: Places, door: Door, throttle: Throttle, pool: Any) -> dict[str, float]:
    return {
        "open_pages": float(len(places)),
        "connections_at_the_door": float(len(door)),
        "places_given_up_total": float(places.given_up),
        "connections_turned_away_total": float(door.turned_away),
        "wrong_tokens_total": float(throttle.guesses),
        "callbacks_dropped_total": float(getattr(pool, "dropped", 0)),
    }


def _follow_visits(
    server: viser.ViserServer,
    limits: Limits,
    callbacks: ThreadPoolExecutor,
    on_connect: SessionCallback,
    on_disconnect: SessionCallback,
) -> None:
    from app.bridge import server as bridge
    from app.bridge.mends import forget_callbacks
    from app.bridge.texts import speak
    from app.http.connection import Guest
    from app.http.frames import Gate, Uploading
    from app.http.language import language_of
    from app.languages.wording import wording

    visits: dict[int, _Visit] = {}
    gates: dict[int, Gate] = {}
    uploading = Uploading(limits)

    def opened(client_id: int, connection: Connection) -> None:
        visits[client_id] = _Visit(connection.session_id)
        connection.gate = gates[client_id] = Gate(Guest(server, client_id), limits, uploading)
        if connection.request is not None:
            speak(server, client_id, wording(language_of(connection.request.headers)))

    # The page is shown once viser knows its camera; viser calls this in the event loop, before `closed`.
    @server.on_client_connect
    async def _(client: viser.ClientHandle) -> None:
        visit = visits.get(client.client_id)
        if visit is not None:
            bridge.plotly_is_on_the_page(client)
            visit.shown = callbacks.submit(_call, on_connect, client, visit.session_id)

    @server.on_client_disconnect
    async def _(client: viser.ClientHandle) -> None:
        visit = visits.get(client.client_id)
        if visit is not None and visit.shown is not None:
            await asyncio.wrap_future(visit.shown)
            await asyncio.wrap_future(callbacks.submit(_call, on_disconnect, client, visit.session_id))

    async def closed(client_id: int) -> None:
        visits.pop(client_id, None)
        gates.pop(client_id).close()
        forget_callbacks(server, client_id)

    bridge.on_socket(server, opened, closed)


def _call(callback: SessionCallback, client: viser.ClientHandle, session_id: str) -> None:
    try:
        callback(client, session_id)
    except Exception as error:
        _log.exception("a session callback failed")
        client.add_notification("Something went wrong", f"{type(error).__name__}: {error}", color="red")


def _quiet_log() -> logging.Logger:
    """Return the log for websockets: never the requests (they carry the token), one line a fault."""
    log = logging.getLogger("schuler.http.websockets")
    log.setLevel(logging.WARNING)
    if not log.filters:
        log.addFilter(_one_line)
    return log


def _one_line(record: logging.LogRecord) -> bool:
    # A stranger's malformed request is not worth a line.
    if record.getMessage() == "opening handshake failed":
        return False
    if record.exc_info and record.exc_info[1] is not None:
        record.msg = f"{record.msg} ({type(record.exc_info[1]).__name__})"
        record.exc_info = record.exc_text = None
    return True
