"""What the page's script sends of a control by its name: a value typed with a unit, a double click."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from app.editing.typed import read_typed, unit_of
from app.shell.commands import Commands
from app.shell.control import Control
from navcore.foundation.errors import Fault, InputError


class Typing:
    """Commands ``typed ID TAB TEXT`` and ``reset-named ID`` of one page (static/boxes.js).

    Parameters
    ----------
    commands : Commands
        Of the page.
    controls : callable
        Gives all controls of the page.
    put : callable
        ``put(control, value)`` changes a field; raises `InputError`.
    reset : callable
        ``reset(control)`` takes a field back to how the scenario was opened.
    """

    def __init__(
        self,
        commands: Commands,
        controls: Callable[[], Iterable[Control]],
        put: Callable[[Control, Any], None],
        reset: Callable[[Control], None],
    ) -> None:
        self._controls, self._put, self._reset = controls, put, reset
        commands.register("typed", self._typed)
        commands.register("reset-named", self._reset_named)

    def _of(self, id: str) -> Control | None:
        return next((control for control in self._controls() if id.strip() in control.ids), None)

    def _typed(self, argument: str) -> None:
        id, _, text = argument.partition("\t")
        control = self._of(id)
        if control is None or control.spec.kind not in ("number", "integer"):
            return
        name = control.spec.label
        try:
            value = read_typed(text.strip(), unit_of(name))
        except ValueError as error:
            raise InputError(Fault("", name, text.strip()[:40], str(error))) from None
        if control.spec.kind == "integer":
            if value != int(value):
                raise InputError(Fault("", name, text.strip()[:40], "must be a whole number"))
            value = int(value)
        self._put(control, value)

    def _reset_named(self, id: str) -> None:
        control = self._of(id)
        if control is not None:
            self._reset(control)
