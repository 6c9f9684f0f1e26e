"""Heavy jobs in processes of their own: they take neither the interpreter nor, beside an answer, a core.

A job in the server's own process shares its interpreter with the answers to all visitors: whatever it does
between two looks at `schuler_bench.jobs.worker.Watch.unwanted` delays them. Once `start` has been called (a
server does; a person's own command line need not), jobs are handed to helpers: child processes of a lower
priority that stay for the next job. A helper asks now and then whether it may go on, so that it stands still,
and ends, as a job in the server does.
"""

import logging
import os
import pickle
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from multiprocessing import get_context
from multiprocessing.connection import Connection
from typing import Any

from navcore.extending.baggage import packed
from navcore.foundation.kernel_wait import Need, when_missing
from navcore.foundation.progress import part_of
from navcore.foundation.stage_cache import keep_only, working_for
from navcore.foundation.text import Text
from schuler_bench.jobs.remote import Compute, Outcome
from schuler_bench.memory import give_back

_ASK_S, _REPORT_S = 0.05, 0.1
"""Between two questions whether to go on, and between two reports of progress."""
_LOOK_S, _END_S = 0.25, 3.0
"""Polling interval of a quiet helper, and kill timeout of one that is to end a cancelled job."""
_IDLE_S = 300.0
"""A helper that was idle for so long ends; the memory of its last job was given back before."""
_NICE = 10
_log = logging.getLogger("schuler.helper")


class _Helper:
    """One child process."""

    def __init__(self) -> None:
        context = get_context("forkserver")
        self._pipe, theirs = context.Pipe()
        self._process = context.Process(target=_help, args=(theirs,), daemon=True)
        self._process.start()
        theirs.close()

    @property
    def there(self) -> bool:
        """Whether it has not ended."""
        return self._process.is_alive()

    def carry_out(
        self, job: bytes, progress: Callable[[float], None], unwanted: Callable[[], bool]
    ) -> Outcome | None:
        """Let it do a pickled job; None when nobody wants the result any more, and it would not end."""
        try:
            return self._outcome(job, progress, unwanted)
        except (EOFError, OSError):
            self.end()
            if not _helpers.used:  # the server ends
                return None
            _log.warning("a helper has ended in the middle of a job")
            why = Text("the process that computed it has ended; is there enough memory?")
            return Outcome(error=RuntimeError(why))

    def _outcome(
        self, job: bytes, progress: Callable[[float], None], unwanted: Callable[[], bool]
    ) -> Outcome | None:
        self._pipe.send_bytes(job)
        until_s = float("inf")
        while True:
            if not self._pipe.poll(_LOOK_S):
                if unwanted():
                    until_s = min(until_s, time.monotonic() + _END_S)
                if time.monotonic() > until_s:
                    self.end()
                    return None
                continue
            kind, content = self._pipe.recv()
            if kind == "progress":
                progress(content)
            elif kind == "ask":
                self._pipe.send(unwanted())
            else:
                return content

    def end(self) -> None:
        """Kill it."""
        self._process.kill()
        self._process.join(_END_S)
        self._pipe.close()


class _Helpers:
    """Those without a job, once they may be used."""

    def __init__(self) -> None:
        self.used = False
        self.idle: list[_Helper] = []
        self.lock = threading.Lock()

    def take(self) -> _Helper:
        with self.lock:
            while self.idle:
                if (helper := self.idle.pop()).there:
                    return helper
        return _Helper()

    def give_back(self, helper: _Helper) -> None:
        with self.lock:
            if self.used and helper.there:
                self.idle.append(helper)
                return
        helper.end()


_helpers = _Helpers()


def start() -> None:
    """From now on let helpers do the jobs."""
    _helpers.used = sys.platform != "win32"


def stop() -> None:
    """Do the jobs in this process again, and end the helpers that have none."""
    with _helpers.lock:
        _helpers.used = False
        idle, _helpers.idle = _helpers.idle, []
    for helper in idle:
        helper.end()


def helps(function: Compute) -> bool:
    """Whether helpers do this job: they are used, and it is found by its name."""
    try:
        return _helpers.used and pickle.dumps(function) != b""
    except (pickle.PicklingError, AttributeError, TypeError):
        return False


def compute(
    function: Compute,
    items: Sequence[Any],
    progress: Callable[[float], None],
    unwanted: Callable[[], bool],
) -> list[Any] | None:
    """Carry ``function(item, progress, cancelled)`` out for each item, one after the other, in one helper.

    Parameters
    ----------
    function : callable
        Of a module.
    items : sequence
        Picklable.
    progress, unwanted : callable
        ``progress(fraction)`` of all items together; ``unwanted()`` says whether to end, and may take time.

    Returns
    -------
    list or None
        None: nobody wants the results any more, and the helper would not end.

    Raises
    ------
    Exception
        Whatever the function raised; RuntimeError when the helper has ended.
    """
    helper, results = _helpers.take(), []
    try:
        for number, item in enumerate(items):
            called, (given,) = packed(function, item)
            job = pickle.dumps((called, given, number + 1 == len(items)), protocol=pickle.HIGHEST_PROTOCOL)
            partly = part_of(progress, number / len(items), (number + 1) / len(items))
            outcome = helper.carry_out(job, partly, unwanted)
            if outcome is None or (len(items) > 1 and unwanted()):
                return None
            if outcome.error is not None:
                raise outcome.error
            results.append(outcome.found)
    finally:
        _helpers.give_back(helper)
    return results


# ------------------------------------------------------------ in the helper


def _help(pipe: Connection) -> None:
    """Do one job after the other, until the server has ended or the helper was idle for too long."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl+C is for the server
    os.nice(_NICE)
    when_missing(Need.WAIT)
    with _server_there():
        while pipe.poll(_IDLE_S):
            function, item, last = pickle.loads(pipe.recv_bytes())
            outcome = _outcome(function, item, pipe)
            try:
                pipe.send(("outcome", outcome))
            except (pickle.PicklingError, AttributeError, TypeError) as problem:
                pipe.send(("outcome", Outcome(error=RuntimeError(f"{type(problem).__name__}: {problem}"))))
            del function, item, outcome
            if last:
                keep_only(frozenset())
                give_back()


def _outcome(function: Compute, item: Any, pipe: Connection) -> Outcome:
    asked_s = told_s = time.monotonic()
    ended, talking = False, threading.Lock()

    def progress(fraction: float) -> None:
        nonlocal told_s
        with talking, _server_there():
            if time.monotonic() - told_s >= _REPORT_S:
                told_s = time.monotonic()
                pipe.send(("progress", float(fraction)))

    def cancelled() -> bool:
        nonlocal asked_s, ended
        with talking, _server_there():
            if not ended and time.monotonic() - asked_s >= _ASK_S:
                pipe.send(("ask", None))
                ended, asked_s = pipe.recv(), time.monotonic()
            return ended

    try:
        with working_for("helper"):
            return Outcome(function(item, progress, cancelled))
    except Exception as error:
        return Outcome(error=error)


@contextmanager
def _server_there() -> Iterator[None]:
    """End the process when the server has gone."""
    try:
        yield
    except (EOFError, OSError):
        os._exit(0)
