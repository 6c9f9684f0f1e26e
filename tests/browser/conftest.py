"""The dashboard, served from this process, and pages on it."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from typing import TYPE_CHECKING

import pytest

from tests.browser.driver import Bench

if TYPE_CHECKING:
    from playwright.sync_api import Browser

    from app.http.server import DashboardServer
    from app.serve import Dashboard
    from app.session.session import Session


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Let playwright give up before a test's time is over, for that would end the browser of all tests."""
    for item in items:
        if "tests/browser/" in item.nodeid and item.get_closest_marker("timeout") is None:
            item.add_marker(pytest.mark.timeout(400))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Let the report of a failed test say what its pages and the server hold."""
    report = yield
    if report.failed:
        for name, value in getattr(item, "funcargs", {}).items():
            if isinstance(value, Bench):
                report.sections.append((f"page of {name!r}", value.account()))
                break
    return report


@pytest.fixture(scope="session")
def dashboard() -> Iterator[tuple[DashboardServer, Dashboard]]:
    """One server for all browser tests; every test has a session of its own."""
    from app.serve import open_dashboard

    server, dashboard = open_dashboard(port=0)
    yield server, dashboard
    server.stop()
    dashboard.close()


@pytest.fixture(scope="session")
def shared(browser: Browser, dashboard: tuple[DashboardServer, Dashboard]) -> Iterator[Bench]:
    """Open the page that all files share: opening one takes seconds.

    In its window frequency and errors are both in view.
    """
    context = browser.new_context(viewport={"width": 1920, "height": 1080}, accept_downloads=True)
    page = context.new_page()
    yield Bench(page, dashboard[0].url, dashboard[1].sessions).open()
    context.close()


@pytest.fixture(scope="module")
def opened(shared: Bench) -> Bench:
    """Give the shared page to a file, as a new visitor finds it."""
    shared.begin()
    return shared


@pytest.fixture
def bench(opened: Bench) -> Bench:
    """Give the shared page without what earlier tests left in its console."""
    opened.faults.clear()
    return opened


@pytest.fixture
def fresh(bench: Bench) -> Bench:
    """Give the shared page with a still ship in one channel; the compass network in hand."""
    bench.reset("zha-fast", selected=2)
    bench.tab("Frequency", "Errors", "Method")
    return bench


@pytest.fixture
def session(bench: Bench) -> Session:
    """What the server keeps of the shared page's visitor."""
    return bench.session
