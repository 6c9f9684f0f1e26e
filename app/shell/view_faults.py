"""A view that fails says so in its own tab; the page and the other views go on."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

from navcore.foundation.text import Text
from schuler_bench.jobs.words import what_failed
from schuler_bench.shell import notices

if TYPE_CHECKING:
    import viser

    from schuler_bench.shell.view import View

log = logging.getLogger(__name__)
P = ParamSpec("P")
T = TypeVar("T")


class ViewFaults:
    """Calls the methods of a page's views, and keeps what fails to the view.

    Parameters
    ----------
    client : viser.ClientHandle
        The browser.
    """

    def __init__(self, client: viser.ClientHandle) -> None:
        self._client = client
        self._places: dict[View, viser.GuiHtmlHandle] = {}
        self._faults: dict[View, dict[str, str]] = {}

    def place(self, view: View) -> None:
        """Make the place, at the top of the view's tab, where its faults are shown."""
        self._places[view] = self._client.gui.add_html(self._note(view), order=-2)

    def forget(self, view: View) -> None:
        """Forget the place of a view whose tab has been removed; its next fault is a notice."""
        self._places.pop(view, None)

    def call(self, step: Callable[P, T], *given: P.args, **named: P.kwargs) -> T | None:
        """Call a view's method; return None where it fails. Its fault is shown until the method succeeds."""
        method: Any = step
        view, name = method.__self__, method.__name__
        known = self._faults.setdefault(view, {})
        try:
            answer = step(*given, **named)
        except Exception as error:
            fault = what_failed(error)[:300]
            if known.get(name) != fault:
                log.exception("the view %r failed in %s", view.title, name)
                known[name] = fault
                self._show(view)
            return None
        if known.pop(name, None) is not None:
            self._show(view)
        return answer

    def failed(self, view: View) -> bool:
        """Whether a view has a fault now."""
        return bool(self._faults.get(view))

    def _show(self, view: View) -> None:
        if view in self._places:
            self._places[view].content = self._note(view)
        elif self._faults[view]:
            notices.tell(self._client, Text("Something went wrong"), self._faults[view].values())

    def _note(self, view: View) -> str:
        faults = tuple(dict.fromkeys(self._faults.get(view, {}).values()))
        lines = [Text("This tab failed, and may show an earlier state: {fault}", fault=f) for f in faults]
        return notices.note(lines, "error")
