"""From a moved control to a new scenario: wrong values are refused and restored, the last good ones kept."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.numbers import NotANumber
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.editing import edits
from schuler_bench.editing.form import Path
from schuler_bench.session.session import Session
from schuler_bench.shell import notices
from schuler_bench.shell.control import Control
from schuler_bench.shell.pace import timer

if TYPE_CHECKING:
    import viser

_UNFINISHED_S = 1.2
"""A typed value that is wrong is only refused when it stays: it may be on the way to a right one."""
_PASSING_S = 0.25
"""The same for a slider, which may only pass a wrong value."""


class Editor:
    """Link between the controls of one page and the session.

    Parameters
    ----------
    client : viser.ClientHandle
        The browser.
    session : Session
        Whose scenario is edited.
    by : object
        Author of the changes, for the session.
    controls : callable
        Gives all controls of the page.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        session: Session,
        by: object,
        controls: Callable[[], Iterable[Control]],
    ) -> None:
        self.moved: Control | None = None
        """The control that the user moves."""
        self.by_slider = False
        """It is moved by its slider, so that its field keeps its place among the others."""
        self._client, self._session, self._by = client, session, by
        self._controls = controls
        self._closed = False
        self._motions: dict[tuple[str, str, str], Mapping[str, Any]] = {}
        self._doubts: dict[Control, threading.Timer] = {}

    def edit(self, control: Control, by_slider: bool) -> None:
        """Take over what a control holds, if the scenario allows it."""
        with self._session.lock:
            if control.removed or self._closed:
                return
            entered = control.take(by_slider)
            self.moved, self.by_slider = control, by_slider
            try:
                value = control.read(entered)
                changed = self._changed(control, value)
            except (InputError, ValueError) as error:
                self._doubt(control, entered, error)
                return
            self._trust(control)
            control.follow(value)
            self._session.change(changed, self._by)

    def put(self, control: Control, value: Any, name: str | None = None) -> None:
        """Set a control's field to a value that the control does not hold yet; raises `InputError`.

        ``name`` is what undo calls it: a reset, if None.
        """
        with self._session.lock:
            if not self._closed and not control.removed:
                self._trust(control)
                changed = self._changed(control, value)
                said = Text("reset {label}", label=control.spec.label) if name is None else name
                self._session.change(changed, None, name=said)

    def drag(self, changed: Scenario, name: str, gesture: str) -> None:
        """Take over what a handle in a plot gives while it is dragged: as a slider, without a control.

        Parameters
        ----------
        changed : Scenario
            With the new values.
        name : str
            What undo calls it.
        gesture : str
            Marks the drag, which is one step of undo.
        """
        with self._session.lock:
            if not self._closed:
                self.moved, self.by_slider = None, True
                self._session.change(changed, self._by, name=name, gesture=gesture)

    def catch_up(self) -> None:
        """Let the box of the moved slider follow it."""
        if self.moved is not None:
            self.moved.catch_up()

    def close(self) -> None:
        """Let nothing follow any more."""
        with self._session.lock:
            self._closed = True
            for waiting in self._doubts.values():
                waiting.cancel()

    def _changed(self, control: Control, value: Any) -> Scenario:
        scenario, path = self._session.scenario, control.spec.path
        if path[-1] == "id" or path == ("motion", "kind"):
            return edits.with_choice(scenario, path, value, self._earlier(scenario, path, value))
        return edits.with_value(scenario, path, value, lambda: self._beside(path))

    def _beside(self, path: Path) -> dict[str, Any]:
        """Values of the controls for the other numbers of the same model: name -> value."""
        beside: dict[str, Any] = {}
        for control in self._controls():
            if control.spec.kind == "number" and control.spec.path[:-1] == path[:-1]:
                beside.setdefault(str(control.spec.path[-1]), control.held)
        return beside

    def _earlier(self, scenario: Scenario, path: Path, chosen: str) -> Mapping[str, Any] | None:
        """Fields of the motion when it was last of the kind chosen; those of the present one are kept."""
        if path[0] != "motion":
            return None
        whose = scenario.title, scenario.source
        self._motions[(*whose, scenario.motion.kind)] = scenario.canonical()["motion"]
        return self._motions.get((*whose, chosen))

    # ------------------------------------------------------------ wrong values

    def _doubt(self, control: Control, entered: Any, error: Exception) -> None:
        self._trust(control)
        delay_s = _UNFINISHED_S if control.typed else _PASSING_S
        doubt = self._doubts[control] = timer(delay_s, self._refuse, control, entered, error)
        doubt.start()

    def _trust(self, control: Control) -> None:
        doubt = self._doubts.pop(control, None)
        if doubt is not None:
            doubt.cancel()
        control.say("")

    def _refuse(self, control: Control, entered: Any, error: Exception) -> None:
        with self._session.lock, self._client.atomic():
            if self._closed or control.removed or control.moving or self._doubts.pop(control, None) is None:
                return
            control.restore()
            kept = control.as_text(control.value)
            if isinstance(error, InputError):
                field = ".".join(map(str, control.spec.path))
                typed = control.holds_numbers and isinstance(entered, str)
                faults = [_as_given(fault, field, entered) for fault in error.faults]
                lines: list[str] = [
                    notices.refusal(fault, kept, field, entered, typed=typed) for fault in faults
                ]
            else:
                allowed = error.allowed if isinstance(error, NotANumber) else Text("cannot be read")
                lines = [notices.refusal(Fault("", "", entered, allowed), kept, typed=True)]
            control.refuse(lines)
        notices.tell(self._client, Text("{label}: rejected", label=control.spec.label), lines)
        self._client.flush()


def _as_given(fault: Fault, field: str, entered: Any) -> Fault:
    """Return a fault of a box's own number with the text that was typed for it."""
    return replace(fault, value=entered) if isinstance(entered, str) and fault.field == field else fault
