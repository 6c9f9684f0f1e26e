"""``schuler serve --workers N``: several processes behind one door, started again when one of them ends."""

from __future__ import annotations

import asyncio
import dataclasses
import json
import logging
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from navcore.extending.plugins import load_plugins
from navcore.foundation.errors import Fault, InputError
from schuler_bench.http.access import access_rules
from schuler_bench.http.address import authority, is_loopback, listen, parse_origins
from schuler_bench.http.limits import Limits
from schuler_bench.jobs import kernels
from schuler_bench.jobs.away import away_seconds
from schuler_bench.jobs.cluster import check_address
from schuler_bench.jobs.elsewhere import leave_cluster, use_cluster
from schuler_bench.jobs.scheduler import WORKERS
from schuler_bench.logs import begin_logging
from schuler_bench.memory import bound_arenas
from schuler_bench.session.store import (
    CLAIMED,
    checked_folder,
    claim,
    default_folder,
    session_key,
    share_claim,
)

if TYPE_CHECKING:
    from schuler_bench.http.front import Front

MOST_WORKERS = 64
_LOOK_S = 0.2
_AGAIN_S = 1.0
_END_S = 3.0
_NO_HOME = "there is no home folder: set XDG_STATE_HOME"
_PLACES, _FEWEST_PLACES = 96, 8
"""Open pages of all workers together, and of each at least: sessions do not fall evenly on the workers."""
_log = logging.getLogger("schuler.workers")


@dataclass(frozen=True)
class Settings:
    """Settings that a worker reads from its standard input.

    Attributes
    ----------
    host, port : str, int
        Public address, by which visitors know the server.
    loopback : bool
        Only this machine can reach it.
    descriptor : int
        Of the socket the worker listens on.
    token : str or None
        As of `schuler_bench.http.server.start`.
    origins, framers : list of str
        As of `schuler_bench.http.server.start`.
    workers : int
        How many share the places.
    cluster : str or None
        See `schuler_bench.serve.serve`.
    """

    host: str
    port: int
    loopback: bool
    descriptor: int
    token: str | None
    origins: list[str]
    framers: list[str]
    workers: int
    cluster: str | None = None


class Crew:
    """The worker processes.

    Parameters
    ----------
    count : int
        How many.
    settings : Settings
        Of the first; each gets a socket of its own.
    """

    def __init__(self, count: int, settings: Settings) -> None:
        self._sockets = [_inner_socket() for _ in range(count)]
        self.ports = [one.getsockname()[1] for one in self._sockets]
        self._settings = [dataclasses.replace(settings, descriptor=one.fileno()) for one in self._sockets]
        self._processes = [self._start(number) for number in range(count)]
        self._ended = threading.Event()
        self._watcher = threading.Thread(target=self._watch, name="crew", daemon=True)
        self._watcher.start()

    def stop(self) -> None:
        """End all workers; those that do not within a few seconds are killed."""
        self._ended.set()
        self._watcher.join(_END_S)
        for process in self._processes:
            process.terminate()
        until = time.monotonic() + _END_S
        for process in self._processes:
            try:
                process.wait(max(0.05, until - time.monotonic()))
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        for one in self._sockets:
            one.close()

    def _start(self, number: int) -> subprocess.Popen[bytes]:
        settings = self._settings[number]
        process = subprocess.Popen(
            [sys.executable, "-m", "schuler_bench.workers"],
            stdin=subprocess.PIPE,
            pass_fds=[settings.descriptor],
            env={**os.environ, CLAIMED: "1", WORKERS: str(settings.workers)},
            start_new_session=True,  # Ctrl+C is for the door, which ends the workers itself
        )
        assert process.stdin is not None
        process.stdin.write(json.dumps(dataclasses.asdict(settings)).encode() + b"\n")
        process.stdin.flush()  # stays open: a worker whose door has gone ends
        return process

    def _watch(self) -> None:
        while not self._ended.wait(_LOOK_S):
            for number, process in enumerate(self._processes):
                if process.poll() is not None:
                    _log.warning("worker %d has ended (%s) and is started again", number, process.returncode)
                    if process.stdin is not None:
                        process.stdin.close()
                    if self._ended.wait(_AGAIN_S):
                        return
                    self._processes[number] = self._start(number)


def serve_with_workers(
    host: str,
    port: int,
    *,
    count: int,
    token: str | None = None,
    show_token: bool = False,
    allow_origins: Iterable[str] = (),
    frame_origins: Iterable[str] = (),
    cluster: str | None = None,
) -> None:
    """Serve until SIGINT or SIGTERM, with ``count`` processes behind one door.

    Parameters
    ----------
    host, port, token, allow_origins, frame_origins
        See `schuler_bench.http.server.start`.
    count : int
        Of workers.
    show_token, cluster
        See `schuler_bench.serve.serve`.

    Raises
    ------
    InputError
        As `schuler_bench.http.server.start`; there are too many or too few workers, or another server keeps
        its sessions in the same folder.
    """
    from schuler_bench.http.front import Front
    from schuler_bench.serve import link_with

    begin_logging()
    if not 1 <= count <= MOST_WORKERS:
        raise InputError([Fault("serve", "--workers", count, f"must be from 1 to {MOST_WORKERS}")])
    if os.name != "posix":
        raise InputError([Fault("serve", "--workers", count, "is for Linux and macOS")])
    origins, framers = parse_origins(allow_origins), parse_origins(frame_origins, "--frame-origin")
    check_address(cluster)
    away_seconds(os.environ)
    with ExitStack() as held:
        listener = held.enter_context(listen(host, port))
        bound, loopback = listener.getsockname()[1], is_loopback(listener)
        access_rules(host, bound, loopback=loopback, token=token, origins=origins)
        held.enter_context(_claimed_folder(count))
        origin_lists = sorted(origins), sorted(framers)
        crew = Crew(count, Settings(host, bound, loopback, -1, token, *origin_lists, count, cluster))
        held.callback(crew.stop)
        name = {"0.0.0.0": "127.0.0.1", "::": "::1"}.get(host, host)
        held.callback(kernels.stop)
        with suppress(InputError):  # which the workers say
            kernels.prepare(start=True, tell=partial(print, flush=True))
        url = f"http://{authority(name, bound)}/"
        link = link_with(url, token) if show_token else url
        greeting = f"Schuler Bench: {link}  ({count} workers; Ctrl+C ends it)"
        asyncio.run(_serve(Front(crew.ports, Limits()), listener, greeting))


async def _serve(front: Front, listener: socket.socket, greeting: str) -> None:
    ended = asyncio.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        asyncio.get_running_loop().add_signal_handler(number, ended.set)
    await front.serve(listener, ended, lambda: print(greeting, flush=True))


@contextmanager
def _claimed_folder(count: int) -> Iterator[None]:
    folder = checked_folder()
    if folder is None:  # workers must sign the addresses of sessions with the same key
        raise InputError([Fault("serve", "--workers", count, _NO_HOME)])
    session_key(folder)
    try:
        claimed = claim(folder)
    except OSError as error:
        raise InputError([Fault("serve", "--workers", count, f"{folder}: {error.strerror}")]) from None
    with claimed:
        share_claim(claimed)
        yield


def _inner_socket() -> socket.socket:
    inner = socket.socket()
    inner.bind(("127.0.0.1", 0))
    inner.listen(100)
    inner.setblocking(False)
    return inner


def work() -> None:
    """One worker: serves on the socket it was given until it is asked to end, or its door has ended."""
    from schuler_bench.http.server import Inner
    from schuler_bench.serve import open_dashboard

    begin_logging(to_file=False)
    for fault in load_plugins():
        _log.warning("%s", fault)
    bound_arenas()
    settings = Settings(**json.loads(sys.stdin.readline()))
    server, dashboard = open_dashboard(
        settings.host,
        settings.port,
        token=settings.token,
        allow_origins=settings.origins,
        frame_origins=settings.framers,
        state=default_folder(),
        inner=Inner(socket.socket(fileno=settings.descriptor), settings.loopback),
        limits=Limits(visitors=max(_FEWEST_PLACES, _PLACES // settings.workers)).shared_by(settings.workers),
    )

    use_cluster(settings.cluster)

    def follow_door() -> None:
        sys.stdin.read()
        os.kill(os.getpid(), signal.SIGTERM)

    threading.Thread(target=follow_door, name="door", daemon=True).start()
    server.wait()
    leave_cluster()
    dashboard.close()


if __name__ == "__main__":
    work()
