"""Start and stop the dashboard's server: viser, wrapped."""

from __future__ import annotations

import os
import signal
import socket
import threading
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from schuler_bench.http.access import access_rules
from schuler_bench.http.address import authority, is_loopback, listen, parse_origins
from schuler_bench.http.limits import Limits

if TYPE_CHECKING:
    import viser

    from schuler_bench.http.ids import SessionIds
    from schuler_bench.http.metrics import Metrics

SessionCallback = Callable[["viser.ClientHandle", str], None]

_EXIT_WITHIN_S = 3.0
_SIGNAL_LOOK_S = 0.5
"""The system may hand a signal to any thread: its handler runs when the main thread next wakes."""


@dataclass(frozen=True)
class Inner:
    """Settings of a server behind a door that other processes share (`schuler_bench.workers`).

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
    fail : callable
        ``fail(reason)`` lets ``/healthz`` fail from now on; from any thread.
    keeps_nothing : callable
        ``keeps_nothing((reason, remedy))`` lets ``/healthz`` say so, until it is called with None; from any
        thread.
    """

    viser: viser.ViserServer
    host: str
    port: int
    url: str
    prepare: Callable[[], None]
    fail: Callable[[str], None]
    keeps_nothing: Callable[[tuple[str, str] | None], None]
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
        while not asked.wait(_SIGNAL_LOOK_S):
            pass
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
        key = {} if session_ids is None else {"cookie_key": session_ids.key}
        access = replace(access, framed_by=framed_by, **key)
        # Only now: what is refused above is refused without the half second that importing viser takes.
        from schuler_bench.http.running import Running

        forwarded, limits = inner is not None, limits or Limits()
        running = Running(listener, access, limits, session_ids, page_scripts, metrics, forwarded=forwarded)
    except BaseException:
        listener.close()
        raise
    callbacks = ThreadPoolExecutor(max_workers=8, thread_name_prefix="session")
    running.follow_visits(callbacks, on_connect, on_disconnect)
    named_host = {"0.0.0.0": "127.0.0.1", "::": "::1"}.get(host, host)
    address = f"http://{authority(named_host, bound_port)}/"
    site = running.site
    told = site.prepare, site.fail, site.keeps_nothing
    return DashboardServer(running.viser, host, bound_port, address, *told, callbacks)
