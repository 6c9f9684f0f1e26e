"""Boxes and sliders understand what is typed and pasted: units, steps, values beyond a range, TOML."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import pytest

from app.editing import edits
from tests.browser.driver import Bench
from tests.browser.patience import THROTTLE_MS

if TYPE_CHECKING:
    from app.session.session import Session

pytestmark = pytest.mark.browser


def test_a_unit_is_typed_a_wheel_steps_and_a_double_click_resets(fresh: Bench, session: Session) -> None:
    page = fresh.page
    fresh.tab("Run")
    before = session.scenario.run.duration_h
    box, number = fresh.box("run.duration_h"), fresh.run
    box.press("Control+a")
    page.keyboard.type("90", delay=THROTTLE_MS)
    page.keyboard.type(" min", delay=THROTTLE_MS)
    page.locator(".sb-unit").press("Enter")
    fresh.wait_until(lambda: session.scenario.run.duration_h == 1.5)
    fresh.wait_for_run(number)
    fresh.settle()
    page.wait_for_function("box => Number(box.value) === 1.5", arg=box.element_handle())
    box.focus()
    box.hover()
    page.mouse.wheel(0, -100)
    fresh.wait_until(lambda: session.scenario.run.duration_h > 1.5)
    fresh.settle()
    box.press("Control+a")
    page.keyboard.type("3 kn", delay=THROTTLE_MS)
    page.locator(".sb-unit").press("Enter")
    assert "one of s, min, h, d" in fresh.notice("That did not work")
    fresh.close_notices()
    page.locator(f"label[for='{fresh.id('run.duration_h')}']").dblclick()
    fresh.wait_until(lambda: session.scenario.run.duration_h == before)
    fresh.settle()
    assert fresh.faults == []


def test_a_slider_grows_for_a_value_outside_its_range_and_goes_back(fresh: Bench, session: Session) -> None:
    sigma = "network.sigma"

    def stands(low: float, high: float, value: float) -> None:
        """The slider has these ends and this value, and its marks say so; the box holds the value."""
        fresh.settle()
        slider = fresh.slider(sigma)
        for name, number in (("min", low), ("max", high), ("now", value)):
            found = float(slider.get_attribute(f"aria-value{name}") or "nan")
            assert found == pytest.approx(math.log10(number), abs=1e-3), (name, found)
        marks = fresh.page.locator(f"[id='{fresh.id(sigma)}'] .mantine-Slider-markLabel").all_inner_texts()
        assert [float(mark) for mark in marks] == [low, high]
        assert fresh.value(sigma) == pytest.approx(value, rel=1e-6)

    stands(5e-4, 0.2, 0.0088)
    fresh.type(sigma, "0.4")
    stands(5e-4, 0.5, 0.4)
    fresh.press(sigma)  # the server takes what lies beyond the old end
    assert 0.4 < session.scenario.method[2].network.values(session.scenario.omega_s)["sigma"] < 0.5
    for value, low in ((0.0088, 5e-4), (4e-5, 2e-5)):
        fresh.put(edits.with_value(session.scenario, ("method", 2, "network", "sigma"), value), selected=2)
        stands(low, 0.2, value)
    assert fresh.faults == []


_PASTED = """text => {
  const clipboardData = new DataTransfer();
  clipboardData.setData('text/plain', text);
  document.activeElement?.blur();
  document.body.dispatchEvent(new ClipboardEvent('paste', {clipboardData, bubbles: true, cancelable: true}));
}"""


def test_a_method_and_the_logs_events_are_copied_and_pasted_as_toml(fresh: Bench, session: Session) -> None:
    page, names = fresh.page, [method.name for method in session.scenario.method]
    dialog, area = page.locator("dialog.sb-dialog"), page.locator("dialog.sb-dialog textarea")

    def copied(copy: str) -> str:
        """What a button of the tab in front copies."""
        page.get_by_role("button", name=copy, exact=True).click()
        area.wait_for()
        text = area.input_value()
        dialog.get_by_role("button", name="Close").click()
        dialog.wait_for(state="detached")
        return text

    text = copied("copy as TOML")
    assert text.startswith("[[method]]") and 'id = "compass"' in text
    number = fresh.run
    page.evaluate(_PASTED, text)  # anywhere on the page
    fresh.wait_for_run(number)
    fresh.settle()
    added = session.scenario.method[3]
    assert [method.name for method in session.scenario.method] == [*names, added.name]
    assert added.network == session.scenario.method[2].network and session.selected == 3
    page.get_by_role("button", name="paste TOML", exact=True).click()
    area.fill(text.replace("xi = 0.7", "xi = 70.0"))
    dialog.get_by_role("button", name="Paste").click()
    notice = fresh.notice("That did not work")
    assert "method.4.network.xi" in notice and "70" in notice and "must be" in notice
    session.undo()  # one step
    fresh.catch_up()
    assert [method.name for method in session.scenario.method] == names

    fresh.tab("Log")
    text = "[[reference.event]]\nt_h = 1.0\n\n[[reference.event]]\nt_h = 2.5\n"
    page.evaluate(_PASTED, text)
    fresh.wait_until(lambda: [event.t_h for event in session.scenario.reference.event] == [1.0, 2.5])
    fresh.settle()
    assert fresh.value("event 2 begins (h), exact") == 2.5
    assert "t_h = 2.5" in copied("copy as TOML")
    assert fresh.faults == []
