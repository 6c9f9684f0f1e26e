"""Tab "Method": which method the controls edit, its network, policy and switching."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from navcore.analysis.loop import velocity_settling
from navcore.damping.gyrocompass import Gyrocompass
from navcore.design.vary import network_not_in_force
from navcore.engine.run import MethodRun, Run
from navcore.foundation.text import Text
from navcore.law.policy import POLICIES
from navcore.law.switching import SWITCHINGS
from navcore.networks import NETWORKS
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from schuler_bench.editing import edits, form
from schuler_bench.editing.form import FieldSpec, Path
from schuler_bench.plots import style
from schuler_bench.plots.effective import earth_mode_text
from schuler_bench.plots.legend import severity, warnings_for
from schuler_bench.plots.units import number, settling
from schuler_bench.session.shown import Shown
from schuler_bench.shell import notices
from schuler_bench.shell.control import Control, Section, controls_of
from schuler_bench.shell.palette import COPY_METHOD, PASTE
from schuler_bench.shell.searching import show_html
from schuler_bench.shell.view import Frame, Tab, View, if_user
from schuler_bench.views.method.tuning import TuningPanel

ADD, COPY, REMOVE = Text("add"), Text("copy"), Text("remove")
COPY_TEXT, PASTE_TEXT = Text("copy as TOML"), Text("paste TOML")
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

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._names: tuple[str, ...] = ()
        add = frame.commands.register
        add("method-add", lambda _: self._arrange(ADD), Text("Add a method"))
        add("method-copy", lambda _: self._arrange(COPY), Text("Copy the method"))
        add("method-remove", lambda _: self._arrange(REMOVE), Text("Remove the method"))

    def build(self, tab: Tab) -> None:
        """Make the chooser, the buttons and the places for controls and notes."""
        gui, edit = self.frame.gui, self.frame.editor.edit
        with tab:
            self._chooser: Any = gui.add_dropdown(
                "method",
                ("",),
                hint=Text("The controls below belong to this method."),
                order=0,
            )
            self._chip = gui.add_html("", order=0.5)
            buttons = gui.add_button_group(
                Text("methods"),
                (ADD, COPY, REMOVE),
                hint=Text(
                    "Add a method, copy the present one to vary it, or remove it. All methods run on the "
                    "same truth, sensors and log."
                ),
                order=1,
            )
            clipboard = gui.add_button_group(
                Text("as text"),
                (COPY_TEXT, PASTE_TEXT),
                hint=Text(
                    "Copy the method as TOML, or paste one that was copied, from this session or another. "
                    "Ctrl+V pastes too."
                ),
                order=1.5,
            )
            self._unused = gui.add_html("", order=19, visible=False)
            self._warnings = gui.add_html("", order=28, visible=False)
            self._loop = gui.add_html("", order=29, visible=False)
        self._chooser.on_update(if_user(self._choose))
        buttons.on_click(
            lambda event: self._arrange(event.target.value) if event.client is not None else None
        )
        self._arranging = buttons, clipboard
        ask = self.frame.commands.run
        clipboard.on_click(if_user(lambda: ask(COPY_METHOD if clipboard.value == COPY_TEXT else PASTE)))
        places = {
            "method": 2.0,
            "settings": 10.0,
            "network": 20.0,
            "parameters": 30.0,
            "azimuth": 60.0,
            "policy": 70.0,
            "switching": 100.0,
        }
        self.sections = {name: Section(gui, tab, edit, order) for name, order in places.items()}
        self._tuning = TuningPanel(self.frame, tab, order=95.0)

    @property
    def leads(self) -> int:
        """A method is what one varies where no lesson is open."""
        return 1

    @property
    def controls(self) -> list[Control]:
        """Controls of the method's fields."""
        return controls_of(self.sections)

    def _choose(self) -> None:
        if self._chooser.value in self._names:
            self.session.select(self._names.index(self._chooser.value), None)

    def _arrange(self, what: str) -> None:
        """Add, copy or remove a method."""
        session = self.session
        with session.lock, notices.told(self.frame.client, Text("Not possible"), self.frame.refresh):
            at = session.selected
            if what in (ADD, COPY):
                changed, at = edits.with_method(session.scenario, at if what == COPY else None)
            else:
                changed = edits.without_method(session.scenario, at)
            session.change(changed, None, selected=at)

    def follow_scenario(self) -> None:
        """Show the selected method and the warnings about it."""
        scenario, index = self.session.scenario, self.session.selected
        self._show(scenario, index, self.frame.editor.moved)
        self._show_warnings(self.session.run, scenario, index)

    def follow_display(self) -> None:
        """Leave what arranges the methods to the normal size: a lecture moves their parameters."""
        for buttons in self._arranging:
            buttons.visible = self.session.display.size == "normal"

    def follow_jobs(self) -> None:
        """Show how far the search for a damping table is."""
        self._tuning.show()

    def draw(self, found: Shown) -> None:
        """Show the warnings about the selected method."""
        del found
        self._show_warnings(self.session.run, self.session.scenario, self.session.selected)

    def _show(self, scenario: Scenario, index: int, moved: Control | None) -> None:
        """Show a method of the scenario."""
        names = tuple(method.name for method in scenario.method)
        if names != self._names:
            self._names = names
            self._chooser.options = names
        self._chooser.value = names[index]
        self._chip.content = _chip(index)
        method, path = scenario.method[index], ("method", index)
        values = _values(scenario, index)
        self.sections["method"].show(form.fields(Method, path), values, moved)
        blocks = method.kind.blocks
        network = [described(spec, method) for spec in form.fields(type(method.network), (*path, "network"))]
        self.sections["network"].show(
            [_catalogue("network", path)] if "network" in blocks else [], values, moved
        )
        unset = {(*path, "network", name): _TAKEN for name in method.network.taken()}
        self.sections["parameters"].show(network if "network" in blocks else [], values, moved, unset)
        for part in ("policy", "switching"):
            specs = [_catalogue(part, path), *form.fields(type(getattr(method, part)), (*path, part))]
            self.sections[part].show(specs if part in blocks else [], _values_at(scenario, specs), moved)
        slow = azimuth_fields(method, path) if "azimuth" in blocks else []
        self.sections["azimuth"].show(slow, _values_at(scenario, slow), moved)
        own = method.kind.settings if method.damping in blocks else None
        block = form.fields(own, (*path, method.damping)) if own else []
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


def described(spec: FieldSpec, method: Method) -> FieldSpec:
    """Description of a network's parameter; where the policy sets it, that says so first."""
    reason = "" if method.undamped else network_not_in_force(method, f"network.{spec.path[-1]}")
    hint = Text("This value does not act: {reason}. {hint}", reason=reason, hint=spec.hint)
    return replace(spec, hint=hint) if reason else spec


def azimuth_fields(method: Method, path: Path) -> list[FieldSpec]:
    """Controls of the azimuth channel: a gyrocompass, which needs the log, or a network."""
    switch = form.flag(Method, "gyrocompass", path)
    if method.gyrocompass is not None:
        return [switch, *form.fields(Gyrocompass, (*path, "gyrocompass"))]
    fields = form.fields(type(method.azimuth), (*path, "azimuth"))
    network = [replace(spec, label=Text("azimuth {label}", label=spec.label)) for spec in fields]
    return [*([switch] if method.kind.uses_log else []), _catalogue("azimuth", path), *network]


def _catalogue(part: str, path: Path) -> FieldSpec:
    members, label = _CATALOGUES[part]
    titles = (
        Text("{key}: {value}", key=key, value=getattr(m, "title", "") or first_line(m))
        for key, m in members.items()
    )
    return FieldSpec(
        (*path, part, "id"), label, Text.joined("; ", titles), "choice", next(iter(members)), tuple(members)
    )


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
    values: dict[Path, Any] = {(*path, "name"): method.name, (*path, "damping"): method.damping}
    network = method.network.taken() | edits.network_values(scenario, index) | {"id": method.network.id}
    return values | {(*path, "network", name): _shown(value) for name, value in network.items()}


def _values_at(scenario: Scenario, specs: list[FieldSpec]) -> dict[Path, Any]:
    return {spec.path: edits.value_at(scenario, spec.path) for spec in specs}


def _shown(value: Any) -> Any:
    # What follows from other parameters has endless digits; six are shown, all are used.
    return form.significant(value, 9) if isinstance(value, float) else value


def _chip(index: int) -> str:
    return Text(
        '<div style="height:4px;margin:-4px 10px 8px calc(8.4rem + '
        '10px);border-radius:2px;background:{method_color:html}"></div>',
        method_color=style.method_color(index),
    )


VIEW = MethodView
