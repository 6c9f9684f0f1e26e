"""Lessons: read from ``assets/lessons/*.md`` and a folder of one's own, and turned into what the page shows.

A file begins with TOML between two lines ``+++``: ``title``, ``about`` (one sentence), and the scenario it
plays in, as ``preset = "NAME"`` or as a table ``[scenario]``. Each ``## Heading`` begins a step: Markdown
with ``$...$`` and ``$$...$$`` (LaTeX), ``{{name}}`` for a number of the present run
(`schuler_bench.views.learn.names`), and at most one each of four fenced blocks of TOML:

``toml action``
    The button "Show me". ``set``: fields of the scenario as on the command line, each step beginning from the
    lesson's scenario; ``tabs`` to bring to the front; ``curves``: which errors the tab Errors then shows, as
    the display's field of this name; ``display``: further fields of
    `schuler_bench.session.display.Display`; ``method``: number of the method to edit; ``sliders``: fields
    that get a slider in the lesson.

``toml sketch``
    The learner draws a curve before it is shown: ``ask``, ``curve`` (number of a method and an error,
    ``0.phi_e``), ``why`` (shown with the run's curve).

``toml task``
    An open task that the learner's own run meets or not: ``ask``, ``conditions``: tables with ``say`` and
    ``when``, ``why`` (shown once all hold).

``toml question``
    ``ask``, ``why`` (shown once it is answered rightly), and either ``answer`` (a name) and its ``tolerance``
    (relative), or ``choices``: tables with ``say`` and ``when``, a comparison of names and numbers
    (``error.1.phi_n.max > 2 * error.0.phi_n.max``). The right choice is the one whose comparison holds for
    the run: no answer is typed into a file.
"""

import os
import re
import tomllib
from collections.abc import Callable
from contextlib import suppress
from copy import deepcopy
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeVar

from pydantic import Field, ValidationError

from navcore.engine.run import Run
from navcore.foundation.assets import asset_path
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.scenario.file import apply_overrides, load, resolve_files
from navcore.scenario.model import Scenario
from schuler_bench.session.display import Display
from schuler_bench.views.learn.asked import Part, Question, Sketch, Task
from schuler_bench.views.learn.names import named

_FRONT = re.compile(r"\A\+\+\+\n(.*?)\n\+\+\+\n(.*)\Z", re.DOTALL)
_HEADING = re.compile(r"^## (.+)$", re.MULTILINE)
_PLACE = re.compile(r"\(at line (\d+), column \d+\)|\(at end of document\)")
_FENCE = re.compile(r"^```toml (action|question|sketch|task)\n(.*?)^```$\n?", re.DOTALL | re.MULTILINE)
_MATH = re.compile(r"\$\$(.+?)\$\$|\$(.+?)\$", re.DOTALL)
_NAME = re.compile(r"\{\{([a-z0-9_.]+)\}\}")
_MARK = "\ue000{}\ue001"
"""Stands for a formula while the Markdown around it is read."""
MISSING = Text("(press Show me)")
"""Stands where the present run has no such number."""
OWN = "SCHULER_LESSONS"
"""In the environment: a folder of lessons beside those of the program."""

_T = TypeVar("_T")


class Action(Part):
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


class Step(Part):
    """A step of a lesson.

    Attributes
    ----------
    title, text : str
        Heading, and Markdown without the fenced blocks.
    action : Action or None
        What its button does.
    question : Question or None
        What it asks.
    sketch : Sketch or None
        The curve that the learner predicts.
    task : Task or None
        What the learner's own run should meet.
    line : int
        Of its heading in the file.
    """

    title: str
    text: str
    action: Action | None = None
    question: Question | None = None
    sketch: Sketch | None = None
    task: Task | None = None
    line: int = 0


class Lesson(Part):
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
    minutes : int
        How long a class takes.
    goals, misconceptions : tuple of str
        For the teacher: what one can do after it, and what learners expect that is not so.
    folder : str
        Of the file: what a scenario of its own reads is named from there.
    """

    id: str
    title: str
    about: str
    preset: str = ""
    scenario: dict[str, Any] = Field(default_factory=dict)
    minutes: int = Field(default=0, ge=0, le=240)
    goals: tuple[str, ...] = ()
    misconceptions: tuple[str, ...] = ()
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


def without(lesson: Lesson | None) -> dict[str, Any]:
    """Fields of the display that a lesson sets, as they are without it: what it sets goes with it."""
    steps = () if lesson is None else lesson.steps
    named = {name for step in steps if step.action is not None for name in step.action.shown}
    plain = Display()
    return {name: getattr(plain, name) for name in sorted(named)}
