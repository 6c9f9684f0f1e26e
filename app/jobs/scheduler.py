"""Scheduler: the order of everything that is computed for the visitors of this process.

Three lanes for what is computed here. *Answers* are the short runs that follow a control: one a core, the
visitors in turn. *Long* runs are those that are estimated to take a while: one a core but for one core, and
they stand still while answers want as many cores: a run computes its methods side by side, and would leave
an answer less than one. *Spare* work (what dominates a run, envelopes, verification, searches, studies, pins
after a restart) goes on only while nothing else does and no answer is being drawn. A job stands still where
it asks whether it is cancelled; so that none stands still for ever under lasting load, each gets a short turn
after a while all the same. All jobs together are admitted by their estimated memory.

A visitor none of whose pages is open is *away*. What such a visitor has asked for goes on for a while
(`schuler_bench.jobs.away`), behind everything that those ask for who are there: it begins only when none of
that waits, takes no thread from it, and stands still meanwhile without a turn of its own.

A fourth lane is for heavy jobs that a Dask cluster computes (`schuler_bench.jobs.cluster`): they take turns
among themselves, and neither cores nor memory of this machine.
"""

import os
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

from navcore.foundation.cores import cores
from schuler_bench.jobs.away import AWAY_S, Away, away_seconds

GIB = 1 << 30
WORKERS = "SCHULER_WORKERS"
"""Set in the environment of a worker: how many share the machine."""
_TURN_S = 0.2
"""A long or spare job that has begun, or has stood still for long, goes on for at least so long."""
_PATIENCE_S = {"long": 0.8, "spare": 2.0}
"""Longest pause of a job before it gets a turn."""
_LOOK_S = 0.05
_DRAWN_S = 0.12
"""Time to draw the picture of an answer, here and in a browser that may share the cores."""
_MOST_REMEMBERED = 4096
_MOST_SPARE = 4
"""Jobs beside the answers at once: each may be of a process of its own."""
_MOST_ON_CLUSTER = 8
"""Jobs sent to a cluster at once; each may be of several parts."""
_ABOUT_S, _LONGEST_PAUSE_S = 3.0, 0.3
"""So long after an answer a visitor counts as about; no pause is longer than that."""


class Lane(Enum):
    """Kind of work of a job."""

    ANSWER = "answer"
    LONG = "long"
    SPARE = "spare"
    CLUSTER = "cluster"


@dataclass(frozen=True)
class Load:
    """Estimated needs of a job.

    Attributes
    ----------
    lane : Lane
        Where it waits.
    bytes : float
        Memory it holds while it is under way.
    note : str
        What is to be known of the place where it is computed.
    """

    lane: Lane = Lane.ANSWER
    bytes: float = 0.0
    note: str = ""


@dataclass(eq=False)
class Ticket:
    """One job's place in the line.

    Attributes
    ----------
    visitor : object
        Whose job it is; visitors take turns.
    call : callable
        ``call()`` does the work.
    load : Load
        What it takes.
    due_s : float
        Not to be begun before, monotonic.
    """

    visitor: object
    call: Callable[[], None]
    load: Load
    due_s: float = 0.0
    _order: int = 0
    _since_s: float = 0.0
    _still: bool = False
    _given_up: bool = False


class Scheduler:
    """Threads, at most one a core for each lane, and the line of what waits for them.

    Parameters
    ----------
    cores : int
        Answers that are under way at once; of the other lanes one less, but at least one.
    memory_bytes : float
        What all jobs under way may hold together, by estimate; one job alone is always admitted.
    pause : float
        While others are about, a visitor's next answer is begun only after this many times the time that
        the last one took. Answers share the interpreter: whoever asks for the next one without a pause, by
        hand or by a script, would otherwise take half of it from the one who asks now and then.
    away_s : float
        So long the jobs of a visitor who is away go on.

    Attributes
    ----------
    away : Away
        Visitors none of whose pages is open.
    """

    def __init__(self, cores: int, memory_bytes: float, pause: float = 0.0, away_s: float = AWAY_S) -> None:
        self.cores, self.memory_bytes, self.pause = cores, memory_bytes, pause
        self.away = Away(away_s)
        self._paused_s: dict[object, float] = {}
        self._last_answer_s: dict[object, float] = {}
        self._changed = threading.Condition()
        self._waiting: list[Ticket] = []
        self._running: list[Ticket] = []
        self._served: dict[object, int] = {}
        self._count = 0
        self._threads = dict.fromkeys(Lane, 0)
        self._idle = dict.fromkeys(Lane, 0)

    def put(self, ticket: Ticket) -> None:
        """Let a job wait for its turn."""
        with self._changed:
            self._count += 1
            ticket._order = self._count
            self._waiting.append(ticket)
            self._staff(ticket.load.lane)
            self._changed.notify_all()

    def _staff(self, lane: Lane) -> None:
        """Start a thread for what waits, if there may be one more."""
        if not self._idle[lane] and self._threads[lane] - self._lent(lane) < self._most(lane):
            self._threads[lane] += 1
            name = f"{lane.value}-{self._threads[lane]}"
            threading.Thread(target=self._loop, args=(lane,), name=name, daemon=True).start()

    def _lent(self, lane: Lane) -> int:
        """Threads that are with jobs of visitors who are away, and are not to be missed by the others."""
        return sum(t.load.lane is lane and self._is_away(t) for t in self._running)

    def _most(self, lane: Lane) -> int:
        """Jobs of a lane at once. Long runs leave a core to answers; spare work stands still meanwhile."""
        if lane is Lane.CLUSTER:
            return _MOST_ON_CLUSTER
        if lane is Lane.LONG:
            return max(1, self.cores - 1)
        return min(self.cores, _MOST_SPARE) if lane is Lane.SPARE else self.cores

    def take_back(self, ticket: Ticket) -> bool:
        """Remove a job that still waits; False when it does not, or not any more."""
        with self._changed:
            if ticket not in self._waiting:
                return False
            self._waiting.remove(ticket)
            return True

    def leave(self, visitor: object) -> None:
        """The visitor's last page has gone: what was asked for gives way to everybody's who is there."""
        with self._changed:
            self.away.leave(visitor)
            for lane in Lane:
                lent = [t for t in self._running if t.load.lane is lane and self._is_away(t)]
                lent.sort(key=lambda ticket: self.away.since_s(ticket.visitor))
                # Each may hold a process, and memory: those of who left first make room.
                for ticket in lent[: max(0, len(lent) - self._most(lane))]:
                    ticket._given_up = True
                if any(t.load.lane is lane for t in self._waiting):
                    self._staff(lane)
            self._changed.notify_all()

    def come_back(self, visitor: object) -> None:
        """A page of the visitor is open."""
        with self._changed:
            if self.away.come_back(visitor):
                self._changed.notify_all()

    def expects(self, visitor: object) -> bool:
        """Whether a visitor is away, and may still come back for what was asked for."""
        with self._changed:
            return visitor in self.away and not self.away.too_long(visitor)

    def given_up(self, ticket: Ticket) -> bool:
        """Whether a job under way is to end because its visitor has been away for too long."""
        with self._changed:
            return ticket._given_up or self.away.too_long(ticket.visitor)

    def _is_away(self, ticket: Ticket) -> bool:
        return ticket.visitor in self.away

    def give_way(self, ticket: Ticket, ended: Callable[[], bool]) -> None:
        """Stand still while more urgent work wants the cores; called by the job itself, now and then.

        Parameters
        ----------
        ticket : Ticket
            Of the job.
        ended : callable
            Whether the job is to end anyway.
        """
        lane = ticket.load.lane
        if lane in (Lane.ANSWER, Lane.CLUSTER):
            return
        with self._changed:
            began_s = time.monotonic()
            if began_s - ticket._since_s < _TURN_S:
                return
            until_s = began_s + _PATIENCE_S[lane.value]
            while self._must_wait(ticket) and not ended():
                if not self._is_away(ticket) and time.monotonic() >= until_s:
                    ticket._since_s = time.monotonic()
                    break
                ticket._still = True
                self._changed.wait(_LOOK_S)
            ticket._still = False

    def figures(self) -> dict[str, float]:
        """Count what waits and runs now, for ``/metrics``: jobs of each lane, estimated bytes under way."""
        with self._changed:
            counts = {
                f"{state}_{lane.value}": float(sum(t.load.lane is lane for t in tickets))
                for state, tickets in (("waiting", self._waiting), ("running", self._running))
                for lane in Lane
            }
            return counts | {"running_bytes": sum(t.load.bytes for t in self._running)}

    def others_about(self, visitor: object) -> bool:
        """Whether any other visitor was recently served, or has a job in the queue."""
        with self._changed:
            since_s = time.monotonic() - _ABOUT_S
            about = {v for v, s in self._last_answer_s.items() if s > since_s}
            about |= {t.visitor for t in (*self._waiting, *self._running) if t.load.lane is not Lane.SPARE}
            return any(one != visitor and one not in self.away for one in about)

    # ------------------------------------------------------------ choosing

    def _must_wait(self, ticket: Ticket) -> bool:
        mine = ticket.load.lane
        waiting, running = _here(self._waiting), _here(self._running)
        if self._is_away(ticket):
            if mine is Lane.CLUSTER:
                return any(t.load.lane is mine and not self._is_away(t) for t in self._waiting)
            others = (*waiting, *(t for t in running if not t._still))
            return self._drawn_of_late() or any(not self._is_away(t) for t in others)
        waiting, running = ([t for t in some if not self._is_away(t)] for some in (waiting, running))
        if any(t.load.lane is Lane.ANSWER or mine is Lane.SPARE is not t.load.lane for t in waiting):
            return True
        active = [t for t in running if not t._still and t is not ticket]
        if mine is Lane.SPARE:
            return self._drawn_of_late() or any(t.load.lane is not Lane.SPARE for t in active)
        return sum(t.load.lane is not Lane.SPARE for t in active) >= self._most(mine)

    def _drawn_of_late(self) -> bool:
        """Whether the picture of an answer may still be drawn."""
        since_s = time.monotonic() - _DRAWN_S
        return any(answered_s >= since_s for answered_s in self._last_answer_s.values())

    def _next(self, lane: Lane) -> Ticket | None:
        now_s, most = time.monotonic(), self._most(lane)
        running, lent = _here(self._running), self._lent(lane)
        held = sum(t.load.bytes for t in running)
        due = [t for t in self._waiting if t.load.lane is lane and self._due_s(t) <= now_s]
        there = [t for t in due if not self._is_away(t)]
        if sum(t.load.lane is lane for t in self._running) - lent >= most:
            return None
        if not there and lent < most:
            due = [t for t in due if not self.away.too_long(t.visitor) and not self._must_wait(t)]
        else:
            due = there
        free = [t for t in due if not running or held + t.load.bytes <= self.memory_bytes]
        if there and not free:
            for ticket in running:
                ticket._given_up |= self._is_away(ticket)  # the memory is wanted by those who are there
        if not free or (lane is Lane.SPARE and self._must_wait(free[0])):
            return None
        chosen = min(free, key=lambda t: (self._served.get(t.visitor, 0), t._order))
        self._waiting.remove(chosen)
        self._count += 1
        self._served.pop(chosen.visitor, None)
        self._served[chosen.visitor] = self._count
        while len(self._served) > _MOST_REMEMBERED:
            del self._served[next(iter(self._served))]
        return chosen

    def _due_s(self, ticket: Ticket) -> float:
        """When a job may begin, monotonic."""
        if ticket.load.lane is not Lane.ANSWER:
            return ticket.due_s
        return max(ticket.due_s, self._paused_s.get(ticket.visitor, 0.0))

    def _answered(self, visitor: object, took_s: float) -> None:
        """Let a visitor pause who has just been answered, if others have been of late."""
        now_s = time.monotonic()
        self._last_answer_s = {v: s for v, s in self._last_answer_s.items() if now_s - s < _ABOUT_S}
        self._paused_s = {v: s for v, s in self._paused_s.items() if s > now_s}
        if self._last_answer_s.keys() - {visitor}:
            self._paused_s[visitor] = now_s + min(self.pause * took_s, _LONGEST_PAUSE_S)
        self._last_answer_s[visitor] = now_s

    def _loop(self, lane: Lane) -> None:
        while True:
            with self._changed:
                if self._threads[lane] - self._lent(lane) > self._most(lane):  # one was lent, and is back
                    self._threads[lane] -= 1
                    return
                self._idle[lane] += 1
                while (ticket := self._next(lane)) is None:
                    self._changed.wait(self._until_due_s(lane))
                self._idle[lane] -= 1
                ticket._since_s = began_s = time.monotonic()
                self._running.append(ticket)
            try:
                ticket.call()
            finally:
                with self._changed:
                    self._running.remove(ticket)
                    if lane is Lane.ANSWER:
                        self._answered(ticket.visitor, time.monotonic() - began_s)
                    self._changed.notify_all()
                del ticket

    def _until_due_s(self, lane: Lane) -> float | None:
        dues = [
            self._due_s(t) for t in self._waiting if t.load.lane is lane and not self.away.too_long(t.visitor)
        ]
        if not dues:
            return None
        left_s = min(dues) - time.monotonic()
        return left_s if left_s > 0.0 else _LOOK_S


def _here(tickets: list[Ticket]) -> list[Ticket]:
    """Those that take cores and memory of this machine."""
    return [t for t in tickets if t.load.lane is not Lane.CLUSTER]


def memory_of_machine() -> float:
    """Bytes this process may hold: of the container it runs in, else of the machine; 4 GiB if unknown."""
    limits = []
    for name in ("memory.max", "memory/memory.limit_in_bytes"):
        try:
            text = Path("/sys/fs/cgroup", name).read_text().strip()
        except OSError:
            continue
        limits += [float(text)] if text.isdigit() else []
    try:
        limits.append(float(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")))
    except (OSError, ValueError, AttributeError):
        limits.append(4.0 * GIB)
    return min(limits)


def cores_of_machine() -> int:
    """Cores this process may use, at least two: a run that waits must not keep all others waiting."""
    return max(2, cores())


_one: list[Scheduler] = []
_making = threading.Lock()


def scheduler() -> Scheduler:
    """The one scheduler of this process."""
    with _making:
        if not _one:
            workers = int(os.environ.get(WORKERS, "1"))
            cores = cores_of_machine() if workers == 1 else max(1, cores_of_machine() // workers)
            memory_bytes = _PART_FOR_RUNS * memory_of_machine() / workers
            _one.append(Scheduler(cores, memory_bytes, pause=1.0, away_s=away_seconds(os.environ)))
        return _one[0]


_PART_FOR_RUNS = 0.4
LARGEST_RUN = 2.0 * GIB
"""Bytes that one run may take by estimate; less where the machine has less."""


def largest_run_bytes() -> float:
    """Estimated bytes beyond which a run is refused."""
    return min(LARGEST_RUN, scheduler().memory_bytes)
