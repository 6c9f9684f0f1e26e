"""A visitor whose last page has gone: the work goes on for a while, behind all others; its answer is kept."""

import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from navcore.foundation.errors import InputError
from schuler_bench.jobs.away import AWAY_S, away_seconds
from schuler_bench.jobs.scheduler import Lane, Load, Scheduler, Ticket, scheduler
from schuler_bench.jobs.search import GIVEN_UP, Search
from schuler_bench.session import sessions
from schuler_bench.session.session import Session
from schuler_bench.session.sessions import Sessions
from tests.unit.test_session import PRESET, Watcher, simulate
from tests.waiting import until


class Jobs:
    """Jobs that count their steps, and look at each whether they may go on, until they are let end."""

    def __init__(self, cores: int = 1, memory: float = 100.0, away_s: float = 60.0) -> None:
        self.turns = Scheduler(cores, memory, away_s=away_s)
        self.steps: dict[str, int] = {}
        self.ended: dict[str, str] = {}
        self._let_end: dict[str, threading.Event] = {}

    def put(self, name: str, visitor: str, lane: Lane = Lane.SPARE, bytes: float = 0.0) -> Ticket:
        self._let_end[name] = threading.Event()

        def call() -> None:
            self.steps[name] = 0
            while not self._let_end[name].wait(0.002):
                self.turns.give_way(ticket, self._let_end[name].is_set)
                if self.turns.given_up(ticket):
                    self.ended[name] = "given up"
                    return
                self.steps[name] += 1
            self.ended[name] = "done"

        ticket = Ticket(visitor, call, Load(lane, bytes))
        self.turns.put(ticket)
        return ticket

    def end(self, *names: str) -> None:
        for name in names:
            self._let_end[name].set()
        until(lambda: all(name in self.ended for name in names))

    def goes_on(self, name: str) -> None:
        until(lambda: name in self.steps)
        before = self.steps[name]
        until(lambda: self.steps[name] > before + 2)

    def stands_still(self, name: str) -> None:
        """After its turn of 0.2 s it counts no more steps, although others have."""
        before = -1
        while before != (before := self.steps[name]):
            threading.Event().wait(0.1)


def stop(jobs: Jobs, names: str) -> None:
    jobs.end(*names)
    until(lambda: not any(jobs.turns.figures().values()))


@pytest.mark.parametrize("lane", [Lane.SPARE, Lane.LONG])
def test_work_of_who_is_away_takes_no_thread_from_those_who_are_there(lane: Lane) -> None:
    """One core has one thread for spare work, which it would hold for minutes."""
    jobs = Jobs()
    jobs.put("a", "gone", lane)
    jobs.goes_on("a")
    jobs.put("b", "here", lane)
    jobs.turns.leave("gone")
    jobs.goes_on("b")
    jobs.stands_still("a")
    jobs.goes_on("b")
    jobs.end("b")
    jobs.goes_on("a")
    stop(jobs, "a")
    # the thread that was there beside it is gone again: one at a time, in the order in which they came
    for name in "cd":
        jobs.put(name, name, lane)
    jobs.goes_on("c")
    assert "d" not in jobs.steps
    stop(jobs, "cd")


def test_it_has_no_turns_under_lasting_load_and_goes_on_when_its_visitor_is_back() -> None:
    jobs = Jobs()
    jobs.put("a", "gone")
    jobs.goes_on("a")
    jobs.turns.leave("gone")
    jobs.put("b", "here", Lane.LONG)
    jobs.goes_on("b")
    jobs.stands_still("a")
    threading.Event().wait(2.2)  # beyond the patience of spare work whose visitor is there
    jobs.stands_still("a")
    jobs.turns.come_back("gone")
    jobs.goes_on("a")
    stop(jobs, "ab")


def test_it_begins_only_when_nobody_who_is_there_waits() -> None:
    jobs = Jobs()
    jobs.put("a", "here")
    jobs.goes_on("a")
    jobs.turns.leave("gone")
    jobs.put("b", "gone")
    jobs.put("c", "another")
    jobs.end("a")
    jobs.goes_on("c")
    assert "b" not in jobs.steps
    jobs.end("c")
    jobs.goes_on("b")
    stop(jobs, "b")


def test_after_a_stated_time_it_is_given_up_and_what_waits_is_not_begun() -> None:
    jobs = Jobs(away_s=0.05)
    jobs.put("a", "gone")
    jobs.put("b", "gone")
    jobs.goes_on("a")
    jobs.turns.leave("gone")
    until(lambda: jobs.ended == {"a": "given up"})
    jobs.put("c", "here")
    jobs.goes_on("c")
    jobs.end("c")
    assert "b" not in jobs.steps
    jobs.turns.come_back("gone")
    jobs.goes_on("b")
    stop(jobs, "b")


def test_its_memory_is_given_to_those_who_are_there() -> None:
    jobs = Jobs(memory=100.0)
    jobs.put("a", "gone", bytes=80.0)
    jobs.goes_on("a")
    jobs.turns.leave("gone")
    jobs.put("b", "here", bytes=60.0)
    jobs.goes_on("b")
    assert jobs.ended == {"a": "given up"}
    stop(jobs, "b")


def test_visitors_who_come_begin_something_and_leave_hold_a_bounded_number_of_jobs() -> None:
    jobs = Jobs()
    for name in "abcd":
        jobs.put(name, name)
        jobs.goes_on(name)
        jobs.turns.leave(name)
    until(lambda: jobs.ended == dict.fromkeys("abc", "given up"))
    jobs.goes_on("d")
    stop(jobs, "d")


@pytest.mark.parametrize(("given", "seconds"), [(None, AWAY_S), ("0", 0.0), ("2.5", 150.0)])
def test_an_operator_sets_the_time(given: str | None, seconds: float) -> None:
    assert away_seconds({} if given is None else {"SCHULER_AWAY_MINUTES": given}) == seconds


@pytest.mark.parametrize("given", ["ten", "-1", "1441", "nan", ""])
def test_another_time_is_refused_by_name(given: str) -> None:
    with pytest.raises(InputError, match=r"SCHULER_AWAY_MINUTES.*0 to 1440"):
        away_seconds({"SCHULER_AWAY_MINUTES": given})


# ------------------------------------------------------------ a session


class Gate:
    """Computes what is asked once it is let; ends when nobody wants it any more."""

    def __init__(self) -> None:
        self.opened = threading.Event()

    def __call__(self, asked: Any, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> Any:
        while not self.opened.wait(0.002):
            if cancelled():
                return None
        return f"answer to {asked}"


def all_searches(session: Session) -> dict[str, Any]:
    """Everything that is computed beside the runs, by its name."""
    owners = (vars(session.searches), vars(session))
    found = {name: one for owner in owners for name, one in owner.items() if isinstance(one, Search)}
    return found | session.searches.asking


@pytest.fixture
def session(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Session]:
    # A scheduler of its own: another test's answers would let the searches wait.
    monkeypatch.setattr("schuler_bench.jobs.scheduler._one", [Scheduler(2, 1e12)])
    session = Session("a" * 24, PRESET, "zha-fast", tmp_path / "up", simulate)
    yield session
    session.close()


def test_what_was_asked_for_is_there_when_the_page_is_back(session: Session) -> None:
    """All kinds alike: a break of a second, a reload, a laptop that sleeps."""
    page, back, gate = Watcher(), Watcher(), Gate()
    searches = all_searches(session)
    assert len(searches) > 10 and {"study", "sweeper", "envelopes", "verify", "pareto"} <= {*searches}
    session.attach(page)
    session.searches.watch(page.searches_changed)
    assert session.wait_idle(5.0)
    for search in searches.values():
        search._carry_out, search._complete = carried_out_here(gate), lambda found: True
        search._ended, search._worker._load = search._tell, lambda _: Load(Lane.SPARE)
        search._worker._still_s = 0.0
        search.begin("what was asked")
    session.searches.unwatch(page.searches_changed)
    session.detach(page)
    gate.opened.set()
    for name, search in searches.items():
        assert search.wait_idle(10.0), name
    del searches["envelopes"]  # the page that is back wants none
    session.attach(back)
    session.searches.watch(back.searches_changed)
    for name, search in searches.items():
        assert (search.result, search.words) == ("answer to what was asked", ()), name


def carried_out_here(gate: Gate) -> Callable[..., Any]:
    return lambda asked, progress, watch: gate(asked, progress, watch.unwanted)


def test_a_page_that_is_back_does_not_begin_its_bands_anew(session: Session) -> None:
    gate, begun = Gate(), list[object]()
    bands: Any = session.envelopes
    bands._carry_out = lambda asked, progress, watch: (
        begun.append(asked) or gate(asked, progress, watch.unwanted)
    )
    bands._worker._still_s = 0.0
    for _ in range(2):
        bands.follow(PRESET, "covariance")
        until(lambda: bool(begun))
    gate.opened.set()
    assert bands.wait_idle(5.0) and len(begun) == 1


def test_what_nobody_came_back_for_says_so(session: Session) -> None:
    page, gate = Watcher(), Gate()
    session.attach(page)
    assert session.wait_idle(5.0)
    search: Any = session.searches.asking["study"]
    search._carry_out, search._worker._load = carried_out_here(gate), lambda _: Load(Lane.SPARE)
    search.begin("what was asked")
    until(lambda: search._worker._watch is not None)
    scheduler().away.longest_s = 0.02
    session.detach(page)
    assert search.wait_idle(5.0)
    assert (search.result, search.words, search.under_way) == (None, (GIVEN_UP,), None)
    assert not session.expected


def test_a_verification_is_kept_while_its_page_may_come_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sessions, "MOST_IDLE_RUNS", 0)
    monkeypatch.setattr("schuler_bench.jobs.scheduler._one", [Scheduler(2, 1e12)])
    visitors, page = Sessions(lambda: (PRESET, "zha-fast")), Watcher()
    session: Any = visitors.get("a" * 24)
    session._simulate = simulate
    session.attach(page)
    session.verifier.result = "found"
    session.detach(page)
    visitors.forget_idle()
    assert session.verifier.result == "found"
    scheduler().away.longest_s = 0.0
    until(lambda: not session.expected)
    visitors.forget_idle()
    assert session.verifier.result is None
    visitors.close()


def test_a_long_run_goes_on_and_is_shown_when_the_page_is_back(session: Session) -> None:
    page, back = Watcher(), Watcher()
    session.attach(page)
    assert session.wait_idle(5.0)
    let_end = threading.Event()

    def slow(scenario: Any, progress: Any, cancelled: Any) -> Any:
        while not let_end.wait(0.002):
            if cancelled():
                break
        return simulate(scenario, progress, cancelled)

    session._simulate = slow
    longer = PRESET.model_copy(update={"run": PRESET.run.model_copy(update={"duration_h": 7.0})})
    assert session.change(longer, page)
    until(lambda: session._worker._watch is not None)
    session.detach(page)
    session.attach(back)
    let_end.set()
    assert session.wait_idle(5.0)
    assert session.run is not None and session.run.scenario == longer and not session.outdated
    assert session.run_number == 2, "it was not begun again"


def test_a_run_that_was_given_up_is_done_when_the_page_is_back(session: Session) -> None:
    page, back = Watcher(), Watcher()
    session.attach(page)
    assert session.wait_idle(5.0)
    scheduler().away.longest_s = 0.0
    endless = PRESET.model_copy(update={"run": PRESET.run.model_copy(update={"duration_h": 15.0})})
    session.change(endless, page)
    until(lambda: session._worker._watch is not None)
    session.detach(page)
    assert session.wait_idle(5.0) and session.outdated
    session._simulate = lambda scenario, progress, cancelled: simulate(PRESET, progress, cancelled)
    session.attach(back)
    assert session.wait_idle(5.0) and session.run_number == 2
