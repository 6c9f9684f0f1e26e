"""Undo and redo: steps, their names, and drags that are one step."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.editing import edits
from app.session.history import MOST_STEPS, History, State, change_name
from navcore.scenario.file import load
from navcore.scenario.model import Scenario

FIRST = State(load("zha-fast"), "zha-fast", 0, load("zha-fast"))


def changed(state: State, *overrides: str) -> State:
    return State(load(state.origin, list(overrides)), state.origin, state.selected, state.opened)


class Clock:
    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


def test_undo_and_redo_walk_over_the_states():
    history = History(FIRST, Clock())
    longer, renamed = changed(FIRST, "run.duration_h=8"), changed(FIRST, "title=x")
    assert (history.undo(), history.redo(), history.undo_name, history.redo_name) == (None,) * 4
    history.push(longer)
    history.push(renamed)
    assert history.undo() == longer
    assert history.undo() == FIRST
    assert history.undo() is None
    assert history.redo_name == "run.duration_h: 4 → 8"
    assert history.redo() == longer
    history.push(FIRST)
    assert history.redo() is None
    assert history.undo() == longer


def test_states_share_what_they_have_in_common():
    history = History(FIRST, Clock())
    for name in ("first", "second"):
        edited = edits.with_value(history.state.scenario, ("method", 1, "name"), name)
        assert edited.method[0] is not history.state.scenario.method[0]
        before = history.state.scenario
        history.push(replace(FIRST, scenario=edited))
    kept = history.state.scenario
    assert kept == edited
    assert kept.model_fields_set == edited.model_fields_set
    assert kept.motion is before.motion
    assert kept.method[0] is before.method[0]
    assert kept.method[1] is not before.method[1]
    fewer = edits.without_method(kept, 0)
    history.push(replace(FIRST, scenario=fewer))
    assert history.state.scenario == fewer
    history.push(replace(FIRST, scenario=kept))
    assert history.state.scenario == kept


def test_a_drag_is_one_step():
    clock = Clock()
    history = History(FIRST, clock)
    for hours in (5, 6, 7):
        history.push(changed(FIRST, f"run.duration_h={hours}"))
        clock.now += 0.3
    assert history.undo_name == "run.duration_h: 4 → 7"
    clock.now += 2.0
    history.push(changed(FIRST, "run.duration_h=9"))
    assert history.undo_name == "run.duration_h: 7 → 9"
    assert history.undo() == changed(FIRST, "run.duration_h=7")
    assert history.undo() == FIRST
    assert history.undo() is None


def test_a_drag_that_ends_where_it_began_is_no_step():
    clock = Clock()
    history = History(FIRST, clock)
    longer = changed(FIRST, "run.duration_h=9")
    history.push(longer)
    clock.now += 2.0
    for seed in (8, 7):
        history.push(changed(FIRST, "run.duration_h=9", f"run.seed={seed}"))
        clock.now += 0.3
    history.push(longer)
    assert (history.undo_name, history.redo_name) == ("run.duration_h: 4 → 9", None)
    assert history.undo() == FIRST
    assert history.redo() == longer


def test_selecting_another_method_is_no_step():
    history = History(FIRST, Clock())
    history.push(State(FIRST.scenario, FIRST.origin, 2, FIRST.opened))
    assert history.undo_name is None
    assert history.state.selected == 2


def test_changes_are_named():
    assert change_name(FIRST, State(load("sun-step"), "sun-step", 0, load("sun-step"))) == "open sun-step"
    without = Scenario.parse(FIRST.scenario.canonical() | {"method": [{"name": "free"}]})
    assert change_name(FIRST, State(without, "zha-fast", 0, FIRST.opened)) == "remove a method"
    sets = ["imu.gyro_arw_dpsh=0.1", "imu.accel_vrw_ugpshz=3"]
    assert change_name(FIRST, changed(FIRST, *sets)) == "change of imu"
    assert change_name(FIRST, changed(FIRST, *sets, "run.seed=4")) == "change of 3 fields"


def test_a_field_of_a_method_is_named_by_the_method():
    state = changed(FIRST, "method.2.network.xi=0.5")
    assert change_name(FIRST, state) == "ζ of fast (compass): 0.7 → 0.5"


def test_a_name_given_is_a_step_of_its_own():
    history = History(FIRST, Clock())
    history.push(changed(FIRST, "run.duration_h=8"))
    history.push(changed(FIRST, "run.duration_h=4"), "reset duration")
    assert history.undo_name == "reset duration"
    assert history.undo() == changed(FIRST, "run.duration_h=8")


def test_a_refused_change_takes_its_step_back():
    clock = Clock()
    history, good = History(FIRST, clock), changed(FIRST, "run.duration_h=8")
    history.push(good)
    clock.now += 5.0
    history.push(changed(FIRST, "run.duration_h=9"))
    clock.now += 5.0
    history.push(changed(FIRST, "run.seed=7"))
    history.take_back(good)  # neither was ever run
    assert (history.state, history.redo_name) == (good, None)
    assert history.undo() == FIRST


def test_a_drag_that_ends_refused_ends_at_its_last_good_value():
    history, good = History(FIRST, Clock()), changed(FIRST, "run.duration_h=6")
    history.push(changed(FIRST, "run.duration_h=5"))
    history.push(good)
    history.push(changed(FIRST, "run.duration_h=700"))
    history.take_back(good)
    assert (history.state, history.undo_name) == (good, "run.duration_h: 4 → 6")
    assert history.undo() == FIRST


def test_undo_into_a_state_that_cannot_run_any_more_is_taken_back():
    clock = Clock()
    history = History(FIRST, clock)
    steps = [changed(FIRST, f"run.duration_h={hours}") for hours in (5, 6)]
    for state in steps:
        clock.now += 5.0
        history.push(state)
    assert history.undo() == steps[0]
    history.take_back(steps[1])
    assert history.state == steps[1]
    assert history.undo() == FIRST


def test_a_history_is_rebuilt_from_its_steps():
    history = History(FIRST, Clock())
    history.push(changed(FIRST, "run.duration_h=8"))
    history.undo()
    again = History.of(history.steps, history.at)
    assert (again.steps, again.redo_name) == (history.steps, "run.duration_h: 4 → 8")
    with pytest.raises(ValueError, match="no step"):
        History.of(history.steps, 2)


def test_only_so_many_steps_are_kept():
    clock = Clock()
    history = History(FIRST, clock)
    for seed in range(2, MOST_STEPS + 12):
        clock.now += 5.0
        history.push(changed(FIRST, f"run.seed={seed}"))
    steps = 0
    while history.undo():
        steps += 1
    assert steps == MOST_STEPS


def test_a_gesture_is_one_step_however_long_it_takes():
    clock = Clock()
    history = History(FIRST, clock)
    for hours, pause in ((5, 30.0), (6, 0.1), (7, 5.0)):
        history.push(changed(FIRST, f"run.duration_h={hours}"), "placing", "pair 1")
        clock.now += pause
    assert (history.undo_name, history.at) == ("placing", 1)
    history.push(changed(FIRST, "run.duration_h=8"), "placing", "pair 2")
    assert history.at == 2
    assert history.undo() == changed(FIRST, "run.duration_h=7")
    assert history.undo() == FIRST


def test_a_drag_over_its_beginning_can_be_undone():
    for named in (("", ""), ("placing", "pair 1")):
        history = History(FIRST, Clock())
        history.push(changed(FIRST, "title=first"))
        before = history.state
        for hours in ("6", "4", "7"):
            history.push(changed(before, "title=first", f"run.duration_h={hours}"), *named)
        assert history.at == 2
        assert history.undo() == before
        assert history.undo() == FIRST
