"""Sweeps: curves that go through the scenario's own run, what is not varied, and the picture of them."""

import math

import pytest

from navcore.engine.measures import measure
from navcore.engine.simulation import simulate
from navcore.quantities import limit_unit
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from navcore.study.model import OF_RUNS
from navcore.study.sweep import KEYS, sweep
from schuler_bench.jobs.sweeps import Sweeper
from schuler_bench.plots.style import places
from schuler_bench.views.sweep.figure import refusals, sweep_figure

_SHORT = ["run.duration_h=0.2", "reference.noise_mps=0.1", "imu.gyro_arw_dpsh=0.01"]


@pytest.fixture(scope="module")
def ship() -> Scenario:
    """A ship on legs, with errors of gyros and log."""
    return load("sikuliaq-like", _SHORT)


@pytest.mark.parametrize("key", KEYS)
def test_a_sweep_goes_through_the_scenarios_own_run(ship: Scenario, key: str) -> None:
    found = sweep(ship, key)
    assert found is not None and found.metrics is not None
    assert list(found.values) == sorted(found.values) and len(found.values) >= 4
    at, run = found.values.index(found.present), simulate(ship)
    for metric in OF_RUNS:
        here = [values[at] for values in found.metrics[metric]]
        own = [measure(method, metric, 0.0) / limit_unit(metric) for method in run.methods]
        assert here == [value if math.isfinite(value) else None for value in own]
        assert all(None not in values for values in found.metrics[metric]) or not all(map(math.isfinite, own))
    tilts = found.metrics["tilt_rms_arcsec"]
    assert any(len({*values}) > 1 for values in tilts)  # it acts


def test_the_log_error_keeps_its_direction_and_the_grade_scales_every_error(ship: Scenario) -> None:
    bias = ship.model_copy(update={"reference": ship.reference.model_copy(update={"bias_mps": (0.3, -0.4)})})
    found = sweep(bias, "log_bias")
    assert found is not None and found.present == 0.5 and found.metrics is not None
    other = simulate(load("sikuliaq-like", [*_SHORT, "reference.bias_mps=[0.6,-0.8]"]))
    mine = [values[found.values.index(1.0)] for values in found.metrics["velocity_rms_mps"]]
    assert mine == pytest.approx([measure(m, "velocity_rms_mps", 0.0) for m in other.methods], rel=1e-12)
    grades = sweep(ship, "grade")
    assert grades is not None and grades.metrics is not None
    sizes = [f"imu.{name}=[{', '.join(str(10 * x) for x in getattr(ship.imu, name))}]"
             for name in ("gyro_bias_dph", "accel_bias_ug")]  # fmt: skip
    noise = ("gyro_arw_dpsh", "accel_vrw_ugpshz", "gyro_instability_dph", "accel_instability_ug")
    sizes += [f"imu.{name}={10 * getattr(ship.imu, name)}" for name in noise]
    worse = simulate(load("sikuliaq-like", [*_SHORT, *sizes]))
    mine = [values[-1] for values in grades.metrics["tilt_rms_arcsec"]]
    want = [measure(m, "tilt_rms_arcsec", 0.0) / limit_unit("tilt_rms_arcsec") for m in worse.methods]
    assert mine == pytest.approx(want, rel=1e-9)


@pytest.mark.parametrize(
    ("preset", "key", "words"),
    [
        ("sikuliaq-recorded", "latitude", "the recording has a latitude of its own"),
        ("zhao-turntable", "log_bias", "the scenario has no simulated log"),
        ("zhao-turntable", "sea", 'the motion "swing" knows no waves'),
    ],
)
def test_what_cannot_be_varied_says_why(preset: str, key: str, words: str) -> None:
    found = sweep(load(preset), key)
    assert found is not None and found.metrics is None and found.words == words


def test_a_setting_that_is_refused_is_a_gap(ship: Scenario) -> None:
    # true states every second are too few for the pitch of a ship in waves
    found = sweep(load("sikuliaq-like", [*_SHORT, "run.step_s=2"]), "sea")
    assert found is not None and found.metrics is not None
    for calm, *rough in found.metrics["tilt_rms_arcsec"]:
        assert calm is not None and rough == [None] * 4
    named = sweep_figure({"sea": found}, "tilt_rms_arcsec", places(m.name for m in ship.method))
    assert any("12 runs without a value" in str(note["text"]) for note in named["layout"]["annotations"])


def test_a_value_out_of_range_is_told_in_full_beside_the_plots() -> None:
    found = sweep(load("sikuliaq-like", [*_SHORT, "motion.pitch_deg=70"]), "sea")
    assert found is not None and found.metrics is None
    told = refusals({"sea": found})
    assert len(told) == 1 and "sea state is not varied" in told[0] and "height_m = 6.0" in told[0]
    shown = sweep_figure({"sea": found}, "tilt_rms_arcsec", {"free": 0})["layout"]["annotations"]
    assert "not varied" in [str(note["text"]) for note in shown]


def test_a_sweep_that_is_stopped_gives_nothing(ship: Scenario) -> None:
    seen: list[float] = []
    assert sweep(ship, "latitude", seen.append, lambda: len(seen) >= 2) is None
    assert 2 <= len(seen) < 7 and seen == sorted(seen)


def test_the_picture_has_a_curve_a_method_and_a_line_at_the_present_value(ship: Scenario) -> None:
    found = {key: sweep(ship, key) for key in ("latitude", "grade")}
    names = [method.name for method in ship.method]
    known = {key: one for key, one in found.items() if one is not None}
    picture = sweep_figure(known, "velocity_max_mps", places(names))
    curves = [trace for trace in picture["data"] if "name" in trace]
    assert [trace["name"] for trace in curves] == [*names, *names]
    assert [bool(trace["showlegend"]) for trace in curves] == [True] * 3 + [False] * 3
    metrics = known["latitude"].metrics
    assert metrics is not None
    assert curves[1]["y"] == list(metrics["velocity_max_mps"][1])
    lines = [shape["x0"] for shape in picture["layout"]["shapes"]]
    assert lines == [ship.site.lat_deg, 1.0]


def test_an_empty_plot_keeps_its_place() -> None:
    data = sweep_figure({}, "tilt_rms_arcsec", {"free": 0})["data"]
    assert [trace["xaxis"] for trace in data] == ["x", "x2", "x3", "x4"]


def test_one_quantity_after_the_other_is_shown_and_a_change_makes_them_old(
    ship: Scenario,
) -> None:
    seen: list[tuple[str, ...]] = []
    sweeper = Sweeper(lambda: seen.append((*sweeper.known,)))
    try:
        sweeper.sweep(ship)
        assert sweeper.wait_idle(60.0)
        while sweeper.under_way is not None:
            assert sweeper.wait_idle(60.0)
        assert [(*sweeper.known,)] == [KEYS]
        assert {KEYS[:k] for k in range(1, 5)} <= {*seen}
        assert sweeper.fits(ship.model_copy(update={"title": "another"}))
        assert not sweeper.fits(load("sikuliaq-like", [*_SHORT, "site.lat_deg=10"]))
    finally:
        sweeper.stop()
