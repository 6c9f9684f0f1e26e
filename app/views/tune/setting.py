"""Search for the best setting of the selected method, and accept or discard what comes out."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from navcore.design.default_limits import limits_by_default
from navcore.design.measures import read_objective, read_requirement
from navcore.design.vary import network_not_in_force, tunable_fields
from navcore.foundation.text import Text
from navcore.quantities import QUANTITIES, searched
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.requirement import Requirement
from schuler_bench.jobs.designer import TuningTask
from schuler_bench.jobs.refusals import OBJECTIVE, VARY
from schuler_bench.plots.limits import limit_words, requirement_words
from schuler_bench.session.display import OBJECTIVES, Display
from schuler_bench.shell import notices
from schuler_bench.shell.places import PlacesChooser
from schuler_bench.shell.searching import SearchControls, reveal, show_html
from schuler_bench.shell.view import Frame, if_user
from schuler_bench.views.tune.change import change_network
from schuler_bench.views.tune.proposal import doubts, proposal_html

TUNE, STOP = Text("Tune"), Text("Stop tuning")
ACCEPT, DISCARD, UNDO = Text("Accept the proposal"), Text("Discard"), Text("Undo the proposal")
KEEP, BEYOND = Text("keep settling and growth bounded"), Text("search beyond the sliders")
ALL = Text("all parameters")
_CURVES = Text("Curves: what is tuned for over one parameter, the others as they are; dot: present setting.")


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
        self._keep: Any = gui.add_checkbox(
            KEEP,
            True,
            hint=Text(
                "The search keeps a limit on settling and on growth where the tab Requirements has none: "
                "without them it may tune the damping away."
            ),
        )
        self._over = PlacesChooser(self.frame)
        self._beyond: Any = gui.add_checkbox(
            BEYOND,
            False,
            hint=Text("All that the fields allow is searched, not only what the sliders reach."),
        )
        hint = Text(
            "Searches for the setting that makes the objective least and keeps the requirements, then runs "
            "both settings on 32 seeds."
        )
        self._controls = SearchControls(gui, self._designer, self.begin, (TUNE, STOP), hint)
        self._told = gui.add_html("", visible=False)
        self._found = gui.add_html("", visible=False)
        self._accept = gui.add_button(ACCEPT, visible=False, hint=Text("One step of undo takes it back."))
        self._discard = gui.add_button(DISCARD, color="gray", visible=False)
        self._undo = gui.add_button(UNDO, visible=False, hint=Text("The method gets its earlier setting."))
        words = {QUANTITIES[name].label: name for name in OBJECTIVES}
        self._vary.on_update(if_user(self.frame.redraw))
        self._objective.on_update(if_user(lambda: self.frame.show(objective=words[self._objective.value])))
        self._accept.on_click(if_user(self._take))
        self._discard.on_click(if_user(self._designer.discard))
        self._undo.on_click(if_user(self._take_back))
        show = self.frame.show
        self._keep.on_update(if_user(lambda: show(default_limits=self._keep.value)))
        self._beyond.on_update(if_user(lambda: show(beyond_sliders=self._beyond.value)))

    def show(self, *, chosen: bool) -> None:
        """Show how far the search is, or its proposal; only what fronts share while those are ``chosen``."""
        designer, scenario = self._designer, self.session.scenario
        self._offer(scenario)
        display = self.session.display
        for box, value in (
            (self._objective, QUANTITIES[display.objective].label),
            (self._keep, display.default_limits),
            (self._beyond, display.beyond_sliders),
        ):
            if box.value != value:
                box.value = value
        running, result, task = self._controls.follow(chosen), designer.result, designer.asked
        accepted = designer.accepted is not None and designer.accepted == scenario
        offered = not running and result is not None and task is not None and not accepted
        if designer.accepted is not None and task is not None and task.scenario != scenario:
            offered = False  # it was accepted, and the user has gone on
        html = notices.note(designer.words, "warning")
        if (offered or accepted) and result is not None and task is not None:
            if offered and task.scenario != scenario:
                html += notices.note(
                    [Text("The scenario has changed since this proposal was made.")], "warning"
                )
            html += notices.note(doubts(task, result), "warning")
            html += proposal_html(task, result, accepted=accepted)
        said = notices.small(limits_told(scenario, display)) + left_out_html(
            scenario.method[self.session.selected]
        )
        if self.idle and self._fields[ALL]:
            said += notices.small(_CURVES)
        show_html(self._told, Text('<div class="sb-wide">{said}</div>', said=said) if chosen else "")
        show_html(
            self._found, Text('<div class="sb-wide">{html}</div>', html=html) if chosen and html else ""
        )
        self._over.follow(chosen)
        reveal(
            (self._objective, chosen),
            (self._vary, chosen),
            (self._keep, chosen),
            (self._accept, chosen and offered),
            (self._discard, chosen and offered),
            (self._undo, chosen and accepted),
        )

    def _offer(self, scenario: Scenario) -> None:
        """Offer the numeric fields of the selected network."""
        fields = tunable_fields(scenario, self.session.selected)
        choices = {ALL: fields} | {field.rsplit(".", 1)[-1]: (field,) for field in fields}
        if choices != self._fields:
            self._fields = choices
            self._vary.options = tuple(choices)
            self._vary.value = ALL

    def task(self, scenario: Scenario, *, limited: bool = True) -> TuningTask | None:
        """Task of what is chosen; None where no parameter acts.

        A picture may be of another scenario than the chooser, which follows later.
        """
        selected, display = self.session.selected, self.session.display
        offered = tunable_fields(scenario, selected) if selected < len(scenario.method) else ()
        fields = tuple(field for field in self._fields.get(self._vary.value, ()) if field in offered)
        limits = requirements_as_text(scenario.requirement) if limited else ()
        kept = limited and display.default_limits
        whole = display.beyond_sliders
        return TuningTask(scenario, display.objective, fields, limits, kept, whole) if fields else None

    @property
    def idle(self) -> bool:
        """Whether there is no proposal, and none is looked for."""
        return self._designer.result is None and self._designer.under_way is None

    def begin(self) -> None:
        """Search for the best setting of the selected method."""
        session = self.session
        with session.lock:
            scenario = session.scenario
            task = self.task(scenario)
        if task is None:
            reason = network_not_in_force(scenario.method[session.selected])
            lines = [reason or Text("The network of this method has no parameter to vary.")]
            notices.tell(self.frame.client, Text("Nothing to tune"), lines)
            return
        with notices.told(self.frame.client, Text("The setting cannot be tuned"), self.frame.refresh):
            self._designer.begin(replace(task, over=self._over.study))

    def _take(self) -> None:
        """Put the proposal into the present scenario."""
        result, task = self._designer.result, self._designer.asked
        if result is None or task is None:
            return
        network = result.scenario.method[task.method].network.model_dump(mode="json", exclude_none=True)
        if change_network(self.frame, task.method, network, Text("proposal of Tune")):
            self._designer.accept(self.session.scenario)

    def _take_back(self) -> None:
        """Give the method its earlier setting."""
        self.session.undo()


def left_out_html(method: Method) -> str:
    """Note on the parameters of a method that a search cannot vary, HTML; empty where there are none."""
    reason = network_not_in_force(method)
    return notices.note([Text("Not to be varied: {reason}.", reason=reason)] if reason else [], "info")


def requirements_as_text(requirements: Sequence[Requirement]) -> tuple[str, ...]:
    """Limits of a scenario as `navcore.design.measures.read_requirement` reads them, SI.

    A limit of one run is kept as that of the ensemble, where there is one.
    """
    return tuple(
        f"{row.key}{one.sense}{one.limit_si:.12g}"
        for one in requirements
        if (row := searched(one.quantity)) is not None
    )


def limits_told(scenario: Scenario, display: Display) -> str:
    """Which limits a search keeps by requirement and by default, and which it cannot."""
    told = requirements_told(scenario.requirement)
    own = [read_requirement(text) for text in requirements_as_text(scenario.requirement)]
    defaults = limits_by_default(read_objective(display.objective), own) if display.default_limits else []
    if not defaults:
        return told
    kept = Text.joined(", ", (limit_words(one.name, one.limit) for one in defaults))
    return Text("{told} Kept by default: {kept}.", told=told, kept=kept)


def requirements_told(requirements: Sequence[Requirement]) -> str:
    """Which limits a search keeps, and which of the tab Requirements it cannot."""
    kept = [requirement_words(text) for text in requirements_as_text(requirements)]
    other = [
        limit_words(one.quantity, one.limit_si) for one in requirements if searched(one.quantity) is None
    ]
    text = (
        Text("Requirements that are kept: {kept}.", kept=Text.joined(", ", kept))
        if kept
        else Text("No requirement is to be kept.")
    )
    return (
        Text("{text} Judged by runs alone: {other}.", text=text, other=Text.joined(", ", other))
        if other
        else text
    )
