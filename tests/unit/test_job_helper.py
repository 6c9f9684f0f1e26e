"""Heavy jobs in processes of their own: they leave the server's interpreter alone, stand still and end."""

import gc
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.foundation.errors import Fault, InputError
from navcore.questions.adapt import AdaptQuestion
from navcore.questions.budget import BudgetQuestion
from navcore.questions.pareto import ParetoQuestion
from navcore.questions.tune import TuneQuestion
from navcore.questions.verify import VerifyQuestion
from navcore.questions.why import WhyQuestion
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from schuler_bench.jobs import helper
from schuler_bench.jobs.asking import Asker
from schuler_bench.jobs.envelopes import Envelopes
from schuler_bench.jobs.long_runs import run_for
from schuler_bench.jobs.scheduler import Lane, Scheduler
from schuler_bench.jobs.search import Search
from schuler_bench.jobs.worker import Watch
from tests.waiting import until

Progress = Callable[[float], None]
Cancelled = Callable[[], bool]


@pytest.fixture(autouse=True, scope="module")
def helped() -> Iterator[None]:
    helper.start()
    yield
    helper.stop()


def counting(item: Path, progress: Progress, cancelled: Cancelled) -> int:
    """Count the looks, in a file as well; ends when cancelled."""
    for looks in range(100_000):
        with item.open("a") as file:
            file.write("x")
        progress(looks / 100_000)
        if cancelled():
            return os.getpid()
        time.sleep(0.001)
    return 0


def deaf(item: object, progress: Progress, cancelled: Cancelled) -> None:
    time.sleep(60.0)


def answering(item: Any, progress: Progress, cancelled: Cancelled) -> Any:
    if item == "die":
        os.kill(os.getpid(), signal.SIGKILL)
    if isinstance(item, Exception):
        raise item
    return lambda: None if item == "a function" else (os.getpid(), item)


def pid_and_item(item: Any, progress: Progress, cancelled: Cancelled) -> tuple[int, Any]:
    return os.getpid(), item


def test_a_helper_does_all_items_and_stays_for_the_next_job() -> None:
    done = helper.compute(pid_and_item, [1, "two"], lambda _: None, lambda: False)
    again = helper.compute(pid_and_item, [3], lambda _: None, lambda: False)
    assert done is not None and again is not None
    pids = {pid for pid, _ in [*done, *again]}
    assert [item for _, item in [*done, *again]] == [1, "two", 3]
    assert len(pids) == 1 and os.getpid() not in pids


def test_a_job_that_is_not_found_by_its_name_is_not_handed_over() -> None:
    assert helper.helps(pid_and_item) and not helper.helps(lambda item, progress, cancelled: item)
    helper.stop()
    try:
        assert not helper.helps(pid_and_item) and helper._helpers.idle == []
    finally:
        helper.start()


def test_it_stands_still_while_it_is_not_told_to_go_on_and_ends_when_nobody_waits(tmp_path: Path) -> None:
    place, go_on, asked, ends = tmp_path / "looks", threading.Event(), threading.Event(), [False]

    def unwanted() -> bool:
        asked.set()
        go_on.wait(30.0)
        return ends[0]

    told, done = list[float](), list[Any]()

    def work() -> None:
        done.append(helper.compute(counting, [place], told.append, unwanted))

    thread = threading.Thread(target=work, daemon=True)
    thread.start()
    try:
        until(place.exists, 30.0)
        assert asked.wait(30.0)
        until(lambda: stands_still(place), 30.0)
        looks = place.stat().st_size
        go_on.set()
        until(lambda: place.stat().st_size > looks + 100, 30.0)
        ends[0] = True
    finally:
        go_on.set()
    thread.join(30.0)
    ((pid,),) = done
    assert pid not in (0, os.getpid()) and told and told == sorted(told)


def stands_still(place: Path) -> bool:
    """Whether nothing is counted for a while."""
    looks = place.stat().st_size
    time.sleep(0.3)
    return place.stat().st_size == looks


def test_one_that_does_not_end_is_killed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(helper, "_END_S", 0.3)
    began = time.monotonic()
    assert helper.compute(deaf, [None], lambda _: None, lambda: True) is None
    assert time.monotonic() - began < 30.0  # of the 60 that it wants
    assert helper._helpers.idle == []


@pytest.mark.parametrize(
    ("item", "kind", "words"),
    [
        (InputError(Fault("", "run.duration_h", 1, "is short")), InputError, "run.duration_h = 1: is short"),
        (ValueError("odd"), ValueError, "odd"),
        (OSError(28, "No space left"), OSError, "No space left"),
        ("a function", RuntimeError, "local object"),
        ("die", RuntimeError, "the process that computed it has ended"),
    ],
)
def test_a_fault_comes_back_and_the_next_job_is_done(item: Any, kind: type[Exception], words: str) -> None:
    with pytest.raises(kind, match=words):
        helper.compute(answering, [item], lambda _: None, lambda: False)
    after = helper.compute(pid_and_item, [1], lambda _: None, lambda: False)
    assert after is not None and after[0][1] == 1


def cpu_s(pid: int) -> float:
    """Processor time of a process."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(") ")[2].split()
    return sum(map(int, fields[11:13])) / os.sysconf("SC_CLK_TCK")


SCENARIO = load("sikuliaq-like")
ADAPTIVE = {"damping": "external", "network": {"id": "unity2"}, "policy": {"id": "adaptive"}}


def begun(name: str) -> Search[Any, Any]:
    """One of the searches, begun."""
    search: Search[Any, Any]
    if name == "fronts":
        search = Asker(lambda: None, ParetoQuestion)
        search.begin(
            ParetoQuestion(
                scenario=SCENARIO, x="velocity_rms", y="settling_s", method=2, network=("compass",)
            )
        )
    elif name == "setting":
        search = Asker(lambda: None, TuneQuestion)
        search.begin(TuneQuestion(scenario=SCENARIO, objective="tilt_rms", vary=("method.2.network.zeta",)))
    elif name == "budget":
        search = Asker(lambda: None, BudgetQuestion)
        search.begin(BudgetQuestion(scenario=SCENARIO))
    elif name == "verification":
        search = Asker(lambda: None, VerifyQuestion)
        search.begin(VerifyQuestion(scenario=SCENARIO))
    elif name == "why":
        search = Asker(lambda: None, WhyQuestion, still_s=0.0)
        search.follow(WhyQuestion.of(simulate(SCENARIO)))
    elif name == "table":
        search = Asker(lambda: None, AdaptQuestion)
        search.begin(
            AdaptQuestion(scenario=Scenario.parse({"reference": {"kind": "log"}, "method": [ADAPTIVE]}))
        )
    else:
        search = Envelopes(simulate, lambda: None, lambda: None, still_s=0.0)
        search.follow(SCENARIO, "seeds" if name == "seeds" else "covariance")
    return search


@pytest.fixture
def at_rest() -> Iterator[None]:
    """Let the process do nothing else: no threads of earlier tests, no collection of what they have left."""
    gc.collect()
    gc.disable()
    for _ in range(50):
        before_s = time.process_time()
        time.sleep(0.1)
        if time.process_time() - before_s < 0.01:
            break
    yield
    gc.enable()


@pytest.mark.usefixtures("at_rest")
@pytest.mark.parametrize(
    "name", ["fronts", "setting", "budget", "verification", "why", "table", "seeds", "covariance"]
)
def test_no_search_takes_the_time_of_the_server(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Processor time of this process beside that of its helper, until the search ends or has had 1 s."""
    simulate(SCENARIO)
    taken, take = list[tuple[int, float]](), helper._helpers.take

    def noted() -> helper._Helper:
        one = take()
        pid = one._process.pid
        assert pid is not None
        taken.append((pid, cpu_s(pid)))
        return one

    monkeypatch.setattr(helper._helpers, "take", noted)
    began_s, theirs_s = time.process_time(), 0.0
    search = begun(name)
    while not search.wait_idle(0.05) and theirs_s + time.process_time() - began_s < 1.0:
        theirs_s = sum(cpu_s(pid) - before_s for pid, before_s in taken)
    own_s = time.process_time() - began_s
    theirs_s = sum(cpu_s(pid) - before_s for pid, before_s in taken)
    search.stop()
    assert search.wait_idle(30.0)
    assert own_s + theirs_s >= 1.0 or search.result is not None, search.words
    assert own_s < 0.25 * (own_s + theirs_s)


@pytest.mark.parametrize(
    ("lane", "others", "large", "helped"),
    [
        ("long", True, False, True),
        ("long", False, False, False),
        ("long", False, True, True),
        ("answer", True, False, False),
    ],
)
def test_a_long_run_beside_others_is_done_by_a_helper(
    lane: str, others: bool, large: bool, helped: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is the same run to the last bit; alone, or short, it stays where the last run is at hand."""
    monkeypatch.setattr("schuler_bench.jobs.long_runs._MOST_HERE", 0.0 if large else 1e12)
    turns = Scheduler(2, 1e12)
    if others:
        turns._answered("another", 0.01)
    turns._answered("mine", 0.01)
    monkeypatch.setattr("schuler_bench.jobs.long_runs.scheduler", lambda: turns)
    here = list[Scenario]()

    def run_here(scenario: Scenario, progress: Progress, cancelled: Cancelled) -> Run:
        here.append(scenario)
        return simulate(scenario, progress, cancelled)

    watch = Watch(lambda: False, lane=Lane(lane))
    run = run_for("mine", run_here, load("zha-fast"), lambda _: None, watch)
    assert run is not None and (here == []) is helped
    for one, other in zip(run.methods, simulate(load("zha-fast")).methods, strict=True):
        np.testing.assert_array_equal(one.rows, other.rows)
        assert one.errors == other.errors


def test_a_long_run_in_a_helper_ends_when_it_is_superseded(monkeypatch: pytest.MonkeyPatch) -> None:
    turns = Scheduler(2, 1e12)
    turns._answered("another", 0.01)
    monkeypatch.setattr("schuler_bench.jobs.long_runs.scheduler", lambda: turns)
    watch = Watch(lambda: True, lane=Lane.LONG)
    watch.began -= 10.0
    scenario = load("zha-fast", ["run.duration_h=800"])
    run = run_for("mine", lambda *_: simulate(scenario), scenario, lambda _: None, watch)
    assert run is None or run.status == "stopped"
