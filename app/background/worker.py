"""Latest-wins execution: one thread a session, a slot for the newest job, cancel of the running one."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from typing import Generic, TypeVar

Job = TypeVar("Job")

SUPERSEDE_AFTER_S = 0.3
"""A run younger than this is let end although a newer job waits: while a slider is dragged, jobs come faster
than runs end, and cancelling each of them would show nothing until the drag ends."""

_TICK_S = 0.05
_log = logging.getLogger("schuler.worker")


class Watch:
    """What a running job asks: whether to stop, and how long it has run.

    Parameters
    ----------
    newer_waits : callable
        Whether a newer job waits.
    """

    def __init__(self, newer_waits: Callable[[], bool]) -> None:
        self.began = time.monotonic()
        self.stop_asked = threading.Event()
        self._newer_waits = newer_waits

    @property
    def elapsed_s(self) -> float:
        """Time since the job began."""
        return time.monotonic() - self.began

    def superseded(self) -> bool:
        """Whether the result is no longer wanted."""
        return self._newer_waits()

    def unwanted(self) -> bool:
        """Whether to stop at once: asked by the user, or superseded."""
        return self.stop_asked.is_set() or self.superseded()

    def stood_still(self, seconds: float) -> bool:
        """Wait until the job is so old; False as soon as it is unwanted."""
        while self.elapsed_s < seconds:
            if self.stop_asked.wait(_TICK_S) or self.superseded():
                return False
        return True

    def cancelled(self) -> bool:
        """Whether to stop now: asked by the user, or superseded and not about to end."""
        return self.stop_asked.is_set() or (self.elapsed_s > SUPERSEDE_AFTER_S and self.superseded())


class Worker(Generic[Job]):
    """Carries out jobs one at a time; of those that arrive meanwhile only the newest.

    Parameters
    ----------
    work : callable
        ``work(job, watch)``; polls ``watch.cancelled()``.
    name : str
        Of the thread.
    """

    def __init__(self, work: Callable[[Job, Watch], None], name: str = "worker") -> None:
        self._work = work
        self._name = name
        self._changed = threading.Condition()
        self._slot: list[Job] = []
        self._watch: Watch | None = None
        self._thread: threading.Thread | None = None
        self._stopped = False

    def submit(self, job: Job) -> None:
        """Put a job into the slot, in place of one that still waits; does nothing after `stop`."""
        with self._changed:
            if self._stopped:
                return
            self._slot = [job]
            if self._thread is None:
                self._thread = threading.Thread(target=self._loop, name=self._name, daemon=True)
                self._thread.start()
            self._changed.notify_all()

    def cancel(self) -> None:
        """Stop the running job and forget the waiting one."""
        with self._changed:
            self._slot = []
            if self._watch is not None:
                self._watch.stop_asked.set()
            self._changed.notify_all()

    def stop(self) -> None:
        """Cancel everything and end the thread; it is not waited for."""
        with self._changed:
            self._stopped = True
        self.cancel()

    @property
    def busy(self) -> bool:
        """Whether a job runs or waits."""
        with self._changed:
            return bool(self._slot) or self._watch is not None

    def wait_idle(self, timeout_s: float | None = None) -> bool:
        """Block until nothing runs or waits; False after the timeout."""
        with self._changed:
            return self._changed.wait_for(lambda: not self._slot and self._watch is None, timeout_s)

    def _loop(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._slot or self._stopped)
                if self._stopped:
                    return
                job = self._slot.pop()
                self._watch = watch = Watch(lambda: bool(self._slot))
            try:
                self._work(job, watch)
            except Exception:  # the thread must outlive any fault of a job; jobs report their own
                _log.exception("a job failed")
            finally:
                with self._changed:
                    self._watch = None
                    self._changed.notify_all()
