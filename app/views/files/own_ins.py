"""Part of the tab "Files": what uploaded files are of a ship's own INS, and one button that damps it."""

from __future__ import annotations

from typing import Any

from navcore.engine.run import Run
from navcore.foundation.text import Text
from schuler_bench.plots.table import cell, row, table
from schuler_bench.session.own_ins import JUDGED, Taken, best, described, sentence, taken
from schuler_bench.shell import notices
from schuler_bench.shell.view import Frame, if_user

TITLE = Text("My ship's INS")
_TOLD = Text(
    "Upload the output of the ship's INS, its speed log and, if there is one, a GNSS track: damping is laid "
    "on the output from outside. No gyro data is needed."
)
_GIVE = Text("Download the damped output")
_GIVE_HINT = Text("The INS's own files, with what the method of the sentence above would have given out.")
_SAIL = Text("A voyage like mine")
_SAIL_HINT = Text(
    "A simulated voyage with the legs of this one and a log that errs like yours, on which methods can be "
    "designed and tuned. The sensors are those that you choose then; Undo brings the recording back."
)
_EXCHANGE = Text("The other way round: output and reference exchanged.")


class OwnIns:
    """Shows the parts of a ship's own INS among the uploads, runs on them, and says what came out.

    Parameters
    ----------
    frame : Frame
        Of the page.
    """

    def __init__(self, frame: Frame) -> None:
        self._frame, self._session = frame, frame.session
        self._run: Run | None = None

    def build(self, order: float) -> None:
        """Make the widgets."""
        gui = self._frame.gui
        gui.add_html(notices.heading(TITLE), order=order)
        gui.add_html(notices.small(_TOLD), order=order + 0.1)
        self._parts = gui.add_html("", order=order + 0.2)
        self._exchange: Any = gui.add_checkbox(
            Text("exchange output and reference"), False, hint=_EXCHANGE, order=order + 0.3, visible=False
        )
        self._damp = gui.add_button(Text("Damp my INS"), color="gray", order=order + 0.4, visible=False)
        words = tuple(words for words, _ in JUDGED.values())
        self._judge: Any = gui.add_dropdown(
            Text("best by"),
            words,
            order=order + 0.5,
            visible=False,
            hint=Text("What the best method is chosen by."),
        )
        self._sentence = gui.add_html("", order=order + 0.6)
        self._give: Any = gui.add_button(
            _GIVE, color="gray", order=order + 0.7, visible=False, hint=_GIVE_HINT
        )
        self._give.on_click(lambda _: self._give_damped())
        self._sail: Any = gui.add_button(
            _SAIL, color="gray", order=order + 0.8, visible=False, hint=_SAIL_HINT
        )
        self._sail.on_click(lambda _: self._frame.opening.sail_like())
        self._exchange.on_update(if_user(self.follow))
        self._judge.on_update(if_user(self._say))
        self._damp.on_click(lambda _: self._frame.opening.damp_ins(self._roles()))

    def _roles(self) -> Taken:
        roles = taken(self._session.uploads)
        return roles.exchanged() if self._exchange.value and roles.truth else roles

    def follow(self) -> None:
        """Show what the uploads are taken for."""
        uploads = self._session.uploads
        roles = self._roles()
        if not uploads.files:
            self._parts.content = ""
        else:
            rows = [row([cell(what), cell(names)]) for what, names in described(uploads, roles)]
            note = notices.small(roles.missing) if roles.missing else ""
            self._parts.content = Text("{table}{note}", table=table((), rows), note=note)
        self._exchange.visible = bool(roles.truth)
        self._damp.visible = bool(uploads.files) and not roles.missing
        self._say()

    def draw(self, run: Run) -> None:
        """Take the run that is shown."""
        self._run = run
        self._say()

    @property
    def _key(self) -> str:
        """Quantity by which the best method is chosen."""
        chosen = (key for key, (words, _) in JUDGED.items() if words == self._judge.value)
        return next(chosen, next(iter(JUDGED)))

    def _give_damped(self) -> None:
        """Let the browser save the output as the best method would have damped it."""
        run = self._run
        method = None if run is None else best(run, self._key)
        if run is not None and method is not None:
            self._frame.opening.give_damped(run, method)

    def _say(self) -> None:
        run = self._run
        told = run is not None and run.against is not None
        self._judge.visible = told
        said = sentence(run, self._key) if run is not None and told else ""
        self._give.visible = self._sail.visible = bool(said)
        self._sentence.content = notices.note((said,), "info") if said else ""
