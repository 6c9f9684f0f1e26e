"""An idle page gives up its place in a real browser, and comes back: by itself, or with its person."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
import viser

import app.shell
from app.http.limits import Limits
from app.http.server import DashboardServer, start
from tests.attack.conftest import eventually
from tests.browser.patience import PATIENCE_MS

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserContext, Page

pytestmark = pytest.mark.browser

SCRIPT = Path(app.shell.__file__).parent / "static" / "place.js"
QUIET_MS = 5500


@pytest.fixture
def open_now() -> list[str]:
    """Sessions whose pages are open."""
    return []


@pytest.fixture
def server(open_now: list[str]) -> Iterator[DashboardServer]:
    def connected(client: viser.ClientHandle, session: str) -> None:
        open_now.append(session)
        client.gui.add_markdown("here")

    def disconnected(client: viser.ClientHandle, session: str) -> None:
        open_now.remove(session)

    limits = Limits(visitors=1, idle_s=1.0)
    server = start(
        port=0, on_connect=connected, on_disconnect=disconnected, page_scripts=[SCRIPT], limits=limits
    )
    yield server
    server.stop()


def visited(browser: Browser, server: DashboardServer) -> tuple[BrowserContext, Page, str]:
    context = browser.new_context(viewport={"width": 900, "height": 600})
    page = context.new_page()
    page.set_default_timeout(PATIENCE_MS)
    page.goto(f"{server.url}?fixedDpr=0.25&start=no")
    return context, page, page.url.split("/s/")[1].split("/")[0]


def test_an_idle_page_comes_back_by_itself_and_at_once_with_its_person(
    browser: Browser, server: DashboardServer, open_now: list[str]
) -> None:
    first_context, first, first_id = visited(browser, server)
    eventually(lambda: open_now == [first_id], 90.0)
    first.wait_for_timeout(1500)
    second_context, _, second_id = visited(browser, server)
    eventually(lambda: open_now == [second_id], 90.0)
    second_context.close()
    eventually(lambda: open_now == [first_id], 90.0)

    first.wait_for_timeout(1500)
    third_context, _, third_id = visited(browser, server)
    eventually(lambda: open_now == [third_id], 90.0)
    first.wait_for_timeout(QUIET_MS)
    assert open_now == [third_id], "a page that nobody looks at drives nobody out"
    with first.expect_response(lambda answer: answer.url.endswith("/place")) as asked:
        first.mouse.move(300, 300)
    assert asked.value.status == 204
    eventually(lambda: open_now == [first_id], 90.0)
    third_context.close()
    first_context.close()
