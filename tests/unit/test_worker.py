"""Latest wins: what waits is replaced, what runs is cancelled once it has run for a while."""

import threading

import pytest

from app.jobs import worker
from app.jobs.worker import Watch, Worker
from tests.waiting import until


def test_a_flood_becomes_a_few_runs_and_the_last_one_wins() -> None:
    done: list[int] = []
    gate = threading.Event()

    def work(job: int, watch: Watch) -> None:
        gate.wait(5.0)
        done.append(job)

    running = Worker(work)
    for job in range(500):
        running.submit(job)
    gate.set()
    assert running.wait_idle(5.0)
    assert done[-1] == 499
    assert len(done) <= 2
    running.stop()


def test_an_old_run_gives_way_to_a_newer_job(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(worker, "SUPERSEDE_AFTER_S", 0.0)
    seen: list[tuple[str, bool]] = []

    def work(job: str, watch: Watch) -> None:
        if job == "long":
            until(watch.cancelled)
        seen.append((job, watch.superseded()))

    running = Worker(work)
    running.submit("long")
    until(lambda: running._watch is not None)
    running.submit("new")
    assert running.wait_idle(5.0)
    assert seen == [("long", True), ("new", False)]
    running.stop()


def test_a_young_run_is_let_end_although_a_newer_job_waits(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(worker, "SUPERSEDE_AFTER_S", 1e9)
    watch = Watch(lambda: True)
    assert watch.superseded()
    assert not watch.cancelled()


def test_cancel_stops_the_run_and_forgets_what_waits() -> None:
    done: list[str] = []

    def work(job: str, watch: Watch) -> None:
        until(watch.cancelled)
        done.append(job)

    running = Worker(work)
    running.submit("first")
    until(lambda: running._watch is not None)
    running.submit("second")
    running.cancel()
    assert running.wait_idle(5.0)
    assert done == ["first"]
    assert not running.busy
    running.stop()


def test_the_thread_outlives_a_fault_of_a_job(caplog: pytest.LogCaptureFixture) -> None:
    done: list[str] = []

    def work(job: str, watch: Watch) -> None:
        if job == "bad":
            raise RuntimeError("of the job")
        done.append(job)

    running = Worker(work)
    running.submit("bad")
    assert running.wait_idle(5.0)
    running.submit("good")
    assert running.wait_idle(5.0)
    assert done == ["good"]
    assert "a job failed" in caplog.text
    running.stop()


def test_nothing_runs_after_stop() -> None:
    done: list[str] = []
    running = Worker(lambda job, watch: done.append(job))
    running.stop()
    running.submit("late")
    assert running.wait_idle(0.2)
    assert done == []
