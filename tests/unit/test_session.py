"""One visitor's work: runs, refusals, undo, several pages, one that presents; and many visitors."""

import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from navcore.engine import simulation
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.kernel_wait import KernelAwaited
from navcore.questions.verify import VerifyQuestion
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from schuler_bench.editing import edits
from schuler_bench.session import sessions
from schuler_bench.session.history import first_editable
from schuler_bench.session.session import Session, runs_on_demand
from schuler_bench.session.sessions import Sessions, first_scenario
from schuler_bench.session.shown import verified_beside

PRESET = load("zha-fast")


class Watcher:
    """A page that only notes what it is told: the method's name, and its first argument."""

    def __init__(self) -> None:
        self.calls: list[tuple[str, Any]] = []

    def __getattr__(self, name: str) -> Callable[..., None]:
        return lambda *given: self.calls.append((name, given[0] if given else None))

    @property
    def names(self) -> list[str]:
        return [name for name, _ in self.calls]


def answer(scenario: Scenario, status: str = "ok") -> Any:
    return SimpleNamespace(scenario=scenario, status=status, methods=(), t_s=(), warnings=())


def simulate(scenario: Scenario, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> Any:
    """Stand-in: 13 h cannot run, 14 h is a fault of ours, 15 h lasts until it is stopped."""
    hours = scenario.run.duration_h
    if hours == 13.0:
        raise InputError(Fault("", "motion.file", None, "is gone"))
    if hours == 14.0:
        raise ZeroDivisionError("ours")
    if hours < 15.0:
        return answer(scenario)
    progress(0.5)
    while not cancelled():
        threading.Event().wait(0.002)
    return answer(scenario, "stopped")


@pytest.fixture
def session(tmp_path: Path) -> Iterator[Session]:
    session = Session("a" * 24, PRESET, "zha-fast", tmp_path / "up", simulate)
    yield session
    session.close()


@pytest.fixture
def page(session: Session) -> Watcher:
    page = Watcher()
    session.attach(page)
    assert session.wait_idle(5.0)
    return page


def change(session: Session, page: Watcher | None, field: str, value: object, **more: Any) -> None:
    """Change a field of the block ``run``, and wait until that has been run."""
    session.change(edits.with_value(session.scenario, ("run", field), value), page, **more)
    assert session.wait_idle(5.0)


# ------------------------------------------------------------ runs


def test_a_change_is_run_and_told_with_who_made_it(session: Session, page: Watcher) -> None:
    assert (page.names, session.run.scenario) == (["run_ended"], PRESET)
    assert (session.run_number, session.outdated) == (1, False)
    change(session, page, "duration_h", 2.0)
    assert page.calls[1:] == [("scenario_changed", page), ("run_ended", None)]
    assert session.run.scenario == session.scenario != PRESET
    assert not session.change(session.scenario, page) and session.run_number == 2


def test_a_scenario_that_cannot_run_gives_way_to_the_last_good_one(session: Session, page: Watcher) -> None:
    change(session, page, "seed", 7)
    good, page.calls = session.state, []
    change(session, page, "duration_h", 13.0)
    assert page.names == ["scenario_changed", "scenario_changed", "run_refused"]
    assert "is gone" in str(page.calls[-1][1])
    assert (session.state, session.run.scenario, session.outdated) == (good, good.scenario, False)
    assert (session.history.undo_name, session.history.redo_name) == ("run.seed: 1 → 7", None)


def test_a_fault_of_ours_is_told_and_the_last_good_run_stays(session: Session, page: Watcher) -> None:
    change(session, page, "duration_h", 14.0)
    ((name, error),) = page.calls[-1:]
    assert (name, type(error)) == ("run_failed", ZeroDivisionError)
    assert session.run.scenario == PRESET and session.outdated


def test_a_long_run_is_stopped_by_the_user(session: Session, page: Watcher) -> None:
    session.change(edits.with_value(PRESET, ("run", "duration_h"), 15.0), page)
    while "run_progressed" not in page.names and session._worker._watch is None:
        threading.Event().wait(0.002)
    session.cancel_run()
    assert session.wait_idle(5.0)
    assert page.names[-1] in ("run_stopped", "scenario_changed")  # not even begun: nothing to tell
    assert session.run.scenario == PRESET and session.outdated


def test_a_long_run_gives_way_to_a_new_change(
    session: Session, page: Watcher, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("schuler_bench.jobs.worker.SUPERSEDE_AFTER_S", 0.0)
    session.change(edits.with_value(PRESET, ("run", "duration_h"), 15.0), page)
    change(session, page, "duration_h", 2.0)
    assert page.names[-1] == "run_ended" and "run_stopped" not in page.names
    assert session.run.scenario.run.duration_h == 2.0


def strapdown(duration_h: float) -> Scenario:
    return Scenario.parse({"run": {"fidelity": "strapdown", "duration_h": duration_h, "rate_hz": 200.0}})


def test_only_a_long_strapdown_run_waits_for_the_user(session: Session, page: Watcher) -> None:
    two_methods = edits.with_method(strapdown(2.0), 0)[0]
    asked = [PRESET, strapdown(1.0), strapdown(6.0), two_methods]
    assert list(map(runs_on_demand, asked)) == [False, False, True, True]
    session.change(strapdown(6.0), page, origin="opened")  # opened: run at once
    assert session.wait_idle(5.0)
    assert (session.run.scenario, page.names[-1]) == (strapdown(6.0), "run_ended")
    change(session, page, "duration_h", 7.0)
    assert (session.run.scenario, page.names[-1]) == (strapdown(6.0), "run_waits")
    assert session.outdated and session.waits
    session.redo_run()
    assert session.wait_idle(5.0)
    assert (session.run.scenario, session.outdated, session.waits) == (strapdown(7.0), False, False)


def test_another_scenario_drops_the_verification(
    session: Session, page: Watcher, monkeypatch: pytest.MonkeyPatch
) -> None:
    verifier = session.verifier
    monkeypatch.setattr(verifier, "result", answer(PRESET))
    monkeypatch.setattr(verifier, "asked", VerifyQuestion(scenario=PRESET))
    assert verified_beside(verifier, PRESET) is not None
    change(session, page, "duration_h", 2.0)
    assert verified_beside(verifier, session.scenario).old
    change(session, page, "duration_h", 2.5, origin="another")
    assert verified_beside(verifier, session.scenario) is None


# ------------------------------------------------------------ undo


def test_undo_and_redo_bring_scenario_origin_and_method_back_and_run(session: Session, page: Watcher) -> None:
    first, other = session.state, load("sun-step")
    change(session, page, "duration_h", 6.0)
    longer = session.state
    session.change(other, None, origin="sun-step", selected=0)
    assert session.opened == other
    assert session.undo() and session.state == longer
    assert session.undo() and session.state == first
    assert session.opened == PRESET
    assert session.wait_idle(5.0) and session.run.scenario == PRESET
    assert not session.undo()
    assert session.redo() and session.redo() and (session.scenario, session.origin) == (other, "sun-step")
    assert not session.redo()


def test_reset_is_back_to_what_was_opened_and_can_be_undone(session: Session, page: Watcher) -> None:
    assert not session.reset(None)
    for field, value in (("seed", 7), ("duration_h", 6.0)):
        change(session, page, field, value)
    edited = session.scenario
    assert session.reset(None) and session.scenario == PRESET
    assert session.history.undo_name == "reset to zha-fast"
    assert session.undo() and session.scenario == edited


def test_opening_the_same_preset_again_is_a_step_of_its_own(session: Session) -> None:
    longer = edits.with_value(PRESET, ("run", "duration_h"), 7.0)
    session.change(longer, None)
    session.change(PRESET, None, origin="zha-fast")
    assert session.history.undo_name == "open zha-fast"
    session.change(longer, None)  # at once, on the same field
    assert session.undo() and session.scenario == PRESET


def test_what_is_to_outlive_the_server_is_told(session: Session) -> None:
    changes: list[None] = []
    session.on_change = lambda: changes.append(None)
    actions: tuple[Callable[[], Any], ...] = (
        lambda: session.change(edits.with_value(PRESET, ("run", "seed"), 7), None),
        session.undo,
        session.redo,
        lambda: session.select(1, None),
        lambda: session.show(None, scale="log"),
        lambda: session.pins.add(simulation.simulate(load("zha-fast", ["run.duration_h=0.1"])), "zha-fast"),
    )
    for act in actions:
        changes.clear()
        act()
        assert changes


# ------------------------------------------------------------ pages


def test_a_page_whose_drawing_fails_does_not_hold_up_the_other(session: Session, page: Watcher) -> None:
    def broken() -> None:
        raise RuntimeError("no picture")

    other = Watcher()
    other.run_ended = broken  # pyright: ignore[reportAttributeAccessIssue]
    session.pages.all.insert(0, other)
    change(session, page, "duration_h", 2.0)
    assert other.names == ["scenario_changed", "run_failed"] and page.names[-1] == "run_ended"


def test_two_pages_of_one_visitor_show_the_same(session: Session, page: Watcher) -> None:
    other = Watcher()
    session.attach(other)
    change(session, page, "duration_h", 2.0)
    assert other.calls == [("scenario_changed", page), ("run_ended", None)]
    session.detach(page)
    assert session.open_pages == 1


def test_selection_stays_within_the_methods(session: Session, page: Watcher) -> None:
    more, at = edits.with_method(PRESET, None)
    session.change(more, page, selected=at)
    assert session.selected == at
    session.change(edits.without_method(more, 1), page)
    assert session.selected == at - 1


def test_a_change_of_the_display_is_told_once_and_runs_nothing(session: Session, page: Watcher) -> None:
    for _ in range(2):
        session.show(page, scale="log")
    assert session.wait_idle(5.0)
    assert (page.names, session.display.scale) == (["run_ended", "display_changed"], "log")


def test_one_page_presents_at_a_time_and_its_leaving_frees_the_others(session: Session) -> None:
    one, two, late = (Watcher() for _ in range(3))
    for page in (one, two):
        session.attach(page)
    assert session.present(one) and not session.present(two)
    assert session.pages.presenter is one and "presenter_changed" in two.names
    assert session.present(None) and session.pages.presenter is None
    assert session.present(two) and session.display.large == "view"
    one.calls.clear()
    session.detach(two)
    assert (session.pages.presenter, session.display.large) == (None, "plots")
    assert one.names == ["presenter_changed", "display_changed"]
    session.present(one)
    session.attach(late)
    assert late.names == ["presenter_changed"]


def test_watchers_are_told_the_tabs_of_the_page_that_presents(session: Session) -> None:
    one, two = Watcher(), Watcher()
    for page in (one, two):
        session.attach(page)
    session.pages.tell_front(one, {"Poles"})
    assert "front_changed" not in two.names  # nobody presents: each looks where it likes
    session.present(one)
    session.pages.tell_front(two, {"Step"})
    session.pages.tell_front(one, {"Poles"})
    assert [page.names.count("front_changed") for page in (one, two)] == [0, 1]


# ------------------------------------------------------------ many visitors


@pytest.fixture
def visitors() -> Iterator[Sessions]:
    visitors = Sessions(lambda: (PRESET, "preset"))
    yield visitors
    visitors.close()


def test_a_session_is_kept_over_a_reload(visitors: Sessions) -> None:
    first = visitors.get("one-visitor")
    first.change(strapdown(1.0), None)
    assert visitors.get("one-visitor") is first and visitors.get("another-one").scenario == PRESET


def test_only_a_bounded_number_of_sessions_without_a_page_is_kept(
    visitors: Sessions, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sessions, "MOST_SESSIONS", 3)
    watched = visitors.get("watched")
    watched.pages.all.append(Watcher())
    for number in range(10):
        visitors.get(f"visitor-{number}")
    assert len(visitors) == 5  # three idle ones, the present one, and the one with an open page
    assert visitors.get("watched") is watched


def test_runs_of_visitors_who_have_left_are_dropped(
    visitors: Sessions, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sessions, "MOST_IDLE_RUNS", 2)
    every = [visitors.get(f"visitor-{number}") for number in range(6)]
    for session in every:
        session.run = answer(PRESET)
    every[0].pages.all.append(Watcher())
    visitors.forget_idle()
    assert [session.run is not None for session in every] == [True, False, False, False, True, True]


def test_large_runs_of_visitors_who_have_left_are_dropped_before_their_number(
    visitors: Sessions, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sessions, "MOST_IDLE_BYTES", 100_000)
    monkeypatch.setattr(sessions, "bytes_of", lambda run: 40_000)
    every = [visitors.get(f"visitor-{number}") for number in range(5)]
    for session in every:
        session.run = answer(PRESET)
    every[0].pages.all.append(Watcher())
    visitors.forget_idle()
    assert [session.run is not None for session in every] == [True, False, False, True, True]


def test_uploads_go_with_their_session(visitors: Sessions, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sessions, "MOST_SESSIONS", 1)
    uploads = visitors.get("old").uploads.folder
    uploads.mkdir(parents=True)
    (uploads / "log.txt").write_text("x")
    for number in range(3):
        visitors.get(f"visitor-{number}")
    assert not uploads.exists()
    visitors.close()
    assert not uploads.parent.exists()


def test_a_new_visitor_sees_a_preset_with_something_to_tune() -> None:
    scenario, name = first_scenario()
    method = scenario.method[first_editable(scenario)]
    assert name and method.damping != "free" and len(type(method.network).model_fields) > 1


def test_the_first_picture_of_a_new_visitor_is_computed_before_they_come() -> None:
    scenario = load("liu-overshoot", ["run.duration_h=1"])
    visitors = Sessions(lambda: (scenario, "preset"))
    visitors.prepared = prepared = simulation.simulate(scenario)
    session, page = visitors.get("new"), Watcher()
    session.attach(page)
    assert session.wait_idle(10.0) and session.run is not None
    assert [a is b for a, b in zip(session.run.methods, prepared.methods, strict=True)] == [True] * 5
    change(session, page, "duration_h", 0.5)
    assert session.run.scenario == session.scenario and session.run.t_s[-1] == 1800.0
    visitors.close()


def test_a_run_whose_kernels_are_being_compiled_says_so_and_is_shown_once_they_are_there(
    tmp_path: Path,
) -> None:
    tried: list[Scenario] = []

    def awaiting(scenario: Scenario, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> Any:
        tried.append(scenario)
        if len(tried) < 3:
            raise KernelAwaited("advance")
        return answer(scenario)

    session, page = Session("waits", PRESET, "", tmp_path, awaiting), Watcher()
    session.attach(page)
    assert session.wait_idle(10.0)
    told = [name for name in page.names if name.startswith("run_")]
    assert told == ["run_awaits_kernels", "run_awaits_kernels", "run_ended"]
    session.close()
