"""Which text boxes of a page hold numbers, said to its scripts (static/boxes.js).

viser's number box edits what is typed before the server sees it: over a selection ``-0.02`` becomes 0.02, and
``1e-3`` becomes -13. A box for a number is therefore a text box, whose text the server reads. viser's text
box has no attributes: an element beside it says what it is for.
"""

import json
from html import escape
from typing import Any

import viser

from schuler_bench.bridge.controls import id_of

_KEPT = "_schuler_number_boxes"
"""Where a page's marks are kept with its widgets."""
LIST = 0.0
"""Step of a box that holds several numbers: the arrow keys do not step it."""


class NumberBoxes:
    """Marks of one page.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client; the hidden element goes into its present container.
    """

    def __init__(self, gui: viser.GuiApi) -> None:
        self._gui: Any = gui
        self._steps: dict[str, float] = {}
        self._element = gui.add_html("", order=3)
        setattr(gui, _KEPT, self)

    def add(self, handle: Any, step: float) -> None:
        """Mark a box; those that have been removed are forgotten."""
        known = self._gui._gui_input_handle_from_uuid
        steps = {id: its for id, its in list(self._steps.items()) if id in known} | {id_of(handle): step}
        self._steps = steps
        self._element.content = f'<div id="sb-numbers" hidden data-boxes="{escape(json.dumps(steps))}"></div>'


def mark_number_box(gui: viser.GuiApi, handle: Any, step: float) -> None:
    """Let the page's scripts treat a text box as one for a number.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client. Without marks of its page nothing happens.
    handle : viser.GuiInputHandle
        The text box.
    step : float
        By which the arrow keys change its number; `LIST` for several numbers.
    """
    marks: NumberBoxes | None = getattr(gui, _KEPT, None)
    if marks is not None:
        marks.add(handle, step)
