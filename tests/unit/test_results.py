"""The folder of results where it cannot just be exchanged; metrics that JSON can hold; methods that stay."""

import json
from dataclasses import replace

import numpy as np
import pytest

from navcore.engine import results
from navcore.engine.measures import metrics
from navcore.engine.results import timeseries, write_results
from navcore.engine.run import MethodRun, Run
from navcore.engine.simulation import simulate
from navcore.scenario.file import load, scenario_hash
from navcore.scenario.model import Scenario


@pytest.fixture(scope="module")
def run() -> Run:
    return simulate(Scenario.parse({"run": {"duration_h": 0.02}, "imu": {"gyro_bias_dph": [0.1, 0.2, 0.3]}}))


def names(folder) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_the_current_folder_keeps_its_place(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    identity = tmp_path.stat().st_ino
    write_results(run, ".")
    assert tmp_path.stat().st_ino == identity
    assert names(tmp_path) == ["metrics.json", "scenario.toml", "timeseries.parquet"]


def test_a_link_to_a_folder_stays_a_link(run, tmp_path):
    (tmp_path / "real").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "real")
    write_results(run, tmp_path / "link", "csv")
    assert (tmp_path / "link").is_symlink()
    assert names(tmp_path) == ["link", "real"]
    assert names(tmp_path / "real") == ["metrics.json", "scenario.toml", "timeseries.csv"]


def test_our_files_are_those_that_are_written(run, tmp_path):
    for format in ("parquet", "csv"):
        write_results(run, tmp_path / "out", format)
        assert set(names(tmp_path / "out")) <= results.OUR_FILES


def test_what_is_infinite_becomes_null(run):
    (method,) = run.methods
    loop = replace(method.loop, h0=np.inf, poles=np.array([complex(np.nan, 1.0)]))
    errors = {name: {key: np.inf for key in row} for name, row in method.errors.items()}
    broken = replace(run, methods=(replace(method, loop=loop, errors=errors),))
    document = json.loads(json.dumps(metrics(broken), allow_nan=False))
    assert document["methods"][0]["loop"]["h0"] is None
    assert document["methods"][0]["loop"]["poles"] == [[None, 1.0]]
    assert document["methods"][0]["errors"]["dve_mps"]["rms"] is None


def test_metrics_need_no_recording_any_more(tmp_path):
    recording = tmp_path / "log.csv"
    recording.write_text("t_s,speed_mps,heading_deg\n" + "".join(f"{t},5.0,90.0\n" for t in range(7200)))
    reference = {"kind": "log", "file": str(recording)}
    made = simulate(Scenario.parse({"run": {"duration_h": 1.0}, "reference": reference}))
    digest = scenario_hash(made.scenario)
    recording.unlink()
    assert metrics(made)["scenario_sha256"] == digest


def test_metrics_say_which_steps_they_cover(run):
    assert metrics(run)["computed_on"] == "every step of the mechanization, 1 s"
    assert metrics(run)["warnings"] == list(run.warnings)


def test_series_of_all_methods_follow_each_other():
    scenario = Scenario.parse(
        {
            "run": {"duration_h": 0.02, "output_step_s": 7.0},
            "reference": {"kind": "log"},
            "method": [
                {"name": 'a, "b"'},
                {"name": "c", "damping": "external", "network": {"id": "classic2"}},
            ],
        }
    )
    table = timeseries(simulate(scenario))
    assert table["method"].to_pylist() == ['a, "b"'] * 12 + ["c"] * 12
    assert table["t_s"].to_pylist() == [*range(0, 72, 7), 72.0] * 2
    assert table["damped"].to_pylist() == [0] * 12 + [1] * 12


# ---------------------------------------------------------------- methods that stay


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
    # taken over, at other places
    assert run.methods[0].rows is before.methods[2].rows and run.methods[2].rows is before.methods[0].rows
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
