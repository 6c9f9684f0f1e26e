"""A proposal in runs: paired seeds and their interval; limits that count by default; sliders' ranges."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from navcore.analysis.heading_settling import heading_settling
from navcore.design.confirm import Change, Confirmed, confirmed
from navcore.design.default_limits import heading_limit
from navcore.design.measures import Setting
from navcore.design.ship import Ship
from navcore.design.tune import tune
from navcore.design.vary import read_varied
from navcore.engine.ensemble import drawn
from navcore.engine.simulation import simulate
from navcore.foundation.errors import UnstableError
from navcore.scenario.file import load, to_toml
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from schuler_bench.cli import main

SHIP: dict[str, Any] = {
    "run": {"duration_h": 3.0},
    "imu": {"gyro_bias_dph": [0.01, 0.01, 0.01], "accel_bias_ug": [50.0, 50.0, 0.0], "gyro_arw_dpsh": 0.001},
    "reference": {"kind": "log", "noise_mps": 0.1, "drift_mps": 0.05},
    "method": [{"name": "damped", "damping": "external", "network": {"id": "complementary"}}],
}
ZETA, ETA = "method.0.network.zeta", "method.0.network.eta"


def ship(**blocks: Any) -> Scenario:
    """The scenario with blocks exchanged."""
    return Scenario.parse({**SHIP, **blocks})


def test_changes_are_those_of_paired_runs() -> None:
    """Carried out again by `simulate`; the interval is Student's of the differences."""
    scenario, seeds = ship(), 6
    other = Method.model_validate({**SHIP["method"][0], "network": {"id": "classic2"}})
    found = confirmed(scenario, scenario.method[0], other, seeds)
    assert found is not None
    rms = []
    for number in range(seeds):
        made = drawn(scenario, number)
        pair = (made.method[0], other.model_copy(update={"name": "other"}))
        methods = simulate(made.model_copy(update={"method": pair})).methods
        rms.append(
            [np.hypot(m.errors["dve_mps"]["rms"], m.errors["dvn_mps"]["rms"]) / 2**0.5 for m in methods]
        )
    before, after = np.array(rms).T
    change = found.changes["velocity_rms"]
    assert (change.before, change.after) == pytest.approx((before.mean(), after.mean()), rel=1e-9)
    half = 2.5706 * (after - before).std(ddof=1) / seeds**0.5
    mean = (after - before).mean()
    assert (change.low, change.high) == pytest.approx((mean - half, mean + half), rel=1e-4)


def test_limited_quantities_are_compared_too() -> None:
    """In the unit of their name, from their time on."""
    limit = {"quantity": "tilt_max_arcsec", "at_most": 20.0, "from_h": 1.0}
    scenario = ship(requirement=[limit])
    found = confirmed(scenario, scenario.method[0], scenario.method[0], 3)
    assert found is not None and found.changes["tilt_max_arcsec"].difference == 0.0
    assert 1.0 < (found.changes["tilt_max_arcsec"].before or 0.0) < 1000.0
    assert "velocity_rms" in found.verdict("velocity_rms")


def test_a_proposal_that_diverges_is_not_offered() -> None:
    """The level loop is unstable as it is sampled."""
    slow = ship(reference={"kind": "log", "rate_hz": 0.01})
    runaway = Method.model_validate(
        {"damping": "external", "network": {"id": "compass", "sigma": 0.0088, "xi": 0.7}}
    )
    with pytest.raises(UnstableError, match="diverges on 3 of 3 seeds"):
        confirmed(slow, slow.method[0], runaway, 3)
    back = confirmed(slow, runaway, slow.method[0], 3)
    assert back is not None and back.changes["tilt_rms"].before is None
    assert back.changes["tilt_rms"].difference is None and back.changes["tilt_rms"].after


def test_command_confirms_unless_told_otherwise(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The key `confirmed` of the document, and a table for people."""
    path = tmp_path / "ship.toml"
    path.write_text(to_toml(ship(run={"duration_h": 1.0})))
    command = ["tune", str(path), "--objective", "velocity_rms", "--vary", f"{ZETA}=0.3:1"]
    assert main([*command, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["confirmed"]["seeds"] == 32
    for name in ("tilt_rms", "velocity_rms", "heading_rms", "position_rms"):
        change = found["confirmed"][name]
        assert change["low"] <= change["difference"] <= change["high"]
        assert change["difference"] == pytest.approx(change["after"] - change["before"], abs=1e-12)
    assert found["default_limits"] == ["settling_s<=4h", "growth_per_s<=1.2e-5"]
    assert main([*command, "--json", "--no-confirm", "--no-default-limits"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert "confirmed" not in found and found["default_limits"] == []
    assert main(command) == 0
    assert "run, 32 seeds" in capsys.readouterr().out


@pytest.mark.slow
def test_a_proposal_that_runs_refute_gives_way_to_one_over_the_run() -> None:
    """On a ship with biases and little noise the steady state prefers damping under which 24 h modes grow."""
    day, vary = ship(run={"duration_h": 24.0, "step_s": 2.0}), [f"{ZETA}=0.05:10", f"{ETA}=0.05:10"]
    found, steady = (tune(day, "velocity_rms", vary, confirm=confirm) for confirm in (True, False))
    refuted = confirmed(day, day.method[0], steady.scenario.method[0])
    assert refuted is not None and refuted.verdict("velocity_rms")
    assert found.confirmed is not None and not found.confirmed.verdict("velocity_rms")
    assert found.judged == "ensemble" and "no better in the runs" in found.warnings[0]


@pytest.mark.slow
def test_a_proposal_on_a_recorded_track_rests_on_the_fitted_error_of_its_log() -> None:
    """Counted as free of error, the log led to settings that are worse in runs; now they are better."""
    compass = 'method.2.network={id="compass"}'
    recorded = load("sikuliaq-recorded", [compass])
    found = tune(recorded, "velocity_rms", ["method.2.network.sigma", "method.2.network.xi"], confirm=True)
    assert found.offered and found.before is not None and found.objective < found.before
    assert found.confirmed is not None
    assert any("counts with its fitted error" in text for text in found.warnings)
    proposed = load("sikuliaq-recorded", [compass, *(f"{k}={x!r}" for k, x in found.best.items())])
    others = recorded.model_copy(update={"run": recorded.run.model_copy(update={"seed": 5001})})
    again = confirmed(others, recorded.method[2], proposed.method[2], 60)
    assert again is not None
    for result in (found.confirmed, again):
        high = result.changes["velocity_rms"].high
        assert high is not None and high < 0.0


def test_the_damping_is_not_tuned_away() -> None:
    """Without limits a slow log makes the best setting one that hardly settles; by default it settles."""
    noisy = ship(imu={"gyro_arw_dpsh": 1e-5}, reference={"kind": "log", "noise_mps": 5.0, "drift_mps": 1.0})
    vary = [f"{ZETA}=0.01:2"]
    free = tune(noisy, "tilt_rms", vary, default_limits=False)
    kept = tune(noisy, "tilt_rms", vary)
    loops = [Setting(Ship(one.scenario, False), one.scenario.method[0]).loop for one in (free, kept)]
    settling = [loop.settling_s for loop in loops]
    assert (settling[0] or 1e9) > 4.5 * 3600.0 and (settling[1] or 1e9) <= 4.0 * 3600.0
    assert kept.default_limits and free.default_limits == ()


def test_limits_by_default_give_way() -> None:
    """To limits of the scenario and of the command, and where no setting keeps them."""
    limit = {"quantity": "settling_s", "at_most": 10000.0}
    found = tune(ship(requirement=[limit]), "tilt_rms", [ZETA])
    assert found.default_limits == ("growth_per_s<=1.2e-5",)
    assert tune(ship(), "tilt_rms", [ZETA], ["damping_ratio>=0.3", "growth_per_s<=1"]).default_limits == ()
    greedy = ship(method=[{"damping": "external", "network": {"id": "optimal", "q": 0.0}}])
    found = tune(greedy, "tilt_rms", ["method.0.network.rho=1e-4:1e-2"])
    assert found.default_limits == () and any("searched without" in text for text in found.warnings)


def test_a_range_that_is_not_given_is_the_sliders() -> None:
    """zeta of complementary; one that is asked for may lie outside."""
    (own,) = read_varied(ship(), [ZETA])
    slider = type(ship().method[0].network).model_fields["zeta"].json_schema_extra["slider"]  # pyright: ignore
    assert [own.low, own.high] == slider
    (asked,) = read_varied(ship(), [f"{ETA}=0.01:9"])
    assert (asked.low, asked.high) == (0.01, 9.0)


def compassed(sigma: float) -> Scenario:
    """A ship whose heading is held by a gyrocompass; the slower it is, the less noise it takes."""
    return ship(
        run={"duration_h": 12.0, "step_s": 10.0},
        imu={"gyro_bias_std_dph": 0.005, "accel_bias_std_ug": 20.0, "gyro_arw_dpsh": 0.001},
        initial_error={"heading_std_arcmin": 10.0},
        method=[
            {
                "damping": "external",
                "network": {"id": "complementary"},
                "gyrocompass": {"sigma": sigma, "xi": 0.707},
            }
        ],
    )


def test_a_proposal_without_a_proven_gain_is_none() -> None:
    """Nothing is offered, the command ends with 3, and a proposal with a gain names what it costs."""
    low = Change(724.7, 726.7, 2.0, -3.0, 7.0)
    ruined = Change(4.25, 283.0, 278.75, 270.0, 287.0)
    assert not Confirmed(32, {"position_rms": low}, low).gains
    assert Confirmed(32, {"position_rms": low}, Change(1.0, 0.9, -0.1, -0.2, -0.01)).gains
    assert Confirmed(32, {}).gains is None
    (said,) = Confirmed(32, {"position_rms": low, "heading_rms": ruined}).worse()
    assert said.startswith("heading_rms is 66.6 times as large after it")
    costs = {
        "position_rms": Change(3790.0, 4204.0, 414.0, 308.0, 519.0),
        "heading_rms": Change(1.908, 1.9, -0.01, -0.09, 0.06),
    }
    (said,) = Confirmed(32, costs).worse()
    assert said == "position_rms is 11 % larger after it, over 32 seeds of the run"


def test_the_setting_stays_where_no_gain_is_proven(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The search goes by a covariance that promises a gain; the runs, of the same two settings, show none."""
    scenario = ship(run={"duration_h": 1.0, "step_s": 5.0})
    same = confirmed(scenario, scenario.method[0], scenario.method[0], terms=[("velocity_rms", 1.0)])
    assert same is not None and same.objective is not None and not same.gains
    monkeypatch.setattr("navcore.design.tune.confirmed", lambda *_, **__: same)
    found = tune(scenario, "velocity_rms", [f"{ZETA}=0.3:1"], along=True, confirm=True)
    assert not found.offered and found.failed and found.scenario == scenario
    assert found.best == {ZETA: 0.5} and found.refused[ZETA] != 0.5
    assert found.objective == found.before and found.warnings[0].startswith("no proposal")
    path = tmp_path / "ship.toml"
    path.write_text(to_toml(scenario))
    asked = ["tune", str(path), "--along", "--objective", "velocity_rms", "--vary", f"{ZETA}=0.3:1"]
    assert main([*asked, "--json"]) == 3
    assert json.loads(capsys.readouterr().out)["offered"] is False


def test_the_settling_limit_sees_the_azimuth_loop() -> None:
    """Twice the heading's settling as it is, four hours at least; none without such a loop."""
    (quick, slow) = (Setting(Ship(one), one.method[0]) for one in (compassed(0.002), compassed(0.0002)))
    assert 0.0 < quick.heading_settling_s < slow.heading_settling_s
    assert heading_limit([quick])[0].limit == max(2.0 * quick.heading_settling_s, 4 * 3600.0)
    assert heading_limit([quick])[0].excess(slow) > 0.0
    assert heading_limit([Setting(Ship(ship()), ship().method[0])]) == []
    assert heading_settling(quick.network, 0.78) == float("inf")


@pytest.mark.slow
def test_tuning_keeps_the_heading_settling() -> None:
    """The limit is told among those by default, and the setting keeps it."""
    quick = Setting(Ship(compassed(0.002)), compassed(0.002).method[0])
    found = tune(compassed(0.002), "position_rms", ["method.0.gyrocompass.sigma"], along=True)
    assert any(text.startswith("heading_settling_s<=") for text in found.default_limits)
    now = Setting(Ship(found.scenario), found.scenario.method[0]).heading_settling_s
    assert now <= heading_limit([quick])[0].limit
