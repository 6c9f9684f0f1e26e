"""Threads in which the callbacks of all pages run: in turn by visitor, one at a time for each."""

import threading
from collections import OrderedDict, deque
from collections.abc import Callable, Hashable
from concurrent.futures import Executor, Future
from dataclasses import dataclass
from typing import Any

from navcore.foundation.kernel_wait import waiting
from navcore.foundation.stage_cache import working_for

MOST_WAITING = 64
"""Callbacks of one visitor that may wait; a person never has so many, and a flood of them is cut off here."""


@dataclass
class _Job:
    future: Future[Any]
    call: Callable[..., Any]
    arguments: tuple[Any, ...]
    named: dict[str, Any]
    same: object


class FairPool(Executor):
    """Runs callbacks in a few threads: the visitors take turns, and each has at most one callback running.

    One visitor's callbacks keep their order. A callback that would read the same value as one that still
    waits is not queued again: while a slider is dragged faster than it is answered, only its newest value is
    read.

    Parameters
    ----------
    threads : int
        Callbacks of different visitors that run at the same time.
    key : callable
        ``key(arguments)``: whose callback it is; hashable.
    same : callable
        ``same(call, arguments)``: callbacks of one visitor that give equal answers, other than None, need
        to run only once.
    """

    def __init__(
        self,
        threads: int,
        key: Callable[[tuple[Any, ...]], object],
        same: Callable[[Callable[..., Any], tuple[Any, ...]], object],
    ) -> None:
        self._key, self._same = key, same
        self._changed = threading.Condition()
        self._waiting: OrderedDict[object, deque[_Job]] = OrderedDict()
        self._running: set[object] = set()
        self._owners: dict[object, Hashable] = {}
        self._idle = 0
        self._most_threads, self._threads = threads, 0
        self._closed = False
        self.dropped = 0

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Queue a callback; its future, which never ends when it is not run at all."""
        key, same = self._key(args), self._same(fn, args)
        with self._changed:
            queue = self._waiting.setdefault(key, deque())
            waiting = None if same is None else next((job for job in queue if job.same == same), None)
            job = _Job(Future(), fn, args, kwargs, same)
            if waiting is not None:
                return job.future
            if self._closed or len(queue) >= MOST_WAITING:
                self.dropped += 1
                return job.future
            queue.append(job)
            if not self._idle and self._threads < self._most_threads:
                self._threads += 1
                threading.Thread(target=self._loop, name=f"callbacks-{self._threads}", daemon=True).start()
            self._changed.notify()
            return job.future

    def work_for(self, key: object, owner: Hashable) -> None:
        """Let what a visitor's callbacks put into the cache of stages belong to an owner, and go with it."""
        with self._changed:
            self._owners[key] = owner

    def forget(self, key: object) -> None:
        """Drop what still waits of a visitor who has gone."""
        with self._changed:
            self._waiting.pop(key, None)
            self._owners.pop(key, None)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Begin nothing more; what runs is not waited for."""
        del wait, cancel_futures
        with self._changed:
            self._closed = True
            self._waiting.clear()
            self._changed.notify_all()

    def _next(self) -> tuple[object, _Job] | None:
        for key, queue in self._waiting.items():
            if queue and key not in self._running:
                self._waiting.move_to_end(key)
                return key, queue.popleft()
        return None

    def _loop(self) -> None:
        while True:
            with self._changed:
                self._idle += 1
                while (entry := self._next()) is None and not self._closed:
                    self._changed.wait()
                self._idle -= 1
                if entry is None:
                    return
                key, job = entry
                self._running.add(key)
                owner = self._owners.get(key)
            try:
                with working_for(owner):
                    _run(job)
            finally:
                with self._changed:
                    self._running.discard(key)
                    if not self._waiting.get(key):
                        self._waiting.pop(key, None)
                    self._changed.notify()
                del job


def _run(job: _Job) -> None:
    try:
        with waiting():
            job.future.set_result(job.call(*job.arguments, **job.named))
    except BaseException as error:  # the future's reader reports it
        job.future.set_exception(error)
