"""A method that the rest of a scenario refuses is refused alone: the others run, and it is named first."""

import json
from pathlib import Path

import pytest

from navcore.foundation.errors import InputError
from navcore.questions import QUESTIONS
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from navcore.study.model import Factor, Study
from navcore.study.plan import Plan
from navcore.study.running import run_points
from navcore.study.sweep import sweep
from schuler_bench.cli import main

SHIP = """
[run]
duration_h = 0.2
[site]
lat_deg = 45.0
[motion]
kind = "static"
[reference]
kind = "log"
noise_mps = 0.1
[[method]]
name = "half periods"
damping = "averaging"
[[method]]
name = "free"
[[method]]
name = "classic2"
damping = "external"
network = { id = "classic2" }
[[requirement]]
quantity = "velocity_rms_mps"
at_most = 5.0
"""
WAVES = ['motion={kind="waves", height_m=2.0}']


@pytest.fixture
def ship(tmp_path: Path) -> str:
    path = tmp_path / "ship.toml"
    path.write_text(SHIP, "utf-8")
    return str(path)


def test_a_refused_method_is_left_out_and_said(ship: str) -> None:
    with pytest.raises(InputError, match="the motion must start from rest"):
        load(ship, WAVES)
    left = load(ship, WAVES, apart=True)
    assert [method.name for method in left.method] == ["free", "classic2"]
    (one,) = left.refused
    assert (one.name, one.place) == ("half periods", 0) and "must start from rest" in one.line
    assert load(ship, apart=True).refused == ()


def test_what_is_wrong_with_the_scenario_itself_or_with_every_method_is_still_refused(ship: str) -> None:
    with pytest.raises(InputError, match="must hold at least one step"):
        load(ship, [*WAVES, "run.duration_h=1e-6"], apart=True)
    only = Scenario.parse(load(ship).canonical()).canonical() | {
        "method": load(ship).canonical()["method"][:1]
    }
    with pytest.raises(InputError, match="must start from rest"):
        Scenario.parse(only | {"motion": {"kind": "waves", "height_m": 2.0}}, apart=True)


def test_run_goes_on_with_the_others_and_ends_as_wrong_input(
    ship: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", ship, "--set", WAVES[0], "--json"]) == 2
    out, err = capsys.readouterr()
    document = json.loads(out)
    assert [method["name"] for method in document["methods"]] == ["free", "classic2"]
    (refused,) = document["refused"]
    assert refused["name"] == "half periods" and "must start from rest" in refused["reason"]
    assert "half periods is refused and left out" in err


def test_a_design_lists_it_among_what_is_left_out(ship: str) -> None:
    question = QUESTIONS["design"].ask(
        {"scenario": load(ship, WAVES, apart=True), "as_set": True, "seeds": 2}
    )
    found = question.answer().document()
    assert {one["name"] for one in found["methods"]} == {"free", "classic2"}
    assert "must start from rest" in found["left_out"]["half periods"]


def test_a_study_names_it_before_the_first_run_and_runs_the_others(ship: str) -> None:
    motions = {"kind": "static"}, {"kind": "waves", "height_m": 2.0}
    sea = Factor(name="sea", field=("motion",), values=motions, labels=("calm", "rough"))
    plan = Plan(Study(scenario=load(ship).canonical(), factor=(sea,), seeds=2))
    (told,) = plan.refused
    assert told.startswith("half periods is refused with sea = rough") and "start from rest" in told
    rows = [row for _, some in run_points(plan, range(plan.runs), lambda: False) for row in some]
    assert len(rows) == 2 * 2 * 3
    refused = [row for row in rows if row["status"] == "refused"]
    assert {(row["method"], row["sea"]) for row in refused} == {("half periods", "rough")} and len(
        refused
    ) == 2
    assert all(row["status"] == "ok" for row in rows if row not in refused)
    assert [row["method"] for row in rows[:3]] == ["half periods", "free", "classic2"]


def test_a_sweep_keeps_each_method_in_its_column(ship: str) -> None:
    found = sweep(load(ship), "sea")
    assert found is not None and found.metrics is not None
    half, free, classic = found.metrics["tilt_rms_arcsec"]
    assert half[0] is not None and half[1:] == (None,) * (len(found.values) - 1)
    assert None not in free and None not in classic
    assert len(found.refused) == 1 and "half periods is refused with sea" in found.refused[0]


def test_a_question_that_names_methods_by_number_refuses_the_whole(ship: str) -> None:
    with pytest.raises(InputError, match="must start from rest"):
        vary = ["method.2.network.zeta"]
        QUESTIONS["tune"].ask({"scenario": load(ship, WAVES), "objective": "tilt_rms", "vary": vary})
