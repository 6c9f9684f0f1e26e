"""Tab "Metrics": the numbers of all methods, what dominates them, and the warnings about the run."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from app.jobs.verifier import Verified
from app.plots import style
from app.plots.table import parts
from app.plots.warnings import severity, warnings_for
from app.session.shown import Shown, window_of
from app.shell import notices
from app.shell.control import Widget
from app.shell.view import PictureView, Tab, if_user
from app.views.metrics.table import method_px, metrics_html, metrics_rows, system_html, verdict
from app.views.metrics.why import why_html
from navcore.engine.run import Run

_LETTER_PX, _PADDING_PX = {True: 7.3, False: 6.7}, {True: 16, False: 8}
"""Of a number in the table: in the large print of a wide window, in the small one."""
_DELTA_PX = {True: 150, False: 125}
_ROW_NAME_PX = 120
_MARGINS_PX = 20
OVER = "errors over"
_WINDOWS = {"the whole run": "whole", "after settling": "settled", "chosen hours": "hours"}
_ENDS = {
    "window_from_h": ("measured from (h)", "Begin of the part of the run that is measured."),
    "window_to_h": ("measured to (h)", "End of the part of the run that is measured."),
}


class MetricsView(PictureView[tuple[str, str]]):
    """Table and warnings, and between them which error source dominates."""

    title = "Metrics"
    place = "lower"
    look_for = "The best number of each row is marked; below, which error source it comes from."

    def build(self, tab: Tab) -> None:
        """Make the places of the texts."""
        with tab:
            self._over: Any = self.frame.gui.add_dropdown(
                OVER, tuple(_WINDOWS), hint="Part of the run over which errors and requirements are measured."
            )
            self._ends = {
                field: Widget(
                    self.frame.gui.add_number(label, 0.0, min=0.0, max=1e5, visible=False, hint=hint)
                )
                for field, (label, hint) in _ENDS.items()
            }
            self._table = self.frame.gui.add_html("")
            self._why = self.frame.gui.add_html("")
            self._warnings = self.frame.gui.add_html("")

        self._over.on_update(if_user(self._choose))
        for field, box in self._ends.items():
            box.handle.on_update(if_user(lambda field=field, box=box: self._end(field, box)))

    def _choose(self) -> None:
        """Measure over another part of the run; hours begin as those of the whole run."""
        window, display = _WINDOWS[self._over.value], self.session.display
        to_h = display.window_to_h
        if window == "hours" and to_h is None:
            to_h = self.session.scenario.run.duration_h
        self.frame.show(window=window, window_to_h=to_h)

    def _end(self, field: str, box: Widget) -> None:
        with self.session.lock:
            self.frame.show(**{field: float(box.take())})

    def follow_display(self) -> None:
        """Show what the errors are measured over."""
        display = self.session.display
        self._over.value = next(word for word, key in _WINDOWS.items() if key == display.window)
        for field, box in self._ends.items():
            value = getattr(display, field)
            box.show(self.session.scenario.run.duration_h if value is None else value)
            box.handle.visible = display.window == "hours"

    def follow_jobs(self) -> None:
        """Tell what dominates the run, as far as it is known."""
        run, session = self.session.run, self.session
        if run is None:
            return
        folded = not self.frame.layout().wide
        html = why_html(session.searches.explainer, run, session.selected, folded=folded)
        if self._why.content != html:
            self._why.content = html

    def picture(self, found: Shown) -> tuple[str, str]:
        """Make the table and the warnings, HTML."""
        return self._table_html(found), warnings_html(found.run, found.verified)

    def show(self, picture: tuple[str, str]) -> None:
        """Show table and warnings; what dominates the run is looked for only now that they are in front."""
        table, warnings = picture
        narrow = "" if self.frame.layout().wide else " sb-narrow"
        self._table.content = f'<div class="sb-table{narrow}" style="padding:4px 10px">{table}</div>'
        self._warnings.content = warnings
        if self.session.run is not None:
            self.session.searches.explain(self.session.run)

    def _table_html(self, now: Shown) -> str:
        """Metrics of all methods, in as many tables below each other as the width asks for."""
        window = window_of(now.run, now.display)
        layout, run, verified, baseline = self.frame.layout(), window.run, now.verified, now.baseline
        if baseline is not None and baseline.run is not None:
            baseline = replace(baseline, run=window.of(baseline.run))
        rows = metrics_rows(run, now.display)
        each_px = method_px(rows, _LETTER_PX[layout.wide], _PADDING_PX[layout.wide])
        each_px += 0 if baseline is None else _DELTA_PX[layout.wide]
        most = max(int((layout.plot_px - _ROW_NAME_PX - _MARGINS_PX) / each_px), 1)
        beside = None if verified is None else verified.verification
        old = verified is not None and verified.old
        note = notices.note([window.told] if window.told else [], "info" if window.possible else "warning")
        tables = "".join(
            '<div style="margin-bottom:2px">'
            + metrics_html(run, part, beside, old=old, display=now.display, baseline=baseline)
            + "</div>"
            for part in parts(len(run.methods), most)
        )
        return note + tables + system_html(now.run)


def warnings_html(run: Run, verified: Verified | None = None) -> str:
    """Notes and warnings about a run and its methods, HTML."""
    notes = [notices.note(dict.fromkeys(run.warnings), "info")]
    if verified is not None and not verified.old:
        notes.append(notices.note([verdict(verified.verification)], "info"))
        notes.append(notices.note(verified.verification.statements, "warning"))
    for index, texts in warnings_for(run).items():
        name = run.methods[index].method.name
        notes.append(notices.note([f"{name}: {text}" for text in texts], severity(run, index) or "warning"))
    return f'<div style="padding-top:3px;color:{style.INK}">{"".join(notes)}</div>'


VIEW = MetricsView
