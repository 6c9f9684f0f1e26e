"""Editing where one looks: handles, number boxes, ranges, units, and TOML that is copied and pasted."""

import math
import re
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Locator

from navcore.analysis import analyse
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.editing import edits
from schuler_bench.shell.control import EXACT
from tests.browser.driver import SIZES, Bench
from tests.browser.patience import THROTTLE_MS
from tests.browser.placing import NEAR, centre, drag, pair, place, pole, ring_at, spot
from tests.browser.windows.seeing import read, see, speaks

ZETA = ("method", 2, "network", "zeta")


def undone(window: Bench, before: Scenario) -> None:
    """One step back is the scenario as it was, on the page too."""
    with window.next_run():
        window.page.keyboard.press("Control+z")
    assert window.session.scenario == before
    assert window.value("network.zeta") == pytest.approx(0.5)


def shown_pair(window: Bench) -> tuple[float, float]:
    """The pair placed, which is the one of the boxes and of the run."""
    assert (window.value("network.zeta"), window.value("network.r")) == pytest.approx(pair(window))
    assert window.session.run.scenario == window.session.scenario
    return pair(window)


def test_a_pole_is_dragged(window: Bench) -> None:
    place(window, "Poles")
    ring_at(window)
    before, (re_, im) = window.session.scenario, pole(window)
    ring = see(window, window.page.locator(".sb-handle:visible").last)
    name = ring.get_attribute("aria-label") or ""
    speaks(window, name)
    assert re.findall(r"\d\.\d+", name)[:2] == ["0.5", "1.2"]
    drag(window, spot(window, *NEAR, -1.0, 1.25))
    assert pole(window) == pytest.approx((-1.0, 1.25), abs=0.03 if window.size == SIZES[0] else 0.05)
    shown_pair(window)
    made = window.session.scenario
    poles = analyse(made.method[1].network.transfer(made.omega_s)).poles / made.omega_s
    assert np.abs(poles - complex(*pole(window))).min() < 1e-6
    ring_at(window)
    undone(window, before)
    ring_at(window)
    ring.press("ArrowLeft")
    window.settle()
    assert pole(window)[0] < re_ and pole(window)[1] == pytest.approx(im, abs=0.002)
    undone(window, before)
    # into the right half plane: the least damping that can be placed, and a word about the range
    drag(window, spot(window, *NEAR, 0.2, 1.25))
    assert pair(window)[0] == 0.01
    assert "ζ = 0.01…1" in window.notice("Placed in part")
    undone(window, before)
    window.close_notices()
    window.select(0)
    reason = Text("its coefficients are fixed")
    why = Text("No handle for {name}: {reason}.", name="fixed", reason=reason)
    window.page.get_by_text(window.said(why)).locator("visible=true").wait_for()
    assert window.page.locator(".sb-handle:visible").count() == 0


def test_the_handle_of_the_bode_plot_is_dragged(window: Bench) -> None:
    place(window, "Frequency")
    ring = see(window, window.page.locator(".sb-handle:visible").last)
    before = window.session.scenario
    x, _ = spot(window, "xaxis2", "yaxis3", 2.0 * before.omega_s, 1.0)
    drag(window, (x, centre(window)[1] - (20.0 if window.size == SIZES[0] else 15.0)))
    zeta, r = shown_pair(window)
    assert r == pytest.approx(2.0, rel=0.02 if window.size == SIZES[0] else 0.04)
    assert zeta < (0.45 if window.size == SIZES[0] else 0.5)
    undone(window, before)
    for _ in range(2):
        ring.press("ArrowDown")
    window.settle()
    assert pair(window)[0] > 0.5 and pair(window)[1] == pytest.approx(1.2, rel=1e-3)
    window.page.wait_for_function(
        """said => [...document.querySelectorAll('.sb-handle')]
          .some(ring => ring.offsetParent && ring.ariaLabel.includes(said))""",
        arg=f"{pair(window)[0]:.3g}",
    )
    window.choose("transfer", "open loop: Nyquist plot and margins")
    window.page.wait_for_function("look.away")


def test_wheel_arrow_keys_and_a_double_click_change_a_box(window: Bench) -> None:
    box = see(window, window.box("network.zeta"))

    def zeta() -> Any:
        return edits.value_at(window.session.scenario, ZETA)

    before = zeta()
    box.focus()
    box.press("ArrowUp")
    window.wait_until(lambda: zeta() > before)
    window.settle()
    stepped = zeta()
    box.hover()
    window.page.mouse.wheel(0, -100)
    window.wait_until(lambda: zeta() > stepped)
    window.settle()
    assert window.value("network.zeta") == pytest.approx(zeta())
    read(window, window.page.locator(".sb-changed"))
    see(window, window.page.locator(f"label[for='{window.id('network.zeta')}']")).dblclick()
    window.wait_until(lambda: zeta() == before)
    window.settle()


def test_a_range_grows_for_a_value_outside_it(window: Bench) -> None:
    session, sigma = window.session, "network.sigma"
    window.reset("zha-fast", "Method", selected=2)

    def stands(low: float, high: float, value: float) -> None:
        """The slider has these ends and this value, and its marks say so; the box holds the value."""
        window.settle()
        slider, row = see(window, window.slider(sigma)), window.page.locator(f"[id='{window.id(sigma)}']")
        ends = [float(slider.get_attribute(f"aria-value{name}") or "nan") for name in ("min", "max", "now")]
        assert ends == pytest.approx([math.log10(number) for number in (low, high, value)], abs=1e-3)
        marks = row.locator(".mantine-Slider-markLabel")
        assert [float(mark) for mark in marks.all_inner_texts()] == [low, high]
        for number in range(2):
            see(window, marks.nth(number))
        assert window.value(sigma) == pytest.approx(value, rel=1e-6)

    stands(5e-4, 0.2, 0.0088)
    window.type(sigma, "0.4")
    stands(5e-4, 0.5, 0.4)
    window.press(sigma)  # the server takes what lies beyond the old end
    assert 0.4 < session.scenario.method[2].network.values(session.scenario.omega_s)["sigma"] < 0.5
    for value, low in ((0.0088, 5e-4), (4e-5, 2e-5)):
        window.put(edits.with_value(session.scenario, ("method", 2, "network", "sigma"), value), selected=2)
        stands(low, 0.2, value)


@pytest.mark.parametrize(("text", "hours"), [("90 min", 1.5), ("3 kn", None)], ids=["90min", "3kn"])
def test_a_unit_is_typed(window: Bench, text: str, hours: float | None) -> None:
    page, session = window.page, window.session
    window.tab("Run")
    box, before = see(window, window.box("run.duration_h")), session.scenario.run.duration_h
    box.press("Control+a")
    page.keyboard.type(text, delay=THROTTLE_MS)
    assert box.input_value() == text
    box.press("Enter")
    if hours is None:
        notice = page.locator(".mantine-Notification-root").filter(has_text="s, min, h, d").first
        notice.wait_for()
        read(window, notice)
        window.close_notices()
        assert window.value("run.duration_h") == before
    else:
        window.wait_until(lambda: session.scenario.run.duration_h == hours)
        window.settle()
        assert window.value("run.duration_h") == hours
        page.locator(f"label[for='{window.id('run.duration_h')}']").dblclick()
        window.wait_until(lambda: session.scenario.run.duration_h == before)
    window.settle()


def copied(window: Bench, button: Locator) -> str:
    """What a button copies."""
    dialog = window.page.locator("dialog.sb-dialog")
    see(window, button).click()
    text = see(window, dialog.locator("textarea")).input_value()
    speaks(window, dialog.locator("h2").inner_text())
    see(window, dialog.get_by_role("button", name=window.said("Close"))).click()
    dialog.wait_for(state="detached")
    return text


def test_a_method_is_copied_and_pasted(window: Bench) -> None:
    page, session = window.page, window.session
    names, dialog = [method.name for method in session.scenario.method], page.locator("dialog.sb-dialog")
    text = copied(window, window.menu("copy as TOML"))
    assert text.startswith("[[method]]") and 'id = "complementary"' in text
    with window.next_run():
        page.evaluate("look.pasted", text)  # anywhere on the page
    *pasted, added = session.scenario.method
    assert [method.name for method in pasted] == names and added.name not in names
    assert added.network == session.scenario.method[2].network and session.selected == 3
    see(window, window.menu("paste TOML")).click()
    see(window, dialog.locator("textarea")).fill(text.replace("zeta = ", "zeta = -"))
    see(window, dialog.get_by_role("button", name=window.said("Paste"))).click()
    assert "method.4.network.zeta" in window.notice("That did not work")
    read(window, page.locator(".mantine-Notification-root"))
    window.close_notices()
    session.undo()  # one step
    window.catch_up()
    assert [method.name for method in session.scenario.method] == names


def test_a_list_of_log_events_is_pasted(window: Bench) -> None:
    window.tab("Log")
    window.page.evaluate("look.pasted", "[[reference.event]]\nt_h = 1.0\n\n[[reference.event]]\nt_h = 2.5\n")
    window.wait_until(lambda: [e.t_h for e in window.session.scenario.reference.event] == [1.0, 2.5])
    window.settle()
    parts = Text("{name} {i}", name="event", i=2), "begins", Text("({sign})", sign="h")
    begins = Text.joined(" ", parts) + EXACT
    assert see(window, window.box(begins)).input_value() == "2.5"
    assert "t_h = 2.5" in copied(window, window.button("copy as TOML"))
