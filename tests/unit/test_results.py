"""The folder of results where it cannot simply be exchanged, and metrics that JSON can hold."""

import json
from dataclasses import replace

import numpy as np
import pytest

from navcore.engine import results
from navcore.engine.measures import metrics
from navcore.engine.results import require_replaceable, timeseries, write_results
from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.scenario.file import scenario_hash
from navcore.scenario.model import Scenario


@pytest.fixture(scope="module")
def run() -> Run:
    return simulate(Scenario.parse({"run": {"duration_h": 0.02}, "imu": {"gyro_bias_dph": [0.1, 0.2, 0.3]}}))


def names(folder) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_the_current_folder_keeps_its_place(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    identity = tmp_path.stat().st_ino
    (tmp_path / "timeseries.csv").write_text("old")
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


def test_a_failed_exchange_puts_the_old_folder_back(run, tmp_path, monkeypatch):
    folder = tmp_path / "out"
    write_results(run, folder)
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    rename = type(folder).rename

    def refuse_new(self, target):
        if ".new-" in self.name:
            raise PermissionError(13, "Permission denied")
        return rename(self, target)

    monkeypatch.setattr(type(folder), "rename", refuse_new)
    with pytest.raises(InputError, match="cannot be written: Permission denied"):
        write_results(run, folder)
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before
    assert names(tmp_path) == ["out"]


@pytest.mark.parametrize("make", ["folder of our name", "hidden file", "five files"])
def test_whatever_no_run_wrote_is_named(make, tmp_path):
    if make == "folder of our name":
        (tmp_path / "metrics.json").mkdir()
    for name in {"hidden file": [".git"], "five files": list("abcde")}.get(make, []):
        (tmp_path / name).write_text("")
    with pytest.raises(InputError) as refused:
        require_replaceable(tmp_path)
    said = str(refused.value)
    assert {"folder of our name": "metrics.json", "hidden file": ".git", "five files": "a, b, c and 2 more"}[
        make
    ] in said


def test_an_earlier_run_is_replaced_with_all_files_beside_it(run, tmp_path, monkeypatch):
    folder = tmp_path / "out"
    write_results(run, folder, "csv")
    (folder / "notes.txt").write_text("stale")
    write_results(run, folder, "parquet")
    assert names(folder) == ["metrics.json", "scenario.toml", "timeseries.parquet"]
    (folder / "notes.txt").write_text("mine")
    monkeypatch.chdir(folder)
    with pytest.raises(InputError, match="notes.txt"):
        write_results(run, ".")
    assert (folder / "notes.txt").read_text() == "mine"


def test_nothing_and_an_empty_folder_may_be_taken(tmp_path):
    require_replaceable(tmp_path / "missing")
    require_replaceable(tmp_path)


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
