"""The frequency workbench as the user drives it: Nyquist, measured dots, locus, placing a pair."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from app.views.frequency.nyquist import margins_of
from navcore.analysis import analyse
from navcore.scenario.model import Scenario
from tests.browser.driver import Bench
from tests.browser.fields import label_of
from tests.browser.placing import placing_scenario
from tests.browser.test_page_layout import SIZES, resize

pytestmark = pytest.mark.browser

# Where a point of the right pole map lies in the window, CSS px.
_SPOT = """([re, im]) => {
  const plot = [...document.querySelectorAll('.js-plotly-plot')].find(
    p => p.offsetParent !== null && p._fullLayout?.meta?.pick);
  const frame = plot.getBoundingClientRect();
  const {xaxis2, yaxis2} = plot._fullLayout;
  return [frame.left + xaxis2._offset + xaxis2.d2p(re), frame.top + yaxis2._offset + yaxis2.d2p(im)];
}"""
_HAS_TRACE = """name => [...document.querySelectorAll('.js-plotly-plot')].some(
  p => p.offsetParent !== null && p._fullData?.some(t => t.name === name && t.x?.length > 0))"""
_HAS_NO_TRACE = f"name => !({_HAS_TRACE})(name)"
_TOOLS_IN_ROW = """() => {
  const tools = [...document.querySelectorAll('.sb-tools')].map(e => e.parentElement.parentElement);
  return tools.filter(t => t.offsetParent !== null).map(t => {
    const controls = [...t.children].filter(c => c.querySelector('.js-plotly-plot') === null);
    const found = controls.flatMap(c => [...c.querySelectorAll('input:not([type=hidden]), button')]);
    const boxes = found.map(e => e.getBoundingClientRect());
    const middles = boxes.filter(b => b.width > 0).map(b => b.top + b.height / 2);
    const labels = [...t.querySelectorAll('p:has(> label)')].map(p => p.scrollWidth - p.clientWidth);
    return [Math.max(...middles) - Math.min(...middles), Math.max(...labels)];
  });
}"""


FREE = {"name": "free"}


@pytest.fixture
def workbench(bench: Bench) -> Bench:
    """The shared page on a scenario of its own; its second method in hand, all choices as at first."""
    bench.put(placing_scenario(FREE), origin=f"workbench {bench.session.run_number}", selected=1)
    bench.show(transfer="phi/dv_r", discrete=False, locus="")
    return bench


def poles_of(bench: Bench, index: int) -> np.ndarray:
    made = bench.session.scenario
    return analyse(made.method[index].network.transfer(made.omega_s)).poles / made.omega_s


def trace(bench: Bench, name: str, place: int = 0) -> dict[str, Any]:
    bench.page.wait_for_function(_HAS_TRACE, arg=name)
    return [t for t in bench.plotly() if t["name"] == name][place]


def test_the_chooser_shows_nyquist_with_margins(workbench: Bench) -> None:
    workbench.tab("Frequency")
    workbench.choose("transfer", "open loop: Nyquist plot and margins")
    run = workbench.session.run
    assert run is not None
    found = margins_of(run.methods[1])
    assert found is not None and found.phase_rad is not None
    dot = trace(workbench, "placed margin", 2)
    assert np.hypot(dot["x"][0], dot["y"][0]) == pytest.approx(1.0)
    assert np.angle(-complex(dot["x"][0], dot["y"][0])) == pytest.approx(found.phase_rad, rel=1e-6)
    words = workbench.page.locator(".annotation-text").all_text_contents()
    assert any(f"placed: phase {math.degrees(found.phase_rad):.3g}°" in text for text in words)
    assert any("free: no margin: undamped" in text for text in words)
    # a second method's slider moves the margin
    workbench.tab("Method")
    workbench.press("network.zeta")
    after = trace(workbench, "placed margin", 2)
    assert after["x"] != dot["x"]
    workbench.choose("transfer", "tilt from log error")
    workbench.page.wait_for_function(_HAS_NO_TRACE, arg="placed margin")
    assert workbench.faults == []


def test_measured_filter_lies_on_h(workbench: Bench) -> None:
    workbench.tab("Frequency")
    switch = workbench.page.locator(f"[id='{workbench.id('measured filter')}']")
    switch.click()
    dots, curve = trace(workbench, "placed measured"), trace(workbench, "placed")
    on_curve = np.interp(np.log(dots["x"]), np.log(curve["x"]), curve["y"])
    assert len(dots["x"]) >= 10
    assert np.max(np.abs(np.array(dots["y"]) - on_curve)) < 0.05
    assert workbench.session.display.discrete
    workbench.settle()
    switch.click()
    workbench.page.wait_for_function(_HAS_NO_TRACE, arg="placed measured")


def test_locus_over_each_parameter_of_the_network_in_hand(workbench: Bench) -> None:
    workbench.tab("Poles")
    workbench.choose("locus", label_of("network.zeta"))
    locus = trace(workbench, "placed locus")
    points = np.array(locus["x"], float) + 1j * np.array(locus["y"], float)
    for pole in poles_of(workbench, 1):
        assert np.nanmin(np.abs(points - pole)) < 0.1
    assert workbench.page.get_by_text("over ζ: ○ 0.02 … □ 1.5, ✕ 0.5").count() == 1
    workbench.choose("locus", label_of("network.r"))
    workbench.page.get_by_text("over r: ○ 0.5").wait_for()
    # a network without parameters has no locus
    workbench.select(0)
    workbench.page.wait_for_function(_HAS_NO_TRACE, arg="placed locus")
    assert workbench.box("locus").input_value() == "nothing"
    assert workbench.faults == []


def test_a_click_into_the_pole_map_places_the_pair_in_one_step(workbench: Bench) -> None:
    workbench.tab("Poles")
    trace(workbench, "placed")
    before, number = workbench.session.scenario, workbench.run
    x, y = workbench.page.evaluate(_SPOT, [-1.0, 1.25])
    workbench.page.mouse.click(x, y)
    workbench.wait_for_run(number)
    assert "pair at" in workbench.notice("Placed")
    assert np.abs(poles_of(workbench, 1) - (-1.0 + 1.25j)).min() < 0.03
    made = workbench.session.scenario
    assert (made.method[0], made.method[2]) == (before.method[0], before.method[2])
    shown = trace(workbench, "placed", 1)
    assert np.min(np.abs(np.array(shown["x"]) + 1j * np.array(shown["y"]) - (-1.0 + 1.25j))) < 0.03
    # one step back is the scenario as it was
    number = workbench.run
    workbench.page.keyboard.press("Control+z")
    workbench.wait_for_run(number)
    assert workbench.session.scenario == before
    # a drag zooms and places nothing
    workbench.page.mouse.move(x, y)
    workbench.page.mouse.down()
    workbench.page.mouse.move(x + 60, y + 60, steps=4)
    workbench.page.mouse.up()
    workbench.page.wait_for_timeout(600)  # a click is told so late, for it may become a double click
    workbench.settle()
    assert workbench.session.scenario == before
    workbench.page.mouse.dblclick(x, y)
    workbench.page.wait_for_timeout(600)
    workbench.settle()
    assert workbench.session.scenario == before
    assert workbench.faults == []


def test_what_cannot_be_placed_is_said(workbench: Bench) -> None:
    workbench.tab("Poles")
    trace(workbench, "placed")
    before = workbench.session.scenario
    x, y = workbench.page.evaluate(_SPOT, [0.2, 1.0])
    workbench.page.mouse.click(x, y)
    assert "nearest possible" in workbench.notice("The pair was not placed")
    workbench.close_notices()
    workbench.select(0)
    workbench.page.get_by_role("button", name="Place", exact=True).click()
    assert "no parameter" in workbench.notice("The pair was not placed")
    assert workbench.session.scenario == before


def test_a_typed_pair_is_placed(workbench: Bench) -> None:
    workbench.tab("Poles")
    number = workbench.run
    workbench.box("pair ζ").fill("0.35")
    workbench.box("pair ω/ωₛ").fill("1.6")
    workbench.page.get_by_role("button", name="Place", exact=True).click()
    workbench.wait_for_run(number)
    wanted = 1.6 * (-0.35 + 1j * np.sqrt(1 - 0.35**2))
    assert np.abs(poles_of(workbench, 1) - wanted).min() < 1e-6
    network = workbench.session.scenario.method[1].network
    assert network.model_dump()["zeta"] == pytest.approx(0.35)
    assert network.model_dump()["r"] == pytest.approx(1.6)


def test_margin_of_a_law_over_time_stands_in_the_switching_view(workbench: Bench) -> None:
    data = placing_scenario(FREE).canonical()
    data["method"][1]["policy"] = {"id": "adaptive"}
    workbench.put(Scenario.parse(data), selected=1)
    workbench.tab("Switching")
    label = """() => Object.values(window.__viserTestpoints?.uplots ?? {})
      .some(entry => entry.chart.axes[1].label.startsWith('least ζ'))"""
    workbench.page.wait_for_function(label)
    charts = {chart["label"]: chart["data"] for chart in workbench.curves()}
    xi, margin = charts["ζ (–)"][1], charts["least ζ (–)"][1]
    # unity2 has the damping ratio that its coefficient says
    assert margin == pytest.approx(xi, rel=1e-3)
    assert charts["least ζ (–)"][0] == charts["ζ (–)"][0]


def test_tools_stand_in_one_row_in_every_window(workbench: Bench) -> None:
    try:
        for size in reversed(SIZES):
            resize(workbench, size)
            for tab in ("Frequency", "Poles"):
                workbench.tab(tab)
                workbench.page.wait_for_function(_HAS_TRACE, arg="placed")
                rows = workbench.page.evaluate(_TOOLS_IN_ROW)
                assert rows, tab
                for apart, cut in rows:
                    assert apart < 8 and cut <= 0, (size, tab, rows)
    finally:
        resize(workbench, SIZES[0])
    assert workbench.faults == []


def test_the_whole_system_stands_beside_the_channel(workbench: Bench) -> None:
    workbench.tab("Poles")
    workbench.choose("poles of", "system")
    growth = trace(workbench, "placed growth")
    run = workbench.session.run
    assert run is not None
    whole = run.methods[1].whole
    site = trace(workbench, "placed at the site")
    assert site["y"][0] == pytest.approx(whole.earth_growth * 86400.0, rel=1e-6)
    at = np.interp(abs(run.scenario.site.lat_deg), growth["x"], growth["y"])
    assert at == pytest.approx(site["y"][0], rel=0.01)
    mode = trace(workbench, "placed 24 h")
    assert len(mode["x"]) == len(whole.named("24 h"))
    workbench.tab("Method")
    workbench.page.get_by_text("Whole system: 24 h mode").first.wait_for()
    workbench.tab("Poles")
    workbench.choose("poles of", "channel")
    workbench.page.wait_for_function(_HAS_NO_TRACE, arg="placed growth")
    assert workbench.faults == []
