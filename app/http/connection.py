"""One browser's connection: its session, its checked messages, its place among all others."""

from __future__ import annotations

import asyncio
import time
from dataclasses import dataclass
from typing import Any

import viser
from websockets.asyncio.server import ServerConnection
from websockets.frames import CloseCode

from app.http import viser_insides
from app.http.frames import BadFrame, Gate
from app.http.limits import Limits

_NOTICE_EVERY_S = 1.0


class Connection(ServerConnection):
    """A websocket connection whose messages pass the gate.

    Parameters
    ----------
    *args, **keywords
        As websockets makes its connections.
    limits : Limits
        Sizes and rates.
    """

    def __init__(self, *args: Any, limits: Limits, **keywords: Any) -> None:
        super().__init__(*args, **keywords)
        self.session_id = ""
        self.gate: Gate | None = None
        self._limits = limits
        self._dismissed = False
        self._window_start_s = 0.0
        self._frames_in_window = 0

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Register the connection; turn it away at once when there are too many."""
        super().connection_made(transport)
        if len(self.server.handlers) > self._limits.sockets:
            body = b"Too many connections; try again later.\n"
            head = "HTTP/1.1 503 Service Unavailable\r\nConnection: close\r\n"
            head += f"Content-Type: text/plain\r\nContent-Length: {len(body)}\r\n\r\n"
            self.transport.write(head.encode() + body)
            self.transport.close()

    async def recv(self, decode: bool | None = None) -> Any:
        """Return the next message that passes the gate."""
        while True:
            frame = await super().recv(decode)
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

    async def _pace(self) -> None:
        now_s = time.monotonic()
        if now_s - self._window_start_s >= 1.0:
            self._window_start_s, self._frames_in_window = now_s, 0
        self._frames_in_window += 1
        if self._frames_in_window >= self._limits.frames_per_second:
            await asyncio.sleep(max(0.0, self._window_start_s + 1.0 - now_s))


@dataclass
class Guest:
    """The visitor behind a connection, as the gate sees them.

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

    def control(self, uuid: str) -> viser_insides.Control | None:
        """Return the control with that id, if the visitor has it."""
        return viser_insides.find_control(self.server, self.client_id, uuid)

    def restore(self, uuid: str) -> None:
        """Show the server's value of a control again."""
        viser_insides.show_held_value(self.server, self.client_id, uuid)

    def end_upload(self, component: str, transfer: str, size: int) -> None:
        """Let the page's progress bar end."""
        viser_insides.end_upload(self.server, self.client_id, component, transfer, size)

    def tell(self, text: str) -> None:
        """Show a short notice, at most one a second."""
        client = self.server.get_clients().get(self.client_id)
        now_s = time.monotonic()
        if client is None or now_s - self._last_notice_s < _NOTICE_EVERY_S:
            return
        self._last_notice_s = now_s
        client.add_notification("Not accepted", text, color="red", auto_close_seconds=8.0)
