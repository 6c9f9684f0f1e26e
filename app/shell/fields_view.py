"""A tab with groups of controls for fields of the scenario."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from app.editing import edits
from app.editing.form import FieldSpec
from app.shell.control import Control, Section, controls_of
from app.shell.view import Tab, View


class FieldsView(View):
    """Makes a section at each of `places`, and shows fields in them.

    Attributes
    ----------
    places : dict
        Name of a section -> place of its first control in the tab.
    """

    places: ClassVar[dict[str, float]] = {}

    def build(self, tab: Tab) -> None:
        """Make the sections."""
        gui, edit = self.frame.gui, self.frame.editor.edit
        self.sections = {name: Section(gui, tab, edit, order) for name, order in self.places.items()}

    @property
    def controls(self) -> list[Control]:
        """Controls of the fields."""
        return controls_of(self.sections)

    def show_fields(self, fields: Mapping[str, list[FieldSpec]]) -> None:
        """Show fields of the session's scenario in the sections with these names."""
        scenario, moved = self.session.scenario, self.frame.editor.moved
        for name, specs in fields.items():
            self.sections[name].show(specs, edits.values_at(scenario, [spec.path for spec in specs]), moved)
