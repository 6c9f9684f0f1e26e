"""The first five minutes: start card, its doors, the tour, scenarios and networks with pictures."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import pytest

from tests.browser.driver import Bench
from tests.browser.test_page_layout import SIZES

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.browser

CARD = "dialog[open][aria-label='Schuler Bench']"
# The card of the tour is within the window, and does not lie over what it speaks of.
_CLEAR = """() => {
  const card = document.querySelector('.sb-tour').getBoundingClientRect();
  const ring = document.querySelector('.sb-ring').getBoundingClientRect();
  const within = card.left >= 0 && card.top >= 0 && card.right <= innerWidth && card.bottom <= innerHeight;
  const beside = card.left >= ring.right || ring.left >= card.right;
  const over = !beside && card.top < ring.bottom && ring.top < card.bottom;
  return within && ring.width > 20 && ring.height > 10 && !over;
}"""


@pytest.fixture(params=SIZES, ids=lambda size: f"{size[0]}x{size[1]}")
def visitor(request: pytest.FixtureRequest, browser: Browser, dashboard: Any) -> Iterator[Bench]:
    """A new visitor's browser, not yet at the page."""
    width, height = request.param
    context = browser.new_context(viewport={"width": width, "height": height})
    page = context.new_page()
    yield Bench(page, dashboard[0].url, dashboard[1].sessions)
    context.close()


def test_a_new_visitor_is_greeted_once_and_shown_around(visitor: Bench) -> None:
    page = visitor.page
    visitor.open(query="?fixedDpr=0.25")
    card = page.locator(CARD)
    card.wait_for()
    assert card.locator(".sb-door").count() == 3
    box = card.bounding_box()
    size = page.viewport_size
    assert box and size and box["y"] >= 0 and box["y"] + box["height"] <= size["height"]
    card.get_by_role("button", name="Guided tour, six steps").press("Enter")
    card.wait_for(state="detached")
    for number in range(1, 7):
        page.get_by_text(f"Step {number} of 6", exact=True).wait_for()
        page.wait_for_function(_CLEAR)
        page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowLeft")
    page.get_by_text("Step 5 of 6", exact=True).wait_for()
    page.keyboard.press("Escape")
    page.locator(".sb-tour").wait_for(state="detached")
    # another session in the same browser: it has been seen, and comes back when it is asked for
    visitor.open(query="?fixedDpr=0.25")
    page.wait_for_selector("#sb-start[data-fresh='1']", state="attached")
    visitor.settle()
    assert card.count() == 0
    page.locator(".sb-links").get_by_role("button", name="Start").click()
    card.wait_for()
    page.keyboard.press("Escape")
    card.wait_for(state="detached")
    assert visitor.faults == []


def test_scenarios_and_networks_are_chosen_by_their_pictures(bench: Bench) -> None:
    page = bench.page
    bench.reset("sikuliaq-like", selected=2)
    links, number = page.locator(".sb-links"), bench.run
    links.get_by_role("button", name="Networks").click()
    chosen = page.locator("dialog .sb-card[aria-pressed=true]")
    chosen.wait_for()
    assert chosen.locator("svg").count() == 1 and "Complementary filter" in chosen.inner_text()
    page.locator("dialog .sb-card", has_text="Two poles (Sun)").click()
    bench.wait_for_run(number)
    assert bench.session.scenario.method[2].network.id == "pole2"
    number = bench.run
    links.get_by_role("button", name="Scenarios").click()
    page.locator("dialog .sb-card", has_text="zha-fast").click()
    bench.wait_for_run(number)
    assert bench.session.origin == "zha-fast"
    bench.reset("sikuliaq-like")
    assert bench.faults == []


def test_the_first_door_lets_a_pendulum_swing(bench: Bench) -> None:
    page = bench.page
    page.locator(".sb-links").get_by_role("button", name="Start").click()
    page.locator(CARD).get_by_role("button", name="See an INS swing").click()
    page.wait_for_selector("#sb-stage [aria-label=pause]")
    page.locator(".sb-lesson").first.wait_for()
    page.locator("#sb-stage [aria-label=pause]").click()
    bench.settle()
    bench.reset("sikuliaq-like")
    assert bench.faults == []
