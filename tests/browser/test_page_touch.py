"""A tablet: a slider, a tab and a plot are driven by a finger, and what it must hit is large enough."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import pytest

from tests.browser.driver import Bench
from tests.browser.placing import placing_scenario
from tests.browser.test_page_handles import _AT, _CENTRE, _SPOT, NEAR, pair, pole
from tests.browser.test_page_layout import _TEXT_OUTSIDE, wait_until_it_fits

if TYPE_CHECKING:
    from playwright.sync_api import Browser

    from app.http.server import DashboardServer
    from app.serve import Dashboard

pytestmark = pytest.mark.browser

WIDTH, HEIGHT = 1180, 820
LEAST_PX = 40

Drag = Callable[[tuple[float, float], tuple[float, float]], None]

# What a finger must hit and is smaller than that: of a slider and of a label with it, the row is hit.
_SMALL = """least => [...document.querySelectorAll('button, select, summary, [role=tab], input')]
  .filter(e => e.offsetParent !== null && !e.closest('[data-sb-kind=hidden]') && e.type !== 'file')
  .map(e => [e.ariaLabel || e.textContent || e.id, e.getBoundingClientRect()])
  .filter(([_, box]) => box.width > 0 && Math.min(box.width, box.height) < least - 0.5)
  .map(([name, box]) => `${name} ${Math.round(box.width)} x ${Math.round(box.height)}`)"""
_TIMES = """() => {
  const scale = Object.values(window.__viserTestpoints.uplots)[0].chart.scales.x;
  return [scale.min, scale.max];
}"""

# Two taps in the middle of the first plot: those of a driver come as late as the machine is busy.
_TWO_TAPS = """() => {
  const over = document.querySelector('.u-over'), box = over.getBoundingClientRect();
  const at = {clientX: box.left + box.width / 2, clientY: box.top + box.height / 2};
  const how = {bubbles: true, pointerType: 'touch', isPrimary: true, pointerId: 7, ...at};
  for (const kind of ['pointerdown', 'pointerup', 'pointerdown', 'pointerup']) {
    over.dispatchEvent(new PointerEvent(kind, how));
  }
}"""


@pytest.fixture(scope="module")
def tablet(browser: Browser, dashboard: tuple[DashboardServer, Dashboard]) -> Iterator[Bench]:
    """A page of its own on a tablet, held across."""
    context = browser.new_context(viewport={"width": WIDTH, "height": HEIGHT}, has_touch=True)
    bench = Bench(context.new_page(), dashboard[0].url, dashboard[1].sessions).open()
    bench.heard()
    yield bench
    context.close()


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
        tablet.page.get_by_role("tab", name=tab, exact=True).tap()
        tablet.heard()
        wait_until_it_fits(tablet, tab)
        assert tablet.page.evaluate(_TEXT_OUTSIDE) == [], tab
        assert tablet.page.evaluate(_SMALL, LEAST_PX) == [], tab
    assert tablet.faults == []


def test_a_finger_moves_a_slider(tablet: Bench, drag: Drag) -> None:
    tablet.page.get_by_role("tab", name="Method", exact=True).tap()
    tablet.heard()
    slider = tablet.page.locator("[data-dock-region=left] [role=slider]").first
    slider.scroll_into_view_if_needed()
    number, before, box = tablet.run, slider.get_attribute("aria-valuenow"), slider.bounding_box()
    middle = box["x"] + box["width"] / 2.0, box["y"] + box["height"] / 2.0
    drag(middle, (middle[0] + 30.0, middle[1]))
    tablet.wait_for_run(number)
    tablet.settle()
    assert slider.get_attribute("aria-valuenow") != before
    assert tablet.faults == []


def test_a_finger_zooms_a_plot_over_time_and_two_taps_show_it_whole(tablet: Bench, drag: Drag) -> None:
    page = tablet.page
    page.get_by_role("tab", name="Errors", exact=True).tap()
    tablet.heard()
    page.wait_for_selector(".u-over")
    whole, box = page.evaluate(_TIMES), page.locator(".u-over").first.bounding_box()
    y = box["y"] + 0.5 * box["height"]
    drag((box["x"] + 0.25 * box["width"], y), (box["x"] + 0.75 * box["width"], y))
    span = whole[1] - whole[0]
    page.wait_for_function(f"span => {{ const [a, b] = ({_TIMES})(); return b - a < 0.6 * span; }}", arg=span)
    low, high = page.evaluate(_TIMES)
    assert low == pytest.approx(whole[0] + 0.25 * span, abs=0.03 * span)
    assert high == pytest.approx(whole[0] + 0.75 * span, abs=0.03 * span)
    page.evaluate(_TWO_TAPS)
    back = f"span => {{ const [a, b] = ({_TIMES})(); return b - a > 0.99 * span; }}"
    page.wait_for_function(back, arg=span)
    assert tablet.faults == []


@pytest.fixture
def handles(tablet: Bench) -> Bench:
    """The tablet on a scenario whose second method, in hand, has a pair that can be placed."""
    tablet.put(placing_scenario(), origin=f"handles {tablet.session.run_number}", selected=1)
    tablet.show(transfer="phi/dv_r", poles="channel", locus="")
    return tablet


def drag_ring(bench: Bench, drag: Drag, to: tuple[float, float]) -> None:
    """Take the last ring in view with a finger to a place in the window; the run follows."""
    number = bench.run
    drag(bench.page.locator(".sb-handle:visible").last.evaluate(_CENTRE), to)
    bench.wait_for_run(number)
    bench.settle()


def test_a_finger_drags_a_pole(handles: Bench, drag: Drag) -> None:
    handles.page.get_by_role("tab", name="Poles", exact=True).tap()
    handles.heard()
    handles.page.wait_for_function(_AT, arg=[*NEAR, *pole(handles)])
    before = handles.session.scenario
    drag_ring(handles, drag, handles.page.evaluate(_SPOT, [*NEAR, -1.0, 1.25]))
    assert pole(handles) == pytest.approx((-1.0, 1.25), abs=0.03)
    handles.page.wait_for_function(_AT, arg=[*NEAR, *pole(handles)])
    assert handles.session.undo()
    assert handles.session.scenario == before, "a drag is one step"
    assert handles.faults == []


def test_a_finger_drags_the_handle_of_the_bode_plot(handles: Bench, drag: Drag) -> None:
    handles.page.get_by_role("tab", name="Frequency", exact=True).tap()
    handles.heard()
    ring = handles.page.locator(".sb-handle:visible").last
    ring.wait_for()
    twice = 2.0 * handles.session.scenario.omega_s
    x, _ = handles.page.evaluate(_SPOT, ["xaxis2", "yaxis3", twice, 1.0])
    drag_ring(handles, drag, (x, ring.evaluate(_CENTRE)[1] - 20.0))
    zeta, r = pair(handles)
    assert r == pytest.approx(2.0, rel=0.03)
    assert zeta < 0.45
    assert handles.faults == []
