"""Search for the best setting of the selected method, and accept or discard what comes out."""

from typing import Any

from app.jobs.designer import TuningTask
from app.session.requirements import Requirements, label_of
from app.shell import notices
from app.shell.searching import SearchControls, reveal, show_html
from app.shell.view import Frame, if_user
from app.views.tune.change import change_network
from app.views.tune.proposal import OBJECTIVES, proposal_html
from navcore.design.vary import tunable_fields
from navcore.foundation.text import Text
from navcore.foundation.units import ARCSEC, MINUTE
from navcore.scenario.model import Scenario

OBJECTIVE, VARY, TUNE, STOP = "tune for", "what may vary", "Tune", "Stop tuning"
ACCEPT, DISCARD = "Accept the proposal", "Discard"
ALL = "all parameters"
_MEASURED = {
    "settling_min": ("settling_s<=", MINUTE),
    "damping_ratio": ("damping_ratio>=", 1.0),
    "h0_deviation": ("h0_deviation<=", 1.0),
    "h_slope_s": ("h_slope_s<=", 1.0),
    "log_tilt_arcsec": ("log_tilt<=", ARCSEC),
    "position_rms_m": ("position_rms<=", 1.0),
}
"""Requirements that a search can measure, as `navcore.design.measures.read_requirement` reads them."""


class SettingPanel:
    """Objective, fields, progress and the proposal.

    Parameters
    ----------
    frame : Frame
        Of the page.
    """

    def __init__(self, frame: Frame) -> None:
        self.frame, self.session = frame, frame.session
        self._designer = frame.session.searches.designer
        self._fields: dict[str, tuple[str, ...]] = {}

    def build(self) -> None:
        """Make the controls."""
        gui = self.frame.gui
        self._fields = {}
        self._objective: Any = gui.add_dropdown(
            OBJECTIVE, tuple(label for label, _, _ in OBJECTIVES.values()), hint="What is to be least."
        )
        self._vary: Any = gui.add_dropdown(
            VARY, (ALL,), hint="Fields of the selected method that the search may move."
        )
        hint = "Searches for the setting that makes the objective least and keeps the requirements."
        self._controls = SearchControls(gui, self._designer, self.begin, (TUNE, STOP), hint)
        self._told = gui.add_html("", visible=False)
        self._found = gui.add_html("", visible=False)
        self._accept = gui.add_button(ACCEPT, visible=False, hint="One step of undo takes it back.")
        self._discard = gui.add_button(DISCARD, color="gray", visible=False)
        words = {label: name for name, (label, _, _) in OBJECTIVES.items()}
        self._objective.on_update(if_user(lambda: self.frame.show(objective=words[self._objective.value])))
        self._accept.on_click(if_user(self._take))
        self._discard.on_click(if_user(self._designer.discard))

    def show(self, *, chosen: bool) -> None:
        """Show how far the search is, or its proposal; nothing while something else is ``chosen``."""
        designer, scenario = self._designer, self.session.scenario
        self._offer(scenario)
        label = OBJECTIVES[self.session.display.objective][0]
        if self._objective.value != label:
            self._objective.value = label
        running, result, task = self._controls.follow(chosen), designer.result, designer.asked
        proposed = not running and result is not None and task is not None
        html = notices.note(designer.words, "warning")
        if proposed and result is not None and task is not None:
            if task.scenario != scenario:
                html += notices.note(["The scenario has changed since this proposal was made."], "warning")
            html += proposal_html(task, result)
        limits = notices.small(requirements_told(self.session.display.requirements))
        show_html(self._told, f'<div class="sb-wide">{limits}</div>' if chosen else "")
        show_html(self._found, f'<div class="sb-wide">{html}</div>' if chosen and html else "")
        reveal(
            (self._objective, chosen),
            (self._vary, chosen),
            (self._accept, chosen and proposed),
            (self._discard, chosen and proposed),
        )

    def _offer(self, scenario: Scenario) -> None:
        """Offer the numeric fields of the selected network."""
        fields = tunable_fields(scenario, self.session.selected)
        choices = {ALL: fields} | {field.rsplit(".", 1)[-1]: (field,) for field in fields}
        if choices != self._fields:
            self._fields = choices
            self._vary.options = tuple(choices)
            self._vary.value = ALL

    def begin(self) -> None:
        """Search for the best setting of the selected method."""
        session = self.session
        with session.lock:
            scenario, display = session.scenario, session.display
            fields = self._fields.get(self._vary.value, ())
        if not fields:
            lines = ["The network of this method has no parameter to vary."]
            notices.tell(self.frame.client, "Nothing to tune", lines)
            return
        self._designer.begin(
            TuningTask(scenario, display.objective, fields, requirements_as_text(display.requirements))
        )

    def _take(self) -> None:
        """Put the proposal into the present scenario."""
        result, task = self._designer.result, self._designer.asked
        if result is None or task is None:
            return
        index = int(task.vary[0].split(".")[1])
        network = result.scenario.method[index].network.model_dump(mode="json", exclude_none=True)
        if change_network(self.frame, index, network, "proposal of Tune"):
            self._designer.discard()


def requirements_as_text(requirements: Requirements) -> tuple[str, ...]:
    """Limits of the tab Requirements as `navcore.design.measures.read_requirement` reads them, SI."""
    return tuple(
        f"{name}{limit * unit:.12g}"
        for field, (name, unit) in _MEASURED.items()
        if (limit := getattr(requirements, field)) is not None
    )


def requirements_told(requirements: Requirements) -> str:
    """Which limits of the tab Requirements a search keeps, and which it cannot."""
    given = [name for name in type(requirements).model_fields if getattr(requirements, name) is not None]
    kept = [_limit(requirements, name) for name in given if name in _MEASURED]
    other = [_limit(requirements, name) for name in given if name not in _MEASURED]
    text = (
        Text("Requirements that are kept: {kept}.", kept=", ".join(kept))
        if kept
        else "No requirement is to be kept."
    )
    return (
        Text("{text} Not measured by a search: {other}.", text=text, other=", ".join(other))
        if other
        else text
    )


def _limit(requirements: Requirements, name: str) -> str:
    label, _, unit = label_of(name).partition(" (")
    return f"{label} {getattr(requirements, name):g} {unit.rstrip(')')}".rstrip()
