"""Tab "Requirements": limits as numbers, and who meets them."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

from app.page import notices
from app.page.layout import Layout
from app.panels.workbench import Tools
from app.session.display import Display
from app.session.requirements import Requirements, label_of, read_limit
from navcore.errors import InputError
from navcore.parameters import allowed_range

if TYPE_CHECKING:
    import viser

REQUIREMENTS = "Requirements"
_GRID = '<div class="sb-limits"></div>'
_UNFINISHED_S = 1.2
"""A wrong text is only refused when it stays: it may be on the way to a right one."""


class RequirementsPanel:
    """Boxes for the limits above the table of verdicts.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    tab : viser.GuiTabHandle
        Where it stands.
    layout : Layout
        Sizes.
    display : Display
        Whose requirements are shown first.
    tools : Tools
        ``tools.show(requirements=...)`` takes a changed one.
    """

    def __init__(
        self, gui: viser.GuiApi, tab: viser.GuiTabHandle, layout: Layout, display: Display, tools: Tools
    ) -> None:
        self._tools, self._layout = tools, layout
        self._lock = threading.Lock()
        self._held = display.requirements
        self._doubts: dict[str, threading.Timer] = {}
        self._boxes: dict[str, viser.GuiTextHandle] = {}
        with tab:
            gui.add_html(_GRID)
            for name, info in Requirements.model_fields.items():
                hint = f"{info.description} A number, {allowed_range(info)}; empty: no requirement."
                box = gui.add_text(label_of(name), _text(getattr(self._held, name)), hint=hint)
                box.on_update(lambda event, name=name: self._typed(name) if event.client else None)
                self._boxes[name] = box
            self._note = gui.add_html("")
            self._table = gui.add_html("")

    def follow(self, display: Display) -> None:
        """Show the display's limits where they have changed; what is being typed stays as it is."""
        with self._lock:
            before, self._held = self._held, display.requirements
            fresh = [
                name
                for name in self._boxes
                if name not in self._doubts and getattr(before, name) != getattr(self._held, name)
            ]
        for name in fresh:
            self._boxes[name].value = _text(getattr(self._held, name))

    def show(self, table: str) -> None:
        """Show the verdicts."""
        narrow = "" if self._layout.wide else " sb-narrow"
        self._table.content = (
            f'<div class="sb-table sb-verdicts{narrow}" style="padding:4px 10px">{table}</div>'
        )

    def _typed(self, name: str) -> None:
        with self._lock:
            timer = self._doubts.pop(name, None)
            if timer is not None:
                timer.cancel()
            text = self._boxes[name].value
            try:
                value = read_limit(name, text)
            except InputError as error:
                timer = self._doubts[name] = threading.Timer(_UNFINISHED_S, self._refuse, (name, text, error))
                timer.daemon = True
                timer.start()
                return
            changed = Requirements.model_validate(self._held.model_dump() | {name: value})
            self._held = changed
        self._note.content = ""
        self._tools.show(requirements=changed)

    def _refuse(self, name: str, text: str, error: InputError) -> None:
        with self._lock:
            if self._doubts.pop(name, None) is None or self._boxes[name].value != text:
                return
        kept = _text(getattr(self._held, name)) or "no requirement"
        self._boxes[name].value = _text(getattr(self._held, name))
        lines = [f"{label_of(name)}: {notices.refusal(fault, kept)}" for fault in error.faults]
        self._note.content = notices.note(lines, "error")


def _text(value: float | None) -> str:
    return "" if value is None else f"{value:.6g}"
