"""The panel that explains the control in hand; static/learn.js asks for it and shows it over the 3D view."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from app.learn.explain import explain_html, told_html
from app.page.commands import Commands
from app.panels.control import Control
from app.session.session import Session

if TYPE_CHECKING:
    import viser

COMMAND = "explain"
"""``explain ID``: the control with that id in the page."""
_NONE_YET = "Point at a control, or put the focus on it, and press E or F1, or press the ? beside its name."


class ExplainPanel:
    """Answers the command `COMMAND`.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    session : Session
        Whose scenario is edited.
    commands : Commands
        Where the command is registered.
    controls : callable
        Gives all controls of fields on the page.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        session: Session,
        commands: Commands,
        controls: Callable[[], Iterable[Control]],
    ) -> None:
        self._gui, self._session, self._controls = gui, session, controls
        self._count = 0
        self._html = gui.add_html("", order=4)
        commands.register(COMMAND, self.explain, "Explain the control under the pointer", "E", watcher=True)

    def explain(self, id: str) -> None:
        """Explain the control with this id; say how to ask when there is none."""
        with self._session.lock:
            content = self._content(id.strip())
            self._count += 1
            self._html.content = f'<div id="sb-explained" hidden data-count="{self._count}">{content}</div>'

    def _content(self, id: str) -> str:
        control = next((c for c in self._controls() if id in c.ids()), None)
        if control is not None:
            return explain_html(control.spec, self._session.scenario)
        handle = self._gui._gui_input_handle_from_uuid.get(id)
        label = getattr(handle, "label", None)
        if label is None:
            return told_html("Explain", _NONE_YET)
        return told_html(str(label), str(getattr(handle, "hint", None) or "Press it and see."))
