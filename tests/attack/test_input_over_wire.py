"""Hostile files sent through the page's own protocol to the served dashboard, beside another visitor at work.

What each took (until the visitor was told, the other's slowest answer, memory) is recorded for the table of
docs/serving.md. Nothing is asserted about time but that an answer came.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator

import pytest

from app.bench.process import Server
from app.bench.visitor import PAGE_STATE, Visitor
from tests.bombs import FILES, SCENARIOS
from tests.browser.fields import label_of

pytestmark = pytest.mark.attack

UPLOAD = "Upload a file"
WINDOW = "1366x768|Files|Errors"
TOLD_S = 100.0
MOST_MB = 2000.0
"""Of the server itself: its children, which read, have bounds of their own."""
SENT = {
    "NMEA line of 128 KiB": ("line.txt", FILES["a line of one sentence's beginning"]),
    "NMEA line of 16 MB": ("long.txt", FILES["16 MB of it"]),
    "CSV of 4 M columns": ("wide.csv", FILES["4 M columns"]),
    "Parquet of one repeated text": ("text.parquet", FILES["Parquet of one repeated text"]),
    "Parquet of 10 M rows": ("rows.parquet", FILES["Parquet of 10 M rows"]),
    "MAT with a matrix in a cell": ("cell.mat", FILES["MAT with a matrix in a cell"]),
    "TOML of 90,000 methods": ("many.toml", lambda: SCENARIOS["90,000 methods"][0].encode()),
    "TOML of dotted keys": ("dotted.toml", lambda: SCENARIOS["a dotted key"][0].encode()),
    "TOML of 900,000 digits": ("digits.toml", lambda: SCENARIOS["900,000 digits"][0].encode()),
}


@pytest.fixture(scope="module")
def server() -> Iterator[Server]:
    with Server() as running:
        yield running


class Other:
    """Another visitor, who moves a slider all the time."""

    def __init__(self, port: int) -> None:
        self._port = port
        self.answers_s: list[float] = []
        self.lost = 0
        self._ended, self.ready = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._work, daemon=True)

    def __enter__(self) -> Other:
        self._thread.start()
        assert self.ready.wait(120.0)
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        self._thread.join(60.0)

    def _work(self) -> None:
        with Visitor(self._port, "beside-the-bombs") as visitor:
            visitor.set(PAGE_STATE, WINDOW)
            visitor.wait(lambda: visitor.run_number >= 1, "its first run", 120.0)
            visitor.control(label_of("network.zeta"))
            step = 0
            while not self._ended.is_set():
                step += 1
                before = visitor.run_number
                sent = visitor.set(label_of("network.zeta"), round(0.5 + 0.001 * (step % 400), 4))
                try:
                    visitor.wait(lambda before=before: visitor.run_number > before, "an answer", 60.0)
                except TimeoutError:
                    self.lost += 1
                    continue
                self.answers_s.append(visitor.arrived_s - sent)
                self.ready.set()
                visitor.rest(0.2)


@pytest.mark.timeout(300)
@pytest.mark.parametrize("what", SENT)
def test_a_hostile_upload_is_told_in_short_and_others_go_on(
    server: Server, what: str, record_property: Callable[[str, object], None]
) -> None:
    name, content = SENT[what][0], SENT[what][1]()
    with Visitor(server.port, "the-bomber") as visitor, Other(server.port) as other:
        visitor.set(PAGE_STATE, WINDOW)
        visitor.wait(lambda: visitor.run_number >= 1, "its first run", 120.0)
        before, answered = len(visitor.notices), len(other.answers_s)
        began = time.monotonic()
        visitor.upload(UPLOAD, name, content)
        visitor.wait(lambda: len(visitor.notices) > before, f"a word about {what}", TOLD_S)
        told_s = time.monotonic() - began
        title, text = visitor.notices[-1]
        assert title == "The file cannot be used; nothing was changed"
        assert 0 < len(text) <= 600 and "Traceback" not in text
        number = visitor.run_number
        visitor.set(label_of("network.zeta"), 0.7 if visitor.held(label_of("network.zeta")) != 0.7 else 0.8)
        visitor.wait(lambda: visitor.run_number > number, "an answer after it", 60.0)
        # However soon the file was refused, the other visitor has moved on since it came.
        until = time.monotonic() + 60.0
        while len(other.answers_s) == answered and time.monotonic() < until:
            visitor.rest(0.2)
    slowest = max(other.answers_s[answered:], default=float("inf"))
    rss_mb = server.rss_mb()
    for name, figure in (("told_s", told_s), ("slowest_other_s", slowest), ("server_mb", rss_mb)):
        record_property(name, figure)
    assert other.lost == 0 and len(other.answers_s) > answered
    assert rss_mb < MOST_MB
