"""What a user keeps the dashboard open for, in three windows and two languages, by what is seen there."""

from __future__ import annotations

import re
from typing import Any

import pytest

from app.editing import edits
from app.session.requirements import Requirements
from app.views.learn.lessons import lessons
from navcore.engine.simulation import simulate
from tests.answers import right_answer
from tests.browser import test_page_lessons as learning
from tests.browser import test_page_playback as playing
from tests.browser.driver import Bench
from tests.browser.test_page_compare import _UPLOT_NAMES
from tests.browser.test_page_requirements import ask, wait_for
from tests.browser.test_page_state import away_from_text, button, palette, wait_for_value

pytestmark = pytest.mark.browser

ZETA = ("method", 2, "network", "zeta")
DIFFERENCE = re.compile("Δ.*ζ")
"""Of this run and the pin, in the head of the table."""
_WITHIN = """selector => {
  const found = [...document.querySelectorAll(selector)];
  const boxes = found.map(e => e.getBoundingClientRect()).filter(b => b.width > 0);
  return boxes.length > 0 && boxes.every(b => b.left >= -1 && b.right <= innerWidth + 1 && b.top >= -1);
}"""
_SHOWS = """([label, number]) => Object.values(window.__viserTestpoints?.uplots ?? {})
  .some(({chart}) => chart.axes[1].label.startsWith(label) && chart.series.length > number)"""


def within(bench: Bench, selector: str) -> None:
    """Wait until what the selector finds lies in the window, cut at neither side."""
    bench.page.wait_for_function(_WITHIN, arg=selector)


def test_why_and_the_pendulum(window: Bench) -> None:
    window.tab("Metrics")
    window.page.wait_for_selector("#sb-why[data-fits='1']")
    why = window.page.locator("#sb-why")
    why.scroll_into_view_if_needed()
    assert "complementary" in why.inner_text()
    within(window, "#sb-why")
    within(window, "#sb-stage .sb-pendulum svg")


def test_a_run_is_pinned_compared_and_flipped(window: Bench) -> None:
    window.tab("Compare")
    button(window, "Pin this run").click()
    try:
        window.press("network.zeta")
        window.tab("Errors")
        window.page.wait_for_function(_SHOWS, arg=[window.said("position"), 4])
        away_from_text(window)
        window.page.keyboard.press("b")
        window.page.wait_for_selector("#sb-flip", state="attached")
        window.page.keyboard.press("b")
        window.page.wait_for_selector("#sb-flip", state="detached")
        window.tab("Metrics")
        window.page.locator(".sb-table", has_text=DIFFERENCE).first.wait_for()
        within(window, ".sb-table table")
    finally:
        for pin in window.session.pins.all:
            window.session.pins.remove(pin.id)
        window.session.pins._next = 1
    window.tab("Errors")
    window.page.wait_for_function(
        f"() => !({_UPLOT_NAMES})().some(names => names.some(n => n.startsWith('ζ')))"
    )


def test_a_change_is_undone_and_all_is_reset(window: Bench) -> None:
    before = edits.value_at(window.session.scenario, ZETA)
    window.press("network.zeta")
    window.settle()
    within(window, ".sb-row button")
    button(window, "Undo").click()
    wait_for_value(window, "network.zeta", before)
    window.settle()
    window.press("network.zeta")
    palette(window, "Reset all")
    wait_for_value(window, "network.zeta", before)
    window.settle()
    assert edits.value_at(window.session.scenario, ZETA) == before


def test_units_cursor_and_spectrum(window: Bench) -> None:
    window.tab("View")
    window.choose("velocities in", "kn")
    window.page.wait_for_function(_SHOWS, arg=["δVE (kn)", 3])
    window.choose("velocities in", "auto")
    window.page.wait_for_function(_SHOWS, arg=["δVE (m/s)", 3])
    window.settle()
    chart = window.page.locator(".uplot .u-over").first
    for x in (40, 60):
        chart.hover(position={"x": x, "y": 20})
    window.page.wait_for_function(
        "() => [...document.querySelectorAll('.sb-values')].filter(e => e.textContent).length === 6"
    )
    window.page.mouse.move(10, 10)
    window.tab("Spectrum")
    assert {"free", "classic2", "complementary"} <= {trace["name"] for trace in window.plotly()}


def test_a_typed_pair_is_placed(window: Bench) -> None:
    window.choose_and_run("network", "unity2")
    window.tab("Poles")
    number = window.run
    window.box("pair ζ").fill("0.35")
    button(window, "Place").click()
    window.wait_for_run(number)
    assert edits.value_at(window.session.scenario, ZETA) == pytest.approx(0.35)
    within(window, ".js-plotly-plot .legend")


def test_a_requirement_is_judged(window: Bench) -> None:
    window.tab("Requirements")
    try:
        window.page.wait_for_function(
            "() => document.querySelectorAll('.sb-verdicts [data-measure]').length > 0"
        )
        ask(window, "settling ≤ (min)", "90")
        wait_for(window, "settling_min", ["missed", "met", "missed"])
        within(window, ".sb-verdicts [data-measure]")
    finally:
        window.show(requirements=Requirements())


def test_the_ship_plays_and_is_seen_from_above(window: Bench) -> None:
    playing.command(window, "seek", 3600)
    button(window, "play").click()
    playing.wait_for(window, "n.playing && n.time > 3700")
    button(window, "pause").click()
    playing.wait_for(window, "!n.playing")
    button(window, "view: top").click()
    playing.wait_for(window, "n.camera === 'top'")
    button(window, "view: map").click()
    playing.command(window, "seek", 1e9)
    playing.wait_for(window, "n.camera === 'map' && n.time === n.span")
    within(window, "#sb-stage .sb-bar")


def test_a_lesson_shows_its_step_and_takes_an_answer(window: Bench) -> None:
    window.tab("Learn")
    if window.page.locator("[data-command='lesson list']").count():
        learning.press(window, "list")
    lesson = lessons()[0]
    learning.press(window, "open 0")
    index = next(i for i, step in enumerate(lesson.steps) if step.question is not None)
    for _ in range(index):
        learning.press(window, "next")
    question: Any = lesson.steps[index].question
    learning.heading(window, lesson.steps[index].title)
    learning.show_me(window, lesson, index)
    right = right_answer(question, simulate(lesson.scenario_of(index)))
    learning.answer(window, right, choices=bool(question.choices))
    window.page.locator(".sb-question[data-right=true]").wait_for()
    within(window, learning.SECTION)


def test_the_palette_opens_and_the_page_turns_dark(window: Bench) -> None:
    palette(window, "Keys")
    dialog = window.dialog("Keys")
    dialog.wait_for()
    within(window, "dialog.sb-dialog")
    window.page.keyboard.press("Escape")
    dialog.wait_for(state="hidden")
    for shown in ("dark", "light"):
        away_from_text(window)
        window.page.keyboard.press("d")
        window.page.wait_for_selector(f"#sb-theme[data-theme={shown}]", state="attached")
