"""The controls of a page by their ids: what they hold, locking them, showing what they hold again.

viser knows controls by the handles that it returned, not by the ids in its messages. Each function says what
the public interface lacks; `tests/attack/test_viser_insides.py` fails when an inside changes.
"""

import time
from dataclasses import dataclass
from typing import Any

import numpy as np
import viser
from viser import _gui_api as viser_gui
from viser import _messages as messages

from schuler_bench.bridge import texts

_NOTICE_EVERY_S = 1.0
_FREE, _GREYED = "_schuler_free", "_schuler_greyed"
"""Marks on a client's gui: ids that a locked page may still use, and those that the lock has disabled."""


@dataclass(frozen=True)
class Control:
    """Bounds by which a browser's new value for a control is judged.

    Attributes
    ----------
    label : str
        As the visitor sees it.
    value : object
        The value the server holds; its type is the type of the control.
    disabled : bool
        Writes are refused.
    options : tuple of str or None
        The only values allowed.
    bounds : tuple of float or None
        Set for controls whose widget cannot leave its range (sliders). Number boxes can: the scenario judges
        them.
    takes_files : bool
        It is an upload button.
    """

    label: str
    value: object
    disabled: bool
    options: tuple[str, ...] | None
    bounds: tuple[float, float] | None
    takes_files: bool


@dataclass
class Guest:
    """The visitor behind a connection, as the gate of messages sees them; viser has no look-up by ids.

    Attributes
    ----------
    server : viser.ViserServer
        The server.
    client_id : int
        viser's number of the connection.
    """

    server: viser.ViserServer
    client_id: int
    _last_notice_s: float = -_NOTICE_EVERY_S

    @property
    def _client(self) -> viser.ClientHandle | None:
        return self.server.get_clients().get(self.client_id)

    def _handle(self, uuid: str) -> Any:
        owners = [owner for owner in (self._client, self.server) if owner is not None]
        handles = (owner.gui._gui_input_handle_from_uuid.get(uuid) for owner in owners)
        return next((handle for handle in handles if handle is not None), None)

    def _queue(self, message: messages.Message) -> None:
        client = self._client
        if client is not None:
            client._websock_connection.queue_message(message)

    def control(self, uuid: str) -> Control | None:
        """Return the control with that id, if the visitor has it."""
        handle, client = self._handle(uuid), self._client
        if handle is None:
            return None
        state, props = handle._impl, handle._impl.props
        free = None if client is None else getattr(client.gui, _FREE, None)
        bounds = None
        if isinstance(handle, (viser.GuiSliderHandle, viser.GuiMultiSliderHandle)):
            bounds = (float(props.min), float(props.max))
        elif isinstance(handle, (viser.GuiRgbHandle, viser.GuiRgbaHandle)):
            bounds = (0.0, 255.0)
        return Control(
            label=str(getattr(props, "label", "") or ""),
            value=state.value,
            disabled=bool(getattr(props, "disabled", False)) or (free is not None and uuid not in free),
            options=getattr(props, "options", None),
            bounds=bounds,
            takes_files=isinstance(handle, viser.GuiUploadButtonHandle),
        )

    def meant(self, uuid: str, value: object) -> object:
        """Return an option that was chosen in the page's language as the server offers it."""
        return texts.meant(self.server, self.client_id, uuid, value)

    def restore(self, uuid: str) -> None:
        """Send the held value to a page that shows another one; assigning an equal value sends nothing."""
        handle = self._handle(uuid)
        if handle is not None and not handle._impl.is_button:
            self._queue(messages.GuiUpdateMessage(uuid, {"value": handle._impl.value}))

    def end_upload(self, component: str, transfer: str, size: int) -> None:
        """Let the page's progress bar end. Without it the button of a refused upload stays blocked."""
        self._queue(messages.FileTransferPartAck(component, transfer, size, size))

    def forget_upload(self, transfer: str) -> None:
        """Drop the parts of an upload that have come: viser keeps them until the last one has come."""
        client = self._client
        if client is not None:
            client.gui._current_file_upload_states.pop(transfer, None)

    def tell(self, title: str, text: str) -> None:
        """Show a short notice, at most one a second."""
        client, now_s = self._client, time.monotonic()
        if client is not None and now_s - self._last_notice_s >= _NOTICE_EVERY_S:
            self._last_notice_s = now_s
            client.add_notification(title, text, color="red", auto_close_seconds=8.0)


def lock_controls(client: viser.ClientHandle, but: frozenset[str] | None) -> None:
    """Let a page's user change nothing: controls are shown disabled, and what is sent for them is dropped.

    viser knows no list of a page's controls.

    Parameters
    ----------
    client : viser.ClientHandle
        The page. Controls made later are locked too, but shown so only after another call.
    but : frozenset of str or None
        Ids of the controls that stay free; None frees all that this function has locked.
    """
    gui: Any = client.gui
    greyed: set[str] = getattr(gui, _GREYED, set())
    setattr(gui, _FREE, but)
    setattr(gui, _GREYED, greyed)
    for uuid, handle in list(gui._gui_input_handle_from_uuid.items()):
        if isinstance(handle, viser.GuiButtonGroupHandle):  # viser cannot show it disabled
            continue
        if but is None and uuid in greyed:
            handle.disabled = False
        elif but is not None and uuid not in but and not getattr(handle, "disabled", True):
            handle.disabled = True
            greyed.add(uuid)
    if but is None:
        greyed.clear()


def show_numbers(plot: viser.GuiUplotHandle, data: tuple[np.ndarray, ...]) -> None:
    """Send a plot over time its numbers, if they are others, as float32: viser sends float64 only."""
    single = in_single(data)
    props: Any = plot._impl.props
    held = props.data
    if len(held) == len(single) and all(map(same_numbers, held, single)):
        return
    props.data = single
    plot._queue_update("data", single)


def same_numbers(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether two curves are equal, NaN counted as equal to NaN."""
    return one is other or np.array_equal(one, other, equal_nan=True)


def in_single(data: tuple[np.ndarray, ...]) -> tuple[np.ndarray, ...]:
    """Numbers as float32: a plot that is made with them shows the same ones as one that they are sent to."""
    return tuple(np.asarray(values, dtype=np.float32) for values in data)


def set_slider_range(
    handle: Any, low: float, high: float, step: float, marks: tuple[tuple[float, str], ...]
) -> None:
    """Give a slider other ends; viser sets the marks below it, and its digits, only when it makes the slider.

    Parameters
    ----------
    handle : viser.GuiSliderHandle
        The slider.
    low, high, step : float
        In its positions.
    marks : tuple of (float, str)
        Position and text of what stands below it.
    """
    handle.min, handle.max, handle.step = low, high, step
    handle.precision = viser_gui._compute_precision_digits_covering(handle.value, low, high, step)
    handle._marks = tuple(messages.GuiSliderMark(at, text) for at, text in marks)


def id_of(handle: Any) -> str:
    """Id of a control, in viser's messages and in the page; viser keeps it to itself."""
    return handle._impl.uuid


def control_with(gui: viser.GuiApi, id: str) -> Any:
    """Return the handle of a client's control from its id, None when there is none."""
    return gui._gui_input_handle_from_uuid.get(id)


def rail_style(left_px: int, right_px: int) -> str:
    """Style sheet that gives the docked panels exactly these widths: viser leaves 120 px between them."""
    return (
        f"<style>[data-dock-root] > :first-child {{ inset: 0 {right_px}px 0 {left_px}px !important; }}"
        "[data-dock-root] > :first-child > * { visibility: hidden; }"
        f"[data-dock-region=left] {{ width: {left_px}px !important; }}"
        f"[data-dock-region=right] {{ width: {right_px}px !important; }}"
        "[data-dock-region] > div > div { width: 100% !important; }</style>"
    )
