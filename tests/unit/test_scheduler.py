"""Whose turn it is: visitors in turn, answers before long runs before spare work, bounded memory."""

import threading
import time

import pytest

from navcore.foundation.errors import InputError
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from schuler_bench.jobs import scheduler as module
from schuler_bench.jobs.load import refuse_too_large, run_load, spare_load
from schuler_bench.jobs.scheduler import Lane, Load, Scheduler, Ticket, cores_of_machine, memory_of_machine
from schuler_bench.jobs.worker import Watch, Worker
from tests.waiting import until


class Line:
    """Jobs that run until they are let end, in the order in which they began."""

    def __init__(self, cores: int = 1, memory: float = 100.0) -> None:
        self.turns = Scheduler(cores, memory)
        self.began: list[str] = []
        self.gates: dict[str, threading.Event] = {}

    def put(self, name: str, visitor: object = None, lane: Lane = Lane.ANSWER, bytes: float = 0.0) -> Ticket:
        self.gates[name] = threading.Event()

        def call() -> None:
            self.began.append(name)
            self.gates[name].wait(5.0)

        ticket = Ticket(visitor or name, call, Load(lane, bytes))
        self.turns.put(ticket)
        return ticket

    def end(self, *names: str) -> None:
        for name in names:
            until(lambda name=name: name in self.began)
            self.gates[name].set()

    def idle(self) -> bool:
        return not any(self.turns.figures().values())


def test_visitors_take_turns() -> None:
    line = Line()
    line.put("first", "a")
    until(lambda: line.began == ["first"])
    for number in range(4):
        line.put(f"a{number}", "a")
    line.put("b0", "b")
    line.put("b1", "b")
    line.put("c0", "c")
    line.end("first", "b0", "c0", "a0", "b1", "a1", "a2", "a3")
    until(line.idle)
    assert line.began == ["first", "b0", "c0", "a0", "b1", "a1", "a2", "a3"]


def test_who_asks_without_a_pause_pauses_while_others_are_about() -> None:
    turns, ends, began = Scheduler(2, 100.0, pause=1.0), dict[str, float](), dict[str, float]()
    all_ended = threading.Event()

    def put(name: str, visitor: str, seconds: float) -> None:
        def call() -> None:
            began[name] = time.monotonic()
            time.sleep(seconds)
            ends[name] = time.monotonic()
            if len(ends) == 5:
                all_ended.set()

        turns.put(Ticket(visitor, call, Load()))

    put("alone 1", "a", 0.1)
    until(lambda: "alone 1" in ends)
    put("alone 2", "a", 0.0)
    until(lambda: "alone 2" in ends)
    put("other", "b", 0.0)
    until(lambda: "other" in ends)
    put("beside 1", "a", 0.1)
    until(lambda: "beside 1" in ends)
    assert turns._due_s(Ticket("a", lambda: None, Load())) >= ends["beside 1"] + 0.1
    assert turns._due_s(Ticket("b", lambda: None, Load())) <= time.monotonic()
    assert turns._due_s(Ticket("a", lambda: None, Load(Lane.LONG))) == 0.0
    put("beside 2", "a", 0.0)
    assert all_ended.wait(5.0)
    assert began["beside 2"] >= ends["beside 1"] + 0.1


def test_no_more_threads_than_cores_in_a_lane() -> None:
    line, before = Line(cores=2), threading.active_count()
    for number in range(20):
        line.put(f"{number}")
    until(lambda: len(line.began) == 2)
    time.sleep(0.05)
    assert len(line.began) == 2
    assert threading.active_count() - before == 2
    line.end(*(str(number) for number in range(20)))
    until(line.idle)


@pytest.mark.parametrize(("cores", "most"), [(1, 1), (2, 1), (4, 3)])
def test_long_runs_leave_a_core_to_answers(cores: int, most: int) -> None:
    line = Line(cores=cores)
    for number in range(6):
        line.put(f"{number}", lane=Lane.LONG)
    until(lambda: len(line.began) == most)
    time.sleep(0.05)
    assert len(line.began) == most
    line.put("answer")
    until(lambda: "answer" in line.began)
    line.end("answer", *(str(number) for number in range(6)))
    until(line.idle)


def test_memory_is_admitted_by_estimate_and_one_job_always_is() -> None:
    line = Line(cores=4, memory=100.0)
    line.put("huge", bytes=500.0)
    until(lambda: line.began == ["huge"])
    line.put("small", bytes=10.0)
    time.sleep(0.05)
    assert line.began == ["huge"]
    line.end("huge")
    for name in ("x", "y"):
        line.put(name, bytes=60.0)
    until(lambda: len(line.began) == 3)
    time.sleep(0.05)
    assert len(line.began) == 3, "small and x fit together, y does not beside them"
    line.end("small", "x", "y")
    until(line.idle)


def test_what_was_taken_back_is_not_begun() -> None:
    line = Line()
    line.put("first")
    until(lambda: line.began == ["first"])
    ticket = line.put("second")
    assert line.turns.take_back(ticket) and not line.turns.take_back(ticket)
    line.end("first")
    until(line.idle)
    assert line.began == ["first"]


@pytest.mark.parametrize("cores", [1, 2])
@pytest.mark.parametrize("lane", [Lane.LONG, Lane.SPARE])
def test_a_long_job_stands_still_while_answers_want_the_core(
    lane: Lane, cores: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "_TURN_S", 0.0)
    monkeypatch.setitem(module._PATIENCE_S, lane.value, 30.0)
    line, ended, polls = Line(cores), threading.Event(), []

    def work(job: str, watch: Watch) -> None:
        while not ended.is_set():
            watch.cancelled()
            polls.append(watch.elapsed_s)
            time.sleep(0.001)

    worker = Worker(work, load=lambda _: Load(lane), turns=line.turns)
    worker.submit("long")
    until(lambda: len(polls) > 3)
    line.put("answer")
    until(lambda: line.began == ["answer"])
    time.sleep(0.05)
    seen = len(polls)
    time.sleep(0.15)
    assert len(polls) <= seen + 1
    line.end("answer")
    until(lambda: len(polls) > seen + 5)
    ended.set()
    assert worker.wait_idle(5.0)


def test_a_job_that_stands_still_ends_when_it_is_cancelled(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_TURN_S", 0.0)
    monkeypatch.setitem(module._PATIENCE_S, "long", 30.0)
    line, stopped = Line(), threading.Event()

    def work(job: str, watch: Watch) -> None:
        until(watch.cancelled, 20.0)
        stopped.set()

    worker = Worker(work, load=lambda _: Load(Lane.LONG), turns=line.turns)
    worker.submit("long")
    until(lambda: worker._watch is not None)
    line.put("answer")
    until(lambda: line.began == ["answer"])
    time.sleep(0.1)
    worker.cancel()
    assert stopped.wait(5.0)
    line.end("answer")


def test_it_gets_a_turn_after_a_while_all_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_TURN_S", 0.0)
    monkeypatch.setitem(module._PATIENCE_S, "spare", 0.05)
    line, polls, ended = Line(), [], threading.Event()

    def work(job: str, watch: Watch) -> None:
        while not ended.is_set():
            watch.unwanted()
            polls.append(0)

    worker = Worker(work, load=lambda _: Load(Lane.SPARE), turns=line.turns)
    worker.submit("why")
    until(lambda: len(polls) > 0)
    line.put("answer")
    until(lambda: line.began == ["answer"])
    seen = len(polls)
    until(lambda: len(polls) > seen + 3)
    ended.set()
    line.end("answer")
    assert worker.wait_idle(5.0)


def test_spare_work_waits_for_the_picture_of_an_answer_and_for_the_next_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(module, "_TURN_S", 0.0)
    monkeypatch.setattr(module, "_DRAWN_S", 30.0)
    monkeypatch.setitem(module._PATIENCE_S, "spare", 30.0)
    line, polls, ended = Line(cores=2), [], threading.Event()

    def work(job: str, watch: Watch) -> None:
        while not ended.is_set():
            watch.unwanted()
            polls.append(0)
            time.sleep(0.001)

    def stands_still() -> bool:
        seen = len(polls)
        time.sleep(0.15)
        return len(polls) <= seen + 1

    worker = Worker(work, load=lambda _: Load(Lane.SPARE), turns=line.turns)
    worker.submit("study")
    until(lambda: len(polls) > 3)
    line.put("answer")
    line.end("answer")
    until(lambda: not line.turns.figures()["running_answer"])
    assert stands_still(), "the answer is drawn"
    (ticket,) = line.turns._running
    ticket._since_s = -1e9  # it began long ago
    monkeypatch.setattr(module, "_TURN_S", 30.0)
    monkeypatch.setattr(module, "_DRAWN_S", 0.0)
    seen = len(polls)
    until(lambda: len(polls) > seen + 5)
    line.put("next")
    until(lambda: "next" in line.began)
    time.sleep(0.05)
    assert stands_still()
    ended.set()
    line.end("next")
    assert worker.wait_idle(5.0)


def test_spare_work_is_begun_only_when_nothing_else_is_under_way() -> None:
    line = Line(cores=2)
    line.put("answer")
    until(lambda: line.began == ["answer"])
    line.put("spare", lane=Lane.SPARE)
    time.sleep(0.15)
    assert line.began == ["answer"]
    line.end("answer")
    until(lambda: line.began == ["answer", "spare"])
    line.end("spare")
    until(line.idle)


def test_a_slot_must_stand_still_before_its_job_is_begun() -> None:
    began: list[tuple[str, float]] = []
    turns = Scheduler(1, 1.0)
    worker = Worker(lambda job, _: began.append((job, time.monotonic())), still_s=0.15, turns=turns)
    for job in ("a", "b", "c"):
        last_s = time.monotonic()
        worker.submit(job)
    assert worker.wait_idle(5.0)
    assert [job for job, _ in began] == ["c"]
    assert began[0][1] - last_s >= 0.15


def test_a_cancelled_worker_takes_the_next_job() -> None:
    done: list[int] = []
    turns = Scheduler(1, 1.0)
    worker = Worker(lambda job, _: done.append(job), turns=turns)
    for job in range(300):
        worker.submit(job)
        worker.cancel()
    worker.submit(1000)
    assert worker.wait_idle(5.0)
    assert done[-1] == 1000


def test_memory_and_cores_of_the_machine() -> None:
    assert memory_of_machine() > 1 << 28
    assert cores_of_machine() >= 2


def test_a_run_that_would_take_too_much_memory_is_refused_with_its_size() -> None:
    refuse_too_large(with_hours(24.0))
    with pytest.raises(InputError, match=r"run.duration_h = .* about \d+\.\d GB .* at most \d") as error:
        refuse_too_large(with_hours(20_000.0))
    assert len(error.value.faults) == 1


def test_lane_follows_the_estimated_time() -> None:
    assert run_load(with_hours(24.0)).lane is Lane.ANSWER
    assert run_load(with_hours(833.0)).lane is Lane.LONG
    assert spare_load(with_hours(24.0)).bytes == run_load(with_hours(24.0)).bytes > 1e6


def with_hours(hours: float) -> Scenario:
    scenario = load("sikuliaq-like")
    return scenario.model_copy(update={"run": scenario.run.model_copy(update={"duration_h": hours})})


def test_what_two_have_asked_is_answered_side_by_side_while_a_core_is_idle() -> None:
    """On two cores a search waited for the end of another one, and one core had nothing to do."""
    line = Line(cores=2)
    line.put("tune", "a", Lane.SPARE)
    line.put("study", "b", Lane.SPARE)
    line.put("third", "c", Lane.SPARE)
    until(lambda: sorted(line.began) == ["study", "tune"])
    line.put("answer", "d")
    until(lambda: "answer" in line.began)  # it waits for none of them: they stand still meanwhile
    assert "third" not in line.began
    line.end("answer", "tune", "study", "third")
    until(line.idle)
