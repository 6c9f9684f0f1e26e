"""serving.md 15: too many visitors, too many sockets, one that never reads, one that never stops sending."""

from __future__ import annotations

import socket
import time
from contextlib import ExitStack

import pytest

from app.http.limits import Limits
from tests.attack.conftest import eventually, running
from tests.attack.wire import SESSION, ask, shake_hands, visit

pytestmark = pytest.mark.attack


def test_visitors_beyond_the_limit_are_told() -> None:
    with running(limits=Limits(visitors=5)) as bench:
        with ExitStack() as crowd:
            for number in range(5):
                crowd.enter_context(visit(bench.port, f"visitor-{number}"))
            assert shake_hands(bench.port).status == 503
            page = ask(bench.port, f"/s/{SESSION}/")
            assert page.status == 503 and b"All places are taken" in page.body
            assert page.headers["Retry-After"] and page.headers["X-Frame-Options"] == "DENY"
            assert ask(bench.port, "/healthz").status == 200
        eventually(lambda: ask(bench.port, f"/s/{SESSION}/").status == 200)


def test_two_hundred_silent_sockets_do_not_keep_others_out() -> None:
    with running(limits=Limits(sockets=150)) as bench, ExitStack() as crowd:
        with visit(bench.port, "already-there") as visitor:
            visitor.control("last")
            silent = [
                crowd.enter_context(socket.create_connection(("127.0.0.1", bench.port))) for _ in range(200)
            ]
            told = [s for s in silent[150:] if s.recv(100).startswith(b"HTTP/1.1 503")]
            assert len(told) == 50
            visitor.set(visitor.control("gain"), 0.9)
            eventually(lambda: bench.of("already-there")["gain"].value == 0.9)
        for s in silent[:10]:
            s.close()
        eventually(lambda: shake_hands(bench.port).status == 101)


def test_a_page_that_never_reads_is_dropped() -> None:
    with running(limits=Limits(ping_s=0.3)) as bench:
        request = (
            f"GET /s/{SESSION} HTTP/1.1\r\nHost: 127.0.0.1:{bench.port}\r\nUpgrade: websocket\r\n"
            "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: viser-v1.1.1\r\n"
            "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"
        )
        with socket.create_connection(("127.0.0.1", bench.port)) as deaf:
            deaf.sendall(request.encode())
            places = bench.server.viser._websock_server._live_connections
            eventually(lambda: len(places) == 1)
            for _ in range(50):
                bench.server.viser.gui.add_markdown("x" * 100_000)
            eventually(lambda: len(places) == 0)


def test_a_flood_is_slowed_not_lost() -> None:
    with running(limits=Limits(frames_per_second=50)) as bench, visit(bench.port, "the-flooder") as visitor:
        gain, last = visitor.control("gain"), visitor.control("last")
        started = time.monotonic()
        for number in range(120):
            visitor.set(gain, number / 1000)
        visitor.set(last, True)
        eventually(lambda: ("last", True) in bench.events)
        assert bench.of("the-flooder")["gain"].value == 0.119
        # Not a measure of speed: 120 messages at 50 a second cannot be read within one second.
        assert time.monotonic() - started > 1.0
