"""Button of Requirements (tab Limits) that makes the verification report and saves it."""

from typing import Any

from navcore.foundation.text import Text
from navcore.questions.report import ReportQuestion
from navcore.scenario.clauses import clause_sets
from schuler_bench.shell import notices
from schuler_bench.shell.searching import SearchControls
from schuler_bench.shell.view import Frame

REPORT, STOP = Text("Verification report (HTML)"), Text("Stop")
CLAUSES, OWN = Text("clauses"), Text("this table")
_CLAUSES_HINT = Text(
    "A ready set adds its clauses to the report: each is tested in the scenario that its standard prescribes."
)
_REPORT_HINT = Text(
    "Every limit on every method by 200 seeds, with the error budget and the worst case, as one file that "
    "prints on A4; as schuler report writes it."
)


class ReportButton:
    """Chooser of the clauses, button, and progress; the file is saved once it is made.

    Parameters
    ----------
    frame : Frame
        Of the page.
    """

    def __init__(self, frame: Frame) -> None:
        self._frame = frame
        self._asker = frame.session.searches.asking["report"]
        self._wanted: object = None
        self._clauses: Any = frame.gui.add_dropdown(CLAUSES, (OWN, *clause_sets()), hint=_CLAUSES_HINT)
        self._controls = SearchControls(frame.gui, self._asker, self._begin, (REPORT, STOP), _REPORT_HINT)

    @property
    def words(self) -> tuple[str, ...]:
        """Why there is no report."""
        return self._asker.words

    def follow(self) -> None:
        """Show how far the report is, and save the one that was asked for here."""
        self._controls.follow()
        asked = self._asker.asked
        if asked is None or asked is not self._wanted or self._asker.result is None:
            return
        self._wanted = None
        for name, text in asked.texts(self._asker.result).items():
            self._frame.client.send_file_download(name, text.encode(), save_immediately=True)
        self._frame.client.flush()

    def _begin(self) -> None:
        """Make the report of the present scenario."""
        frame, chosen = self._frame, str(self._clauses.value)
        with notices.told(frame.client, Text("The report cannot be made"), frame.refresh):
            with frame.session.lock:
                given = {} if chosen == OWN else {"clauses": chosen}
                asked = ReportQuestion.ask({"scenario": frame.session.scenario, **given})
            self._wanted = asked
            self._asker.begin(asked)
