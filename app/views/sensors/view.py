"""Fold "Sensors" of the tab "Setup": errors of gyros and accelerometers."""

from pathlib import Path

from navcore.foundation.text import Text
from navcore.sensors.imu import Imu
from schuler_bench.editing import form
from schuler_bench.editing.form import FieldSpec
from schuler_bench.shell import notices
from schuler_bench.shell.view import FieldsView, Tab, if_user

_FIRST = 9
"""Fields of the IMU model, in its order, that are shown without asking."""
_RECORDED_ONLY = ("axes", "begin_s")


class SensorsView(FieldsView):
    """Errors of gyros and accelerometers."""

    title = Text("Sensors")
    place = "edit"
    tab = Text("Setup")
    places = {"first": 1.0, "more": 100.0}

    def build(self, tab: Tab) -> None:
        """Make the widgets."""
        super().build(tab)
        gui = self.frame.gui
        self._specs = sorted(form.fields(Imu, ("imu",)), key=lambda spec: spec.path[-1] != "part")
        with tab:
            gui.add_html(
                notices.small(Text("Measured minus true, body axes x starboard, y forward, z up.")), order=0
            )
            self._file = gui.add_html("", order=0.5, visible=False)
            self._all = gui.add_checkbox(
                Text("all errors"),
                False,
                hint=Text("Drift, scale factor, misalignment and quantisation too."),
                order=99,
            )
        self._all.on_update(if_user(self.frame.refresh))

    def fields(self) -> list[FieldSpec]:
        """All of them, shown or not."""
        return [spec for group in self._groups() for spec in group]

    def reveal(self, spec: FieldSpec) -> None:
        """Show all errors where this one is not shown."""
        if all(control.spec.path != spec.path for control in self.controls):
            self._all.value = True
            self.frame.refresh()

    def _groups(self) -> tuple[list[FieldSpec], list[FieldSpec]]:
        """Fields of the scenario's IMU: those that are shown without asking, and the others."""
        recorded = [spec for spec in self._specs if spec.path[-1] in _RECORDED_ONLY]
        if self.session.scenario.imu.file:
            return recorded, []
        simulated = [spec for spec in self._specs if spec not in recorded]
        return simulated[:_FIRST], simulated[_FIRST:]

    def follow_scenario(self) -> None:
        """Show the scenario's values; errors that it sets are always shown."""
        file = self.session.scenario.imu.file
        told = Text(
            "The run is on the recorded IMU {name}: it brings its own errors.", name=Path(file or "").name
        )
        self._file.content = notices.small(told) if file else ""
        self._file.visible, self._all.visible = bool(file), not file
        first, more = self._groups()
        if not self._all.value:
            more = self.given(more)
        self.show_fields({"first": first, "more": more})


VIEW = SensorsView
