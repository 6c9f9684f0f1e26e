"""Tab "Learn": a lesson step by step, its button "Show me", its sliders, its question."""

import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from functools import lru_cache
from html import escape
from typing import Any

from pydantic import BaseModel

from navcore.engine.run import Run
from navcore.foundation.numbers import NotANumber
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.editing import edits, form
from schuler_bench.editing.form import FieldSpec, Path
from schuler_bench.session.classroom import Place
from schuler_bench.session.shown import Shown
from schuler_bench.shell import notices
from schuler_bench.shell.control import Control, Section
from schuler_bench.shell.searching import show_html
from schuler_bench.shell.view import Frame, Tab, View
from schuler_bench.views.learn import asked
from schuler_bench.views.learn.asked import Question, Sketch, is_right
from schuler_bench.views.learn.lessons import Action, Lesson, lessons, to_html, without
from schuler_bench.views.learn.shown import COMMAND, sketch_html, task_html
from schuler_bench.views.learn.steps import below_html, list_html, question_html, step_html
from schuler_bench.views.learn.together import Together

_UNREADABLE = Text("Type a number, such as 84.4.")

_RUNNING = Text("Running this step's scenario for the answer.")


class LearnView(View):
    """Shows lessons and carries out what they ask for."""

    title = Text("Learn")
    place = "edit"

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._lock = threading.RLock()
        self._followed = self._shown_step
        self._given: dict[tuple[int, int], str] = {}
        self._sketched: dict[tuple[int, int], tuple[float, ...]] = {}
        self._revealed: set[tuple[int, int]] = set()
        self._runner = frame.session.searches.runner
        self._judged_by = self._runner.result
        self._live: Scenario | None = None
        self._asked = 0
        self._together = Together(frame.session)
        frame.commands.register(COMMAND, self.command)

    def build(self, tab: Tab) -> None:
        """Make the places of text, question and buttons, in this order."""
        gui = self.frame.gui
        with tab:
            self._class = gui.add_html("", order=-1, visible=False)
            self._places = [gui.add_html("", order=order) for order in (0, 0.5, 50, 55, 60)]
            self._front = gui.add_html("", order=70)
        self._section = Section(gui, tab, self.frame.editor.edit, 1.0)
        self._together.join(self._follow_class)

    def close(self) -> None:
        """Leave the class."""
        self._together.leave()

    @property
    def _place(self) -> Place | None:
        """Step that is open, as the class names it."""
        lesson = self._current()
        return None if lesson is None else (lesson.id, self._step)

    @property
    def _key(self) -> tuple[int, int]:
        return self._lesson or 0, self._step

    @property
    def _lesson(self) -> int | None:
        """Place of the open lesson; all pages of a session show the same."""
        ids = [lesson.id for lesson in lessons()]
        wanted = self.session.display.lesson
        return ids.index(wanted) if wanted in ids else None

    @property
    def _step(self) -> int:
        lesson = self._current()
        return 0 if lesson is None else min(self.session.display.lesson_step, len(lesson.steps) - 1)

    @property
    def _shown_step(self) -> tuple[str, int, int]:
        display = self.session.display
        return display.lesson, display.lesson_step, display.lesson_shown

    @property
    def leads(self) -> int:
        """An open lesson has what a lecture needs."""
        return 0 if self._lesson is None else 2

    @property
    def controls(self) -> list[Control]:
        """The sliders of the lesson."""
        return list(self._section.controls.values())

    # ------------------------------------------------------------ what the user asks for

    def command(self, argument: str) -> None:
        """Carry out what a button of the panel's HTML asks for; anything else is ignored."""
        what, _, rest = argument.partition(" ")
        acts: dict[str, Callable[[], None]] = {
            "open": lambda: self._go(int(rest), 0),
            "list": lambda: self._go(None, 0),
            "next": lambda: self._go(self._lesson, self._step + 1),
            "back": lambda: self._go(self._lesson, self._step - 1),
            "step": lambda: self._go(self._lesson, int(rest)),
            "show": self._show_me,
            "answer": lambda: self._answer(rest.strip()),
            "sketch": lambda: self._sketch(rest.strip()),
            "again": self._draw_again,
            "reveal": self._reveal,
            "lead": lambda: self._lead(rest.strip()),
            "stop": self._together.stop,
        }
        act = acts.get(what)
        if act is None or (rest and not rest.strip()) or (what in ("open", "step") and not rest.isdigit()):
            return
        with self.session.lock, self._lock:
            act()
            self._show(None)

    def _go(self, lesson: int | None, step: int) -> None:
        if lesson is None:
            self.frame.show(**without(self._current()), lesson="", lesson_step=0)
        elif lesson < len(lessons()) and 0 <= step < len(lessons()[lesson].steps):
            left = {} if lesson == self._lesson else without(self._current())
            self.frame.show(**left, lesson=lessons()[lesson].id, lesson_step=step)
        self._together.go(self._place)

    def _show_me(self) -> None:
        lesson, action = self._current(), self._action()
        if lesson is None or action is None:
            return
        scenario, session = self._scenario(), self.session
        self._live = None
        session.change(scenario, None, origin=self._origin(lesson), selected=action.method)
        session.show(None, **action.shown, lesson_shown=session.display.lesson_shown + 1)
        self._together.show()

    def _answer(self, given: str) -> None:
        if self._lesson is not None and given and len(given) < 40:
            self._given[self._key] = given
            self._together.give(self._place, answer=given, right=False)

    def _sketch(self, heights: str) -> None:
        lesson = self._current()
        if lesson is None or lesson.steps[self._step].sketch is None:
            return
        with suppress(ValueError):
            self._sketched[self._key] = drawn = asked.read_heights(heights)
            self._together.give(self._place, heights=drawn)

    def _draw_again(self) -> None:
        self._sketched.pop(self._key, None)
        self._revealed.discard(self._key)
        self._together.give(self._place, heights=())

    def _reveal(self) -> None:
        self._revealed.add(self._key)
        self._together.reveal()

    def _lead(self, code: str) -> None:
        if not self._together.lead(code, self._place):
            notices.tell(
                self.frame.client, Text("Not possible"), [Text("That is not the code of the class.")]
            )

    def _follow_class(self) -> None:
        """Go where the class is led, and show what it has given."""
        with self.session.lock, self._lock:
            news = self._together.news()
            if news is not None:
                led, shown = news
                ids = [lesson.id for lesson in lessons()]
                if led.place is not None and led.place[0] in ids and led.place != self._place:
                    self.frame.commands.ask_page("front", "Learn")
                    self._go(ids.index(led.place[0]), led.place[1])
                if led.revealed:
                    self._revealed.add(self._key)
                if shown:
                    self._show_me()
            self._show(self.frame.editor.moved)
        self.frame.client.flush()

    # ------------------------------------------------------------ showing

    def follow_display(self) -> None:
        """Show the session's lesson and step; bring to the front what they are about."""
        before, self._followed = self._followed, self._shown_step
        if before == self._followed:
            return
        self._show(self.frame.editor.moved)
        action, tabs = self._action(), list[str]()
        if self.frame.commands.watching and before[:2] != self._followed[:2] and self._lesson is not None:
            tabs.append(self.title)
        if before[2] != self._followed[2] and action is not None:
            tabs += action.tabs
        if tabs:
            self._asked += 1
            data = f'data-count="{self._asked}" data-tabs="{escape("|".join(tabs))}"'
            self._front.content = Text('<div id="sb-front" hidden {data}></div>', data=data)

    def follow_scenario(self) -> None:
        """Show the lesson, and its sliders with the scenario's values."""
        self._show(self.frame.editor.moved)

    def draw(self, found: Shown) -> None:
        """Show the lesson with the numbers of the run."""
        del found
        self._show(self.frame.editor.moved)

    def _show(self, moved: Control | None) -> None:
        scenario, run = self.session.scenario, self.session.run
        with self._lock:
            lesson, action = self._current(), self._action()
            texts = (list_html(), "", "", "", "")
            if lesson is not None:
                step = lesson.steps[self._step]
                texts = (
                    step_html(
                        lesson,
                        self._step,
                        self._spoken_of(lesson, run),
                        fresh=scenario == self._scenario(),
                    ),
                    self._sketch_html(step.sketch),
                    self._question_html(lesson),
                    self._task_html(lesson, run),
                    below_html(self._lesson or 0, self._step, len(lesson.steps)),
                )
            show_html(self._class, self._together.html(self._place, lesson))
            for handle, html in zip(self._places, texts, strict=True):
                if handle.content != html:
                    handle.content, handle.visible = html, bool(html)
            specs = [spec for path in (action.sliders if action else ()) for spec in spec_at(scenario, path)]
            values = {spec.path: edits.value_at(scenario, spec.path) for spec in specs}
            self._section.show(specs, values, moved)

    def _current(self) -> Lesson | None:
        return None if self._lesson is None else lessons()[self._lesson]

    def _action(self) -> Action | None:
        lesson = self._current()
        return None if lesson is None else lesson.steps[self._step].action

    def _origin(self, lesson: Lesson) -> str:
        """Where a session's scenario comes from that the present step has set."""
        action = self._action()
        plain = bool(lesson.preset) and (action is None or not action.set)
        return lesson.preset if plain else Text("lesson: {title}", title=lesson.title)

    def _spoken_of(self, lesson: Lesson, run: Run | None) -> Run | None:
        """Run whose numbers the step may tell: of its own scenario, or of that as its sliders changed it."""
        own = self._scenario()
        if run is not None and run.scenario == own:
            self._live = own
        return run if self._live == own and self.session.origin == self._origin(lesson) else None

    def _scenario(self) -> Scenario:
        return _scenario(self._lesson or 0, self._step)

    def _sketch_html(self, sketch: Sketch | None) -> str:
        if sketch is None:
            return ""
        return sketch_html(
            sketch,
            self._run_of(self._scenario()),
            self._sketched.get(self._key, ()),
            [one.heights for one in self._together.given(self._place) if one.heights],
            revealed=self._key in self._revealed,
            words=Text.joined("; ", self._runner.words) or _RUNNING,
        )

    def _task_html(self, lesson: Lesson, run: Run | None) -> str:
        task = lesson.steps[self._step].task
        if task is None:
            return ""
        try:
            html, done = task_html(task, self._spoken_of(lesson, run))
        except KeyError:  # the learner's own run has no such method
            html, done = task_html(task, None)
        if done:
            self._together.give(self._place, met=True)
        return html

    def _question_html(self, lesson: Lesson) -> str:
        question = lesson.steps[self._step].question
        if question is None:
            return ""
        given = self._given.get(self._key)
        verdict, right = ("", False) if given is None else self._verdict(question, given)
        if right:
            self._together.give(self._place, right=True)
        return question_html(
            question, given or "", verdict, right=right, of_class=self._together.given(self._place)
        )

    def _verdict(self, question: Question, given: str) -> tuple[str, bool]:
        run = self._run_of(self._scenario())
        if run is None:
            words = Text.joined("; ", self._runner.words) or _RUNNING
            return Text('<p class="sb-muted">{words:html}</p>', words=words), False
        try:
            right = is_right(question, given, run)
        except NotANumber as error:
            unreadable = Text("{error:html}. {example}", error=error.args[0], example=_UNREADABLE)
            return Text('<p class="sb-wrong"><b>{unreadable}</b></p>', unreadable=unreadable), False
        if right:
            why = to_html(question.why, run).removeprefix("<p>")
            return Text('<p class="sb-right"><b>&#10003; Right.</b><br>{why}', why=why), True
        advice = Text("Look again: press Show me if the pictures are of something else.")
        if not question.choices:
            advice += Text(" Within {tolerance:g} % counts as right.", tolerance=100.0 * question.tolerance)
        return Text('<p class="sb-wrong"><b>&#10007; Not so.</b> {advice}</p>', advice=advice), False

    def _run_of(self, scenario: Scenario) -> Run | None:
        """Run of the step's own scenario: that on the page, or one made for the answer; None until then."""
        present = self.session.run
        if present is not None and present.scenario == scenario:
            return present
        found, runner = self._runner.result, self._runner
        if found is not None and found.scenario == scenario:
            return found
        if runner.under_way != scenario and not runner.words:
            runner.begin(scenario)
        return None

    def follow_jobs(self) -> None:
        """Judge an answer once the run of its step is there."""
        found = self._runner.result
        if found is not self._judged_by and self._lesson is not None:
            self._judged_by = found
            with self._lock:
                self._show(self.frame.editor.moved)


@lru_cache(maxsize=64)
def _scenario(lesson: int, step: int) -> Scenario:
    """Scenario of a step; it depends on the files alone."""
    return lessons()[lesson].scenario_of(step)


def spec_at(scenario: Scenario, dotted: str) -> list[FieldSpec]:
    """The control of one field of a scenario, labelled for a lesson; none if the scenario lacks it."""
    path: Path = tuple(int(part) if part.isdigit() else part for part in dotted.split("."))
    place: Any = scenario
    for depth, part in enumerate(path):
        if isinstance(place, BaseModel):
            fields = form.fields(type(place), path[:depth])
            # labels are unique on the page
            chosen = [
                replace(spec, label=Text("try: {label}", label=spec.label))
                for spec in fields
                if spec.path == path
            ]
            if chosen:
                return chosen
        try:
            place = getattr(place, part) if isinstance(part, str) else place[part]  # pyright: ignore[reportIndexIssue]
        except (AttributeError, IndexError, TypeError):
            break
    return []


VIEW = LearnView
