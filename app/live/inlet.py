"""Lines of a live stream on their way in: bounded, and counted where they are dropped."""

from __future__ import annotations

import errno
import logging
import os
import socket
import stat
import threading
from collections import deque
from collections.abc import Iterable
from contextlib import suppress

from navcore.foundation.errors import Fault, InputError
from navcore.io.nmea_plain import LONGEST_LINE
from schuler_bench.live.addresses import LISTEN, Datagrams, Growing, Source

LARGEST_DATAGRAM = 8192
"""Bytes; a longer one is dropped."""
MOST_WAITING = 2000
"""Lines that may wait for the next look at them, a second later; more are dropped."""
_READ_BYTES = 1 << 18
_PAUSE_S = 0.2
_log = logging.getLogger("schuler.live")


class Inlet:
    """Takes lines from all sources until they are asked for.

    Attributes
    ----------
    dropped : int
        Lines and datagrams that were dropped: too long, too many, or of a stranger.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._lines: deque[str] = deque()
        self.dropped = 0

    def take(self, data: bytes) -> None:
        """Take whole lines; never waits."""
        lines = [line.strip() for line in data.decode("ascii", "replace").splitlines()]
        with self._lock:
            for line in lines:
                if not line:
                    continue
                if len(line) > LONGEST_LINE or len(self._lines) >= MOST_WAITING:
                    self.dropped += 1
                else:
                    self._lines.append(line)

    def drop(self) -> None:
        """Count what was not taken."""
        with self._lock:
            self.dropped += 1

    def drain(self) -> str:
        """Give the lines that wait, each with a line feed."""
        with self._lock:
            lines, self._lines = self._lines, deque()
        return "".join(f"{line}\n" for line in lines)


class Listener:
    """Receives from all sources in one thread each.

    Parameters
    ----------
    sources : iterable of Source
        Where to listen.
    inlet : Inlet
        Is given the lines.

    Raises
    ------
    InputError
        An address cannot be bound.
    """

    def __init__(self, sources: Iterable[Source], inlet: Inlet) -> None:
        self._inlet, self._ended = inlet, threading.Event()
        self._sockets: list[socket.socket] = []
        self._threads: list[threading.Thread] = []
        try:
            for source in sources:
                if isinstance(source, Datagrams):
                    self._begin(self._receive, bound(source), source)
                else:
                    self._begin(self._follow, source)
        except InputError:
            self.close()
            raise

    def _begin(self, act: object, *arguments: object) -> None:
        self._sockets += [one for one in arguments if isinstance(one, socket.socket)]
        thread = threading.Thread(target=act, args=arguments, name="live-in", daemon=True)  # pyright: ignore[reportArgumentType]
        self._threads.append(thread)
        thread.start()

    def _receive(self, inlet: socket.socket, source: Datagrams) -> None:
        while not self._ended.is_set():
            try:
                data, (sender, *_) = inlet.recvfrom(LARGEST_DATAGRAM + 1)
            except TimeoutError:
                continue
            except OSError as error:
                if self._ended.is_set():
                    return
                # a datagram that was too long for the system, or an answer to nothing: the next one may come
                _log.warning("%s: %s", source, error.strerror or error)
                self._ended.wait(_PAUSE_S)
                continue
            if len(data) > LARGEST_DATAGRAM or source.sender not in (None, sender.partition("%")[0]):
                self._inlet.drop()
            else:
                self._inlet.take(data)

    def _follow(self, source: Growing) -> None:
        """Read what is added to a file from now on, also when it is begun anew or replaced."""
        tail = _Tail(source)
        while not self._ended.is_set():
            try:
                data = tail.more()
            except OSError as error:
                _log.warning("%s: %s", source, error.strerror or error)
                data = b""
            if data:
                self._inlet.take(data)
            if len(data) < _READ_BYTES // 2:
                self._ended.wait(_PAUSE_S)
        tail.close()

    def close(self) -> None:
        """End all threads."""
        self._ended.set()
        for thread in self._threads:
            thread.join(2.0)
        for one in self._sockets:
            one.close()


def bound(source: Datagrams) -> socket.socket:
    """Bind an address for datagrams; raises `InputError`."""
    family = socket.AF_INET6 if ":" in source.host else socket.AF_INET
    inlet = socket.socket(family, socket.SOCK_DGRAM)
    try:
        inlet.bind((source.host, source.port))
    except OSError as error:
        inlet.close()
        why = {
            errno.EADDRINUSE: "is in use; choose another port",
            errno.EACCES: "is reserved for the system; choose a port from 1024 to 65535",
            errno.EADDRNOTAVAIL: "is not an address of this machine",
        }.get(error.errno or 0, f"cannot be listened on: {error.strerror or error}")
        raise InputError(Fault("serve", LISTEN, str(source), why)) from None
    inlet.settimeout(_PAUSE_S)
    return inlet


class _Tail:
    """End of a file that grows; what it held before it was first seen is passed over."""

    def __init__(self, source: Growing) -> None:
        self._path = source.path
        self._descriptor: int | None = None
        self._inode, self._place = 0, 0
        self._rest = b""
        with suppress(OSError):
            self._open()
            if self._descriptor is not None:
                self._place = os.fstat(self._descriptor).st_size

    def _open(self) -> None:
        descriptor = os.open(self._path, os.O_RDONLY | os.O_NONBLOCK)
        status = os.fstat(descriptor)
        if not stat.S_ISREG(status.st_mode):
            os.close(descriptor)
            raise OSError(errno.EINVAL, "not a regular file")
        self.close()
        self._descriptor, self._inode, self._place, self._rest = descriptor, status.st_ino, 0, b""

    def more(self) -> bytes:
        """Whole lines that were added, at most 256 KiB at once."""
        try:
            now = os.stat(self._path)
        except FileNotFoundError:
            return b""
        if self._descriptor is None or now.st_ino != self._inode or now.st_size < self._place:
            self._open()
        assert self._descriptor is not None
        data = os.pread(self._descriptor, _READ_BYTES, self._place)
        self._place += len(data)
        whole, feed, rest = (self._rest + data).rpartition(b"\n")
        self._rest = rest[-LONGEST_LINE - 1 :]
        return whole + feed

    def close(self) -> None:
        """Let the file go."""
        if self._descriptor is not None:
            os.close(self._descriptor)
            self._descriptor = None
