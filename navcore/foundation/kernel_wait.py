"""Kernels that another process is compiling: how far it is, and what a process does that needs one of them.

By default it compiles the kernel itself. A server never compiles, since that takes a gigabyte which is not
given back: a run raises `KernelAwaited` and is tried again. Pages and helpers wait.
"""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

_LOOK_S = 0.2


class Need(Enum):
    """What happens when a kernel is missing that another process compiles."""

    COMPILE = "compile it here"
    WAIT = "wait for it"
    RAISE = "raise `KernelAwaited`"


@dataclass(frozen=True)
class Compiling:
    """How far the process is that compiles every kernel.

    Attributes
    ----------
    done, total : int
        Kernels.
    kernel : str
        Module and name of the one under way; may be empty.
    """

    done: int
    total: int
    kernel: str

    @property
    def name(self) -> str:
        """Name of the kernel within the package; empty before the first."""
        return self.kernel.removeprefix("navcore.")

    def __str__(self) -> str:
        return ", ".join(filter(None, (f"{self.done} of {self.total}" if self.total else "", self.name)))


class KernelAwaited(Exception):
    """A kernel is missing that another process is about to compile: try again later."""


@dataclass
class _Process:
    """What this process does, and whether the other one is on its way although it has not begun."""

    need: Need = Need.COMPILE
    expected: bool = False


_process = _Process()
_waits: ContextVar[bool] = ContextVar("waits", default=False)


def when_missing(need: Need) -> None:
    """Say what this process does from now on when a kernel is missing that another one compiles."""
    _process.need = need


@contextmanager
def waiting() -> Iterator[None]:
    """Let this thread wait meanwhile where the process raises: what it does cannot be tried again."""
    before = _waits.set(True)
    try:
        yield
    finally:
        _waits.reset(before)


def expect(coming: bool) -> None:
    """Say whether a process that compiles has been started, which may not have begun yet."""
    _process.expected = coming


def note(lock: Path, compiling: Compiling) -> None:
    """Note how far this process is, in the file that it has locked."""
    lock.write_text(f"{compiling.done} {compiling.total} {compiling.kernel}\n", "ascii", "replace")


def under_way(lock: Path) -> Compiling | None:
    """Return how far another process is that holds the lock; None when there is none."""
    try:
        with open(lock, "r+b") as file:
            if not _held(file.fileno()):
                return Compiling(0, 0, "") if _process.expected else None
            done, total, *name = file.read(500).decode("ascii", "replace").split()
            return Compiling(int(done), int(total), " ".join(name))
    except ValueError:  # it is writing just now
        return Compiling(0, 0, "")
    except OSError:
        return Compiling(0, 0, "") if _process.expected else None


def _held(descriptor: int) -> bool:
    try:
        import fcntl
    except ImportError:
        return False
    try:
        fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    fcntl.flock(descriptor, fcntl.LOCK_UN)
    return False


def wait_once(lock: Path, kernel: str) -> bool:
    """Wait a moment for a missing kernel; False where it is to be compiled here.

    Parameters
    ----------
    lock : Path
        Held by whoever compiles.
    kernel : str
        Name of the missing kernel.

    Raises
    ------
    KernelAwaited
        This process does something else meanwhile.
    """
    if _process.need is Need.COMPILE or under_way(lock) is None:
        return False
    if _process.need is Need.RAISE and not _waits.get():
        raise KernelAwaited(kernel)
    time.sleep(_LOOK_S)
    return True
