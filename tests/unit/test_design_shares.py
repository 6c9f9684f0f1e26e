"""`schuler design`: draws, shares with their intervals, order, faults; gains that a filter's runs share."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from navcore.design.budget import budget
from navcore.design.designs import designs
from navcore.design.stated import assumed_zero
from navcore.design.tune import tune
from navcore.engine.ensemble import drawn, outcomes
from navcore.engine.measures import judged
from navcore.engine.simulation import simulate
from navcore.engine.verdicts import wilson
from navcore.foundation.errors import InputError, StoppedError
from navcore.foundation.units import ARCMIN, ARCSEC
from navcore.scenario.file import to_toml
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from schuler_bench.cli import main

SHIP: dict[str, Any] = {
    "run": {"duration_h": 2.0, "seed": 7},
    "imu": {"gyro_bias_dph": [0.01, 0.02, 0.0], "accel_bias_std_ug": 30.0, "gyro_arw_dpsh": 0.003},
    "initial_error": {"level_std_arcmin": 0.5, "attitude_arcmin": [9.0, 9.0, 3.0]},
    "reference": {"kind": "log", "noise_mps": 0.1, "drift_mps": 0.05},
    "method": [
        {"name": "damped", "damping": "external", "network": {"id": "classic2"}},
        {"name": "free", "damping": "free"},
        {"name": "filter", "damping": "kalman"},
    ],
    "requirement": [
        {"quantity": "tilt_max_arcsec", "at_most": 30.0, "from_h": 0.5},
        {"quantity": "velocity_rms_mps", "at_most": 0.35},
    ],
}


def ship(**blocks: Any) -> Scenario:
    """The scenario with blocks exchanged."""
    return Scenario.parse({**SHIP, **blocks})


def test_constants_are_drawn_with_the_stated_spreads() -> None:
    """Mean zero; a number beside its standard deviation does not count; what is not given stays 0."""
    made = [drawn(ship(), k) for k in range(1000)]
    assert [one.run.seed for one in made[:3]] == [7, 8, 9]
    gyro = np.array([one.imu.gyro_bias_dph for one in made])
    accel = np.array([one.imu.accel_bias_ug for one in made])
    attitude = np.array([one.initial_error.attitude_arcmin for one in made])
    assert gyro.std(axis=0) == pytest.approx([0.01, 0.02, 0.0], rel=0.07)
    assert accel.std(axis=0) == pytest.approx([30.0, 30.0, 30.0], rel=0.07)
    assert attitude.std(axis=0) == pytest.approx([0.5, 0.5, 3.0], rel=0.07)
    assert np.abs(attitude.mean(axis=0)).max() < 0.3 and np.abs(gyro.mean(axis=0)).max() < 0.002
    assert not any(any(one.initial_error.velocity_mps) for one in made)
    together = np.corrcoef(np.column_stack([gyro[:, :2], accel, attitude]).T)
    assert np.abs(together - np.eye(len(together))).max() < 0.12


def test_shares_are_those_of_runs_of_their_own() -> None:
    """Each seed carried out by `simulate` and judged by the run's own requirements."""
    seeds, scenario = 12, ship()
    found = designs(scenario, seeds, as_set=True)
    met: dict[str, list[bool]] = {"damped": [], "free": []}
    tilts = []
    for number in range(seeds):
        made = drawn(scenario, number)
        for method in simulate(made.model_copy(update={"method": made.method[:2]})).methods:
            verdicts = [judged(one, method) for one in scenario.requirement]
            met[method.method.name].append(all(passed for _, passed in verdicts))
            if method.method.name == "damped":
                tilts.append(verdicts[0][0])
    shares = {share.method.name: share for share in found.methods}
    for name, passed in met.items():
        assert shares[name].met == np.mean(passed)
        assert (shares[name].low, shares[name].high) == wilson(sum(passed), seeds)
    assert 0.0 < shares["damped"].met < 1.0
    assert shares["damped"].limits[0].median == pytest.approx(np.median(tilts), rel=1e-12)
    assert [share.met for share in found.methods] == sorted((s.met for s in found.methods), reverse=True)


def test_a_limit_of_the_setting_is_met_by_all_seeds_or_none() -> None:
    """settling_s of classic2; free never settles, and its median is null."""
    limits = [{"quantity": "settling_s", "at_most": 1e5, "from_h": 9.0}]
    methods = SHIP["method"][:2]
    damped, free = designs(ship(requirement=limits, method=methods), 3, as_set=True).methods
    assert (damped.met, free.met) == (1.0, 0.0) and free.limits[0].median is None
    assert free.as_dict()["network"] is None and damped.as_dict()["network"] == {"id": "classic2"}


def test_a_run_that_diverges_stays_in_the_number() -> None:
    """It meets nothing; the median is null."""
    slow = {"kind": "log", "rate_hz": 0.01}
    method = {"damping": "external", "network": {"id": "compass", "sigma": 0.0088, "xi": 0.7}}
    limits = [{"quantity": "position_final_m", "at_most": 1e9}]
    (share,) = designs(ship(reference=slow, method=[method], requirement=limits), 3, as_set=True).methods
    assert share.met == 0.0 and share.diverged == 3 and share.limits[0].median is None


@pytest.mark.parametrize(("met", "count"), [(0, 200), (7, 10), (200, 200)])
def test_wilson_interval(met: int, count: int) -> None:
    """The ends are the shares whose score statistic is 1.96."""
    for end in wilson(met, count):
        if 0.0 < end < 1.0:
            assert abs(met / count - end) / math.sqrt(end * (1.0 - end) / count) == pytest.approx(1.96)


def test_a_filters_runs_share_its_gains() -> None:
    """The third seed in company and alone; the filter is told the stated spreads, not the drawn constants."""
    scenario = ship()
    filtered = (scenario.method[2],)
    shared = outcomes(scenario, filtered, [0, 1, 2])[2][0]
    (alone,) = outcomes(scenario, filtered, [2])[0]
    assert shared.spans[0].rms == pytest.approx(alone.spans[0].rms, rel=1e-9)
    assert shared.final_m == pytest.approx(alone.final_m, rel=1e-9)


def test_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The document, the folder, and its second use."""
    path, folder = tmp_path / "ship.toml", tmp_path / "out"
    path.write_text(to_toml(ship()))
    command = ["design", str(path), "--as-set", "--seeds", "3", "--out", str(folder)]
    assert main([*command, "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    first = document["methods"][0]
    assert {"name", "network", "azimuth", "met", "low", "high", "limits"} <= first.keys()
    assert [one["quantity"] for one in first["limits"]] == ["tilt_max_arcsec", "velocity_rms_mps"]
    assert json.loads((folder / "design.json").read_text()) == document
    assert main(["run", str(folder / "scenario.toml"), "--set", "run.duration_h=0.1", "--json"]) == 0
    capsys.readouterr()
    assert main(command) == 0
    assert "met %" in capsys.readouterr().out


def test_unstated_spreads_are_named() -> None:
    """An empty box and a zero are two things."""
    assert assumed_zero(ship()) == (
        "reference.bias_std_mps",
        "initial_error.velocity_std_mps",
        "initial_error.position_std_arcsec",
    )
    stated = {**SHIP["initial_error"], "velocity_std_mps": 0.0, "position_arcsec": [0.0, 0.0]}
    assert assumed_zero(ship(initial_error=stated)) == ("reference.bias_std_mps",)


def test_budget_and_tuning_name_unstated_spreads_too(capsys: pytest.CaptureFixture[str]) -> None:
    """The steady state knows no initial error."""
    damped = ship(method=SHIP["method"][:1])
    assert budget(damped).document()["assumed_zero"] == list(assumed_zero(damped))
    assert budget(damped, steady=True).assumed_zero == ("reference.bias_std_mps",)
    method = [{"damping": "external", "network": {"id": "complementary"}}]
    compass = ship(method=method, requirement=[])
    found = tune(compass, "tilt_rms", ["method.0.network.zeta=0.3:1"])
    assert found.document()["assumed_zero"] == ["reference.bias_std_mps"]
    assert main(["budget", "zha-fast", "--steady"]) == 0
    assert "note: 0 is assumed for " in capsys.readouterr().out


@pytest.mark.parametrize(
    ("blocks", "words"),
    [
        ({"requirement": []}, "requirement: is needed"),
        (
            {"requirement": [{"quantity": "tilt_max_arcsec", "at_most": 1.0, "from_h": 2.5}]},
            "requirement.0.from_h = 2.5: must be <= 2 (h)",
        ),
        (
            {
                "run": {"fidelity": "channel", "duration_h": 1.0},
                "method": SHIP["method"][:1],
                "requirement": [{"quantity": "heading_max_arcmin", "at_most": 1.0}],
            },
            "requirement.0.quantity = 'heading_max_arcmin': has no value",
        ),
    ],
)
def test_what_cannot_be_judged_is_refused(blocks: dict[str, Any], words: str) -> None:
    """One line that names field, value and remedy."""
    with pytest.raises(InputError) as error:
        designs(ship(**blocks), 2)
    assert words in str(error.value)


@pytest.mark.slow
def test_networks_are_tuned_for_the_largest_share() -> None:
    """Every network and the filter; a tuned one meets the limits more often than its defaults do."""
    scenario = ship(method=SHIP["method"][:1])
    progress: list[float] = []
    found = designs(scenario, 40, progress=progress.append)
    names = {share.method.name for share in found.methods}
    assert {"compass", "complementary", "unity2", "optimal", "classic2", "kalman"} <= names
    shares = {share.method.name: share.met for share in found.methods}
    default = Method.model_validate({"name": "x", "damping": "external", "network": {"id": "compass"}})
    as_set = designs(scenario.model_copy(update={"method": (default,)}), 40, as_set=True)
    assert shares["compass"] > as_set.methods[0].met + 0.1
    assert progress[-1] == pytest.approx(1.0) and sorted(progress)[0] > 0.0


@pytest.mark.parametrize("part", [0.2, pytest.param(0.7, marks=pytest.mark.slow)])
def test_a_design_that_is_stopped_keeps_what_it_has(part: float) -> None:
    """While it tunes: the networks so far on a few seeds; while it runs: all methods on fewer seeds."""
    done = [0.0]
    found = designs(ship(), 40, progress=done.append, cancelled=lambda: done[-1] >= part)
    names = [share.method.name for share in found.methods]
    late = [name for name, reason in found.left_out if reason == "the search was stopped before it"]
    assert found.stopped and 1 <= found.seeds < 40
    assert sorted([*names, *late]) == sorted(set(names) | set(late))
    assert {"compass", "classic2", "kalman"} <= {*names, *late, "kalman"}
    assert ("kalman" in names) is not bool(late) and bool(late) is (part < 0.35)


def test_a_design_that_is_stopped_at_once_has_nothing() -> None:
    with pytest.raises(StoppedError):
        designs(ship(), 40, cancelled=lambda: True)


def test_drawn_errors_reach_the_run() -> None:
    """The tilt at t = 0 is what was drawn."""
    made = drawn(ship(), 3)
    row = simulate(made).methods[0].rows[0]
    assert row[:3] == pytest.approx(np.array(made.initial_error.attitude_arcmin) * ARCMIN)
    assert row[0] / ARCSEC != 0.0


def test_own_whole_damping_is_judged_beside_the_tuned_networks(monkeypatch: pytest.MonkeyPatch) -> None:
    """As it stands, with its azimuth network or gyrocompass; a level method of the scenario is not."""
    level = {"name": "level", "damping": "external", "network": {"id": "complementary"}}
    own = [
        level,
        {**level, "name": "whole", "azimuth": {"id": "unity2"}},
        {**level, "name": "compassed", "gyrocompass": {}},
    ]
    limit = [{"quantity": "velocity_rms_mps", "at_most": 5.0}]
    scenario = Scenario.parse(
        {
            "run": {"duration_h": 0.5, "step_s": 5.0},
            "reference": {"kind": "log", "noise_mps": 0.1},
            "method": own,
            "requirement": limit,
        }
    )
    monkeypatch.setattr("navcore.design.designs.tuned_methods", lambda *_: ([], []))
    found = {share.method.label(): share.method for share in designs(scenario, 2).methods}
    assert "level" not in found
    assert found["whole"] == scenario.method[1] and found["compassed"] == scenario.method[2]
