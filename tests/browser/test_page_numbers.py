"""Boxes for numbers in Chromium and Firefox: what is given is taken, or refused with the text."""

import math
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from navcore import load
from schuler_bench.dashboard import Dashboard
from schuler_bench.editing.typed import write_number
from schuler_bench.http.server import DashboardServer
from schuler_bench.session.session import Session
from tests.browser.driver import Bench
from tests.browser.fields import box_labels
from tests.browser.firefox import FIREFOX, Firefox
from tests.number_texts import MEANT, NARROW, same

FIELD = "imu.gyro_bias_dph.0"
START = 0.003
TYPED = [
    "-0.02", "\u22120.02", "\u20130.02", "1e-3", "2E-4", "1·10^-3", "1×10⁻³", "0,02", "-0,02", "1.234,5",
    "+5", ".5", "5.", "١٢", "１２．５", "1_000", f"1{NARROW}234,5", '"0.02"', "“0.02”",
]  # fmt: skip
PASTED = [text for text, meant in MEANT.items() if text not in TYPED and abs(meant) < 1e4] + ["2E-4", "0,02"]
SPOILED = ["12abc", "--5", "5-", "(5)", "1,234", "1e", "0x10", "inf", "1e999", "1 2", "p", "5%"]
"""Refused; of letters that are keys of commands, none is one while it is typed."""


@pytest.fixture
def sensors(bench: Bench) -> Iterator[Bench]:
    """Give a short run with its sensors in front."""
    bench.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    scenario = load("zha-fast", ["run.duration_h=0.02", f"imu.gyro_bias_dph=[{START}, 0, 0]"])
    bench.put(scenario, "Sensors", origin=f"numbers {bench.session.run_number}")
    yield bench
    bench.close_notices()


def held(session: Session) -> float:
    return session.scenario.imu.gyro_bias_dph[0]


def give(bench: Bench, how: str, text: str) -> None:
    """Put a text into the box, over all that stands there."""
    page, box = bench.page, bench.box(FIELD)
    box.click()
    page.keyboard.press("Control+A")
    if how == "pasted":
        page.evaluate("text => navigator.clipboard.writeText(text)", text)
        page.keyboard.press("Control+V")
    else:
        page.keyboard.type(text)


@pytest.mark.parametrize("how", ["typed", "pasted"])
def test_what_is_meant_is_taken(sensors: Bench, session: Session, how: str) -> None:
    box = sensors.box(FIELD)
    assert box.get_attribute("inputmode") == "decimal" and box.get_attribute("translate") == "no"
    for text in PASTED if how == "pasted" else TYPED:
        give(sensors, how, text)
        sensors.page.keyboard.press("Enter")
        sensors.wait_until(lambda text=text: same(held(session), MEANT[text]), 10.0)
    sensors.settle()
    assert same(float(box.input_value()), held(session))


@pytest.mark.parametrize("how", ["typed", "pasted"])
def test_anything_else_is_refused_with_the_text(sensors: Bench, session: Session, how: str) -> None:
    box, page = sensors.box(FIELD), sensors.page
    for text in SPOILED[:6] if how == "pasted" else SPOILED:
        give(sensors, how, text)
        page.keyboard.press("Enter")
        notice = sensors.notice("gyro bias x (°/h): rejected")
        assert repr(text) in notice and f"{START} is kept" in notice
        sensors.wait_until(lambda: box.input_value() == str(START), 10.0)
        assert held(session) == START
        sensors.close_notices()


def test_an_empty_box_is_refused_and_escape_gives_the_number_back(sensors: Bench, session: Session) -> None:
    page, box = sensors.page, sensors.box(FIELD)
    box.fill("")
    page.keyboard.press("Tab")
    assert "''" in sensors.notice("gyro bias x (°/h): rejected")
    sensors.close_notices()
    give(sensors, "typed", "12abc")
    page.keyboard.press("Escape")
    assert box.input_value() == str(START)
    sensors.settle()
    assert held(session) == START


def test_a_number_that_is_dropped_is_taken(sensors: Bench, session: Session) -> None:
    page, box = sensors.page, sensors.box(FIELD)
    page.evaluate("""() => {
      const made = document.createElement("span");
      Object.assign(made, { id: "dragged", textContent: "\u22120.04" });
      made.style.cssText = "position:fixed;left:600px;top:300px;z-index:1000;font-size:30px;background:#fff";
      document.body.append(made);
      getSelection().selectAllChildren(made);
    }""")
    try:
        box.evaluate("box => box.value.length && box.setSelectionRange(0, box.value.length)")
        from_, to = page.locator("#dragged").bounding_box(), box.bounding_box()
        box.evaluate("box => (window.schuler.write(box, '0'))")
        page.evaluate("getSelection().selectAllChildren(document.getElementById('dragged'))")
        page.mouse.move(from_["x"] + 20, from_["y"] + 15)
        page.mouse.down()
        page.mouse.move(to["x"] + 30, to["y"] + 12, steps=6)
        page.mouse.move(to["x"] + 2, to["y"] + 12, steps=3)
        page.mouse.up()
        sensors.wait_until(lambda: held(session) in (-0.04, -0.040), 10.0)
    finally:
        page.evaluate("document.getElementById('dragged').remove()")


def test_arrow_keys_and_the_wheel_step(sensors: Bench, session: Session) -> None:
    page, box = sensors.page, sensors.box(FIELD)
    box.click()
    page.keyboard.press("ArrowUp")
    sensors.wait_until(lambda: same(held(session), 0.004), 10.0)
    page.keyboard.press("Shift+ArrowDown")
    sensors.wait_until(lambda: same(held(session), -0.006), 10.0)
    page.mouse.wheel(0, -100)
    sensors.wait_until(lambda: same(held(session), -0.005), 10.0)
    page.keyboard.press("Enter")


def test_what_arrives_leaves_all_of_a_box_selected(sensors: Bench, session: Session) -> None:
    box = sensors.box(FIELD)
    box.click()
    sensors.page.keyboard.press("Control+A")
    with session.lock:
        session.change(load("zha-fast", ["run.duration_h=0.02", "imu.gyro_bias_dph=[0.25, 0, 0]"]), None)
    sensors.wait_until(lambda: box.input_value() == "0.25")
    sensors.wait_until(lambda: box.evaluate("box => box.selectionEnd - box.selectionStart") == 4)
    sensors.page.keyboard.type("-0.02")
    sensors.page.keyboard.press("Enter")
    sensors.wait_until(lambda: same(held(session), -0.02), 10.0)


def test_boxes_that_are_no_fields_read_the_same(sensors: Bench, session: Session) -> None:
    page = sensors.page
    sensors.tab("Study")
    seeds = sensors.box("seeds")
    seeds.fill("1,5")
    assert "'1,5'" in sensors.notice("seeds: rejected")
    sensors.close_notices()
    seeds.fill("500")
    sensors.notice("Not changed")
    sensors.wait_until(lambda: seeds.input_value() == "10")
    seeds.fill("１２")
    sensors.wait_until(lambda: session.display.study_seeds == 12 and seeds.input_value() == "12")
    sensors.close_notices()
    assert page.evaluate("document.querySelectorAll('.mantine-NumberInput-root').length") == page.evaluate(
        "document.querySelectorAll('.mantine-Slider-root ~ .mantine-NumberInput-root').length"
    )


# ---------------------------------------------------------------- Firefox

ENTER, CONTROL = "\ue007", "\ue009"


@pytest.mark.skipif(FIREFOX is None, reason="needs Firefox (apt-get install firefox-esr)")
def test_the_table_in_firefox(dashboard: tuple[DashboardServer, Dashboard], tmp_path: Path) -> None:
    with Firefox(tmp_path, 1600, 950) as firefox:
        firefox.open(f"{dashboard[0].url}?start=no&fixedDpr=1&tab=Sensors")
        run = "Number(document.querySelector('#sb-run')?.dataset.run ?? 0)"
        firefox.wait_for(f"{run} > 0")
        session_id = firefox.evaluate("location.pathname.split('/')[2]")
        session = dashboard[1].sessions.get(session_id)
        with session.lock:
            session.change(
                load("zha-fast", ["run.duration_h=0.02", f"imu.gyro_bias_dph=[{START}, 0, 0]"]), None
            )
        (label,) = box_labels(FIELD)
        box = f"""[...document.querySelectorAll('label')].filter(l => l.textContent === '{label}')
          .map(l => document.getElementById(l.htmlFor))[0]"""
        firefox.wait_for(f"{box}?.value === '{START}'")

        def give(text: str, *, paste: bool) -> None:
            if paste:
                firefox.evaluate(f"""(() => {{
                  const area = document.body.appendChild(document.createElement('textarea'));
                  area.id = 'source'; area.value = {text!r}; area.focus(); area.select(); return 1 }})()""")
                firefox.press("c", CONTROL)
                firefox.evaluate("(document.getElementById('source').remove(), 1)")
            firefox.evaluate(f"({box}.focus(), {box}.select(), 1)")
            if paste:
                firefox.press("v", CONTROL)
            for letter in "" if paste else text:
                firefox.press(letter)
            firefox.press(ENTER)

        def until(holds: Callable[[], Any], text: str) -> None:
            for _ in range(200):
                if holds():
                    return
                firefox.evaluate("new Promise(done => setTimeout(() => done(1), 50))")
            raise AssertionError((text, held(session)))

        def taken(text: str) -> None:
            until(lambda: same(held(session), MEANT[text]), text)
            # a text that is no plain number is written anew: a person sees that before he types on
            until(
                lambda: firefox.evaluate(f"{box}.value") in (write_number(held(session)), plain(text)), text
            )

        def plain(text: str) -> str | None:
            with suppress(ValueError):
                return text if text.isascii() and math.isfinite(float(text)) else None
            return None

        for text in TYPED:
            give(text, paste=False)
            taken(text)
        for text in ("2E-4", "\u22120.02", "0,02", f"1{NARROW}234,5"):
            give(text, paste=True)
            taken(text)
        give(str(START), paste=False)
        until(lambda: held(session) == START, str(START))
        notices = (
            "[...document.querySelectorAll('.mantine-Notification-root')].map(e => e.textContent).join()"
        )
        for text in SPOILED[:5]:
            give(text, paste=False)
            firefox.wait_for(f"{notices}.includes({text!r})")
            firefox.wait_for(f"{box}.value === '{START}'")
            assert held(session) == START
        firefox.screenshot(tmp_path / "numbers.png")
        assert firefox.faults == []
