"""A box for one number that is no field of the scenario: its text is read as a whole, or refused."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from navcore.foundation.errors import Fault
from navcore.foundation.numbers import NotANumber
from navcore.foundation.text import Text
from navcore.foundation.with_unit import read_with_unit
from schuler_bench.bridge.boxes import mark_number_box
from schuler_bench.editing.typed import unit_of, write_number
from schuler_bench.shell import notices
from schuler_bench.shell.control import Widget

if TYPE_CHECKING:
    import viser


class NumberBox:
    """A text box that holds a number.

    Parameters
    ----------
    client : viser.ClientHandle
        The browser; the box goes into its present container.
    label : str
        Its unit, if it has one, in brackets at the end.
    value : float
        To show first.
    changed : callable, optional
        Called with the number that the user has given. It judges the range.
    step : float
        By which the arrow keys change it.
    whole : bool
        Whole numbers only.
    hint : str
        For the tooltip.
    visible : bool
        Whether it is shown.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        label: str,
        value: float,
        changed: Callable[[float], None] | None = None,
        *,
        step: float = 1.0,
        whole: bool = False,
        hint: str = "",
        visible: bool = True,
    ) -> None:
        self._client, self._label, self._changed, self._whole = client, label, changed, whole
        self.value = value
        """The last number that was read, or shown."""
        handle = client.gui.add_text(label, write_number(value), hint=hint or None, visible=visible)
        mark_number_box(client.gui, handle, step)
        self._box = Widget(handle)
        handle.on_update(lambda event: self._take() if event.client is not None else None)

    def show(self, value: float) -> None:
        """Show a number, unless the user has just given another one."""
        if not self._box.awaited:
            self.value = value
            self._box.show(write_number(value))

    @property
    def visible(self) -> bool:
        """Whether it is shown."""
        return self._box.handle.visible

    @visible.setter
    def visible(self, visible: bool) -> None:
        self._box.handle.visible = visible

    def _take(self) -> None:
        entered = self._box.take()
        try:
            value = read_with_unit(entered, unit_of(self._label), whole=self._whole)
        except NotANumber as error:
            kept = write_number(self.value)
            line = notices.refusal(Fault("", "", entered, error.allowed), kept, typed=True)
            self._box.show(kept)
            notices.tell(self._client, Text("{label}: rejected", label=self._label), [line])
            return
        self.value = value
        self._box.show(write_number(value))
        if self._changed is not None:
            self._changed(value)
