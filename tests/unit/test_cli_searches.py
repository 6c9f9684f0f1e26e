"""The commands that search: `tune`, `pareto` and `design`."""

import json
import signal
from pathlib import Path

import pytest

from navcore.scenario.file import load, to_toml
from navcore.scenario.requirement import Requirement
from schuler_bench.cli import main
from schuler_bench.cli.progress import Bar
from tests.acceptance.test_design_values import set_a


def test_commands(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Keys of interface.md; the written scenario has the best setting; faults give 2."""
    out = tmp_path / "best.toml"
    call = ["tune", "sikuliaq-like", "--objective", "tilt_rms", "--vary", "method.2.network.zeta=0.1:3"]
    assert main([*call, "--require", "settling_s<=48h", "--out", str(out), "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    keys = {"best", "objective", "before", "floor", "at_end_of_range", "active"}
    assert keys <= set(document)
    zeta = load(str(out)).method[2].network.model_dump()["zeta"]
    assert zeta == pytest.approx(document["best"]["method.2.network.zeta"])
    assert main(call) == 0
    assert "times the floor" in capsys.readouterr().out
    assert main([*call, "--vary", "run.seed"]) == 2
    assert "run.seed" in capsys.readouterr().err
    assert main(["pareto", "sikuliaq-like", "--method", "1", "--network", "classic2", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["fronts"][0]["network"] == "classic2"
    assert main(["pareto", "sikuliaq-like", "--method", "1", "--network", "classic2"]) == 0
    assert "as it is" in capsys.readouterr().out


@pytest.mark.parametrize(
    "command",
    [
        ["tune", "--objective", "tilt_rms", "--vary", "method.0.network.xi"],
        ["pareto", "--network", "compass", "--network", "unity2"],
        ["design", "--seeds", "40"],
    ],
)
def test_ctrl_c_keeps_what_was_found_and_marks_it(
    command: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[float] = []

    def interrupt_once(bar: Bar, fraction: float) -> None:
        if fraction > 0.1 and not asked:
            asked.append(fraction)
            signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(Bar, "advance", interrupt_once)
    scenario = set_a({"id": "compass"})
    limit = Requirement(quantity="tilt_rms_arcsec", at_most=20.0)
    run = scenario.run.model_copy(update={"duration_h": 1.0})
    path = tmp_path / "ship.toml"
    path.write_text(to_toml(scenario.model_copy(update={"requirement": (limit,), "run": run})), "utf-8")
    assert main([command[0], str(path), *command[1:], "--json"]) == 3
    out, err = capsys.readouterr()
    document = json.loads(out)
    assert asked[0] < 0.9 and document["stopped"] is True and "stopped" in err
    assert document.get("best") or document.get("fronts") or document.get("methods")
