"""Ways from the palette to a field's control, and to a method: they follow the scenario."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from navcore.foundation.text import Text
from schuler_bench.editing.form import FieldSpec, label_alone
from schuler_bench.shell.tabs import tab_of

if TYPE_CHECKING:
    from schuler_bench.shell.view import Frame, View

_LONGEST = 70


class Finder:
    """Offers a command for every field that a tab can show, and one for every method.

    Parameters
    ----------
    frame : Frame
        Of the page.
    """

    def __init__(self, frame: Frame) -> None:
        self._frame = frame
        self._offered: dict[str, str] = {}
        self._found: tuple[object, ...] = ()

    def show(self) -> None:
        """Offer what the session's scenario has now, where that is not what was offered before."""
        methods, views = self._frame.session.scenario.method, self._frame.views()
        found = (tuple(method.name for method in methods), tuple(tuple(view.fields()) for view in views))
        if found == self._found:
            return
        self._found = found
        wanted: dict[str, tuple[str, Callable[[], None]]] = {}
        for name, found in self._wanted():
            wanted.setdefault(name, found)  # a lesson shows fields of other tabs, too
        commands = self._frame.commands
        for name in self._offered.keys() - wanted.keys():
            commands.remove(name)
        for name, (title, act) in wanted.items():
            if self._offered.get(name) != title:
                commands.register(name, lambda _, act=act: act(), title)
        self._offered = {name: title for name, (title, _) in wanted.items()}

    def _wanted(self) -> Iterator[tuple[str, tuple[str, Callable[[], None]]]]:
        for place, method in enumerate(self._frame.session.scenario.method):
            yield f"edit-{place}", (Text("Edit {name}", name=method.name), lambda at=place: self._edit(at))
        for view in self._frame.views():
            for spec in view.fields():
                title = Text("{field} (tab {tab})", field=label_alone(spec), tab=tab_of(type(view)))
                name = f"field-{re.sub(r'[^a-z0-9]+', '-', spec.name.lower())}"[:_LONGEST]
                yield name, (title, lambda view=view, spec=spec: self._go(view, spec))

    def _edit(self, place: int) -> None:
        session = self._frame.session
        with session.lock:
            if place < len(session.scenario.method):
                session.select(place, None)
        self._frame.commands.ask_page("tab", "Method")

    def _go(self, view: View, spec: FieldSpec) -> None:
        """Bring the tab to the front and the control into sight, with the focus in its box."""
        with self._frame.session.lock:
            view.reveal(spec)
            control = next((one for one in view.controls if one.spec.path == spec.path), None)
        if control is not None:
            self._frame.commands.ask_page("field", json.dumps([view.title, control.ids[-1]]))
