"""Tab "Requirements": limits of the scenario as numbers, and who meets them, in this run and over seeds."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace

from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.editing.limits import (
    BOXES,
    DETAILS,
    FROM,
    detail_label,
    detail_text,
    from_text,
    label_of,
    limit_text,
    with_begin,
    with_detail,
    with_limit,
)
from schuler_bench.session.shown import Shown
from schuler_bench.shell import notices
from schuler_bench.shell.view import Frame, PictureView, Tab
from schuler_bench.views.requirements.report_button import ReportButton
from schuler_bench.views.requirements.table import requirements_html


class RequirementsView(PictureView[str]):
    """Table of verdicts, with a box for each limit."""

    title = Text("Requirements")
    place = "lower"
    tab = Text("Limits")
    look_for = Text("Type limits into the table: it says who meets them, and the plots show them.")
    asks = ("report",)

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._refused: Counter[str] = Counter()
        self._judge = frame.session.searches.judge
        self._drawn: object = None
        frame.commands.register("limit", self._typed)

    def build(self, tab: Tab) -> None:
        """Make the places of notes and table."""
        gui = self.frame.gui
        with tab:
            self._note = gui.add_html("")
            self._seeds = gui.add_html("")
            self._table = gui.add_html("")
            self._report = ReportButton(self.frame)

    def follow_scenario(self) -> None:
        """Offer the report where there are limits."""
        self.follow_jobs()

    def follow_jobs(self) -> None:
        """Say why the seeds are not judged, and how far the report is; save it once it is made."""
        words = notices.note((*self._judge.words, *self._report.words), "warning")
        if self._seeds.content != words:
            self._seeds.content = words
        self._report.follow()

    def take_new(self) -> bool:
        """Whether more seeds have just been judged."""
        if self._judge.known is self._drawn:
            return False
        self._drawn = self._judge.known
        return True

    def picture(self, found: Shown) -> str:
        """Make the table of verdicts, HTML."""
        pins = [replace(pin, run=pin.run) for pin in found.pins if pin.run is not None]
        odds = [self._judge.odds(found.run.scenario, one.method) for one in found.run.methods]
        return requirements_html(found.run, pins, odds=odds, boxes=self._refused)

    def show(self, picture: str) -> None:
        """Show the verdicts, and have the seeds judged."""
        narrow = "" if self.frame.layout().wide else " sb-narrow"
        self._table.content = Text(
            '<div class="sb-table sb-verdicts{narrow}" style="padding:4px 10px">{picture}</div>',
            narrow=narrow,
            picture=picture,
        )
        run = self.session.run
        if run is not None:
            self._judge.judge(run.scenario)

    def _typed(self, argument: str) -> None:
        """Take over a limit as typed: its key and a number, or nothing."""
        key, _, text = argument.partition(" ")
        box = _box_of(key)
        if box is None:
            return
        label = box.label
        with self.session.lock:
            scenario = self.session.scenario
            try:
                changed = box.changed(scenario, text)
            except InputError as error:
                kept = box.text(scenario)
                said = kept or Text("no requirement")
                lines = [
                    Text("{label_of}: {refusal}", label_of=fault.field, refusal=notices.refusal(fault, said))
                    for fault in error.faults
                ]
                self._note.content = notices.note(lines, "error")
                self._refused[key] += 1
            else:
                self._note.content = ""
                self.session.change(changed, self, name=Text("limit {label}", label=label))
                return
        self.frame.redraw()


@dataclass(frozen=True)
class _Box:
    """A box of the table: its label, its text in a scenario, and the scenario with another text."""

    label: str
    text: Callable[[Scenario], str]
    changed: Callable[[Scenario, str], Scenario]


def _box_of(name: str) -> _Box | None:
    """Box by its name: ``from``, a quantity, or a quantity and a field of its block; None for no box."""
    key, _, field = name.partition(".")
    if name == "from":
        return _Box(FROM, from_text, with_begin)
    if key not in BOXES:
        return None
    if not field:
        return _Box(
            label_of(key), lambda now: limit_text(now, key), lambda now, text: with_limit(now, key, text)
        )
    if field not in DETAILS or not DETAILS[field].allowed(key):
        return None
    return _Box(
        detail_label(key, field),
        lambda now: detail_text(now, key, field),
        lambda now, text: with_detail(now, key, field, text),
    )


VIEW = RequirementsView
