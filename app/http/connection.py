"""One browser's connection: its session, its checked messages, its place among all others."""

import asyncio
import contextlib
import fcntl
import termios
import time
from array import array
from typing import Any

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed, ProtocolError
from websockets.frames import DATA_OPCODES, CloseCode, Frame, Opcode
from websockets.protocol import State

from navcore.foundation.text import Text
from schuler_bench.http.frames import BadFrame, Gate
from schuler_bench.http.limits import MIB, Limits
from schuler_bench.http.places import Door, Places

GAVE_UP_PLACE = Text("This page was idle and gave up its place.")
"""Reason with which an idle page is closed."""
_COST_OF_PART = 5
"""A ping, a pong or a fragment counts as so many whole messages: a page sends hardly any."""
_LAST_WORD_S, _MOST_DROPPED = 0.3, 16 * MIB
"""So long, and so many bytes, the other side may go on sending while the last word is on its way to it."""


class Connection(ServerConnection):
    """A websocket connection whose messages pass the gate.

    It ends with a close frame of either side, a fault of the protocol, a refused request or an HTTP answer.
    websockets would then read on until the other side closes the socket; here nothing that still comes is
    taken, and the socket is closed: at once if nothing comes, else within `_LAST_WORD_S` and `_MOST_DROPPED`.

    Parameters
    ----------
    *args, **keywords
        As websockets makes its connections.
    limits : Limits
        Sizes and rates.
    door : Door
        Where it waits until it is an open page.
    places : Places
        Of the open pages.

    Attributes
    ----------
    address : str
        Where it comes from; of a reverse proxy, if there is one.
    session_id : str
        Of the page it belongs to.
    active_s : float
        When the page last sent something, monotonic.
    asked : bool
        A request has arrived.
    """

    def __init__(self, *args: Any, limits: Limits, door: Door, places: Places, **keywords: Any) -> None:
        super().__init__(*args, **keywords)
        self.address = ""
        self.session_id = ""
        self.active_s = time.monotonic()
        self._asked = False
        self.gate: Gate | None = None
        self._limits, self._door, self._places = limits, door, places
        self._dismissed = self._ended = False
        self._dropped = 0
        self._window_start_s = 0.0
        self._frames_in_window = 0
        # websockets answers pings and collects fragments as it parses them: they are counted there.
        self._take_frame = self.protocol.recv_frame
        self.protocol.recv_frame = self._count_frame
        self._second, self._counted, self._fragments = 0, 0, 0

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Register the connection; another one may have to go."""
        super().connection_made(transport)
        peer = transport.get_extra_info("peername")
        self.address = str(peer[0]) if isinstance(peer, tuple) and peer else ""
        self._door.enter(self)

    def connection_lost(self, exc: Exception | None) -> None:
        """Forget the connection."""
        self._door.leave(self)
        self._places.leave(self)
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Take what has come; after the end drop it, and too much of it closes the socket."""
        if not self._ended:
            super().data_received(data)
            return
        self._dropped += len(data)
        if self._dropped > _MOST_DROPPED:
            self.transport.abort()

    def send_data(self) -> None:
        """Send what is to be sent; after the last word the connection ends."""
        super().send_data()
        if self.protocol.eof_sent and not self._ended:
            self._ended = True
            self._end()

    def _end(self) -> None:
        """Close the socket: at once where the other side has said its last word too, else in a moment."""
        answering = self.protocol.state is State.CONNECTING
        if (answering or self.protocol.close_rcvd is not None) and _unread(self.transport) == 0:
            self.transport.close()
            if answering:  # websockets bounds how long an answer may take to be sent
                return
        # A socket that is closed with something unread resets the connection: the other side might not learn
        # why it has ended.
        self.loop.call_later(_LAST_WORD_S, self.transport.abort)

    async def close(self, code: int = CloseCode.NORMAL_CLOSURE, reason: str = "") -> None:
        """Close the connection with a word; what the other side says to that is not waited for."""
        with contextlib.suppress(ConnectionClosed):
            async with self.send_context():
                self.protocol.fail(code, reason)

    @property
    def asked(self) -> bool:
        """Whether a request has arrived, also if still unread: many may be taken before one is read."""
        return self._asked or _unread(self.transport) > 0

    @asked.setter
    def asked(self, asked: bool) -> None:
        self._asked = asked

    def turn_away(self) -> None:
        """Close a connection that is still at the door, with a word if it can still be read."""
        if self.transport.get_write_buffer_size() == 0 and not self.asked:
            body = b"Too many connections; try again later.\n"
            head = "HTTP/1.1 503 Service Unavailable\r\nConnection: close\r\n"
            head += f"Content-Type: text/plain\r\nContent-Length: {len(body)}\r\n\r\n"
            try:
                self.transport.write(head.encode() + body)
            except RuntimeError:  # websockets has ended its side already
                self.transport.abort()
            else:
                self.transport.close()
        else:
            self.transport.abort()

    def give_up_place(self) -> None:
        """Close the page: it has long been idle, and somebody else needs its place."""
        self._dismissed = True
        self._closing = asyncio.ensure_future(self.close(CloseCode.TRY_AGAIN_LATER, GAVE_UP_PLACE))

    async def recv(self, decode: bool | None = None) -> Any:
        """Return the next message that passes the gate."""
        while True:
            frame = await super().recv(decode)
            self.active_s = time.monotonic()
            await self._pace()
            if self._dismissed:
                continue
            if self.gate is None:
                return frame
            try:
                accepted = self.gate.judge(frame)
            except BadFrame as error:
                # Once what had already been taken is read, recv() reports the closed connection; viser
                # handles that quietly.
                self._dismissed = True
                await self.close(CloseCode.POLICY_VIOLATION, str(error)[:100])
                continue
            if accepted is not None:
                return accepted

    def _count_frame(self, frame: Frame) -> None:
        """Take a frame of any kind; too many end the connection, by a `ProtocolError` while it is parsed."""
        whole = frame.fin and frame.opcode in (Opcode.TEXT, Opcode.BINARY)
        if int(self.loop.time()) != self._second:
            self._second, self._counted = int(self.loop.time()), 0
        self._counted += 1 if whole else _COST_OF_PART
        if frame.opcode in DATA_OPCODES:
            self._fragments = 0 if frame.fin else self._fragments + 1
        limits = self._limits
        if self._counted > limits.frames_at_once or self._fragments > limits.fragments:
            self._dismissed = True
            raise ProtocolError("too many frames")
        self._take_frame(frame)

    async def _pace(self) -> None:
        now_s = time.monotonic()
        if now_s - self._window_start_s >= 1.0:
            self._window_start_s, self._frames_in_window = now_s, 0
        self._frames_in_window += 1
        if self._frames_in_window >= self._limits.frames_per_second:
            await asyncio.sleep(max(0.0, self._window_start_s + 1.0 - now_s))


def _unread(transport: asyncio.BaseTransport) -> int:
    """Bytes that have come and are still to be read."""
    socket, count = transport.get_extra_info("socket"), array("i", [0])
    try:
        fcntl.ioctl(socket.fileno(), termios.FIONREAD, count)
    except (AttributeError, OSError, ValueError):  # no socket, or closed
        return 0
    return count[0]
