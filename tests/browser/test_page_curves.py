"""Only curves that have changed are sent: each page of a session still has all curves of the run."""

from __future__ import annotations

import base64
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from app.bridge.controls import in_single
from app.editing import edits
from app.session.shown import shown
from app.views.errors.view import _OVERVIEW_KEYS, error_curves
from tests.browser.driver import Bench

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.browser

# The curves of each plot over time, by the name of its axis, as float32 in base64.
_CURVES = """() => Object.fromEntries(Object.values(window.__viserTestpoints.uplots).map(({chart}) => [
  chart.axes[1].label,
  chart.data.map(curve => {
    let letters = '';
    for (const byte of new Uint8Array(Float32Array.from(curve).buffer)) letters += String.fromCharCode(byte);
    return btoa(letters);
  }),
]))"""
# A hand on a slider: to the right and back, until it is let go.
_DRAG = """id => {
  let step = 0;
  window.drag = setInterval(() => {
    const key = step++ % 12 < 6 ? 'ArrowRight' : 'ArrowLeft';
    const thumb = document.getElementById(id).querySelector('[role=slider]');
    for (const kind of ['keydown', 'keyup'])
      thumb.dispatchEvent(new KeyboardEvent(kind, {key, code: key, bubbles: true, cancelable: true}));
  }, 50);
}"""
# Which curves of the first plot over time have the path that they had at the last look.
_PATHS = """() => {
  const {series} = Object.values(window.__viserTestpoints.uplots)[0].chart;
  const kept = series.slice(1).map(each => each._paths === each.lookedAt);
  for (const each of series) each.lookedAt = each._paths;
  return kept;
}"""
_LARGE = ".mantine-Modal-content .uplot canvas"
_LET_GO = "() => clearInterval(window.drag)"


@pytest.fixture
def late(browser: Browser, bench: Bench, dashboard: Any) -> Iterator[Bench]:
    """Give another page, which is not open yet."""
    context = browser.new_context(viewport={"width": 1920, "height": 1080})
    yield Bench(context.new_page(), dashboard[0].url, dashboard[1].sessions)
    context.close()


def wrong_curves(page: Bench) -> list[str]:
    """Name the curves of the session's run that a page does not show, or shows otherwise."""
    plots = error_curves(shown(page.session), _OVERVIEW_KEYS).plots.values()
    found, wrong = page.page.evaluate(_CURVES), []
    for plot in plots:
        label, names = plot.axes()[1]["label"], ("time", *plot.names)
        held = [np.frombuffer(base64.b64decode(curve), np.float32) for curve in found.get(label, ())]
        if len(held) != len(names):
            wrong.append(f"{label}: {len(held)} curves")
            continue
        each = zip(names, held, in_single(plot.data), strict=True)
        wrong += [f"{label}: {name}" for name, *pair in each if not np.array_equal(*pair, equal_nan=True)]
    return wrong


def has_all_curves(page: Bench) -> None:
    """Wait until a page shows the session's run, which is not to change meanwhile."""
    assert page.session.wait_idle(60.0)
    try:
        page.wait_until(lambda: wrong_curves(page) == [])
    except AssertionError as error:
        raise AssertionError(f"{wrong_curves(page)}: {error}") from None


def views_of(page: Bench) -> list[Any]:
    """Return the server's side of the session's pages."""
    return list(page._pages)


def test_every_page_has_all_curves_after_a_drag_and_after_its_connection_was_lost(
    bench: Bench, late: Bench, dashboard: Any
) -> None:
    bench.reset("sikuliaq-like", selected=2)
    bench.tab("Frequency", "Errors", "Method")
    bench.press("network.zeta")
    has_all_curves(bench)
    (first,) = views_of(bench)

    bench.page.evaluate(_DRAG, bench.id("network.zeta"))
    late.open(path=f"s/{bench.session_id}/")
    bench.page.evaluate(_LET_GO)
    bench.settle()
    has_all_curves(bench)
    has_all_curves(late)

    (second,) = (view for view in views_of(late) if view is not first)
    websockets = dashboard[0].viser._websock_server
    lost = websockets._live_connections[second.client.client_id]
    lost.loop.call_soon_threadsafe(lost.transport.abort)
    # Meanwhile the session goes on; viser's page connects again by itself.
    bench.press("network.zeta")
    late.wait_until(lambda: second not in views_of(late) and len(views_of(late)) > 1)
    has_all_curves(late)
    bench.press("network.zeta")
    has_all_curves(bench)
    has_all_curves(late)
    assert bench.faults == []


def test_a_curve_that_stands_still_keeps_its_path(bench: Bench) -> None:
    bench.reset("sikuliaq-like", selected=2)
    bench.tab("Method", "Errors")
    bench.press("network.zeta")
    bench.page.evaluate(_PATHS)
    bench.press("network.zeta")
    assert bench.page.evaluate(_PATHS) == [True, True, False]  # free, classic2, the method in hand
    bench.press("network.zeta", "ArrowLeft")
    has_all_curves(bench)
    assert bench.faults == []


def test_a_plot_in_its_large_window_follows_the_run(bench: Bench) -> None:
    bench.reset("sikuliaq-like", selected=2)
    bench.tab("Method", "Errors")
    bench.settle()
    page = bench.page
    plot = page.locator(".uplot-container").first
    plot.hover(position={"x": 30, "y": 30})
    plot.locator("button").click()
    page.wait_for_selector(_LARGE)
    before = page.evaluate(f"document.querySelector('{_LARGE}').toDataURL()")
    session = bench.session
    session.change(edits.with_value(session.scenario, ("method", 2, "network", "zeta"), 1.2), None)
    changed = f"before => document.querySelector('{_LARGE}').toDataURL() !== before"
    page.wait_for_function(changed, arg=before)
    page.keyboard.press("Escape")
    page.wait_for_selector(_LARGE, state="detached")
    assert bench.faults == []
