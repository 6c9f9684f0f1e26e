"""A running server with one control of every kind, and a record of what reached it."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import pytest
import viser

from schuler_bench.http.ids import SessionIds
from schuler_bench.http.server import DashboardServer, start


@dataclass
class Bench:
    """The server under attack."""

    server: DashboardServer
    handles: dict[str, dict[str, Any]]
    """Controls of each session, by label."""
    events: list[tuple[Any, ...]]

    @property
    def port(self) -> int:
        return self.server.port

    def of(self, session: str) -> dict[str, Any]:
        """Handles of a session's controls, by label."""
        eventually(lambda: session in self.handles)
        return self.handles[session]


@contextmanager
def running(**options: Any) -> Iterator[Bench]:
    handles: dict[str, dict[str, Any]] = {}
    events: list[tuple[Any, ...]] = []

    def connected(client: viser.ClientHandle, session: str) -> None:
        gui = client.gui
        own: dict[str, Any] = {
            "gain": gui.add_slider("gain", 0.0, 1.0, 0.1, 0.5),
            "count": gui.add_number("count", 3),
            "network": gui.add_dropdown("network", ("compass", "pole2")),
            "on": gui.add_checkbox("on", True),
            "title": gui.add_text("title", "plain"),
            "frozen": gui.add_slider("frozen", 0.0, 1.0, 0.1, 0.5, disabled=True),
            "triple": gui.add_vector3("triple", (1.0, 2.0, 3.0)),
            "log": gui.add_upload_button("log"),
            "last": gui.add_button("last"),
        }
        for label, handle in own.items():
            attach = {"last": "on_click", "log": "on_upload"}.get(label, "on_update")
            getattr(handle, attach)(lambda event, label=label: events.append((label, event.target.value)))
        handles[session] = own
        events.append(("connect", session))

    def disconnected(client: viser.ClientHandle, session: str) -> None:
        events.append(("disconnect", session))

    # The tests name their sessions themselves; test_doors.py attacks with the ids that servers accept.
    options = {"session_ids": SessionIds(known=lambda _: True)} | options
    server = start(port=0, on_connect=connected, on_disconnect=disconnected, **options)
    try:
        yield Bench(server, handles, events)
    finally:
        server.stop()


def eventually(condition: Callable[[], Any], seconds: float = 30.0) -> None:
    """Wait until the condition holds; fail when it never does."""
    until = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < until, "did not happen in time"
        time.sleep(0.005)


@pytest.fixture(scope="module")
def bench() -> Iterator[Bench]:
    with running() as bench:
        yield bench


@pytest.fixture(scope="module")
def guarded() -> Iterator[Bench]:
    with running(token=TOKEN, allow_origins=["https://bench.example.org"]) as bench:
        yield bench


TOKEN = "a-token-of-this-test"
