"""Jobs in the background: what dominates a run that stands still, a damping table, a halted search."""

import threading
from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

import pytest

from navcore.foundation.errors import Fault, InputError
from navcore.questions.adapt import AdaptQuestion
from navcore.questions.budget import BudgetQuestion
from navcore.questions.design import DesignQuestion
from navcore.questions.pareto import ParetoQuestion
from navcore.questions.tune import TuneQuestion
from navcore.questions.why import WhyQuestion
from navcore.scenario.model import Scenario
from schuler_bench.jobs.asking import Asker
from schuler_bench.jobs.scheduler import Lane, Load
from schuler_bench.jobs.searches import Searches
from tests.waiting import until


class Finder:
    """Stand-in for a long search that notes what it did."""

    def __init__(self) -> None:
        self.begun, self.ended = threading.Event(), threading.Event()
        self.quick = True
        self.asked: list[Any] = []

    def __call__(self, run: Any, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> Any:
        self.asked.append(run)
        if run == "fault":
            raise ZeroDivisionError
        self.begun.set()
        while not self.quick and not cancelled():
            progress(0.5)
            threading.Event().wait(0.002)
        self.ended.set()
        return SimpleNamespace(complete=not cancelled(), of=run)


@pytest.fixture
def finder() -> Finder:
    return Finder()


def with_finder(explainer: Asker, finder: Finder) -> Asker:
    explainer._compute = finder
    explainer._worker._load = lambda _: Load(Lane.SPARE)
    explainer._worker._still_s = 0.1
    explainer.report_after_s = 0.05
    return explainer


@pytest.fixture
def explained(finder: Finder) -> Iterator[tuple[Asker, list[Any]]]:
    told: list[Any] = []
    explainer = Asker(lambda: told.append((explainer.fraction, explainer.result)), WhyQuestion, "explainer")
    yield with_finder(explainer, finder), told
    explainer.cancel()
    explainer.stop()


def test_a_run_that_stands_still_is_explained_once(finder: Finder, explained: Any) -> None:
    explainer, told = explained
    first, second = object(), object()
    explainer.follow(first)
    explainer.follow(second)  # the first has not stood still
    assert explainer.wait_idle(5.0)
    assert finder.asked == [second]
    assert explainer.asked is second
    assert len(told) == 1


def test_a_change_ends_the_search_at_once_and_the_old_result_stays(finder: Finder, explained: Any) -> None:
    explainer, told = explained
    first, second = object(), object()
    explainer.follow(first)
    assert explainer.wait_idle(5.0)
    old = explainer.result
    finder.quick = False
    finder.ended.clear()
    finder.begun.clear()
    explainer.follow(second)
    assert finder.begun.wait(5.0)
    until(lambda: (0.5, old) in told)
    explainer.cancel()
    assert finder.ended.wait(5.0) and explainer.wait_idle(5.0)
    assert explainer.result is old and explainer.fraction is None
    assert explainer.asked is first


def test_a_fault_is_told_and_forgotten_with_the_next_run(finder: Finder, explained: Any, caplog: Any) -> None:
    explainer, _ = explained
    explainer.follow("fault")
    assert explainer.wait_idle(5.0)
    assert "ZeroDivisionError" in explainer.words[0] and "explainer failed" in caplog.text
    explainer.follow("run")
    assert not explainer.words
    assert explainer.wait_idle(5.0) and explainer.asked == "run"


def of_the_ship() -> Any:
    """Stand-in for a run."""
    return SimpleNamespace(scenario=SHIP)


def test_without_a_page_nothing_is_looked_for(finder: Finder) -> None:
    searches = Searches("test")
    with_finder(searches.asking["why"], finder)
    run: Any = SimpleNamespace(scenario=SHIP)
    searches.explain(run)
    assert not searches.asking["why"]._worker.busy
    told: list[int] = []
    watch = lambda: told.append(1)  # noqa: E731
    searches.watch(watch)
    assert not searches.asking["why"]._worker.busy, "nobody looks at it"
    searches.explain(run)
    assert searches.asking["why"].wait_idle(5.0)
    assert told and searches.asking["why"].asked == WhyQuestion.of(run)
    finder.quick = False
    finder.begun.clear()
    searches.explain(of_the_ship())
    assert finder.begun.wait(5.0)
    searches.unwatch(watch)
    assert searches.asking["why"]._worker.busy, "what was begun goes on"
    searches.stop()
    assert searches.asking["why"].wait_idle(5.0)


def test_a_run_that_several_pages_show_is_looked_at_once(finder: Finder) -> None:
    searches = Searches("test")
    with_finder(searches.asking["why"], finder)
    run: Any = SimpleNamespace(scenario=SHIP)
    searches.watch(lambda: None)
    finder.quick = False
    searches.explain(run)
    assert finder.begun.wait(5.0)
    finder.begun.clear()
    searches.explain(run)
    finder.quick = True
    assert searches.asking["why"].wait_idle(5.0)
    searches.explain(run)
    assert searches.asking["why"].wait_idle(5.0) and finder.asked == [WhyQuestion.of(run)]
    searches.changed()
    searches.explain(another := of_the_ship())
    assert searches.asking["why"].wait_idle(5.0) and finder.asked == [
        WhyQuestion.of(one) for one in (run, another)
    ]
    searches.stop()


# ------------------------------------------------------------ the table


def tuned(task: Any, progress: Any, cancelled: Any) -> Any:
    scenario = task.scenario
    if scenario == "refused":
        raise InputError(Fault("", "imu.file", "a.csv", "must be empty"))
    if scenario == "fault":
        raise ZeroDivisionError("ours")
    while scenario == "endless" and not cancelled():
        progress(0.5)
        threading.Event().wait(0.002)
    return SimpleNamespace(complete=not cancelled(), of=scenario)


def test_a_table_is_found_stopped_refused_and_kept() -> None:
    told: list[float | None] = []
    tuner = Asker(lambda: told.append(tuner.fraction), AdaptQuestion)
    tuner._compute = tuned
    tuner._worker._load = lambda _: Load(Lane.SPARE)

    def begin(scenario: Any) -> None:
        tuner.begin(AdaptQuestion.model_construct(scenario=scenario))

    begin("one")
    assert tuner.wait_idle(5.0)
    kept = tuner.result
    assert kept is not None and tuner.asked is not None and tuner.asked.scenario == "one"
    assert told == [0.0, None]
    begin("endless")
    until(lambda: 0.5 in told)
    tuner.cancel()
    assert tuner.wait_idle(0.3)  # answered at once
    assert tuner.words == ("Stopped: no table was found.",) and tuner.result is kept
    for scenario, words in (("refused", "imu.file"), ("fault", "Something went wrong")):
        begin(scenario)
        assert tuner.wait_idle(5.0)
        assert words in tuner.words[0] and tuner.fraction is None
        assert tuner.result is kept
    tuner.stop()


# ---------------------------------------------------------------- a search that is halted


COMPASS = {"id": "compass"}
SHIP = Scenario.parse(
    {
        "run": {"duration_h": 2.0},
        "imu": {"gyro_arw_dpsh": 0.003, "accel_vrw_ugpshz": 20.0},
        "reference": {"kind": "log", "noise_mps": 0.1, "drift_mps": 0.05},
        "method": [{"name": "compass", "damping": "external", "network": COMPASS}],
        "requirement": [{"quantity": "tilt_max_arcsec", "at_most": 30.0, "from_h": 0.5}],
    }
)


@pytest.mark.parametrize(
    ("kind", "task", "found"),
    [
        (
            lambda tell: Asker(tell, TuneQuestion),
            TuneQuestion(scenario=SHIP, objective="tilt_rms", vary=("method.0.network.xi",)),
            lambda one: one.best,
        ),
        (
            lambda tell: Asker(tell, ParetoQuestion),
            ParetoQuestion(scenario=SHIP),
            lambda one: one.fronts["compass"],
        ),
        (lambda tell: Asker(tell, DesignQuestion), DesignQuestion(scenario=SHIP), lambda one: one.methods),
    ],
)
def test_what_a_halted_search_has_found_is_kept_and_marked(kind: Any, task: Any, found: Any) -> None:
    halted: list[float] = []

    def tell() -> None:
        if search.fraction and not halted:
            halted.append(search.fraction)
            search.halt()

    search = kind(tell)
    search._worker._load = lambda _: Load(Lane.SPARE)
    search.report_after_s = search.report_every_s = 0.0
    search.begin(task)
    assert search.wait_idle(60.0)
    assert 0.0 < halted[0] < 0.9
    assert search.result is not None and search.result.stopped and found(search.result)
    assert search.words == () and search.fraction is None and search.asked is task
    search.stop()


def test_a_search_that_is_halted_twice_or_before_its_turn_leaves_nothing() -> None:
    begun, go_on = threading.Event(), threading.Event()

    def compute(asked: Any, progress: Any, cancelled: Any) -> Any:
        begun.set()
        go_on.wait(10.0)
        return SimpleNamespace(fronts={"compass": ()}, stopped=True)

    fronts = Asker(lambda: None, ParetoQuestion)
    fronts._compute = compute
    fronts._worker._load = lambda _: Load(Lane.SPARE)
    task = ParetoQuestion(scenario=SHIP)
    fronts.begin(task)
    assert begun.wait(5.0)
    fronts.halt()
    assert fronts.words == ("Stopping: what was found so far is kept.",) and fronts.under_way is task
    fronts.halt()
    assert fronts.words == ("Stopped: no fronts were found.",) and fronts.under_way is None
    fronts.begin(task)  # waits for the one that does not end
    fronts.begin(task)
    go_on.set()
    assert fronts.wait_idle(5.0) and fronts.result is not None
    fronts.forget()
    fronts._worker._still_s = 60.0
    fronts.begin(task)
    fronts.halt()
    assert fronts.words == ("Stopped: no fronts were found.",) and fronts.result is None
    fronts.stop()


def test_what_is_asked_again_while_its_stopped_work_ends_is_answered() -> None:
    """Verify, Stop, Verify at once: the end of the first counted as that of the second, which was dropped."""
    begun, go_on, asked = threading.Event(), threading.Event(), []

    def compute(question: Any, progress: Any, cancelled: Any) -> Any:
        asked.append(question)
        if len(asked) == 1:
            begun.set()
            go_on.wait(10.0)
        return SimpleNamespace(complete=len(asked) > 1, number=len(asked))

    search = Asker(lambda: None, BudgetQuestion)
    search._compute = compute
    search._worker._load = lambda _: Load(Lane.SPARE)
    question = BudgetQuestion(scenario=SHIP)
    search.begin(question)
    assert begun.wait(5.0)
    search.cancel()
    search.begin(question)
    go_on.set()
    assert search.wait_idle(10.0)
    assert len(asked) == 2 and search.result is not None and search.result.number == 2
    assert search.fraction is None and search.words == ()
    search.stop()
