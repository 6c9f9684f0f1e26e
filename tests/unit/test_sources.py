"""Sources run apart: what is switched on, that their errors add up, and which one is said to dominate."""

from __future__ import annotations

import numpy as np
import pytest

from navcore.engine.simulation import simulate
from navcore.scenario.file import load
from navcore.scenario.model import Method, Scenario
from navcore.studies import alone
from navcore.studies.sources import active_sources, apart, only

SCENARIO = {
    "run": {"duration_h": 3.0, "step_s": 5.0},
    "imu": {"gyro_bias_dph": [0.0, 0.01, 0.0], "gyro_arw_dpsh": 0.002, "accel_bias_ug": [20.0, 0.0, 0.0]},
    "initial_error": {"velocity_mps": [0.1, 0.0]},
    "reference": {"kind": "log", "noise_mps": 0.2, "rate_hz": 0.2},
    "method": [
        {"name": "free"},
        {
            "name": "damped",
            "damping": "external",
            "network": {"id": "classic2"},
            "event": [{"t_h": 1.0, "duration_s": 100.0, "accel_mps2": [0.01, 0.0]}],
        },
    ],
}
ALL = ("initial error", "gyro bias", "gyro noise", "accelerometer bias", "log noise", "log events")


def test_what_is_switched_on_is_named():
    assert active_sources(Scenario.parse(SCENARIO)) == ALL
    assert active_sources(Scenario.parse({})) == ()


def test_errors_of_the_sources_add_up_to_the_whole():
    scenario = Scenario.parse(SCENARIO)
    whole = simulate(scenario)
    runs = [simulate(only(scenario, name)) for name in ALL]
    for i, method in enumerate(whole.methods):
        together = np.sum([run.methods[i].rows[:, :7] for run in runs], axis=0)
        scale = np.abs(method.rows[:, :7]).max(axis=0)
        assert np.abs(together - method.rows[:, :7]).max(axis=0) == pytest.approx(0.0, abs=1e-9 * scale.max())


def test_the_largest_source_comes_first():
    scenario = load("zha-fast", ["imu.accel_bias_ug=[0.01, 0, 0]"])
    free = apart(scenario, simulate(scenario))[0]
    assert free.method == "free"
    (first, share), (second, rest) = free.shares("position_m")
    assert (first, second) == ("gyro bias", "accelerometer bias")
    assert share > 0.99
    assert share + rest == pytest.approx(1.0)


@pytest.mark.parametrize("preset", ["sikuliaq-like", "liu-networks", "zha-external", "liu-switching"])
def test_shares_at_the_pace_of_the_loop_are_those_of_every_step(preset: str, monkeypatch: pytest.MonkeyPatch):
    from navcore.studies import sources

    scenario = load(preset, ["run.duration_h=5"])
    whole = simulate(scenario)
    sources._apart.clear()
    quick = apart(scenario, whole)
    monkeypatch.setattr(alone, "_LONGEST_STRIDE", 1)
    sources._apart.clear()
    exact = apart(scenario, whole)
    for one, other in zip(quick, exact, strict=True):
        assert [c.source for c in one.contributions] == [c.source for c in other.contributions]
        for quantities in (("dlat_m", "dlon_m"), ("phi_e_rad", "phi_n_rad"), ("phi_u_rad",)):
            found, right = dict(one.shares(*quantities)), dict(other.shares(*quantities))
            assert found == pytest.approx(right, abs=0.01)


def test_a_method_that_switches_is_run_at_every_step():
    scenario = load("liu-switching")
    switching = [m for m in scenario.method if m.policy.id != "constant"]
    assert switching and all(alone.Alone(scenario, m)._stride == 1 for m in switching)
    constant = load("sikuliaq-like")
    assert all(alone.Alone(constant, m)._stride > 1 for m in constant.method)


def test_a_recorded_log_is_a_source(tmp_path):
    log = tmp_path / "log.csv"
    log.write_text("t_s,speed_mps,speed_starboard_mps\n" + "".join(f"{t},0.3,0\n" for t in range(0, 400)))
    data = {
        "run": {"duration_h": 0.1},
        "reference": {"kind": "file", "file": str(log), "frame": "body"},
        "method": [{"damping": "external", "network": {"id": "classic2"}}],
    }
    scenario = Scenario.parse(data)
    assert active_sources(scenario) == ("recorded log",)
    (method,) = apart(scenario, simulate(scenario))
    assert method.contributions[0].rms == pytest.approx(method.whole)


def test_cancel_leaves_out_what_has_not_run():
    scenario = Scenario.parse(SCENARIO)
    whole = simulate(scenario)
    asked = iter([False, False, False, True])
    (free, _) = apart(scenario, whole, cancelled=lambda: next(asked, True))
    assert len(free.contributions) < len(ALL)


def test_an_unchanged_method_is_not_run_apart_again(monkeypatch: pytest.MonkeyPatch):
    from navcore.studies import sources

    scenario = Scenario.parse(SCENARIO | {"run": {"duration_h": 2.5, "step_s": 5.0}})
    ran: list[str] = []
    made = sources.Alone

    def noted(one: Scenario, method: Method):
        ran.append(method.name)
        return made(one, method)

    monkeypatch.setattr(sources, "Alone", noted)
    first = apart(scenario, simulate(scenario))
    assert ran == ["free", "damped"]
    data = scenario.canonical()
    data["method"][1]["network"] = {"id": "compass"}
    moved = Scenario.parse(data)
    ran.clear()
    second = apart(moved, simulate(moved))
    assert ran == ["damped"]
    assert (
        [c.source for c in second[1].contributions] == [c.source for c in first[1].contributions] == list(ALL)
    )
    for old, new in zip(first[0].contributions, second[0].contributions, strict=True):
        assert np.array_equal(old.rms, new.rms)
    sources._apart.clear()
    afresh = apart(moved, simulate(moved))
    for one, other in zip(afresh, second, strict=True):
        assert all(
            np.array_equal(a.rms, b.rms) for a, b in zip(one.contributions, other.contributions, strict=True)
        )
