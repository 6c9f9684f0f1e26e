"""The whole system in the page: modes, the line under the network, growth over latitude, limit of H'(0)."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from app.plots.effective import earth_mode_text
from app.session.requirements import Requirements
from app.views.poles.whole import LATITUDES
from navcore.analysis.whole_system import growth_over_latitude
from navcore.foundation.units import DEG
from navcore.scenario.model import Scenario
from tests.browser.driver import Bench
from tests.browser.test_page_layout import SIZES, resize
from tests.browser.test_page_requirements import box

pytestmark = pytest.mark.browser

_DAY = 86400.0
_CUT = """() => [...document.querySelectorAll('.mantine-ScrollArea-viewport')]
  .filter(e => e.clientHeight > 0 && e.querySelector('.js-plotly-plot'))
  .map(e => [e.scrollWidth - e.clientWidth, e.scrollHeight - e.clientHeight])"""


@pytest.fixture
def whole(bench: Bench) -> Iterator[Bench]:
    """The shared page with a network that can be placed; the tab Poles and the method in hand in front."""
    bench.reset("sikuliaq-like", selected=1)
    data = bench.session.scenario.canonical()
    data["method"][1]["network"] = {"id": "unity2", "zeta": 0.5, "zeta2": 0.3}
    number = bench.run
    bench.session.change(Scenario.parse(data), None)
    bench.wait_for_run(number)
    bench.show(requirements=Requirements(), poles="channel")
    bench.tab("Poles", "Method")
    bench.box("pair ζ").wait_for()
    yield bench
    bench.show(requirements=Requirements(), poles="channel")
    resize(bench, SIZES[0])


def test_modes_growth_and_the_line_under_the_network_are_the_engines(whole: Bench) -> None:
    whole.choose("poles of", "system")
    whole.page.wait_for_selector(".gtitle, .annotation-text:has-text('Growth of the 24 h mode')")
    run = whole.session.run
    traces = {trace["name"]: trace for trace in whole.plotly()}
    scenario = run.scenario
    for method in run.methods[1:]:
        name = method.method.name
        rates = growth_over_latitude(method.network, method.method.damping, LATITUDES * DEG, scenario.earth)
        assert traces[f"{name} growth"]["y"] == pytest.approx((rates * _DAY).tolist(), rel=1e-6, abs=1e-9)
        (here,) = traces[f"{name} at the site"]["y"]
        assert here == pytest.approx(method.whole.earth_growth * _DAY, rel=1e-6)
        assert len(traces[f"{name} 24 h"]["x"]) >= 1
    told = earth_mode_text(run.methods[1].whole.earth_growth)
    line = f"Whole system: 24 h mode {told} at {abs(scenario.site.lat_deg):.3g}°."
    whole.page.get_by_text(line).first.wait_for()
    for size in reversed(SIZES):
        resize(whole, size)
        whole.tab("Poles")
        whole.page.wait_for_function(f"() => ({_CUT})().length > 0")
        assert all(right <= 0 and below <= 0 for right, below in whole.page.evaluate(_CUT)), size
    assert whole.faults == []


def test_a_pair_that_lets_the_24_h_mode_grow_is_not_placed_when_it_must_not(whole: Bench) -> None:
    before = whole.session.scenario
    whole.box("H'(0) ≤ 0").click()
    whole.box("pair ω/ωₛ").fill("1.2")
    whole.page.get_by_role("button", name="Place", exact=True).click()
    told = whole.notice("The pair was not placed")
    assert "H'(0)" in told and "the 24 h mode grows" in told and "unity2 with a pair below ωₛ" in told
    assert whole.session.scenario == before
    assert whole.session.display.requirements.h_slope_s == 0.0
    whole.close_notices()
    number = whole.run
    whole.box("pair ω/ωₛ").fill("0.8")
    whole.page.get_by_role("button", name="Place", exact=True).click()
    whole.wait_for_run(number)
    assert whole.session.run.methods[1].whole.earth_growth < 0.0
    # one limit: the tab Requirements has it too, and emptied there it is gone here
    whole.tab("Requirements")
    limit = box(whole, "H'(0) ≤ (s)")
    assert limit.input_value() == "0"
    limit.fill("")
    ticked = "id => document.getElementById(id).checked"
    whole.page.wait_for_function(f"id => !({ticked})(id)", arg=whole.id("H'(0) ≤ 0"))
    assert whole.faults == []
