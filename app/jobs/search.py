"""One thing computed at a time in the background: progress, cancel, newest wins; the last result stays."""

import logging
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from navcore.foundation.errors import InputError, StoppedError
from navcore.foundation.kernel_wait import KernelAwaited
from navcore.foundation.text import Text
from schuler_bench.jobs.elsewhere import LOST, carried_out
from schuler_bench.jobs.load import heavy_load
from schuler_bench.jobs.scheduler import Load
from schuler_bench.jobs.words import for_a_page, what_failed
from schuler_bench.jobs.worker import ElsewhereLost, Watch, Worker

Asked = TypeVar("Asked")
Found = TypeVar("Found")
GIVEN_UP = Text("Stopped: no page of this session was open for long.")
_STOPPING = Text("Stopping: what was found so far is kept.")
_log = logging.getLogger("schuler.search")


@dataclass(frozen=True, eq=False)
class _Job(Generic[Asked]):
    """One submission: the same thing asked twice is two jobs."""

    asked: Asked


class Search(Generic[Asked, Found]):
    """Computes one thing at a time; the last complete result stays until the next.

    Parameters
    ----------
    tell : callable
        ``tell()`` whenever there is something new to show, from the thread that computes.
    compute : callable
        ``compute(asked, progress, cancelled)``; raises `InputError` when it is refused. On a cluster it is
        found by its name.
    complete : callable
        ``complete(found)``: it came to its end; else it was stopped.
    stopped : str
        What is said when it was stopped; empty: nothing.
    name : str
        Of the visitor, for the turns and for the log.
    load : callable
        ``load(asked)``: what it will take; by default that of heavy work on the scenario that is asked about.
    still_s : float
        Nothing newer must have been asked for so long before it is begun.
    keeps : bool
        What a job that is halted has found so far is a result, which says itself that it was stopped.

    Attributes
    ----------
    report_after_s, report_every_s : float
        Time under way before its progress is reported first, and between two reports.
    fraction : float or None
        Part that is done while it is under way.
    result
        The last complete one, or None.
    asked
        What that is of.
    words : tuple of str
        Why there is no newer result: stopped, refused, failed. While one is under way: what is to be known.
    """

    report_after_s = report_every_s = 0.15

    def __init__(
        self,
        tell: Callable[[], None],
        compute: Callable[[Asked, Callable[[float], None], Callable[[], bool]], Found | None],
        complete: Callable[[Found], bool] = lambda found: True,
        stopped: str = "",
        name: str = "search",
        load: Callable[[Asked], Load] | None = None,
        still_s: float = 0.0,
        keeps: bool = False,
    ) -> None:
        self._keeps, self._halted = keeps, False
        self._tell, self._compute, self._complete = tell, compute, complete
        self._stopped, self._name = stopped, name
        self._lock = threading.Lock()
        of = load or _heavy
        self._worker: Worker[_Job[Asked]] = Worker(
            self._work, visitor=name, load=lambda job: of(job.asked), still_s=still_s
        )
        self._job: _Job[Asked] | None = None
        self.fraction: float | None = None
        self.result: Found | None = None
        self.asked: Asked | None = None
        self.words: tuple[str, ...] = ()

    @property
    def under_way(self) -> Asked | None:
        """Give what is being computed now, or None."""
        job = self._job
        return None if job is None else job.asked

    def begin(self, asked: Asked) -> None:
        """Compute this, in place of what is under way."""
        self._submit(asked, 0.0)
        self._tell()

    def _submit(self, asked: Asked, fraction: float | None) -> None:
        job = _Job(asked)
        note = self._worker.note(job)
        self._set(fraction, (note,) if note else (), job)
        self._worker.submit(job)

    def _set(self, fraction: float | None, words: tuple[str, ...], job: _Job[Asked] | None) -> None:
        with self._lock:
            self.fraction, self.words, self._job = fraction, words, job
            self._halted = False

    def cancel(self, why: str = "") -> None:
        """Stop, and say why; an earlier result stays."""
        if self.fraction is None and self._job is None:
            return
        self._set(None, self._because(why), None)
        self._worker.cancel()
        if self.words:
            self._tell()

    def halt(self) -> None:
        """Stop, and keep what was found so far where the job gives that; the second time, drop it."""
        with self._lock:
            first = self._keeps and self._job is not None and not self._halted
            self._halted = self._halted or first
        if first and self._worker.cancel():
            with self._lock:
                if self._halted and self._job is not None:
                    self.words = (_STOPPING,)
            self._tell()
        else:
            self.cancel()

    def forget(self) -> None:
        """Drop the result and what was said of it."""
        with self._lock:
            self.result = self.asked = None
            self.words = ()

    def stop(self) -> None:
        """End the thread."""
        self._worker.stop()

    def wait_idle(self, timeout_s: float | None = None) -> bool:
        """Block until nothing is under way; False after the timeout."""
        return self._worker.wait_idle(timeout_s)

    def _because(self, why: str = "") -> tuple[str, ...]:
        return tuple(words for words in (why or self._stopped,) if words)

    def _carry_out(self, asked: Asked, progress: Callable[[float], None], watch: Watch) -> Found | None:
        return carried_out(self._compute, asked, progress, watch)

    def _refused(self, error: InputError) -> tuple[str, ...]:
        """Say why it is refused."""
        return tuple(str(fault) for fault in for_a_page(error).faults)

    def _ended(self) -> None:
        """Tell that there is a new result."""
        self._tell()

    def _work(self, job: _Job[Asked], watch: Watch) -> None:
        asked = job.asked
        last_s = self.report_after_s - self.report_every_s

        def progress(fraction: float) -> None:
            nonlocal last_s
            if watch.elapsed_s - last_s < self.report_every_s:
                return
            last_s = watch.elapsed_s
            with self._lock:
                if self._job is not job:
                    return
                self.fraction = fraction
            self._tell()

        result, words = None, ()
        try:
            result = self._carry_out(asked, progress, watch)
        except (ElsewhereLost, KernelAwaited) as reason:
            lost = isinstance(reason, ElsewhereLost)
            with self._lock:
                if self._job is job:
                    self.fraction, self.words = 0.0, (LOST,) if lost else ()
            self._tell()
            raise
        except StoppedError:
            words = self._because(GIVEN_UP if watch.given_up() else "")
        except InputError as error:
            words = self._refused(error)
        except Exception as error:
            _log.exception("%s failed", self._name)
            name, _, why = what_failed(error).partition(": ")
            words = (Text("Something went wrong: {name}: {error}", name=name, error=why),)
        complete = result is not None and self._complete(result)
        given_up = not complete and watch.given_up()
        with self._lock:
            if self._job is not job:  # stopped, or superseded
                return
            self.fraction = self._job = None
            ended_early = given_up or (self._halted if result is None else not complete)
            self.words = words or (self._because(GIVEN_UP if given_up else "") if ended_early else ())
            if complete:
                self.result, self.asked = result, asked
        self._ended() if complete else self._tell()


def _heavy(asked: Any) -> Load:
    return heavy_load(getattr(asked, "scenario", asked))
