"""The worst log: what is stated of it is what a run under it shows, and no other log is worse."""

import json
import math
from contextlib import closing
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import linprog
from scipy.sparse import eye, vstack

from navcore import load, parse_network, run, tune
from navcore.analysis.report import network_report
from navcore.analysis.transfers import time_response
from navcore.analysis.worst_step import worst_step
from navcore.design.worst.bounded import worst
from navcore.design.worst.logs import steps
from navcore.design.worst.played import silent
from navcore.design.worst.rate import _solved, worst_within_rate
from navcore.design.worst.result import Worst
from navcore.design.worst.searched import Player
from navcore.design.worst.written import FILE_KEYS, files_of, names_of
from navcore.foundation.earth import SPHERE
from navcore.foundation.errors import InputError
from navcore.foundation.units import ARCSEC
from navcore.quantities import COMPONENTS
from navcore.questions.worst import WorstQuestion
from navcore.scenario.model import Scenario
from schuler_bench.cli import main
from schuler_bench.session.session import Session
from schuler_bench.shell.opening import Opening

CLASSIC2: dict[str, Any] = {"name": "classic2", "damping": "external", "network": {"id": "classic2"}}
TURNING: dict[str, Any] = {
    "kind": "legs",
    "leg": [
        {"duration_s": 2400.0, "speed_mps": 6.0, "heading_deg": 20.0},
        {"duration_s": 100.0, "turn_dps": 1.2},
        {"duration_s": 9000.0},
    ],
}


def scenario_of(*methods: dict[str, Any], **blocks: Any) -> Scenario:
    run = {"fidelity": "error_model", "duration_h": 3.0, **blocks.pop("run", {})}
    log = {"kind": "log", "noise_mps": 0.3, **blocks.pop("reference", {})}
    errors = {"gyro_bias_dph": [0.02, 0.02, 0.02], "accel_bias_ug": [50.0, 50.0, 0.0]}
    data = {"schema": 1, "run": run, "imu": errors, "reference": log, "method": list(methods), **blocks}
    return Scenario.parse(data)


def played(found: Worst, folder: Path) -> dict[str, np.ndarray]:
    """Largest errors of a run under each log that is written, by method."""
    for name, text in files_of(found.scenario, found.logs, found.playable):
        (folder / name).write_text(text)
    shown = {}
    for place, method in enumerate(found.methods):
        paths = [next(iter(folder.glob(f"{place + 1}-*-{key}.toml")), None) for key in FILE_KEYS]
        if all(paths):
            ran = [run(load(str(path))).run.methods[0].errors for path in paths]
            pairs = zip(ran, COMPONENTS, strict=True)
            shown[method.name] = np.array([errors[name]["max_abs"] for errors, name in pairs])
    return shown


@pytest.mark.parametrize("rate", [None, 0.001])
@pytest.mark.parametrize("frame", ["enu", "body"])
def test_the_log_that_is_written_does_what_is_stated(rate: float | None, frame: str, tmp_path: Path) -> None:
    optimal = {"name": "optimal", "damping": "external", "network": {"id": "optimal", "rho": 0.01}}
    scenario = scenario_of(CLASSIC2, optimal, motion=TURNING, reference={"frame": frame, "rate_hz": 0.5})
    found = worst(scenario, 0.8, rate)
    shown = played(found, tmp_path)
    assert [*shown] == ["classic2", "optimal"]
    for method in found.methods:
        np.testing.assert_allclose(shown[method.name], method.largest, rtol=1e-3)


def test_outages_and_a_moored_ship_are_in_the_worst_case(tmp_path: Path) -> None:
    motion = {"kind": "legs", "leg": [{"duration_s": 3000.0}, {"duration_s": 9000.0, "speed_mps": 4.0}]}
    log = {"outage": [{"t_h": 2.0, "duration_s": 700.0}], "zero_below_mps": 0.5}
    scenario = scenario_of(CLASSIC2, motion=motion, reference=log)
    found = worst(scenario, 1.0)
    np.testing.assert_allclose(played(found, tmp_path)["classic2"], found.methods[0].largest, rtol=1e-3)


def test_the_full_mechanization_shows_it_within_one_percent(tmp_path: Path) -> None:
    scenario = scenario_of(CLASSIC2, run={"fidelity": "strapdown", "duration_h": 2.0, "rate_hz": 10.0})
    found = worst(scenario, 1.0)
    np.testing.assert_allclose(played(found, tmp_path)["classic2"], found.methods[0].largest, rtol=1e-2)


def test_no_random_log_is_worse_than_an_exact_bound() -> None:
    scenario = scenario_of(CLASSIC2, motion=TURNING, reference={"frame": "body"})
    found = worst(scenario, 1.0).methods[0]
    quiet = silent(scenario)
    player, generator = Player(quiet, quiet.method[0], scenario), np.random.default_rng(1)
    for _ in range(20):
        wave = np.cumsum(generator.normal(size=(len(player.time_s), 2)), axis=0)
        assert (player.largest(np.sign(wave - wave.mean(axis=0))) <= found.largest * 1.0001).all()


def test_a_bound_on_the_rate_is_the_linear_program_over_all_samples() -> None:
    omega_s = SPHERE.schuler_frequency(0.0)
    network = parse_network('id = "complementary", zeta = 0.5, eta = 0.5').transfer(omega_s)
    time_s = np.arange(0.0, 6.0 * 3600.0 + 1.0, 15.0)
    weights = np.diff(time_response(network, "dv_r", "phi", time_s))[::-1] / ARCSEC
    count = len(weights)
    change = eye(count - 1, count, 1, format="csr") - eye(count - 1, count, format="csr")
    for rate in (0.01, 0.001, 0.0003):
        allowed = np.full(2 * (count - 1), rate * 15.0)
        best = -linprog(-weights, A_ub=vstack([change, -change]), b_ub=allowed, bounds=(-1.0, 1.0)).fun
        nodes = worst_within_rate(weights, time_s[:-1], rate)
        error = np.interp(time_s[:-1], *nodes)
        assert np.abs(error).max() <= 1.0 and np.abs(np.diff(error)).max() <= rate * 15.0 * (1.0 + 1e-9)
        assert float(weights @ error) == pytest.approx(best, rel=2e-3)


@pytest.mark.parametrize("seed", range(40))
def test_from_node_to_node_it_is_solved_as_by_a_general_solver(seed: int) -> None:
    generator = np.random.default_rng(seed)
    count, rate = int(generator.integers(2, 60)), float(10.0 ** generator.uniform(-3.0, 1.0))
    time_s = np.cumsum(generator.uniform(0.1, 3.0, count))
    weights = generator.normal(size=count) * (generator.random(count) < 0.8)
    weights = np.cumsum(weights) if seed % 2 else weights
    found = _solved(weights, time_s, rate)
    step = rate * np.diff(time_s)
    assert np.abs(found).max() <= 1.0 and (np.abs(np.diff(found)) <= step + 1e-12).all()
    change = eye(count - 1, count, 1, format="csr") - eye(count - 1, count, format="csr")
    rows, allowed = vstack([change, -change]), np.tile(step, 2)
    best = -linprog(-weights, A_ub=rows, b_ub=allowed, bounds=(-1.0, 1.0)).fun
    assert weights @ found == pytest.approx(best, rel=1e-9, abs=1e-12)


def test_a_policy_is_searched_and_shows_what_was_found(tmp_path: Path) -> None:
    threshold = {**CLASSIC2, "name": "threshold", "policy": {"id": "threshold", "limit_mps": 0.4}}
    free = {"name": "free"}
    scenario = scenario_of(free, threshold, CLASSIC2, run={"duration_h": 2.0, "step_s": 5.0})
    found = worst(scenario, 1.0)
    assert [one.bound for one in found.methods] == ["exact", "found", "exact"]
    assert not found.methods[0].largest.any()
    shown = played(found, tmp_path)
    np.testing.assert_allclose(shown["threshold"], found.methods[1].largest, rtol=1e-9)
    # as long as it is within the limit the law is the linear one: a smaller log must do at least as much
    within = worst(scenario, 0.4 / math.sqrt(2.0)).methods[2].largest
    assert (found.methods[1].largest > 0.99 * within).all()


def test_a_search_that_is_stopped_says_so() -> None:
    threshold = {**CLASSIC2, "policy": {"id": "threshold"}}
    calls = iter([False] * 4 + [True] * 1000)
    found = worst(scenario_of(threshold, run={"duration_h": 0.5}), 1.0, cancelled=lambda: next(calls))
    assert not found.complete and 0 < found.methods[0].runs < 10


def test_a_loop_that_grows_beyond_the_model_has_no_bound() -> None:
    fast = {**CLASSIC2, "network": {"id": "compass", "sigma": 0.0088, "xi": 0.7}}
    scenario = scenario_of(fast, run={"duration_h": 24.0}, reference={"rate_hz": 0.002})
    found = worst(scenario, 1.0)
    assert found.failed and found.document()["methods"][0]["tilt_rad"] == [None, None]
    assert [*files_of(found.scenario, found.logs, found.playable)] == []


def test_levels_are_reached_within_the_rate() -> None:
    times, errors = steps(np.array([0.0, 100.0, 130.0]), np.array([1.0, -1.0, 1.0]), 0.01)
    np.testing.assert_allclose(np.interp([50.0, 130.0, 160.0, 500.0], times, errors), [1.0, 0.7, 1.0, 1.0])


def test_one_channel_has_no_bound_without_damping() -> None:
    growing = network_report(parse_network('id = "custom", zeros = [0.5], poles = [-0.5], gain = -1.0'))
    assert growing["worst_tilt_rad_per_mps"] is None and growing["worst_velocity_per_mps"] is None
    free = network_report(parse_network('id = "none"'))
    assert free["worst_tilt_rad_per_mps"] == free["worst_velocity_per_mps"] == 0.0
    lightly = parse_network('id = "unity2", zeta = 0.05, r = 1.01').transfer(SPHERE.schuler_frequency(0.0))
    time_s = np.linspace(0.0, 30.0 * 86400.0, 400_001)
    variation = np.abs(np.diff(time_response(lightly, "dv_r", "dv", time_s))).sum()
    assert worst_step(lightly).velocity_mps == pytest.approx(variation, rel=1e-3)


@pytest.mark.parametrize(
    ("field", "value", "range"),
    [
        ("log_max", 0.0, ">= 1e-06 and <= 50 (m/s)"),
        ("log_max", math.inf, "finite"),
        ("log_max", math.nan, "finite"),
        ("log_rate", -0.1, ">= 1e-09 and <= 50 (m/s²)"),
        ("log_rate", 0.0, ">= 1e-09 and <= 50 (m/s²)"),
        ("log_rate", math.inf, "finite"),
    ],
)
def test_a_bound_out_of_range_is_refused(field: str, value: float, range: str) -> None:
    with pytest.raises(InputError) as error:
        WorstQuestion.ask({"scenario": "zha-fast", "log_max": 1.0, field: value})
    (fault,) = error.value.faults
    assert fault.field == f"--{field.replace('_', '-')}" and range in fault.allowed
    assert fault.value == value or math.isnan(value)


def test_the_command_prints_and_writes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    asked = ["worst", "zha-fast", "--log-max", "0.5", "--set", "run.duration_h=1", "--json", "--quiet"]
    assert main([*asked, "--out", str(out)]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["log_max_mps"] == 0.5 and document["log_rate_mps2"] is None
    assert document["horizon_h"] == 1.0
    assert [one["name"] for one in document["methods"]] == ["free", "classic2", "fast (compass)"]
    assert {*document["methods"][1]} >= {"name", "bound", "tilt_rad", "heading_rad", "velocity_mps", "lat_m"}
    written = sorted(path.name for path in out.iterdir())
    assert written == sorted(n for n in names_of(load("zha-fast")) if not n.startswith("1-free"))


def test_a_limit_can_be_on_the_worst_case_and_tune_makes_it_small() -> None:
    limit = {"quantity": "worst_tilt", "at_most": 60.0}
    scenario = scenario_of(CLASSIC2, {"name": "free"}, requirement=[limit])
    first, free = (one["requirements"][0] for one in run(scenario).document()["methods"])
    assert first["value"] == pytest.approx(68.6, rel=2e-2) and not first["met"]
    assert free["value"] == 0.0 and free["met"]
    pole2 = scenario_of({**CLASSIC2, "network": {"id": "complementary", "zeta": 0.5, "eta": 0.5}})
    found = tune(pole2, "worst_tilt", ["method.0.network.zeta=0.2:1"], confirm=False)
    assert found.document()["objective"] < 0.999 * found.document()["before"]


def test_a_page_plays_the_log_of_an_answer_and_undoes_it(tmp_path: Path) -> None:
    scenario = scenario_of(CLASSIC2, {"name": "free"}, run={"duration_h": 1.0})
    found = worst(scenario, 1.0)
    assert found.plays()[:2] == ("classic2: tilt φE", "classic2: tilt φN") and len(found.plays()) == 7
    with closing(Session("a" * 22, scenario, "zha-fast", tmp_path)) as session:
        opening = Opening(SimpleNamespace(), session, lambda: None)  # pyright: ignore[reportArgumentType]
        opening.play(found.played(3), found.plays()[3])
        assert session.wait_idle(60.0) and session.run is not None
        (method,) = session.run.methods
        assert session.scenario.reference.kind == "file" and method.method.name == "classic2"
        assert method.errors["dve_mps"]["max_abs"] == pytest.approx(found.methods[0].largest[3], rel=1e-3)
        assert session.undo() and session.scenario == scenario
