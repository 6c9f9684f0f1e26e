"""Answers to HTTP requests: page, script files, health, redirects, refusals."""

import asyncio
import html
import math
import re
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from http import HTTPStatus
from urllib.parse import parse_qsl, urlencode

from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from schuler_bench.http.access import (
    Access,
    Refusal,
    Throttle,
    answer_headers,
    health,
    refuse_address,
    security_headers,
    shown,
)
from schuler_bench.http.address import FORWARDED
from schuler_bench.http.connection import Connection
from schuler_bench.http.ids import SessionIds, is_shared
from schuler_bench.http.page import File, Page
from schuler_bench.http.places import Places
from schuler_bench.jobs import kernels

_SESSION_PATH = re.compile(r"/s/([A-Za-z0-9_-]{8,64})(/?)")
_PLACE_PATH = re.compile(r"/s/([A-Za-z0-9_-]{8,64})/place")
_FULL = "All places are taken; try again later."
_LONGEST_TURN_S = 5.0
"""Longest time for which a token is throttled, when very many are guessed."""
_METRICS = "text/plain; version=1.0.0; charset=utf-8"
_FOR_EVER = "private, max-age=31536000, immutable"


@dataclass
class Site:
    """Answers every request; a None answer lets a websocket open.

    Attributes
    ----------
    access : Access
        Who may come in.
    ids : SessionIds
        Makes and recognises the ids of sessions.
    places : Places
        How many may come in.
    throttle : Throttle
        Of guesses of the token.
    load_page : callable
        Makes the page at the first request for it.
    forwarded : bool
        A door before this process tells where requests come from.
    metrics : callable or None
        Gives the figures for ``/metrics``; None: there are none.
    fault : str
        What keeps the server from its work, for ``/healthz``; without a place on the server.
    unkept : (str, str) or None
        Why nothing is kept, and what can be done, likewise.
    """

    access: Access
    ids: SessionIds
    places: Places
    throttle: Throttle
    load_page: Callable[[], Page]
    forwarded: bool = False
    metrics: Callable[[], bytes] | None = None
    fault: str = ""
    unkept: tuple[str, str] | None = None
    ready: threading.Event = field(default_factory=threading.Event)
    _page: Page | None = None
    _loading: asyncio.Lock = field(default_factory=asyncio.Lock)

    async def process_request(self, connection: Connection, request: Request) -> Response | None:
        """Answer a request; None accepts a websocket and notes its session."""
        connection.asked = True
        while not self.ready.is_set():
            await asyncio.sleep(0.005)
        headers = request.headers
        if self.forwarded:
            connection.address = headers.get(FORWARDED, "")
        path, _, query = request.path.partition("?")
        refusal = refuse_address(self.access, headers)
        if refusal is not None:
            return _refuse(refusal)
        if path == "/healthz":
            status = HTTPStatus.SERVICE_UNAVAILABLE if self.fault else HTTPStatus.OK
            told = health(self.fault, self.unkept, kernels=kernels.words())
            return _respond(status, told, "application/json")
        websocket = any("websocket" in value.lower() for value in headers.get_all("Upgrade"))
        pairs = parse_qsl(query, keep_blank_values=True)
        tokens = [] if websocket else [value for name, value in pairs if name == "token"]
        if self.access.token is not None:
            refused = await self._refuse_unknown(connection, headers, tokens)
            if refused is not None:
                return refused
            if tokens:
                return self._exchange_token(path, pairs, headers)
        return (
            self._open(connection, path) if websocket else await self._get(connection, path, query, headers)
        )

    async def _refuse_unknown(
        self, connection: Connection, headers: Headers, in_query: Sequence[str]
    ) -> Response | None:
        """Judge what is shown for the token; None lets the request pass.

        An address that has guessed too often waits, with a right token too: it would be told from a wrong one
        otherwise. Only the right cookie always passes, since it cannot be guessed.
        """
        given, address = shown(self.access, headers, in_query), connection.address
        if given is None:
            how = "This bench needs its token: open its address with ?token=... at the end."
            return _refuse(Refusal(HTTPStatus.UNAUTHORIZED, how))
        if given.by_cookie and given.right:
            return None
        wait_s = self.throttle.wait_s(address, by_cookie=given.by_cookie)
        turn_s = None if wait_s > 0.0 else self.throttle.turn_s(0.0 if given.by_cookie else _LONGEST_TURN_S)
        if turn_s is None:
            extra = {"Retry-After": str(math.ceil(wait_s) or 1)}
            return _respond(
                HTTPStatus.TOO_MANY_REQUESTS, "Too many wrong tokens; try again later.", extra=extra
            )
        self.throttle.failed(address)  # before it waits: of many at once, no more are judged
        await asyncio.sleep(turn_s)
        if not given.right:
            return _refuse(Refusal(HTTPStatus.UNAUTHORIZED, given.reason))
        self.throttle.forgive(address)
        return None

    def process_response(self, connection: Connection, request: Request, response: Response) -> None:
        """Add the security headers to whatever is answered, the library's own refusals included."""
        del connection
        if response.status_code == HTTPStatus.SWITCHING_PROTOCOLS:
            return
        host = request.headers.get_all("Host")
        known = host[0].lower() if len(host) == 1 and host[0].lower() in self.access.hosts else ""
        # A frame may hold a single view (shell/static/alone.js), never the page with its controls.
        alone = "view" in dict(parse_qsl(request.path.partition("?")[2], keep_blank_values=True))
        framed_by = self.access.framed_by if alone else frozenset[str]()
        for name, value in security_headers(known, framed_by).items():
            response.headers[name] = value

    def _open(self, connection: Connection, path: str) -> Response | None:
        match = _SESSION_PATH.fullmatch(path)
        if match is None or is_shared(match.group(1)):
            return _not_found()
        # A page cannot be redirected here; one with an id that is not ours begins anew, under an id that is.
        connection.session_id = match.group(1) if self.ids.accepts(match.group(1)) else self.ids.new()
        return None if self.places.take(connection) else _full()

    async def _get(self, connection: Connection, path: str, query: str, headers: Headers) -> Response:
        if path == "/":
            return _redirect(_with_query(f"s/{self.ids.new()}/", query))
        session = _SESSION_PATH.fullmatch(path)
        if session is not None:
            asked, slash = session.groups()
            # A shared state is never worked on: whoever opens it gets a copy of their own.
            copy = self.ids.new_copy(asked) if is_shared(asked) else None
            id = copy or (asked if self.ids.accepts(asked) else self.ids.new())
            if id != asked or not slash:
                return _redirect(_with_query(f"../{id}/" if slash else f"{id}/", query))
            self.places.invite(id)
            if not self.places.has_room(connection.address, id):
                return _full()
            return await _serve((await self._loaded()).html, headers, "no-cache")
        returning = _PLACE_PATH.fullmatch(path)
        if returning is not None:  # a person has come back to a page that was idle (static/place.js)
            if not self.ids.accepts(returning.group(1)):
                return _respond(HTTPStatus.GONE, "This session is not known here; open the page anew.")
            self.places.invite(returning.group(1))
            return _respond(HTTPStatus.NO_CONTENT, "")
        if path == "/metrics" and self.metrics is not None:
            return _respond(HTTPStatus.OK, await asyncio.to_thread(self.metrics), _METRICS)
        if path.startswith("/static/"):
            file = (await self._loaded()).files.get(path.removeprefix("/static/"))
            if file is not None:
                return await _serve(file, headers, _FOR_EVER)
        return _not_found()

    def fail(self, fault: str) -> None:
        """Let ``/healthz`` fail from now on; from any thread."""
        self.fault = fault

    def keeps_nothing(self, unkept: tuple[str, str] | None) -> None:
        """Let ``/healthz`` say that nothing is kept, or (None) no longer so; from any thread."""
        self.unkept = unkept

    def prepare(self) -> None:
        """Make the page and compress its files before they are asked for; from any thread."""
        page = self._page or self.load_page()
        for file in (page.html, *page.files.values()):
            _ = file.zipped
        self._page = self._page or page

    async def _loaded(self) -> Page:
        async with self._loading:
            if self._page is None:
                self._page = await asyncio.to_thread(self.load_page)
            return self._page

    def _exchange_token(self, path: str, pairs: list[tuple[str, str]], headers: Headers) -> Response:
        if path != "/" and _SESSION_PATH.fullmatch(path) is None:
            return _not_found()
        # Relative to the last part of the path, whatever a reverse proxy has put before it.
        rest = urlencode([pair for pair in pairs if pair[0] != "token"])
        target = _with_query(path.rpartition("/")[2] or "./", rest)
        cookie = {"Set-Cookie": self.access.cookie_header(headers["Host"].lower())}
        if "cross-site" in headers.get_all("Sec-Fetch-Site"):
            # Coming from a link on another site, the browser would withhold a strict cookie from a redirect;
            # a page that moves on by itself counts as ours.
            refresh = f'<meta http-equiv="refresh" content="0;url={html.escape(target)}">'
            moving_on = f"<!doctype html>{refresh}<title>...</title>"
            return _respond(HTTPStatus.OK, moving_on, "text/html; charset=utf-8", cookie)
        return _redirect(target, cookie)


async def _serve(file: File, headers: Headers, cache: str) -> Response:
    zipped = any("gzip" in value.lower() for value in headers.get_all("Accept-Encoding"))
    extra = {"Cache-Control": cache, "Vary": "Accept-Encoding"}
    if zipped:
        extra["Content-Encoding"] = "gzip"
    content = await asyncio.to_thread(lambda: file.zipped) if zipped else file.plain
    return _respond(HTTPStatus.OK, content, file.content_type, extra)


def _refuse(refusal: Refusal) -> Response:
    unknown = refusal.status == HTTPStatus.UNAUTHORIZED
    challenge = {"WWW-Authenticate": 'Bearer realm="schuler"'} if unknown else {}
    return _respond(refusal.status, refusal.reason, extra=challenge)


def _full() -> Response:
    return _respond(HTTPStatus.SERVICE_UNAVAILABLE, _FULL, extra={"Retry-After": "30"})


def _not_found() -> Response:
    return _respond(HTTPStatus.NOT_FOUND, "No such page.")


def _redirect(target: str, extra: dict[str, str] | None = None) -> Response:
    return _respond(HTTPStatus.FOUND, "", extra={"Location": target, **(extra or {})})


def _respond(
    status: HTTPStatus,
    body: str | bytes,
    content_type: str = "text/plain; charset=utf-8",
    extra: dict[str, str] | None = None,
) -> Response:
    content = body if isinstance(body, bytes) else body.encode()
    if isinstance(body, str) and content_type.startswith("text/plain") and content:
        content += b"\n"
    headers = answer_headers(len(content), content_type) | (extra or {})
    return Response(status.value, status.phrase, Headers(headers), content)


def _with_query(target: str, query: str) -> str:
    return f"{target}?{query}" if query and re.fullmatch(r"[!-~]*", query) else target
