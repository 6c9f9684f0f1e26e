"""Curves that learners predict, and tasks that their own runs meet: judged by the engine."""

import math
from collections.abc import Iterable

import numpy as np
import pytest

from navcore.engine.simulation import simulate
from schuler_bench.editing.edits import with_value
from schuler_bench.views.learn.asked import (
    COLUMNS_OF_SKETCH,
    compare,
    crossings,
    curve_of,
    met,
    read_heights,
)
from schuler_bench.views.learn.lessons import Lesson, lessons
from schuler_bench.views.learn.shown import task_html
from schuler_bench.views.learn.view import spec_at
from tests.answers import run_of

LESSONS = lessons()
STEPS = [(lesson, i) for lesson in LESSONS for i in range(len(lesson.steps))]


SKETCHES = [(lesson, i) for lesson, i in STEPS if lesson.steps[i].sketch is not None]
TASKS = [(lesson, i) for lesson, i in STEPS if lesson.steps[i].task is not None]


def as_drawn(heights: Iterable[float]) -> tuple[float, ...]:
    return read_heights(",".join(f"{height:.3f}" for height in heights))


@pytest.mark.parametrize(("lesson", "index"), SKETCHES, ids=[f"{le.id}-{i + 1}" for le, i in SKETCHES])
def test_the_run_judges_a_sketch(lesson: Lesson, index: int) -> None:
    curve = curve_of(lesson.steps[index].sketch, run_of(lesson.id, index))
    assert 1.2 * curve.largest <= curve.half <= 3.0 * curve.largest
    at = np.linspace(curve.hours[0], curve.hours[-1], COLUMNS_OF_SKETCH)
    traced = np.interp(at, curve.hours, curve.values) / curve.half
    assert compare(as_drawn(traced), curve)[1], "the curve itself is right"
    assert not compare(as_drawn(0.1 * traced), curve)[1], "a tenth of it is not"
    many = 0.8 * np.abs(traced).max() * (-1.0) ** np.arange(COLUMNS_OF_SKETCH)
    assert not compare(as_drawn(many), curve)[1], "nor a curve that crosses zero all the time"


def test_a_sketch_says_what_was_drawn_and_what_the_run_does() -> None:
    curve = curve_of(LESSONS[0].steps[0].sketch, run_of(LESSONS[0].id, 0))
    words, _ = compare(as_drawn([0.5, -0.5] * 24 + [0.5]), curve)
    assert words.startswith('Your curve reaches 50" and crosses zero 48 times; the run reaches 60"')
    assert crossings([1.0, 0.0, math.nan, -1.0, -2.0, 0.0, 3.0]) == 2


@pytest.mark.parametrize(
    "text", ["", "1", "0," * 48 + "2", "x," * 48 + "0", "0," * 20 + "," * 28, "inf," * 48 + "0"]
)
def test_what_is_no_sketch_is_refused(text: str) -> None:
    with pytest.raises(ValueError):
        read_heights(text)


def test_every_lesson_has_a_task_that_needs_its_slider() -> None:
    assert {lesson.id for lesson, _ in TASKS} == {lesson.id for lesson in LESSONS}
    assert len(SKETCHES) >= 7
    for lesson in LESSONS:
        assert lesson.minutes and len(lesson.goals) >= 2 and len(lesson.misconceptions) >= 2


ENOUGH = {
    "1-schuler-pendulum": 0.003,
    "2-damping-and-tuning": 0.0015,
    "3-internal-external": 0.8,
    "4-gain-at-rest": 0.72,
    "5-foucault-beat": 41.7,
    "6-switching-overshoot": 1.0,
    "7-half-period-averaging": 15.0,
    "8-whole-system": 10.0,
    "9-how-good-can-it-get": 0.002,
    "10-two-oscillations": 0.9,
    "11-damping-from-outside": 0.9,
}
"""A value of the step's first slider with which its task is met."""


@pytest.mark.parametrize(("lesson", "index"), TASKS, ids=[f"{le.id}-{i + 1}" for le, i in TASKS])
def test_a_task_is_met_by_its_slider_and_not_before(lesson: Lesson, index: int) -> None:
    step, before = lesson.steps[index], run_of(lesson.id, index)
    assert not all(met(step.task, before))
    (spec,) = spec_at(before.scenario, step.action.sliders[0])
    value = ENOUGH[lesson.id]
    assert spec.slider.low <= value <= spec.slider.high
    after = simulate(with_value(before.scenario, spec.path, value))
    assert met(step.task, after) == (True,) * len(step.task.conditions)
    assert 'data-right="true"' in task_html(step.task, after)[0]
    assert 'data-right="false"' in task_html(step.task, before)[0]
