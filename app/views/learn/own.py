"""Lessons of a teacher: a folder of Markdown files, each checked by its own runs before the page opens."""

import os
import re
from collections.abc import Iterator
from pathlib import Path

from pydantic import ValidationError

from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.faults import faults_from
from navcore.foundation.inputs import TooLargeError, read_bytes
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.session.display import Display
from schuler_bench.views.learn.asked import Question, curve_of, met, right_choice
from schuler_bench.views.learn.lessons import OWN, Action, Lesson, Step, at_line, lessons, read_lesson
from schuler_bench.views.learn.names import named
from schuler_bench.views.learn.view import spec_at

_NAMES = re.compile(r"\{\{([^{}]*)\}\}")
_LARGEST_BYTES = 1 << 20


def use_lessons(folder: Path) -> tuple[Lesson, ...]:
    """Check the lessons of a folder, and show them from now on after those of the program.

    Parameters
    ----------
    folder : Path
        With at least one file ``*.md``, as the lessons of the program (``assets/lessons``).

    Raises
    ------
    InputError
        One fault for each thing wrong, with file, line and remedy.
    """
    if not folder.is_dir():
        raise InputError(Fault("--lessons", "", str(folder), Text("must be a folder with lessons (*.md)")))
    files = sorted(folder.glob("*.md"))
    if not files:
        allowed = Text("holds no lesson: a lesson is a Markdown file (*.md)")
        raise InputError(Fault("--lessons", "", str(folder), allowed))
    found, faults = list[Lesson](), list[Fault]()
    for file in files:
        try:
            lesson = read_lesson(file.name, _text(file), str(file.parent))
        except InputError as error:
            faults += error.faults
            continue
        found.append(lesson)
        faults += lesson_faults(lesson)
    if faults:
        raise InputError(faults)
    os.environ[OWN] = str(folder.resolve())
    lessons.cache_clear()
    return tuple(found)


def _text(file: Path) -> str:
    try:
        return read_bytes(file, _LARGEST_BYTES).decode("utf-8")
    except TooLargeError:
        raise InputError(Fault(file.name, "", None, Text("is larger than 1 MiB: no lesson"))) from None
    except OSError as error:
        raise InputError(Fault(file.name, "", None, error.strerror or str(error))) from None
    except UnicodeDecodeError:
        raise InputError(Fault(file.name, "", None, Text("is not UTF-8 text: save it as UTF-8"))) from None


def lesson_faults(lesson: Lesson) -> Iterator[Fault]:
    """Yield what a lesson asks for that there is not: fields, tabs, choices, numbers, a right answer."""
    for place, step in enumerate(lesson.steps):
        where = at_line(lesson.id, step.line)
        try:
            scenario = lesson.scenario_of(place)
        except InputError as error:
            for fault in error.faults:
                named_so = fault.field or "preset"
                yield Fault(where, named_so, fault.value if fault.field else lesson.preset, fault.allowed)
            continue
        if step.action is not None:
            yield from _action_faults(where, step.action, scenario)
        asked = [one for one in (step.question, step.sketch, step.task) if one is not None]
        texts = step.text + "".join(one.why for one in asked)
        if not asked and not _NAMES.search(texts):
            continue
        run = simulate(scenario)
        for name in dict.fromkeys(_NAMES.findall(texts)):
            if not _known(name, run):
                allowed = Text("is no number of this step's run; the guide lists their names")
                yield Fault(where, "", "{{" + name + "}}", allowed)
        if step.question is not None:
            yield from _question_faults(where, step.question, run)
        yield from _prediction_faults(where, step, run)


def _action_faults(where: str, action: Action, scenario: Scenario) -> Iterator[Fault]:
    from schuler_bench.views import load

    tabs = [str(kind.title) for kind in load() if kind.place in ("upper", "lower")]
    for tab in action.tabs:
        if tab not in tabs:
            yield Fault(where, "tabs", tab, Text("must be one of {tabs}", tabs=", ".join(tabs)))
    try:
        Display().with_(**action.shown)
    except ValidationError as error:
        faults = faults_from(error, Display, action.shown, "")
        yield from (Fault(where, f"display.{one.field}", one.value, one.allowed) for one in faults)
    if action.method is not None and action.method >= len(scenario.method):
        allowed = Text("must be >= 0 and < {count}, the number of methods", count=len(scenario.method))
        yield Fault(where, "method", action.method, allowed)
    for path in action.sliders:
        if not any(spec.slider for spec in spec_at(scenario, path)):
            allowed = Text("must be a field with a slider, such as method.0.network.xi")
            yield Fault(where, "sliders", path, allowed)


def _question_faults(where: str, question: Question, run: Run) -> Iterator[Fault]:
    if question.choices:
        try:
            right_choice(question, run)
        except KeyError as error:
            allowed = Text("must have one right choice in this step's run: {why}", why=str(error.args[0]))
            yield Fault(where, "question.choices", None, allowed)
    elif not _known(question.answer, run):
        allowed = Text("must be the name of a number of this step's run, or there must be choices")
        yield Fault(where, "question.answer", question.answer, allowed)


def _prediction_faults(where: str, step: Step, run: Run) -> Iterator[Fault]:
    if step.sketch is not None:
        try:
            curve_of(step.sketch, run)
        except KeyError:
            allowed = Text(
                "must be the number of a method and an error that is not zero in this step's run, such as "
                "0.phi_e"
            )
            yield Fault(where, "sketch.curve", step.sketch.curve, allowed)
    if step.task is not None:
        try:
            done = all(met(step.task, run))
        except KeyError as error:
            allowed = Text("must be comparisons of numbers of this step's run")
            yield Fault(where, "task.conditions", error.args[0], allowed)
        else:
            if done:
                allowed = Text("must not hold before anything was changed: all do in this step's run")
                yield Fault(where, "task.conditions", None, allowed)


def _known(name: str, run: Run) -> bool:
    try:
        named(name, run)
    except KeyError:
        return False
    return True
