"""``schuler adapt``: the double loop from the command line."""

import json
from pathlib import Path

import numpy as np
import pytest

from navcore.design.sun import TuningSettings, tune_table
from navcore.law.policy.adaptive import Adaptive
from navcore.scenario.file import load
from schuler_bench.cli import main

COARSE = ("--loop", "step=0.3", "--loop", "smallest=0.1", "--loop", "differences_kn=[0,0.5,3]", "--quiet")
SHORT = ("zha-fast", "--set", "run.step_s=10")


def test_the_command_gives_the_table_of_the_double_loop(capsys: pytest.CaptureFixture[str]) -> None:
    drift = ("--loop", "error=drift", "--loop", 'network={id="complementary"}')
    assert main(["adapt", *SHORT, *COARSE, *drift, "--json"]) == 0
    given = json.loads(capsys.readouterr().out)
    settings = TuningSettings.model_validate(
        {
            "step": 0.3,
            "smallest": 0.1,
            "differences_kn": (0.0, 0.5, 3.0),
            "error": "drift",
            "network": {"id": "complementary"},
        }
    )
    found = tune_table(load("zha-fast", ["run.step_s=10"]), settings)
    assert [[row["difference_kn"], row["xi"]] for row in given["rows"]] == found.pairs()
    assert len(set(np.array(found.pairs())[:, 1])) > 1


def test_the_table_goes_into_a_scenario(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "adapted.toml"
    assert main(["adapt", *SHORT, *COARSE, "--out", str(path)]) == 0
    rows = [line.split() for line in capsys.readouterr().out.splitlines()[1:4]]
    policy = load(str(path)).method[-1].policy
    assert isinstance(policy, Adaptive)
    assert [tuple(row) for row in policy.table] == [(float(row[0]), float(row[1])) for row in rows]


def test_without_a_scenario_it_is_suns_own_setting(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["adapt", "--loop", "step=0.9", "--loop", "differences_kn=[0,3]", "--quiet"]) == 0
    told = capsys.readouterr().out
    rows = tune_table(settings=TuningSettings(step=0.9, differences_kn=(0.0, 3.0))).beside_sun()
    assert [float(line.split()[1]) for line in told.splitlines()[1:3]] == [row[1] for row in rows]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("--loop", "step=9"), "--loop: step = 9: must be >= 0.001 and <= 1"),
        (("--loop", "stp=1"), "did you mean step?"),
        (("--loop", "step"), "KEY=VALUE"),
        (("--loop", 'network={id="none"}'), "must have a damping ratio"),
        (("--set", "run.seed=2"), "needs a SCENARIO"),
        (("no-such",), "no-such: is neither a preset nor a file"),
    ],
)
def test_wrong_settings_are_one_line(
    arguments: tuple[str, ...], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["adapt", *arguments, "--quiet"]) == 2
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1 and told in lines[0]
