"""A pair is taken by its ring in a plot and placed, by mouse and by keys; one step of undo each."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from navcore.analysis import analyse
from navcore.scenario.model import Scenario
from tests.browser.driver import Bench
from tests.browser.placing import placing_scenario

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.browser

# Where a place of a panel lies in the window, CSS px; null before there is a figure with a handle.
_SPOT = """([across, up, x, y]) => {
  const plot = [...document.querySelectorAll('.js-plotly-plot')].find(
    p => p.offsetParent !== null && p._fullLayout?.meta?.handle);
  if (!plot) return null;
  const [xaxis, yaxis] = [plot._fullLayout[across], plot._fullLayout[up]];
  const frame = plot.getBoundingClientRect();
  return [frame.left + xaxis._offset + xaxis.d2p(x), frame.top + yaxis._offset + yaxis.d2p(y)];
}"""
_CENTRE = """ring => {
  const box = ring.getBoundingClientRect();
  return [box.left + box.width / 2, box.top + box.height / 2];
}"""
# The last ring in view stands at a place.
_AT = f"""place => {{
  const spot = ({_SPOT})(place);
  const rings = [...document.querySelectorAll('.sb-handle')].filter(r => r.offsetParent && !r.hidden);
  if (spot === null || rings.length === 0) return false;
  const at = ({_CENTRE})(rings.at(-1));
  return Math.hypot(at[0] - spot[0], at[1] - spot[1]) < 2;
}}"""
_AWAY = "() => [...document.querySelectorAll('.sb-handle')].every(r => !r.offsetParent)"
NEAR = ("xaxis2", "yaxis2")


@pytest.fixture
def handles(bench: Bench) -> Bench:
    """The shared page on a scenario of its own; its second method in hand."""
    bench.put(placing_scenario(), origin=f"handles {bench.session.run_number}", selected=1)
    bench.show(transfer="phi/dv_r", poles="channel", locus="")
    return bench


def pair(bench: Bench) -> tuple[float, float]:
    network = bench.session.scenario.method[1].network.model_dump()
    return network["zeta"], network["r"]


def pole(bench: Bench) -> tuple[float, float]:
    zeta, r = pair(bench)
    return -zeta * r, r * np.sqrt(1.0 - zeta**2)


def drag(bench: Bench, to: tuple[float, float]) -> None:
    """Take the last ring in view to a place in the window."""
    mouse = bench.page.mouse
    x, y = bench.page.locator(".sb-handle:visible").last.evaluate(_CENTRE)
    mouse.move(x, y)
    mouse.down()
    for part in (0.3, 0.6, 1.0):
        mouse.move(x + part * (to[0] - x), y + part * (to[1] - y))
    mouse.up()
    bench.settle()


def undone(bench: Bench, before: Scenario) -> None:
    """One step back is the scenario as it was, on the page too."""
    number = bench.run
    bench.page.keyboard.press("Control+z")
    bench.wait_for_run(number)
    bench.settle()
    assert bench.session.scenario == before
    assert bench.value("network.zeta") == pytest.approx(0.5)


def test_a_dragged_pole_moves_sliders_and_run_and_is_one_step(handles: Bench) -> None:
    handles.tab("Method", "Poles")
    handles.page.wait_for_function(_AT, arg=[*NEAR, *pole(handles)])
    before, number = handles.session.scenario, handles.run
    drag(handles, handles.page.evaluate(_SPOT, [*NEAR, -1.0, 1.25]))
    assert handles.run > number
    zeta, r = pair(handles)
    assert pole(handles) == pytest.approx((-1.0, 1.25), abs=0.03)
    made = handles.session.scenario
    poles = analyse(made.method[1].network.transfer(made.omega_s)).poles / made.omega_s
    assert np.abs(poles - complex(*pole(handles))).min() < 1e-6
    assert (handles.value("network.zeta"), handles.value("network.r")) == pytest.approx((zeta, r))
    assert handles.session.run is not None
    assert handles.session.run.scenario.method[1] == made.method[1]
    handles.page.wait_for_function(_AT, arg=[*NEAR, *pole(handles)])
    undone(handles, before)
    handles.page.wait_for_function(_AT, arg=[*NEAR, *pole(handles)])
    assert handles.faults == []


def test_a_pole_is_moved_by_keys_and_stops_at_its_range(handles: Bench) -> None:
    handles.tab("Method", "Poles")
    handles.page.wait_for_function(_AT, arg=[*NEAR, *pole(handles)])
    before, (re, im) = handles.session.scenario, pole(handles)
    ring = handles.page.locator(".sb-handle:visible").last
    assert "damping ratio 0.5, frequency 1.2" in (ring.get_attribute("aria-label") or "")
    ring.press("ArrowLeft")
    handles.settle()
    moved = pole(handles)
    assert moved[0] < re
    assert moved[1] == pytest.approx(im, abs=0.002)
    undone(handles, before)
    # into the right half plane: the least damping that can be placed, and a word about the range
    drag(handles, handles.page.evaluate(_SPOT, [*NEAR, 0.2, 1.25]))
    assert pair(handles)[0] == 0.01
    assert "the parameters allow ζ = 0.01…1" in handles.notice("Placed in part")
    undone(handles, before)
    assert handles.faults == []


def test_the_handle_of_the_bode_plot_is_frequency_across_and_damping_up(handles: Bench) -> None:
    handles.tab("Method", "Frequency")
    ring = handles.page.locator(".sb-handle:visible").last
    ring.wait_for()
    before = handles.session.scenario
    x, _ = handles.page.evaluate(_SPOT, ["xaxis2", "yaxis3", 2.0 * before.omega_s, 1.0])
    start = ring.evaluate(_CENTRE)
    drag(handles, (x, start[1] - 20.0))
    zeta, r = pair(handles)
    assert r == pytest.approx(2.0, rel=0.02)
    assert zeta < 0.45
    assert (handles.value("network.zeta"), handles.value("network.r")) == pytest.approx((zeta, r))
    assert handles.session.run is not None
    assert handles.session.run.scenario == handles.session.scenario
    undone(handles, before)
    ring.press("ArrowDown")
    ring.press("ArrowDown")
    handles.settle()
    damped = pair(handles)
    assert damped[0] > 0.5
    assert damped[1] == pytest.approx(1.2, rel=1e-3)
    handles.page.wait_for_function(
        """said => [...document.querySelectorAll('.sb-handle')].some(
            r => r.offsetParent && r.ariaLabel.includes(said))""",
        arg=f"damping ratio {damped[0]:.3g}",
    )
    handles.choose("transfer", "open loop: Nyquist plot and margins")
    handles.page.wait_for_function(_AWAY)
    assert handles.faults == []


def test_a_network_that_cannot_be_placed_says_why_in_the_plot(handles: Bench) -> None:
    handles.tab("Poles")
    handles.page.wait_for_function(_AT, arg=[*NEAR, *pole(handles)])
    handles.select(0)
    handles.page.get_by_text("No handle for fixed: its coefficients are fixed.").locator(
        "visible=true"
    ).wait_for()
    assert handles.page.locator(".sb-handle:visible").count() == 0
    handles.select(1)
    handles.page.wait_for_function(_AT, arg=[*NEAR, *pole(handles)])


def test_a_page_that_watches_has_no_handle(handles: Bench, browser: Browser) -> None:
    handles.tab("Poles")
    context = browser.new_context(viewport=handles.page.viewport_size)  # it follows the presenter's tabs
    try:
        other = Bench(context.new_page(), handles.url, handles.sessions)
        other.open(f"s/{handles.session_id}/")
        other.tab("Poles")
        other.page.wait_for_function(_AT, arg=[*NEAR, *pole(handles)])
        present = handles.page.get_by_role("button", name="Present", exact=True)
        present.click()
        other.page.get_by_text("Another page presents: you watch").wait_for()
        other.page.wait_for_function(_AWAY)
        assert other.page.locator(".js-plotly-plot:visible").count() > 0
        handles.page.wait_for_function(_AT, arg=[*NEAR, *pole(handles)])  # who drives keeps it
        present.click()
        other.page.get_by_text("Another page presents: you watch").wait_for(state="hidden")
        other.page.wait_for_function(_AT, arg=[*NEAR, *pole(handles)])
        assert other.faults == handles.faults == []
    finally:
        context.close()
