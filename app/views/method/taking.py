"""In the tab "Method", below the controls: the equations in force, and the law as files of code (ZIP)."""

from typing import Any

from navcore.exporting.equations import Equation, equations_of
from navcore.foundation.text import Text
from navcore.questions.export import ExportQuestion
from schuler_bench.shell import notices
from schuler_bench.shell.question_form import QuestionForm
from schuler_bench.shell.searching import SearchControls, reveal, show_html
from schuler_bench.shell.view import Frame, Tab
from schuler_bench.views.learn.lessons import formula_html

COPY_LATEX, COPY_TEXT = "copy-equations-latex", "copy-equations-text"
"""Commands that put the equations on the clipboard."""
EXPORT, STOP = Text("Download (ZIP)"), Text("Stop")
_EQUATIONS, _FILES = Text("Equations with these numbers"), Text("Law for a navigation computer")
_COPY = {COPY_LATEX: Text("copy as LaTeX"), COPY_TEXT: Text("copy as text")}
_HINT = Text(
    "Writes the files of schuler export for this method: the law as code, with test vectors of 24 h of this "
    "scenario. They are yours."
)
_GIVEN = ("method", "as_archive")
_DIGITS = 6
"""Significant digits of the numbers on the page; what is copied has all."""


class TakingPanel:
    """Folders with the equations of the selected method, and with the form of its export.

    Parameters
    ----------
    frame : Frame
        Of the page.
    tab : context manager
        Where they stand.
    order : float
        Place in the tab.
    """

    def __init__(self, frame: Frame, tab: Tab, order: float) -> None:
        gui = frame.gui
        self._frame, self._session = frame, frame.session
        self._asker = frame.session.searches.asking["export"]
        self._wanted: object = None
        self._listed: object = None
        with tab:
            self._equations = gui.add_folder(_EQUATIONS, order=order, expand_by_default=False)
            self._files = gui.add_folder(_FILES, order=order + 1.0, expand_by_default=False)
        with self._equations:
            self._formulas: Any = gui.add_html("")
        self._form = QuestionForm(frame, self._files, ExportQuestion, 1.0, without=_GIVEN)
        with self._files:
            gui.add_html(notices.small(_HINT), order=0.0)
            self._controls = SearchControls(gui, self._asker, self.begin, (EXPORT, STOP), _HINT, order=20.0)
            self._words: Any = gui.add_html("", visible=False, order=23.0)
            self._said: Any = gui.add_html("", visible=False, order=24.0)

    def draw(self) -> None:
        """Show the equations of the selected method; remove the list of an archive that holds another law."""
        if self._listed != self._law():
            show_html(self._said, "")
        found = self._found(_DIGITS)
        reveal((self._equations, bool(found)))
        if found:
            show_html(self._formulas, equations_html(found))

    def _law(self) -> tuple[object, int]:
        return self._session.scenario, self._session.selected

    def copied(self, write: Any) -> str:
        """Return the equations with all digits, written by `as_latex` or `as_text`."""
        return write(self._found(None))

    def _found(self, digits: int | None) -> tuple[Equation, ...]:
        scenario = self._session.scenario
        return equations_of(scenario, scenario.method[self._session.selected], digits)

    def follow(self) -> None:
        """Show the form and how far the export is; save the one that was asked for here."""
        self._form.show(known={"rate": 1.0 / self._session.scenario.law_step_s})
        self._controls.follow()
        asker = self._asker
        show_html(self._words, notices.note(asker.words, "warning"))
        if asker.asked is not None and asker.asked is self._wanted and asker.result is not None:
            self._save()

    def begin(self) -> None:
        """Export the selected method; what has just been exported is saved again."""
        frame, session = self._frame, self._session
        with notices.told(frame.client, Text("The method cannot be exported"), frame.refresh):
            with session.lock:
                scenario = session.scenario
                method = scenario.method[session.selected].label()
                given = {**self._form.given(), "method": method, "as_archive": True}
                asked = ExportQuestion.ask({"scenario": scenario, **given})
            if self._asker.beside(asked) is not None:
                self._save()
                return
            self._wanted = asked
            show_html(self._said, "")
            self._asker.begin(asked)

    def _save(self) -> None:
        """Let the browser save the archive, and tell what it holds."""
        self._wanted, found = None, self._asker.result
        if found is None:  # forgotten meanwhile
            return
        self._listed = self._law()
        show_html(self._said, Text('<div class="sb-wide sb-table">{html}</div>', html=found.html()))
        client = self._frame.client
        client.send_file_download(found.name, found.archive, save_immediately=True)
        client.flush()


def equations_html(equations: tuple[Equation, ...]) -> str:
    """Return equations as MathML, each below what it says, and the buttons that copy them."""
    shown = (
        Text(
            '<div class="sb-equation"><small>{about:html}</small>{formula}</div>',
            about=one.about,
            formula=formula_html(one.latex, block=True),
        )
        for one in equations
    )
    buttons = (
        Text('<button class="sb-do" data-command="{name}">{words:html}</button>', name=name, words=words)
        for name, words in _COPY.items()
    )
    units = Text("s in rad/s; velocities in m/s")
    return Text(
        '<div class="sb-equations">{shown}<p><small>{units:html}</small></p><p>{buttons}</p></div>',
        shown=Text.joined("", shown),
        units=units,
        buttons=Text.joined(" ", buttons),
    )
