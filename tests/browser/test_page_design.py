"""Bands, Design and Tune in three windows: bars follow a slider; proposals and points are taken, undone."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from app.jobs.designer import FrontsTask
from app.views.appearance.view import BANDS
from app.views.design.view import BUDGET_OF, CHOICES
from app.views.tune.finder import FIND, STOP
from app.views.tune.setting import ACCEPT, DISCARD, TUNE
from app.views.tune.view import SEARCH_FOR
from tests.browser.driver import Bench
from tests.browser.test_page_layout import SIZES, resize

pytestmark = pytest.mark.browser

_AT_FIRST = {"budget": "steady", "objective": "tilt_rms", "search": "setting", "envelope": "none"}
_BARS = """() => [...document.querySelectorAll('.js-plotly-plot')]
  .filter(p => p.offsetParent !== null && p._fullLayout?.meta?.view === 'Design')
  .flatMap(p => p._fullData.filter(t => t.yaxis === 'y').map(t => t.x[2]))
  .reduce((a, b) => a + b, 0)"""
# Bands of the plot of the east velocity, and the sum of the last one's upper edge.
_BAND = """() => {
  const chart = Object.values(window.__viserTestpoints?.uplots ?? {})
    .map(entry => entry.chart).find(c => c.axes[1].label.startsWith('δVE'));
  const bands = chart?.bands ?? [];
  return [bands.length, bands.length ? chart.data[bands.at(-1).series[0]].reduce((a, b) => a + b, 0) : 0];
}"""
_LEGEND = "() => document.body.innerText.match(/band: .*/)?.[0] ?? ''"
# Where a point of the fronts lies in the window, CSS px; null while it is not drawn.
_SPOT = """name => {
  const plot = [...document.querySelectorAll('.js-plotly-plot')].find(
    p => p.offsetParent !== null && p._fullLayout?.meta?.view === 'Tune');
  const trace = plot?._fullData?.find(t => t.name === name);
  if (!trace) return null;
  const frame = plot.getBoundingClientRect();
  const {xaxis: x, yaxis: y} = plot._fullLayout;
  return [frame.left + x._offset + x.d2p(trace.x[0]), frame.top + y._offset + y.d2p(trace.y[0])];
}"""
_PANELS = """() => [...document.querySelectorAll('.js-plotly-plot')]
  .filter(p => p.offsetParent !== null && p._fullLayout?.meta?.view === 'Design')
  .map(p => new Set(p._fullData.map(t => t.yaxis)).size)[0] ?? 0"""


@pytest.fixture(scope="module", params=SIZES, ids=lambda size: f"{size[0]}x{size[1]}")
def resized(request: pytest.FixtureRequest, opened: Bench) -> Iterator[Bench]:
    resize(opened, request.param)
    yield opened
    resize(opened, SIZES[0])


@pytest.fixture
def window(resized: Bench) -> Iterator[Bench]:
    resized.faults.clear()
    resized.reset("sikuliaq-like", selected=2)
    resized.show(**_AT_FIRST)
    resized.tab("Method", "Design")
    yield resized
    resized.show(**_AT_FIRST)
    assert resized.faults == []


def test_a_band_of_one_sigma_follows_the_scenario_and_says_what_it_is(window: Bench) -> None:
    page, session = window.page, window.session
    window.tab("View", "Errors")
    window.choose(BANDS, "±1σ by covariance")
    page.wait_for_function(f"() => ({_BAND})()[0] === 3", timeout=60_000)
    assert page.evaluate(_LEGEND).startswith("band: ±1σ by covariance")
    before = page.evaluate(_BAND)[1]
    window.tab("Method")
    window.select(2)
    window.press("network.zeta")
    fresh = f"old => !({_LEGEND})().includes('earlier') && ({_BAND})()[1] !== old"
    page.wait_for_function(fresh, arg=before, timeout=60_000)
    assert session.run is not None
    found = session.envelopes.beside(session.run.scenario, "covariance")
    assert found is not None and not found.old and found.high[2] is not None


def test_the_bars_follow_a_slider_and_the_run_has_four_panels(window: Bench) -> None:
    page = window.page
    page.wait_for_function(f"() => ({_BARS})() > 0")
    before = page.evaluate(_BARS)
    window.press("network.zeta")
    page.wait_for_function(f"old => Math.abs(({_BARS})() - old) > 1e-4 * old", arg=before)
    window.choose(BUDGET_OF, CHOICES["run"])
    page.wait_for_function(f"() => ({_PANELS})() === 4", timeout=60_000)


def test_a_proposal_is_accepted_and_undone_or_discarded(window: Bench) -> None:
    page, session = window.page, window.session
    before = session.scenario
    window.tab("Tune")
    page.get_by_role("button", name=TUNE, exact=True).click()
    page.get_by_role("button", name=ACCEPT, exact=True).wait_for(timeout=120_000)
    assert "times the floor" in page.locator(".sb-proposal").inner_text()
    assert session.scenario == before
    page.get_by_role("button", name=ACCEPT, exact=True).click()
    page.get_by_role("button", name=ACCEPT, exact=True).wait_for(state="hidden")
    assert session.scenario.method[2].network != before.method[2].network
    assert session.undo() and session.scenario == before
    page.get_by_role("button", name=TUNE, exact=True).click()
    page.get_by_role("button", name=DISCARD, exact=True).wait_for(timeout=120_000)
    page.get_by_role("button", name=DISCARD, exact=True).click()
    page.locator(".sb-proposal").wait_for(state="hidden")
    assert session.scenario == before


def test_a_click_on_a_point_of_the_fronts_is_one_step_of_undo(window: Bench) -> None:
    page, session = window.page, window.session
    window.tab("Tune")
    window.choose(SEARCH_FOR, "Pareto fronts")
    page.get_by_role("button", name=FIND, exact=True).click()
    page.get_by_role("button", name=STOP, exact=True).click()
    page.get_by_text("Stopped: no fronts were found.").wait_for(timeout=60_000)
    # all networks take too long for a test
    search = session.searches.fronts
    search.begin(FrontsTask(session.scenario, 2, ("tilt_rms", "velocity_rms"), ("classic2", "classic3")))
    page.wait_for_function(f"() => ({_SPOT})('classic3') !== null", timeout=60_000)
    before = session.scenario
    page.mouse.click(*page.evaluate(_SPOT, "classic3"))
    window.notice("classic3 from the Pareto fronts")
    assert session.scenario.method[2].network.id == "classic3"
    assert session.undo() and session.scenario == before
    window.close_notices()
