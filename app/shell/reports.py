"""Hidden elements and controls by which page and server tell each other what they show."""

from __future__ import annotations

import hashlib
import json
import re
import threading
from collections.abc import Callable, Sequence
from html import escape
from typing import TYPE_CHECKING

from navcore.engine.measures import metrics
from navcore.engine.run import Run
from schuler_bench.bridge.controls import id_of
from schuler_bench.shell.layout import Window, read_state
from schuler_bench.shell.opening import as_json
from schuler_bench.shell.tabs import told
from schuler_bench.shell.view import View

if TYPE_CHECKING:
    import viser

PAGE_STATE = "page state"
"""Label of the control through which the page reports its size and front tabs (static/page.js)."""

PAGE_PAINTED = "page painted"
"""Label of the control through which the page says which picture it has painted (static/drawn.js)."""


class Reports:
    """The two controls that the page's own scripts fill in.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the page.
    on_window : callable
        ``on_window(window, front, report)``, as `read_state` gives the first two; and the report itself.
    on_painted : callable
        ``on_painted(picture, moving=...)``: it has painted this picture, and whether a slider moves.

    Attributes
    ----------
    window_id, painted_id : str
        Ids of the two controls.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        on_window: Callable[[Window, dict[str, int], str], None],
        on_painted: Callable[..., None],
    ) -> None:
        self._on_window, self._on_painted = on_window, on_painted
        self._came = threading.Event()
        self._window = gui.add_text(PAGE_STATE, "", order=1)
        self._window.on_update(lambda _: self._take_window())
        self._painted = gui.add_text(PAGE_PAINTED, "", order=1)
        self._painted.on_update(lambda _: self._take_painted())
        self.window_id, self.painted_id = id_of(self._window), id_of(self._painted)

    def wait_for_window(self, timeout_s: float) -> bool:
        """Block until the page has told of its window; False after the timeout."""
        return self._came.wait(timeout_s)

    def _take_window(self) -> None:
        report = self._window.value.strip()
        window, front = read_state(report)
        if window is not None:
            self._on_window(window, front, report)
            self._came.set()

    def _take_painted(self) -> None:
        match = re.fullmatch(r"([0-9]{1,9}) ([01])", self._painted.value)
        if match is not None:
            self._on_painted(int(match[1]), moving=match[2] == "1")


def run_element(run: Run, number: int) -> str:
    """Return HTML with the run's number, its status, a digest of its methods and its metrics as JSON."""
    digest = hashlib.blake2b(digest_size=16)
    for method in run.methods:
        digest.update(method.fingerprint)
    return (
        f'<div id="sb-run" hidden data-run="{number}" data-status="{run.status}" '
        f'data-digest="{digest.hexdigest()}">{escape(as_json(metrics(run)).decode())}</div>'
    )


def view_names(kinds: Sequence[type[View]]) -> dict[str, str]:
    """Names for ``?view=`` -> titles of the tabs of results; "" for what stands beside the tabs.

    A scenario's block ``view`` uses the same names for the tabs.
    """
    results = [kind for kind in kinds if kind.place in ("upper", "lower")]
    beside = [name for kind in kinds for name in kind.alone]
    return {kind.focus or kind.title.lower(): kind.title for kind in results} | dict.fromkeys(beside, "")


def views_element(kinds: Sequence[type[View]]) -> str:
    """HTML that tells the page's scripts these names, and in which tab each view stands, in their order."""
    names, tabs = escape(json.dumps(view_names(kinds))), escape(json.dumps(told(kinds)))
    return f'<div id="sb-views" hidden data-names="{names}" data-tabs="{tabs}"></div>'
