"""Tab "Metrics": the numbers of all methods, what dominates them, and the warnings about the run."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from navcore.engine.run import Run
from navcore.foundation.text import Text
from navcore.quantities import HEADING, POSITION, TILT, Kind
from navcore.questions.why import WhyQuestion
from schuler_bench.plots import style
from schuler_bench.plots.legend import severity, warnings_for
from schuler_bench.plots.table import parts
from schuler_bench.plots.units import duration
from schuler_bench.session.shown import Shown, Verified, window_of
from schuler_bench.shell import notices
from schuler_bench.shell.layout import TOOLS
from schuler_bench.shell.number_box import NumberBox
from schuler_bench.shell.view import PictureView, Tab, if_user
from schuler_bench.views.metrics.table import method_px, metrics_html, metrics_rows, system_html, verdict

if TYPE_CHECKING:
    from navcore.design.dominance import Cause, Why
    from navcore.engine.run import Run
    from schuler_bench.jobs.asking import Asker


_WAITS = Text("What dominates this result is computed once the controls rest.")


def why_html(explainer: Asker, run: Run, selected: int = 0) -> str:
    """A line for each method; a mark while it is of an earlier run. Its panel folds them (static/room.js).

    Parameters
    ----------
    explainer : Asker
        Of the session.
    run : Run
        That is shown.
    selected : int
        Method whose line stands for all while they are folded.
    """
    result, fits = explainer.result, explainer.asked == WhyQuestion.of(run)
    if fits and result is not None:
        name, causes = result.methods[min(selected, len(result.methods) - 1)]
        return _box(_lines(result, run), "", Text("{name}: {told}", name=name, told=_told(causes, result)))
    if explainer.words:
        return _box("", Text("What dominates this result could not be found."))
    state = _WAITS
    if explainer.fraction is not None:
        state = Text(
            "Computing what dominates this result: {fraction:.0f} %.", fraction=100.0 * explainer.fraction
        )
    if result is None or len(result.methods) != len(run.methods):
        return _box("", state)
    old = Text('<div class="sb-old">{lines}</div>', lines=_lines(result, run))
    return _box(old, Text("{state} Below: of an earlier run.", state=state))


def _box(lines: str, state: str, short: str = "") -> str:
    """HTML of the lines below a heading; ``short`` is shown while they are folded."""
    status = Text('<span role="status" class="sb-muted">{state:html}</span>', state=state) if state else ""
    which = f'id="sb-why" class="sb-wide" data-fits="{int(not state)}"'
    if not lines:
        return Text("<div {which}><b>Why</b> {status}</div>", which=which, status=status)
    return Text(
        '<details {which} data-sb-folds open><summary><b>Why</b> {status}<span class="sb-short">{short:html}'
        "</span></summary>{lines}</details>",
        which=which,
        status=status,
        short=short,
        lines=lines,
    )


def _words(causes: tuple[Cause, ...], result: Why, *kinds: Kind) -> str:
    return Text.joined("; ", (cause_text(cause, result) for cause in causes if cause.quantity in kinds))


def _told(causes: tuple[Cause, ...], result: Why) -> str:
    """Position and tilt in words; the heading stands in the tooltip."""
    return _words(causes, result, POSITION, TILT) or Text("neither position error nor tilt")


def why_line(result: Why, causes: tuple[Cause, ...], name: str, color: str) -> str:
    """Return what dominates the errors of one method, behind a name in its colour."""
    return Text(
        '<div title="{words:html}"><span class="sb-swatch" style="background:{color}">'
        "</span><b>{name:html}</b>: {told:html}.</div>",
        words=_words(causes, result, HEADING),
        color=color,
        name=name,
        told=_told(causes, result),
    )


def _lines(result: Why, run: Run) -> str:
    rows = Text.joined(
        "",
        (
            why_line(result, causes, name, style.method_color(method.place))
            for method, (name, causes) in zip(run.methods, result.methods, strict=True)
        ),
    )
    return rows + Text.joined(
        "", (Text('<div class="sb-muted">{text:html}</div>', text=text) for text in result.remarks)
    )


def cause_text(cause: Cause, result: Why) -> str:
    """One cause in words.

    Such as "position error mostly (83 %) from log bias, as a constant".
    """
    period = _period(cause, result)
    if not cause.source:
        return Text("{label} {period}", label=cause.quantity.label, period=period)
    if cause.share > 0.995:
        return Text(
            "{quantity} all from {source}, {period}",
            quantity=cause.quantity.label,
            source=cause.source,
            period=period,
        )
    percent = f"{100.0 * cause.share:.0f}"
    if cause.share >= 0.5:
        return Text(
            "{quantity} mostly ({percent} %) from {source}, {period}",
            quantity=cause.quantity.label,
            percent=percent,
            source=cause.source,
            period=period,
        )
    return Text(
        "{quantity} most of all ({percent} %) from {source}, {period}",
        quantity=cause.quantity.label,
        percent=percent,
        source=cause.source,
        period=period,
    )


def _period(cause: Cause, result: Why) -> str:
    largest = cause.swing.largest
    if largest == "schuler":
        beat = ""
        if cause.swing.beats and math.isfinite(result.foucault_s):
            beat = Text(", beating (Foucault {foucault_s})", foucault_s=duration(result.foucault_s))
        return Text(
            "at the Schuler period ({schuler_s}){beat}", schuler_s=duration(result.schuler_s), beat=beat
        )
    return {
        "constant": Text("as a constant"),
        "drift": Text("as a slow drift"),
        "earth": Text("at the 24 h period"),
        "other": Text("without a natural period"),
    }[largest]


_LETTER_PX, _PADDING_PX = {True: 7.3, False: 6.7}, {True: 16, False: 8}
"""Of a number in the table: in the large print of a wide window, in the small one."""
_DELTA_PX = {True: 150, False: 125}
_ROW_NAME_PX = 120
_MARGINS_PX = 20
OVER = Text("errors over")
_WINDOWS = {Text("the whole run"): "whole", Text("after settling"): "settled", Text("chosen hours"): "hours"}
_ENDS = {
    "window_from_h": (Text("measured from (h)"), Text("Begin of the part of the run that is measured.")),
    "window_to_h": (Text("measured to (h)"), Text("End of the part of the run that is measured.")),
}


class MetricsView(PictureView[tuple[str, str]]):
    """Table and warnings, and between them which error source dominates."""

    title = Text("Metrics")
    place = "lower"
    tab = Text("Errors")
    asks = ("run", "why")
    look_for = Text("The best number of each row is marked; below, which error source it comes from.")

    def build(self, tab: Tab) -> None:
        """Make the places of the texts."""
        with tab:
            self.frame.gui.add_html(TOOLS)
            self._over: Any = self.frame.gui.add_dropdown(
                OVER,
                tuple(_WINDOWS),
                hint=Text("Part of the run over which errors are measured."),
            )
            self._ends = {
                field: NumberBox(self.frame.client, label, 0.0, self._end(field), hint=hint, visible=False)
                for field, (label, hint) in _ENDS.items()
            }
            self._table = self.frame.gui.add_html("")
            self._why = self.frame.gui.add_html("")
            self._warnings = self.frame.gui.add_html("")

        self._over.on_update(if_user(self._choose))

    def _choose(self) -> None:
        """Measure over another part of the run; hours begin as those of the whole run."""
        window, display = _WINDOWS[self._over.value], self.session.display
        to_h = display.window_to_h
        if window == "hours" and to_h is None:
            to_h = self.session.scenario.run.duration_h
        self.frame.show(window=window, window_to_h=to_h)

    def _end(self, field: str) -> Callable[[float], None]:
        def take(value: float) -> None:
            with self.session.lock:
                self.frame.show(**{field: value})

        return take

    def follow_display(self) -> None:
        """Show what the errors are measured over."""
        display = self.session.display
        self._over.value = next(word for word, key in _WINDOWS.items() if key == display.window)
        for field, box in self._ends.items():
            value = getattr(display, field)
            box.show(self.session.scenario.run.duration_h if value is None else value)
            box.visible = display.window == "hours"

    def follow_jobs(self) -> None:
        """Tell what dominates the run, as far as it is known."""
        run, session = self.session.run, self.session
        if run is None:
            return
        html = why_html(session.searches.asking["why"], run, session.selected)
        if self._why.content != html:
            self._why.content = html

    def picture(self, found: Shown) -> tuple[str, str]:
        """Make the table and the warnings, HTML."""
        return self._table_html(found), warnings_html(found.run, found.verified)

    def show(self, picture: tuple[str, str]) -> None:
        """Show table and warnings; what dominates the run is looked for only now that they are in front."""
        table, warnings = picture
        narrow = "" if self.frame.layout().wide else " sb-narrow"
        self._table.content = Text(
            '<div class="sb-table sb-wide{narrow}" style="padding:4px 10px">{table}</div>',
            narrow=narrow,
            table=table,
        )
        self._warnings.content = warnings
        if self.session.run is not None:
            self.session.searches.explain(self.session.run)

    def _table_html(self, now: Shown) -> str:
        """Metrics of all methods, in as many tables below each other as the width asks for."""
        window = window_of(now.run, now.display)
        layout, run = self.frame.layout(), window.run.with_recorded
        verified, baseline = now.verified, now.baseline
        if baseline is not None and baseline.run is not None:
            baseline = replace(baseline, run=window.of(baseline.run))
        first = len(run.methods) - len(window.run.methods)
        edited = None if now.baseline is None else (first + now.selected, now.baseline.method)
        each_px = method_px(metrics_rows(run, now.display), _LETTER_PX[layout.wide], _PADDING_PX[layout.wide])
        each_px += 0 if baseline is None else _DELTA_PX[layout.wide]
        most = max(int((layout.text_px - _ROW_NAME_PX - _MARGINS_PX) / each_px), 1)
        beside = None if verified is None else verified.verification
        old = verified is not None and verified.old
        note = notices.note([window.told] if window.told else [], "info" if window.possible else "warning")
        tables = Text.joined(
            "",
            (
                Text(
                    '<div style="margin-bottom:2px">{metrics}</div>',
                    metrics=metrics_html(
                        run, part, beside, old=old, display=now.display, baseline=baseline, edited=edited
                    ),
                )
                for part in parts(len(run.methods), most)
            ),
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
        notes.append(
            notices.note(
                [Text("{name}: {text}", name=name, text=text) for text in texts],
                severity(run, index) or "warning",
            )
        )
    return Text(
        '<div class="sb-wide" style="padding-top:3px;color:{ink}">{notes}</div>',
        ink=style.INK,
        notes=Text.joined("", notes),
    )


VIEW = MetricsView
