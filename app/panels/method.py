"""Tab "Method": which method the controls edit, its network, policy and switching."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from html import escape
from typing import TYPE_CHECKING, Any

from app.editing import edits, form
from app.editing.form import FieldSpec, Path
from app.figures import style
from app.figures.units import duration, number
from app.figures.warnings import severity, warnings_for
from app.page import notices
from app.panels.control import Control, Edit
from app.panels.section import Section
from navcore.control.policy import POLICIES
from navcore.control.switching import SWITCHINGS
from navcore.loop import Loop
from navcore.network import NETWORKS
from navcore.run import Run
from navcore.scenario import Method, Scenario

if TYPE_CHECKING:
    import viser

ADD, COPY, REMOVE = "add", "copy", "remove"
NO_DESIGN = "no (sigma, xi) gives these K"
_CATALOGUES: Mapping[str, tuple[Mapping[str, type], str]] = {
    "network": (NETWORKS, "network"),
    "policy": (POLICIES, "policy"),
    "switching": (SWITCHINGS, "switching"),
}


class MethodPanel:
    """Controls of the selected method.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    tab : viser.GuiTabHandle
        Where they stand.
    edit : callable
        As for `Control`.
    select : callable
        ``select(index)``: the user wants to edit another method.
    arrange : callable
        ``arrange(what)`` with `ADD`, `COPY` or `REMOVE`.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        tab: viser.GuiTabHandle,
        edit: Edit,
        select: Callable[[int], None],
        arrange: Callable[[str], None],
    ) -> None:
        self._select, self._arrange = select, arrange
        self._names: tuple[str, ...] = ()
        with tab:
            self._chooser: Any = gui.add_dropdown(
                "method to edit",
                ("",),
                hint="The controls below belong to this method.",
                order=0,
            )
            self._chip = gui.add_html("", order=0.5)
            buttons = gui.add_button_group(
                "methods",
                (ADD, COPY, REMOVE),
                hint="Add a method, copy the present one to vary it, or remove it. All methods run on the "
                "same truth, sensors and log.",
                order=1,
            )
            self._unused = gui.add_html("", order=19, visible=False)
            self._warnings = gui.add_html("", order=28, visible=False)
            self._loop = gui.add_html("", order=29, visible=False)
        self._chooser.on_update(self._on_choose)
        buttons.on_click(self._on_button)
        places = {
            "method": 2.0,
            "averaging": 10.0,
            "network": 20.0,
            "parameters": 30.0,
            "policy": 70.0,
            "switching": 100.0,
        }
        self.sections = {name: Section(gui, tab, edit, order) for name, order in places.items()}

    def _on_choose(self, event: viser.GuiEvent[Any]) -> None:
        if event.client is not None and self._chooser.value in self._names:
            self._select(self._names.index(self._chooser.value))

    def _on_button(self, event: viser.GuiEvent[Any]) -> None:
        if event.client is not None:
            self._arrange(event.target.value)

    def show(self, scenario: Scenario, index: int, moved: Control | None) -> None:
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
        averaged = method.damping == "averaging"
        network = form.fields(type(method.network), (*path, "network"))
        self.sections["network"].show([] if averaged else [_catalogue("network", path)], values, moved)
        self.sections["parameters"].show([] if averaged else network, values, moved)
        for part in ("policy", "switching"):
            specs = [_catalogue(part, path), *form.fields(type(getattr(method, part)), (*path, part))]
            self.sections[part].show([] if averaged else specs, _values_at(scenario, specs), moved)
        block = form.fields(type(method.averaging), (*path, "averaging")) if averaged else []
        self.sections["averaging"].show(block, _values_at(scenario, block), moved)
        last_gain = self.sections["parameters"].controls.get((*path, "network", "k3"))
        if last_gain is not None:
            known = (*path, "network", "sigma") in values
            last_gain.say(notices.note([] if known else [NO_DESIGN], "warning"))

    def show_warnings(self, run: Run | None, scenario: Scenario, index: int) -> None:
        """Say beside the controls concerned what the last run found about the method."""
        network, unused, loop = "", "", ""
        if run is not None and run.scenario == scenario:
            loop = (
                notices.small(loop_text(run.methods[index].loop))
                if not scenario.method[index].undamped
                else ""
            )
            texts = [text for text in warnings_for(run).get(index, ()) if text != NO_DESIGN]
            about_damping = [text for text in texts if "damping" in text.split(":")[0].split(" ")[:2]]
            others = [text for text in texts if text not in about_damping]
            network = notices.note(others, severity(run, index) or "warning")
            unused = notices.note(about_damping, "warning")
        _say(self._warnings, network)
        _say(self._loop, loop)
        _say(self._unused, unused)

    @property
    def shown_network(self) -> dict[str, Any]:
        """What the boxes of the network's parameters hold."""
        return {
            str(path[-1]): control.held
            for path, control in self.sections["parameters"].controls.items()
            if control.spec.kind == "number"
        }


def _catalogue(part: str, path: Path) -> FieldSpec:
    members, label = _CATALOGUES[part]
    told = (f"{key}: {getattr(m, 'title', '') or first_line(m)}" for key, m in members.items())
    return FieldSpec(
        (*path, part, "id"), label, "; ".join(told), "choice", next(iter(members)), tuple(members)
    )


def loop_text(loop: Loop) -> str:
    """The closed loop in a line, to be read while a slider moves."""
    if not loop.stable:
        return ""
    settles = "never settles" if loop.settling_s is None else f"settles to 2 % in {duration(loop.settling_s)}"
    return f"Closed loop: least damping ratio {number(loop.damping_ratio, 3)}, {settles}."


def first_line(kind: type) -> str:
    """First line of a class's docstring, for a tooltip."""
    return (kind.__doc__ or "").strip().partition("\n")[0]


def _values(scenario: Scenario, index: int) -> dict[Path, Any]:
    method, path = scenario.method[index], ("method", index)
    found: dict[Path, Any] = {(*path, "name"): method.name, (*path, "damping"): method.damping}
    network = edits.network_values(scenario, index) | {"id": method.network.id}
    return found | {(*path, "network", name): _shown(value) for name, value in network.items()}


def _values_at(scenario: Scenario, specs: list[FieldSpec]) -> dict[Path, Any]:
    return {spec.path: edits.value_at(scenario, spec.path) for spec in specs}


def _shown(value: Any) -> Any:
    # What follows from other parameters has endless digits; six are shown, all are used.
    return form.significant(value, 9) if isinstance(value, float) else value


def _chip(index: int) -> str:
    return (
        f'<div style="height:4px;margin:-4px 10px 8px calc(8.4rem + 10px);border-radius:2px;'
        f'background:{escape(style.method_color(index))}"></div>'
    )


def _say(handle: viser.GuiHtmlHandle, html: str) -> None:
    if handle.content != html:
        handle.content = html
    handle.visible = bool(html)
