"""Every use of viser's insides, in one place, for exactly one version.

Each entry says why the public interface does not do; `tests/attack/test_viser_insides.py` fails when an
inside changes.
"""

from __future__ import annotations

import threading
import types
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import rich
import viser
import websockets
import websockets.asyncio.server
from viser import _messages as messages
from viser.infra import _infra

from navcore.errors import Fault, InputError

VISER_VERSION = "1.1.1"

PAGE_SCRIPT_HASHES = (
    # The loader that stands in the page, and the program it unpacks and inserts.
    "sha256-5iRcjB7VnwnYpbUpHa15FmjNIRu22hIQnvWuocHMxJw=",
    "sha256-o/BTEGoB4UnTxqb+3RxwUFQZkWXpqUxouHkbDNrAkqE=",
)

FRAME_TYPES: dict[str, type] = {
    # What a browser may send: every message viser has a handler for, except the share tunnel (opens a public
    # address) and forms (repeated to all visitors and kept for ever under any name the sender invents).
    kind.__name__: kind
    for kind in (
        messages.CommandTriggerMessage,
        messages.FileTransferPart,
        messages.FileTransferStartUpload,
        messages.GetRenderResponseMessage,
        messages.GuiButtonHoldMessage,
        messages.GuiUpdateMessage,
        messages.LocalStorageGetItemResponseMessage,
        messages.SceneNodeClickMessage,
        messages.SceneNodeDragMessage,
        messages.ScenePointerMessage,
        messages.TransformControlsDragEndMessage,
        messages.TransformControlsDragStartMessage,
        messages.TransformControlsUpdateMessage,
        messages.ViewerCameraMessage,
    )
}
IGNORED_FRAMES = frozenset(
    {"ShareUrlRequest", "ShareUrlDisconnect", "GuiFormSubmitMessage", "GuiFormDirtyMessage"},
)

_FREE, _GREYED = "_schuler_free", "_schuler_greyed"
"""Marks on a client's gui: ids that a locked page may still use, and those that the lock has disabled."""

_one_start_at_a_time = threading.Lock()


@dataclass(frozen=True)
class Control:
    """What a browser's new value for a control is judged by.

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


def require_pinned_version() -> None:
    """Refuse another viser than the one the insides were read from.

    Raises
    ------
    InputError
        Another version is installed.
    """
    if viser.__version__ != VISER_VERSION:
        wanted = f"must be {VISER_VERSION}: make setup"
        raise InputError([Fault("installation", "viser", viser.__version__, wanted)])


def page_html() -> str:
    """Return viser's page, which viser serves only under ``/`` and with no place for scripts of ours."""
    return (Path(viser.__file__).parent / "client" / "build" / "index.html").read_text(encoding="utf-8")


def make_server(serve: Callable[..., Any], label: str) -> viser.ViserServer:
    """Start viser with `serve` in place of the one of websockets, and without a word on the console.

    viser has no hook for the handshake, the HTTP answers or a bound socket; its one call of ``serve`` is
    where all three can be given. viser prints through rich even with ``verbose=False``, also from its own
    thread later on: rich's shared console is set to quiet for the process. Whoever prints with rich uses a
    console of their own.

    Parameters
    ----------
    serve : callable
        Takes viser's arguments (handler, host, port, keywords), returns an asynchronous context manager.
    label : str
        Shown at the top of the controls.
    """
    rich.reconfigure(quiet=True)
    # Host and port only appear in what viser would print: `serve` holds the bound socket.
    with _one_start_at_a_time, _serve_replaced(serve):
        server = viser.ViserServer(host="127.0.0.1", port=0, label=label, verbose=False)
    for request in (messages.ShareUrlRequest, messages.ShareUrlDisconnect):
        server._websock_server.unregister_handler(request)
    return server


@contextmanager
def _serve_replaced(serve: Callable[..., Any]) -> Iterator[None]:
    # Only viser's own name `websockets` is exchanged, and only while it starts: other users of the library in
    # this process never see it.
    stand_in = types.SimpleNamespace(
        **{name: getattr(websockets, name) for name in ("datastructures", "exceptions")},
        asyncio=types.SimpleNamespace(server=types.SimpleNamespace(serve=serve)),
    )
    name = "websockets"
    original = getattr(_infra, name)
    setattr(_infra, name, stand_in)
    try:
        yield
    finally:
        setattr(_infra, name, original)


def on_socket(
    server: viser.ViserServer,
    opened: Callable[[int, Any], None],
    closed: Callable[[int], Awaitable[None]],
) -> None:
    """Call `opened(client_id, connection)` and `closed(client_id)` in the event loop, before any message.

    viser's public callbacks come only after the first camera message, carry no connection, and run
    concurrently.
    """
    inner = server._websock_server

    async def connected(client: Any) -> None:
        opened(client.client_id, inner._live_connections[client.client_id])

    async def disconnected(client: Any) -> None:
        await closed(client.client_id)

    inner.on_client_connect(connected)
    inner.on_client_disconnect(disconnected)


def plotly_is_on_the_page(owner: viser.ViserServer | viser.ClientHandle) -> None:
    """Tell viser not to send plotly.js: the page loads it as a file.

    viser queues the 4.8 MB source for every client and has it run by ``eval``; as a file it is sent once,
    cached by the browser, and the page needs no permission to ``eval``.
    """
    owner.gui._setup_plotly_js = True


def leaving_is_no_fault(client: viser.ClientHandle) -> None:
    """Do not warn of what is written to a visitor who has just gone.

    viser reports a departure only after it has closed the connection; whatever is on its way in between is
    dropped, which is as it should be, but with a warning.
    """
    client._websock_connection.get_message_buffer()._warned_push_after_done = True


def find_control(server: viser.ViserServer, client_id: int, uuid: str) -> Control | None:
    """Return the control a browser's message is about; viser offers no look-up by its id."""
    handle = _find_handle(server, client_id, uuid)
    if handle is None:
        return None
    state, props = handle._impl, handle._impl.props
    bounds = None
    if isinstance(handle, (viser.GuiSliderHandle, viser.GuiMultiSliderHandle)):
        bounds = (float(props.min), float(props.max))
    elif isinstance(handle, (viser.GuiRgbHandle, viser.GuiRgbaHandle)):
        bounds = (0.0, 255.0)
    return Control(
        label=str(getattr(props, "label", "") or ""),
        value=state.value,
        disabled=bool(getattr(props, "disabled", False)) or _is_locked(server, client_id, uuid),
        options=getattr(props, "options", None),
        bounds=bounds,
        takes_files=isinstance(handle, viser.GuiUploadButtonHandle),
    )


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


def _is_locked(server: viser.ViserServer, client_id: int, uuid: str) -> bool:
    client = server.get_clients().get(client_id)
    free = None if client is None else getattr(client.gui, _FREE, None)
    return free is not None and uuid not in free


def show_held_value(server: viser.ViserServer, client_id: int, uuid: str) -> None:
    """Send the held value to a page that shows another one; assigning an equal value sends nothing."""
    handle = _find_handle(server, client_id, uuid)
    if handle is not None and not handle._impl.is_button:
        _queue(server, client_id, messages.GuiUpdateMessage(uuid, {"value": handle._impl.value}))


def end_upload(server: viser.ViserServer, client_id: int, component: str, transfer: str, size: int) -> None:
    """Let the page's progress bar end. Without it the button of a refused upload stays blocked."""
    _queue(server, client_id, messages.FileTransferPartAck(component, transfer, size, size))


def _queue(server: viser.ViserServer, client_id: int, message: messages.Message) -> None:
    client = server.get_clients().get(client_id)
    if client is not None:
        client._websock_connection.queue_message(message)


def _find_handle(server: viser.ViserServer, client_id: int, uuid: str) -> Any:
    client = server.get_clients().get(client_id)
    for owner in (client, server):
        handle = None if owner is None else owner.gui._gui_input_handle_from_uuid.get(uuid)
        if handle is not None:
            return handle
    return None
