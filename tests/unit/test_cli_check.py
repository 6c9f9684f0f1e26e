"""``schuler check`` of scenarios and logs."""

import json

import pytest

from app.cli import main
from navcore.scenario.file import load, scenario_hash
from tests.recordings import ship


def test_a_scenario_is_described(tmp_path, capsys):
    file = tmp_path / "my.toml"
    file.write_text(
        'schema = 1\ntitle = "mine"\n[reference]\nkind = "log"\n[[method]]\ndamping = "external"\n'
        'network = { id = "compass" }\n'
    )
    assert main(["check", str(file), "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["ok"] is True
    assert document["title"] == "mine"
    assert document["scenario_sha256"] == scenario_hash(load(str(file)))
    assert document["methods"][0]["network"] == "compass"
    assert any("H(0)" in warning for warning in document["warnings"])
    assert main(["check", str(file)]) == 0
    out = capsys.readouterr().out
    assert "mine" in out and "external, network compass" in out and "warning: " in out


def test_a_preset_is_checked_by_its_name(capsys):
    assert main(["check", "liu-overshoot"]) == 0
    assert "5: sine for 1000 s" in capsys.readouterr().out


@pytest.mark.parametrize("json_wanted", [False, True])
def test_a_wrong_scenario_gives_a_line_per_fault(json_wanted, tmp_path, capsys):
    file = tmp_path / "wrong.toml"
    file.write_text('schema = 1\n[run]\nduration_h = -1\nearth = "flat"\n')
    assert main(["check", str(file), *(["--json"] if json_wanted else [])]) == 2
    captured = capsys.readouterr()
    lines = captured.err.splitlines()
    assert len(lines) == 2
    assert all(line.startswith(f"{file}: run.") for line in lines)
    if json_wanted:
        document = json.loads(captured.out)
        assert document["ok"] is False
        assert [fault["field"] for fault in document["faults"]] == ["run.duration_h", "run.earth"]
    else:
        assert captured.out == ""


def test_a_motion_that_cannot_be_carried_out_is_found(tmp_path, capsys):
    file = tmp_path / "track.toml"
    file.write_text('schema = 1\n[motion]\nkind = "track"\nfile = "missing.csv"\n')
    assert main(["check", str(file)]) == 2
    err = capsys.readouterr().err
    assert "motion.file" in err and err.count("\n") == 1


@pytest.mark.parametrize("content", [None, b"", b"\x00\x01\x02\xff" * 100])
def test_a_log_that_is_none(content, tmp_path, capsys):
    file = tmp_path / "log.txt"
    if content is not None:
        file.write_bytes(content)
    assert main(["check", str(file)]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert str(file.name) in captured.err
    assert "Traceback" not in captured.err


def test_the_ships_log_is_described(capsys):
    files = ship()
    assert main(["check", files.log, "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert ("VDVBW" if files.raw else "rows") in document["sentences"]
    assert document["checksum_faults"] == 0
    assert document["quantities"]["ground"]["span_s"] == pytest.approx(46 * 60, rel=0.05)
