"""Search for the best setting of the selected method, and accept or discard what comes out."""

from collections.abc import Sequence
from typing import Any

from navcore.design.default_limits import left_to_runs, limits_by_default, own_limits
from navcore.design.measures import read_objective
from navcore.design.vary import network_not_in_force, tunable_fields
from navcore.foundation.text import Text
from navcore.quantities import QUANTITIES
from navcore.questions.profile import ProfileQuestion
from navcore.questions.tune import TuneQuestion
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.requirement import Requirement
from navcore.scenario.stochastic import stochastic_model
from schuler_bench.plots.limits import limit_words
from schuler_bench.session.display import OBJECTIVES, Display
from schuler_bench.shell import notices
from schuler_bench.shell.places import PlacesChooser
from schuler_bench.shell.searching import SearchControls, reveal, show_html
from schuler_bench.shell.view import Frame, if_user
from schuler_bench.views.tune.change import change_network
from schuler_bench.views.tune.proposal import doubts, proposal_html

TUNE, STOP = Text("Tune"), Text("Stop tuning")
ACCEPT, DISCARD, UNDO = Text("Accept the proposal"), Text("Discard"), Text("Undo the proposal")
_BOXES = {one.name: one for one in TuneQuestion.options()}
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
        self._designer = frame.session.searches.asking["tune"]
        self._fields: dict[str, tuple[str, ...]] = {}

    def build(self) -> None:
        """Make the controls."""
        gui = self.frame.gui
        self._fields = {}
        objective, vary, keep, beyond = (
            _BOXES[name] for name in ("objective", "vary", "default_limits", "beyond_sliders")
        )
        self._objective: Any = gui.add_dropdown(
            objective.label, tuple(QUANTITIES[name].label for name in OBJECTIVES), hint=objective.help
        )
        self._vary: Any = gui.add_dropdown(vary.label, (ALL,), hint=vary.help)
        self._keep: Any = gui.add_checkbox(keep.label, True, hint=keep.help)
        self._over = PlacesChooser(self.frame)
        self._beyond: Any = gui.add_checkbox(beyond.label, False, hint=beyond.help)
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
            (self._accept, chosen and offered and result is not None and result.offered),
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

    def task(self, scenario: Scenario) -> TuneQuestion | None:
        """Make the question of what is chosen; None where no parameter acts."""
        fields = self._varied(scenario)
        if not fields:
            return None
        given = self._chosen(scenario, fields) | {"default_limits": self.session.display.default_limits}
        return TuneQuestion.ask(given | {"over": self._over.study})

    def profile(self, scenario: Scenario) -> ProfileQuestion | None:
        """Make the question of the curves before a search; None where no parameter acts."""
        fields = self._varied(scenario)
        return ProfileQuestion.ask(self._chosen(scenario, fields)) if fields else None

    def _chosen(self, scenario: Scenario, fields: tuple[str, ...]) -> dict[str, Any]:
        display = self.session.display
        return {
            "scenario": scenario,
            "objective": display.objective,
            "vary": fields,
            # without a random error every setting is alike in the steady state
            "along": stochastic_model(scenario).silent or scenario.on_ins,
            "beyond_sliders": display.beyond_sliders,
        }

    def _varied(self, scenario: Scenario) -> tuple[str, ...]:
        """Chosen fields; a picture may be of another scenario than the chooser, which follows later."""
        selected = self.session.selected
        offered = tunable_fields(scenario, selected) if selected < len(scenario.method) else ()
        return tuple(field for field in self._fields.get(self._vary.value, ()) if field in offered)

    @property
    def idle(self) -> bool:
        """Whether there is no proposal, and none is looked for."""
        return self._designer.result is None and self._designer.under_way is None

    def begin(self) -> None:
        """Search for the best setting of the selected method."""
        session = self.session
        with notices.told(self.frame.client, Text("The setting cannot be tuned"), self.frame.refresh):
            with session.lock:
                scenario = session.scenario
                task = self.task(scenario)
            if task is not None:
                self._designer.begin(task)
                return
            reason = network_not_in_force(scenario.method[session.selected])
            lines = [reason or Text("The network of this method has no parameter to vary.")]
            notices.tell(self.frame.client, Text("Nothing to tune"), lines)

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


def limits_told(scenario: Scenario, display: Display) -> str:
    """Which limits a search keeps by requirement and by default, and which it cannot."""
    own = own_limits(scenario.requirement, ())
    told = requirements_told(scenario.requirement)
    defaults = limits_by_default(read_objective(display.objective), own) if display.default_limits else []
    if not defaults:
        return told
    kept = Text.joined(", ", (limit_words(one.name, one.limit) for one in defaults))
    return Text("{told} Kept by default: {kept}.", told=told, kept=kept)


def requirements_told(requirements: Sequence[Requirement]) -> str:
    """Which limits a search keeps, and which of Requirements (tab Limits) it cannot."""
    kept = [limit_words(one.name, one.limit) for one in own_limits(requirements, ())]
    left = left_to_runs(requirements)
    other = [limit_words(one.quantity, one.limit_si) for one in requirements if one.quantity in left]
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
