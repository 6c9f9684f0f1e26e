"""The panel that explains the selected control; app/views/learn/learn.js asks for it."""

from __future__ import annotations

from app.bridge.controls import control_with
from app.shell.view import Frame, Tab, View
from app.views.explain.text import explain_html, told_html

COMMAND = "explain"
"""``explain ID``: the control with that id in the page."""
_NONE_YET = "Point at a control, or put the focus on it, and press E or F1, or press the ? beside its name."


class ExplainView(View):
    """Answers the command `COMMAND`."""

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._count = 0
        title = "Explain the control under the pointer"
        frame.commands.register(COMMAND, self.explain, title, "E", watcher=True)

    def build(self, tab: Tab) -> None:
        """Make the place of the explanation."""
        with tab:
            self._html = self.frame.gui.add_html("", order=4)

    def explain(self, id: str) -> None:
        """Explain the control with this id; say how to ask when there is none."""
        with self.session.lock:
            content = self._content(id.strip())
            self._count += 1
            # No div: what a hidden div holds is for scripts, and stays English (app.languages.markup).
            self._html.content = (
                f'<section id="sb-explained" hidden data-count="{self._count}">{content}</section>'
            )

    def _content(self, id: str) -> str:
        control = next((c for c in self.frame.controls() if id in c.ids), None)
        if control is not None:
            return explain_html(control.spec, self.session.scenario)
        handle = control_with(self.frame.gui, id)
        label = getattr(handle, "label", None)
        if label is None:
            return told_html("Explain", _NONE_YET)
        return told_html(str(label), str(getattr(handle, "hint", None) or "Press it and see."))


VIEW = ExplainView
