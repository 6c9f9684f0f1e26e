"""What the address of the page can ask for: tabs in front, one view alone."""

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


# The view with this name fills the window and has been drawn.
_FILLS = """view => {
  const shown = document.querySelector(`[data-sb-alone="${view}"]`);
  const drawn = shown?.querySelector('.js-plotly-plot .trace, .uplot canvas');
  if (!drawn || document.getElementById('sb-veil')) return false;
  const plots = [...shown.querySelectorAll('.js-plotly-plot, .uplot')]
    .map(plot => plot.getBoundingClientRect());
  const [top, left] = ['top', 'left'].map(side => Math.min(...plots.map(box => box[side])));
  const [bottom, right] = ['bottom', 'right'].map(side => Math.max(...plots.map(box => box[side])));
  const within = top >= 0 && left >= 0 && bottom <= innerHeight && right <= innerWidth;
  return within && right - left > 0.9 * innerWidth && bottom - top > 0.72 * innerHeight;
}"""
# Labels or roles of the controls that a user sees.
_CONTROLS = """() =>
  [...document.querySelectorAll('input, select, textarea, [role=tab], [role=slider], .mantine-Button-root')]
    .filter(each => each.checkVisibility({visibilityProperty: true}))
    .map(each => each.getAttribute('aria-label') ?? each.getAttribute('role') ?? each.tagName)"""


def test_one_view_fills_the_window_without_controls(visitor: Callable[[int, int], Bench]) -> None:
    bench = visitor(600, 380)
    page = bench.page
    for name, width in (("bode", 500), ("errors", 600)):  # 500: there viser would leave the views out
        page.set_viewport_size({"width": width, "height": 380})
        page.goto(f"{bench.url}?fixedDpr=0.25&view={name}")
        page.wait_for_function(_FILLS, arg=name)
        assert page.evaluate(_CONTROLS) == []
        page.keyboard.press("Control+k")
        page.keyboard.press("?")
        bench.sent()
        assert page.get_by_role("dialog").count() == 0
        assert page.evaluate(_CONTROLS) == []
    page.goto(f"{bench.url}?fixedDpr=0.25&view=boat")
    told = bench.notice("No such view")
    assert "'boat'" in told and "bode, poles, step" in told and "map, follow, top, side" in told
    assert page.evaluate(_CONTROLS) == []
    page.goto(f"{bench.url}?fixedDpr=0.25&view=switching")
    assert "Switching" in bench.notice("Nothing to show")
    # the same session with all its controls: what is asked for above can be seen
    page.set_viewport_size({"width": 1280, "height": 720})
    bench.open(f"s/{bench.session_id}/")
    bench.heard()
    assert len(page.evaluate(_CONTROLS)) > 20
    page.keyboard.press("?")
    page.get_by_role("dialog", name="Keys").wait_for()
    assert bench.faults == []


# The 3D view fills the window, seen so; its key stands over it, without the bar.
_STAGE = """camera => {
  const now = JSON.parse(document.getElementById('sb-playback')?.dataset.now ?? '{}');
  const box = document.querySelector('canvas[data-engine]')?.getBoundingClientRect();
  const seen = selector => document.querySelector(selector)?.checkVisibility({visibilityProperty: true});
  return !document.getElementById('sb-veil') && now.camera === camera && box?.width === innerWidth
    && box.height === innerHeight && seen('#sb-stage .sb-key') && !seen('#sb-stage .sb-bar');
}"""


def test_the_map_fills_the_window_without_controls(visitor: Callable[[int, int], Bench]) -> None:
    bench = visitor(600, 380)
    page, looks = bench.page, []
    for camera in ("map", "top"):
        page.goto(f"{bench.url}?fixedDpr=0.25&view={camera}")
        page.wait_for_function(_STAGE, arg=camera)
        page.wait_for_function("() => window.__viserSceneTree.getState()['/track/truth'] !== undefined")
        assert page.evaluate(_CONTROLS) == []
        assert page.locator("#sb-stage button:visible").all_inner_texts() == [
            entry.inner_text() for entry in page.locator("#sb-stage .sb-entry").all()
        ]
        looks.append(bench.wait_for_change(page.screenshot, *looks))
    page.goto(f"{bench.url}?fixedDpr=0.25&view=bode")
    page.wait_for_function(_FILLS, arg="bode")
    assert not page.locator("#sb-stage").is_visible()
    assert bench.faults == []
