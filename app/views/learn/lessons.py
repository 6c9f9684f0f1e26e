"""Lessons: read from ``assets/lessons/*.md`` and a folder of one's own, and turned into what the page shows.

A file begins with TOML between two lines ``+++``: ``title``, ``about`` (one sentence), and the scenario it
plays in, as ``preset = "NAME"`` or as a table ``[scenario]``. Each ``## Heading`` begins a step: Markdown
with ``$...$`` and ``$$...$$`` (LaTeX), ``{{name}}`` for a number of the present run
(`schuler_bench.views.learn.names`), and at most one each of two fenced blocks of TOML:

``toml action``
    The button "Show me". ``set``: fields of the scenario as on the command line, each step beginning from the
    lesson's scenario; ``tabs`` to bring to the front; ``curves``: which errors the tab Errors then shows, as
    the display's field of this name; ``display``: further fields of
    `schuler_bench.session.display.Display`; ``method``: number of the method to edit; ``sliders``: fields
    that get a slider in the lesson.

``toml question``
    ``ask``, ``why`` (shown once it is answered rightly), and either ``answer`` (a name) and its ``tolerance``
    (relative), or ``choices``: tables with ``say`` and ``when``, a comparison of names and numbers
    (``error.1.phi_n.max > 2 * error.0.phi_n.max``). The right choice is the one whose comparison holds for
    the run: no answer is typed into a file.
"""

import operator
import os
import re
import tomllib
from collections.abc import Callable
from contextlib import suppress
from copy import deepcopy
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from navcore.engine.run import Run
from navcore.foundation.assets import asset_path
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.numbers import read_number, read_whole
from navcore.foundation.text import Text
from navcore.scenario.file import apply_overrides, load, resolve_files
from navcore.scenario.model import Scenario
from schuler_bench.session.display import Display
from schuler_bench.views.learn.names import named

_FRONT = re.compile(r"\A\+\+\+\n(.*?)\n\+\+\+\n(.*)\Z", re.DOTALL)
_HEADING = re.compile(r"^## (.+)$", re.MULTILINE)
_PLACE = re.compile(r"\(at line (\d+), column \d+\)|\(at end of document\)")
_FENCE = re.compile(r"^```toml (action|question)\n(.*?)^```$\n?", re.DOTALL | re.MULTILINE)
_MATH = re.compile(r"\$\$(.+?)\$\$|\$(.+?)\$", re.DOTALL)
_NAME = re.compile(r"\{\{([a-z0-9_.]+)\}\}")
_COMPARISON = re.compile(r"([^<>]*)(<=|>=|<|>)(.*)")
_TERM = re.compile(r"(?:([0-9.eE+-]+)\s*\*\s*)?([a-z][a-z0-9_.]*)")
_MARK = "\ue000{}\ue001"
"""Stands for a formula while the Markdown around it is read."""
_SIGNS: dict[str, Callable[[float, float], bool]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
MISSING = Text("(press Show me)")
"""Stands where the present run has no such number."""
OWN = "SCHULER_LESSONS"
"""In the environment: a folder of lessons beside those of the program."""

_T = TypeVar("_T")


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class Action(_Part):
    """Action of the button "Show me"; see the module's text."""

    set: tuple[str, ...] = ()
    tabs: tuple[str, ...] = ()
    curves: str = "overview"
    display: dict[str, bool | str | float] = Field(default_factory=dict)
    method: int | None = Field(default=None, ge=0)
    sliders: tuple[str, ...] = ()

    @property
    def shown(self) -> dict[str, bool | str | float]:
        """Fields of the display that it sets."""
        return {"curves": self.curves, **self.display}


class Choice(_Part):
    """One of the answers to choose from, and when it is right."""

    say: str
    when: str


class Question(_Part):
    """A question, and how its answer follows from a run; see the module's text."""

    ask: str
    why: str
    answer: str = ""
    tolerance: float = Field(default=0.05, gt=0.0, le=0.5)
    choices: tuple[Choice, ...] = ()


class Step(_Part):
    """A step of a lesson.

    Attributes
    ----------
    title, text : str
        Heading, and Markdown without the fenced blocks.
    action : Action or None
        What its button does.
    question : Question or None
        What it asks.
    line : int
        Of its heading in the file.
    """

    title: str
    text: str
    action: Action | None = None
    question: Question | None = None
    line: int = 0


class Lesson(_Part):
    """A lesson.

    Attributes
    ----------
    id : str
        Name of its file.
    title, about : str
        As listed.
    preset : str
        Scenario it plays in; or
    scenario : dict
        the same as a table.
    steps : tuple of Step
        In order.
    folder : str
        Of the file: what a scenario of its own reads is named from there.
    """

    id: str
    title: str
    about: str
    preset: str = ""
    scenario: dict[str, Any] = Field(default_factory=dict)
    steps: tuple[Step, ...]
    folder: str = ""

    def scenario_of(self, step: int) -> Scenario:
        """Scenario in which a step plays: that of the nearest action up to it; raises `InputError`."""
        acting = (s.action.set for s in reversed(self.steps[: step + 1]) if s.action is not None)
        overrides = next(acting, ())
        if self.preset:
            return load(self.preset, overrides)
        data = deepcopy(self.scenario)
        apply_overrides(data, overrides)
        if self.folder:
            resolve_files(data, Path(self.folder))
        return Scenario.parse(data, self.id)


# ------------------------------------------------------------ reading


@lru_cache(maxsize=1)
def lessons() -> tuple[Lesson, ...]:
    """All lessons: those of the program by the numbers of their files, then those of the folder `OWN` names.

    Raises
    ------
    InputError
        A file is no lesson.
    """
    files = sorted(asset_path("lessons").glob("*.md"), key=lambda file: int(file.stem.partition("-")[0]))
    own = os.environ.get(OWN)
    more = sorted(Path(own).glob("*.md")) if own else []
    return tuple(
        read_lesson(
            file.stem if file in files else file.name, file.read_text(encoding="utf-8"), str(file.parent)
        )
        for file in (*files, *more)
    )


def read_lesson(id: str, text: str, folder: str = "") -> Lesson:
    """Read a lesson from its file's text; names of recordings in it are relative to a folder.

    Raises
    ------
    InputError
        It is none; the fault says in which line.
    """
    text = text.replace("\r\n", "\n")
    match = _FRONT.match(text)
    if match is None:
        raise InputError(Fault(at_line(id, 1), "", None, Text("must begin with TOML between two lines +++")))
    headings = [*_HEADING.finditer(text, match.start(2))]
    if not headings or text[match.start(2) : headings[0].start()].strip():
        raise InputError(
            Fault(
                at_line(id, line_of(text, match.start(2))),
                "",
                None,
                Text('must have its text in steps, each under a heading "## ..."'),
            )
        )
    ends = [*(heading.start() for heading in headings[1:]), len(text)]
    steps = [_step(id, text, heading, end) for heading, end in zip(headings, ends, strict=True)]
    front = _toml(id, 2, match.group(1))
    return _checked(id, 2, lambda: Lesson(id=id, steps=tuple(steps), folder=folder, **front))


def at_line(id: str, line: int) -> str:
    """Place of a fault."""
    return Text("{file}, line {line}", file=id, line=line)


def line_of(text: str, place: int) -> int:
    """Number of the line, from 1, in which a place of a text stands."""
    return text.count("\n", 0, place) + 1


def _step(id: str, text: str, heading: re.Match[str], end: int) -> Step:
    blocks: dict[str, Any] = {}
    for fence in _FENCE.finditer(text, heading.end(), end):
        kind, line = fence.group(1), line_of(text, fence.start())
        if kind in blocks:
            raise InputError(Fault(at_line(id, line), kind, None, Text("must stand once in a step")))
        blocks[kind] = _toml(id, line + 1, fence.group(2))
    body = _FENCE.sub("", text[heading.end() : end]).strip()
    line = line_of(text, heading.start())
    return _checked(id, line, lambda: Step(title=heading.group(1).strip(), text=body, line=line, **blocks))


def _toml(id: str, first: int, text: str) -> dict[str, Any]:
    """Read TOML that begins in a line of the file."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        words = str(error)
        place = _PLACE.search(words)
        line = first + (int(place.group(1)) - 1 if place and place.group(1) else text.count("\n"))
        words = _PLACE.sub("", words).strip()
        raise InputError(
            Fault(at_line(id, line), "", None, Text("is not valid TOML: {error}", error=words))
        ) from None


def _checked(id: str, line: int, make: Callable[[], _T]) -> _T:
    try:
        return make()
    except ValidationError as error:
        first = error.errors()[0]
        field = ".".join(map(str, first["loc"]))
        raise InputError(Fault(at_line(id, line), field, first.get("input"), first["msg"])) from None


# ------------------------------------------------------------ showing


def to_html(text: str, run: Run | None) -> str:
    """Markdown of a lesson as HTML, with formulas as MathML and the numbers of a run.

    Parameters
    ----------
    text : str
        Markdown; HTML in it is shown as text.
    run : Run or None
        Where the numbers come from; `MISSING` without one.
    """
    return _NAME.sub(lambda match: _number_html(match.group(1), run), _markdown(text))


@lru_cache(maxsize=256)
def _markdown(text: str) -> str:
    from markdown_it import MarkdownIt

    formulas: list[str] = []

    def keep(match: re.Match[str]) -> str:
        block, inline = match.groups()
        formulas.append(formula_html(block or inline, block=block is not None))
        return _MARK.format(len(formulas) - 1)

    html = MarkdownIt("commonmark", {"html": False}).enable("table").render(_MATH.sub(keep, text))
    return re.sub("\ue000([0-9]+)\ue001", lambda match: formulas[int(match.group(1))], html)


def formula_html(latex: str, *, block: bool = False) -> str:
    """A formula as MathML; one that stands alone can be scrolled when it is too wide."""
    from latex2mathml.converter import convert

    if not block:
        return convert(latex.strip(), display="inline")
    return Text('<span class="sb-formula">{formula}</span>', formula=convert(latex.strip(), display="block"))


def _number_html(name: str, run: Run | None) -> str:
    number = MISSING
    if run is not None:
        with suppress(KeyError):
            number = named(name, run).text
    return Text(
        '<span class="sb-live" data-name="{name:html}">{number:html}</span>', name=name, number=number
    )


# ------------------------------------------------------------ answers


def holds(comparison: str, run: Run) -> bool:
    """Whether a comparison of names and numbers holds for a run.

    Raises
    ------
    KeyError
        It is no comparison, or a name is unknown.
    """
    match = _COMPARISON.fullmatch(comparison)
    if match is None:
        raise KeyError(comparison)
    left, sign, right = match.groups()
    return _SIGNS[sign](_term(left.strip(), run), _term(right.strip(), run))


def _term(text: str, run: Run) -> float:
    with suppress(ValueError):
        return float(text)
    match = _TERM.fullmatch(text)
    if match is None:
        raise KeyError(text)
    factor, name = match.groups()
    return float(factor or 1.0) * named(name, run).value


def right_choice(question: Question, run: Run) -> int:
    """Number of the choice that is right for a run.

    Raises
    ------
    KeyError
        Not exactly one is.
    """
    right = [i for i, choice in enumerate(question.choices) if holds(choice.when, run)]
    if len(right) != 1:
        raise KeyError(f"{question.ask}: {len(right)} choices are right")
    return right[0]


def without(lesson: Lesson | None) -> dict[str, Any]:
    """Fields of the display that a lesson sets, as they are without it: what it sets goes with it."""
    steps = () if lesson is None else lesson.steps
    named = {name for step in steps if step.action is not None for name in step.action.shown}
    plain = Display()
    return {name: getattr(plain, name) for name in sorted(named)}


def is_right(question: Question, given: str, run: Run) -> bool:
    """Whether an answer is right for a run.

    Parameters
    ----------
    question : Question
        What was asked.
    given : str
        Number of the choice, or the number that was typed.
    run : Run
        Of the scenario that the question is about.

    Raises
    ------
    NotANumber
        ``given`` is no number.
    """
    if question.choices:
        return read_whole(given) == right_choice(question, run)
    value = named(question.answer, run).value
    return abs(read_number(given) - value) <= question.tolerance * abs(value)
