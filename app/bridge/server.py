"""The viser server and its connections: every use of what viser keeps to itself.

Each entry says why the public interface does not do; `tests/attack/test_viser_insides.py` fails when an
inside changes. Controls are in `schuler_bench.bridge.controls`.
"""

import re
import threading
import types
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from typing import Any

import rich
import viser
import websockets
import websockets.asyncio.server
from viser import _messages as messages
from viser.infra import _infra

from navcore.foundation.errors import Fault, InputError
from schuler_bench.bridge.mends import mend_queues, share_hints, share_threads_fairly

KNOWN = "1.1.1"
"""The version whose insides were read."""

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

_one_start_at_a_time = threading.Lock()


def require_known_version() -> None:
    """Refuse a viser older than the one whose insides were read, or of the next major version.

    Raises
    ------
    InputError
        Another version is installed.
    """
    known, installed = (tuple(map(int, re.findall(r"\d+", v)[:3])) for v in (KNOWN, viser.__version__))
    if not known <= installed < (known[0] + 1,):
        wanted = f"must be >= {KNOWN} and < {known[0] + 1}: make setup"
        raise InputError(Fault("installation", "viser", viser.__version__, wanted))


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
    mend_queues()
    share_hints()
    # Host and port only appear in what viser would print: `serve` holds the bound socket.
    with _one_start_at_a_time, _serve_replaced(serve):
        server = viser.ViserServer(host="127.0.0.1", port=0, label=label, verbose=False)
    for request in (messages.ShareUrlRequest, messages.ShareUrlDisconnect):
        server._websock_server.unregister_handler(request)
    share_threads_fairly(server)
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

    viser queues the source, 4.8 MB, for every client and has it run by ``eval``; as a file it is sent once,
    cached by the browser, and the page needs no permission to ``eval``.
    """
    owner.gui._setup_plotly_js = True


def leaving_is_no_fault(client: viser.ClientHandle) -> None:
    """Do not warn of what is written to a visitor who has just gone.

    viser reports a departure only after it has closed the connection; whatever is on its way in between is
    dropped, which is as it should be, but with a warning.
    """
    client._websock_connection.get_message_buffer()._warned_push_after_done = True
