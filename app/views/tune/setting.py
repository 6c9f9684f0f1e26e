"""Search for the best setting of the selected method, and accept or discard what comes out."""

from typing import Any

from navcore.design.vary import network_not_in_force, tunable_fields
from navcore.foundation.text import Text
from navcore.quantities import QUANTITIES, searched
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from schuler_bench.jobs.designer import TuningTask
from schuler_bench.session.display import OBJECTIVES
from schuler_bench.session.requirements import Requirements
from schuler_bench.shell import notices
from schuler_bench.shell.searching import SearchControls, reveal, show_html
from schuler_bench.shell.view import Frame, if_user
from schuler_bench.views.tune.change import change_network
from schuler_bench.views.tune.proposal import limit_words, proposal_html, requirement_words

OBJECTIVE, VARY, TUNE, STOP = Text("tune for"), Text("what may vary"), Text("Tune"), Text("Stop tuning")
ACCEPT, DISCARD = Text("Accept the proposal"), Text("Discard")
ALL = Text("all parameters")


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
            OBJECTIVE, tuple(QUANTITIES[name].label for name in OBJECTIVES), hint=Text("What is to be least.")
        )
        self._vary: Any = gui.add_dropdown(
            VARY, (ALL,), hint=Text("Fields of the selected method that the search may move.")
        )
        hint = Text("Searches for the setting that makes the objective least and keeps the requirements.")
        self._controls = SearchControls(gui, self._designer, self.begin, (TUNE, STOP), hint)
        self._told = gui.add_html("", visible=False)
        self._found = gui.add_html("", visible=False)
        self._accept = gui.add_button(ACCEPT, visible=False, hint=Text("One step of undo takes it back."))
        self._discard = gui.add_button(DISCARD, color="gray", visible=False)
        words = {QUANTITIES[name].label: name for name in OBJECTIVES}
        self._objective.on_update(if_user(lambda: self.frame.show(objective=words[self._objective.value])))
        self._accept.on_click(if_user(self._take))
        self._discard.on_click(if_user(self._designer.discard))

    def show(self, *, chosen: bool) -> None:
        """Show how far the search is, or its proposal; nothing while something else is ``chosen``."""
        designer, scenario = self._designer, self.session.scenario
        self._offer(scenario)
        label = QUANTITIES[self.session.display.objective].label
        if self._objective.value != label:
            self._objective.value = label
        running, result, task = self._controls.follow(chosen), designer.result, designer.asked
        proposed = not running and result is not None and task is not None
        html = notices.note(designer.words, "warning")
        if proposed and result is not None and task is not None:
            if task.scenario != scenario:
                html += notices.note(
                    [Text("The scenario has changed since this proposal was made.")], "warning"
                )
            html += proposal_html(task, result)
        said = notices.small(requirements_told(self.session.display.requirements))
        said += left_out_html(scenario.method[self.session.selected])
        show_html(self._told, Text('<div class="sb-wide">{said}</div>', said=said) if chosen else "")
        show_html(
            self._found, Text('<div class="sb-wide">{html}</div>', html=html) if chosen and html else ""
        )
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
            reason = network_not_in_force(scenario.method[session.selected])
            lines = [reason or Text("The network of this method has no parameter to vary.")]
            notices.tell(self.frame.client, Text("Nothing to tune"), lines)
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
        if change_network(self.frame, index, network, Text("proposal of Tune")):
            self._designer.discard()


def left_out_html(method: Method) -> str:
    """Note on the parameters of a method that a search cannot vary, HTML; empty where there are none."""
    reason = network_not_in_force(method)
    return notices.note([Text("Not to be varied: {reason}.", reason=reason)] if reason else [], "info")


def requirements_as_text(requirements: Requirements) -> tuple[str, ...]:
    """Limits of the tab Requirements as `navcore.design.measures.read_requirement` reads them, SI.

    A limit of one run is kept as that of the ensemble, where there is one.
    """
    return tuple(
        f"{row.key}{row.sense}{limit:.12g}"
        for key, limit in requirements.limits.items()
        if (row := searched(key)) is not None
    )


def requirements_told(requirements: Requirements) -> str:
    """Which limits a search keeps, and which of the tab Requirements it cannot."""
    kept = [requirement_words(text) for text in requirements_as_text(requirements)]
    other = [limit_words(key, limit) for key, limit in requirements.limits.items() if searched(key) is None]
    text = (
        Text("Requirements that are kept: {kept}.", kept=Text.joined(", ", kept))
        if kept
        else Text("No requirement is to be kept.")
    )
    return (
        Text("{text} Not measured by a search: {other}.", text=text, other=Text.joined(", ", other))
        if other
        else text
    )
