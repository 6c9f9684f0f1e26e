"""The page in three windows and two languages: all tests run in one of them, then in the next.

`make test` takes each test through one window in one language, `make windows` through all six.
"""

from collections.abc import Iterator
from itertools import product
from typing import Any
from zlib import crc32

import pytest

from tests.browser.conftest import Another
from tests.browser.driver import SIZES, Bench

LOCALES = {"en": "en-US", "zh": "zh-CN"}
"""Languages of the page, and what a browser asks for."""

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
def spoken(request: pytest.FixtureRequest, language: str) -> Bench:
    """The page of a language."""
    bench: Bench = request.getfixturevalue({"en": "shared", "zh": "chinese"}[language])
    assert bench.language.startswith(language)
    return bench


@pytest.fixture
def resized(spoken: Bench, size: tuple[int, int]) -> Bench:
    """The same, in a window of its size, as a new visitor finds it."""
    spoken.size = size
    spoken.clean()
    return spoken


@pytest.fixture
def window(resized: Bench) -> Iterator[Bench]:
    """A page in one of the windows and languages, on a ship under way with three methods."""
    resized.reset("sikuliaq-like", "Method", "Errors", selected=2)
    yield resized
    assert resized.faults == []


@pytest.fixture
def visitor(another: Another, language: str, size: tuple[int, int]) -> Bench:
    """A further page in such a window, not yet open, in the browser of a user who reads the language."""
    return another(*size, locale=LOCALES[language])
