"""What the address of the page can ask for: tabs in front."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import pytest

from app.views import load
from tests.browser.driver import Bench

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.browser

PLAIN = "?fixedDpr=0.25&start=no"
_FRONT = """() =>
  [...document.querySelectorAll('[role=tab][aria-selected=true]')].map(tab => tab.textContent)"""


@pytest.fixture
def visitor(browser: Browser, dashboard: Any) -> Iterator[Callable[[int, int], Bench]]:
    """Browsers with a window of some size, not yet at the page."""
    contexts = []

    def make(width: int, height: int) -> Bench:
        contexts.append(browser.new_context(viewport={"width": width, "height": height}))
        page = contexts[-1].new_page()
        return Bench(page, dashboard[0].url, dashboard[1].sessions)

    yield make
    for context in contexts:
        context.close()


def fronted(bench: Bench) -> list[str]:
    """Tabs in front, once the page has brought those to the front that its address names."""
    bench.page.wait_for_selector("html[data-fronted]", state="attached")
    bench.heard()
    return bench.page.evaluate(_FRONT)


def test_an_address_opens_tabs_and_a_link_to_them_is_made(visitor: Callable[[int, int], Bench]) -> None:
    bench = visitor(1920, 1080)
    page = bench.page
    page.goto(f"{bench.url}{PLAIN}&tab=poles,Spectrum&tab=Sensors&tab=Bodies")
    told = bench.notice("Not all tabs of the address are here")
    assert "'Bodies'" in told
    assert all(kind.title in told for kind in load() if kind.title)
    assert fronted(bench) == ["Sensors", "Poles", "Spectrum"]
    bench.close_notices()
    bench.tab("Errors")
    page.evaluate("() => schuler.command('share-view')")
    dialog = page.get_by_role("dialog", name="Share this state")
    link = dialog.get_by_label("Link to this state").input_value()
    assert link.endswith("?tab=Sensors,Poles,Errors")
    # in a small window two of them stand in one panel
    small = visitor(1280, 720)
    small.page.goto(link.replace("?", f"{PLAIN}&"))
    assert fronted(small) == ["Sensors", "Errors"]
    assert small.session.display == bench.session.display
    assert bench.faults == small.faults == []
