"""A group of controls for the fields of one model, rebuilt when the model changes."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Any

from app.editing.form import FieldSpec, Path
from app.shell.control import Control, Edit

if TYPE_CHECKING:
    import viser


class Section:
    """Controls in one container.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    container : context manager
        A folder or tab that holds the controls.
    edit : callable
        As for `Control`.
    order : float
        Place of the first control in the container.
    """

    def __init__(
        self, gui: viser.GuiApi, container: AbstractContextManager[Any], edit: Edit, order: float
    ) -> None:
        self._gui, self._container, self._edit, self._order = gui, container, edit, order
        self.controls: dict[Path, Control] = {}

    def show(self, specs: list[FieldSpec], values: Mapping[Path, Any], moved: Control | None) -> None:
        """Show these fields with these values; widgets are made anew only when the fields are others.

        Parameters
        ----------
        specs : list of FieldSpec
            What to show, in order.
        values : mapping
            Path -> value; a missing one leaves what is shown.
        moved : Control or None
            The control that the user is moving.
        """
        if [control.spec for control in self.controls.values()] != specs:
            self._rebuild(specs, values)
            return
        for path, control in self.controls.items():
            if control is not moved:
                control.show(values.get(path))

    def _rebuild(self, specs: list[FieldSpec], values: Mapping[Path, Any]) -> None:
        for control in self.controls.values():
            control.remove()
        with self._container:
            self.controls = {
                spec.path: Control(
                    self._gui, spec, self._edit, self._order + index, values.get(spec.path, spec.default)
                )
                for index, spec in enumerate(specs)
            }


def controls_of(sections: Mapping[str, Section]) -> list[Control]:
    """All controls of some sections, in order."""
    return [control for section in sections.values() for control in section.controls.values()]
