"""Controls of the Pareto fronts: the two objectives, begin and stop, and what a click on a point does."""

import math
from typing import Any

from navcore.design.fronts import Pareto
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.quantities import QUANTITIES
from navcore.questions.pareto import ParetoQuestion
from schuler_bench.session.display import AXES
from schuler_bench.shell import notices
from schuler_bench.shell.searching import SearchControls, reveal, show_html
from schuler_bench.shell.view import Frame, if_user
from schuler_bench.views.tune.change import change_network
from schuler_bench.views.tune.fronts import COMMAND, nearest, setting_text

_BOXES = {one.name: one for one in ParetoQuestion.options()}
ACROSS, UP = _BOXES["x"].label, _BOXES["y"].label
FIND, STOP = Text("Find the fronts"), Text("Stop finding")
_OLD = Text("of an earlier scenario: find the fronts again")
_SO_FAR = Text("The search was stopped: these are the fronts so far.")
_CLICK = Text("Click a point to put it into the method; undo takes it back.")


class FrontsPanel:
    """Two choosers, a button, and the click on a point.

    Parameters
    ----------
    frame : Frame
        Of the page.
    """

    def __init__(self, frame: Frame) -> None:
        self.frame, self.session = frame, frame.session
        self._fronts = frame.session.searches.asking["pareto"]
        frame.commands.register(COMMAND, self._pick)

    def build(self) -> None:
        """Make the controls."""
        gui, words = self.frame.gui, {QUANTITIES[name].label: name for name in AXES}
        self._axes: dict[str, Any] = {
            "front_x": gui.add_dropdown(ACROSS, tuple(words), hint=_BOXES["x"].help),
            "front_y": gui.add_dropdown(UP, tuple(words), hint=_BOXES["y"].help),
        }
        for field, box in self._axes.items():
            box.on_update(
                if_user(lambda field=field, box=box: self.frame.show(**{field: words[str(box.value)]}))
            )
        hint = Text("Searches all networks in place of that of the selected method, in the steady state.")
        self._controls = SearchControls(gui, self._fronts, self.begin, (FIND, STOP), hint)
        self._words = gui.add_html("", visible=False)

    @property
    def objectives(self) -> tuple[str, str]:
        """Objectives on the axes."""
        return self.session.display.front_x, self.session.display.front_y

    @property
    def found(self) -> Pareto | None:
        """The last fronts, if they are of these objectives."""
        result = self._fronts.result
        return result if result is not None and result.objectives == self.objectives else None

    @property
    def note(self) -> str:
        """Note that the fronts are of an earlier scenario; empty while they fit."""
        task = self._fronts.asked
        old = self.found is not None and task is not None and not task.fits(self.session.scenario)
        return _OLD if old else ""

    @property
    def method(self) -> int:
        """Index of the method whose network the fronts would replace."""
        task = self._fronts.asked
        if self.found is None or task is None or task.method >= len(self.session.scenario.method):
            return self.session.selected
        return task.method

    def show(self, *, chosen: bool) -> None:
        """Show how far the search is; nothing while something else is chosen."""
        self._controls.follow(chosen)
        for field, box in self._axes.items():
            label = QUANTITIES[getattr(self.session.display, field)].label
            if box.value != label:
                box.value = label
        html = notices.note(self._fronts.words, "warning")
        if not html and self.found is not None:
            html = notices.note([_SO_FAR] if self.found.stopped else [], "warning") + notices.small(_CLICK)
        show_html(
            self._words, Text('<div class="sb-wide">{html}</div>', html=html) if chosen and html else ""
        )
        reveal(*((box, chosen) for box in self._axes.values()))

    def begin(self) -> None:
        """Find the fronts of the selected method."""
        session = self.session
        if self.objectives[0] == self.objectives[1]:
            axes = QUANTITIES[self.objectives[0]].label
            lines = [Text("{axes} is on both axes: choose two objectives.", axes=axes)]
            notices.tell(self.frame.client, Text("Nothing to weigh"), lines)
            return
        with session.lock:
            whole = session.display.beyond_sliders
            x, y = self.objectives
            task = ParetoQuestion(
                scenario=session.scenario, x=x, y=y, method=session.selected, beyond_sliders=whole
            )
        self._fronts.begin(task)

    def _pick(self, text: str) -> None:
        """Put the point that was clicked into the method."""
        fronts, task = self.found, self._fronts.asked
        if fronts is None or task is None:
            return
        name, point = nearest(fronts, *read_place(text))
        step = Text("{name} from the Pareto fronts", name=name)
        if change_network(self.frame, task.method, point.network, step):
            notices.tell(self.frame.client, step, [setting_text(point.network)], "info")


def read_place(text: str) -> tuple[float, float]:
    """Read ``x y``, two positive numbers.

    Raises
    ------
    InputError
        It is something else.
    """
    words = text.split()
    try:
        x, y = (float(word) for word in words)
    except ValueError:
        raise InputError(Fault("", "point", text[:60], Text("must be two numbers"))) from None
    if not (0.0 < x < math.inf and 0.0 < y < math.inf):
        raise InputError(Fault("", "point", text[:60], Text("must be two positive numbers")))
    return x, y
