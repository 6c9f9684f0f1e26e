"""A verdict of a run says what it was drawn from: a ship that is good only while its biases are 0."""

import json
from pathlib import Path
from typing import Any

import pytest

from navcore.design.designs import designs
from navcore.engine.simulation import simulate
from navcore.scenario.file import to_toml
from navcore.scenario.model import Scenario
from navcore.scenario.stochastic import drawn_as_zero
from schuler_bench.cli import main
from schuler_bench.session.display import Display
from schuler_bench.session.shown import Shown
from schuler_bench.views.requirements.table import requirements_html
from schuler_bench.views.strip.view import strip_html

DEVIATIONS = {"gyro_bias_std_dph": 0.01, "accel_bias_std_ug": 50.0}
SHIP: dict[str, Any] = {
    "run": {"duration_h": 6.0, "step_s": 5.0, "seed": 3},
    "imu": {**DEVIATIONS, "gyro_arw_dpsh": 0.001},
    "reference": {"kind": "log", "noise_mps": 0.1},
    "method": [
        {"name": "damped", "damping": "external", "network": {"id": "classic2"}},
        {"name": "free", "damping": "free"},
    ],
    "requirement": [
        {"quantity": "tilt_max_arcsec", "at_most": 7.0, "from_h": 2.0},
        {"quantity": "position_max_m", "at_most": 1852.0},
    ],
}


def written(tmp_path: Path, **blocks: Any) -> str:
    """Path of the ship with blocks exchanged."""
    path = tmp_path / "ship.toml"
    path.write_text(to_toml(Scenario.parse({**SHIP, **blocks})))
    return str(path)


def test_a_run_says_what_seeds_say(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Met by the run that takes the biases as 0 and by no seed; the shares are those of a design."""
    out = tmp_path / "out"
    assert main(["run", written(tmp_path), "--out", str(out), "--json", "--quiet"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert json.loads((out / "metrics.json").read_text())["methods"] == document["methods"]
    method = document["methods"][0]
    tilt, position = method["requirements"]
    assert tilt["met"] and position["met"]
    assert tilt["drawn_as_zero"] == ["imu.gyro_bias_std_dph", "imu.accel_bias_std_ug"]
    assert tilt["seeds"]["seeds"] == 24 and tilt["seeds"]["met"] < 0.1
    assert tilt["seeds"]["met"] < tilt["seeds"]["high"] < 0.35
    found = designs(Scenario.parse(SHIP), 24, as_set=True)
    share = next(one for one in found.methods if one.method.label() == "damped")
    assert method["seeds"] == {"seeds": 24, "met": share.met, "low": share.low, "high": share.high}
    assert [row["seeds"]["met"] for row in method["requirements"]] == [one.met for one in share.limits]


def test_the_command_prints_a_verdict_for_each_method_and_limit(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """With the share beside it, and the deviations that were drawn as 0."""
    assert main(["run", written(tmp_path), "--quiet"]) == 0
    lines = capsys.readouterr().out.splitlines()
    limits = "tilt_max_arcsec <= 7 from 2 h", "position_max_m <="
    verdicts = [line for line in lines if line.startswith(limits)]
    assert len(verdicts) == 4 and all(" of 24 (" in line for line in verdicts)
    assert " damped " in verdicts[0] and " met " in verdicts[0]
    assert " free " in verdicts[1] and " damped " in verdicts[2]
    (zero,) = [line for line in lines if line.startswith("drawn as 0")]
    assert zero.endswith("imu.gyro_bias_std_dph, imu.accel_bias_std_ug")


def test_without_deviations_no_seed_is_run(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The verdict stands alone; without limits there is none."""
    monkeypatch.setattr("navcore.design.run_shares.outcomes", None)
    assert main(["run", written(tmp_path, imu={"gyro_arw_dpsh": 0.001}), "--quiet"]) == 0
    text = capsys.readouterr().out
    assert "tilt_max_arcsec <= 7 from 2 h" in text and "% of" not in text and "drawn as 0" not in text
    assert main(["run", written(tmp_path, requirement=[]), "--quiet"]) == 0
    assert "requirement" not in capsys.readouterr().out


def test_only_what_the_run_takes_as_zero_is_named() -> None:
    """Tilt and heading share a field of numbers; a number beside its deviation is no 0."""
    ship = Scenario.parse(
        {
            **SHIP,
            "imu": {**DEVIATIONS, "gyro_bias_dph": [0.0, 0.01, 0.0]},
            "initial_error": {
                "attitude_arcmin": [0.0, 0.0, 3.0],
                "level_std_arcmin": 1.0,
                "heading_std_arcmin": 5.0,
                "velocity_std_mps": 0.0,
            },
        }
    )
    assert drawn_as_zero(ship) == ("imu.accel_bias_std_ug", "initial_error.level_std_arcmin")


def test_the_page_names_them_beside_its_verdicts() -> None:
    """Under the table of limits and in the hint of a card; not where the constants are numbers."""
    ship, fields = Scenario.parse(SHIP), "imu.gyro_bias_std_dph, imu.accel_bias_std_ug"
    run = simulate(ship)
    assert fields in requirements_html(run)
    assert f"drawn as 0 in this run: {fields}" in strip_html(Shown(run, 1, Display()), 0)
    plain = simulate(ship.model_copy(update={"imu": type(ship.imu)()}))
    assert "rawn as 0" not in requirements_html(plain) + strip_html(Shown(plain, 1, Display()), 0)
