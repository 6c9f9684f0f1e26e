"""Latest-wins execution: a slot for the newest job, cancel of the running one, turns by the scheduler."""

import logging
import threading
import time
from collections.abc import Callable
from typing import Generic, TypeVar

from navcore.foundation.kernel_wait import KernelAwaited
from navcore.foundation.stage_cache import working_for
from schuler_bench.jobs.scheduler import Lane, Load, Scheduler, Ticket, scheduler

Job = TypeVar("Job")

SUPERSEDE_AFTER_S = 0.3
"""A run younger than this may finish although it is superseded: while a slider is dragged, jobs come faster
than runs end, and cancelling each of them would show nothing until the drag ends."""
_KERNEL_S = 0.5
"""Retry interval of a job whose kernel is being compiled."""

_log = logging.getLogger("schuler.worker")


class ElsewhereLost(Exception):
    """A job that was sent elsewhere was not done there: it stands in line again, for this machine."""


class Watch:
    """Tell a running job whether to stop, and how long it has run.

    Parameters
    ----------
    newer_waits : callable
        Whether a newer job waits.
    give_way : callable, optional
        ``give_way(ended)`` stands still while more urgent jobs want the cores.
    lane : Lane
        In which the job was let on.
    given_up : callable, optional
        Whether the visitor has been away for so long that the job is to end.
    """

    def __init__(
        self,
        newer_waits: Callable[[], bool],
        give_way: Callable[[Callable[[], bool]], None] = lambda _: None,
        lane: Lane = Lane.ANSWER,
        given_up: Callable[[], bool] = lambda: False,
    ) -> None:
        self.lane, self.given_up = lane, given_up
        self.began = self.asked_s = time.monotonic()
        self.stop_asked = threading.Event()
        self._newer_waits, self._give_way = newer_waits, give_way

    @property
    def elapsed_s(self) -> float:
        """Time since the job began."""
        return time.monotonic() - self.began

    def superseded(self) -> bool:
        """Whether the result is no longer wanted."""
        return self._newer_waits()

    def unwanted(self) -> bool:
        """Whether to stop at once: asked by the user, or superseded. Asking may take time."""
        self._give_way(self._ended)
        return self._ended()

    def cancelled(self) -> bool:
        """Whether to stop now: asked by the user, or superseded and not about to end; may take time."""
        self._give_way(self._ended)
        ended = self.stop_asked.is_set() or self.given_up()
        return ended or (self.elapsed_s > SUPERSEDE_AFTER_S and self.superseded())

    def _ended(self) -> bool:
        return self.stop_asked.is_set() or self.superseded() or self.given_up()


class Worker(Generic[Job]):
    """Carries out jobs one at a time; of those that arrive meanwhile only the newest.

    Parameters
    ----------
    work : callable
        ``work(job, watch)``; polls ``watch.cancelled()``; raises `ElsewhereLost` to be called once more, and
        `KernelAwaited` to be called once more in a moment.
    visitor : object, optional
        Whose jobs these are: visitors take turns. By default the worker is a visitor of its own.
    load : callable, optional
        ``load(job)``: what the job will take.
    still_s : float
        Time without a change of the slot after which its job begins.
    turns : Scheduler, optional
        Gives the turns; by default the one of this process.
    """

    def __init__(
        self,
        work: Callable[[Job, Watch], None],
        *,
        visitor: object = None,
        load: Callable[[Job], Load] = lambda _: Load(),
        still_s: float = 0.0,
        turns: Scheduler | None = None,
    ) -> None:
        self._work, self._load, self._still_s = work, load, still_s
        self._visitor = self if visitor is None else visitor
        self._turns = turns or scheduler()
        self._changed = threading.Condition()
        self._slot: list[Job] = []
        self._asked_s = 0.0
        self._ticket: Ticket | None = None
        self._watch: Watch | None = None
        self._stopped = False

    def submit(self, job: Job) -> None:
        """Put a job into the slot, in place of one that still waits; does nothing after `stop`."""
        with self._changed:
            if self._stopped:
                return
            self._slot, self._asked_s = [job], time.monotonic()
            if self._watch is None:
                self._stand_in_line()
            self._changed.notify_all()

    def cancel(self) -> bool:
        """Stop the running job and forget the waiting one; return whether one is running."""
        with self._changed:
            self._slot = []
            if self._ticket is not None:
                self._turns.take_back(self._ticket)
                self._ticket = None
            if self._watch is not None:
                self._watch.stop_asked.set()
            self._changed.notify_all()
            return self._watch is not None

    def stop(self) -> None:
        """Cancel everything; what runs is not waited for."""
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

    def note(self, item: Job) -> str:
        """Message of an item's load to whoever waits for it."""
        return self._load(item).note

    def _stand_in_line(self, after_s: float = 0.0) -> None:
        """Wait for a turn with the job in the slot; a job of the same lane keeps the place it has."""
        load, due_s = self._load(self._slot[0]), time.monotonic() + max(self._still_s, after_s)
        if self._ticket is not None:
            if self._still_s == 0.0 and self._ticket.load.lane is load.lane:
                self._ticket.load = load
                return
            self._turns.take_back(self._ticket)
        ticket = Ticket(self._visitor, lambda: self._begin(ticket), load, due_s)
        self._ticket = ticket
        self._turns.put(ticket)

    def _begin(self, ticket: Ticket) -> None:
        with self._changed:
            if self._ticket is not ticket:  # cancelled between the scheduler's choice and this moment
                return
            self._ticket = None
            job = self._slot.pop()
            self._watch = watch = Watch(
                lambda: bool(self._slot),
                lambda ended: self._turns.give_way(ticket, ended),
                ticket.load.lane,
                lambda: self._turns.given_up(ticket),
            )
            watch.asked_s = self._asked_s
        after_s = 0.0
        try:
            with working_for(self._visitor):
                self._work(job, watch)
        except (ElsewhereLost, KernelAwaited) as reason:
            after_s = _KERNEL_S if isinstance(reason, KernelAwaited) else 0.0
            with self._changed:
                if not self._slot and not self._stopped and not watch.stop_asked.is_set():
                    self._slot = [job]
        except Exception:  # the thread must outlive any fault of a job; jobs report their own
            _log.exception("a job failed")
        finally:
            with self._changed:
                self._watch = None
                if self._slot:
                    self._stand_in_line(after_s)
                self._changed.notify_all()
