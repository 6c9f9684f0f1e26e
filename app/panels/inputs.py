"""Tabs "Sensors", "Log" and "Run": what all methods share."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

from app.editing import edits, form
from app.editing.form import FieldSpec, Path
from app.page import notices
from app.panels.control import Control, Edit
from app.panels.section import Section
from navcore.motion import MOTIONS
from navcore.motion.swing import Oscillation
from navcore.scenario import Alignment, InitialError, RunSettings, Scenario, SiteSettings
from navcore.sensors.imu import Imu
from navcore.sensors.reference import LogEvent, Outage, Reference

if TYPE_CHECKING:
    import viser

ADD_EVENT, REMOVE_EVENT, ADD_OUTAGE, REMOVE_OUTAGE = (
    "add event",
    "remove event",
    "add outage",
    "remove outage",
)
_FIRST_SENSORS = 8
"""Fields of the IMU model, in its order, that are shown without asking."""
_FIRST_LOG = 7
_KINDS = {"event": LogEvent, "outage": Outage}

_RATE, _STRAPDOWN_ONLY = "rate_hz", ("vertical", "compensation")
_RECORDED_ONLY = ("axes", "begin_s")
_RECORDED_TOLD = "The run is on the recorded IMU {}: it brings its own errors."
_STRAPDOWN_TOLD = (
    'Used by "Verify with full strapdown", and where the fidelity is strapdown. A long strapdown run does '
    "not follow every move of a control: it is started by a button at the top."
)

Arrange = Callable[[str], None]
Again = Callable[[], None]
"""Shows everything anew, after a panel was asked for more or less."""


class SensorPanel:
    """Errors of gyros and accelerometers."""

    def __init__(self, gui: viser.GuiApi, tab: viser.GuiTabHandle, edit: Edit, again: Again) -> None:
        self._specs = form.fields(Imu, ("imu",))
        with tab:
            gui.add_html(
                notices.small("Measured minus true, body axes x starboard, y forward, z up."), order=0
            )
            self._file = gui.add_html("", order=0.5, visible=False)
            self._all = gui.add_checkbox(
                "all errors", False, hint="Drift, scale factor, misalignment and quantisation too.", order=99
            )
        self._all.on_update(lambda event: again() if event.client is not None else None)
        self.sections = {"first": Section(gui, tab, edit, 1.0), "more": Section(gui, tab, edit, 100.0)}

    def show(self, scenario: Scenario, moved: Control | None) -> None:
        """Show the scenario's values; errors that it sets are always shown."""
        file = scenario.imu.file
        self._file.content = notices.small(_RECORDED_TOLD.format(FilePath(file).name)) if file else ""
        self._file.visible, self._all.visible = bool(file), not file
        recorded = [spec for spec in self._specs if spec.path[-1] in _RECORDED_ONLY]
        simulated = [spec for spec in self._specs if spec not in recorded]
        first, more = simulated[:_FIRST_SENSORS], simulated[_FIRST_SENSORS:]
        if file:
            first, more = recorded, []
        elif not self._all.value:
            more = [spec for spec in more if edits.value_at(scenario, spec.path) != spec.default]
        for name, specs in (("first", first), ("more", more)):
            self.sections[name].show(specs, _values(scenario, specs), moved)


class LogPanel:
    """The reference velocity, its errors, events and outages."""

    def __init__(
        self, gui: viser.GuiApi, tab: viser.GuiTabHandle, edit: Edit, again: Again, arrange: Arrange
    ) -> None:
        self._specs = form.fields(Reference, ("reference",))
        with tab:
            self._all = gui.add_checkbox(
                "all log errors", False, hint="Scale, delay, resolution, current and tide too.", order=29
            )
            self._buttons = gui.add_button_group(
                "events",
                (ADD_EVENT, REMOVE_EVENT),
                hint="A passing disturbance: its acceleration is integrated into the log's velocity.",
                order=60,
            )
            self._outages = gui.add_button_group(
                "outages",
                (ADD_OUTAGE, REMOVE_OUTAGE),
                hint="A time in which the log gives nothing: undamped meanwhile.",
                order=200,
            )
        self._all.on_update(lambda event: again() if event.client is not None else None)
        for group in (self._buttons, self._outages):
            group.on_click(lambda event: arrange(event.target.value) if event.client is not None else None)
        places = {"kind": 0.0, "first": 1.0, "more": 30.0, "event": 61.0, "outage": 201.0}
        self.sections = {name: Section(gui, tab, edit, order) for name, order in places.items()}

    def show(self, scenario: Scenario, moved: Control | None) -> None:
        """Show the scenario's values; errors that it sets are always shown."""
        kind = scenario.reference.kind
        shown = {"none": [], "file": [spec for spec in self._specs if spec.kind == "choice"]}
        specs = shown.get(kind, self._specs)
        first, more = specs[:_FIRST_LOG], specs[_FIRST_LOG:]
        self._all.visible = bool(more)
        if not self._all.value:
            more = [spec for spec in more if edits.value_at(scenario, spec.path) != spec.default]
        self._buttons.visible = self._outages.visible = kind != "none"
        listed = {
            "kind": [form.choice(Reference, "kind", ("reference",))],
            "first": first,
            "more": more,
            "event": _blocks(scenario, "event"),
            "outage": _blocks(scenario, "outage"),
        }
        for name, found in listed.items():
            self.sections[name].show(found, _values(scenario, found), moved)


class RunPanel:
    """Duration, site, motion, initial errors, seed."""

    def __init__(self, gui: viser.GuiApi, tab: viser.GuiTabHandle, edit: Edit) -> None:
        with tab:
            gui.add_html(notices.heading("Run and site"), order=0)
            gui.add_html(notices.heading("Motion"), order=30)
            self._about = gui.add_html("", order=69, visible=False)
            gui.add_html(notices.heading("Errors at the start"), order=70)
            gui.add_html(notices.heading("Full strapdown"), order=90)
            gui.add_html(notices.small(_STRAPDOWN_TOLD), order=91)
        places = {"run": 1.0, "site": 20.0, "motion": 31.0, "initial": 71.0, "strapdown": 92.0}
        self.sections = {name: Section(gui, tab, edit, order) for name, order in places.items()}

    def show(self, scenario: Scenario, moved: Control | None) -> None:
        """Show the scenario's values."""
        motion, settings = scenario.motion, form.fields(RunSettings, ("run",))
        kind = FieldSpec(("motion", "kind"), "motion", _told(MOTIONS), "choice", "static", tuple(MOTIONS))
        listed = {
            "run": [spec for spec in settings if spec.path[-1] not in (_RATE, *_STRAPDOWN_ONLY)],
            "site": form.fields(SiteSettings, ("site",)),
            "motion": [kind, *form.fields(type(motion), ("motion",)), *_swings(scenario)],
            "initial": form.fields(InitialError, ("initial_error",)),
            "strapdown": [*(spec for spec in settings if spec.path[-1] == _RATE), *_strapdown_only(scenario)],
        }
        for name, specs in listed.items():
            self.sections[name].show(specs, _values(scenario, specs), moved)
        legs = len(getattr(motion, "leg", ()))
        text = f"{legs} legs, as the scenario file gives them." if legs else ""
        self._about.content, self._about.visible = notices.small(text), bool(text)


def _strapdown_only(scenario: Scenario) -> list[FieldSpec]:
    """What other fidelities refuse, and the alignment record that averaging forecasts from in all of them."""
    path: Path = ("alignment",)
    more = form.fields(Alignment, path, "alignment")
    record = [spec for spec in more if spec.path[-1] == "duration_s"]
    averaged = any(method.damping == "averaging" for method in scenario.method)
    if not scenario.strapdown:
        return record if averaged else []
    settings = [spec for spec in form.fields(RunSettings, ("run",)) if spec.path[-1] in _STRAPDOWN_ONLY]
    shown = more if scenario.alignment.kind != "none" else record if averaged else []
    return [*settings, form.choice(Alignment, "kind", path, label="alignment"), *shown]


def _swings(scenario: Scenario) -> list[FieldSpec]:
    """Fields of the blocks inside a motion, one block an angle."""
    return [
        spec
        for name, info in type(scenario.motion).model_fields.items()
        if info.annotation is Oscillation
        for spec in form.fields(Oscillation, ("motion", name), prefix=f"{name} swing")
    ]


def _blocks(scenario: Scenario, name: str) -> list[FieldSpec]:
    blocks = getattr(scenario.reference, name)
    return [
        spec
        for i in range(len(blocks))
        for spec in form.fields(_KINDS[name], ("reference", name, i), prefix=f"{name} {i + 1}")
    ]


def _told(members: dict[str, type]) -> str:
    return "; ".join(f"{key}: {(m.__doc__ or '').strip().splitlines()[0]}" for key, m in members.items())


def _values(scenario: Scenario, specs: list[FieldSpec]) -> dict[Path, Any]:
    return {spec.path: edits.value_at(scenario, spec.path) for spec in specs}
