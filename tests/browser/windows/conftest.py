"""The page in three windows and two languages: all tests run in one of them, then in the next.

`make test` takes each test through one window in one language, `make windows` through all six.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import product
from typing import TYPE_CHECKING, Any
from zlib import crc32

import pytest

from tests.browser.driver import Bench
from tests.browser.test_page_layout import SIZES, resize

if TYPE_CHECKING:
    from playwright.sync_api import Browser

    from app.http.server import DashboardServer
    from app.serve import Dashboard

LOCALES = {"en": "en-US", "zh": "zh-CN"}
"""Languages of the page, and what a browser asks for."""

Open = Callable[..., Bench]

RUNS = tuple(product(LOCALES, SIZES))
"""Language and window of each run. Most other tests of the page are in English, in the first window."""


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Make all runs of a test nightly but one, which its name decides."""
    for item in items:
        turn = crc32(item.nodeid.partition("[")[0].rpartition("::")[2].encode())
        if run_of(item) not in (None, RUNS[turn % len(RUNS)]):
            item.add_marker(pytest.mark.nightly)


def run_of(item: pytest.Item) -> Any:
    """Language and window of a test of this folder; None for any other test."""
    params = item.callspec.params if isinstance(item, pytest.Function) and hasattr(item, "callspec") else {}
    return (params["language"], params["size"]) if {"language", "size"} <= params.keys() else None


@pytest.fixture(scope="session", params=tuple(LOCALES))
def language(request: pytest.FixtureRequest) -> str:
    """Language of the page."""
    return request.param


@pytest.fixture(scope="session", params=SIZES, ids=lambda size: f"{size[0]}x{size[1]}")
def size(request: pytest.FixtureRequest) -> tuple[int, int]:
    """Width and height of the window."""
    return request.param


@pytest.fixture(scope="session")
def chinese(browser: Browser, dashboard: tuple[DashboardServer, Dashboard]) -> Iterator[Bench]:
    """A page in Chinese, which stays open: to load a page takes seconds."""
    context = browser.new_context(viewport={"width": 1920, "height": 1080}, accept_downloads=True)
    bench = Bench(context.new_page(), dashboard[0].url, dashboard[1].sessions)
    yield bench.open(query="?fixedDpr=0.25&start=no&lang=zh")
    context.close()


@pytest.fixture(scope="session")
def spoken(request: pytest.FixtureRequest, language: str) -> Bench:
    """The page of a language, as a new visitor finds it."""
    bench: Bench = request.getfixturevalue({"en": "shared", "zh": "chinese"}[language])
    bench.begin()
    assert bench.language.startswith(language)
    return bench


@pytest.fixture(scope="session")
def resized(spoken: Bench, size: tuple[int, int]) -> Bench:
    """The same, in a window of its size."""
    resize(spoken, size)
    return spoken


@pytest.fixture
def window(resized: Bench) -> Iterator[Bench]:
    """A page in one of the windows and languages, on a ship under way with three methods."""
    resized.faults.clear()
    resized.reset("sikuliaq-like", selected=2)
    resized.tab("Method", "Errors")
    yield resized
    assert resized.faults == []


@pytest.fixture
def another(
    browser: Browser, dashboard: tuple[DashboardServer, Dashboard], language: str, size: tuple[int, int]
) -> Iterator[Open]:
    """Opens further pages in such a window, each in a browser of its own, whose user reads the language."""
    contexts, benches = [], []

    def opened(path: str = "", query: str = "?fixedDpr=0.25&start=no") -> Bench:
        viewport = {"width": size[0], "height": size[1]}
        contexts.append(browser.new_context(viewport=viewport, locale=LOCALES[language]))
        benches.append(Bench(contexts[-1].new_page(), dashboard[0].url, dashboard[1].sessions))
        return benches[-1].open(path, query)

    yield opened
    faults = [fault for bench in benches for fault in bench.faults]
    for context in contexts:
        context.close()
    assert faults == []
