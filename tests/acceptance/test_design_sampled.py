"""The loop as it runs, with the log's difference held: variance and growth against values and runs."""

import json

import numpy as np
import pytest

from navcore.analysis.held_log import held_log
from navcore.design.budget import budget
from navcore.design.tune import tune
from navcore.engine.simulation import simulate
from navcore.foundation.errors import UnstableError
from navcore.foundation.units import ARCSEC
from navcore.networks import parse_network
from navcore.scenario.file import to_toml
from navcore.scenario.model import Scenario
from schuler_bench.cli import main
from tests.acceptance.test_design_values import SET_A

NETWORKS = (
    {"id": "classic2"},
    {"id": "unity2", "zeta": 0.5, "r": 1.2, "zeta2": 0.7},
    {"id": "compass", "sigma": 0.0015, "xi": 0.7},
    {"id": "compass", "sigma": 0.0088, "xi": 0.7},
)
HELD = {
    100.0: ((6.629, 0.1861), (6.519, 0.2003), (6.662, 0.1620), 7.6e-3),
    300.0: ((8.806, 0.2174), (8.146, 0.2270), (11.192, 0.3066), 1.07e-2),
    500.0: ((10.87, 0.2596), (9.707, 0.2579), 7.1e-4, 8.6e-3),
}
"""Tilt (arcsec) and velocity (m/s) of each network by the log's period (s), or its growth (1/s)."""


def slow_log(period_s: float, **more: object) -> Scenario:
    """Set A with a log of this period."""
    log = {**SET_A["reference"], "rate_hz": 1.0 / period_s}
    methods = [{"name": str(k), "damping": "external", "network": n} for k, n in enumerate(NETWORKS)]
    return Scenario.parse({**SET_A, "reference": log, "method": methods, **more})


@pytest.mark.known(
    "oracle",
    ["tilt_rms", "velocity_rms"],
    kinds=["external"],
    fidelities=["covariance"],
    source="table of an independent discrete Lyapunov equation",
)
@pytest.mark.parametrize("period_s", HELD)
def test_steady_state_with_a_held_log(period_s: float) -> None:
    """Within 0.7 % of an own discrete Lyapunov equation whose law is continuous."""
    scenario = slow_log(period_s)
    for method, expected in zip(budget(scenario, steady=True).methods, HELD[period_s], strict=True):
        total = method.total.rms
        if isinstance(expected, float):
            assert method.diverged and total.tilt_rad is None and total.velocity_mps is None
            continue
        assert (total.tilt_rad or 0.0) / ARCSEC == pytest.approx(expected[0], rel=7e-3)
        assert total.velocity_mps == pytest.approx(expected[1], rel=7e-3)


@pytest.mark.known(
    "oracle",
    ["growth_per_s"],
    kinds=["external"],
    fidelities=["loop"],
    source="table of an independent discrete Lyapunov equation",
)
@pytest.mark.parametrize("period_s", HELD)
def test_growth_of_the_whole_system_with_a_held_log(period_s: float) -> None:
    """The growths of the table to their digits, in the run's metrics and in `held_log`."""
    run = simulate(slow_log(period_s, run={"earth": "sphere", "duration_h": 0.1}))
    for method, expected in zip(run.methods, HELD[period_s], strict=True):
        assert method.growth_per_s is not None
        if isinstance(expected, float):
            assert method.growth_per_s == pytest.approx(expected, rel=0.01)
        else:
            assert abs(method.growth_per_s) < 1e-5


def test_growth_is_that_of_a_run() -> None:
    """A compass loop with a log each 100 s: the errors of a run grow at the rate of the map's eigenvalue."""
    quiet = {"kind": "log", "rate_hz": 0.01}
    start = {"attitude_arcmin": [1e-9, 1e-9, 0.0]}
    method = {"damping": "external", "network": NETWORKS[3]}
    settings = {"earth": "sphere", "duration_h": 0.8, "output_step_s": 100.0}
    run = simulate(
        Scenario.parse({"run": settings, "reference": quiet, "initial_error": start, "method": [method]})
    )
    found = run.methods[0]
    size = np.log(np.abs(found.rows[:, 3]) + np.abs(found.rows[:, 0]) * 1e4)
    assert np.polyfit(found.t_s[8:], size[8:], 1)[0] == pytest.approx(found.growth_per_s, rel=0.02)


def test_a_channel_has_the_channels_growth() -> None:
    """classic2: its 24 h mode grows, its level channel does not."""
    network = parse_network('id = "classic2"').transfer(1.24e-3)
    assert held_log(network, 1.0, 1.0, 0.8).growth_per_s > 1e-6
    assert held_log(network, 1.0, 1.0, 0.8, coupled=False).growth_per_s < -1e-4


def test_budget_of_what_diverges_has_no_numbers(tmp_path, capsys: pytest.CaptureFixture[str]) -> None:
    """Exit code 3, `status` "diverged", null; with and without --steady."""
    path = tmp_path / "slow.toml"
    path.write_text(to_toml(slow_log(100.0, run={"earth": "sphere", "duration_h": 12.0})))
    for options in (["--steady"], []):
        assert main(["budget", str(path), "--json", *options]) == 3
        methods = json.loads(capsys.readouterr().out)["methods"]
        assert [method["status"] for method in methods] == ["ok", "ok", "ok", "diverged"]
        assert methods[3]["tilt_rad"] is None and methods[3]["sources"] == {}


def test_tune_proposes_what_is_stable_as_it_runs() -> None:
    """With a log each 500 s the continuous model prefers compass settings that diverge."""
    scenario = slow_log(500.0)
    found = tune(scenario, "tilt_rms", ["method.2.network.sigma=1e-4:0.1", "method.2.network.xi=0.1:5"])
    assert not budget(found.scenario, steady=True).methods[2].diverged
    with pytest.raises(UnstableError, match="grow by e every"):
        tune(scenario, "settling_s", ["method.2.network.sigma=0.005:0.1"])


def test_biases_are_in_the_steady_budget() -> None:
    """R eps of a gyro and nabla / g of an accelerometer, in the total and apart from what is random."""
    imu = {**SET_A["imu"], "gyro_bias_dph": [0.01, 0.01, 0.0], "accel_bias_ug": [50.0, 50.0, 0.0]}
    method = budget(slow_log(1.0, imu=imu), steady=True).methods[0]
    document = method.as_dict()
    assert document["sources"]["accel_bias"]["tilt_rad"] == pytest.approx(50e-6, rel=1e-3)
    assert document["sources"]["gyro_bias"]["velocity_mps"] == pytest.approx(0.3092, rel=2e-3)
    assert document["random_tilt_rad"] / ARCSEC == pytest.approx(5.360, rel=5e-3)
    parts = [source["tilt_rad"] for source in document["sources"].values()]
    assert document["tilt_rad"] == pytest.approx(np.linalg.norm(parts), rel=1e-12)
