"""From a moved control to a new scenario: wrong values are refused and restored, the last good ones kept."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from app.editing import edits
from app.http.viser_insides import show_held_value
from app.page import notices
from app.panels.control import Control
from app.session.session import Session
from navcore.errors import InputError
from navcore.scenario import Scenario

if TYPE_CHECKING:
    import viser

_UNFINISHED_S = 1.2
"""A typed value that is wrong is only refused when it stays: it may be on the way to a right one."""
_PASSING_S = 0.25
"""The same for a slider, which may only pass a wrong value."""
_BURST_OVER_S = 0.6
"""After this long without an event the server's values are shown again: the browser drops some while several
controls move at once."""
_HAND_OFF_S = 2.0
"""The same for the widget that was moved last: a step that its user makes just then would be counted from the
value that is shown again, and be lost."""


class Editor:
    """What the controls of one page do to the session.

    Parameters
    ----------
    client : viser.ClientHandle
        The browser.
    session : Session
        Whose scenario is edited.
    by : object
        Whom the session is told to be the author of changes.
    controls : callable
        Gives all controls of the page.
    shown_network : callable
        Gives what the page shows for the parameters of the network.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        session: Session,
        by: object,
        controls: Callable[[], Iterable[Control]],
        shown_network: Callable[[], Mapping[str, Any]],
    ) -> None:
        self.moved: Control | None = None
        """The control the user has in hand."""
        self._client, self._session, self._by = client, session, by
        self._controls, self._shown_network = controls, shown_network
        self._closed = False
        self._doubts: dict[Control, threading.Timer] = {}
        self._quiet: threading.Timer | None = None

    def edit(self, control: Control, by_slider: bool) -> None:
        """Take over what a control holds, if the scenario allows it."""
        with self._session.lock:
            if control.removed or self._closed:
                return
            shown = control.take(by_slider)
            self._touched(control)
            try:
                value = control.read(shown)
                changed = self._changed(control, value)
            except (InputError, ValueError) as error:
                self._doubt(control, shown, error)
                return
            self._trust(control)
            control.follow(value)
            self._session.change(changed, self._by)

    def put(self, control: Control, value: Any) -> None:
        """Set a control's field to a value that the control does not hold yet; raises `InputError`."""
        with self._session.lock:
            if not self._closed and not control.removed:
                self._trust(control)
                changed = self._changed(control, value)
                self._session.change(changed, None, name=f"reset {control.spec.label}")

    def close(self) -> None:
        """Let nothing follow any more."""
        with self._session.lock:
            self._closed = True
            for timer in (*self._doubts.values(), self._quiet):
                if timer is not None:
                    timer.cancel()

    def _changed(self, control: Control, value: Any) -> Scenario:
        scenario, path = self._session.scenario, control.spec.path
        if path[-1] == "id" or path == ("motion", "kind"):
            return edits.with_choice(scenario, path, value)
        return edits.with_value(scenario, path, value, self._shown_network())

    # ------------------------------------------------------------ wrong values

    def _doubt(self, control: Control, shown: Any, error: Exception) -> None:
        self._trust(control)
        delay_s = _UNFINISHED_S if control.typed else _PASSING_S
        timer = self._doubts[control] = _timer(delay_s, self._refuse, control, shown, error)
        timer.start()

    def _trust(self, control: Control) -> None:
        timer = self._doubts.pop(control, None)
        if timer is not None:
            timer.cancel()
        control.say("")

    def _refuse(self, control: Control, shown: Any, error: Exception) -> None:
        with self._session.lock, self._client.atomic():
            if self._closed or control.removed or control.moving or self._doubts.pop(control, None) is None:
                return
            control.show(control.value)
            kept = f"{control.value:.9g}" if control.spec.kind == "number" else control.as_text(control.value)
            if isinstance(error, InputError):
                lines = [notices.refusal(fault, kept) for fault in error.faults]
            else:
                lines = [f"{shown!r} was not taken over: cannot be read ({kept} is kept)"]
            control.refuse(lines)
        notices.tell(self._client, f"{control.spec.label}: not taken over", lines)
        self._client.flush()

    # ------------------------------------------------------------ bursts

    def _touched(self, control: Control) -> None:
        self.moved = control
        if self._quiet is not None:
            self._quiet.cancel()
        self._quiet = _timer(_BURST_OVER_S, self._burst_over, control)
        self._quiet.start()

    def _burst_over(self, last: Control) -> None:
        with self._session.lock, self._client.atomic():
            if self._closed or self._quiet is not threading.current_thread():
                return  # something has been moved again
            for control in self._controls():
                self._show_held(control.ids(but_moved=control is last))
            self._quiet = _timer(_HAND_OFF_S - _BURST_OVER_S, self._hand_off, last)
            self._quiet.start()
        self._client.flush()

    def _hand_off(self, last: Control) -> None:
        with self._session.lock, self._client.atomic():
            if self._closed or last.removed or self._quiet is not threading.current_thread():
                return
            self._show_held(last.ids(but_box=True))
        self._client.flush()

    def _show_held(self, ids: Iterable[str]) -> None:
        for id in ids:
            show_held_value(self._client._viser_server, self._client.client_id, id)


def _timer(delay_s: float, act: Callable[..., None], *arguments: Any) -> threading.Timer:
    timer = threading.Timer(delay_s, act, arguments)
    timer.daemon = True
    return timer
