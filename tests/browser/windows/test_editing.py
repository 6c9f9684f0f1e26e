"""Editing where one looks: handles, number boxes, ranges, units, and TOML that is copied and pasted."""

from __future__ import annotations

import pytest

from app.editing import edits
from tests.browser import test_page_handles as handling
from tests.browser.driver import Bench
from tests.browser.patience import THROTTLE_MS
from tests.browser.placing import placing_scenario
from tests.browser.test_page_typing import _PASTED
from tests.browser.windows.seeing import read, see, speaks

pytestmark = pytest.mark.browser

ZETA = ("method", 2, "network", "zeta")


def placing(window: Bench, tab: str) -> None:
    """A method with a pair that can be placed is in hand, the tab in front, its ring seen."""
    window.put(placing_scenario(), origin=f"handles {window.session.run_number}", selected=1)
    window.show(transfer="phi/dv_r", poles="channel", locus="")
    window.tab(tab)
    window.page.locator(".sb-handle:visible").last.wait_for()
    see(window, window.page.locator(".sb-handle:visible").last)


def test_a_pole_is_dragged(window: Bench) -> None:
    placing(window, "Poles")
    window.page.wait_for_function(handling._AT, arg=[*handling.NEAR, *handling.pole(window)])
    ring = window.page.locator(".sb-handle:visible").last
    speaks(window, ring.get_attribute("aria-label") or "")
    handling.drag(window, window.page.evaluate(handling._SPOT, [*handling.NEAR, -1.0, 1.25]))
    assert handling.pole(window) == pytest.approx((-1.0, 1.25), abs=0.05)
    zeta, r = handling.pair(window)
    assert (window.value("network.zeta"), window.value("network.r")) == pytest.approx((zeta, r))


def test_the_handle_of_the_bode_plot_is_dragged(window: Bench) -> None:
    placing(window, "Frequency")
    ring = window.page.locator(".sb-handle:visible").last
    twice = 2.0 * window.session.scenario.omega_s
    x, _ = window.page.evaluate(handling._SPOT, ["xaxis2", "yaxis3", twice, 1.0])
    handling.drag(window, (x, ring.evaluate(handling._CENTRE)[1] - 15.0))
    zeta, r = handling.pair(window)
    assert r == pytest.approx(2.0, rel=0.04) and zeta < 0.5
    assert (window.value("network.zeta"), window.value("network.r")) == pytest.approx((zeta, r))


def test_wheel_arrow_keys_and_a_double_click_change_a_box(window: Bench) -> None:
    page, session = window.page, window.session
    box = see(window, window.box("network.zeta"))
    before = edits.value_at(session.scenario, ZETA)
    box.focus()
    box.press("ArrowUp")
    window.wait_until(lambda: edits.value_at(session.scenario, ZETA) > before)
    window.settle()
    stepped = edits.value_at(session.scenario, ZETA)
    box.hover()
    page.mouse.wheel(0, -100)
    window.wait_until(lambda: edits.value_at(session.scenario, ZETA) > stepped)
    window.settle()
    assert window.value("network.zeta") == pytest.approx(edits.value_at(session.scenario, ZETA))
    read(window, page.locator(".sb-changed"))
    see(window, page.locator(f"label[for='{window.id('network.zeta')}']")).dblclick()
    window.wait_until(lambda: edits.value_at(session.scenario, ZETA) == before)
    window.settle()


def test_a_range_grows_for_a_value_outside_it(window: Bench) -> None:
    slider = see(window, window.slider("network.zeta"))
    end = float(slider.get_attribute("aria-valuemax") or "nan")
    window.type("network.zeta", f"{1.5 * end:g}")
    window.settle()
    window.wait_until(lambda: float(slider.get_attribute("aria-valuemax") or "nan") >= 1.5 * end)
    assert float(slider.get_attribute("aria-valuenow") or "nan") == pytest.approx(1.5 * end)
    see(window, window.slider("network.zeta"))
    row = window.page.locator(f"[id='{window.id('network.zeta')}']")
    marks = [float(mark) for mark in row.locator(".mantine-Slider-markLabel").all_inner_texts()]
    assert marks[-1] >= 1.5 * end
    for place in range(len(marks)):
        see(window, row.locator(".mantine-Slider-markLabel").nth(place))


@pytest.mark.parametrize(("text", "hours"), [("90 min", 1.5), ("3 kn", None)], ids=["90min", "3kn"])
def test_a_unit_is_typed(window: Bench, text: str, hours: float | None) -> None:
    page, session = window.page, window.session
    window.tab("Run")
    box, before = see(window, window.box("run.duration_h")), session.scenario.run.duration_h
    box.press("Control+a")
    page.keyboard.type(text, delay=THROTTLE_MS)
    line = see(window, page.locator(".sb-unit"))
    assert line.input_value() == text
    speaks(window, line.get_attribute("aria-label") or "")
    line.press("Enter")
    if hours is None:
        window.notice("That did not work")
        read(window, page.locator(".mantine-Notification-root"))
        window.close_notices()
        window.settle()
        return
    window.wait_until(lambda: session.scenario.run.duration_h == hours)
    window.settle()
    assert window.value("run.duration_h") == hours
    assert before != hours


def test_a_method_is_copied_and_pasted(window: Bench) -> None:
    page, names = window.page, [method.name for method in window.session.scenario.method]
    dialog, area = page.locator("dialog.sb-dialog"), page.locator("dialog.sb-dialog textarea")
    see(window, page.get_by_role("button", name=window.said("copy as TOML"), exact=True)).click()
    see(window, area)
    speaks(window, dialog.locator("h2").inner_text())
    text = area.input_value()
    assert text.startswith("[[method]]")
    see(window, dialog.get_by_role("button", name=window.said("Close"))).click()
    dialog.wait_for(state="detached")
    number = window.run
    page.evaluate(_PASTED, text)
    window.wait_for_run(number)
    window.settle()
    pasted = [method.name for method in window.session.scenario.method]
    assert pasted[:3] == names and len(set(pasted)) == 4
    see(window, page.get_by_role("button", name=window.said("paste TOML"), exact=True)).click()
    see(window, area).fill(text.replace("zeta = ", "zeta = -"))
    see(window, dialog.get_by_role("button", name=window.said("Paste"))).click()
    window.notice("That did not work")
    read(window, page.locator(".mantine-Notification-root"))
    window.close_notices()


def test_a_list_of_log_events_is_pasted(window: Bench) -> None:
    window.tab("Log")
    text = "[[reference.event]]\nt_h = 1.0\n\n[[reference.event]]\nt_h = 2.5\n"
    window.page.evaluate(_PASTED, text)
    window.wait_until(lambda: [e.t_h for e in window.session.scenario.reference.event] == [1.0, 2.5])
    window.settle()
    assert see(window, window.box("event 2 begins (h), exact")).input_value() == "2.5"
    see(window, window.page.get_by_role("button", name=window.said("copy as TOML"), exact=True)).click()
    area = see(window, window.page.locator("dialog.sb-dialog textarea"))
    assert "t_h = 2.5" in area.input_value()
    window.page.keyboard.press("Escape")
