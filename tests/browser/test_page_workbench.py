"""The frequency workbench: Nyquist, measured dots, locus, placing a pair, the whole system, limits."""

import math
import re
from typing import Any

import numpy as np
import pytest

from navcore.analysis import analyse
from navcore.analysis.whole_system import growth_over_latitude
from navcore.foundation.units import DEG
from navcore.scenario.model import Scenario
from schuler_bench.editing.limits import with_limit
from schuler_bench.plots.effective import earth_mode_text
from schuler_bench.views.frequency.nyquist import margins_of
from schuler_bench.views.poles.whole import LATITUDES
from tests.browser.driver import SIZES, Bench
from tests.browser.fields import label_of
from tests.browser.placing import NEAR, place, placing_scenario, spot
from tests.browser.windows.test_results import ask, box, cells, wait_for

FREE = {"name": "free"}


@pytest.fixture
def workbench(bench: Bench) -> Bench:
    """The shared page on a scenario of its own; its second method selected."""
    place(bench, "Frequency", FREE)
    return bench


def poles_of(bench: Bench, index: int) -> np.ndarray:
    scenario = bench.session.scenario
    return analyse(scenario.method[index].network.transfer(scenario.omega_s)).poles / scenario.omega_s


def trace(bench: Bench, name: str, place: int = 0) -> dict[str, Any]:
    bench.page.wait_for_function("look.hasTrace", arg=name)
    return [t for t in bench.plotly() if t["name"] == name][place]


def test_the_chooser_shows_nyquist_with_margins(workbench: Bench) -> None:
    workbench.choose("transfer", "open loop: Nyquist plot and margins")
    phase = margins_of(workbench.session.run.methods[1]).phase_rad
    dot = trace(workbench, "placed margin", 2)
    assert np.hypot(dot["x"][0], dot["y"][0]) == pytest.approx(1.0)
    assert np.angle(-complex(dot["x"][0], dot["y"][0])) == pytest.approx(phase, rel=1e-6)
    words = " ".join(workbench.page.locator(".annotation-text").all_text_contents())
    assert f"placed: phase {math.degrees(phase):.3g}°" in words
    assert "free: no margin: undamped" in words
    # a second method's slider moves the margin
    workbench.press("network.zeta")
    assert trace(workbench, "placed margin", 2)["x"] != dot["x"]
    number = workbench.run
    workbench.choose("transfer", "tilt from log error")
    workbench.page.wait_for_function("look.hasNoTrace", arg="placed margin")
    assert workbench.run == number


def test_measured_filter_lies_on_h(workbench: Bench) -> None:
    switch = workbench.page.locator(f"[id='{workbench.id('measured filter')}']")
    switch.click()
    dots, curve = trace(workbench, "placed measured"), trace(workbench, "placed")
    on_curve = np.interp(np.log(dots["x"]), np.log(curve["x"]), curve["y"])
    assert len(dots["x"]) >= 10
    assert np.max(np.abs(np.array(dots["y"]) - on_curve)) < 0.05
    assert workbench.session.display.discrete
    workbench.settle()
    switch.click()
    workbench.page.wait_for_function("look.hasNoTrace", arg="placed measured")


def test_locus_over_each_parameter_of_the_selected_network(workbench: Bench) -> None:
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
    workbench.page.wait_for_function("look.hasNoTrace", arg="placed locus")
    assert workbench.box("locus").input_value() == "nothing"


def test_a_click_into_the_pole_map_places_the_pair_in_one_step(workbench: Bench) -> None:
    mouse = workbench.page.mouse
    workbench.tab("Poles")
    trace(workbench, "placed")
    before, (x, y), wanted = workbench.session.scenario, spot(workbench, *NEAR, -1.0, 1.25), -1.0 + 1.25j
    with workbench.next_run():
        mouse.click(x, y)
    assert "pair at" in workbench.notice("Placed")
    assert np.abs(poles_of(workbench, 1) - wanted).min() < 0.03
    made = workbench.session.scenario
    assert (made.method[0], made.method[2]) == (before.method[0], before.method[2])
    shown = trace(workbench, "placed", 1)
    assert np.min(np.abs(np.array(shown["x"]) + 1j * np.array(shown["y"]) - wanted)) < 0.03
    # one step back is the scenario as it was
    with workbench.next_run():
        workbench.page.keyboard.press("Control+z")
    assert workbench.session.scenario == before
    # a drag zooms and places nothing
    mouse.move(x, y)
    mouse.down()
    mouse.move(x + 60, y + 60, steps=4)
    mouse.up()
    workbench.page.wait_for_timeout(600)  # a click is told so late, for it may become a double click
    workbench.settle()
    mouse.dblclick(x, y)
    workbench.page.wait_for_timeout(600)
    workbench.settle()
    assert workbench.session.scenario == before


def test_what_cannot_be_placed_is_said(workbench: Bench) -> None:
    workbench.tab("Poles")
    trace(workbench, "placed")
    before = workbench.session.scenario
    workbench.page.mouse.click(*spot(workbench, *NEAR, 0.2, 1.0))
    assert "nearest possible" in workbench.notice("The pair was not placed")
    workbench.close_notices()
    workbench.select(0)
    workbench.button("Place").click()
    assert "no parameter" in workbench.notice("The pair was not placed")
    assert workbench.session.scenario == before


def test_margin_of_a_law_over_time_stands_in_the_switching_view(workbench: Bench) -> None:
    data = placing_scenario(FREE).canonical()
    data["method"][1]["policy"] = {"id": "adaptive"}
    workbench.put(Scenario.parse(data), "Switching", selected=1)
    workbench.page.wait_for_function("look.hasLabel", arg="least ζ")
    charts = {chart["label"]: chart["data"] for chart in workbench.curves()}
    margin, xi = charts["least ζ (–)"], charts["ζ (–)"]
    # unity2 has the damping ratio that its coefficient says
    assert margin[1] == pytest.approx(xi[1], rel=1e-3)
    assert margin[0] == xi[0]


def test_the_view_comes_with_the_first_policy_and_goes_with_the_last(moving: Bench) -> None:
    tab = moving.tab_of("Switching")
    mode = moving.page.locator(".sb-modes").get_by_role("radio", name="Switching", exact=True)
    assert tab.count() == mode.count() == 0
    moving.choose_and_run("policy", "threshold")
    mode.click()
    moving.page.get_by_text("wanted state", exact=True).wait_for()
    moving.choose("curve above", "Position error")
    moving.page.wait_for_function("look.hasLabel", arg="position")
    moving.choose_and_run("policy", "constant")
    tab.wait_for(state="detached")
    # another tab has come to the front
    moving.wait_for_front("Errors")
    assert mode.count() == 0


# ------------------------------------------------------------ the whole system


@pytest.fixture
def whole(bench: Bench) -> Bench:
    """The shared page with a network that can be placed, under way; the tab Poles in front."""
    bench.reset("sikuliaq-like")
    data = bench.session.scenario.canonical()
    data["method"][1]["network"] = {"id": "unity2", "zeta": 0.5, "zeta2": 0.3}
    bench.put(Scenario.parse(data), "Poles", "Method", selected=1)
    bench.box("pair ζ").wait_for()
    return bench


@pytest.mark.slow
def test_modes_growth_and_the_line_under_the_network_are_the_engines(whole: Bench) -> None:
    whole.choose("poles of", "system")
    whole.page.wait_for_selector(".gtitle, .annotation-text:has-text('Growth of the 24 h mode')")
    run = whole.session.run
    traces, scenario = {trace["name"]: trace for trace in whole.plotly()}, run.scenario
    for method in run.methods[1:]:
        name = method.method.name
        rates = growth_over_latitude(
            method.method.kind.acting(method.network), LATITUDES * DEG, scenario.earth
        )
        assert traces[f"{name} growth"]["y"] == pytest.approx((rates * 86400.0).tolist(), rel=1e-6, abs=1e-9)
        (here,) = traces[f"{name} at the site"]["y"]
        assert here == pytest.approx(method.whole.earth_growth * 86400.0, rel=1e-6)
        assert len(traces[f"{name} 24 h"]["x"]) == len(method.whole.named("24 h")) >= 1
    told = earth_mode_text(run.methods[1].whole.earth_growth)
    line = f"Whole system: 24 h mode {told} at {abs(scenario.site.lat_deg):.3g}°."
    whole.page.get_by_text(line).first.wait_for()
    for size in reversed(SIZES):
        whole.resize(size)
        whole.tab("Poles")
        whole.page.wait_for_function("() => look.plotsCut().length > 0")
        assert all(right <= 0 and below <= 0 for right, below in whole.page.evaluate("look.plotsCut")), size
    whole.choose("poles of", "channel")
    whole.page.wait_for_function("look.hasNoTrace", arg=f"{scenario.method[1].name} growth")


def test_a_typed_pair_that_lets_the_24_h_mode_grow_is_not_placed_when_it_must_not(whole: Bench) -> None:
    session, frequency = whole.session, whole.box("pair ω/ωₛ")
    before = session.scenario
    whole.box("H'(0) ≤ 0").click()
    frequency.fill("1.2")
    whole.button("Place").click()
    told = whole.notice("The pair was not placed")
    assert "H'(0)" in told and "the 24 h mode grows" in told and "unity2 with a pair below ωₛ" in told
    assert session.scenario == with_limit(before, "h_slope_s", "0")
    whole.close_notices()
    with whole.next_run():
        frequency.fill("0.8")
        whole.box("pair ζ").fill("0.35")
        whole.button("Place").click()
    assert session.run.methods[1].whole.earth_growth < 0.0
    assert np.abs(poles_of(whole, 1) - 0.8 * (-0.35 + 1j * np.sqrt(1 - 0.35**2))).min() < 1e-6
    network = session.scenario.method[1].network.model_dump()
    assert (network["zeta"], network["r"]) == pytest.approx((0.35, 0.8))
    # one limit: the tab Requirements has it too, and emptied there it is gone here
    whole.tab("Requirements")
    limit = box(whole, "H'(0) ≤ (s)")
    assert limit.input_value() == "0"
    ask(whole, "H'(0) ≤ (s)", "")
    ticked = "id => !document.getElementById(id).checked"
    whole.page.wait_for_function(ticked, arg=whole.id("H'(0) ≤ 0"))


# ------------------------------------------------------------ limits


@pytest.fixture
def asked(bench: Bench) -> Bench:
    """The shared page with no requirement, the tab in front."""
    bench.reset("sikuliaq-like", "Requirements", selected=2)
    wait_for(bench, "settling_s", ["", "", ""])
    return bench


def test_limits_are_drawn_as_regions_and_lines_and_each_run_is_judged_anew(asked: Bench) -> None:
    for label, text in (
        ("settling ≤ (min)", "90"),
        ("tilt overshoot ≤ (%)", "30"),
        ("damping ratio ≥", "0.6"),
        ("tilt after log step ≤ (arcsec)", "10"),
        ("largest tilt of this run ≤ (arcsec)", "12"),
    ):
        ask(asked, label, text)
    wait_for(asked, "damping_ratio", ["missed", "met", "missed"])
    table = asked.page.locator(".sb-verdicts").inner_text()
    assert re.findall(r"✗ misses \d of \d", table) and "✗ missed" in table
    before = cells(asked, "tilt_overshoot")[2][0]
    asked.press("network.zeta")
    judged = "old => Math.abs(look.cells().filter(c => c[0] === 'tilt_overshoot')[2][1] - old) > 1e-6"
    asked.page.wait_for_function(judged, arg=before)
    asked.tab("Step")
    asked.page.wait_for_function("() => look.shapes().some(s => s[0] === 'overshoot')")
    shapes = asked.page.evaluate("look.shapes")
    assert ["overshoot", "x", 0, -0.3, None] in shapes
    assert {x0 for name, _, x0, _, _ in shapes if name == "settling"} == {90}
    asked.tab("Errors")
    asked.page.wait_for_function("() => look.limits().length >= 1")
    drawn = dict(asked.page.evaluate("look.limits"))
    assert {label.split()[0]: found for label, found in drawn.items()} == {"|φ|": [pytest.approx(12.0)]}
    drag_the_limit(asked)
    # and gone with the limit
    asked.tab("Requirements")
    ask(asked, "tilt overshoot ≤ (%)", "")
    asked.page.wait_for_function("() => !look.shapes().some(s => s[0] === 'overshoot')")


def drag_the_limit(asked: Bench) -> None:
    """Drag the line of the limit on the tilt: it sets the limit, and the plots stay alike in height."""
    page, mouse = asked.page, asked.page.mouse
    line, number = page.locator(".sb-limit-line:visible").first, asked.session.run_number
    box: Any = line.bounding_box()
    x, y = box["x"] + 0.3 * box["width"], box["y"] + 0.5 * box["height"]
    mouse.move(x, y)
    mouse.down()
    for down in (2, 4, 6, 8):
        mouse.move(x, y + down)
    said = line.inner_text()
    assert asked.session.run_number == number, "a limit is set where it is let go"
    mouse.up()
    of_tilt = lambda: [r.limit for r in asked.session.scenario.requirement if "tilt_max" in r.quantity]  # noqa: E731
    asked.wait_until(lambda: of_tilt() != [12.0])
    (limit,) = of_tilt()
    assert said == f"{limit:g} arcsec" and limit < 12.0
    asked.catch_up()
    page.wait_for_function("v => look.limits()[0][1][0] === Math.fround(v)", arg=limit, timeout=9e3)
    areas = "() => [...document.querySelectorAll('.uplot .u-over')].map(o => o.clientHeight).filter(h => h)"
    page.wait_for_function(
        f"() => {{ const a = ({areas})(); return Math.max(...a) - Math.min(...a) <= 1; }}", timeout=9e3
    )


def test_bad_input_is_refused_beside_the_boxes_and_the_old_limit_kept(asked: Bench) -> None:
    ask(asked, "settling ≤ (min)", "90")
    for text in ("soon", "-5", "1e9"):
        ask(asked, "settling ≤ (min)", text)
        note = (
            asked.page.locator(".sb-note:visible").filter(has_text="settling ≤ (min)").filter(has_text=text)
        )
        told = note.inner_text()
        assert "was refused" in told and "must be" in told and "90 is kept" in told
        asked.wait_until(lambda: box(asked, "settling ≤ (min)").input_value() == "90", 5.0)
        assert asked.page.evaluate("() => document.activeElement.dataset.limit") == "settling_s"
        assert [one.limit for one in asked.session.scenario.requirement] == [5400.0]
