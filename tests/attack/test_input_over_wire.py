"""Hostile files sent through the page's own protocol to the served dashboard, beside another visitor at work.

What each took (until the visitor was told, the other's slowest answer, memory) is recorded for the table of
docs/serving.md. Nothing is asserted about time but that an answer came.
"""

import itertools
import math
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

import pytest

from schuler_bench.bench.process import Server
from schuler_bench.bench.visitor import PAGE_STATE, Visitor
from tests.attack.conftest import eventually
from tests.bombs import FILES, SCENARIOS
from tests.browser.fields import label_of

pytestmark = pytest.mark.attack

UPLOAD, ZETA = "Upload a file", label_of("network.zeta")
WINDOW = "1366x768|Files|Errors"
TOLD_S = 100.0
MOST_MB = 2000.0
"""Of the server itself: its children, which read, have bounds of their own."""
SENT = {
    "NMEA line of 128 KiB": ("line.txt", FILES["a line of one sentence's beginning"]),
    "CSV of 4 M columns": ("wide.csv", FILES["4 M columns"]),
    "Parquet of one repeated text": ("text.parquet", FILES["Parquet of one repeated text"]),
    "MAT with a matrix in a cell": ("cell.mat", FILES["MAT with a matrix in a cell"]),
    "TOML of 90,000 methods": ("many.toml", lambda: SCENARIOS["90,000 methods"][0].encode()),
    "NMEA line of 16 MB": ("long.txt", FILES["16 MB of it"]),
    "Parquet of 10 M rows": ("rows.parquet", FILES["Parquet of 10 M rows"]),
    "TOML of dotted keys": ("dotted.toml", lambda: SCENARIOS["a dotted key"][0].encode()),
    "TOML of 900,000 digits": ("digits.toml", lambda: SCENARIOS["900,000 digits"][0].encode()),
}
DAILY = 5
"""Of each format the first; the others at night."""


@pytest.fixture(scope="module")
def server() -> Iterator[Server]:
    with Server() as running:
        yield running


def move(visitor: Visitor, value: float) -> float:
    """Move a slider; return the seconds until the answer."""
    before, sent = visitor.run_number, visitor.set(ZETA, value)
    visitor.wait(lambda: visitor.run_number > before, f"an answer to {value}", 60.0)
    return visitor.arrived_s - sent


@contextmanager
def another(port: int) -> Iterator[list[float]]:
    """Another visitor, who moves a slider all the time: the seconds of each answer, inf for none."""
    answers_s: list[float] = []
    ended, ready = threading.Event(), threading.Event()

    def work() -> None:
        with Visitor(port, "beside-the-bombs") as visitor:
            visitor.set(PAGE_STATE, WINDOW)
            visitor.wait_for_run(1)
            visitor.control(ZETA)
            for step in itertools.count(1):  # at 0 the slider would stand where it is
                if ended.is_set():
                    return
                try:
                    answers_s.append(move(visitor, round(0.5 + 0.001 * (step % 400), 4)))
                except TimeoutError:
                    answers_s.append(math.inf)
                ready.set()
                visitor.rest(0.2)

    with ThreadPoolExecutor(1) as pool:
        working = pool.submit(work)
        try:
            assert ready.wait(120.0)
            yield answers_s
        finally:
            ended.set()
            working.result(60.0)


@pytest.mark.timeout(300)
@pytest.mark.parametrize(
    "what", [pytest.param(what, marks=[pytest.mark.nightly] * (n >= DAILY)) for n, what in enumerate(SENT)]
)
def test_a_hostile_upload_is_told_in_short_and_others_go_on(
    server: Server, what: str, record_property: Callable[[str, object], None]
) -> None:
    name, content = SENT[what]
    with Visitor(server.port, "the-bomber") as visitor, another(server.port) as others_s:
        visitor.set(PAGE_STATE, WINDOW)
        visitor.wait_for_run(1)
        data, before, answered = content(), len(visitor.notices), len(others_s)
        began = time.monotonic()
        visitor.upload(UPLOAD, name, data)
        refused = "The file cannot be used; nothing was changed"
        told = lambda: [text for title, text in visitor.notices[before:] if title == refused]  # noqa: E731
        visitor.wait(lambda: bool(told()), f"a refusal of {what}", TOLD_S)
        told_s = time.monotonic() - began
        text = told()[-1]
        assert 0 < len(text) <= 600 and "Traceback" not in text
        move(visitor, 0.7 if visitor.held(ZETA) != 0.7 else 0.8)
        # However soon the file was refused, the other visitor has moved on since it came.
        eventually(lambda: visitor.rest(0.2) or len(others_s) > answered, 60.0)
    rss_mb = server.rss_mb()
    slowest_s = max(others_s[answered:])
    for name, figure in (("told_s", told_s), ("slowest_other_s", slowest_s), ("server_mb", rss_mb)):
        record_property(name, figure)
    assert slowest_s < math.inf and rss_mb < MOST_MB
