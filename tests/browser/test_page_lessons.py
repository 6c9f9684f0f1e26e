"""Each lesson is worked through as a reader would: shown, answered wrongly, answered rightly, to its end."""

from __future__ import annotations

import pytest

from app.views.learn.lessons import MISSING, Lesson, lessons
from app.views.learn.names import named
from app.views.learn.view import spec_at
from navcore.engine.simulation import simulate
from tests.answers import names_in, right_answer
from tests.browser.driver import Bench
from tests.browser.test_page_layout import SIZES, resize

pytestmark = pytest.mark.browser

SECTION = ".sb-lesson:not(.sb-question):not(.sb-below)"
_IN_FRONT = """tabs => tabs.every(name => [...document.querySelectorAll('[role=tab]')]
  .some(tab => tab.textContent === name && tab.getAttribute('aria-selected') === 'true'))"""
# Numbers of the text as they are shown, by their name.
_LIVE = f"""() => [...document.querySelectorAll('{SECTION} .sb-live')]
  .map(e => [e.dataset.name, e.textContent])"""


def press(bench: Bench, what: str) -> None:
    """Press a button of the lesson by what it asks for; wait until that is done."""
    bench.page.locator(f"[data-command='lesson {what}']").first.click()
    bench.sent()


def open_list(bench: Bench) -> None:
    """Leave the lesson that is open, if one is."""
    bench.page.locator("[data-command^='lesson ']").first.wait_for()
    if bench.page.locator("[data-command='lesson list']").count():
        press(bench, "list")


def heading(bench: Bench, text: str) -> None:
    bench.page.locator(f"{SECTION} h3", has_text=bench.said(text)).wait_for()


def show_me(bench: Bench, lesson: Lesson, index: int) -> None:
    """Press "Show me" and wait for what it promises: the scenario's run, and the tabs in front."""
    press(bench, "show")
    bench.page.locator("[data-command='lesson show'].sb-quiet").wait_for()
    assert bench.session.scenario == lesson.scenario_of(index)
    bench.settle()
    tabs = lesson.steps[index].action.tabs
    bench.page.wait_for_function(_IN_FRONT, arg=[bench.said(tab) for tab in tabs])
    for field, value in lesson.steps[index].action.display.items():
        assert getattr(bench.session.display, field) == value


def answer(bench: Bench, given: str, *, choices: bool) -> None:
    if choices:
        press(bench, f"answer {given}")
        return
    bench.page.get_by_label(bench.said("Your answer")).fill(given)
    bench.page.keyboard.press("Enter")


def work_through(bench: Bench, lesson: Lesson, index: int) -> None:
    """One step: what it shows, then its question, first wrongly."""
    step = lesson.steps[index]
    heading(bench, step.title)
    show_me(bench, lesson, index)
    run = bench.session.run
    live = dict(bench.page.evaluate(_LIVE))
    assert live == {name: named(name, run).text for name in names_in(step.text)}
    assert bench.page.locator(f"{SECTION} math").count() == step.text.count("$$") // 2 + (
        step.text.replace("$$", "").count("$") // 2
    )
    for path in step.action.sliders:
        (spec,) = spec_at(run.scenario, path)
        assert bench.slider(spec.label).is_visible()
    question = step.question
    if question is None:
        return
    right = right_answer(question, simulate(lesson.scenario_of(index)))
    wrong = str((int(right) + 1) % len(question.choices)) if question.choices else f"{3 * float(right) + 1:g}"
    asked = bench.page.locator(".sb-question [role=status]")
    answer(bench, wrong, choices=bool(question.choices))
    asked.filter(has_text="Not so").wait_for()
    assert bench.page.locator(".sb-question").get_attribute("data-right") == "false"
    answer(bench, right, choices=bool(question.choices))
    bench.page.locator(".sb-question[data-right=true]").wait_for()
    assert "press Show me" not in asked.inner_text()


@pytest.mark.parametrize("number", range(len(lessons())), ids=[lesson.id for lesson in lessons()])
def test_a_lesson_is_worked_through(bench: Bench, number: int) -> None:
    lesson = lessons()[number]
    bench.tab("Learn")
    open_list(bench)
    press(bench, f"open {number}")
    for index in range(len(lesson.steps)):
        work_through(bench, lesson, index)
        assert (
            bench.page.locator(".sb-dot[aria-current=step]")
            .get_attribute("aria-label")
            .startswith(f"Step {index + 1} of {len(lesson.steps)}")
        )
        if index + 1 < len(lesson.steps):
            press(bench, "next")
    assert bench.faults == []


def test_a_slider_in_a_lesson_moves_the_curves_and_the_numbers(bench: Bench) -> None:
    bench.tab("Learn")
    open_list(bench)
    press(bench, "open 0")
    for _ in range(2):
        press(bench, "next")
    heading(bench, "The same swing in the velocity")
    show_me(bench, lessons()[0], 2)
    press(bench, "back")
    press(bench, "next")
    before = bench.metrics["methods"][0]["errors"]["dvn_mps"]["max_abs"]
    bench.press("try: initial misalignment φE (arcmin)")
    after = bench.metrics["methods"][0]["errors"]["dvn_mps"]["max_abs"]
    assert after > before
    # the question is still about the step's own scenario, and the button offers to go back to it
    assert bench.page.locator("[data-command='lesson show']").inner_text() == "Show me"
    answer(bench, "4.6", choices=False)
    bench.page.locator(".sb-question[data-right=true]").wait_for()
    answer(bench, "much", choices=False)
    bench.page.locator(".sb-question [role=status]", has_text="Type a number").wait_for()


def test_a_lesson_is_worked_by_keyboard_alone(bench: Bench) -> None:
    bench.tab("Learn")
    open_list(bench)
    first = bench.page.locator("[data-command='lesson open 4']")
    first.focus()
    first.press("Enter")
    heading(bench, lessons()[4].steps[0].title)
    following = bench.page.locator("[data-command='lesson next']")
    following.focus()
    following.press("Enter")
    heading(bench, lessons()[4].steps[1].title)
    # the HTML was replaced; the focus is where it was
    focused = "() => document.activeElement?.dataset?.command === 'lesson next'"
    bench.page.wait_for_function(focused)


@pytest.mark.parametrize(
    "argument", ["open 99", "open -1", "step 77", "answer " + "9" * 3000, "nonsense", ""]
)
def test_what_no_lesson_knows_is_ignored(bench: Bench, argument: str) -> None:
    bench.tab("Learn")
    open_list(bench)
    bench.page.evaluate("text => window.schuler.command('lesson', text)", argument)
    press(bench, "open 0")
    heading(bench, lessons()[0].steps[0].title)
    assert bench.faults == []


def test_no_number_of_another_scenario_is_told_before_show_me(bench: Bench) -> None:
    bench.reset("sikuliaq-like")
    bench.tab("Learn")
    open_list(bench)
    press(bench, "open 0")
    heading(bench, lessons()[0].steps[0].title)
    assert {text for _, text in bench.page.evaluate(_LIVE)} == {MISSING}
    show_me(bench, lessons()[0], 0)
    assert MISSING not in {text for _, text in bench.page.evaluate(_LIVE)}
    bench.reset("sikuliaq-like")
    bench.page.wait_for_function(
        f"missing => ({_LIVE})().every(([_, text]) => text === missing)", arg=MISSING
    )


def test_in_one_panel_the_tab_that_a_step_speaks_of_is_in_front(bench: Bench) -> None:
    resize(bench, (1280, 720))
    try:
        bench.tab("Learn", "Poles")
        open_list(bench)
        press(bench, "open 1")
        press(bench, "show")
        bench.page.wait_for_function(_IN_FRONT, arg=["Errors"])
        bench.page.wait_for_timeout(500)
        assert bench.page.evaluate(_IN_FRONT, ["Errors"])
    finally:
        resize(bench, SIZES[0])
