"""A run takes over from the one before it what has not changed: bit by bit what it would compute itself."""

import numpy as np
import pytest

from navcore.engine.run import MethodRun, Run
from navcore.engine.simulation import simulate
from navcore.scenario.file import load
from navcore.scenario.model import Scenario


@pytest.fixture(scope="module")
def scenario() -> Scenario:
    found = load("sikuliaq-like")
    return changed(found, run={"duration_h": 1.0})


@pytest.fixture(scope="module")
def before(scenario: Scenario) -> Run:
    return simulate(scenario)


def changed(scenario: Scenario, method: dict | None = None, at: int = 1, **blocks: dict) -> Scenario:
    data = scenario.canonical()
    for name, fields in blocks.items():
        data[name] = data[name] | fields
    if method is not None:
        data["method"][at] = data["method"][at] | method
    return Scenario.parse(data)


def same(one: MethodRun, other: MethodRun) -> bool:
    arrays = [(getattr(one, name), getattr(other, name)) for name in ("t_s", "rows", "law_series")]
    return one.errors == other.errors and all(np.array_equal(a, b, equal_nan=True) for a, b in arrays)


def test_only_the_changed_method_is_run(scenario: Scenario, before: Run) -> None:
    moved = changed(scenario, {"name": "another name"})
    run, alone = simulate(moved, before=before), simulate(moved)
    taken = [now is then for now, then in zip(run.methods, before.methods, strict=True)]
    assert taken == [index != 1 for index in range(len(taken))] and len(taken) >= 2
    assert all(same(a, b) for a, b in zip(run.methods, alone.methods, strict=True))
    assert run.scenario == moved and [m.method.name for m in run.methods] == [m.name for m in moved.method]


@pytest.mark.parametrize(
    "change",
    [
        {"run": {"seed": 77}},
        {"run": {"duration_h": 1.5}},
        {"run": {"output_step_s": 30.0}},
        {"imu": {"gyro_bias_dph": [0.02, 0.0, 0.0]}},
        {"initial_error": {"velocity_mps": [0.3, 0.1]}},
        {"site": {"lat_deg": 12.0}},
        {"reference": {"noise_mps": 0.3}},
    ],
)
def test_nothing_is_taken_over_when_what_all_share_has_changed(
    scenario: Scenario, before: Run, change: dict
) -> None:
    moved = changed(scenario, **change)
    assert moved != scenario
    run = simulate(moved, before=before)
    assert not any(now is then for now in run.methods for then in before.methods)


def test_an_added_method_is_run_and_a_removed_one_is_left_out(scenario: Scenario, before: Run) -> None:
    data = scenario.canonical()
    data["method"] = [data["method"][2], {**data["method"][0], "name": "new"}, data["method"][0]]
    run = simulate(Scenario.parse(data), before=before)
    assert run.methods[0] is before.methods[2] and run.methods[2] is before.methods[0]
    assert same(run.methods[1], before.methods[0]) and run.methods[1].method.name == "new"


def test_a_stopped_method_is_run_again(scenario: Scenario) -> None:
    long = changed(scenario, run={"duration_h": 48.0})
    stopped = simulate(long, cancelled=lambda: True)
    assert stopped.status == "stopped"
    assert simulate(long, before=stopped).status == "ok"


def test_progress_counts_what_was_taken_over_as_done(scenario: Scenario, before: Run) -> None:
    told: list[float] = []
    simulate(changed(scenario, {"name": "x"}), told.append, before=before)
    assert told and told[-1] == pytest.approx(1.0) and min(told) >= 2.0 / 3.0 - 1e-9
