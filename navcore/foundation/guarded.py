"""Reading a stranger's input in a child process, with bounds on its memory and time.

A parser that is fed hostile bytes may take gigabytes, minutes or the whole process with it. Once `start` has
been called (a server does; a person's own command line need not), `call` runs a function in a child that is
forked from a warm, single-threaded helper: some 10 ms. What a child may take is stated in `Limits`; one that
takes more is killed, and the caller gets one line that says so.
"""

import os
import pickle
import signal
import sys
import tempfile
import threading
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import Any, TypeVar

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.kernel_wait import Need, when_missing

Result = TypeVar("Result")
Packing = Callable[..., tuple[Callable[..., Any], tuple[Any, ...]]]
"""Gives a function and the arguments that stand for those it is given."""
_LARGEST_ANSWER = 512 * 2**20
_MOST_FAULTS = 50
_AT_ONCE = 2
_WAIT_FOR_END_S = 2.0
_LONGEST_FOLDER = 70
"""Letters of the path of the temporary folder, where the helper's socket lies: it has room for about 100."""


@dataclass(frozen=True)
class Limits:
    """Bounds of one child.

    Attributes
    ----------
    memory_bytes : int
        Beyond what the interpreter and its libraries take.
    cpu_s : int
        Processor time, s.
    wall_s : float
        Time until the answer, s; longer than ``cpu_s``, since the machine may be busy.
    """

    memory_bytes: int = 1 << 30
    cpu_s: int = 10
    wall_s: float = 120.0


@dataclass
class _Guard:
    """Whether reading is guarded, and how many children may be at work."""

    limits: Limits | None = None
    packed: Packing | None = None
    places: threading.BoundedSemaphore = threading.BoundedSemaphore(_AT_ONCE)  # noqa: RUF009


_guard = _Guard()


def start(preload: tuple[str, ...] = (), limits: Limits | None = None) -> None:
    """From now on let `call` use a child process.

    Parameters
    ----------
    preload : tuple of str
        Modules that the helper imports once, so that no child has to.
    limits : Limits, optional
        Of every child.
    """
    if sys.platform != "win32":
        get_context("forkserver").set_forkserver_preload([__name__, *preload])
        _guard.limits = limits or Limits()


def stop() -> None:
    """Let `call` run functions in this process again."""
    _guard.limits = None


def warm() -> None:
    """Start the helper, so that the first child does not wait for its imports."""
    if _guard.limits is not None:
        call("the helper", os.getpid)


def take_along(packed: Packing) -> None:
    """Have a function and its arguments packed together with what a child needs to read them."""
    _guard.packed = packed


def call(what: str, function: Callable[..., Result], *arguments: Any) -> Result:
    """Call a function of a module: in a child once `start` has been called, else here.

    Parameters
    ----------
    what : str
        Name of the input, for the fault.
    function : callable
        Of a module (it is handed over by name); its result must be picklable.
    *arguments
        Picklable.

    Raises
    ------
    InputError
        What the function raised, or: too much memory or time, or a parser that broke.
    """
    limits = _guard.limits
    if limits is None:
        return function(*arguments)
    if _guard.packed is not None:
        function, arguments = _guard.packed(function, *arguments)
    with _guard.places:
        return _in_child(what, limits, function, arguments)


def _in_child(what: str, limits: Limits, function: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
    context = get_context("forkserver")
    ours, theirs = context.Pipe(duplex=False)
    child = context.Process(target=_work, args=(theirs, limits, function, arguments), daemon=True)
    try:
        child.start()
    except OSError:
        raise _refused(what, _not_started()) from None
    theirs.close()
    try:
        if not ours.poll(limits.wall_s):
            raise _refused(what, f"takes longer than {limits.wall_s:g} s to read")
        kind, content = pickle.loads(ours.recv_bytes(_LARGEST_ANSWER))
    except (EOFError, OSError, pickle.UnpicklingError):
        child.join(_WAIT_FOR_END_S)
        raise _refused(what, _reason(child, limits)) from None
    finally:
        ours.close()
        _end(child)
    if kind == "result":
        return content
    if kind == "faults":
        raise InputError(Fault(*fault) for fault in content)
    if kind == "memory":
        raise _refused(what, f"needs more than {_size(limits)} of memory to read")
    raise _refused(what, f"cannot be read ({content})")


def _refused(what: str, allowed: str) -> InputError:
    return InputError(Fault(what, "", None, allowed))


def _not_started() -> str:
    """Why no child can be started: the helper listens in a temporary folder."""
    try:
        letters = len(tempfile.gettempdir())
    except FileNotFoundError:
        letters = 0
    if letters > _LONGEST_FOLDER:
        return (
            f"cannot be read: the path of the temporary folder has {letters} letters, and the process that "
            f"reads files needs at most {_LONGEST_FOLDER}; set TMPDIR to a shorter one"
        )
    return "cannot be read: no process can be started for it; is there a temporary folder with room?"


def _size(limits: Limits) -> str:
    return f"{limits.memory_bytes / 2**30:g} GiB"


def _reason(child: BaseProcess, limits: Limits) -> str:
    """Why a child ended without an answer."""
    if child.exitcode == -signal.SIGXCPU or child.exitcode == -signal.SIGKILL:
        return f"takes more than {limits.cpu_s} s of processor time to read"
    return f"cannot be read: it needs more than {_size(limits)} of memory, or is damaged"


def _end(child: BaseProcess) -> None:
    if child.is_alive():
        child.join(0.05)
    if child.is_alive():
        child.kill()
    child.join(_WAIT_FOR_END_S)
    if child.exitcode is not None:
        child.close()


# ------------------------------------------------------------ in the child


def _work(
    answer: Connection, limits: Limits, function: Callable[..., Any], arguments: tuple[Any, ...]
) -> None:
    """Run the function within the limits and send its result, its faults, or what broke."""
    _bound(limits)
    when_missing(Need.WAIT)
    try:
        sent = pickle.dumps(("result", function(*arguments)), protocol=pickle.HIGHEST_PROTOCOL)
    except InputError as error:
        sent = pickle.dumps(("faults", _plain(error.faults)))
    except MemoryError:
        sent = pickle.dumps(("memory", ""))
    except Exception as problem:
        sent = pickle.dumps(("broken", _cause(problem)))
    answer.send_bytes(sent)
    answer.close()


def _cause(problem: Exception) -> str:
    """Kind of an exception; the system's own words, which name no file, where it has some."""
    words = getattr(problem, "strerror", None)
    return f"{type(problem).__name__}: {words}" if words else type(problem).__name__


def _bound(limits: Limits) -> None:
    """Bound memory and time, write no files, leave no trace of a crash, run at a lower priority."""
    import resource  # not on every system

    setrlimit = resource.setrlimit
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    os.nice(5)
    # Data, not addresses: allocators reserve gigabytes of the latter and touch none.
    data = _data_pages() * resource.getpagesize() + limits.memory_bytes
    setrlimit(resource.RLIMIT_DATA, (data, data))
    setrlimit(resource.RLIMIT_CPU, (limits.cpu_s, limits.cpu_s + 1))
    setrlimit(resource.RLIMIT_CORE, (0, 0))
    setrlimit(resource.RLIMIT_FSIZE, (0, 0))


def _data_pages() -> int:
    """Pages of data in use, or a number above where the system does not tell."""
    try:
        with open("/proc/self/statm", encoding="ascii") as stream:
            return int(stream.read().split()[5])
    except (OSError, ValueError):
        return 1 << 18


def _plain(faults: tuple[Fault, ...]) -> list[tuple[str, str, Any, str]]:
    """Faults as plain values, the first of very many."""
    more = len(faults) - _MOST_FAULTS
    listed = [(f.where, f.field, _value(f.value), f.allowed) for f in faults[:_MOST_FAULTS]]
    return [*listed, ("", "", None, f"and {more} more faults")] if more > 0 else listed


def _value(value: object) -> Any:
    if value is None or isinstance(value, bool | float):
        return value
    if isinstance(value, int) and abs(value) < 1 << 63:
        return value
    return value[:1000] if isinstance(value, str) else f"{type(value).__name__}"
