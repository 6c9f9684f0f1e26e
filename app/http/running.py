"""A running server: viser's, with our answers, our checks and our bounds; loaded once an address is bound."""

from __future__ import annotations

import asyncio
import logging
import re
import socket
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Executor, Future
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import viser
import websockets.asyncio.server

from navcore.foundation.kernel_wait import waiting
from navcore.foundation.stage_cache import working_for
from navcore.foundation.text import Text
from schuler_bench.bridge import server as bridge
from schuler_bench.bridge.controls import Guest
from schuler_bench.bridge.mends import forget_callbacks, pool_of, work_for
from schuler_bench.bridge.texts import speak
from schuler_bench.http.access import Access, RequestHeaders, Throttle, cookies
from schuler_bench.http.connection import Connection
from schuler_bench.http.frames import Gate, Uploading
from schuler_bench.http.ids import SessionIds, log_name
from schuler_bench.http.limits import Limits
from schuler_bench.http.page import FIRST_SCRIPTS, PLOTLY, build_page
from schuler_bench.http.places import Door, Places
from schuler_bench.http.site import Site
from schuler_bench.jobs.words import what_failed
from schuler_bench.languages.wording import NAMES, wording

if TYPE_CHECKING:
    from schuler_bench.http.metrics import Metrics

SessionCallback = Callable[[viser.ClientHandle, str], None]

_TITLE = "Schuler Bench"
COOKIE = "schuler_language"
"""Written by language.js: ``?lang=``, the visitor's last choice, or the browser's first language we have."""
ENGLISH = "en"
_LONGEST_HEADER = 500
_log = logging.getLogger("schuler.http")


class Running:
    """The server behind one address.

    Parameters
    ----------
    listener, access, limits, session_ids, page_scripts, metrics, forwarded
        See `schuler_bench.http.server.start`.

    Attributes
    ----------
    viser : viser.ViserServer
        Has begun to listen.
    site : Site
        Its answers.
    """

    def __init__(
        self,
        listener: socket.socket,
        access: Access,
        limits: Limits,
        session_ids: SessionIds | None,
        page_scripts: Sequence[Path],
        metrics: Callable[[], Metrics] | None,
        *,
        forwarded: bool,
    ) -> None:
        bridge.require_known_version()
        self._listener, self._limits = listener, limits
        self._door, self._places = Door(limits), Places(limits)
        self.site = Site(
            access=access,
            ids=session_ids or SessionIds(),
            places=self._places,
            forwarded=forwarded,
            throttle=Throttle(
                limits.token_guesses, limits.token_refill_s, limits.all_guesses, limits.all_refill_s
            ),
            load_page=lambda: build_page([*FIRST_SCRIPTS, *page_scripts], [PLOTLY], _TITLE),
        )
        self.viser = bridge.make_server(self._serve, _TITLE)
        if metrics is not None:
            self.site.metrics = partial(self._metrics, metrics, [])
        bridge.plotly_is_on_the_page(self.viser)
        self.viser.gui.configure_theme(show_share_button=False)

    def _serve(self, handler: Callable[[Any], Any], host: str, port: int, **keywords: Any) -> Any:
        """Stand in for websockets' ``serve`` in viser: its arguments, our socket, answers and checks."""
        del host, port
        limits, door, places = self._limits, self._door, self._places

        async def placed(connection: Any) -> None:
            door.leave(connection)
            try:
                await handler(connection)
            finally:
                places.leave(connection)

        ours = {
            "process_request": self.site.process_request,
            "process_response": self.site.process_response,
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
        return websockets.asyncio.server.serve(placed, sock=self._listener, **{**keywords, **ours})

    def _metrics(self, make: Callable[[], Metrics], cached: list[Metrics]) -> bytes:
        """Text for ``/metrics``; what gathers it is made when it is first asked for."""
        if not cached:
            cached.append(make())
            cached[0].sources.append(self._figures)
        return cached[0].text()

    def _figures(self) -> dict[str, float]:
        return {
            "open_pages": float(len(self._places)),
            "connections_at_the_door": float(len(self._door)),
            "places_given_up_total": float(self._places.given_up),
            "connections_turned_away_total": float(self._door.turned_away),
            "wrong_tokens_total": float(self.site.throttle.guesses),
            "callbacks_dropped_total": float(getattr(pool_of(self.viser), "dropped", 0)),
        }

    def follow_visits(
        self, callbacks: Executor, on_connect: SessionCallback, on_disconnect: SessionCallback
    ) -> None:
        """Answer from now on, and call back, in threads of ``callbacks``, for pages that open or close."""
        server, uploading = self.viser, Uploading(self._limits)
        sessions: dict[int, str] = {}
        opening: dict[int, Future[None]] = {}
        gates: dict[int, Gate] = {}

        def opened(client_id: int, connection: Connection) -> None:
            sessions[client_id] = connection.session_id
            work_for(server, client_id, log_name(connection.session_id))
            connection.gate = gates[client_id] = uploading.gate(Guest(server, client_id))
            if connection.request is not None:
                speak(server, client_id, wording(language_of(connection.request.headers)))

        # The page is shown once viser knows its camera; viser calls this in the event loop, before `closed`.
        @server.on_client_connect
        async def _(client: viser.ClientHandle) -> None:
            id = sessions.get(client.client_id)
            if id is not None:
                bridge.plotly_is_on_the_page(client)
                opening[client.client_id] = callbacks.submit(_call, on_connect, client, id)

        @server.on_client_disconnect
        async def _(client: viser.ClientHandle) -> None:
            id, showing = sessions.get(client.client_id), opening.pop(client.client_id, None)
            if id is not None and showing is not None:
                await asyncio.wrap_future(showing)
                await asyncio.wrap_future(callbacks.submit(_call, on_disconnect, client, id))

        async def closed(client_id: int) -> None:
            sessions.pop(client_id, None)
            uploading.end(gates.pop(client_id))
            forget_callbacks(server, client_id)

        bridge.on_socket(server, opened, closed)
        self.site.ready.set()


def _call(callback: SessionCallback, client: viser.ClientHandle, session_id: str) -> None:
    try:
        with waiting(), working_for(log_name(session_id)):
            callback(client, session_id)
    except Exception as error:
        _log.exception("a session callback failed")
        client.add_notification(Text("Something went wrong"), what_failed(error), color="red")


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


# ------------------------------------------------------------ the language of a page


def language_of(headers: RequestHeaders) -> str:
    """Language for a request: one of `schuler_bench.languages.wording.NAMES`."""
    chosen = cookies(headers, COOKIE)
    if chosen:
        return _known(chosen[-1:])
    return _known(_accepted(headers.get_all("Accept-Language")))


def _known(wanted: Iterable[str]) -> str:
    """First of some languages that we have.

    Examples
    --------
    >>> _known(["fr-CH", "zh-TW", "en"]), _known(["de", "en-GB", "zh"]), _known(["xx"])
    ('zh-CN', 'en', 'en')
    """
    for name in wanted:
        first = name.strip().lower().partition("-")[0]
        for own in NAMES:
            if own.partition("-")[0] == first:
                return own
    return ENGLISH


def _accepted(lines: Iterable[str]) -> list[str]:
    """Languages of an Accept-Language header, the most wanted first; what cannot be read is left out.

    Examples
    --------
    >>> _accepted(["en;q=0.7, zh-CN, *;q=0.1, zh;q=0.9"])
    ['zh-CN', 'zh', 'en']
    """
    ranked: list[tuple[float, str]] = []
    for part in ",".join(lines)[:_LONGEST_HEADER].split(","):
        one = re.fullmatch(
            r"\s*([A-Za-z]{1,8}(?:-[A-Za-z0-9]{1,8})*)\s*(?:;\s*q=([01](?:\.[0-9]{0,3})?))?\s*", part
        )
        if one is not None:
            ranked.append((-float(one[2] or 1.0), one[1]))
    return [name for _, name in sorted(ranked, key=lambda pair: pair[0])]
