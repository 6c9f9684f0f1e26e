"""One visitor's work: runs, refusals, reloads, several pages, many visitors."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.editing import edits
from app.session import sessions
from app.session.session import Session, first_editable, runs_on_demand
from app.session.sessions import Sessions, first_scenario
from navcore.engine import simulation
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from tests.watchers import Watcher, answer, simulate

DURATION = ("run", "duration_h")


@pytest.fixture
def scenario() -> Scenario:
    return Scenario.parse({"reference": {"kind": "log"}, "run": {"duration_h": 1.0}})


@pytest.fixture
def work(scenario: Scenario, tmp_path: Path) -> Iterator[tuple[Session, Watcher]]:
    made, page = Session("a" * 20, scenario, "preset", tmp_path / "up", simulate), Watcher()
    made.attach(page)
    assert made.wait_idle(5.0)
    yield made, page
    made.close()


def test_a_page_gets_its_first_run(work: tuple[Session, Watcher], scenario: Scenario) -> None:
    made, page = work
    assert page.names() == ["run_ended"]
    assert made.run.scenario == scenario
    assert (made.run_number, made.outdated) == (1, False)


def test_a_change_is_run_and_told_with_who_made_it(work: tuple[Session, Watcher]) -> None:
    made, page = work
    changed = edits.with_value(made.scenario, DURATION, 2.0)
    assert made.change(changed, page)
    assert made.wait_idle(5.0)
    assert page.told[1:] == [("scenario_changed", page), ("run_ended", None)]
    assert made.run.scenario == changed
    assert not made.change(changed, page)
    assert made.run_number == 2


def test_a_scenario_that_cannot_run_gives_way_to_the_last_good_one(work: tuple[Session, Watcher]) -> None:
    made, page = work
    good = made.scenario
    made.change(edits.with_value(good, DURATION, 13.0), page)
    assert made.wait_idle(5.0)
    assert page.names() == ["run_ended", "scenario_changed", "scenario_changed", "run_refused"]
    assert "is gone" in str(page.told[-1][1])
    assert made.scenario == good
    assert made.run.scenario == good
    assert not made.outdated


def test_a_fault_of_ours_is_told_and_the_last_good_run_stays(work: tuple[Session, Watcher]) -> None:
    made, page = work
    made.change(edits.with_value(made.scenario, DURATION, 14.0), page)
    assert made.wait_idle(5.0)
    assert page.names()[-1] == "run_failed"
    assert isinstance(page.told[-1][1], ZeroDivisionError)
    assert made.run.scenario.run.duration_h == 1.0
    assert made.outdated


def test_a_long_run_is_stopped_by_the_user(work: tuple[Session, Watcher]) -> None:
    made, page = work
    made.change(edits.with_value(made.scenario, DURATION, 15.0), page)
    while "run_progressed" not in page.names() and made._worker._watch is None:
        threading.Event().wait(0.002)
    made.cancel_run()
    assert made.wait_idle(5.0)
    assert page.names()[-1] in ("run_stopped", "scenario_changed")  # not even begun: nothing to tell
    assert made.run.scenario.run.duration_h == 1.0
    assert made.outdated


def test_a_long_run_gives_way_to_a_new_change(
    work: tuple[Session, Watcher], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.jobs.worker.SUPERSEDE_AFTER_S", 0.0)
    made, page = work
    made.change(edits.with_value(made.scenario, DURATION, 15.0), page)
    made.change(edits.with_value(made.scenario, DURATION, 2.0), page)
    assert made.wait_idle(5.0)
    assert page.names()[-1] == "run_ended"
    assert "run_stopped" not in page.names()
    assert made.run.scenario.run.duration_h == 2.0


def test_a_page_whose_drawing_fails_does_not_hold_up_the_other(work: tuple[Session, Watcher]) -> None:
    made, page = work
    other = Watcher()

    def broken() -> None:
        raise RuntimeError("no picture")

    other.run_ended = broken  # pyright: ignore[reportAttributeAccessIssue]
    made._views.insert(0, other)
    made.change(edits.with_value(made.scenario, DURATION, 2.0), page)
    assert made.wait_idle(5.0)
    assert other.names() == ["scenario_changed", "run_failed"]
    assert page.names()[-1] == "run_ended"


def test_two_pages_of_one_visitor_show_the_same(work: tuple[Session, Watcher]) -> None:
    made, page = work
    other = Watcher()
    made.attach(other)
    made.change(edits.with_value(made.scenario, DURATION, 2.0), page)
    assert made.wait_idle(5.0)
    assert other.told == [("scenario_changed", page), ("run_ended", None)]
    made.detach(page)
    assert made.open_pages == 1


def test_selection_stays_within_the_methods(work: tuple[Session, Watcher]) -> None:
    made, page = work
    two, at = edits.with_method(made.scenario, None)
    made.change(two, page, selected=at)
    assert made.selected == 1
    made.change(edits.without_method(made.scenario, 1), page)
    assert made.selected == 0


# ------------------------------------------------------------ strapdown


def strapdown(duration_h: float) -> Scenario:
    return Scenario.parse({"run": {"fidelity": "strapdown", "duration_h": duration_h, "rate_hz": 200.0}})


def test_only_a_long_strapdown_run_waits_for_the_user(work: tuple[Session, Watcher]) -> None:
    made, page = work
    assert not runs_on_demand(made.scenario) and not runs_on_demand(strapdown(1.0))
    assert runs_on_demand(strapdown(6.0))
    assert runs_on_demand(edits.with_method(strapdown(2.0), 0)[0])
    made.change(strapdown(6.0), page, origin="opened")  # opened: run at once
    assert made.wait_idle(5.0)
    assert (made.run.scenario, page.names()[-1]) == (strapdown(6.0), "run_ended")
    made.change(strapdown(7.0), page)
    assert made.wait_idle(5.0)
    assert (made.run.scenario, page.names()[-1]) == (strapdown(6.0), "run_waits")
    assert made.outdated and made.waits
    made.redo_run()
    assert made.wait_idle(5.0)
    assert (made.run.scenario, made.outdated, made.waits) == (strapdown(7.0), False, False)


def test_another_scenario_drops_the_verification_and_the_last_page_stops_it(
    work: tuple[Session, Watcher], monkeypatch: pytest.MonkeyPatch
) -> None:
    made, page = work
    monkeypatch.setattr(made.verifier, "result", answer(made.scenario))
    monkeypatch.setattr(made.verifier, "asked", made.scenario)
    assert made.verifier.beside(made.scenario) is not None
    made.change(edits.with_value(made.scenario, DURATION, 2.0), page)
    assert made.verifier.beside(made.scenario).old
    made.change(edits.with_value(made.scenario, DURATION, 2.5), page, origin="another")
    assert made.verifier.beside(made.scenario) is None
    made.verifier.fraction = 0.5
    made.detach(page)
    assert made.verifier.fraction is None


# ------------------------------------------------------------ many visitors


def test_a_session_is_kept_over_a_reload(scenario: Scenario) -> None:
    visitors = Sessions(lambda: (scenario, "preset"))
    first = visitors.get("one-visitor")
    first.change(edits.with_value(scenario, DURATION, 2.0), None)
    assert visitors.get("one-visitor") is first
    assert visitors.get("another-one").scenario == scenario
    visitors.close()


def test_only_a_bounded_number_of_sessions_without_a_page_is_kept(
    scenario: Scenario, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sessions, "MOST_SESSIONS", 3)
    monkeypatch.setattr(sessions, "MOST_IDLE_RUNS", 1)
    visitors = Sessions(lambda: (scenario, "preset"))
    watched = visitors.get("watched")
    watched._views.append(Watcher())
    for number in range(10):
        visitors.get(f"visitor-{number}").run = answer(scenario)
    assert len(visitors) == 5  # three idle ones, the present one, and the one with an open page
    assert visitors.get("watched") is watched
    assert sum(s.run is not None for s in visitors._by_id.values()) <= 3
    visitors.close()


def test_runs_of_visitors_who_have_left_are_dropped(
    scenario: Scenario, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sessions, "MOST_IDLE_RUNS", 2)
    visitors = Sessions(lambda: (scenario, "preset"))
    every = [visitors.get(f"visitor-{number}") for number in range(6)]
    for session in every:
        session._views.append(Watcher())
        session.run = answer(scenario)
    for session in every[1:]:
        session._views.clear()
    visitors.forget_idle()
    assert [session.run is not None for session in every] == [True, False, False, False, True, True]
    visitors.close()


def test_uploads_go_with_their_session(scenario: Scenario, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sessions, "MOST_SESSIONS", 1)
    visitors = Sessions(lambda: (scenario, "preset"))
    old = visitors.get("old")
    old.uploads.folder.mkdir(parents=True)
    (old.uploads.folder / "log.txt").write_text("x")
    for number in range(3):
        visitors.get(f"visitor-{number}")
    assert not old.uploads.folder.exists()
    root = visitors._folder
    visitors.close()
    assert not root.exists()


def test_a_new_visitor_sees_a_preset_with_something_to_tune() -> None:
    scenario, name = first_scenario()
    assert name
    method = scenario.method[first_editable(scenario)]
    assert method.damping != "free"
    assert len(type(method.network).model_fields) > 1


def test_a_change_of_the_display_is_told_once_and_runs_nothing(work: tuple[Session, Watcher]) -> None:
    session, page = work
    number = session.run_number
    session.show(page, scale="log")
    session.show(page, scale="log")
    assert page.names().count("display_changed") == 1
    assert session.display.scale == "log"
    session.wait_idle(5.0)
    assert session.run_number == number


def test_every_preset_says_what_it_shows_and_where_it_comes_from() -> None:
    from navcore.scenario.file import load, presets

    for name in presets():
        opened = load(name)
        assert opened.title and opened.source, name


def test_the_first_picture_of_a_new_visitor_is_computed_before_they_come() -> None:
    scenario = load("liu-overshoot", ["run.duration_h=1"])
    visitors = Sessions(lambda: (scenario, "preset"))
    visitors.prepared = prepared = simulation.simulate(scenario)
    session, page = visitors.get("new"), Watcher()
    session.attach(page)
    assert session.wait_idle(10.0) and session.run is not None
    assert [a is b for a, b in zip(session.run.methods, prepared.methods, strict=True)] == [True] * 5
    changed = edits.with_value(scenario, DURATION, 0.5)
    session.change(changed, page)
    assert session.wait_idle(10.0)
    assert session.run.scenario == changed and session.run.t_s[-1] == 1800.0
    visitors.close()
