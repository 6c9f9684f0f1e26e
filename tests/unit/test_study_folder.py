"""The folder of a study, which is gone on with; its summary; faults."""

import fcntl
import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import navcore.engine.ensemble
from navcore.engine.verdicts import wilson
from navcore.foundation.errors import InputError
from navcore.study.file import load, studies
from navcore.study.plan import Plan, plan_of, require_affordable
from navcore.study.results import Folder
from navcore.study.study import carry_out
from schuler_bench.cli import main
from tests.studies import LATITUDE, NOISE, stored, write

# ---------------------------------------------------------------- the folder


@pytest.fixture
def study(tmp_path: Path) -> str:
    """A study of 24 runs."""
    return write(tmp_path / "study.toml", factor=[LATITUDE, NOISE], seeds=3, sample={"points": 4})


class Stops:
    """Says to stop after so many questions."""

    def __init__(self, after: int) -> None:
        self.left = after

    def __call__(self) -> bool:
        self.left -= 1
        return self.left < 0


def begun(study: str, folder: Path, runs: int) -> None:
    """Run a study in part."""
    made = plan_of(study)
    results = Folder(folder, made)
    with results.opened(resume=False):
        document = carry_out(made, results, 1, stopped=Stops(runs + 2))
    assert document["status"] == "stopped" and 0 < document["runs"] < made.runs
    assert len(stored(folder)) == 2 * document["runs"]


def test_runs_of_other_sources_are_not_gone_on_with(study, tmp_path, capsys, monkeypatch):
    """The version's name alone stood in study.toml: two states of a program mixed their runs."""
    begun(study, tmp_path / "part", 5)
    call = ["study", study, "--out", str(tmp_path / "part"), "--resume", "--json"]
    with monkeypatch.context() as patch:
        patch.setattr("navcore.study.results.source_digest", lambda: "0123")
        assert main(call) == 2
        assert "sources 0123 here" in capsys.readouterr().err
    assert main(call) == 0


def test_what_was_stopped_is_gone_on_with(study, tmp_path, capsys, monkeypatch):
    assert main(["study", study, "--out", str(tmp_path / "whole"), "--workers", "2", "--json"]) == 0
    whole = json.loads(capsys.readouterr().out)
    begun(study, tmp_path / "part", 5)
    there = {row["run"] for row in stored(tmp_path / "part")}
    ran: list[int] = []
    real = navcore.study.study.run_points

    def counted(made: Plan, numbers: range, stopped: Any) -> Iterator[Any]:
        ran.extend(numbers)
        return real(made, numbers, stopped)

    monkeypatch.setattr(navcore.study.study, "run_points", counted)
    assert main(["study", study, "--out", str(tmp_path / "part"), "--resume"]) == 0
    assert sorted([*there, *ran]) == [*range(24)]
    assert stored(tmp_path / "part") == stored(tmp_path / "whole")
    assert json.loads((tmp_path / "part" / "summary.json").read_text()) == whole
    assert sorted(p.name for p in (tmp_path / "part").iterdir()) == [
        "runs.parquet",
        "study.toml",
        "summary.json",
    ]
    ran.clear()
    assert main(["study", study, "--out", str(tmp_path / "part"), "--resume"]) == 0
    assert not ran


def refusal(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    """What a refused command says."""
    capsys.readouterr()
    assert main(["study", *arguments]) == 2
    captured = capsys.readouterr()
    assert not captured.out and "Traceback" not in captured.err
    return captured.err


def test_a_changed_study_does_not_go_on_with_old_results(study, tmp_path, capsys):
    folder = tmp_path / "results"
    begun(study, folder, 5)
    before = (folder / "study.toml").read_text()
    assert "holds unfinished results: --resume" in refusal([study, "--out", str(folder)], capsys)
    write(tmp_path / "study.toml", factor=[LATITUDE, NOISE], seeds=4, sample={"points": 4})
    error = refusal([study, "--out", str(folder), "--resume"], capsys)
    assert "holds results of another study (seeds = 3 there, seeds = 4 here)" in error
    assert "holds unfinished results" in refusal([study, "--out", str(folder)], capsys)
    assert (folder / "study.toml").read_text() == before and [*folder.glob("parts/*.parquet")]


def test_complete_results_are_replaced_as_a_whole(study, tmp_path):
    folder = tmp_path / "results"
    assert main(["study", study, "--out", str(folder)]) == 0
    write(tmp_path / "study.toml", seeds=1)
    assert main(["study", study, "--out", str(folder)]) == 0
    assert len(stored(folder)) == 2


def files_of(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


@pytest.mark.parametrize("after", [0, 2, 9])
def test_complete_results_stay_until_new_ones_are_complete(study, tmp_path, capsys, after):
    """A second run removed the results of the first when it began: an interrupt or a full disk lost both."""
    folder = tmp_path / "results"
    assert main(["study", study, "--out", str(folder)]) == 0
    earlier = files_of(folder)
    (folder / "notes.md").write_text("ours")
    write(tmp_path / "study.toml", factor=[LATITUDE, NOISE], seeds=4, sample={"points": 4})
    made = plan_of(study)
    results = Folder(folder, made)
    with results.opened(resume=False):
        document = carry_out(made, results, 1, stopped=Stops(after))
    assert document["status"] == "stopped"
    assert files_of(folder) == earlier | {"notes.md": b"ours"}
    if results.done():
        assert "--resume goes on; or remove" in refusal([study, "--out", str(folder)], capsys)
    assert main(["study", study, "--out", str(folder), "--resume"]) == 0
    assert main(["study", study, "--out", str(tmp_path / "alone")]) == 0
    assert files_of(folder) == files_of(tmp_path / "alone") | {"notes.md": b"ours"}
    assert not (folder / "parts").exists()


@pytest.mark.parametrize("at", range(1, 7))
def test_a_kill_while_earlier_results_are_replaced_loses_neither(tmp_path, monkeypatch, at):
    folder, study = tmp_path / "results", write(tmp_path / "study.toml", seeds=2)
    assert main(["study", study, "--out", str(folder)]) == 0
    write(tmp_path / "study.toml", seeds=1)
    for name in ("replace", "unlink"):
        steps = iter(range(1, 99))
        real = getattr(os, name)

        def step(*arguments: Any, real: Any = real, steps: Any = steps, **options: Any) -> None:
            if next(steps) == at:
                raise KeyboardInterrupt
            real(*arguments, **options)

        with monkeypatch.context() as patch:
            patch.setattr(os, name, step)
            try:
                main(["study", study, "--out", str(folder)])
            except KeyboardInterrupt:
                pass
        assert {"runs.parquet", "study.toml", "summary.json"} <= {*files_of(folder)}
        call = ["study", study, "--out", str(folder)]
        assert 0 in (main([*call, "--resume"]), main(call))
        assert len(stored(folder)) == 2 and not (folder / "parts").exists()


def test_a_folder_that_cannot_be_used_is_refused(study, tmp_path, capsys):
    assert "exists and is not a folder" in refusal([study, "--out", study], capsys)
    (tmp_path / "used").mkdir()
    held = os.open(tmp_path / "used", os.O_RDONLY)
    fcntl.flock(held, fcntl.LOCK_EX)
    assert "is in use by another command" in refusal([study, "--out", str(tmp_path / "used")], capsys)
    os.close(held)


def test_a_full_disk_is_told_and_leaves_what_is_there(study, tmp_path, capsys, monkeypatch):
    begun(study, tmp_path / "results", 5)
    there = len([*tmp_path.glob("results/parts/*.parquet")])

    def full(*_: Any) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(Folder, "_write", full)
        error = refusal([study, "--out", str(tmp_path / "results"), "--resume"], capsys)
    assert "cannot be written: No space left on device" in error
    assert len([*tmp_path.glob("results/parts/*.parquet")]) == there
    assert main(["study", study, "--out", str(tmp_path / "results"), "--resume"]) == 0


# ---------------------------------------------------------------- summary


def test_the_summary_is_that_of_the_rows(study, tmp_path, capsys):
    assert main(["study", study, "--out", str(tmp_path / "o"), "--json"]) == 0
    document, rows = json.loads(capsys.readouterr().out), stored(tmp_path / "o")
    assert document["runs"] == document["of"] == 24 and document["status"] == "complete"
    damped = [row for row in rows if row["method"] != "free"]
    method = document["methods"][1]
    met = sum(row["met"] for row in damped)
    assert 0 < met < 24
    assert [method["met"][key] for key in ("share", "low", "high")] == [met / 24, *wilson(met, 24)]
    values = [row["tilt_max_arcsec"] for row in damped]
    assert method["metrics"]["tilt_max_arcsec"]["q95"] == pytest.approx(np.quantile(values, 0.95))
    assert [cell["factors"] for cell in document["cells"]] == [{"site.lat_deg": 10}, {"site.lat_deg": 45}]
    pairs = [(a, b) for a, b in zip(rows[0::2], rows[1::2], strict=True) if a["site.lat_deg"] == 45.0]
    wins = sum(b["velocity_rms_mps"] < a["velocity_rms_mps"] for a, b in pairs)
    best = document["cells"][1]["methods"][1]["metrics"]["velocity_rms_mps"]["best"]
    assert [best["share"], best["low"]] == [wins / 12, wilson(wins, 12)[0]]


def test_people_get_tables(study, capsys):
    assert main(["study", study, "--quiet"]) == 0
    out = capsys.readouterr().out
    assert "24 of 24 runs" in out and "95 % interval" in out and "\n45 " in out


def test_listed_studies_can_be_run(capsys):
    assert {"latitudes", "sea-states", "sensor-grades"} <= {*studies()}
    for name in studies():
        made = plan_of(name)
        require_affordable(made, 2, 1.0 / 60.0)
        assert made.study.title
    assert main(["presets", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)["studies"]
    assert listed == [{"name": name, "title": load(name).title} for name in studies()]


# ---------------------------------------------------------------- faults

FAULTS: list[tuple[dict[str, Any], str]] = [
    ({"seeds": 0}, "seeds = 0: must be >= 1"),
    ({"seed": 3}, "seed = 3: "),
    ({"scenario": "nowhere"}, "nowhere: is neither a preset nor a file"),
    (
        {"factor": [{"field": "site.lat_deg", "values": [10, 95]}]},
        "factor.0.values.1 = 95: site.lat_deg = 95",
    ),
    ({"factor": [{"field": "site.latitude", "values": [10]}]}, "factor.0.values.0 = 10: site.latitude = 10"),
    ({"factor": [{**NOISE, "low": -1.0}]}, "factor.0 = -0.495: imu.gyro_arw_dpsh = -0.495: must be >= 0"),
    ({"factor": [{"field": "site.lat_deg"}]}, "factor.0.low: is required where there are no values"),
    ({"factor": [{**NOISE, "high": 0.0005}]}, "factor.0.low = 0.001: must be < high = 0.0005"),
    ({"factor": [{**NOISE, "distribution": "gamma"}]}, "factor.0.distribution = 'gamma': must be one of"),
    ({"factor": [{**NOISE, "distribution": "normal"}]}, "factor.0.mean: is required"),
    ({"factor": [{**LATITUDE, "labels": ["one"]}]}, "factor.0.labels = ['one']: must be 2 different texts"),
    ({"factor": [{**LATITUDE, "name": "run"}]}, "factor.0.name = 'run': must differ"),
    ({"factor": [LATITUDE, LATITUDE]}, "factor.1.name = 'site.lat_deg': must differ"),
    (
        {"factor": [{"field": ["site.lat_deg", "site.lon_deg"], "values": [10]}]},
        "factor.0.values.0 = 10: must be a list of 2 values",
    ),
    ({"factor": [LATITUDE], "sample": {"points": 4}}, "sample: needs a [[factor]] with a distribution"),
    ({"factor": [NOISE], "sample": {"method": "halton"}}, "sample.method = 'halton': must be one of"),
    ({"output": {"metrics": ["speed"]}}, "output.metrics.0 = 'speed': must be one of"),
    ({"output": {"series": ["phi_e_rad"]}}, "output.epochs_h: is required"),
    (
        {"output": {"series": ["phi_e_rad"], "epochs_h": [0.7]}},
        "output.epochs_h.0 = 0.7: must be >= 0 and <= 0.5",
    ),
    ({"fidelity": "exact"}, "fidelity = 'exact': must be one of"),
    ({"set": ["run.duration_h"]}, "--set = 'run.duration_h': must have the form"),
]


@pytest.mark.parametrize(("blocks", "line"), FAULTS, ids=[line.split(":")[0] for _, line in FAULTS])
def test_faults_name_field_value_and_range(tmp_path, capsys, blocks, line):
    assert line in refusal([write(tmp_path / "study.toml", **blocks)], capsys)


def test_other_faults(study, capsys):
    assert "nowhere: is neither a listed study nor a file; studies: " in refusal(["nowhere"], capsys)
    assert "--resume: needs --out DIR" in refusal([study, "--resume"], capsys)
    assert "--workers = 0: must be >= 1" in refusal([study, "--workers", "0"], capsys)
    assert "--hours = 0.0: must be > 0 (h)" in refusal([study, "--hours", "0"], capsys)


def test_a_study_that_takes_too_long_is_refused_with_its_estimate(tmp_path, capsys):
    name = write(tmp_path / "study.toml", factor=[NOISE], seeds=1000, sample={"points": 2_000_000})
    error = refusal([name, "--workers", "2"], capsys)
    assert "is 2000000000 runs, which take about " in error and "ask for them by --hours" in error
    made = plan_of(name)
    hours = made.seconds() / 2 / 3600
    require_affordable(made, 2, 1.01 * hours)
    with pytest.raises(InputError, match=r"at most .* h"):
        require_affordable(made, 2, 0.99 * hours)
    assert "about" in refusal([write(tmp_path / "s.toml", seeds=20), "--hours", "1e-6"], capsys)
