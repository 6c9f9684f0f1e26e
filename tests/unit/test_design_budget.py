"""The error budget: model from a scenario, steady state, growth, along a run, seeds, floor, faults."""

import json
import math
from typing import Any

import numpy as np
import pytest

from navcore.design.budget import budget
from navcore.design.course import course
from navcore.design.seeds import no_covariance
from navcore.engine.simulation import simulate
from navcore.foundation.units import ARCMIN, DEG_PER_HOUR, MICRO_G
from navcore.scenario.model import Scenario
from navcore.scenario.stochastic import RANDOM_SOURCES, stochastic_model
from schuler_bench.cli import main

IMU = {
    "gyro_arw_dpsh": 0.003,
    "gyro_instability_dph": 0.003,
    "accel_vrw_ugpshz": 10.0,
    "accel_instability_ug": 10.0,
}
LOG = {"kind": "log", "noise_mps": 0.2, "drift_mps": 0.1}
TURNS = {
    "kind": "legs",
    "leg": [
        {"duration_s": 1800.0, "speed_kn": 10.0, "heading_deg": 30.0},
        {"duration_s": 90.0, "turn_dps": 1.0},
        {"duration_s": 5400.0},
    ],
}


def scenario(**blocks: Any) -> Scenario:
    """Noisy scenario of two hours with one method unless blocks say otherwise."""
    whole: dict[str, Any] = {
        "run": {"duration_h": 2.0, "output_step_s": 60.0},
        "imu": IMU,
        "reference": LOG,
        "method": [{"damping": "external", "network": {"id": "classic2"}}],
    }
    return Scenario.parse({**whole, **blocks})


def test_a_number_counts_as_its_own_standard_deviation_unless_one_is_given() -> None:
    """Biases, initial errors, log bias."""
    given = {"gyro_bias_dph": [-0.01, 0.0, 0.02], "accel_bias_ug": [50.0, -20.0, 0.0]}
    start = {"attitude_arcmin": [-1.0, 0.0, 3.0], "velocity_mps": [0.1, -0.2]}
    model = stochastic_model(scenario(imu=given, initial_error=start))
    assert model.gyro_bias == pytest.approx(np.array([0.01, 0.0, 0.02]) * DEG_PER_HOUR)
    assert model.initial == pytest.approx([0.1, 0.2, 0.0, 0.0, ARCMIN, 0.0, 3.0 * ARCMIN])
    stated = stochastic_model(
        scenario(
            imu={**given, "gyro_bias_std_dph": 0.005, "accel_bias_std_ug": 30.0},
            reference={**LOG, "bias_mps": [0.5, 0.0], "bias_std_mps": 0.1},
            initial_error={
                **start,
                "level_std_arcmin": 0.5,
                "heading_std_arcmin": 2.0,
                "velocity_std_mps": 0.0,
            },
        )
    )
    assert stated.gyro_bias == pytest.approx(0.005 * DEG_PER_HOUR)
    assert stated.accel_bias == pytest.approx(30.0 * MICRO_G)
    assert stated.log_bias == pytest.approx(0.1)
    assert stated.initial == pytest.approx([0.0, 0.0, 0.0, 0.0, 0.5 * ARCMIN, 0.5 * ARCMIN, 2.0 * ARCMIN])


def test_standard_deviations_do_not_change_a_run() -> None:
    """They are for the budget only."""
    plain, stated = scenario(), scenario(imu={**IMU, "gyro_bias_std_dph": 0.01})
    assert np.array_equal(simulate(plain).methods[0].rows, simulate(stated).methods[0].rows)
    heading = [budget(s).methods[0].sources.get("gyro_bias") for s in (plain, stated)]
    assert heading[0] is None and heading[1] is not None


def test_a_free_loop_has_no_steady_state_but_a_growth() -> None:
    """ARW N drives phi = sqrt(N^2 t / 2) on average; the run agrees after many periods."""
    free = scenario(
        run={"duration_h": 40.0, "output_step_s": 600.0, "fidelity": "channel", "earth": "sphere"},
        imu={"gyro_arw_dpsh": 0.01},
        method=[{"damping": "free"}],
    )
    method = budget(free, steady=True).methods[0]
    assert method.total.rms.tilt_rad is None
    assert "no steady state" in method.warnings[0] and "gyro_white" in method.warnings[0]
    growth = method.sources["gyro_white"].growth
    assert growth is not None and growth.tilt_rad is not None
    assert growth.tilt_rad == pytest.approx(0.01 * math.pi / 180.0 / math.sqrt(2.0), rel=1e-6)
    at_end = budget(free).methods[0].sources["gyro_white"].final
    assert at_end is not None
    assert at_end.tilt_rad == pytest.approx(growth.tilt_rad * math.sqrt(40.0), rel=0.02)


def test_the_run_settles_at_the_steady_state() -> None:
    """Long after the start the covariance of the sampled loop is that of Lyapunov's equation."""
    long = scenario(
        run={"duration_h": 12.0, "output_step_s": 60.0, "fidelity": "channel", "earth": "sphere"},
        method=[
            {"damping": "external", "network": network}
            for network in ({"id": "classic2"}, {"id": "complementary"}, {"id": "compass"})
        ],
    )
    for method, steady in zip(budget(long).methods, budget(long, steady=True).methods, strict=True):
        assert method.shown == "covariance"
        for source in RANDOM_SOURCES:
            final, entry = method.sources[source].final, steady.sources[source].rms
            assert final is not None
            assert final.tilt_rad == pytest.approx(entry.tilt_rad, rel=0.01), (method.name, source)
            assert final.velocity_mps == pytest.approx(entry.velocity_mps, rel=0.01), (method.name, source)


@pytest.mark.parametrize("outage", [pytest.param(False, marks=pytest.mark.nightly), True])
def test_covariance_is_that_of_many_seeds(outage: bool) -> None:
    """Tilt, heading, velocity and position of 150 seeds along legs with a turn, all sources on."""
    rng = np.random.default_rng(7)
    gaps = [{"t_h": 1.0, "duration_s": 600.0}] if outage else []
    fixed = {"gyro_bias_std_dph": 0.004, "accel_bias_std_ug": 15.0}
    deviations = {"level_std_arcmin": 0.2, "heading_std_arcmin": 2.0, "velocity_std_mps": 0.05}
    methods = [
        {"damping": "external", "network": {"id": "classic2"}},
        {"damping": "external", "network": {"id": "compass"}},
        {"name": "free"},
    ]

    def drawn(seed: int) -> Scenario:
        return scenario(
            run={"duration_h": 2.0, "output_step_s": 600.0, "seed": seed},
            motion=TURNS,
            imu={
                **IMU,
                **fixed,
                "gyro_bias_dph": (0.004 * rng.standard_normal(3)).tolist(),
                "accel_bias_ug": (15.0 * rng.standard_normal(3)).tolist(),
            },
            reference={**LOG, "frame": "body", "outage": gaps},
            initial_error={
                **deviations,
                "attitude_arcmin": (np.array([0.2, 0.2, 2.0]) * rng.standard_normal(3)).tolist(),
                "velocity_mps": (0.05 * rng.standard_normal(2)).tolist(),
            },
            method=methods,
        )

    seeds = 150
    squares = np.zeros(1)
    for seed in range(seeds):
        squares = squares + np.stack([m.rows[:, :7] ** 2 for m in simulate(drawn(seed)).methods])
    found = budget(drawn(0))
    for k, method in enumerate(found.methods):
        series = method.series
        assert series is not None
        rows = [np.argmin(np.abs(series.t_s - t)) for t in np.arange(13) * 600.0]
        ratio = np.sqrt(squares[k][2:] / seeds / series.total[rows][2:])
        # the deviation of 150 draws is known to 5.8 %
        assert np.all(np.abs(ratio - 1.0) < 4.0 * 0.058), method.name
        assert abs(float(np.mean(ratio)) - 1.0) < 0.08, method.name


def test_the_filter_is_never_worse_than_any_method_along_a_run() -> None:
    """The floor holds for every quantity at every time, with turns, outage and a heading-turned log."""
    found = budget(
        scenario(
            motion=TURNS,
            imu={**IMU, "gyro_bias_std_dph": 0.01, "accel_bias_std_ug": 30.0},
            reference={
                **LOG,
                "frame": "body",
                "bias_std_mps": 0.05,
                "outage": [{"t_h": 1.0, "duration_s": 600.0}],
            },
            initial_error={"level_std_arcmin": 0.5, "heading_std_arcmin": 5.0, "velocity_std_mps": 0.1},
            method=[
                {"name": str(k), "damping": "external", "network": {"id": name}}
                for k, name in enumerate(("classic2", "classic3", "complementary", "unity2", "compass"))
            ],
        )
    )
    assert found.floor_series is not None
    for method in found.methods:
        assert method.series is not None
        assert np.all(method.series.total >= found.floor_series.total * (1.0 - 1e-6)), method.name


def test_a_slow_log_is_held_between_its_samples() -> None:
    """Covariance of the held difference against seeds, log each 10 s."""
    slow = {"kind": "log", "noise_mps": 0.5, "rate_hz": 0.1}
    methods = [{"damping": "external", "network": {"id": "compass"}}]
    seeds, squares = 200, np.zeros(1)
    run = {"duration_h": 0.5, "output_step_s": 300.0}
    for seed in range(seeds):
        one = scenario(run={**run, "seed": seed}, imu={}, reference=slow, method=methods)
        squares = squares + simulate(one).methods[0].rows[:, :7] ** 2
    series = budget(scenario(run=run, imu={}, reference=slow, method=methods)).methods[0].series
    assert series is not None
    rows = [int(np.argmin(np.abs(series.t_s - t))) for t in (600.0, 1200.0, 1800.0)]
    ratio = np.sqrt(squares[[2, 4, 6]] / seeds / series.total[rows])[:, [0, 1, 3, 4]]
    assert np.all(np.abs(ratio - 1.0) < 4.0 / math.sqrt(2.0 * seeds))


def test_intervals_of_a_straight_leg_share_their_matrices() -> None:
    """A constant course has few kinds of intervals, a turn has its own."""
    way = course(scenario(run={"duration_h": 2.0, "output_step_s": 10.0}, motion=TURNS))
    assert len(way.kind) == 720
    assert len(way.length) < 0.2 * len(way.kind)


@pytest.mark.parametrize(
    ("method", "reason"),
    [
        ({"policy": {"id": "variation"}}, 'policy "variation" looks at the data'),
        ({"switching": {"id": "bumpless"}}, 'switching "bumpless" acts on what was measured before'),
        ({"damping": "averaging"}, "averaging combines several navigations"),
        ({"policy": {"id": "constant"}}, ""),
    ],
)
def test_what_has_no_covariance_says_so(method: dict[str, Any], reason: str) -> None:
    """A law that looks at the data is shown by seeds."""
    one = {"damping": "external", "network": {"id": "classic2"}, **method}
    if one["damping"] == "averaging":
        del one["network"]
    found = scenario(run={"duration_h": 2.0, "output_step_s": 60.0}, method=[one])
    assert no_covariance(found, found.method[0]) == reason
    shown = budget(found, seeds=2).methods[0]
    assert shown.shown == ("seeds" if reason else "covariance")
    assert bool(shown.sources) is not bool(reason)
    assert any(reason in text for text in shown.warnings) if reason else "24 h" in shown.warnings[0]


def test_sensors_without_any_random_error_have_no_floor() -> None:
    """Said in plain words, in both kinds of budget."""
    silent = scenario(imu={"gyro_bias_dph": [0.0, 0.02, 0.0]}, reference={"kind": "log"})
    for steady in (True, False):
        found = budget(silent, steady=steady)
        assert found.floor.rms.tilt_rad is None
        assert "no random error" in found.floor_reason


def test_without_a_log_there_is_no_floor() -> None:
    """Named by its field."""
    found = budget(scenario(reference={"kind": "none"}, method=[{"damping": "free"}]))
    assert 'reference.kind = "none"' in found.floor_reason


def test_an_unstable_loop_has_no_budget() -> None:
    """Steady and along a run: a warning with the time in which it grows, and no figures."""
    unstable = {"damping": "external", "network": {"id": "custom", "num": [1.0, -0.1], "den": [1.0, 0.1]}}
    steady = budget(scenario(method=[unstable]), steady=True).methods[0]
    assert steady.total.rms.tilt_rad is None and "unstable" in steady.warnings[0]
    stable = {"damping": "external", "network": {"id": "classic2"}}
    long = {"duration_h": 400.0, "output_step_s": 3600.0}
    found = budget(scenario(run=long, method=[stable, unstable]))
    assert [method.diverged for method in found.methods] == [False, True]
    assert found.methods[1].total.rms.tilt_rad is None and "unstable" in found.methods[1].warnings[0]
    assert found.methods[0].total.rms.tilt_rad and found.document()["methods"][1]["status"] == "diverged"


@pytest.mark.parametrize("steady", [True, False])
def test_a_whole_system_that_grows_stands_in_its_budget(steady: bool) -> None:
    """`optimal` with q = 0 is at the floor of one channel; with its default it does not grow."""
    networks: list[dict[str, Any]] = [{"id": "optimal", "q": 0.0}, {"id": "optimal"}]
    methods = [{"name": str(k), "damping": "external", "network": n} for k, n in enumerate(networks)]
    found = budget(scenario(run={"duration_h": 1.0}, method=methods), steady=steady)
    greedy, default = (" ".join(map(str, method.warnings)) for method in found.methods)
    assert "the 24 h mode grows" in greedy and "grows" not in default


def test_command_prints_the_contract(capsys: pytest.CaptureFixture[str]) -> None:
    """Keys of interface.md, steady and along the scenario; text too."""
    assert main(["budget", "sikuliaq-like", "--steady", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert set(document["floor"]) >= {"tilt_rad", "velocity_mps"}
    assert {"name", "tilt_rad", "velocity_mps", "sources"} <= set(document["methods"][0])
    assert document["methods"][1]["sources"]["gyro_white"]["tilt_rad"] > 0.0
    assert main(["budget", "sikuliaq-like", "--json", "--set", "run.duration_h=1"]) == 0
    document = json.loads(capsys.readouterr().out)
    first = document["methods"][1]
    assert {"tilt_rad", "velocity_mps", "heading_rad", "position_m", "final"} <= set(first)
    assert {"heading_rad", "position_m", "final"} <= set(first["sources"]["gyro_bias"])
    random = [size for name, size in first["sources"].items() if name.endswith(("_white", "_drift"))]
    total = sum(size["tilt_rad"] ** 2 for size in (*random, first["given"]))
    assert math.sqrt(total) == pytest.approx(first["tilt_rad"], rel=1e-9)
    assert main(["budget", "sikuliaq-like", "--set", "run.duration_h=1"]) == 0
    assert "times the floor" in capsys.readouterr().out
    assert main(["budget", "no-such"]) == 2
