"""Tab "Ask": every question without a tab of its own, as a form made from its fields."""

from __future__ import annotations

from typing import Any

from navcore.engine.run import Run
from navcore.foundation.text import Text
from navcore.questions import QUESTIONS
from navcore.questions.base import Question
from schuler_bench.session.shown import Shown
from schuler_bench.shell import notices
from schuler_bench.shell.layout import TOOLS
from schuler_bench.shell.question_form import QuestionForm
from schuler_bench.shell.searching import SearchControls, reveal, show_html
from schuler_bench.shell.view import MENU, Frame, PictureView, Tab, if_user

QUESTION, ASK, STOP = Text("question"), Text("Ask"), Text("Stop")
SHOWN, PLAY = Text("shown by a scenario"), Text("Play it")
_OLD = Text("Of an earlier scenario: ask again.")
_SPACE = 40.0
"""Between the places of two forms in the tab."""


class AskView(PictureView[str]):
    """Chooser of the question, its form, and its answer."""

    title = Text("Ask")
    place = "lower"
    tab = MENU
    look_for = Text("Questions to this scenario; the answer stays until the next one.")
    always = False

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        of_views = {id for kind in frame.kinds for id in kind.asks}
        self._offered = {id: one for id, one in QUESTIONS.items() if id not in of_views}
        self._panels: dict[str, _Panel] = {}
        self._drawn: object = None
        for id in self._offered:
            frame.commands.register(f"ask-{id}", lambda _, id=id: self._panels[id].begin())

    def stands(self, run: Run) -> bool:
        """Whether a question is left for it."""
        del run
        return bool(self._offered)

    @property
    def _chosen(self) -> str:
        asked = self.session.display.asked
        return asked if asked in self._offered else next(iter(self._offered), "")

    def build(self, tab: Tab) -> None:
        """Make the chooser, and a form for each question."""
        gui = self.frame.gui
        if not self._offered:
            return
        words = {question.title: id for id, question in self._offered.items()}
        with tab:
            gui.add_html(TOOLS, order=0.0)
            self._chooser: Any = gui.add_dropdown(QUESTION, tuple(words), order=1.0)
        self._chooser.on_update(if_user(lambda: self.frame.show(asked=words[str(self._chooser.value)])))
        self._panels = {
            id: _Panel(self.frame, tab, question, _SPACE * (place + 1))
            for place, (id, question) in enumerate(self._offered.items())
        }
        self.follow_display()

    def follow_display(self) -> None:
        """Show the display's question with its values."""
        if not self._panels:
            return
        title = self._offered[self._chosen].title
        if self._chooser.value != title:
            self._chooser.value = title
        reveal((self._chooser, len(self._offered) > 1))
        for id, panel in self._panels.items():
            panel.show(chosen=id == self._chosen)

    def follow_scenario(self) -> None:
        """Say where an answer is of an earlier scenario."""
        self.follow_display()

    def follow_jobs(self) -> None:
        """Show how far the question is, or what came of it."""
        self.follow_display()

    def take_new(self) -> bool:
        """Whether an answer has just come."""
        found = [self.session.searches.asking[id].result for id in self._offered]
        new, self._drawn = found != self._drawn, found
        return new

    def picture(self, found: Shown) -> str:
        """Make the tables of the answer, HTML."""
        del found
        if not self._offered:
            return ""
        answer = self.session.searches.asking[self._chosen].result
        return "" if answer is None else answer.html()

    def show(self, picture: str) -> None:
        """Show the answer."""
        for id, panel in self._panels.items():
            panel.answer(picture if id == self._chosen else "")


class _Panel:
    """Form of one question: its controls, its button, and the place of its answer."""

    def __init__(self, frame: Frame, tab: Tab, question: type[Question], order: float) -> None:
        gui = frame.gui
        self._frame, self._session, self._question = frame, frame.session, question
        self._id: str = question.model_fields["id"].default
        self._asker = frame.session.searches.asking[self._id]
        self._form = QuestionForm(frame, tab, question, order)
        with tab:
            self._controls = SearchControls(
                gui, self._asker, self.begin, (ASK, STOP), question.help, order=order + _SPACE - 8.0
            )
            self._words: Any = gui.add_html("", visible=False, order=order + _SPACE - 4.0)
            self._answer: Any = gui.add_html("", visible=False, order=order + _SPACE - 3.0)
            hint = Text("Open the scenario in which what is chosen can be seen; undo brings this one back.")
            self._plays: Any = gui.add_dropdown(SHOWN, ("",), visible=False, order=order + _SPACE - 2.0)
            self._play: Any = gui.add_button(PLAY, hint=hint, visible=False, order=order + _SPACE - 1.0)
        self._play.on_click(if_user(self._open))

    def show(self, *, chosen: bool) -> None:
        """Show the form, and how far the question is; nothing where another one is chosen."""
        self._form.show(chosen)
        self._controls.follow(chosen)
        asked = self._asker.asked
        old = asked is not None and asked.load != self._session.scenario
        words = [*self._asker.words, *([_OLD] if old else [])]
        show_html(self._words, notices.note(words, "warning") if chosen else "")
        plays = self._asker.result.plays() if chosen and self._asker.result is not None else ()
        if plays and tuple(self._plays.options) != plays:
            self._plays.options = plays
        reveal((self._plays, bool(plays)), (self._play, bool(plays)))

    def answer(self, html: str) -> None:
        """Show the answer."""
        text = Text('<div class="sb-wide sb-table">{html}</div>', html=html) if html else ""
        show_html(self._answer, text)

    def _open(self) -> None:
        """Play what is chosen of the answer."""
        answer, what = self._asker.result, str(self._plays.value)
        if answer is not None and what in (plays := answer.plays()):
            self._frame.opening.play(answer.played(plays.index(what)), what)

    def begin(self) -> None:
        """Ask the question."""
        with notices.told(self._frame.client, self._question.title, self._frame.refresh):
            with self._session.lock:
                asked = self._question.ask({"scenario": self._session.scenario, **self._form.given()})
            self._asker.begin(asked)


VIEW = AskView
