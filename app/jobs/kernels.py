"""Compile the kernels beside the server, which never does so itself, and say how far that is.

A process that compiles grows to a gigabyte and does not give it back. Runs that need a kernel which is not
there yet are tried again (`navcore.foundation.kernel_wait`).
"""

import logging
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import TypeVar

from navcore.foundation import kernel_wait
from navcore.foundation.errors import InputError

COMPILING = "Compiling the kernels, once: about a minute"
_LOOK_S, _SAY_S, _BEGINS_WITHIN_S = 0.5, 2.0, 30.0
T = TypeVar("T")
_log = logging.getLogger("schuler.kernels")


@dataclass
class _State:
    """How far it is, None when nothing is compiled; the process, of a server that has started one."""

    compiling: kernel_wait.Compiling | None = None
    process: subprocess.Popen[bytes] | None = None


_state = _State()


def compiling() -> kernel_wait.Compiling | None:
    """Return how far the process is that compiles; None when there is none."""
    return _state.compiling


def words() -> str:
    """Line for ``/healthz``; empty when nothing is compiled."""
    return "" if _state.compiling is None else ": ".join(filter(None, (COMPILING, str(_state.compiling))))


def begin() -> None:
    """Start the process that compiles, where kernels are missing, before the server does anything else."""
    from navcore.foundation.kernel_cache import ready

    with suppress(InputError):  # `prepare` says it
        if _state.process is None and not ready():
            _state.process = _start()


def prepare(*, start: bool, tell: Callable[[str], None]) -> None:
    """Have the kernels compiled that are missing; returns at once.

    Parameters
    ----------
    start : bool
        Start a process that compiles, unless `begin` has; False: the parent of this one has.
    tell : callable
        ``tell(line)``, every few seconds and when all is done.

    Raises
    ------
    InputError
        There are no kernels, and nowhere to put any.
    """
    from navcore.foundation.kernel_cache import ready

    if ready():
        return
    _state.compiling = kernel_wait.Compiling(0, 0, "")
    kernel_wait.when_missing(kernel_wait.Need.RAISE)
    kernel_wait.expect(True)
    if start and _state.process is None:
        _state.process = _start()
    threading.Thread(target=_follow, args=(_state.process, tell), name="kernels", daemon=True).start()


def stop() -> None:
    """End the process that compiles; kernels that are there are kept for the next start."""
    if _state.process is not None and _state.process.poll() is None:
        os.killpg(_state.process.pid, signal.SIGTERM)
        _state.process.wait()
    _state.process = None


def when_there(act: Callable[[], T]) -> T:
    """Return what ``act()`` does, tried again until the kernels that it needs are there."""
    while True:
        try:
            return act()
        except kernel_wait.KernelAwaited:
            time.sleep(_LOOK_S)


def _start() -> subprocess.Popen[bytes]:
    process = subprocess.Popen(
        [sys.executable, "-m", "navcore.warm"],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,  # Ctrl+C is for the server, which ends it with its own child
    )
    with suppress(OSError):  # short of memory, the system is to end it, and not the server
        with open(f"/proc/{process.pid}/oom_score_adj", "w") as file:
            file.write("1000")
    return process


def _follow(process: subprocess.Popen[bytes] | None, tell: Callable[[str], None]) -> None:
    """Say how far it is until the kernels are there or nobody compiles them any more."""
    from navcore.foundation.kernel_cache import ready, under_way

    tell(COMPILING)
    began_s = said_s = time.monotonic()
    while not ready():
        time.sleep(_LOOK_S)
        if process is not None and process.poll() is not None:
            break
        found = under_way()
        if found is None:
            break
        if found.total:
            _state.compiling = found
        if found.total or time.monotonic() - began_s > _BEGINS_WITHIN_S:
            kernel_wait.expect(False)
        if time.monotonic() - said_s >= _SAY_S:
            said_s = time.monotonic()
            tell(words())
    kernel_wait.expect(False)
    _state.compiling = None
    if process is not None and _state.process is None:  # the server ends
        return
    if ready():
        tell("The kernels are compiled.")
        return
    # From now on each that is missing is compiled where it is needed, as without this process.
    kernel_wait.when_missing(kernel_wait.Need.COMPILE)
    _log.error("the kernels could not be compiled in a process of their own: is there a gigabyte of memory?")
