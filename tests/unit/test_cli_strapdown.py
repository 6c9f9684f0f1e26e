"""The command with fidelity strapdown: presets, files, faults, stopping."""

import json

import pytest

from app.cli import main

STRAPDOWN = ["--set", "run.fidelity=strapdown", "--set", "run.duration_h=0.05"]


@pytest.mark.parametrize("preset", ["liu-networks", "sikuliaq-like", "zha-fast"])
def test_a_linear_preset_runs_as_strapdown(preset, capsys):
    assert main(["run", preset, *STRAPDOWN, "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["computed_on"].startswith("states every 1 s")
    assert all(method["status"] == "ok" for method in document["methods"])


def test_people_read_what_was_run(capsys):
    assert main(["run", "zha-fast", *STRAPDOWN]) == 0
    out = capsys.readouterr().out
    assert "strapdown, 0.05 h" in out and "every 100 steps of the mechanization at 100 Hz" in out


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        (["site.lat_deg=88", "alignment.kind=compass"], "zha-fast: site.lat_deg = 88.0: compass alignment"),
        (["imu.file=/nowhere.imu"], "/nowhere.imu: imu.file: No such file or directory"),
        (["run.rate_hz=5"], "zha-fast: run.rate_hz = 5: must be >= 10 and <= 1000 (Hz)"),
    ],
)
def test_a_fault_is_one_line_and_exit_2(changes, line, capsys):
    words = [word for change in changes for word in ("--set", change)]
    assert main(["run", "zha-fast", *STRAPDOWN, *words]) == 2
    err = capsys.readouterr().err
    assert err.startswith(line) and err.count("\n") == 1


def test_check_tells_the_samples_of_a_strapdown_scenario(tmp_path, capsys):
    path = tmp_path / "s.toml"
    path.write_text('schema = 1\n[run]\nfidelity = "strapdown"\nduration_h = 0.5\nrate_hz = 200.0\n')
    assert main(["check", str(path)]) == 0
    assert "strapdown, 0.5 h, 360000 samples at 200 Hz" in capsys.readouterr().out
