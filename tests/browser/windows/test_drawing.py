"""While the hand moves: what is in front follows, the rest is marked, and at rest all is of one run."""

from __future__ import annotations

import pytest

from tests.browser.driver import Bench
from tests.browser.test_page_redraw import _COUNT, _PATHS
from tests.browser.windows.seeing import read, see, speaks

pytestmark = pytest.mark.browser

_STATUS = "() => document.querySelector('#sb-status').textContent"
# A key of the slider is held down: to the right and back, until it is let go.
_HOLD = """id => {
  let step = 0;
  window.hand = setInterval(() => {
    const key = step++ % 40 < 20 ? 'ArrowRight' : 'ArrowLeft';
    const thumb = document.getElementById(id).querySelector('[role=slider]');
    const event = {key, code: key, repeat: true, bubbles: true, cancelable: true};
    thumb.dispatchEvent(new KeyboardEvent('keydown', event));
  }, 40);
}"""
_FIRST_CURVE = """() => {
  const {chart} = Object.values(window.__viserTestpoints.uplots)[0];
  return chart.data.at(-1).reduce((sum, value, place) => sum + (value ?? 0) * (1 + place % 97), 0);
}"""


def test_what_is_in_front_follows_a_drag_and_the_rest_is_marked(window: Bench) -> None:
    page, number = window.page, window.run
    see(window, window.slider("network.zeta"))
    moving = window.said("The slider moves; 3D view and numbers follow when it rests")
    page.evaluate(_HOLD, window.id("network.zeta"))
    try:
        page.wait_for_function(
            f"([before, moving]) => ({_FIRST_CURVE})() !== before && ({_STATUS})() === moving",
            arg=[page.evaluate(_FIRST_CURVE), moving],
        )
    finally:
        page.evaluate("() => clearInterval(window.hand)")
    window.wait_for_run(number)
    window.settle()
    page.wait_for_function(f"moving => ({_STATUS})() !== moving", arg=moving)
    window.settle()
    assert window.run == window.session.run_number
    read(window, page.locator("#sb-status"))
    speaks(window, moving)


def test_a_step_moves_the_lines_of_the_bode_plot_without_a_layout(window: Bench) -> None:
    page = window.page
    window.tab("Frequency")
    see(window, page.locator(".js-plotly-plot:visible"))
    window.press("network.zeta")
    window.plotly()
    page.evaluate(_COUNT)
    before, in_place = page.evaluate(_PATHS), 0
    for _ in range(3):
        was = page.evaluate("window.laidOut")
        window.press("network.zeta")
        window.plotly()
        in_place += page.evaluate("window.laidOut") == was
    assert in_place >= 1 and page.evaluate(_PATHS) != before


def test_a_tab_that_was_behind_shows_the_present_run(window: Bench) -> None:
    window.tab("Poles", "Metrics")
    window.press("network.zeta")
    window.tab("Step", "Errors")
    window.press("network.zeta")
    for tab in ("Step", "Frequency", "Poles"):
        window.tab(tab)
        assert window.plotly(), "of the run that is shown"
        see(window, window.page.locator(".js-plotly-plot:visible"))
    assert window.run == window.session.run_number
