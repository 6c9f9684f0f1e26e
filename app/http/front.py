"""The door before several worker processes: one address, each session always to the same worker.

It reads the head of a request, chooses the worker by the session in its path, and from then on passes bytes
in both directions. What a request may do is judged by the worker.
"""

import asyncio
import contextlib
import re
import socket
import time
import zlib
from collections.abc import Callable, Sequence

from schuler_bench.http.access import answer_headers, security_headers
from schuler_bench.http.address import FORWARDED
from schuler_bench.http.limits import Limits
from schuler_bench.http.places import Door

_SESSION = re.compile(rb"^[A-Z]+ /s/([A-Za-z0-9_-]{8,64})[/? ]")
_HEAD_BYTES = 16 * 1024
_PIECE = 64 * 1024
_CONNECT_S = 3.0


class _Guest:
    """A connection at the door, as `Door` sees it."""

    def __init__(self, writer: asyncio.StreamWriter) -> None:
        peer = writer.get_extra_info("peername")
        self.address = str(peer[0]) if isinstance(peer, tuple) and peer else ""
        self.session_id, self.asked, self.active_s = "", False, time.monotonic()
        self._writer = writer

    def turn_away(self) -> None:
        """Close the connection; the places themselves are kept by the workers."""
        self._writer.transport.abort()

    give_up_place = turn_away


class Front:
    """Passes every connection on to a worker.

    Parameters
    ----------
    workers : sequence of int
        Ports of this machine on which the workers listen.
    limits : Limits
        Of half-open requests.
    """

    def __init__(self, workers: Sequence[int], limits: Limits) -> None:
        self._workers, self._limits = workers, limits
        self._door = Door(limits)
        self._next = 0

    async def serve(self, listener: socket.socket, ended: asyncio.Event, ready: Callable[[], None]) -> None:
        """Serve until `ended`."""
        server = await asyncio.start_server(self._accept, sock=listener, limit=_HEAD_BYTES)
        async with server:
            ready()
            await ended.wait()

    def worker_of(self, head: bytes) -> int:
        """Port of the worker for a request: of a session always the same one, else in turn."""
        match = _SESSION.match(head)
        if match is not None:
            return self._workers[zlib.crc32(match.group(1)) % len(self._workers)]
        self._next += 1
        return self._workers[self._next % len(self._workers)]

    async def _accept(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        guest = _Guest(writer)
        self._door.enter(guest)
        try:
            async with asyncio.timeout(self._limits.request_s):
                head = await reader.readuntil(b"\r\n\r\n")
            guest.asked = True
            await self._pass_on(head, guest, reader, writer)
        except (OSError, TimeoutError, asyncio.IncompleteReadError, asyncio.LimitOverrunError):
            pass
        finally:
            self._door.leave(guest)
            await _close(writer, self._limits.request_s)

    async def _pass_on(
        self, head: bytes, guest: _Guest, reader: asyncio.StreamReader, writer: asyncio.StreamWriter
    ) -> None:
        try:
            async with asyncio.timeout(_CONNECT_S):
                inner_reader, inner_writer = await asyncio.open_connection("127.0.0.1", self.worker_of(head))
        except (OSError, TimeoutError):
            writer.write(_answer(503, "Service Unavailable", b"Starting again; try again in a moment.\n"))
            await writer.drain()
            return
        self._door.leave(guest)  # from here on the worker counts it
        inner_writer.write(_with_address(head, guest.address))
        # A worker drops a page that answers no ping for twice this time; one that reads nothing is the same.
        stalled_s = 2.0 * self._limits.ping_s
        ways = [
            asyncio.create_task(_copy(reader, inner_writer, stalled_s)),
            asyncio.create_task(_copy(inner_reader, writer, stalled_s)),
        ]
        try:
            await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
            # What the worker has still to say is passed on; what a visitor says to a closed worker is not.
            await asyncio.wait(ways[1:], timeout=_CONNECT_S)
        finally:
            for way in ways:
                way.cancel()
            inner_writer.close()


async def _copy(reader: asyncio.StreamReader, writer: asyncio.StreamWriter, stalled_s: float) -> None:
    """Pass bytes on until they end, or until none has been taken for so long."""
    with contextlib.suppress(OSError):
        while piece := await reader.read(_PIECE):
            writer.write(piece)
            async with asyncio.timeout(stalled_s):
                await writer.drain()


async def _close(writer: asyncio.StreamWriter, within_s: float) -> None:
    """Close a connection: nothing more is read, and what has still to be sent may take so long."""
    writer.close()
    try:
        async with asyncio.timeout(within_s):
            await writer.wait_closed()
    except OSError:
        writer.transport.abort()


def _with_address(head: bytes, address: str) -> bytes:
    name = FORWARDED.encode()
    first, *lines = head[:-4].split(b"\r\n")
    kept = [line for line in lines if line.partition(b":")[0].strip().lower() != name]
    return b"\r\n".join([first, *kept, name + b": " + address.encode(), b"", b""])


def _answer(status: int, phrase: str, body: bytes, kind: str = "text/plain; charset=utf-8") -> bytes:
    headers = answer_headers(len(body), kind) | security_headers("")
    lines = [f"HTTP/1.1 {status} {phrase}", *(f"{name}: {value}" for name, value in headers.items()), "", ""]
    return "\r\n".join(lines).encode() + body
