"""The dashboard, served from this process, and pages on it."""

from collections.abc import Callable, Generator, Iterator
from typing import Any

import pytest
from playwright.sync_api import Browser

from navcore.scenario.file import load
from schuler_bench.dashboard import Dashboard
from schuler_bench.http.server import DashboardServer
from schuler_bench.serve import open_dashboard
from schuler_bench.session.session import Session
from tests.browser.driver import SIZES, Bench

Served = tuple[DashboardServer, Dashboard]
Another = Callable[..., Bench]


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Let playwright give up before a test's time is over, for that would end the browser of all tests."""
    for item in items:
        if "tests/browser/" in item.nodeid:
            item.add_marker(pytest.mark.browser)
            if item.get_closest_marker("timeout") is None:
                item.add_marker(pytest.mark.timeout(400))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Let the report of a failed test say what its pages and the server hold."""
    report = yield
    if report.failed:
        pages = {
            id(page): (name, page)
            for name, page in getattr(item, "funcargs", {}).items()
            if isinstance(page, Bench)
        }
        for name, page in pages.values():
            report.sections.append((f"page of {name!r}", page.account()))
    return report


@pytest.fixture(scope="session")
def dashboard() -> Iterator[Served]:
    """One server for all browser tests; every test has a session of its own."""
    server, dashboard = open_dashboard(port=0)
    yield server, dashboard
    server.stop()
    dashboard.close()


@pytest.fixture(scope="session")
def shared(browser: Browser, dashboard: Served) -> Iterator[Bench]:
    """Open the page that all files share: opening one takes seconds.

    In its window frequency and errors are both in view.
    """
    context = browser.new_context(viewport={"width": 1920, "height": 1080}, accept_downloads=True)
    yield Bench(context.new_page(), dashboard[0].url, dashboard[1].sessions).open()
    context.close()


@pytest.fixture(scope="session")
def chinese(browser: Browser, dashboard: Served) -> Iterator[Bench]:
    """A page in Chinese, which stays open: to load a page takes seconds."""
    context = browser.new_context(viewport={"width": 1920, "height": 1080}, accept_downloads=True)
    bench = Bench(context.new_page(), dashboard[0].url, dashboard[1].sessions)
    yield bench.open(query="?fixedDpr=0.25&start=no&lang=zh")
    context.close()


@pytest.fixture
def bench(shared: Bench) -> Iterator[Bench]:
    """Give the shared page as a new visitor finds it, but for the scenario and the tabs in front."""
    shared.size = SIZES[0]
    shared.clean()
    yield shared
    assert shared.faults == []


@pytest.fixture
def fresh(bench: Bench) -> Bench:
    """Give the shared page with a still ship in one channel; the compass network is selected."""
    bench.reset("zha-fast", "Frequency", "Errors", "Method", selected=2)
    return bench


@pytest.fixture
def moving(bench: Bench) -> Bench:
    """Give the shared page with a ship under way; the third of its methods is selected."""
    bench.reset("sikuliaq-like", "Frequency", "Errors", "Method", selected=2)
    return bench


@pytest.fixture
def short(bench: Bench) -> Bench:
    """An hour of the moving preset."""
    scenario = load("sikuliaq-like", ["run.duration_h=1.0"])
    bench.put(scenario, "Method", "Errors", origin=f"test {bench.session.run_number}", selected=2)
    return bench


@pytest.fixture
def session(bench: Bench) -> Session:
    """What the server keeps of the shared page's visitor."""
    return bench.session


@pytest.fixture
def another(browser: Browser, dashboard: Served) -> Iterator[Another]:
    """Make further pages, not yet open, each in a browser of its own."""
    contexts, benches = [], []

    def make(width: int = 800, height: int = 600, **options: Any) -> Bench:
        contexts.append(browser.new_context(viewport={"width": width, "height": height}, **options))
        benches.append(Bench(contexts[-1].new_page(), dashboard[0].url, dashboard[1].sessions))
        return benches[-1]

    yield make
    faults = [fault for bench in benches for fault in bench.faults]
    for context in contexts:
        context.close()
    assert faults == []
