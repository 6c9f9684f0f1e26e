"""A connection that has ended is not read any more, whoever has ended it and however much is still sent."""

import asyncio
import contextlib
import secrets
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest

from schuler_bench.http.front import Front
from schuler_bench.http.limits import MIB, Limits
from tests.attack.conftest import Bench, eventually, running
from tests.attack.wire import UPGRADE, ask

pytestmark = pytest.mark.attack

MASK = bytes(4)
MESSAGE = b"\x82\xff" + (MIB - 14).to_bytes(8, "big") + MASK + bytes(MIB - 14)
"""A whole message in form: nothing in it ends a connection by itself."""
MOST_TAKEN = 48 * MIB
"""Dropped while the last word is on its way, and buffered by the system on both sides of two connections."""


def request(port: int, path: str = "/s/session-of-a-test", method: str = "GET") -> bytes:
    head = {"Host": f"127.0.0.1:{port}"} | UPGRADE
    lines = [f"{method} {path} HTTP/1.1", *(f"{name}: {value}" for name, value in head.items())]
    return "\r\n".join([*lines, "", ""]).encode()


def taken(attacker: socket.socket) -> int:
    """Bytes that are taken before the server closes the connection; it may take 256 MiB in vain."""
    sent = 0
    with contextlib.suppress(ConnectionError):
        while sent < 256 * MIB:
            attacker.sendall(MESSAGE)
            sent += len(MESSAGE)
    return sent


@contextmanager
def through_a_door(
    port: int, limits: Limits | None = None
) -> Iterator[tuple[int, asyncio.AbstractEventLoop]]:
    """Port and event loop of a door with one worker behind it, as of ``--workers``."""
    listener, loop, ended = socket.create_server(("127.0.0.1", 0)), asyncio.new_event_loop(), asyncio.Event()
    opened = threading.Event()
    listener.setblocking(False)
    serving = Front([port], limits or Limits()).serve(listener, ended, opened.set)
    thread = threading.Thread(target=loop.run_until_complete, args=(serving,))
    thread.start()
    opened.wait(10.0)
    try:
        yield listener.getsockname()[1], loop
    finally:
        loop.call_soon_threadsafe(ended.set)
        thread.join(10.0)
        loop.close()


@pytest.fixture(scope="module", params=["alone", "behind a door"])
def ports(request: pytest.FixtureRequest, bench: Bench) -> Iterator[tuple[int, int]]:
    """Where to connect, and the server's own port, which the Host header names."""
    if request.param == "alone":
        yield bench.port, bench.port
        return
    with through_a_door(bench.port) as (port, _):
        yield port, bench.port


ENDINGS = {
    "a close frame": b"\x88\x80" + MASK,
    "a close frame amid a message": b"\x02\x81" + MASK + b"a" + b"\x88\x80" + MASK,
    "a frame without a mask": b"\x82\x01a",
    "a frame of no kind": b"\x8f\x80" + MASK,
    "a message that is too large": b"\x82\xff" + (64 * MIB).to_bytes(8, "big") + MASK,
    "no message of a page": b"\x82\x81" + MASK + b"\xc1",
    "too many frames": (b"\x89\x80" + MASK) * 1100,
}


@pytest.mark.parametrize("ending", ENDINGS)
def test_an_ended_websocket_is_not_read(
    bench: Bench, ports: tuple[int, int], ending: str, record_property: Callable[[str, object], None]
) -> None:
    live = bench.server.viser._websock_server._live_connections
    with socket.create_connection(("127.0.0.1", ports[0]), timeout=10.0) as attacker:
        attacker.sendall(request(ports[1], f"/s/ended-by-{'-'.join(ending.split())}"))
        assert attacker.recv(12) == b"HTTP/1.1 101"
        attacker.sendall(ENDINGS[ending])
        record_property("taken_mib", (count := taken(attacker)) / MIB)
        assert count < MOST_TAKEN
    eventually(lambda: not live)


REFUSED = {
    "a foreign path": lambda port: request(port, "/nowhere"),
    "a foreign host": lambda port: request(port + 1),
    "a method": lambda port: request(port, method="POST"),
    "no request": lambda _: b"HELLO\r\n\r\n",
    "headers without end": lambda port: request(port)[:-2] + b"a: b\r\n" * 300,
}


@pytest.mark.parametrize("refused", REFUSED)
def test_a_refused_request_is_not_read(bench: Bench, ports: tuple[int, int], refused: str) -> None:
    with socket.create_connection(("127.0.0.1", ports[0]), timeout=10.0) as attacker:
        attacker.sendall(REFUSED[refused](ports[1]))
        assert taken(attacker) < MOST_TAKEN
    assert ask(bench.port, "/healthz").status == 200


def test_a_page_that_has_lost_its_place_is_not_read() -> None:
    with running(limits=Limits(visitors=1, idle_s=0.0)) as bench:
        with socket.create_connection(("127.0.0.1", bench.port), timeout=10.0) as attacker:
            attacker.sendall(request(bench.port, "/s/sends-on-and-on"))
            assert attacker.recv(12) == b"HTTP/1.1 101"
            assert ask(bench.port, "/s/a-newcomer/").status == 200
            assert ask(bench.port, "/s/a-newcomer", UPGRADE).status == 101
            assert taken(attacker) < MOST_TAKEN


def test_who_never_reads_loses_the_door_too() -> None:
    """The server drops the page; what the door still holds for it keeps no connection open."""
    quick = Limits(ping_s=0.2, request_s=0.2)
    with (
        running(limits=quick) as bench,
        through_a_door(bench.port, quick) as (port, loop),
        socket.create_connection(("127.0.0.1", port), timeout=10.0) as attacker,
    ):
        attacker.sendall(request(bench.port, "/s/never-reads"))
        live = bench.server.viser._websock_server._live_connections
        eventually(lambda: live)
        for _ in range(60):
            bench.server.viser.gui.add_markdown(secrets.token_hex(250_000))  # which nothing compresses much
        eventually(lambda: not live)
        eventually(lambda: len(asyncio.all_tasks(loop)) == 1, 10.0)  # that which serves
