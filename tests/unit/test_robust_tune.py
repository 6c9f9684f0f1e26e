"""A setting that is best at the worst point of a study, and its price in the scenario itself."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from navcore.design.measures import TUNING_INTERVALS, Setting, measure
from navcore.design.ship import Ship
from navcore.design.tune import tune
from navcore.foundation.errors import InputError
from navcore.questions.tune import TuneQuestion
from navcore.scenario.model import Scenario
from navcore.study.model import Study
from navcore.study.robust_tune import tune_over
from schuler_bench.cli import main
from schuler_bench.views.tune.proposal import proposal_html

VARY = ["method.0.network.sigma=1e-3:0.05"]
SHIP = {
    "title": "ship",
    "run": {"duration_h": 2.0},
    "site": {"lat_deg": 45.0},
    "imu": {"gyro_arw_dpsh": 0.002, "accel_vrw_ugpshz": 10.0},
    "reference": {"kind": "log", "noise_mps": 0.02},
    "method": [{"name": "fast", "damping": "external", "network": {"id": "compass", "sigma": 0.01}}],
}
NOISES = [0.02, 0.1, 0.5]


def ship() -> Scenario:
    return Scenario.parse(SHIP, "ship.toml")


def study(field: str = "reference.noise_mps", values: list[float] = NOISES) -> Study:
    return Study.parse({"schema": 1, "scenario": SHIP, "factor": [{"field": field, "values": values}]}, "s")


def test_the_setting_is_best_at_the_worst_point_and_dearer_in_the_scenario() -> None:
    found = tune_over(ship(), study(), "tilt_rms", VARY)
    alone = tune(ship(), "tilt_rms", VARY)
    noisy = Scenario.parse({**SHIP, "reference": {"kind": "log", "noise_mps": 0.5}}, "noisy")
    there = tune(noisy, "tilt_rms", VARY)
    assert found.where == {"reference.noise_mps": 0.5} and found.points == 3
    assert found.worst == pytest.approx(there.objective, rel=1e-3) == found.objective
    assert found.best_here == pytest.approx(alone.objective, rel=1e-9)
    # a slower loop, which the quiet log does not need
    name = VARY[0].partition("=")[0]
    assert found.best[name] < 0.5 * alone.best[name]
    here = measure(Setting(Ship(ship(), False, TUNING_INTERVALS), found.scenario.method[0]), "tilt_rms")
    assert found.here == pytest.approx(here) and here > 1.2 * alone.objective
    # it is put into the scenario itself
    assert found.scenario.reference == ship().reference
    document = found.document()["over"]
    assert document["worst"]["factors"] == found.where and document["points"] == 3


def asked() -> TuneQuestion:
    return TuneQuestion(scenario=ship(), objective="tilt_rms", vary=("method.0.network.sigma",), over=study())


def test_page_and_terminal_say_what_it_costs() -> None:
    found = tune_over(ship(), study(), "tilt_rms", VARY)
    lines = "\n".join(found.lines())
    assert "over 3 points" in lines and "reference.noise_mps = 0.5" in lines and "best there" in lines
    html = proposal_html(asked(), found)
    assert "Over 3 points of the study the objective is at most" in html
    assert "the setting that is best here has" in html
    task = asked()
    assert "arcsec, with " in html
    at_home = proposal_html(task, replace(found, where={}))
    assert "arcsec, in this scenario itself; the runs are of" in at_home


def test_a_weighted_sum_is_relative_to_what_the_scenario_gave_before() -> None:
    found = tune_over(ship(), study(), "tilt_rms + velocity_rms", VARY)
    names = "tilt_rms", "velocity_rms"
    before, after = (
        [measure(Setting(Ship(ship(), False, TUNING_INTERVALS), method), name) for name in names]
        for method in (ship().method[0], found.scenario.method[0])
    )
    assert found.here == pytest.approx(sum(new / old for new, old in zip(after, before, strict=True)))
    assert found.best_here <= 2.0 * (1.0 + 1e-9), "what it was before"


def test_a_study_must_change_what_is_not_tuned() -> None:
    with pytest.raises(InputError, match="must not be a method"):
        tune_over(ship(), study("method.0.network.xi", [0.5, 0.7]), "tilt_rms", VARY)


def test_the_command_takes_a_study_or_scenarios(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "noise.toml"
    file.write_text(
        f'schema = 1\nscenario = "zha-fast"\n[[factor]]\nfield = "reference.noise_mps"\nvalues = {NOISES}\n'
    )
    given = [
        "tune", "sikuliaq-like", "--objective", "tilt_rms", "--vary", "method.2.network.zeta=0.2:1",
        "--no-confirm", "--quiet", "--json", "--over", str(file),
    ]  # fmt: skip
    assert main(given) == 0
    assert json.loads(capsys.readouterr().out)["over"]["points"] == 3
    assert main([*given, "--worst-of", "zha-fast"]) == 2
    assert "does not go with --worst-of" in capsys.readouterr().err
