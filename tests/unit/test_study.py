"""Studies: which runs they are, and rows that equal single runs."""

import math
from typing import Any

import numpy as np
import pytest
import tomlkit
from scipy.stats import norm, qmc

import navcore.engine.ensemble
import navcore.sensors.imu
import navcore.sensors.simulated_log
from navcore.engine.measures import metrics
from navcore.engine.simulation import simulate
from navcore.scenario.file import load as load_scenario
from navcore.scenario.model import Scenario
from navcore.study.file import load, to_toml
from navcore.study.model import Factor, Sample
from navcore.study.plan import Plan
from navcore.study.running import run_points
from navcore.study.sampling import drawn_value, unit_point
from tests.studies import LATITUDE, NOISE, SHIP, plan, write


def rows_of(made: Plan) -> list[dict[str, Any]]:
    """All rows, without a folder."""
    return [row for _, rows in run_points(made, range(made.runs), lambda: False) for row in rows]


# ---------------------------------------------------------------- which runs


def test_grid_draws_and_seeds_are_combined(tmp_path):
    made = plan(tmp_path, factor=[LATITUDE, NOISE], seeds=3, sample={"points": 4})
    assert made.runs == 2 * 4 * 3
    points = [made.at(number) for number in range(made.runs)]
    assert len({*points}) == made.runs
    scenarios = [made.seeded(made.scenario_of(setting), seed) for setting, seed in points]
    assert {(s.site.lat_deg, s.run.seed) for s in scenarios} == {(a, b) for a in (10, 45) for b in (7, 8, 9)}
    drawn = sorted({s.imu.gyro_arw_dpsh for s in scenarios})
    unit = qmc.Sobol(1, bits=31, rng=1).random(4)[:, 0]
    assert drawn == pytest.approx(sorted(0.001 + 0.009 * unit), rel=1e-12)
    # truth slowest, then the seed, then what changes sensors alone
    assert [(s.site.lat_deg, s.run.seed) for s in scenarios[3:9:4]] == [(10, 7), (10, 8)]
    assert [s.site.lat_deg for s in scenarios] == [10] * 12 + [45] * 12


def test_several_fields_go_together(tmp_path):
    sea = {"field": ["imu.gyro_arw_dpsh", "reference.noise_mps"], "values": [[0.001, 0.05], [0.002, 0.2]]}
    made = plan(tmp_path, factor=[{**sea, "name": "sea", "labels": ["calm", "rough"]}])
    found = [(s.imu.gyro_arw_dpsh, s.reference.noise_mps) for s in map(made.scenario_of, [(0, 0), (0, 1)])]
    assert found == [(0.001, 0.05), (0.002, 0.2)]
    assert [made.values((0, k)) for k in (0, 1)] == [{"sea": "calm"}, {"sea": "rough"}]


def test_a_factor_of_the_network_leaves_the_methods_name(tmp_path):
    made = plan(tmp_path, factor=[{"field": "method.1.network.id", "values": ["unity2", "pole2"]}])
    assert {made.scenario_of((0, k)).method[1].name for k in (0, 1)} == {made.scenario.method[1].name}
    assert made.scenario_of((0, 1)).method[1].network.id == "pole2"


@pytest.mark.parametrize("method", ["random", "latin_hypercube", "sobol"])
def test_points_do_not_depend_on_which_were_asked_before(method):
    sample = Sample(method=method, points=3000, seed=5)
    ours = np.array([unit_point(sample, 3, k) for k in (2999, 0, 1024, 7)])
    whole = {
        "random": lambda: np.random.Generator(np.random.PCG64(5)).random((3000, 3)),
        "latin_hypercube": lambda: qmc.LatinHypercube(3, rng=5).random(3000),
        "sobol": lambda: qmc.Sobol(3, bits=31, rng=5).random(4096),
    }[method]()
    np.testing.assert_array_equal(ours, whole[[2999, 0, 1024, 7]])


def test_distributions():
    logarithmic = Factor(field="a", distribution="log_uniform", low=0.01, high=1.0)
    assert drawn_value(logarithmic, 0.5) == pytest.approx(0.1)
    normal = Factor(field="a", distribution="normal", mean=3.0, deviation=2.0)
    assert drawn_value(normal, 0.9) == pytest.approx(norm.ppf(0.9, 3.0, 2.0))
    cut = normal.model_copy(update={"low": 3.0, "high": 5.0})
    assert [drawn_value(cut, part) for part in (0.0, 1.0)] == pytest.approx([3.0, 5.0])
    middle = 0.5 * (norm.cdf(3.0, 3.0, 2.0) + norm.cdf(5.0, 3.0, 2.0))
    assert drawn_value(cut, 0.5) == pytest.approx(norm.ppf(middle, 3.0, 2.0))


def test_the_written_study_is_the_study(tmp_path):
    path = write(
        tmp_path / "a.toml", factor=[LATITUDE, NOISE], set=["run.seed=3"], output={"metrics": ["h0"]}
    )
    (tmp_path / "b.toml").write_text(to_toml(load(path)))
    assert load(str(tmp_path / "b.toml")) == load(path)


# ---------------------------------------------------------------- rows


@pytest.mark.parametrize("output", [{}, {"metrics": ["position_final_m", "damping_ratio", "growth_per_s"]}])
def test_a_row_equals_the_run_of_the_same_setting(tmp_path, output):
    made = plan(tmp_path, factor=[LATITUDE, NOISE], seeds=2, sample={"points": 2}, output=output)
    rows = rows_of(made)
    assert len(rows) == 2 * made.runs
    path = tmp_path / "ship.toml"
    path.write_text(tomlkit.dumps(SHIP))
    for row, other in zip(rows[0::2], rows[1::2], strict=True):
        given = [f"{field}={row[field]!r}" for field in ("site.lat_deg", "imu.gyro_arw_dpsh")]
        run = simulate(load_scenario(str(path), [*given, f"run.seed={row['seed']}"]))
        for one, method in zip((row, other), metrics(run)["methods"], strict=True):
            (limit,) = method["requirements"]
            assert one["method"] == method["name"] and one["status"] == "ok"
            assert one["position_final_m"] == method["errors"]["position_m"]["final"]
            assert (one["requirement_0"], one["met"]) == (limit["value"], limit["met"])
            if output:
                assert one["damping_ratio"] == method["loop"]["damping_ratio"]
                assert one["growth_per_s"] == method["loop"]["growth_per_s"]
            else:
                assert one["position_max_m"] == method["errors"]["position_m"]["max_abs"]
                assert one["heading_max_arcmin"] == method["errors"]["phi_u_rad"]["max_abs"] / (
                    math.pi / 10800
                )


def test_series_are_the_output_rows(tmp_path):
    output = {"series": ["phi_e_rad", "position_m"], "epochs_h": [0.25, 0.5]}
    rows = rows_of(plan(tmp_path, seeds=2, output=output))
    run = simulate(Scenario.parse({**SHIP, "run": {"duration_h": 0.5, "seed": 8}}))
    for row, method in zip(rows[2:], run.methods, strict=True):
        place = method.t_s.tolist().index(900.0)
        assert row["phi_e_rad@0.25h"] == method.rows[place, 0]
        assert row["position_m@0.5h"] == method.rows[-1, 7]


def test_strapdown_seeds_side_by_side_are_the_single_runs(tmp_path):
    scenario = {**SHIP, "run": {"duration_h": 0.05, "fidelity": "strapdown", "rate_hz": 20.0}}
    made = plan(tmp_path, scenario=scenario, factor=[LATITUDE], seeds=3)
    rows = rows_of(made)
    assert [row["seed"] for row in rows] == [1, 1, 2, 2, 3, 3] * 2
    single = simulate(made.seeded(made.scenario_of((0, 1)), 2)).methods
    for row, method in zip(rows[-2:], single, strict=True):
        assert row["position_final_m"] == pytest.approx(method.errors["position_m"]["final"], rel=1e-6)
    halves = [*run_points(made, [4], lambda: False), *run_points(made, [5], lambda: False)]
    assert [row for _, some in halves for row in some] == rows[-4:]


def test_constants_are_those_of_design(tmp_path):
    made = plan(tmp_path, seeds=2, constants=True)
    run = simulate(navcore.engine.ensemble.drawn(made.scenario, 1))
    assert run.scenario.imu.gyro_bias_dph != (0.01, 0.02, 0.0)
    rows = rows_of(made)[2:]
    assert [row["position_final_m"] for row in rows] == [m.errors["position_m"]["final"] for m in run.methods]


def test_a_run_that_diverges_and_a_refused_setting_are_results(tmp_path):
    bias = {"field": "imu.gyro_bias_dph.1", "values": [0.02, 20000.0]}
    rows = rows_of(plan(tmp_path, factor=[bias]))
    assert [row["status"] for row in rows] == ["ok", "ok", "diverged", "diverged"]
    assert rows[2]["position_final_m"] is None and not rows[2]["met"]
    # each value is allowed with the first of the other
    pair = [
        {"field": "reference.kind", "values": ["log", "none"]},
        {"field": "method.1.damping", "values": ["free", "external"]},
    ]
    made = plan(tmp_path, factor=pair)
    found = {(r["reference.kind"], r["method.1.damping"]): (r["status"], r["reason"]) for r in rows_of(made)}
    assert found["log", "external"] == ("ok", None) and found["none", "free"] == ("ok", None)
    status, reason = found["none", "external"]
    assert status == "refused" and "method.1" in reason


def test_methods_that_come_out_the_same_are_not_run_again(tmp_path, monkeypatch):
    began = []
    carried_out = navcore.engine.ensemble.carried_out
    monkeypatch.setattr(
        navcore.engine.ensemble, "carried_out", lambda s, m, *a: began.append(m.name) or carried_out(s, m, *a)
    )
    zeta = {"field": "method.1.network.zeta", "values": [0.3, 0.5, 0.7]}
    rows_of(plan(tmp_path, factor=[zeta], seeds=2))
    assert [began.count(name) for name in dict.fromkeys(began)] == [2, 6]


def test_seeds_share_what_follows_from_the_truth(tmp_path, monkeypatch):
    made = []
    for module, name in (
        (navcore.sensors.simulated_log, "horizontal_state"),
        (navcore.sensors.imu, "_mean_attitude"),
    ):
        real = getattr(module, name)
        monkeypatch.setattr(module, name, lambda *a, real=real, name=name: made.append(name) or real(*a))
    legs = {"kind": "legs", "leg": [{"duration_s": 1801.5, "speed_mps": 6.25, "turn_dps": 0.03}]}
    log = {**SHIP["reference"], "frame": "body", "delay_s": 0.75}
    rows = rows_of(plan(tmp_path, scenario={**SHIP, "motion": legs, "reference": log}, seeds=4))
    assert len({row["position_final_m"] for row in rows}) == len(rows)
    assert sorted(made) == ["_mean_attitude", "horizontal_state", "horizontal_state"]
