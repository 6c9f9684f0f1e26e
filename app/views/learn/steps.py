"""The steps of a lesson as HTML: the list of lessons, text and button of a step, its question, the way on."""

from collections import Counter
from collections.abc import Sequence
from functools import lru_cache

from navcore.engine.run import Run
from navcore.foundation.text import Text
from schuler_bench.session.classroom import Given
from schuler_bench.views.learn.asked import Question
from schuler_bench.views.learn.lessons import Lesson, lessons, to_html
from schuler_bench.views.learn.shown import COMMAND

_MOST_VALUES = 6


def step_html(lesson: Lesson, place: int, run: Run | None, *, fresh: bool) -> str:
    """Return text and button of a step.

    Parameters
    ----------
    lesson : Lesson
        Of the step.
    place : int
        Of the step, from 0.
    run : Run or None
        Whose numbers the text may tell.
    fresh : bool
        The session's scenario is that of the step.
    """
    step = lesson.steps[place]
    dots = Text.joined(
        "",
        (
            Text(
                '<button class="sb-dot{here}" data-command="{command} step {i}" '
                'aria-label="Step {number} of {count}: {title:html}"{current}></button>',
                here=" sb-here" * (i == place),
                command=COMMAND,
                i=i,
                number=i + 1,
                count=len(lesson.steps),
                title=s.title,
                current=" aria-current=step" * (i == place),
            )
            for i, s in enumerate(lesson.steps)
        ),
    )
    button = ""
    if step.action is not None:
        label = Text("Show me again") if fresh else Text("Show me")
        button = Text(
            '<button class="sb-button{quiet}" data-command="{command} show">{label}</button>',
            quiet=" sb-quiet" * fresh,
            command=COMMAND,
            label=label,
        )
    return Text(
        '<section class="sb-lesson" aria-label="Lesson"><div class="sb-crumb"><button '
        'class="sb-link" data-command="{command} list">All lessons</button><nav class="sb-dots" '
        'aria-label="Steps">{dots}</nav></div><h2>{title:html}</h2><div aria-live="polite"><h3>'
        "{step:html}</h3>{text}</div>{button}</section>",
        command=COMMAND,
        dots=dots,
        title=lesson.title,
        step=step.title,
        text=to_html(step.text, run),
        button=button,
    )


def question_html(
    question: Question, given: str, verdict: str, *, right: bool, of_class: Sequence[Given]
) -> str:
    """Return a question with its answers.

    Parameters
    ----------
    question : Question
        What is asked.
    given : str
        Answer of this visitor; empty: none.
    verdict : str
        On it, HTML.
    right : bool
        It is right.
    of_class : sequence of Given
        Answers of a class, on the page of the one who leads.
    """
    if question.choices:
        answers = Text.joined(
            "",
            (
                Text(
                    '<button class="sb-choice{value}" aria-pressed="{lower}" '
                    'data-command="{command} answer '
                    '{i}">{words}{count}</button>',
                    count=_count(sum(one.answer == str(i) for one in of_class)),
                    value=" sb-chosen" * (given == str(i)),
                    lower=str(given == str(i)).lower(),
                    command=COMMAND,
                    i=i,
                    words=to_html(choice.say, None).removeprefix("<p>").removesuffix("</p>" + chr(10)),
                )
                for i, choice in enumerate(question.choices)
            ),
        )
    else:
        answers = Text(
            '<form class="sb-number" data-answer="{command}"><input type="text" inputmode="decimal" '
            'aria-label="Your answer" value="{value:html}" autocomplete="off"><button '
            'class="sb-button">Check</button></form>',
            command=COMMAND,
            value=given,
        ) + _answers_html(of_class)
    return Text(
        '<section class="sb-lesson sb-question" aria-label="Question" data-right="{lower}">'
        '{text}{answers}<div role="status">{verdict}</div></section>',
        lower=str(right).lower(),
        text=to_html(question.ask, None),
        answers=answers,
        verdict=verdict,
    )


def _count(number: int) -> str:
    """How many of a class chose an answer; nothing for none."""
    return Text(' <b class="sb-count">{number}</b>', number=number) if number else ""


def _answers_html(given: Sequence[Given]) -> str:
    """Return the numbers that a class has answered, the most frequent first, and how often each."""
    counts = Counter(one.answer for one in given if one.answer)
    items = Text.joined(
        "",
        (
            Text("<li><b>{count}</b> \N{MULTIPLICATION SIGN} {answer:html}</li>", count=count, answer=answer)
            for answer, count in counts.most_common(_MOST_VALUES)
        ),
    )
    return (
        Text('<ul class="sb-answers" aria-label="Answers of the class">{items}</ul>', items=items)
        if counts
        else ""
    )


def _minutes(number: int) -> str:
    """How long a lesson takes; empty where the file does not say it."""
    return Text(" ({minutes} min)", minutes=number) if number else ""


def list_html() -> str:
    """Return the list of lessons."""
    return _list_of(tuple((lesson.title, lesson.about, lesson.minutes) for lesson in lessons()))


@lru_cache(maxsize=4)
def _list_of(listed: tuple[tuple[str, str, int], ...]) -> str:
    entries = Text.joined(
        "",
        (
            Text(
                '<li><button class="sb-choice" data-command="{command} open {i}"><b>{title:html}</b>'
                "{minutes}<br>{about:html}</button></li>",
                command=COMMAND,
                i=i,
                title=title,
                about=about,
                minutes=_minutes(minutes),
            )
            for i, (title, about, minutes) in enumerate(listed)
        ),
    )
    return Text(
        '<section class="sb-lesson" aria-label="Lessons"><h2>Lessons</h2><p>Each sets the '
        "page up as it goes. Your own scenario comes back with Undo.</p><ol>"
        "{entries}</ol></section>",
        entries=entries,
    )


def below_html(place: int, step: int, steps: int) -> str:
    """Return the buttons Back and Next.

    Parameters
    ----------
    place, step : int
        Of the lesson in the list, and of the step in it, from 0.
    steps : int
        Of the lesson.
    """
    following = place + 1
    forward = f"{COMMAND} next", Text("Next")
    if step == steps - 1:
        more = following < len(lessons())
        forward = (
            (f"{COMMAND} open {following}", Text("Next lesson"))
            if more
            else (f"{COMMAND} list", Text("Done"))
        )
    back = (
        Text(
            '<button class="sb-button sb-quiet" data-command="{command} back">Back</button>',
            command=COMMAND,
        )
        if step
        else "<span></span>"
    )
    return Text(
        '<nav class="sb-lesson sb-below" aria-label="Lesson">{back}<button class="sb-button '
        'sb-quiet" data-command="{next_command}">{label}</button></nav>',
        back=back,
        next_command=forward[0],
        label=forward[1],
    )
