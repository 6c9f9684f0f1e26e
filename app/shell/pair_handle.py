"""The handle in a plot with which the pole pair of the edited method is dragged to where it is wanted."""

from collections.abc import Callable, Sequence
from typing import Any, Literal

from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from schuler_bench.bridge.controls import id_of
from schuler_bench.editing.placing import Block, handle_of, read_drag, with_nearest_pair
from schuler_bench.plots import style
from schuler_bench.session.requirements import limits_of
from schuler_bench.session.shown import Shown
from schuler_bench.shell import notices
from schuler_bench.shell.view import Frame

PAIR_HANDLE = "pair handle"
"""Label of the hidden control that receives the place of the handle (static/handle.js)."""
Kind = Literal["poles", "bode"]
"""Axes of the plot: real and imaginary part in units of omega_s, or frequency and damping."""


class PairHandle:
    """Takes what a dragged handle says; a figure carries in its ``meta`` where the handle stands.

    The page sends the newest place through a control of its own, as it sends that of a slider.

    Parameters
    ----------
    frame : Frame
        Of the page.
    kind : {"poles", "bode"}
        What the axes of the plot are.
    panels : sequence of (str, str)
        Names of the axes of each panel that has the handle.
    block : callable, optional
        Gives the network of the method whose pair it is.
    """

    def __init__(
        self,
        frame: Frame,
        kind: Kind,
        panels: Sequence[tuple[str, str]],
        block: Callable[[], Block] = lambda: "network",
    ) -> None:
        self._frame, self._kind, self._panels, self._block = frame, kind, panels, block
        self._control: Any = None
        self._announced = ""

    def build(self) -> None:
        """Make the control, in the present container."""
        self._control = self._frame.gui.add_text(PAIR_HANDLE, "", visible=False)
        self._control.on_update(lambda _: self.take(self._control.value))

    def meta(self, sources: Shown) -> dict[str, Any]:
        """Description of the handle in a figure's ``meta``."""
        run, selected = sources.run, sources.selected
        handle = handle_of(run.scenario, selected, self._block())
        note = {"told": handle.pop("told", "")}
        where = {
            "control": id_of(self._control),
            "kind": self._kind,
            "panels": [list(names) for names in self._panels],
            "color": style.method_color(run.methods[min(selected, len(run.methods) - 1)].place),
        }
        return note | {"handle": where | handle}

    def take(self, text: str) -> None:
        """Place the pair where the handle is; what could not be met is reported at the end of a drag."""
        drag, session, client = read_drag(text), self._frame.session, self._frame.client
        if drag is None:
            return
        gesture = f"{id_of(self._control)} {drag.gesture}"
        words = lines = None
        with session.lock:
            if drag.method != session.selected:
                return
            try:
                limit = limits_of(session.scenario.requirement).get("h_slope_s")
                placed = with_nearest_pair(
                    session.scenario, drag.method, drag.damping_ratio, drag.ratio, limit, self._block()
                )
            except InputError as error:
                words, lines = Text("The pair was not placed"), notices.fault_lines(error)
            else:
                name = session.scenario.method[drag.method].name
                self._frame.editor.drag(
                    placed.scenario, Text("placing the pair of {name}", name=name), gesture
                )
                if placed.note:
                    words, lines = Text("Placed in part"), [placed.words, placed.note]
        if drag.ends and words and lines and self._announced != gesture:
            self._announced = gesture
            notices.tell(client, words, lines, "warning")
            client.flush()
