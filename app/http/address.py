"""Where the server listens, under which names it may be addressed, and where its token comes from."""

import errno
import ipaddress
import os
import re
import secrets
import socket
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import urlsplit

from navcore.foundation.errors import Fault, InputError

LOOPBACK_NAMES = ("localhost", "127.0.0.1", "[::1]")
FORWARDED = "x-schuler-address"
"""Header by which the door of several workers tells where a request comes from; a stranger's is removed."""
_DEFAULT_PORT = {"http": 80, "https": 443}
_LONGEST_TOKEN = 4096
_HOST = re.compile(r"[a-z0-9]([a-z0-9._-]*[a-z0-9])?|\[[0-9a-f:.]+\]")


def listen(host: str, port: int) -> socket.socket:
    """Bind the address, before viser is even imported.

    viser would take the next port silently when one is busy, and hang on a host that cannot be bound. Handing
    it a bound socket leaves neither case, and no moment in which another program could take the port.

    Parameters
    ----------
    host : str
        Name or address of this machine; the first of its addresses is used, IPv4 before IPv6.
    port : int
        0 to 65535; 0 takes any free port.

    Returns
    -------
    socket.socket
        Bound, not yet listening.

    Raises
    ------
    InputError
        The host is not this machine's, the port is busy, reserved or out of range.
    """
    if isinstance(port, bool) or not isinstance(port, int) or not 0 <= port <= 65535:
        raise _fault("--port", port, "must be a whole number from 0 to 65535")
    if not host:
        raise _fault("--host", host, "must be a name or address of this machine, for example 127.0.0.1")
    try:
        addresses = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)
    except (OSError, UnicodeError):
        raise _fault("--host", host, "no such host; must be a name or address of this machine") from None
    family, kind, protocol, _, address = min(addresses, key=lambda entry: entry[0] != socket.AF_INET)
    listener = socket.socket(family, kind, protocol)
    try:
        if os.name == "posix":
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(address)
        # Linux lets two sockets bind one port until one of them listens: claim it now.
        listener.listen(100)
    except OSError as error:
        listener.close()
        raise _why_not_bound(error, host, port) from None
    listener.setblocking(False)
    return listener


def is_loopback(listener: socket.socket) -> bool:
    """Whether only this machine can reach the socket."""
    return ipaddress.ip_address(listener.getsockname()[0].partition("%")[0]).is_loopback


def authority(host: str, port: int, scheme: str = "http") -> str:
    """Return ``host:port`` as a browser writes it: lower case, IPv6 in brackets, no default port."""
    name = host.lower()
    if ":" in name and not name.startswith("["):
        name = f"[{name}]"
    return name if port == _DEFAULT_PORT[scheme] else f"{name}:{port}"


def parse_origins(texts: Iterable[str], option: str = "--allow-origin") -> frozenset[str]:
    """Check and normalise the origins given by the user.

    Parameters
    ----------
    texts : iterable of str
        For example ``https://bench.example.org`` or ``http://10.1.2.3:8080``; no path, no pattern.
    option : str
        By which they were given.

    Returns
    -------
    frozenset of str
        As browsers send them in the Origin header.

    Raises
    ------
    InputError
        One fault for each text that is not an origin.
    """
    faults, origins = [], set()
    for text in texts:
        origin = _origin(text)
        if origin is None:
            wanted = (
                "must be scheme://host or scheme://host:port with http or https, without a path or pattern"
            )
            faults.append(Fault("serve", option, text, wanted))
        else:
            origins.add(origin)
    if faults:
        raise InputError(faults)
    return frozenset(origins)


def _origin(text: str) -> str | None:
    try:
        parts = urlsplit(text)
        port, scheme = parts.port, parts.scheme
    except ValueError:
        return None
    host = parts.netloc.lower()
    if port is not None:
        host = host.rpartition(":")[0]
    plain = parts.path in ("", "/") and "?" not in text and "#" not in text
    if scheme not in _DEFAULT_PORT or not plain or not _HOST.fullmatch(host):
        return None
    return f"{scheme}://{authority(host, _DEFAULT_PORT[scheme] if port is None else port, scheme)}"


def _fault(field: str, value: object, allowed: str) -> InputError:
    return InputError([Fault("serve", field, value, allowed)])


def _why_not_bound(error: OSError, host: str, port: int) -> InputError:
    if error.errno == errno.EADDRINUSE:
        return _fault("--port", port, f"is in use on {host}; choose another, or 0 for any free one")
    if error.errno in (errno.EACCES, errno.EPERM):
        return _fault("--port", port, "is reserved for the system; choose one from 1024 to 65535")
    if error.errno == errno.EADDRNOTAVAIL:
        return _fault("--host", host, "is not an address of this machine")
    return _fault("--host", host, f"cannot be listened on: {error.strerror or error}")


# ------------------------------------------------------------ the token


@dataclass(frozen=True)
class Token:
    """Conditions of access for a visitor.

    Attributes
    ----------
    value : str or None
        None: nothing.
    generated : bool
        It was made just now, and nobody knows it yet.
    """

    value: str | None
    generated: bool = False


def find_token(given: str | None, file: Path | None, generate: bool, environment: Mapping[str, str]) -> Token:
    """Find the token: what is given goes before SCHULER_TOKEN, a file before SCHULER_TOKEN_FILE.

    Parameters
    ----------
    given : str or None
        On the command line.
    file : Path or None
        Its first line is the token.
    generate : bool
        Make one when there is none; it is written to the file, if one is named.
    environment : mapping
        SCHULER_TOKEN, SCHULER_TOKEN_FILE.

    Raises
    ------
    InputError
        The file cannot be read or written, or holds no token.
    """
    if given is None and file is None:
        given = environment.get("SCHULER_TOKEN") or None
    if file is None and environment.get("SCHULER_TOKEN_FILE"):
        file = Path(environment["SCHULER_TOKEN_FILE"])
    if given is not None:
        return Token(given)
    if file is not None and (file.exists() or not generate):
        return Token(_first_line(file))
    if not generate:
        return Token(None)
    secret = secrets.token_urlsafe(24)
    if file is not None:
        _write(file, secret)
    return Token(secret, generated=True)


def _first_line(file: Path) -> str:
    try:
        if not file.is_file():
            raise _token_fault(file, "must be a file that holds the token")
        with file.open("rb") as opened:
            line = opened.read(_LONGEST_TOKEN).partition(b"\n")[0].decode().strip()
    except UnicodeDecodeError:
        raise _token_fault(file, "must hold text") from None
    except OSError as error:
        raise _fault("--token-file", str(file), f"cannot be read: {error.strerror or error}") from None
    if not line:
        raise _token_fault(file, "must hold the token in its first line")
    return line


def _write(file: Path, token: str) -> None:
    try:
        with os.fdopen(os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w") as opened:
            opened.write(token + "\n")
    except OSError as error:
        raise _fault("--token-file", str(file), f"cannot be written: {error.strerror or error}") from None


def _token_fault(file: Path, allowed: str) -> InputError:
    return _fault("--token-file", str(file), allowed)
