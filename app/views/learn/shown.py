"""What the tab "Learn" shows of sketches, tasks and the class, as HTML."""

import math
from collections.abc import Sequence
from contextlib import suppress

import numpy as np

from navcore.engine.run import Run
from navcore.foundation.text import Text
from schuler_bench.session.classroom import Classroom, Given
from schuler_bench.views.learn.asked import COLUMNS_OF_SKETCH, Curve, Sketch, Task, compare, curve_of, met
from schuler_bench.views.learn.lessons import Lesson, to_html

COMMAND = "lesson"
"""Command with which the panel's HTML asks: ``lesson open 2``, ``step 1``, ``next``, ``back``, ``list``,
``show``, ``answer TEXT``, ``sketch HEIGHTS``, ``again``, ``reveal``, ``lead CODE``, ``stop``."""
_WIDTH, _HEIGHT, _LEFT, _TOP = 300, 170, 44, 10
_INNER = (_WIDTH - _LEFT - 8, _HEIGHT - _TOP - 24)
_POINTS = 240
_MET, _NOT_YET = Text("met"), Text("not yet")
_UNITS = {'"': "arcsec", "'": "arcmin"}


# ------------------------------------------------------------ sketches


def sketch_html(
    sketch: Sketch,
    run: Run | None,
    mine: Sequence[float],
    others: Sequence[Sequence[float]],
    *,
    revealed: bool,
    words: str,
) -> str:
    """Return the question, the place to draw in, and what is to be pressed or read below it.

    Parameters
    ----------
    sketch : Sketch
        What is asked.
    run : Run or None
        Of the step's own scenario; None while it is awaited.
    mine : sequence of float
        The visitor's own sketch; empty: none yet.
    others : sequence of sequence of float
        Those of a class, on the page of the one who leads.
    revealed : bool
        The run's curve is drawn over them.
    words : str
        In place of the sketch while there is no curve.
    """
    curve = None
    if run is not None:
        with suppress(KeyError):
            curve = curve_of(sketch, run)
    if curve is None:
        below = Text('<p class="sb-muted">{words:html}</p>', words=words)
        return _box(to_html(sketch.ask, None), below, right=False)
    below, right = _hint(), False
    if revealed:
        told, right = compare(mine, curve) if mine else ("", False)
        look = "sb-right" if right else "sb-wrong"
        verdict = Text('<p class="{look}"><b>{told:html}</b></p>', look=look, told=told) if mine else ""
        below = verdict + to_html(sketch.why, run) + _button("again", Text("Draw again"), quiet=True)
    elif mine or others:
        below = _button("reveal", Text("Draw the run's curve"))
    large = Text('<button class="sb-enlarge" aria-label="Enlarge or reduce the sketch">\u2922</button>')
    return _box(
        to_html(sketch.ask, None) + large + _svg(curve, mine, others, revealed=revealed), below, right=right
    )


def _hint() -> str:
    return Text(
        '<p class="sb-muted">Draw with the pointer from the left end to the right, or with the arrow '
        "keys.</p>"
    )


def _box(first: str, below: str, *, right: bool) -> str:
    return Text(
        '<section class="sb-lesson sb-asks sb-predicts" aria-label="Sketch" data-right="{right}">{first}'
        '<div role="status">{below}</div></section>',
        right=str(right).lower(),
        first=first,
        below=below,
    )


def _button(what: str, words: str, *, quiet: bool = False) -> str:
    return Text(
        '<button class="sb-button{quiet}" data-command="{command} {what}">{words}</button>',
        quiet=" sb-quiet" * quiet,
        command=COMMAND,
        what=what,
        words=words,
    )


def _svg(curve: Curve, mine: Sequence[float], others: Sequence[Sequence[float]], *, revealed: bool) -> str:
    """The axes, all sketches, and the run's curve once it is revealed."""
    width, height = _INNER
    lines = [f'<polyline class="sb-theirs" points="{_points(heights)}"/>' for heights in others]
    if revealed:
        at = np.linspace(curve.hours[0], curve.hours[-1], _POINTS)
        values = np.interp(at, curve.hours, curve.values) / curve.half
        lines.append(f'<polyline class="sb-runs" points="{_points(values)}"/>')
    lines.append(f'<polyline class="sb-mine" points="{_points(mine)}"/>')
    grid = "".join(
        f'<line class="sb-grid" x1="{_LEFT}" x2="{_LEFT + width}" y1="{y:.1f}" y2="{y:.1f}"/>'
        for y in (_TOP, _TOP + 0.25 * height, _TOP + 0.5 * height, _TOP + 0.75 * height, _TOP + height)
    )
    ticks = "".join(
        f'<text x="{_LEFT - 5}" y="{y + 4:.1f}" text-anchor="end">{value:g}</text>'
        for value, y in (
            (curve.half, _TOP),
            (0.0, _TOP + 0.5 * height),
            (-curve.half, _TOP + height),
        )
    )
    hours = float(curve.hours[-1])
    times = "".join(
        f'<text x="{_LEFT + share * width:.1f}" y="{_TOP + height + 15}" text-anchor="{anchor}">'
        f"{words}</text>"
        for share, anchor, words in (
            (0.0, "start", "0"),
            (0.5, "middle", f"{0.5 * hours:.3g}"),
            (1.0, "end", f"{hours:.3g} h"),
        )
    )
    unit = f'<text x="{_LEFT + 5}" y="{_TOP + 16}">{_UNITS.get(curve.unit, curve.unit)}</text>'
    return Text(
        '<svg class="sb-sketch" viewBox="0 0 {width} {height}" tabindex="0" role="application" '
        'aria-label="Draw the curve that you expect" data-sketch="{command}" data-columns="{columns}" '
        'data-left="{left}" data-top="{top}" data-wide="{wide}" data-high="{high}" data-given="{given}">'
        "{grid}{ticks}{times}{unit}{lines}</svg>",
        width=_WIDTH,
        height=_HEIGHT,
        command=COMMAND,
        columns=COLUMNS_OF_SKETCH,
        left=_LEFT,
        top=_TOP,
        wide=width,
        high=height,
        given=",".join("" if math.isnan(h) else f"{h:.3f}" for h in mine),
        grid=grid,
        ticks=ticks,
        times=times,
        unit=unit,
        lines="".join(lines),
    )


def _points(heights: Sequence[float] | np.ndarray) -> str:
    """Points of a line in the drawing; what was not drawn is left out."""
    width, height = _INNER
    last = max(len(heights) - 1, 1)
    return " ".join(
        [
            f"{_LEFT + width * place / last:.1f},{_TOP + 0.5 * height * (1.0 - min(max(h, -1.0), 1.0)):.1f}"
            for place, h in enumerate(heights)
            if not math.isnan(h)
        ]
    )


# ------------------------------------------------------------ tasks


def task_html(task: Task, run: Run | None) -> tuple[str, bool]:
    """Return an open task with what of it a run meets, and whether it meets all."""
    found = (False,) * len(task.conditions) if run is None else met(task, run)
    items = Text.joined(
        "",
        (
            Text(
                '<li data-met="{met}"><span aria-hidden="true">{mark}</span> {words} <em>{told}</em></li>',
                met=str(holds).lower(),
                mark="\N{CHECK MARK}" if holds else "\N{WHITE CIRCLE}",
                words=to_html(condition.say, None).removeprefix("<p>").removesuffix("</p>\n"),
                told=_MET if holds else _NOT_YET,
            )
            for condition, holds in zip(task.conditions, found, strict=True)
        ),
    )
    done = all(found)
    why = Text('<div class="sb-right">{why}</div>', why=to_html(task.why, run)) if done else ""
    html = Text(
        '<section class="sb-lesson sb-asks sb-task" aria-label="Task" data-right="{right}">{ask}<ul>'
        '{items}</ul><div role="status">{why}</div></section>',
        right=str(done).lower(),
        ask=to_html(task.ask, None),
        items=items,
        why=why,
    )
    return html, done


# ------------------------------------------------------------ a class


def class_html(room: Classroom, *, leads: bool, given: Sequence[Given], lesson: Lesson | None) -> str:
    """Return the line about the class: who leads, how many are here, and what they gave at this step."""
    here = room.here
    if leads:
        sketched = sum(bool(one.heights) for one in given)
        answered, right = sum(bool(one.answer) for one in given), sum(one.right for one in given)
        tasks = sum(one.met for one in given)
        words = Text(
            "<b>You lead.</b> {here} here; at this step {sketched} sketched, {answered} answered ({right} "
            "rightly), {tasks} met the task.",
            here=here,
            sketched=sketched,
            answered=answered,
            right=right,
            tasks=tasks,
        )
        sheet = "" if lesson is None else sheet_html(lesson)
        return _class_box(words, _button("stop", Text("Stop leading"), quiet=True) + sheet)
    if room.is_led:
        return _class_box(Text("This page follows the class."), "")
    form = Text(
        '<form class="sb-number" data-answer="{command}" data-what="lead"><input type="text" '
        'inputmode="numeric" aria-label="Code of the class" placeholder="code" autocomplete="off">'
        '<button class="sb-button sb-quiet">Lead the class</button></form>',
        command=COMMAND,
    )
    return _class_box(Text("Nobody leads the class. The server has printed the code."), form)


def _class_box(words: str, below: str) -> str:
    return Text(
        '<section class="sb-lesson sb-asks sb-class" aria-label="Class"><p role="status">{words}</p>'
        "{below}</section>",
        words=words,
        below=below,
    )


def sheet_html(lesson: Lesson) -> str:
    """Return the teacher's sheet of a lesson: minutes, goals, what learners expect that is not so."""
    if not lesson.goals and not lesson.misconceptions:
        return ""
    goals, wrong = (
        Text.joined("", (Text("<li>{line}</li>", line=_inline(line)) for line in lines))
        for lines in (lesson.goals, lesson.misconceptions)
    )
    return Text(
        "<details><summary>Teacher's sheet ({minutes} min)</summary><h3>Goals</h3><ul>{goals}</ul>"
        "<h3>What learners expect that is not so</h3><ul>{wrong}</ul></details>",
        minutes=lesson.minutes,
        goals=goals,
        wrong=wrong,
    )


def _inline(line: str) -> str:
    return to_html(line, None).removeprefix("<p>").removesuffix("</p>\n")
