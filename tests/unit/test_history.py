"""Undo and redo: steps, their names, and drags that are one step."""

from dataclasses import replace
from typing import Any

import pytest

from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from schuler_bench.editing import edits
from schuler_bench.session.history import MOST_STEPS, History, State, change_name

FIRST = State(load("zha-fast"), "zha-fast", 0, load("zha-fast"))
TO_8, TO_X = ("run.duration_h=8", "run.duration_h: 4 → 8"), ("title=x", "change of 2 fields")


def changed(overrides: str) -> State:
    return replace(FIRST, scenario=load("zha-fast", overrides.split()))


def hours(*values: int) -> list[str]:
    return [f"run.duration_h={value}" for value in values]


H4, H5, H6, H7, H8, H9 = hours(4, 5, 6, 7, 8, 9)
PLACING = ("placing", "pair 1")


@pytest.mark.parametrize(
    ("actions", "steps", "at"),
    [
        pytest.param([H8, "title=x"], [TO_8, TO_X], 2, id="each change"),
        pytest.param([H8, "title=x", "undo"], [TO_8, TO_X], 1, id="undo"),
        pytest.param([H8, "title=x", *["undo"] * 3], [TO_8, TO_X], 0, id="undo beyond the first"),
        pytest.param([H8, "undo", *["redo"] * 2], [TO_8], 1, id="redo beyond the last"),
        pytest.param(
            [H8, "title=x", "undo", H4],
            [TO_8, (H4, "run.duration_h: 8 → 4")],
            2,
            id="what was undone is forgotten",
        ),
        pytest.param(
            [H5, 0.3, H6, 0.3, H7, 2.3, H9],
            [(H7, "run.duration_h: 4 → 7"), (H9, "run.duration_h: 7 → 9")],
            2,
            id="a drag is one step",
        ),
        pytest.param(
            [H9, 2.0, f"{H9} run.seed=8", 0.3, f"{H9} run.seed=7", 0.3, H9],
            [(H9, "run.duration_h: 4 → 9")],
            1,
            id="a drag that ends where it began is no step",
        ),
        pytest.param(
            ["run.seed=2", f"run.seed=2 {H6}", "run.seed=2", f"run.seed=2 {H7}"],
            [("run.seed=2", "run.seed: 1 → 2"), (f"run.seed=2 {H7}", "run.duration_h: 4 → 7")],
            2,
            id="a drag over its beginning",
        ),
        pytest.param(
            ["run.seed=2", *[(f"run.seed=2 {h}", *PLACING) for h in (H6, H4, H7)]],
            [("run.seed=2", "run.seed: 1 → 2"), (f"run.seed=2 {H7}", "placing")],
            2,
            id="a gesture over its beginning",
        ),
        pytest.param(
            [(H5, *PLACING), 30.0, (H6, *PLACING), 0.1, (H7, *PLACING), 5.0, (H8, "placing", "pair 2")],
            [(H7, "placing"), (H8, "placing")],
            2,
            id="a gesture is one step however long it takes",
        ),
        pytest.param(
            [H8, (H4, "reset duration")],
            [TO_8, (H4, "reset duration")],
            2,
            id="a name given is a step of its own",
        ),
        pytest.param(
            [H8, 5.0, H9, 5.0, "run.seed=7", ("refused", H8)],
            [TO_8],
            1,
            id="refused, and what was never run with it",
        ),
        pytest.param(
            [H5, H6, "run.duration_h=700", ("refused", H6)],
            [(H6, "run.duration_h: 4 → 6")],
            1,
            id="a drag that ends refused ends at its last good value",
        ),
        pytest.param(
            [H5, 5.0, H6, "undo", ("refused", H6)],
            [(H6, "run.duration_h: 5 → 6")],
            1,
            id="undone into, and refused",
        ),
    ],
)
def test_what_was_done_is_kept_as_steps(actions: list[Any], steps: list[tuple[str, str]], at: int) -> None:
    now = [0.0]
    history = History(FIRST, lambda: now[0])
    for action in actions:
        match action:
            case float():
                now[0] += action
            case "undo" | "redo":
                getattr(history, action)()
            case ("refused", good):
                history.take_back(changed(good))
            case (overrides, *named):
                history.push(changed(overrides), *named)
            case _:
                history.push(changed(action))
    assert history.steps == [(FIRST, ""), *((changed(overrides), name) for overrides, name in steps)]
    assert (history.at, history.state) == (at, history.steps[at][0])
    names = [None, *(name for _, name in steps), None]
    assert (history.undo_name, history.redo_name) == (names[at], names[at + 1])
    assert history.undo() == (history.steps[at - 1][0] if at else None)


def test_states_share_what_they_have_in_common() -> None:
    history = History(FIRST)
    for name in ("first", "second"):
        before = history.state.scenario
        edited = edits.with_value(before, ("method", 1, "name"), name)
        assert edited.method[0] is not before.method[0]
        history.push(replace(FIRST, scenario=edited))
    kept = history.state.scenario
    assert (kept, kept.model_fields_set) == (edited, edited.model_fields_set)
    assert kept.motion is before.motion and kept.method[0] is before.method[0]
    assert kept.method[1] is not before.method[1]
    for scenario in (edits.without_method(kept, 0), kept):
        history.push(replace(FIRST, scenario=scenario))
        assert history.state.scenario == scenario


def test_selecting_another_method_is_no_step() -> None:
    history = History(FIRST)
    history.push(replace(FIRST, selected=2))
    assert (history.undo_name, history.state.selected) == (None, 2)


IMU = "imu.gyro_arw_dpsh=0.1 imu.accel_vrw_ugpshz=3"
FREE = Scenario.parse(FIRST.scenario.canonical() | {"method": [{"name": "free"}]})


@pytest.mark.parametrize(
    ("state", "name"),
    [
        (State(load("sun-step"), "sun-step", 0, load("sun-step")), "open sun-step"),
        (replace(FIRST, scenario=FREE), "remove a method"),
        (changed(IMU), "change of imu"),
        (changed(f"{IMU} run.seed=4"), "change of 3 fields"),
        (changed("method.2.network.xi=0.5"), "ζ of fast (compass): 0.7 → 0.5"),
    ],
)
def test_changes_are_named(state: State, name: str) -> None:
    assert change_name(FIRST, state) == name


def test_a_history_is_rebuilt_from_its_steps() -> None:
    history = History(FIRST)
    history.push(changed(H8))
    history.undo()
    again = History.of(history.steps, history.at)
    assert (again.steps, again.at, again.redo_name) == (history.steps, 0, TO_8[1])
    with pytest.raises(ValueError, match="no step"):
        History.of(history.steps, 2)


def test_only_so_many_steps_are_kept() -> None:
    history = History(FIRST)
    for seed in range(2, MOST_STEPS + 12):
        history.push(changed(f"run.seed={seed}"), "another")
    assert len(history.steps) == MOST_STEPS + 1 and history.at == MOST_STEPS
