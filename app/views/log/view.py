"""Fold "Log" of the tab "Setup": the reference velocity, its errors, events and outages."""

from navcore.engine.correcting import corrected, correction_of
from navcore.fitting.recorded import FittedLog, can_fit, fit_of, with_fitted_log
from navcore.foundation.text import Text
from navcore.questions.correction import CorrectionQuestion
from navcore.scenario.model import Scenario
from navcore.sensors.log_errors.events import LogEvent
from navcore.sensors.reference import RECORDED_ONLY, Outage, Reference
from schuler_bench.editing import edits, form
from schuler_bench.editing.form import FieldSpec
from schuler_bench.shell import notices
from schuler_bench.shell.palette import COPY_LOG, PASTE
from schuler_bench.shell.view import FieldsView, Tab, if_user
from schuler_bench.views.log.picture import log_svg

ADD_EVENT, REMOVE_EVENT = Text("add event"), Text("remove event")
ADD_OUTAGE, REMOVE_OUTAGE = Text("add outage"), Text("remove outage")
COPY_TEXT, PASTE_TEXT = Text("copy as TOML"), Text("paste TOML")
FIT, USE_FIT = Text("Fit this log's error"), Text("Simulate a log with this error")
_FIT_TOLD = Text(
    "Compares the recorded log with the recorded track: clock, bias, scale, current, tide, noise and drift."
)
_USE_TOLD = Text(
    "Replaces the recorded log by a simulated one with the fitted error, of any length. Undo brings it back."
)
CORRECTION, TRY, CORRECT = Text("recordings"), Text("try the correction"), Text("correct")
_CORRECT_TOLD = Text(
    "Track and log do not agree. Try runs with the correction and compares the position errors; correct sets "
    "the field that is named."
)
_FIRST = 8
"""Fields of the log's model, in its order, that are shown without asking."""
_KINDS = {"event": LogEvent, "outage": Outage}


class LogView(FieldsView):
    """The reference velocity, its errors, events and outages."""

    title = Text("Log")
    place = "edit"
    tab = Text("Setup")
    asks = ("correction", "fit")
    places = {"kind": 0.0, "first": 1.0, "more": 30.0, "event": 61.0, "outage": 201.0}

    def build(self, tab: Tab) -> None:
        """Make the widgets."""
        super().build(tab)
        gui = self.frame.gui
        self._specs = sorted(form.fields(Reference, ("reference",)), key=lambda spec: spec.path[-1] != "part")
        with tab:
            self._all = gui.add_checkbox(
                Text("all log errors"),
                False,
                hint=Text("Scale, delay, resolution, current and tide too."),
                order=29,
            )
            self._buttons = gui.add_button_group(
                Text("events"),
                (ADD_EVENT, REMOVE_EVENT),
                hint=Text("A passing disturbance: its acceleration is integrated into the log's velocity."),
                order=60,
            )
            self._outages = gui.add_button_group(
                Text("outages"),
                (ADD_OUTAGE, REMOVE_OUTAGE),
                hint=Text("A time in which the log gives nothing: undamped meanwhile."),
                order=200,
            )
            self._clipboard = gui.add_button_group(
                Text("events as text"),
                (COPY_TEXT, PASTE_TEXT),
                hint=Text(
                    "Copy all events, outages and currents as TOML, or paste such a list in their place. "
                    "Ctrl+V pastes too."
                ),
                order=59,
            )
            self._fit = gui.add_button(FIT, hint=_FIT_TOLD, order=20, visible=False)
            self._fitted = gui.add_html("", order=21)
            self._use = gui.add_button(USE_FIT, color="gray", hint=_USE_TOLD, order=22, visible=False)
            self._wrong = gui.add_html("", order=23, visible=False)
            self._correct = gui.add_button_group(CORRECTION, (TRY, CORRECT), hint=_CORRECT_TOLD, order=24)
        self._last_fit: tuple[Scenario, FittedLog] | None = None
        self._trying = self.session.searches.asking["correction"]
        self._correct.on_click(if_user(self._take_correction))
        self._fit.on_click(lambda _: self._fit_error())
        self._use.on_click(lambda _: self._use_fit())
        self._all.on_update(if_user(self.frame.refresh))
        for group in (self._buttons, self._outages):
            group.on_click(
                lambda event: self._arrange(event.target.value) if event.client is not None else None
            )
        ask = self.frame.commands.run
        self._clipboard.on_click(
            if_user(lambda: ask(COPY_LOG if self._clipboard.value == COPY_TEXT else PASTE))
        )

    def _arrange(self, what: str) -> None:
        """Add or remove an event or outage of the log."""
        session = self.session
        with session.lock, notices.told(self.frame.client, Text("Not possible"), self.frame.refresh):
            block = "event" if what in (ADD_EVENT, REMOVE_EVENT) else "outage"
            change = edits.with_block if what in (ADD_EVENT, ADD_OUTAGE) else edits.without_block
            session.change(change(session.scenario, ("reference", block)), None)

    def _fit_error(self) -> None:
        """Fit the recorded log's error, and show it beside the button."""
        with self.session.lock:
            scenario = self.session.scenario
        with notices.told(self.frame.client, Text("The log's error cannot be fitted"), self.frame.refresh):
            self._last_fit = scenario, fit_of(scenario)
            self.frame.refresh()

    def _use_fit(self) -> None:
        """Run on a simulated log with the fitted error in the place of the recorded one."""
        session = self.session
        with session.lock, notices.told(self.frame.client, Text("Not possible"), self.frame.refresh):
            if self._last_fit is not None:
                session.change(with_fitted_log(session.scenario, self._last_fit[1].fit), None)

    def _take_correction(self) -> None:
        """Give the field its value, or run with it and say what it changes."""
        session = self.session
        title = Text("The correction cannot be made")
        with session.lock:
            scenario = session.scenario
        found = correction_of(scenario)
        if found is None:
            return
        with notices.told(self.frame.client, title, self.frame.refresh):
            if self._correct.value == CORRECT:
                with session.lock:
                    session.change(corrected(session.scenario, found), None)
            else:
                self._trying.begin(CorrectionQuestion(scenario=scenario))

    def follow_jobs(self) -> None:
        """Show how far the runs of a correction are, and what they gave."""
        self._show_correction(self.session.scenario)

    def _show_correction(self, scenario: Scenario) -> None:
        """Show what of the recordings does not agree, and what its correction was found to change."""
        found = correction_of(scenario)
        self._wrong.visible = self._correct.visible = found is not None
        if found is None:
            return
        result, asked = self._trying.result, self._trying.asked
        said = []
        if result is not None and asked is not None and asked.scenario == scenario:
            said = result.told()
        if self._trying.fraction is not None:
            said = [Text("Running with and without it: {part:.0f} %.", part=100.0 * self._trying.fraction)]
        self._wrong.content = notices.note([found.notice, *said, *self._trying.words], "warning")

    def _show_fit(self, scenario: Scenario) -> None:
        """Show the fit as long as it is of the scenario's own recordings."""
        self._fit.visible = can_fit(scenario)
        if self._last_fit is not None:
            of = self._last_fit[0]
            if (of.reference, of.motion) != (scenario.reference, scenario.motion):
                self._last_fit = None
        self._fitted.content = "" if self._last_fit is None else _told(self._last_fit[1])
        self._use.visible = self._last_fit is not None

    def fields(self) -> list[FieldSpec]:
        """All of them, shown or not."""
        shown = super().fields()
        paths = {spec.path for spec in shown}
        return [*shown, *(spec for group in self._groups() for spec in group if spec.path not in paths)]

    def reveal(self, spec: FieldSpec) -> None:
        """Show all errors of the log where this one is not shown."""
        if all(control.spec.path != spec.path for control in self.controls):
            self._all.value = True
            self.frame.refresh()

    def _groups(self) -> tuple[list[FieldSpec], list[FieldSpec]]:
        """Fields of the scenario's log: those that are shown without asking, and the others."""
        recorded = [
            spec
            for spec in self._specs
            if spec.path[1] in RECORDED_ONLY or (spec.kind == "choice" and spec.path[1] != "part")
        ]
        simulated = [spec for spec in self._specs if spec.path[1] not in RECORDED_ONLY]
        kind = self.session.scenario.reference.kind
        specs = {"none": [], "file": recorded}.get(kind, simulated)
        return specs[:_FIRST], specs[_FIRST:]

    def follow_scenario(self) -> None:
        """Show the scenario's values; errors that it sets are always shown."""
        scenario = self.session.scenario
        self._show_fit(scenario)
        self._show_correction(scenario)
        kind = scenario.reference.kind
        first, more = self._groups()
        self._all.visible = bool(more)
        if not self._all.value:
            more = self.given(more)
        self._buttons.visible = self._outages.visible = self._clipboard.visible = kind != "none"
        self.show_fields(
            {
                "kind": [form.choice(Reference, "kind", ("reference",))],
                "first": first,
                "more": more,
                "event": _blocks(scenario, "event"),
                "outage": _blocks(scenario, "outage"),
            }
        )


def _told(fitted: FittedLog) -> str:
    """Result of the fit, and the log against the track."""
    return fitted.html() + log_svg(fitted.log, fitted.fit.late_s)


def _blocks(scenario: Scenario, name: str) -> list[FieldSpec]:
    return [
        spec
        for i in range(len(getattr(scenario.reference, name)))
        for spec in form.fields(
            _KINDS[name], ("reference", name, i), prefix=Text("{name} {i}", name=name, i=i + 1)
        )
    ]


VIEW = LogView
