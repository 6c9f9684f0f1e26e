"""Each lesson is worked through as a reader would: shown, answered wrongly, answered rightly, to its end."""

import re
from pathlib import Path

import pytest

from navcore.engine.simulation import simulate
from schuler_bench.views.learn.lessons import OWN, Lesson, lessons
from schuler_bench.views.learn.names import named
from schuler_bench.views.learn.own import use_lessons
from schuler_bench.views.learn.view import spec_at
from tests.answers import names_in, right_answer
from tests.browser.cases import first_of
from tests.browser.conftest import Another
from tests.browser.driver import Bench

SECTION = ".sb-lesson:not(.sb-question):not(.sb-asks):not(.sb-below)"
# Numbers of the text as they are shown, by their name.
_LIVE = f"""() => [...document.querySelectorAll('{SECTION} .sb-live')]
  .map(e => [e.dataset.name, e.textContent])"""


def press(bench: Bench, what: str) -> None:
    """Press a button of the lesson by what it asks for; wait until that is done."""
    bench.page.locator(f"[data-command='lesson {what}']").first.click()
    bench.sent()


def heading(bench: Bench, text: str) -> None:
    bench.page.locator(f"{SECTION} h3", has_text=bench.said(text)).wait_for()


def show_me(bench: Bench, lesson: Lesson, index: int) -> None:
    """Press "Show me" and wait for what it promises: the scenario's run, and the tabs in front."""
    press(bench, "show")
    bench.page.locator("[data-command='lesson show'].sb-quiet").wait_for()
    assert bench.session.scenario == lesson.scenario_of(index)
    bench.settle()
    tabs = lesson.steps[index].action.tabs
    bench.page.wait_for_function("look.inFront", arg=[bench.said(tab) for tab in tabs])
    for field, value in lesson.steps[index].action.display.items():
        assert getattr(bench.session.display, field) == value


def answer(bench: Bench, given: str, *, choices: bool) -> None:
    """Give an answer once the page shows all that was sent: a late verdict would replace the box."""
    bench.settle()
    if choices:
        press(bench, f"answer {given}")
        return
    bench.page.get_by_label(bench.said("Your answer")).fill(given)
    bench.page.keyboard.press("Enter")


@pytest.fixture
def learner(bench: Bench) -> Bench:
    """The shared page with the list of lessons."""
    bench.reset("sikuliaq-like", "Learn")
    bench.page.locator("[data-command='lesson open 0']").wait_for()
    return bench


def work_through(bench: Bench, lesson: Lesson, index: int) -> None:
    """One step: what it shows, then its question, first wrongly."""
    step = lesson.steps[index]
    heading(bench, step.title)
    show_me(bench, lesson, index)
    run = bench.session.run
    assert dict(bench.page.evaluate(_LIVE)) == {name: named(name, run).text for name in names_in(step.text)}
    formulas = step.text.count("$$") // 2 + step.text.replace("$$", "").count("$") // 2
    assert bench.page.locator(f"{SECTION} math").count() == formulas
    for path in step.action.sliders:
        (spec,) = spec_at(run.scenario, path)
        assert bench.slider(spec.label).is_visible()
    dot = bench.page.locator(".sb-dot[aria-current=step]").get_attribute("aria-label")
    assert dot.startswith(f"Step {index + 1} of {len(lesson.steps)}")
    question = step.question
    if question is None:
        return
    right = right_answer(question, simulate(lesson.scenario_of(index)))
    wrong = str((int(right) + 1) % len(question.choices)) if question.choices else f"{3 * float(right) + 1:g}"
    told = bench.page.locator(".sb-question [role=status]")
    answer(bench, wrong, choices=bool(question.choices))
    told.filter(has_text="Not so").wait_for()
    assert bench.page.locator(".sb-question").get_attribute("data-right") == "false"
    answer(bench, right, choices=bool(question.choices))
    bench.page.locator(".sb-question[data-right=true]").wait_for()
    assert "press Show me" not in told.inner_text()


@pytest.mark.parametrize("number", first_of(range(len(lessons()))), ids=[lesson.id for lesson in lessons()])
def test_a_lesson_is_worked_through(learner: Bench, number: int) -> None:
    lesson = lessons()[number]
    press(learner, f"open {number}")
    for index in range(len(lesson.steps)):
        work_through(learner, lesson, index)
        if index + 1 < len(lesson.steps):
            press(learner, "next")


def test_a_slider_in_a_lesson_moves_the_curves_and_the_numbers(learner: Bench) -> None:
    for what in ("open 0", "next", "next"):
        press(learner, what)
    heading(learner, "The same swing in the velocity")
    show_me(learner, lessons()[0], 2)
    for what in ("back", "next"):
        press(learner, what)
    before = learner.metrics["methods"][0]["errors"]["dvn_mps"]["max_abs"]
    learner.press("try: initial misalignment φE (arcmin)")
    assert learner.metrics["methods"][0]["errors"]["dvn_mps"]["max_abs"] > before
    # the question is still about the step's own scenario, and the button offers to go back to it
    assert learner.page.locator("[data-command='lesson show']").inner_text() == "Show me"
    answer(learner, "4.6", choices=False)
    learner.page.locator(".sb-question[data-right=true]").wait_for()
    answer(learner, "much", choices=False)
    learner.page.locator(".sb-question [role=status]", has_text="Type a number").wait_for()


def test_a_lesson_is_worked_by_keyboard_alone(learner: Bench) -> None:
    for command, step in (("open 4", 0), ("next", 1)):
        button = learner.page.locator(f"[data-command='lesson {command}']")
        button.focus()
        button.press("Enter")
        heading(learner, lessons()[4].steps[step].title)
    # the HTML was replaced; the focus is where it was
    learner.page.wait_for_function("() => document.activeElement?.dataset?.command === 'lesson next'")


@pytest.mark.slow
def test_a_teachers_lesson_is_followed_by_two_pages_that_watch(
    fresh: Bench, another: Another, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(OWN, "")
    monkeypatch.delenv(OWN)
    guide = Path(__file__).parents[2] / "docs" / "teaching.md"
    text = re.search(r"^````markdown\n(.*?)^````$", guide.read_text(), re.DOTALL | re.MULTILINE).group(1)
    (tmp_path / "log.md").write_text(text)
    try:
        (lesson,) = use_lessons(tmp_path)
        watching = [another(1280, 720).open(f"s/{fresh.session_id}/") for _ in range(2)]
        for page in watching:
            page.tab("Method", "Poles")
        fresh.tab("Learn")
        fresh.button("Present").click()
        for page in watching:
            page.page.get_by_text("watch").first.wait_for()
        press(fresh, "open 0")  # the list is made anew after it
        press(fresh, "list")
        press(fresh, f"open {len(lessons()) - 1}")
        press(fresh, "next")
        for page in (fresh, *watching):
            heading(page, lesson.steps[1].title)
            page.page.wait_for_function("look.inFront", arg=["Learn"])
        show_me(fresh, lesson, 1)
        for page in watching:
            page.page.wait_for_function("look.inFront", arg=["Errors"])
            page.page.locator(f"{SECTION} .sb-live").first.wait_for()
            assert page.page.evaluate(_LIVE) == fresh.page.evaluate(_LIVE)
            assert not page.page.get_by_text("press Show me").is_visible()
    finally:
        lessons.cache_clear()


def test_what_no_lesson_knows_is_ignored(learner: Bench) -> None:
    for argument in ("open 99", "open -1", "step 77", "answer " + "9" * 3000, "nonsense", ""):
        learner.page.evaluate("text => window.schuler.command('lesson', text)", argument)
    press(learner, "open 0")
    heading(learner, lessons()[0].steps[0].title)
