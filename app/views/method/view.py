"""Tab "Method": which method the controls edit, its network, policy and switching."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Any

from navcore.analysis.loop import velocity_settling
from navcore.damping import WHOLE
from navcore.damping.base import Damping
from navcore.damping.gyrocompass import Gyrocompass
from navcore.design.vary import network_not_in_force
from navcore.engine.run import MethodRun, Run
from navcore.exporting.equations import as_latex, as_text
from navcore.foundation.offered import when_changed
from navcore.foundation.text import Text
from navcore.law.policy import POLICIES
from navcore.law.switching import SWITCHINGS
from navcore.networks import NETWORKS
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.needs import meets
from schuler_bench.editing import edits, form
from schuler_bench.editing.form import FieldSpec, Path
from schuler_bench.editing.rounding import significant
from schuler_bench.plots.effective import earth_mode_text
from schuler_bench.plots.legend import severity, warnings_for
from schuler_bench.plots.units import number, settling
from schuler_bench.session.shown import Shown
from schuler_bench.shell import notices
from schuler_bench.shell.control import Control, Section, controls_of
from schuler_bench.shell.searching import show_html
from schuler_bench.shell.view import Frame, Tab, View
from schuler_bench.views.method.chips import ADD, COPY, EYE, REMOVE, RENAME, SELECT, chips_html
from schuler_bench.views.method.taking import COPY_LATEX, COPY_TEXT, TakingPanel
from schuler_bench.views.method.tuning import TuningPanel

_TAKEN = Text("from the sensors and the log of the scenario")
NO_DESIGN = Text("no (σ, ζ) gives these K")
_CATALOGUES: Mapping[str, tuple[Mapping[str, type], str]] = {
    "network": (NETWORKS, "network"),
    "azimuth": (NETWORKS, Text("azimuth network")),
    "policy": (POLICIES, "policy"),
    "switching": (SWITCHINGS, "switching"),
}


class MethodView(View):
    """Controls of the selected method."""

    title = Text("Method")
    place = "edit"
    asks = ("adapt", "export")

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        add = frame.commands.register
        add(ADD, lambda _: self._arrange(ADD), Text("Add a method"))
        add(COPY, lambda _: self._arrange(COPY), Text("Copy the method"))
        add(REMOVE, lambda _: self._arrange(REMOVE), Text("Remove the method"))
        add(RENAME, lambda name: self._arrange(RENAME, name))
        add(SELECT, self._with_method(lambda at: self.session.select(at, None)))
        add(EYE, self._with_method(self._look))
        ask = frame.commands.ask_page
        latex, text = Text("Copy the equations as LaTeX"), Text("Copy the equations as text")
        add(COPY_LATEX, lambda _: ask("copy-latex", self._taking.copied(as_latex)), latex, watcher=True)
        add(COPY_TEXT, lambda _: ask("copy-plain", self._taking.copied(as_text)), text, watcher=True)

    def build(self, tab: Tab) -> None:
        """Make the chips, and the places for controls and notes."""
        gui, edit = self.frame.gui, self.frame.editor.edit
        with tab:
            self._chips = gui.add_html("", order=0)
            self._by_policy = gui.add_html("", order=20, visible=False)
            self._loop = gui.add_html("", order=40, visible=False)
            self._warnings = gui.add_html("", order=41, visible=False)
            self._unused = gui.add_html("", order=42, visible=False)
        places = {
            "network": 1.0,
            "parameters": 10.0,
            "method": 50.0,
            "settings": 51.0,
            "azimuth": 60.0,
            "policy": 70.0,
            "switching": 100.0,
        }
        self.sections = {name: Section(gui, tab, edit, order) for name, order in places.items()}
        self._tuning = TuningPanel(self.frame, tab, order=95.0)
        self._taking = TakingPanel(self.frame, tab, order=150.0)

    @property
    def leads(self) -> int:
        """A method is what one varies where no lesson is open."""
        return 1

    @property
    def controls(self) -> list[Control]:
        """Controls of the method's fields."""
        return controls_of(self.sections)

    def _with_method(self, act: Callable[[int], None]) -> Callable[[str], None]:
        """Command with the number of a method; any other is of a row of chips that has gone."""

        def run(number: str) -> None:
            with self.session.lock:
                if number.isdecimal() and int(number) < len(self.session.scenario.method):
                    act(int(number))

        return run

    def _look(self, at: int) -> None:
        """Hide the curves of a method, or show them again."""
        self.frame.show(legend=self.session.display.looked(self.session.scenario.method[at].name))

    def _arrange(self, what: str, name: str = "") -> None:
        """Add, copy, remove or rename a method."""
        session = self.session
        with session.lock, notices.told(self.frame.client, Text("Not possible"), self.frame.refresh):
            at = session.selected
            if what == RENAME:
                changed = edits.with_value(session.scenario, ("method", at, "name"), name)
            elif what == REMOVE:
                changed = edits.without_method(session.scenario, at)
            else:
                changed, at = edits.with_method(session.scenario, at if what == COPY else None)
            session.change(changed, None, selected=at)

    def follow_scenario(self) -> None:
        """Show the selected method and the warnings about it."""
        scenario, index = self.session.scenario, self.session.selected
        self._show(scenario, index, self.frame.editor.moved)
        self._show_warnings(self.session.run, scenario, index)

    def follow_display(self) -> None:
        """Show whose curves are hidden, what arranges the methods, and what was entered for an export."""
        self._show_chips()
        self._taking.follow()

    def _show_chips(self) -> None:
        display = self.session.display
        names = display.colored(self.session.scenario)
        hidden = [display.state_of(name) == "hidden" for name in names]
        show_html(
            self._chips, chips_html(names, self.session.selected, hidden, arranging=not display.enlarged)
        )

    def follow_jobs(self) -> None:
        """Show how far the search for a damping table is, and how far an export."""
        self._tuning.show()
        self._taking.follow()

    def draw(self, found: Shown) -> None:
        """Show the warnings about the selected method, and its equations."""
        del found
        self._taking.draw()
        self._show_warnings(self.session.run, self.session.scenario, self.session.selected)

    def _show(self, scenario: Scenario, index: int, moved: Control | None) -> None:
        """Show a method of the scenario."""
        self._show_chips()
        method, path = scenario.method[index], ("method", index)
        values = _values(scenario, index)
        of_method = [spec for spec in form.fields(Method, path) if spec.path[-1] != "name"]
        self.sections["method"].show(of_method, values, moved)
        blocks = method.kind.blocks
        network = form.fields(type(method.network), (*path, "network"))
        by_policy = [spec for spec in network if set_by_policy(spec, method)]
        self.sections["network"].show(
            [_catalogue("network", path)] if "network" in blocks else [], values, moved
        )
        unset = {(*path, "network", name): _TAKEN for name in method.network.taken()}
        shown = [spec for spec in network if "network" in blocks and spec not in by_policy]
        self.sections["parameters"].show(shown, values, moved, unset)
        show_html(self._by_policy, by_policy_html(by_policy, method, values))
        for part in ("policy", "switching"):
            specs = [_catalogue(part, path), *form.fields(type(getattr(method, part)), (*path, part))]
            self.sections[part].show(specs if part in blocks else [], _values_at(scenario, specs), moved)
        slow = azimuth_fields(scenario, index)
        self.sections["azimuth"].show(slow, _values_at(scenario, slow), moved)
        block = own_fields(method.kind, path)
        self.sections["settings"].show(block, _values_at(scenario, block), moved)
        last_gain = self.sections["parameters"].controls.get((*path, "network", "k3"))
        if last_gain is not None:
            known = (*path, "network", "sigma") in values
            last_gain.say(notices.note([] if known else [NO_DESIGN], "warning"))

    def _show_warnings(self, run: Run | None, scenario: Scenario, index: int) -> None:
        """Say beside the controls concerned what the last run found about the method."""
        network, unused, loop = "", "", ""
        if run is not None and run.scenario == scenario:
            loop = (
                notices.small(loop_text(run.methods[index], scenario.site.lat_deg))
                if not scenario.method[index].undamped
                else ""
            )
            # The line below the network says these.
            elsewhere = {NO_DESIGN, *run.methods[index].whole.warnings}
            texts = [text for text in warnings_for(run).get(index, ()) if text not in elsewhere]
            about_damping = [text for text in texts if "damping" in text.split(":")[0].split(" ")[:2]]
            others = [text for text in texts if text not in about_damping]
            network = notices.note(others, severity(run, index) or "warning")
            unused = notices.note(about_damping, "warning")
        show_html(self._warnings, network)
        show_html(self._loop, loop)
        show_html(self._unused, unused)


def set_by_policy(spec: FieldSpec, method: Method) -> str:
    """Why a network's parameter has no control: the policy sets it; "" where it acts."""
    return "" if method.undamped else network_not_in_force(method, f"network.{spec.path[-1]}")


def by_policy_html(set_by: list[FieldSpec], method: Method, values: Mapping[Path, Any]) -> str:
    """Parameters of a network that the policy sets, with the values that the network itself has."""
    if not set_by:
        return ""
    own = [
        Text("{label} {value:.4g}", label=spec.label, value=value)
        for spec in set_by
        if isinstance(value := values.get(spec.path), int | float)
    ]
    sets = Text("{reason:sentence}", reason=network_not_in_force(method))
    without = [Text("Without it: {own}.", own=Text.joined(", ", own))] if own else []
    return notices.small(Text.joined(" ", [sets, *without]))


def own_fields(kind: Damping, path: Path) -> list[FieldSpec]:
    """Controls of the parameters that a kind of damping has of its own."""
    return form.fields(kind.settings, (*path, kind.id)) if kind.settings else []


def azimuth_fields(scenario: Scenario, index: int) -> list[FieldSpec]:
    """Controls of the azimuth channel: a gyrocompass, which needs the log, or a network.

    None where the scenario has no azimuth channel, so that every choice would be refused.
    """
    method, path = scenario.method[index], ("method", index)
    whole = WHOLE.get(method.damping)
    given = method.azimuth.id != "none" or method.gyrocompass is not None
    if "azimuth" not in method.kind.blocks or whole is None or not (given or meets(scenario, whole)):
        return []
    switch = form.flag(Method, "gyrocompass", path)
    if method.gyrocompass is not None:
        return [switch, *form.fields(Gyrocompass, (*path, "gyrocompass"))]
    fields = form.fields(type(method.azimuth), (*path, "azimuth"))
    network = [replace(spec, label=Text("azimuth {label}", label=spec.label)) for spec in fields]
    return [*([switch] if method.kind.uses_log else []), _catalogue("azimuth", path), *network]


@lru_cache(maxsize=256)
def _catalogue(part: str, path: Path) -> FieldSpec:
    members, label = _CATALOGUES[part]
    titles = (
        Text("{key}: {value}", key=key, value=getattr(m, "title", "") or first_line(m))
        for key, m in members.items()
    )
    return FieldSpec(
        (*path, part, "id"), label, Text.joined("; ", titles), "choice", next(iter(members)), tuple(members)
    )


when_changed(_catalogue.cache_clear)


def loop_text(method: MethodRun, lat_deg: float) -> str:
    """One channel and the whole system in two sentences, to be read while a slider moves."""
    loop = method.loop
    if not loop.stable:
        return ""
    settles = (
        Text("never settles")
        if loop.settling_s is None
        else Text(
            "settles to 2 % in {tilt} (tilt) and {velocity} (velocity)",
            tilt=settling(loop.settling_s),
            velocity=settling(velocity_settling(method.network, loop)),
        )
    )
    earth_mode = earth_mode_text(method.whole.earth_growth)
    return Text(
        "One channel: least damping ratio {damping_ratio}, {settles}. Whole system: "
        "24 h mode {earth_mode} at {lat_deg:.3g}°.",
        damping_ratio=number(loop.damping_ratio, 3),
        settles=settles,
        earth_mode=earth_mode,
        lat_deg=abs(lat_deg),
    )


def first_line(kind: type) -> str:
    """First line of a class's docstring, for a tooltip."""
    return (kind.__doc__ or "").strip().partition("\n")[0]


def _values(scenario: Scenario, index: int) -> dict[Path, Any]:
    method, path = scenario.method[index], ("method", index)
    values: dict[Path, Any] = {(*path, "damping"): method.damping}
    network = method.network.taken() | edits.network_values(scenario, index) | {"id": method.network.id}
    return values | {
        (*path, "network", name): value if getattr(method.network, name, None) is not None else _shown(value)
        for name, value in network.items()
    }


def _values_at(scenario: Scenario, specs: list[FieldSpec]) -> dict[Path, Any]:
    return {spec.path: edits.value_at(scenario, spec.path) for spec in specs}


def _shown(value: Any) -> Any:
    # What follows from other parameters has endless digits; six are shown, all are used.
    return significant(value, 6) if isinstance(value, float) else value


VIEW = MethodView
