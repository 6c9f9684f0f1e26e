"""A tablet: a slider, a tab and a plot are driven by a finger, and what it must hit is large enough."""

from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Browser

from tests.browser.choosing import standing
from tests.browser.conftest import Served
from tests.browser.driver import Bench
from tests.browser.placing import NEAR, centre, pair, place, pole, ring_at, spot
from tests.browser.test_page_layout import wait_until_it_fits

WIDTH, HEIGHT = 1180, 820
LEAST_PX = 40

Drag = Callable[[tuple[float, float], tuple[float, float]], None]


@pytest.fixture(scope="module")
def held(browser: Browser, dashboard: Served) -> Iterator[Bench]:
    """A page of its own on a tablet, held across."""
    context = browser.new_context(viewport={"width": WIDTH, "height": HEIGHT}, has_touch=True)
    yield Bench(context.new_page(), dashboard[0].url, dashboard[1].sessions).open()
    context.close()


@pytest.fixture
def tablet(held: Bench) -> Iterator[Bench]:
    """The tablet, once the server knows its window."""
    held.heard()
    yield held
    assert held.faults == []


def tap(tablet: Bench, tab: str) -> None:
    """Bring a tab to the front by a finger."""
    found = tablet.tab_of(tab)
    if not found.is_visible():  # a mode that is not chosen
        one = standing(tab)
        assert one is not None
        tablet.page.get_by_role("tab", name=one.tab, exact=True).tap()
        found = tablet.page.locator(f".sb-modes [data-view='{tab}']")
    found.tap()
    tablet.heard()


@pytest.fixture
def drag(tablet: Bench) -> Drag:
    """Move one finger over the page."""
    tools = tablet.page.context.new_cdp_session(tablet.page)

    def touch(kind: str, *points: dict[str, float]) -> None:
        tools.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": list(points)})

    def move(start: tuple[float, float], end: tuple[float, float]) -> None:
        (x, y), steps = start, 8
        touch("touchStart", {"x": x, "y": y})
        for step in range(1, steps + 1):
            part = step / steps
            touch("touchMove", {"x": x + part * (end[0] - x), "y": y + part * (end[1] - y)})
        touch("touchEnd")

    return move


def test_fingers_have_room_and_nothing_is_cut(tablet: Bench) -> None:
    for tab in ("Errors", "Frequency", "Poles", "Step"):
        tap(tablet, tab)
        wait_until_it_fits(tablet, tab)
        assert tablet.page.evaluate("look.textOutside") == [], tab
        assert tablet.page.evaluate("look.small", LEAST_PX) == [], tab


def test_a_finger_moves_a_slider(tablet: Bench, drag: Drag) -> None:
    tap(tablet, "Method")
    slider = tablet.page.locator("[data-dock-region=left] [role=slider]").first
    slider.scroll_into_view_if_needed()
    before, box = slider.get_attribute("aria-valuenow"), slider.bounding_box()
    x, y = box["x"] + box["width"] / 2.0, box["y"] + box["height"] / 2.0
    with tablet.next_run():
        drag((x, y), (x + 30.0, y))
    assert slider.get_attribute("aria-valuenow") != before


def test_a_finger_zooms_a_plot_over_time_and_two_taps_show_it_whole(tablet: Bench, drag: Drag) -> None:
    page = tablet.page
    tap(tablet, "Errors")
    page.wait_for_selector(".u-over")
    (start, end), box = page.evaluate("look.times"), page.locator(".u-over").first.bounding_box()
    y, span = box["y"] + 0.5 * box["height"], end - start
    width = "span => {{ const [a, b] = ({})(); return b - a {} * span; }}"
    drag((box["x"] + 0.25 * box["width"], y), (box["x"] + 0.75 * box["width"], y))
    page.wait_for_function(width.format("look.times", "< 0.6"), arg=span)
    middle = [start + 0.25 * span, start + 0.75 * span]
    assert page.evaluate("look.times") == pytest.approx(middle, abs=0.03 * span)
    page.evaluate("look.twoTaps")
    page.wait_for_function(width.format("look.times", "> 0.99"), arg=span)


def drag_ring(tablet: Bench, drag: Drag, to: tuple[float, float]) -> None:
    """Take the last ring in view with a finger to a place in the window; the run follows."""
    with tablet.next_run():
        drag(centre(tablet), to)


def test_a_finger_drags_a_pole(tablet: Bench, drag: Drag) -> None:
    place(tablet, "Errors")
    tap(tablet, "Poles")
    ring_at(tablet)
    before = tablet.session.scenario
    drag_ring(tablet, drag, spot(tablet, *NEAR, -1.0, 1.25))
    assert pole(tablet) == pytest.approx((-1.0, 1.25), abs=0.03)
    ring_at(tablet)
    assert tablet.session.undo()
    assert tablet.session.scenario == before, "a drag is one step"


def test_a_finger_drags_the_handle_of_the_bode_plot(tablet: Bench, drag: Drag) -> None:
    place(tablet, "Errors")
    tap(tablet, "Frequency")
    tablet.page.locator(".sb-handle:visible").last.wait_for()
    x, _ = spot(tablet, "xaxis2", "yaxis3", 2.0 * tablet.session.scenario.omega_s, 1.0)
    drag_ring(tablet, drag, (x, centre(tablet)[1] - 20.0))
    zeta, r = pair(tablet)
    assert r == pytest.approx(2.0, rel=0.03)
    assert zeta < 0.45
