"""A session's undo, redo and reset, and one page that drives while the others watch."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from app.editing import edits, form
from app.editing.form import FieldSpec
from app.session.session import Session
from app.shell.reset import opened_value
from navcore.networks import NETWORKS
from navcore.scenario.file import load
from navcore.scenario.model import Method, Scenario
from tests.watchers import Watcher, simulate

HOURS = ("run", "duration_h")
SEED = ("run", "seed")


@pytest.fixture
def made(tmp_path: Path) -> Iterator[Session]:
    session = Session("a" * 24, load("zha-fast"), "zha-fast", tmp_path / "up", simulate)
    session.attach(Watcher())
    assert session.wait_idle(5.0)
    yield session
    session.close()


def put(session: Session, path: Any, value: Any) -> None:
    session.change(edits.with_value(session.scenario, path, value), None)
    assert session.wait_idle(5.0)


def test_undo_and_redo_bring_scenario_origin_and_method_back_and_run(made: Session) -> None:
    first = made.state
    put(made, HOURS, 6.0)
    longer = made.state
    other = load("sun-step")
    made.change(other, None, origin="sun-step", selected=0)
    assert made.opened == other
    assert made.undo() and made.state == longer
    assert made.undo() and made.state == first
    assert made.opened == load("zha-fast")
    assert made.wait_idle(5.0) and made.run.scenario == first.scenario
    assert not made.undo()
    assert made.redo() and made.redo() and (made.scenario, made.origin) == (other, "sun-step")
    assert not made.redo()


def test_a_refused_run_takes_its_step_back(made: Session) -> None:
    put(made, SEED, 7)
    good = made.state
    put(made, HOURS, 13.0)
    assert made.state == good
    assert (made.history.undo_name, made.history.redo_name) == ("run.seed: 1 → 7", None)
    assert made.undo() and made.scenario == load("zha-fast")


def test_reset_is_back_to_what_was_opened_and_can_be_undone(made: Session) -> None:
    assert not made.reset(None)
    put(made, SEED, 7)
    put(made, HOURS, 6.0)
    edited = made.scenario
    assert made.reset(None) and made.scenario == load("zha-fast")
    assert made.history.undo_name == "reset to zha-fast"
    assert made.undo() and made.scenario == edited


def test_what_is_to_outlive_the_server_is_told(made: Session) -> None:
    told: list[int] = []
    made.on_change = lambda: told.append(1)
    actions: tuple[Callable[[], Any], ...] = (
        lambda: made.change(edits.with_value(made.scenario, SEED, 7), None),
        made.undo,
        made.redo,
        lambda: made.select(1, None),
        lambda: made.show(None, scale="log"),
        lambda: made.pins.add(load_run(), "zha-fast"),
    )
    for number, act in enumerate(actions, start=1):
        act()
        assert len(told) >= number
        told[number:] = []


def load_run() -> Any:
    from navcore.engine.simulation import simulate as run

    return run(load("zha-fast", ["run.duration_h=0.1"]))


# ------------------------------------------------------------ one field


def spec_of(scenario: Scenario, *path: Any) -> FieldSpec:
    if path[0] == "method" and path[2] == "network":
        specs = form.fields(type(scenario.method[path[1]].network), path[:3])
    elif path[0] == "method":
        specs = form.fields(Method, path[:2])
    else:
        specs = form.fields(type(getattr(scenario, path[0])), path[:1])
    return next(spec for spec in specs if spec.path == path)


def test_a_field_goes_back_to_what_was_opened() -> None:
    opened = load("zha-fast")
    now = edits.with_value(opened, ("method", 2, "network", "xi"), 0.4)
    assert opened_value(opened, now, spec_of(now, "method", 2, "network", "xi")) == 0.7
    assert opened_value(opened, now, spec_of(now, "run", "duration_h")) == 4.0
    assert opened_value(opened, now, spec_of(now, "method", 2, "damping")) == "external"
    # a value that follows from others goes back to what followed then
    k1 = opened_value(opened, now, spec_of(now, "method", 2, "network", "k1"))
    assert k1 == pytest.approx(3 * 0.0088)


def test_where_nothing_like_it_was_opened_a_field_goes_back_to_its_default() -> None:
    opened = load("zha-fast")
    other = edits.with_choice(opened, ("method", 2, "network", "id"), "pole2")
    spec = next(iter(form.fields(NETWORKS["pole2"], ("method", 2, "network"))))
    assert opened_value(opened, other, spec) == spec.default
    more, at = edits.with_method(opened, None)
    assert opened_value(opened, more, spec_of(more, "method", at, "damping")) == Method().damping


# ------------------------------------------------------------ presenter


def test_one_page_presents_at_a_time_and_its_leaving_frees_the_others(made: Session) -> None:
    one, two = Watcher(), Watcher()
    for page in (one, two):
        made.attach(page)
    assert made.present(one)
    assert not made.present(two)
    assert made.presenter is one
    assert "presenter_changed" in two.names()
    assert made.present(None) and made.presenter is None
    assert made.present(two)
    one.told.clear()
    made.detach(two)
    assert made.presenter is None
    assert one.names() == ["presenter_changed"]
    late = Watcher()
    made.present(one)
    made.attach(late)
    assert late.names() == ["presenter_changed"]


def test_watchers_are_told_the_tabs_of_the_page_that_presents(made: Session) -> None:
    one, two = Watcher(), Watcher()
    for page in (one, two):
        made.attach(page)
    made.tell_front(one, {"Poles"})
    assert "front_changed" not in two.names()  # nobody presents: each looks where it likes
    made.present(one)
    made.tell_front(two, {"Step"})
    made.tell_front(one, {"Poles"})
    assert (one.names().count("front_changed"), two.names().count("front_changed")) == (0, 1)


def test_opening_the_same_preset_again_is_a_step_of_its_own(made: Session) -> None:
    opened = made.scenario
    made.change(edits.with_value(opened, ("run", "duration_h"), 7.0), None)
    made.change(opened, None, origin=made.origin)
    assert made.history.undo_name == f"open {made.origin}"
    made.change(edits.with_value(opened, ("run", "duration_h"), 7.0), None)  # at once, on the same field
    assert made.undo()
    assert made.scenario == opened
