"""Mends of viser's server: a page's queue, its language and curves; the callbacks' threads; types.

A mend whose place is missing in the installed viser is left out and logged once: the page works without it,
more slowly, and without the queue in English. ``SCHULER_PLAIN_VISER=1`` leaves out all mends.
"""

import asyncio
import dataclasses
import logging
import os
from collections.abc import AsyncGenerator, Callable, Hashable, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache, partial
from types import SimpleNamespace
from typing import Any, ClassVar, get_type_hints

import msgspec
import numpy as np
import viser
from viser import _messages as messages
from viser._assignable_props_api import AssignablePropsBase
from viser.infra import _infra
from viser.infra._async_message_buffer import AsyncMessageBuffer

from schuler_bench.bridge.controls import same_numbers
from schuler_bench.bridge.pool import FairPool
from schuler_bench.bridge.texts import Translator

_CALLBACK_THREADS = 16
_CAST = "_schuler_cast"
"""Where viser's own method is kept."""
_AT_ONCE = 2048
"""Messages that go to a page in one piece: all that it is made of at its opening."""
_log = logging.getLogger("schuler.bridge")


def plain_viser() -> bool:
    """Whether viser is to be left as it is."""
    return os.environ.get("SCHULER_PLAIN_VISER") == "1"


@cache
def left_out(mend: str) -> None:
    """Log, once, that a mend does not fit the installed viser."""
    _log.warning("viser %s is used without a mend: %s", viser.__version__, mend)


def _fits(mend: str, owner: object, *names: str) -> bool:
    """Whether all that a mend exchanges is there."""
    if plain_viser():
        return False
    fits = all(hasattr(owner, name) for name in names)
    if not fits:
        left_out(mend)
    return fits


class _LoopEvent(asyncio.Event):
    """An event that is set in its own event loop alone; from anywhere else nothing happens.

    Parameters
    ----------
    home : asyncio.AbstractEventLoop
        Its event loop.
    """

    def __init__(self, home: asyncio.AbstractEventLoop) -> None:
        super().__init__()
        self._home = home

    def set(self) -> None:
        """Set the event, if its event loop calls: another thread may have a loop of its own."""
        if asyncio._get_running_loop() is self._home:
            super().set()


@dataclass
class MendedBuffer(AsyncMessageBuffer):
    """viser's queue of what is to be sent to a page, without its lost wake-up.

    viser's ``push`` sets the queue's `asyncio.Event` in the calling thread *and* has the event loop set it.
    When the first call falls between the loop's look at the event and its entry among the waiters, the event
    is set, nobody is woken, and the second call does nothing, because the event is set already: the message
    stays in the queue until the next one comes, which may be never. Without the first call nothing is lost:
    whatever is pushed or ends an atomic block has the event loop set the event.

    viser sends 128 messages at a time. A page is made of four times as many, and viser's page lays itself out
    anew after each piece.
    """

    max_window_size: int = _AT_ONCE

    shortens: ClassVar[bool] = True
    """Whether the page's script puts in the curves that are left out."""
    translator: Translator | None = None
    """Translates what the page is sent; None: it reads English."""

    def __post_init__(self) -> None:
        """Exchange the event."""
        self.message_event = _LoopEvent(self.event_loop)

    def push(self, message: Any) -> None:
        """Queue a message, in the page's language."""
        super().push(message if self.translator is None else self.translator.message(message))

    def window_generator(
        self, client_id: int, backlog_done_message: Any = None
    ) -> AsyncGenerator[Sequence[Any], None]:
        """Take out what is to be sent; of the curves that the page has, nothing."""
        windows = super().window_generator(client_id, backlog_done_message)
        # What is queued for all pages is kept for those to come: it stays as it is.
        return windows if self.persistent_messages or not self.shortens else _shortened(windows)


async def _shortened(
    windows: AsyncGenerator[Sequence[Any], None],
) -> AsyncGenerator[Sequence[Any], None]:
    """Leave out the curves that a page has, for which `curves.js` puts in the page's own.

    A slider changes one of several methods, but viser sends a plot whole: the time and the curves of all
    methods. What is left out is decided when a message is taken from the page's queue, not when it is put
    into it. In the queue a plot's newer numbers replace those that have not been sent yet, so a message
    shortened there could refer to curves that the page never gets. What is taken from the queue is sent next,
    over one connection, which keeps the order. When the connection is lost, the page that comes back is
    another client with a queue of its own, and is sent all plots whole.
    """
    sent: dict[str, tuple[np.ndarray, ...]] = {}
    try:
        async for window in windows:
            yield [_shorter(message, sent) for message in window]
    finally:
        await windows.aclose()


def _shorter(message: Any, sent: dict[str, tuple[np.ndarray, ...]]) -> Any:
    """Put None in the place of each curve that was sent; the message itself stays as it is."""
    if isinstance(message, messages.GuiUplotMessage):
        # The handle and its message share these, and the handle goes on changing them.
        props = dataclasses.replace(message.props)
        sent[message.uuid] = props.data
        return dataclasses.replace(message, props=props)
    if isinstance(message, messages.GuiRemoveMessage):
        sent.pop(message.uuid, None)
    elif isinstance(message, messages.GuiUpdateMessage) and "data" in message.updates:
        before, data = sent.get(message.uuid), message.updates["data"]
        if before is not None:
            sent[message.uuid] = data
            if len(before) == len(data):
                pairs = zip(before, data, strict=True)
                curves = tuple(None if same_numbers(old, new) else new for old, new in pairs)
                return dataclasses.replace(message, updates={**message.updates, "data": curves})
    return message


def mend_queues() -> None:
    """Let every page that connects from now on have a mended queue, through which a `Text` can pass."""
    changed: Any = _infra
    encode = partial(msgspec.msgpack.encode, enc_hook=_as_plain)
    changed.msgspec = SimpleNamespace(msgpack=SimpleNamespace(encode=encode))
    queue = AsyncMessageBuffer.__name__
    if _fits("no message is lost in a page's queue", _infra, queue):
        setattr(_infra, queue, MendedBuffer)


def _as_plain(value: object) -> str:
    """Return the plain string of a `Text`, which msgspec does not take."""
    if isinstance(value, str):
        return str(value)
    raise TypeError(f"{type(value).__name__} cannot be sent to a page")


_hints_of = lru_cache(maxsize=None)(get_type_hints)


def share_hints() -> None:
    """Let all handles of a kind share the types of their properties.

    viser works them out for each handle, at its first change, and keeps them with it: on a page of ours that
    is a tenth of a second and a megabyte.
    """
    changed: Any = AssignablePropsBase
    names = "_prop_hints", "_cast_value_recursive"
    if not _fits("handles of a kind share the types of their properties", changed, *names):
        return
    changed._prop_hints = property(lambda handle: _hints_of(type(handle._impl.props)))
    if not hasattr(AssignablePropsBase, _CAST):
        setattr(changed, _CAST, changed._cast_value_recursive)
        changed._cast_value_recursive = _cast


def _cast(handle: Any, hint: Any, value: Any, name: str) -> Any:
    """Convert as viser does, without asking for each text whether an array is wanted."""
    return value if isinstance(value, str | bool) else getattr(handle, _CAST)(hint, value, name)


def share_threads_fairly(server: viser.ViserServer) -> None:
    """Exchange viser's pool, where one visitor's callbacks can fill all threads and the queue before them."""
    if not _fits("visitors share the callbacks' threads fairly", server, "_thread_executor"):
        return
    pool: Any = FairPool(_CALLBACK_THREADS, _visitor_of, _read_again)
    server._thread_executor.shutdown(wait=False)
    server._thread_executor = server.gui._thread_executor = server.scene._thread_executor = pool


def pool_of(server: viser.ViserServer) -> object:
    """Threads that carry out the visitors' callbacks: a `FairPool`, if viser is mended."""
    return getattr(server, "_thread_executor", None)


def work_for(server: viser.ViserServer, client_id: int, owner: Hashable) -> None:
    """Let what a visitor's callbacks put into the cache of stages belong to an owner."""
    if isinstance(pool := pool_of(server), FairPool):
        pool.work_for(client_id, owner)


def forget_callbacks(server: viser.ViserServer, client_id: int) -> None:
    """Drop the callbacks of a visitor who has gone that have not begun."""
    if isinstance(pool := pool_of(server), FairPool):
        pool.forget(client_id)


def _visitor_of(arguments: tuple[Any, ...]) -> object:
    event = arguments[0] if arguments else None
    owner = event if hasattr(event, "client_id") else getattr(event, "client", None)
    return getattr(owner, "client_id", None)


def _read_again(call: Callable[..., Any], arguments: tuple[Any, ...]) -> object:
    """A control's callback reads the value the control holds then: of several that wait, one is enough."""
    event = arguments[0] if arguments else None
    if isinstance(event, viser.CameraHandle):
        return call, id(event)
    target = getattr(event, "target", None)
    state: Any = getattr(target, "_impl", None)
    if isinstance(target, viser.GuiUploadButtonHandle) or getattr(state, "is_button", True):
        return None
    return call, state.uuid
