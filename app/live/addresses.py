"""Where a live stream comes from and goes to, checked first: ``udp://HOST:PORT`` or ``file:PATH``."""

import ipaddress
import re
import socket
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

from navcore.foundation.errors import Fault, InputError

_FROM = "from"
_HOST = re.compile(r"[A-Za-z0-9]([A-Za-z0-9._-]*[A-Za-z0-9])?|[0-9A-Fa-f:.]+")
LISTEN, SEND = "--listen", "--send"


@dataclass(frozen=True)
class Datagrams:
    """Address of datagrams.

    Attributes
    ----------
    host : str
        Numeric address.
    port : int
        1 to 65535.
    sender : str or None
        The only numeric address from which datagrams are taken; None: any, on this machine.
    """

    host: str
    port: int
    sender: str | None = None

    def __str__(self) -> str:
        """Write it as it was given."""
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"udp://{host}:{self.port}"


@dataclass(frozen=True)
class Growing:
    """A file to which lines are added.

    Attributes
    ----------
    path : Path
        A regular file; it may not exist yet.
    """

    path: Path

    def __str__(self) -> str:
        """Name the file without its folder: visitors read it."""
        return f"file:{self.path.name}"


Source = Datagrams | Growing


def sources_of(texts: Iterable[str]) -> tuple[Source, ...]:
    """Read what ``--listen`` names.

    Parameters
    ----------
    texts : iterable of str
        Each ``udp://HOST:PORT``, ``udp://:PORT`` on this machine, or ``file:PATH``.

    Raises
    ------
    InputError
        One fault for each that is neither, for a host that is not this machine's own loopback without
        ``?from=ADDRESS``, and for one that is named twice.
    """
    found: list[Source] = []
    faults: list[Fault] = []
    for text in texts:
        try:
            source = _source(text)
        except InputError as error:
            faults += error.faults
            continue
        if source in found:
            faults.append(Fault("serve", LISTEN, text, "must be named once"))
        found.append(source)
    if faults:
        raise InputError(faults)
    return tuple(found)


def _source(text: str) -> Source:
    if text.startswith("file:"):
        path = Path(text.removeprefix("file:").removeprefix("//")).expanduser()
        if not path.name or path.is_dir() or (path.exists() and not path.is_file()):
            raise _fault(LISTEN, text, "must name a file to which sentences are added, as file:ins.nmea")
        return Growing(path.absolute())
    found = _datagrams(LISTEN, text)
    if found.sender is None and not ipaddress.ip_address(found.host).is_loopback:
        raise _fault(
            LISTEN,
            text,
            "is open to others, who could feed it anything: name the sender, as "
            f"udp://{found.host}:{found.port}?{_FROM}=192.0.2.7, or listen on 127.0.0.1",
        )
    return found


def target_of(text: str, sources: Iterable[Source]) -> Datagrams:
    """Read what ``--send`` names.

    Raises
    ------
    InputError
        It is no ``udp://HOST:PORT``, or an address on which the program itself listens.
    """
    target = _datagrams(SEND, text, sends=True)
    for source in sources:
        if not isinstance(source, Datagrams) or source.port != target.port:
            continue
        same = source.host == target.host or ipaddress.ip_address(source.host).is_unspecified
        if same:
            raise _fault(SEND, text, "must not be where the program listens: it would hear itself")
    return target


def _datagrams(option: str, text: str, *, sends: bool = False) -> Datagrams:
    example = "must be udp://HOST:PORT, as udp://127.0.0.1:10110" + ("" if sends else ", or file:PATH")
    try:
        parts = urlsplit(text)
        port, host = parts.port, parts.hostname or "127.0.0.1"
    except ValueError:
        raise _fault(option, text, example) from None
    asked = parse_qs(parts.query, keep_blank_values=True)
    allowed = set() if sends else {_FROM}
    if parts.scheme != "udp" or parts.path or parts.fragment or parts.username or set(asked) - allowed:
        raise _fault(option, text, example)
    if port is None or not 1 <= port <= 65535:
        raise _fault(option, text, f"{example}; the port is a whole number from 1 to 65535")
    if not _HOST.fullmatch(host):
        raise _fault(option, text, example)
    sender = None
    if _FROM in asked:
        try:
            sender = str(ipaddress.ip_address(asked[_FROM][-1]))
        except ValueError:
            raise _fault(option, text, f"{_FROM}= must be the numeric address of the sender") from None
    return Datagrams(_numeric(option, text, host), port, sender)


def _numeric(option: str, text: str, host: str) -> str:
    try:
        entries = socket.getaddrinfo(host, None, type=socket.SOCK_DGRAM)
    except (OSError, UnicodeError):
        raise _fault(option, text, "no such host") from None
    return str(min(entries, key=lambda entry: entry[0] != socket.AF_INET)[4][0]).partition("%")[0]


def _fault(option: str, text: str, allowed: str) -> InputError:
    return InputError(Fault("serve", option, text, allowed))
