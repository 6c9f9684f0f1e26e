"""Tab "Requirements": limits as numbers, and who meets them."""

import threading
from dataclasses import replace

from navcore.foundation.errors import InputError
from navcore.foundation.parameters import allowed_range
from navcore.foundation.text import Text
from schuler_bench.session.requirements import Requirements, label_of, read_limit
from schuler_bench.session.shown import Shown, window_of
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

    def build(self, tab: Tab) -> None:
        """Make the boxes."""
        gui = self.frame.gui
        self._held = self.session.display.requirements
        self._boxes: dict[str, Widget] = {}
        with tab:
            gui.add_html(_GRID)
            for name, info in Requirements.model_fields.items():
                hint = Text(
                    "{description} A number, {allowed_range}; empty: no requirement.",
                    description=info.description,
                    allowed_range=allowed_range(info),
                )
                box = gui.add_text(label_of(name), _text(getattr(self._held, name)), hint=hint)
                box.on_update(if_user(lambda name=name: self._typed(name)))
                self._boxes[name] = Widget(box)
            self._note = gui.add_html("")
            self._table = gui.add_html("")

    def follow_display(self) -> None:
        """Show the display's limits where they have changed; what is being typed stays as it is."""
        before, self._held = self._held, self.session.display.requirements
        for name, box in self._boxes.items():
            if name not in self._doubts and getattr(before, name) != getattr(self._held, name):
                box.show(_text(getattr(self._held, name)))

    def picture(self, found: Shown) -> str:
        """Make the table of verdicts, HTML."""
        window = window_of(found.run, found.display)
        note = notices.note([window.told] if window.told else [], "info" if window.possible else "warning")
        pins = [replace(pin, run=window.of(pin.run)) for pin in found.pins if pin.run is not None]
        return note + requirements_html(window.run, found.display.requirements, pins)

    def show(self, picture: str) -> None:
        """Show the verdicts."""
        narrow = "" if self.frame.layout().wide else " sb-narrow"
        self._table.content = Text(
            '<div class="sb-table sb-verdicts{narrow}" style="padding:4px 10px">{picture}</div>',
            narrow=narrow,
            picture=picture,
        )

    def _typed(self, name: str) -> None:
        with self.session.lock:
            timer = self._doubts.pop(name, None)
            if timer is not None:
                timer.cancel()
            text = self._boxes[name].take()
            try:
                value = read_limit(name, text)
            except InputError as error:
                timer = self._doubts[name] = threading.Timer(_UNFINISHED_S, self._refuse, (name, text, error))
                timer.daemon = True
                timer.start()
                return
            self._note.content = ""
            self._held = Requirements.model_validate(self._held.model_dump() | {name: value})
            self.frame.show(requirements=self._held)

    def _refuse(self, name: str, text: str, error: InputError) -> None:
        with self.session.lock:
            if self._doubts.pop(name, None) is None or self._boxes[name].handle.value != text:
                return
            self._boxes[name].show(_text(getattr(self._held, name)))
            kept = _text(getattr(self._held, name)) or Text("no requirement")
            lines = [
                Text("{label_of}: {refusal}", label_of=label_of(name), refusal=notices.refusal(fault, kept))
                for fault in error.faults
            ]
            self._note.content = notices.note(lines, "error")


def _text(value: float | None) -> str:
    return "" if value is None else f"{value:.6g}"


VIEW = RequirementsView
