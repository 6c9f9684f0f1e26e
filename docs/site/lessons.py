"""The lessons of the page as plain Markdown, with the numbers of their own scenarios."""

from __future__ import annotations

import re
from collections.abc import Callable

from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.scenario.model import Scenario
from schuler_bench.views.learn.asked import Question, right_choice
from schuler_bench.views.learn.lessons import Lesson, Step, lessons
from schuler_bench.views.learn.names import named

_NAME = re.compile(r"\{\{\s*([^}]+?)\s*\}\}")


def pages() -> dict[str, str]:
    """Markdown of each lesson by the name of its file, without the ending."""
    return {lesson.id: _page(lesson) for lesson in lessons()}


def _page(lesson: Lesson) -> str:
    run_of = _memory()
    parts = [f"# {lesson.title}\n\n{lesson.about} (Lesson of the tab *Learn*; there it drives the page.)\n"]
    for number, step in enumerate(lesson.steps):
        run = run_of(lesson.scenario_of(number))
        parts.append(f"## {step.title}\n\n{_with_numbers(step.text, run)}\n")
        parts += _shown(step, run)
    return "\n".join(parts)


def _memory() -> Callable[[Scenario], Run]:
    """Run a scenario once, although several steps of a lesson play in it."""
    runs: dict[str, Run] = {}

    def run_of(scenario: Scenario) -> Run:
        key = scenario.model_dump_json()
        if key not in runs:
            runs[key] = simulate(scenario)
        return runs[key]

    return run_of


def _with_numbers(text: str, run: Run) -> str:
    return _NAME.sub(lambda found: named(found.group(1), run).text, text)


def _shown(step: Step, run: Run) -> list[str]:
    parts = []
    if step.action and step.action.set:
        fields = "\n".join(step.action.set)
        parts.append(f"The button *Show me* sets:\n\n```text\n{fields}\n```\n")
    if step.question:
        parts.append(_asked(step.question, run))
    return parts


def _asked(question: Question, run: Run) -> str:
    """A question with its answer folded away."""
    if question.choices:
        right = question.choices[right_choice(question, run)]
        answer = f"{right.say}"
        choices = "\n".join(f"- {choice.say}" for choice in question.choices) + "\n\n"
    else:
        answer, choices = named(question.answer, run).text, ""
    why = _with_numbers(question.why, run)
    return (
        f"**Question.** {_with_numbers(question.ask, run)}\n\n{choices}"
        f"<details>\n<summary>Answer</summary>\n\n{answer}. {why}\n\n</details>\n"
    )
