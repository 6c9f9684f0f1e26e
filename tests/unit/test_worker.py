"""Workers: the latest job wins, and heavy jobs go elsewhere and come back."""

import importlib.util
import threading

import pytest

from navcore.foundation.errors import InputError
from navcore.foundation.kernel_wait import KernelAwaited
from schuler_bench.cli import main
from schuler_bench.jobs import worker
from schuler_bench.jobs.cluster import check_address
from schuler_bench.jobs.scheduler import Lane, Load, Scheduler
from schuler_bench.jobs.worker import ElsewhereLost, Watch, Worker
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


# ---------------------------------------------------------------- elsewhere, without a cluster


@pytest.mark.parametrize("address", ["", "127.0.0.1", "http://a:1", "tcp://a", "tcp://a:b", "tcp://a b:1"])
def test_what_is_no_address_is_refused(address: str) -> None:
    with pytest.raises(InputError, match=r"--cluster.*tcp://HOST:PORT"):
        check_address(address)


def test_without_the_extra_the_command_says_how_to_install_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    assert main(["serve", "--port", "0", "--cluster", "tcp://[::1]:8786"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "--cluster" in line and "pip install 'schuler-bench[cluster]'" in line


def test_a_job_that_was_lost_elsewhere_is_done_here() -> None:
    lanes: list[Lane] = []
    there = [True]

    def work(job: str, watch: Watch) -> None:
        lanes.append(watch.lane)
        if watch.lane is Lane.CLUSTER:
            there[0] = False
            raise ElsewhereLost

    worker = Worker(
        work, load=lambda _: Load(Lane.CLUSTER if there[0] else Lane.SPARE), turns=Scheduler(1, 100.0)
    )
    worker.submit("job")
    assert worker.wait_idle(10.0)
    assert lanes == [Lane.CLUSTER, Lane.SPARE]
    worker.stop()


def test_a_lost_job_that_was_cancelled_or_has_a_successor_is_not_done_again() -> None:
    done: list[str] = []
    begun, gate = threading.Event(), threading.Event()

    def work(job: str, watch: Watch) -> None:
        done.append(job)
        begun.set()
        gate.wait(10.0)
        if job == "lost":
            raise ElsewhereLost

    for submit_another in (True, False):
        done.clear()
        begun.clear()
        gate.clear()
        worker = Worker(work, turns=Scheduler(1, 100.0))
        worker.submit("lost")
        assert begun.wait(10.0)
        if submit_another:
            worker.submit("next")
        else:
            worker.cancel()
        gate.set()
        assert worker.wait_idle(10.0)
        assert done == (["lost", "next"] if submit_another else ["lost"])
        worker.stop()


def test_jobs_elsewhere_take_no_core_and_no_memory_of_this_machine() -> None:
    turns, gate = Scheduler(1, 100.0), threading.Event()
    away = [
        Worker(lambda job, watch: gate.wait(10.0), load=lambda _: Load(Lane.CLUSTER), turns=turns)
        for _ in range(3)
    ]
    for one in away:
        one.submit(1)
    until(lambda: turns.figures()["running_cluster"] == 3.0)  # their threads begin when they can
    here = [
        Worker(lambda job, watch: None, load=lambda _, lane=lane: Load(lane, 1e9), turns=turns)
        for lane in (Lane.ANSWER, Lane.LONG, Lane.SPARE)
    ]
    for one in here:
        one.submit(1)
        assert one.wait_idle(10.0)
    assert turns.figures()["running_cluster"] == 3.0
    gate.set()
    for one in away:
        assert one.wait_idle(10.0)


def test_a_job_whose_kernel_is_being_compiled_is_tried_again_until_it_is_there() -> None:
    tried: list[str] = []

    def work(job: str, watch: Watch) -> None:
        tried.append(job)
        if len(tried) < 3:
            raise KernelAwaited("advance")

    worker = Worker(work, turns=Scheduler(1, 100.0))
    worker.submit("job")
    assert worker.wait_idle(10.0)
    assert tried == ["job"] * 3
    worker.stop()


def test_a_job_that_waits_for_its_kernel_can_be_cancelled() -> None:
    tried: list[str] = []
    begun = threading.Event()

    def work(job: str, watch: Watch) -> None:
        tried.append(job)
        begun.set()
        raise KernelAwaited("advance")

    worker = Worker(work, turns=Scheduler(1, 100.0))
    worker.submit("job")
    assert begun.wait(10.0)
    worker.cancel()
    assert worker.wait_idle(10.0) and not worker.busy
    worker.stop()
