"""The left column: a tab for each view with controls, or one for several, as folds below each other."""

from __future__ import annotations

import json
from contextlib import AbstractContextManager
from html import escape
from typing import TYPE_CHECKING, Any

from schuler_bench.shell.tabs import tab_of
from schuler_bench.shell.view import View
from schuler_bench.shell.view_faults import ViewFaults

if TYPE_CHECKING:
    import viser

    from navcore.scenario.model import Scenario


class LeftColumn:
    """Tabs of the left column, and which of their folds are open.

    A fold that holds something of a newly opened scenario is open; then its user opens and closes it
    (static/folds.js).

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    faults : ViewFaults
        Calls the methods of the views.
    """

    def __init__(self, gui: viser.GuiApi, faults: ViewFaults) -> None:
        self._gui, self._faults = gui, faults
        self._group = gui.add_tab_group(order=20)
        self._told = gui.add_html("", order=3)
        self._tabs: dict[str, viser.GuiTabHandle] = {}
        self._folds: list[View] = []
        self._opened: Scenario | None = None
        self._count = 0

    def build(self, view: View) -> None:
        """Make the place of a view in its tab, and the view's widgets in it."""
        title = tab_of(type(view))
        if title not in self._tabs:
            self._tabs[title] = self._group.add_tab(title)
        place: AbstractContextManager[Any] = self._tabs[title]
        if title != view.title:
            with place:
                place = self._gui.add_folder(view.mode or view.title, expand_by_default=True)
            self._folds.append(view)
        with place:
            self._faults.place(view)
        self._faults.call(view.build, place)

    def show(self, opened: Scenario) -> None:
        """Say which folds are open in a scenario, if it has just been opened; the views show it already."""
        if opened is self._opened:
            return
        self._opened, self._count = opened, self._count + 1
        used = json.dumps([view.title for view in self._folds if view.in_use])
        self._told.content = (
            f'<div id="sb-folds" hidden data-count="{self._count}" data-open="{escape(used)}"></div>'
        )
