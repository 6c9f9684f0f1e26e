"""Tab "Sensors": errors of gyros and accelerometers."""

from __future__ import annotations

from pathlib import Path

from app.editing import edits, form
from app.shell import notices
from app.shell.control import Control
from app.shell.section import Section, controls_of
from app.shell.view import Tab, View, if_user
from navcore.sensors.imu import Imu

_FIRST = 8
"""Fields of the IMU model, in its order, that are shown without asking."""
_RECORDED_ONLY = ("axes", "begin_s")
_RECORDED_TOLD = "The run is on the recorded IMU {}: it brings its own errors."


class SensorsView(View):
    """Errors of gyros and accelerometers."""

    title = "Sensors"
    place = "edit"

    def build(self, tab: Tab) -> None:
        """Make the widgets."""
        gui, edit = self.frame.gui, self.frame.editor.edit
        self._specs = form.fields(Imu, ("imu",))
        with tab:
            gui.add_html(
                notices.small("Measured minus true, body axes x starboard, y forward, z up."), order=0
            )
            self._file = gui.add_html("", order=0.5, visible=False)
            self._all = gui.add_checkbox(
                "all errors", False, hint="Drift, scale factor, misalignment and quantisation too.", order=99
            )
        self._all.on_update(if_user(self.frame.refresh))
        self.sections = {"first": Section(gui, tab, edit, 1.0), "more": Section(gui, tab, edit, 100.0)}

    @property
    def controls(self) -> list[Control]:
        """Controls of the IMU's fields."""
        return controls_of(self.sections)

    def follow_scenario(self) -> None:
        """Show the scenario's values; errors that it sets are always shown."""
        scenario, moved = self.session.scenario, self.frame.editor.moved
        file = scenario.imu.file
        self._file.content = notices.small(_RECORDED_TOLD.format(Path(file).name)) if file else ""
        self._file.visible, self._all.visible = bool(file), not file
        recorded = [spec for spec in self._specs if spec.path[-1] in _RECORDED_ONLY]
        simulated = [spec for spec in self._specs if spec not in recorded]
        first, more = simulated[:_FIRST], simulated[_FIRST:]
        if file:
            first, more = recorded, []
        elif not self._all.value:
            more = [spec for spec in more if edits.value_at(scenario, spec.path) != spec.default]
        for name, specs in (("first", first), ("more", more)):
            self.sections[name].show(specs, edits.values_at(scenario, [spec.path for spec in specs]), moved)


VIEW = SensorsView
