"""Tab "Requirements": limits of the scenario as numbers, and who meets them, in this run and over seeds."""

import threading
from collections.abc import Callable
from dataclasses import replace

from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from navcore.quantities import QUANTITIES
from navcore.scenario.model import Scenario
from schuler_bench.editing.limits import BOXES, FROM, from_text, label_of, limit_text, with_begin, with_limit
from schuler_bench.session.shown import Shown
from schuler_bench.shell import notices
from schuler_bench.shell.control import Widget
from schuler_bench.shell.view import Frame, PictureView, Tab, if_user
from schuler_bench.views.requirements.table import requirements_html

_GRID = '<div class="sb-limits"></div>'
_UNFINISHED_S = 1.2
"""A wrong text is only refused when it stays: it may be on the way to a right one."""


class RequirementsView(PictureView[str]):
    """Boxes for the limits above the table of verdicts."""

    title = Text("Requirements")
    place = "lower"
    look_for = Text("Give limits in the boxes: the table says who meets them, and the plots show the limits.")

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._doubts: dict[str, threading.Timer] = {}
        self._judge = frame.session.searches.judge
        self._drawn: object = None

    def build(self, tab: Tab) -> None:
        """Make the boxes."""
        gui = self.frame.gui
        self._held = self.session.scenario
        self._boxes: dict[str, Widget] = {}
        with tab:
            gui.add_html(_GRID)
            for key in BOXES:
                hint = Text(
                    "{help} A number; empty: no requirement. A limit on errors counts from the time in the "
                    "last box.",
                    help=QUANTITIES[key].help,
                )
                self._boxes[key] = Widget(gui.add_text(label_of(key), limit_text(self._held, key), hint=hint))
            hint = Text("Errors before this time of the run do not count for any limit.")
            self._boxes[FROM] = Widget(gui.add_text(FROM, from_text(self._held), hint=hint))
            for key, box in self._boxes.items():
                box.handle.on_update(if_user(lambda key=key: self._typed(key)))
            self._note = gui.add_html("")
            self._seeds = gui.add_html("")
            self._table = gui.add_html("")

    def follow_scenario(self) -> None:
        """Show the scenario's limits where they have changed; what is being typed stays as it is."""
        before, self._held = self._held, self.session.scenario
        for key, box in self._boxes.items():
            text = _text(self._held, key)
            if key not in self._doubts and _text(before, key) != text:
                box.show(text)

    def follow_jobs(self) -> None:
        """Say why the seeds are not judged."""
        words = notices.note(self._judge.words, "warning")
        if self._seeds.content != words:
            self._seeds.content = words

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
        return requirements_html(found.run, pins, odds=odds)

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
            self._judge.follow(run.scenario)

    def _typed(self, key: str) -> None:
        with self.session.lock:
            timer = self._doubts.pop(key, None)
            if timer is not None:
                timer.cancel()
            text = self._boxes[key].take()
            try:
                changed = _change(key)(self.session.scenario, text)
            except InputError as error:
                timer = self._doubts[key] = threading.Timer(_UNFINISHED_S, self._refuse, (key, text, error))
                timer.daemon = True
                timer.start()
                return
            self._note.content = ""
            self._held = changed
            label = FROM if key == FROM else label_of(key)
            self.session.change(changed, self, name=Text("limit {label}", label=label))

    def _refuse(self, key: str, text: str, error: InputError) -> None:
        with self.session.lock:
            if self._doubts.pop(key, None) is None or self._boxes[key].handle.value != text:
                return
            kept = _text(self._held, key)
            self._boxes[key].show(kept)
            said = kept or Text("no requirement")
            lines = [
                Text("{label_of}: {refusal}", label_of=fault.field, refusal=notices.refusal(fault, said))
                for fault in error.faults
            ]
            self._note.content = notices.note(lines, "error")


def _change(key: str) -> Callable[[Scenario, str], Scenario]:
    return with_begin if key == FROM else lambda scenario, text: with_limit(scenario, key, text)


def _text(scenario: Scenario, key: str) -> str:
    return from_text(scenario) if key == FROM else limit_text(scenario, key)


VIEW = RequirementsView
