"""Who may come in: Host, Origin and token of a request."""

from __future__ import annotations

import hashlib
import hmac
from dataclasses import dataclass
from http import HTTPStatus
from typing import Protocol

from app.http.address import LOOPBACK_NAMES, authority
from navcore.foundation.errors import Fault, InputError

SHORTEST_TOKEN = 8
"""Characters of a token beyond this machine: guesses are throttled, see `app.http.throttle`."""


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
    """

    hosts: frozenset[str]
    origins: frozenset[str]
    loopback: bool
    token: str | None
    cookie_name: str
    framed_by: frozenset[str] = frozenset()

    def token_is_right(self, offered: str) -> bool:
        """Compare in constant time."""
        return self.token is not None and _same(offered, self.token)

    def cookie_header(self, host: str) -> str:
        """Return the Set-Cookie value for a visitor who showed the token.

        The cookie is derived from the token, so that another service of the same host name, which gets to see
        the cookie too, does not learn the token.
        """
        secure = "; Secure" if f"https://{host}" in self.origins else ""
        return f"{self.cookie_name}={_derived(self.token or '')}; Path=/; HttpOnly; SameSite=Strict{secure}"


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
        Further origins, see `app.http.address.parse_origins`.

    Raises
    ------
    InputError
        The token is missing although others can reach the server, is then too short, or is empty.
    """
    if token is not None and not token.strip():
        raise InputError([Fault("serve", "--token", token, "must not be empty")])
    if token is None and not loopback:
        how = (
            "others can reach this address, so a token is needed: add --token with a secret of your own, "
            "--generate-token to have one made and printed, or use --host 127.0.0.1"
        )
        raise InputError([Fault("serve", "--host", host, how)])
    if token is not None and not loopback and len(token.strip()) < SHORTEST_TOKEN:
        allowed = f"must have at least {SHORTEST_TOKEN} characters where others can reach the server"
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


def refuse_unknown(access: Access, headers: RequestHeaders) -> Refusal | None:
    """Judge the token, shown by cookie or ``Authorization: Bearer``; None lets the request pass."""
    if access.token is None:
        return None
    offered = [value.strip() for value in cookies(headers, access.cookie_name)]
    derived = _derived(access.token)
    authorizations = headers.get_all("Authorization")
    bearer = [value[7:].strip() for value in authorizations if value[:7].lower() == "bearer "]
    # A list, not a generator: all are compared, so that the time does not depend on which one fits.
    fits = [_same(value, derived) for value in offered] + [_same(value, access.token) for value in bearer]
    if any(fits):
        return None
    how = "This bench needs its token: open its address with ?token=... at the end."
    return Refusal(HTTPStatus.UNAUTHORIZED, how)


def offers_token(headers: RequestHeaders) -> bool:
    """Whether the request shows a token itself, which a stranger may be guessing."""
    return any(value[:7].lower() == "bearer " for value in headers.get_all("Authorization"))


def cookies(headers: RequestHeaders, name: str) -> list[str]:
    """Values that a request has for a cookie."""
    # Not http.cookies: it drops everything after a cookie it cannot read, and other services share this host.
    pairs = (part.partition("=") for line in headers.get_all("Cookie") for part in line.split(";"))
    return [value for key, _, value in pairs if key.strip() == name]


def _derived(token: str) -> str:
    key = token.encode("utf-8", "surrogateescape")
    return hmac.new(key, b"schuler bench cookie", hashlib.sha256).hexdigest()


def _same(offered: str, right: str) -> bool:
    return hmac.compare_digest(
        offered.encode("utf-8", "surrogateescape"), right.encode("utf-8", "surrogateescape")
    )
