"""Who may come in: Host, Origin and token of a request, throttled guesses; and what our page may do."""

import email.utils
import hashlib
import hmac
import json
import secrets
import time
from collections import OrderedDict
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field
from http import HTTPStatus
from typing import Protocol

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.version import __version__
from schuler_bench.http.address import LOOPBACK_NAMES, authority

SHORTEST_TOKEN = 8
"""Characters of a token, also on this machine: a reverse proxy may stand before it. Guesses are throttled."""


class RequestHeaders(Protocol):
    """The part of a header mapping that is read here."""

    def get_all(self, key: str) -> list[str]:
        """Return every value of a header, in order."""
        ...


@dataclass(frozen=True)
class Refusal:
    """An answer that keeps the visitor out.

    Attributes
    ----------
    status : HTTPStatus
        What to answer.
    reason : str
        Plain words for a person; never echoes the request.
    """

    status: HTTPStatus
    reason: str


@dataclass(frozen=True)
class Access:
    """The rules of one running server.

    Attributes
    ----------
    hosts : frozenset of str
        Accepted Host headers, exact.
    origins : frozenset of str
        Accepted Origin headers, exact.
    loopback : bool
        Only this machine can reach the server.
    token : str or None
        What a visitor must know.
    cookie_name : str
        Carries the port: cookies are shared by all ports of a host.
    framed_by : frozenset of str
        Origins whose pages may show a single view in a frame.
    cookie_key : bytes
        Of this server: without it a cookie cannot be made from a token, nor guessed.
    """

    hosts: frozenset[str]
    origins: frozenset[str]
    loopback: bool
    token: str | None
    cookie_name: str
    framed_by: frozenset[str] = frozenset()
    cookie_key: bytes = field(default_factory=lambda: secrets.token_bytes(32), repr=False)

    @property
    def cookie(self) -> str:
        """Value of the cookie of who has shown the token; another service of the same host may see it."""
        token = (self.token or "").encode("utf-8", "surrogateescape")
        return hmac.new(self.cookie_key, b"schuler bench cookie " + token, hashlib.sha256).hexdigest()

    def cookie_header(self, host: str) -> str:
        """Return the Set-Cookie value for a visitor who showed the token."""
        secure = "; Secure" if f"https://{host}" in self.origins else ""
        return f"{self.cookie_name}={self.cookie}; Path=/; HttpOnly; SameSite=Strict{secure}"


def access_rules(
    host: str,
    port: int,
    *,
    loopback: bool,
    token: str | None,
    origins: frozenset[str],
) -> Access:
    """Make the rules for an address.

    Parameters
    ----------
    host : str
        The host as the user gave it.
    port : int
        The port that was bound.
    loopback : bool
        Only this machine can reach the server.
    token : str or None
        What a visitor must know; compulsory when others can reach the server.
    origins : frozenset of str
        Further origins, see `schuler_bench.http.address.parse_origins`.

    Raises
    ------
    InputError
        The token is missing although others can reach the server, is too short, or is empty.
    """
    if token is not None and not token.strip():
        raise InputError([Fault("serve", "--token", token, "must not be empty")])
    if token is None and not loopback:
        how = (
            "others can reach this address, so a token is needed: add --token with a secret of your own, "
            "--generate-token to have one made and printed, or use --host 127.0.0.1"
        )
        raise InputError([Fault("serve", "--host", host, how)])
    if token is not None and len(token.strip()) < SHORTEST_TOKEN:
        allowed = f"must have at least {SHORTEST_TOKEN} characters, a shorter one is soon guessed"
        raise InputError([Fault("serve", "--token", "*" * len(token), allowed)])
    own = {authority(name, port) for name in (*LOOPBACK_NAMES, host)}
    return Access(
        hosts=frozenset(own | {origin.partition("://")[2] for origin in origins}),
        origins=frozenset({f"http://{name}" for name in own} | origins),
        loopback=loopback,
        token=token,
        cookie_name=f"schuler_{port}",
    )


def refuse_address(access: Access, headers: RequestHeaders) -> Refusal | None:
    """Judge Host and Origin; None lets the request pass.

    A page elsewhere can make a browser connect here (foreign Origin), or make its own name point here
    (foreign Host, "DNS rebinding"). Both headers are set by the browser, out of the page's reach. Equality is
    exact.
    """
    host = headers.get_all("Host")
    if len(host) != 1 or host[0].lower() not in access.hosts:
        return Refusal(
            HTTPStatus.MISDIRECTED_REQUEST,
            "This server is not known under that name. Open it under the address it printed, or start it "
            "with --allow-origin (or SCHULER_ALLOW_ORIGIN) and the address you use, for example http://localhost:9000.",
        )
    origin = headers.get_all("Origin")
    if origin and (len(origin) != 1 or origin[0] not in access.origins):
        return Refusal(HTTPStatus.FORBIDDEN, "Requests made by pages of another origin are refused.")
    # Browsers always send Origin with a websocket. Programs need not, where nobody else can come in anyway.
    if not origin and not access.loopback and access.token is None:
        return Refusal(HTTPStatus.FORBIDDEN, "A request without an Origin needs a token here.")
    return None


@dataclass(frozen=True)
class Shown:
    """Token or cookie with which a request asks for access.

    Attributes
    ----------
    by_cookie : bool
        It is a cookie, which nobody can guess, or one of another token.
    right : bool
        It fits.
    reason : str
        Why not.
    """

    by_cookie: bool
    right: bool
    reason: str = "Wrong token: open this address with ?token=... at the end."


def shown(access: Access, headers: RequestHeaders, in_query: Sequence[str] = ()) -> Shown | None:
    """Judge the token of a request, by one comparison in constant time.

    The first of these counts: ``?token=``, the cookie, ``Authorization: Bearer``.

    Parameters
    ----------
    access : Access
        Its token is not None.
    headers : RequestHeaders
        Of the request.
    in_query : sequence of str
        Tokens in its address.

    Returns
    -------
    Shown or None
        None: the request shows nothing.
    """
    kept = [] if in_query else [value.strip() for value in cookies(headers, access.cookie_name)]
    lines = headers.get_all("Authorization")
    bearer = [value[7:].strip() for value in lines if value[:7].lower() == "bearer "]
    values = list(in_query) or kept or bearer
    if not values:
        return None
    if len(values) > 1:
        return Shown(bool(kept), False, "Show one token, once.")
    return Shown(bool(kept), _same(values[0], access.cookie if kept else access.token or ""))


def cookies(headers: RequestHeaders, name: str) -> list[str]:
    """Values that a request has for a cookie."""
    # Not http.cookies: it drops everything after a cookie it cannot read, and other services share this host.
    pairs = (part.partition("=") for line in headers.get_all("Cookie") for part in line.split(";"))
    return [value for key, _, value in pairs if key.strip() == name]


def _same(offered: str, right: str) -> bool:
    return hmac.compare_digest(
        offered.encode("utf-8", "surrogateescape"), right.encode("utf-8", "surrogateescape")
    )


def security_headers(host: str, framed_by: Collection[str] = ()) -> dict[str, str]:
    """Return the headers of every answer.

    Scripts run only from this server's own files: no inline script, no inline handler and no ``eval``, so
    that text which reaches the page as HTML by mistake stays harmless. viser needs: WebAssembly (zstd),
    workers made from blobs, inline styles, pictures and fonts from blobs and data addresses.

    Parameters
    ----------
    host : str
        The Host header, already checked; the websocket goes there. Some browsers do not count it as 'self'.
    framed_by : collection of str
        Origins whose pages may show the answer in a frame; none by default.
    """
    socket = f"ws://{host} wss://{host}" if host else ""
    policy = {
        "default-src": "'none'",
        "script-src": "'self' 'wasm-unsafe-eval'",
        "worker-src": "blob:",
        "style-src": "'self' 'unsafe-inline'",
        "img-src": "'self' data: blob:",
        "font-src": "'self' data:",
        "connect-src": f"'self' {socket} data: blob:",
        "base-uri": "'none'",
        "form-action": "'none'",
        "frame-ancestors": " ".join(sorted(framed_by)) or "'none'",
    }
    return {
        "Content-Security-Policy": "; ".join(f"{key} {value}".strip() for key, value in policy.items()),
        "X-Content-Type-Options": "nosniff",
        # For old browsers: those that know frame-ancestors ignore it.
        "X-Frame-Options": "DENY",
        # The path of a page is a capability: whoever knows it sees the visitor's work.
        "Referrer-Policy": "no-referrer",
        "Cross-Origin-Opener-Policy": "same-origin",
        "Cross-Origin-Resource-Policy": "same-origin",
        "Permissions-Policy": "camera=(), microphone=(), geolocation=()",
    }


def answer_headers(length: int, content_type: str) -> dict[str, str]:
    """Return what every answer says of itself."""
    return {
        "Date": email.utils.formatdate(usegmt=True),
        "Content-Type": content_type,
        "Content-Length": str(length),
        "Cache-Control": "no-store",
        "Connection": "close",
    }


def health(fault: str = "", unkept: tuple[str, str] | None = None, **notes: str) -> str:
    """Answer to ``/healthz``, JSON.

    Parameters
    ----------
    fault : str
        What keeps the server from its work; empty: nothing.
    unkept : (str, str), optional
        Why it works, but keeps nothing, and what can be done.
    **notes : str
        Further words; empty ones are left out.
    """
    state = {"status": "ok"}
    if fault:
        state = {"status": "failed", "reason": fault}
    elif unkept is not None:
        state = {"status": "nothing is kept", "reason": unkept[0], "remedy": unkept[1]}
    state |= {name: note for name, note in notes.items() if note}
    return json.dumps({**state, "version": __version__})


_MOST_ADDRESSES = 4096


@dataclass
class Throttle:
    """Of guesses: a bucket for each address, which is refilled slowly, and turns for all together.

    Attributes
    ----------
    burst : int
        Wrong guesses of an address that are judged at once.
    refill_s : float
        So long it takes until one more is.
    all_burst : int
        Guesses of all addresses that are judged at once.
    all_refill_s : float
        Time between two more; they wait for their turn.
    clock : callable
        Seconds, monotonic.
    guesses : int
        Wrong ones so far.
    """

    burst: int = 10
    refill_s: float = 2.0
    all_burst: int = 300
    all_refill_s: float = 0.05
    clock: Callable[[], float] = time.monotonic
    guesses: int = 0
    _spent: OrderedDict[str, tuple[float, float]] = field(default_factory=OrderedDict)
    _all_until_s: float = 0.0

    def wait_s(self, address: str, *, by_cookie: bool = False) -> float:
        """Seconds until a guess of this address is judged again; 0: now.

        Cookies of an earlier token, which open pages go on showing, take four fifths of the bucket at most:
        the right token can still be shown.
        """
        burst = 0.8 * self.burst if by_cookie else self.burst
        return max(0.0, (self._level(address) - burst + 1.0) * self.refill_s)

    def turn_s(self, most_s: float) -> float | None:
        """Seconds until it is the turn of one more guess, which then takes it; None: more than ``most_s``."""
        now_s = self.clock()
        until_s = max(self._all_until_s, now_s - self.all_burst * self.all_refill_s) + self.all_refill_s
        if until_s - now_s > most_s:
            return None
        self._all_until_s = until_s
        return max(0.0, until_s - now_s)

    def failed(self, address: str) -> None:
        """Note a wrong guess."""
        self.guesses += 1
        self._add(address, 1.0)

    def forgive(self, address: str) -> None:
        """Take a guess back that was noted before it was judged, and was right."""
        self.guesses -= 1
        self._add(address, -1.0)

    def _add(self, address: str, guesses: float) -> None:
        level = self._level(address) + guesses
        self._spent.pop(address, None)
        self._spent[address] = (level, self.clock())
        while len(self._spent) > _MOST_ADDRESSES:
            self._spent.popitem(last=False)

    def _level(self, address: str) -> float:
        level, at_s = self._spent.get(address, (0.0, 0.0))
        return max(0.0, level - (self.clock() - at_s) / self.refill_s)
