"""Tab "Tune": search for the best setting of the method in hand, and accept or discard what comes out."""

from __future__ import annotations

from typing import Any

from app.jobs.designer import TuningTask
from app.session.requirements import Requirements
from app.shell import notices
from app.shell.view import Frame, Tab, View, if_user
from app.views.tune.proposal import OBJECTIVES, proposal_html
from navcore.design.vary import tunable_fields
from navcore.foundation.errors import InputError
from navcore.foundation.units import ARCSEC, MINUTE
from navcore.scenario.model import Scenario

OBJECTIVE, VARY, TUNE, STOP = "tune for", "what may vary", "Tune", "Stop tuning"
ACCEPT, DISCARD = "Accept the proposal", "Discard"
ALL = "all parameters of the network"
_TOLD = (
    "Searches for the setting of the method in hand that makes the objective least. The limits of the tab "
    "Requirements are kept."
)


class TuneView(View):
    """Objective, fields, progress and the proposal."""

    title = "Tune"
    place = "lower"

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._designer = frame.session.searches.designer
        self._fields: dict[str, tuple[str, ...]] = {}
        frame.commands.register("tune", lambda _: self._begin(), "Tune the method in hand")

    def build(self, tab: Tab) -> None:
        """Make the controls."""
        gui = self.frame.gui
        with tab:
            gui.add_html(notices.small(_TOLD))
            self._objective: Any = gui.add_dropdown(
                OBJECTIVE, tuple(label for label, _, _ in OBJECTIVES.values()), hint="What is to be least."
            )
            self._vary: Any = gui.add_dropdown(VARY, (ALL,), hint="Fields that the search may move.")
            self._start = gui.add_button(TUNE, hint=_TOLD)
            self._progress = gui.add_progress_bar(0.0, visible=False)
            self._stop = gui.add_button(STOP, color="orange", visible=False)
            self._found = gui.add_html("", visible=False)
            self._accept = gui.add_button(ACCEPT, visible=False, hint="One step of undo takes it back.")
            self._discard = gui.add_button(DISCARD, color="gray", visible=False)
        words = {label: name for name, (label, _, _) in OBJECTIVES.items()}
        self._objective.on_update(if_user(lambda: self.frame.show(objective=words[self._objective.value])))
        self._start.on_click(lambda _: self._begin())
        self._stop.on_click(lambda _: self._designer.cancel())
        self._accept.on_click(lambda _: self._take())
        self._discard.on_click(lambda _: self._designer.discard())
        self._show()

    def follow_scenario(self) -> None:
        """Offer the fields of the method in hand."""
        self._show()

    def follow_display(self) -> None:
        """Show the display's objective."""
        self._show()

    def follow_jobs(self) -> None:
        """Show how far the search is, or its proposal."""
        self._show()

    def _show(self) -> None:
        designer, scenario = self._designer, self.session.scenario
        self._offer(scenario)
        label = OBJECTIVES[self.session.display.objective][0]
        if self._objective.value != label:
            self._objective.value = label
        running, result, task = designer.fraction is not None, designer.result, designer.asked
        if designer.fraction is not None:
            self._progress.value = round(100.0 * designer.fraction, 1)
        proposed = not running and result is not None
        for handle, shown in (
            (self._start, not running),
            (self._progress, running),
            (self._stop, running),
            (self._accept, proposed),
            (self._discard, proposed),
        ):
            if handle.visible != shown:
                handle.visible = shown
        html = notices.note(designer.words, "warning")
        if proposed and result is not None and task is not None:
            if task.scenario != scenario:
                html += notices.note(["The scenario has changed since this proposal was made."], "warning")
            html += proposal_html(task, result)
        if self._found.content != html:
            self._found.content, self._found.visible = html, bool(html)

    def _offer(self, scenario: Scenario) -> None:
        """Offer the numeric fields of the network in hand."""
        fields = tunable_fields(scenario, self.session.selected)
        choices = {ALL: fields} | {field.rsplit(".", 1)[-1]: (field,) for field in fields}
        if choices != self._fields:
            self._fields = choices
            self._vary.options = tuple(choices)
            self._vary.value = ALL

    def _begin(self) -> None:
        session = self.session
        with session.lock:
            scenario, display = session.scenario, session.display
            fields = self._fields.get(self._vary.value, ())
        if not fields:
            notices.tell(
                self.frame.client, "Nothing to tune", ["The network of this method has no parameter to vary."]
            )
            return
        self._designer.begin(
            TuningTask(scenario, display.objective, fields, requirements_as_text(display.requirements))
        )

    def _take(self) -> None:
        """Make the proposal the present scenario."""
        session = self.session
        with session.lock:
            result, task = self._designer.result, self._designer.asked
            if result is None or task is None:
                return
            try:
                session.change(result.scenario, None, name="proposal of Tune")
            except InputError as error:
                notices.tell(self.frame.client, "The proposal cannot be used", notices.fault_lines(error))
                return
        self._designer.discard()


def requirements_as_text(requirements: Requirements) -> tuple[str, ...]:
    """Limits of the tab Requirements as `navcore.design.measures.read_requirement` reads them, SI.

    The overshoot after an initial tilt and the largest tilt of a run are no measures of a search.
    """
    asked = {
        "settling_s<=": (requirements.settling_min, MINUTE),
        "damping_ratio>=": (requirements.damping_ratio, 1.0),
        "h0_deviation<=": (requirements.h0_deviation, 1.0),
        "log_tilt<=": (requirements.log_tilt_arcsec, ARCSEC),
        "position_rms<=": (requirements.position_rms_m, 1.0),
    }
    return tuple(f"{name}{limit * unit:.12g}" for name, (limit, unit) in asked.items() if limit is not None)


VIEW = TuneView
