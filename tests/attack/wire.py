"""A hostile (or plain) client: HTTP and websocket requests as no browser would make them."""

import http.client
import socket
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass, field
from typing import Any

import msgspec
from websockets.sync.client import ClientConnection, connect

from schuler_bench.bench.visitor import CAMERA, decoded

SESSION = "session-of-a-test"
UPGRADE = {
    "Upgrade": "websocket",
    "Connection": "Upgrade",
    "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA==",
    "Sec-WebSocket-Version": "13",
    "Sec-WebSocket-Protocol": "viser-v1.1.1",
}


@dataclass
class Answer:
    status: int
    headers: http.client.HTTPMessage
    body: bytes


def ask(port: int, path: str = "/", headers: dict[str, str | list[str]] | None = None) -> Answer:
    """GET, without following redirects; a header may come several times, Host may be wrong or missing."""
    given = {"Host": f"127.0.0.1:{port}", **(headers or {})}
    with closing(http.client.HTTPConnection("127.0.0.1", port, timeout=10)) as connection:
        connection.putrequest("GET", path, skip_host=True, skip_accept_encoding=True)
        for name, values in given.items():
            for value in [values] if isinstance(values, str) else values:
                connection.putheader(name, value)
        connection.endheaders()
        with connection.getresponse() as response:
            return Answer(
                response.status, response.headers, b"" if response.status == 101 else response.read()
            )


def shake_hands(port: int, path: str = f"/s/{SESSION}", **headers: str | list[str]) -> Answer:
    """Ask for a websocket and hang up; status 101 means it would have opened."""
    return ask(port, path, UPGRADE | {name.replace("_", "-"): value for name, value in headers.items()})


def statuses(port: int, path: str = f"/s/{SESSION}/", **headers: str | list[str]) -> tuple[int, int]:
    """Statuses with which the page and the websocket of a path are answered."""
    return ask(port, path, headers).status, shake_hands(port, path, **headers).status


@dataclass
class Visitor:
    """What a browser does, without a browser."""

    socket: ClientConnection
    received: list[dict[str, Any]] = field(default_factory=list)

    def send(self, **message: Any) -> None:
        self.socket.send(msgspec.msgpack.encode(message))

    def set(self, uuid: str, value: Any, **more: Any) -> None:
        self.send(type="GuiUpdateMessage", uuid=uuid, updates={"value": value, **more})

    def wait_for(self, wanted: Callable[[dict[str, Any]], bool], seconds: float = 30.0) -> dict[str, Any]:
        """First message that fits, among those received so far and those to come."""
        seen, until = 0, time.monotonic() + seconds
        while True:
            for message in self.received[seen:]:
                if wanted(message):
                    return message
            seen = len(self.received)
            self.received += decoded(self.socket.recv(timeout=until - time.monotonic()))

    def control(self, label: str) -> str:
        """Wait for a control; return its id."""
        return self.wait_for(lambda m: m.get("props", {}).get("label") == label)["uuid"]

    def notice(self) -> str:
        """Wait for a notification and take it out; return its text."""
        found = self.wait_for(lambda m: m["type"] == "NotificationShowMessage")
        self.received.remove(found)
        return found["props"]["body"]

    def closed_with(self, seconds: float = 5.0) -> int | None:
        """Read until the server closes the connection; return its code."""
        until = time.monotonic() + seconds
        try:
            while True:
                self.socket.recv(timeout=until - time.monotonic())
        except TimeoutError:
            return None
        except Exception:
            return self.socket.close_code


def upload(visitor: Visitor, label: str, name: str, parts: list[bytes], size: int = 0) -> None:
    """Announce a file of ``size`` bytes (0: those of the parts) to a control, and send its first parts."""
    common = {"source_component_uuid": visitor.control(label), "transfer_uuid": name}
    whole = sum(map(len, parts))
    count = len(parts) + (size > whole)
    start = {"filename": name, "mime_type": "text/plain", "part_count": count, "size_bytes": size or whole}
    visitor.send(type="FileTransferStartUpload", **common, **start)
    for index, content in enumerate(parts):
        visitor.send(type="FileTransferPart", **common, part_index=index, content=content)


@contextmanager
def visit(port: int, session: str = SESSION, camera: bool = True, **options: Any) -> Iterator[Visitor]:
    """Open a page's websocket; with `camera` the server counts it as a connected client."""
    with connect(
        f"ws://127.0.0.1:{port}/s/{session}",
        subprotocols=["viser-v1.1.1"],
        compression=None,
        max_size=None,
        close_timeout=1,
        **options,
    ) as socket:
        visitor = Visitor(socket)
        if camera:
            visitor.send(**CAMERA)
        yield visitor


@contextmanager
def raw(port: int, session: str) -> Iterator[socket.socket]:
    """An open page's websocket without a library: to send what none would."""
    head = {"Host": f"127.0.0.1:{port}"} | UPGRADE
    lines = [f"GET /s/{session} HTTP/1.1", *(f"{name}: {value}" for name, value in head.items())]
    with socket.create_connection(("127.0.0.1", port), timeout=10) as opened:
        opened.sendall("\r\n".join([*lines, "", ""]).encode())
        assert opened.recv(12) == b"HTTP/1.1 101"
        yield opened
