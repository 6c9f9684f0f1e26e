"""Tabs Design and Tune in three windows: the bars follow a slider, a proposal is accepted and undone."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from app.views.design.view import BUDGET_OF, CHOICES
from app.views.tune.view import ACCEPT, DISCARD, TUNE
from tests.browser.driver import Bench
from tests.browser.test_page_layout import SIZES, resize

pytestmark = pytest.mark.browser

_BARS = """() => [...document.querySelectorAll('.js-plotly-plot')]
  .filter(p => p.offsetParent !== null && p._fullLayout?.meta?.view === 'Design')
  .flatMap(p => p._fullData.filter(t => t.yaxis === 'y').map(t => t.y[2]))
  .reduce((a, b) => a + b, 0)"""
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
    resized.session.show(None, budget="steady", objective="tilt_rms")
    resized.tab("Method", "Design")
    yield resized
    assert resized.faults == []


def test_the_bars_follow_a_slider_and_the_run_has_four_panels(window: Bench) -> None:
    page = window.page
    page.wait_for_function(f"() => ({_BARS})() > 0", timeout=20_000)
    before = page.evaluate(_BARS)
    window.press("zeta")
    page.wait_for_function(f"old => Math.abs(({_BARS})() - old) > 1e-4 * old", arg=before, timeout=20_000)
    window.choose(BUDGET_OF, CHOICES["run"])
    page.wait_for_function(f"() => ({_PANELS})() === 4", timeout=60_000)


def test_a_proposal_is_accepted_and_undone_or_discarded(window: Bench) -> None:
    page, session = window.page, window.session
    before = session.scenario
    window.tab("Tune")
    page.get_by_role("button", name=TUNE, exact=True).click()
    page.get_by_role("button", name=ACCEPT, exact=True).wait_for(timeout=90_000)
    assert "times the floor" in page.locator(".sb-proposal").inner_text()
    assert session.scenario == before
    page.get_by_role("button", name=ACCEPT, exact=True).click()
    page.get_by_role("button", name=ACCEPT, exact=True).wait_for(state="hidden", timeout=20_000)
    assert session.scenario.method[2].network != before.method[2].network
    assert session.undo() and session.scenario == before
    page.get_by_role("button", name=TUNE, exact=True).click()
    page.get_by_role("button", name=DISCARD, exact=True).wait_for(timeout=90_000)
    page.get_by_role("button", name=DISCARD, exact=True).click()
    page.locator(".sb-proposal").wait_for(state="hidden", timeout=20_000)
    assert session.scenario == before
