"""One browser's connection: its session, its checked messages, its place among all others."""

import asyncio
import fcntl
import termios
import time
from array import array
from typing import Any

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ProtocolError
from websockets.frames import DATA_OPCODES, CloseCode, Frame, Opcode

from navcore.foundation.text import Text
from schuler_bench.http.frames import BadFrame, Gate
from schuler_bench.http.limits import Limits
from schuler_bench.http.places import Door, Places

GAVE_UP_PLACE = Text("This page was idle and gave up its place.")
"""Reason with which an idle page is closed."""
_COST_OF_PART = 5
"""A ping, a pong or a fragment counts as so many whole messages: a page sends hardly any."""
_ABORT_S = 0.3


class Connection(ServerConnection):
    """A websocket connection whose messages pass the gate.

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
        self._dismissed = False
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
                # Once what had already arrived is read, recv() reports the closed connection; viser handles
                # that quietly.
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
            self.loop.call_later(_ABORT_S, self.transport.abort)  # it may go on sending, and read nothing
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
