"""simulate(): inputs, rows, cancel, divergence; of strapdown: rates, columns, alignment, law series."""

from typing import Any

import numpy as np
import pyarrow.parquet
import pytest

from navcore.engine.results import timeseries, write_results
from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG
from navcore.mechanization.recorder import NAMES, output_steps
from navcore.mechanization.strapdown.records import NAVIGATION
from navcore.motion.truth import HEADING, LAT, VE
from navcore.scenario.file import load, presets
from navcore.scenario.model import Scenario

COMPASS = {"damping": "external", "network": {"id": "compass", "sigma": 0.0088, "xi": 0.7}}
UNSTABLE = {"damping": "external", "network": {"id": "compass", "k1": 0.001, "k2": 1.0, "k3": 0.5}}
LINEAR = {"fidelity": "error_model", "output_step_s": 1.0}
CHUNK_S = 60.0
"""A cancel is asked for after each: at 100 Hz some 2 ms for the IMU and each method."""
NOISY: dict[str, Any] = {
    "imu": {"gyro_bias_dph": [0.01, 0.02, 0.0], "gyro_arw_dpsh": 0.01, "accel_vrw_ugpshz": 20.0},
    "reference": {"kind": "log", "noise_mps": 0.2, "bias_mps": [0.1, -0.2]},
}


def scenario(hours: float = 0.2, **changes: Any) -> Scenario:
    run = {"fidelity": "strapdown", "duration_h": hours, "seed": 5} | changes.pop("run", {})
    return Scenario.parse(NOISY | {"run": run} | changes)


def run_of(hours: float = 0.2, **changes: Any) -> Run:
    return simulate(scenario(hours, **changes))


@pytest.mark.parametrize("fidelity", ["error_model", "strapdown"])
def test_order_and_company_of_methods_change_nothing(fidelity):
    fine, free = {"name": "c", **COMPASS}, {"name": "f"}
    alone, first, last = (
        run_of(run={"fidelity": fidelity}, method=methods) for methods in ([fine], [fine, free], [free, fine])
    )
    assert np.array_equal(alone.methods[0].rows, first.methods[0].rows)
    assert np.array_equal(first.methods[0].rows, last.methods[1].rows)
    assert np.array_equal(first.methods[1].rows, last.methods[0].rows)
    assert not np.array_equal(first.methods[0].rows, first.methods[1].rows)


@pytest.mark.parametrize("fidelity", ["error_model", "strapdown"])
def test_another_seed_gives_another_run(fidelity):
    one, other = (run_of(run={"fidelity": fidelity, "seed": seed}, method=[COMPASS]) for seed in (5, 6))
    assert not np.array_equal(one.methods[0].rows, other.methods[0].rows)


@pytest.mark.parametrize("fidelity", ["error_model", "strapdown"])
def test_rows_hold_start_every_output_step_and_the_end(fidelity):
    run = run_of(0.0141, run={"fidelity": fidelity, "output_step_s": 20.0})
    assert run.t_s.tolist() == [0.0, 20.0, 40.0, 50.0]
    method = run.methods[0]
    assert (method.rows.shape, method.law_series.shape, run.truth.shape) == ((4, 10), (4, 4), (4, 15))
    navigation = None if method.navigation is None else method.navigation.shape
    assert navigation == ((4, len(NAVIGATION)) if fidelity == "strapdown" else None)
    assert output_steps(7, 1.0, 0.1).tolist() == list(range(8))


@pytest.mark.parametrize("stop_at", [1, 3])
def test_a_cancel_acts_at_the_next_chunk_and_keeps_what_was_computed(stop_at):
    asked: list[int] = []

    def cancelled() -> bool:
        asked.append(1)
        return len(asked) == stop_at

    run = simulate(scenario(200.0, method=[{"name": "free"}, COMPASS]), cancelled=cancelled)
    assert len(asked) == stop_at
    assert run.status == "stopped"
    for method in run.methods:
        assert method.status == "stopped"
        assert f"stopped by the user at {stop_at * CHUNK_S:.0f} s" in method.warnings[-1]
        assert method.t_s[-1] == stop_at * CHUNK_S - 10.0 and len(method.t_s) < len(run.t_s)
        assert method.navigation is not None and len(method.navigation) == len(method.t_s)


@pytest.mark.parametrize(("fidelity", "hours", "calls"), [("error_model", 50.0, 3), ("strapdown", 0.5, 30)])
def test_progress_rises_to_one(fidelity, hours, calls):
    seen: list[float] = []
    simulate(scenario(hours, run={"fidelity": fidelity}), progress=seen.append)
    assert seen[-1] == 1.0 and seen == sorted(seen) and len(seen) >= calls


def test_a_diverging_method_says_why_and_where_and_the_others_finish(tmp_path):
    run = run_of(
        12.0, run={"rate_hz": 20.0}, method=[UNSTABLE | {"name": "bad"}, {"name": "free"}],
        initial_error={"attitude_arcmin": [5.0, 5.0, 0.0]},
    )  # fmt: skip
    bad, free = run.methods
    assert (bad.status, free.status) == ("diverged", "ok")
    assert "left the range of navigation" in bad.reason and " s = " in bad.reason
    assert len(free.t_s) == len(run.t_s) > len(bad.t_s)
    assert np.all(np.isfinite(bad.rows))
    write_results(run, tmp_path / "out", "csv")
    assert timeseries(run).num_rows == len(bad.t_s) + len(free.t_s)


def test_the_files_carry_the_navigation_solution(tmp_path):
    motion = {"kind": "legs", "leg": [{"duration_s": 3600.0, "speed_mps": 5.0, "heading_deg": 60.0}]}
    run = run_of(motion=motion, method=[{"name": "free"}, COMPASS])
    write_results(run, tmp_path / "out")
    table = pyarrow.parquet.read_table(tmp_path / "out" / "timeseries.parquet")
    assert tuple(table.column_names[-11:]) == NAVIGATION
    assert table.column_names[:3] == ["method", "t_s", "phi_e_rad"]
    first = {name: table[name].to_numpy()[: len(run.t_s)] for name in table.column_names[1:]}
    np.testing.assert_allclose(first["ve_mps"] - run.truth[:, VE], first["dve_mps"], atol=1e-9)
    np.testing.assert_allclose(
        (first["lat_rad"] - run.truth[:, LAT]) * 6.35e6, first["dlat_m"], rtol=5e-3, atol=1e-3
    )
    np.testing.assert_allclose(first["heading_rad"], run.truth[:, HEADING], atol=1e-3)
    assert np.all(first["dvu_mps"] == 0.0) and np.all(first["height_m"] == 0.0)


@pytest.mark.parametrize("fidelity", ["error_model", "strapdown"])
def test_the_law_series_tells_wish_state_xi_and_measure(fidelity):
    """A log that steps by 2 m/s at 600 s: `threshold` (0.5 m/s) lets go."""
    run = run_of(
        0.5, run={"fidelity": fidelity, "output_step_s": 1.0},
        reference={"kind": "log", "event": [{"t_h": 1 / 6, "duration_s": 1.0, "accel_mps2": [2.0, 0.0]}]},
        method=[COMPASS | {"policy": {"id": "threshold"}}],
    )  # fmt: skip
    method = run.methods[0]
    wanted, damped, xi, measure = method.law_series.T
    assert np.array_equal(damped, method.rows[:, 8]) and np.array_equal(xi, method.rows[:, 9])
    assert wanted[590] == damped[590] == 1.0 and wanted[700] == damped[700] == 0.0
    assert measure[590] < 0.5 < measure[700]
    assert np.array_equal(wanted, (measure <= 0.5).astype(float))


def test_compensation_makes_the_difference_it_should():
    """Coning at 2 Hz: without compensation the level attitude drifts."""
    cone = [{"amplitude_deg": 1.0, "frequency_hz": 2.0, "phase_deg": phase} for phase in (0.0, 90.0)]
    motion = {"kind": "swing", "pitch": cone[0], "roll": cone[1]}
    worst = {}
    for on in (True, False):
        run = run_of(0.05, run={"compensation": on}, imu={}, reference={}, motion=motion)
        worst[on] = run.methods[0].errors["phi_u_rad"]["max_abs"]
    assert worst[True] < 0.02 * worst[False]


SWING = {"amplitude_deg": 5.0, "frequency_hz": 0.13, "phase_deg": 40.0}


@pytest.mark.parametrize(
    "motion", [{"kind": "static"}, {"kind": "waves"}, {"kind": "swing", "roll": SWING, "heading": SWING}]
)
def test_an_alignment_takes_the_initial_error_out(motion):
    """0.1 deg of tilt and 1 deg of heading: 0.003 deg of heading are left (theory.md 6.1)."""
    run = run_of(
        0.02, imu={}, reference={}, motion=motion, alignment={"kind": "compass"},
        initial_error={"attitude_arcmin": [6.0, -6.0, 60.0], "position_arcsec": [10.0, 0.0]},
    )  # fmt: skip
    start = run.methods[0].rows[0]
    assert abs(start[2]) < 0.004 * DEG and np.abs(start[:2]).max() < 2e-4 * DEG
    assert start[3] == start[4] == 0.0
    assert start[5] == pytest.approx(308.0, rel=0.01)


def test_an_alignment_leaves_what_the_biases_make_of_it():
    """phi_N = nabla_E / g: navigation starts with errors that its own sensors made."""
    run = run_of(0.02, imu={"accel_bias_ug": [100.0, 0.0, 0.0]}, reference={}, alignment={"kind": "compass"})
    assert run.methods[0].rows[0, 1] == pytest.approx(100e-6, rel=0.02)


def test_an_alignment_at_speed_is_told():
    motion = {"kind": "legs", "leg": [{"duration_s": 3600.0, "speed_mps": 5.0}]}
    run = run_of(0.02, motion=motion, alignment={"kind": "compass"})
    assert any("the alignment is made at rest" in text for text in run.warnings)


def test_an_alignment_at_sea_leaves_what_one_at_rest_would():
    """Waves disturb the compass loop by their accelerations only: pure rotation and heave hardly at all."""
    imu = {"accel_bias_ug": [100.0, 0.0, 0.0], "gyro_bias_dph": [0.01, 0.0, 0.0]}
    start = {}
    for name, motion in (("rest", {"kind": "static"}), ("sea", {"kind": "waves", "speed_mps": 5.0})):
        run = run_of(0.02, imu=imu, reference={}, motion=motion, alignment={"kind": "compass"})
        start[name] = run.methods[0].rows[0, :3]
    np.testing.assert_allclose(start["sea"], start["rest"], rtol=0.05, atol=0.002 * DEG)


# ---------------------------------------------------------------- the linear model


@pytest.mark.parametrize("fidelity", ["error_model", "strapdown"])
def test_statistics_are_those_of_every_step(fidelity):
    """With a row each step the metrics must be recomputable from the rows."""
    method = run_of(run={"fidelity": fidelity, "output_step_s": 1.0}, method=[COMPASS]).methods[0]
    for i, name in enumerate(NAMES):
        column = method.rows[:, i]
        found = method.errors[name]
        assert found["mean"] == pytest.approx(column.mean(), rel=1e-9, abs=1e-15)
        assert found["std"] == pytest.approx(column.std(), rel=1e-6, abs=1e-12)
        assert found["rms"] == pytest.approx(np.sqrt(np.mean(column**2)), rel=1e-9)
        assert found["max_abs"] == np.abs(column).max()
        assert found["final"] == column[-1]


def test_plot_curves_keep_every_extreme_in_order():
    run = run_of(4.0, run=LINEAR, method=[COMPASS])
    plot, rows = run.methods[0].plot, run.methods[0].rows
    assert len(plot.t_s) <= 2000 and np.all(np.diff(plot.t_s) > 0)
    assert np.array_equal(plot.values.max(axis=0), rows[:, :8].max(axis=0))
    assert np.array_equal(plot.values.min(axis=0), rows[:, :8].min(axis=0))
    smooth = np.interp(plot.t_s, run.t_s, rows[:, 7])
    assert np.abs(plot.values[:, 7] - smooth).max() < 0.02 * rows[:, 7].max()


def test_an_outage_leaves_the_loop_undamped_until_the_log_returns():
    run = run_of(
        1.0,
        run=LINEAR,
        reference={"kind": "log", "outage": [{"t_h": 0.5, "duration_s": 600.0}]},
        method=[COMPASS],
    )
    damped = run.methods[0].rows[:, 8]
    assert damped[:1800].all() and not damped[1800:2400].any() and damped[2401:].all()
    assert run.methods[0].rows[2000, 9] == 0.0 and run.methods[0].rows[100, 9] == 0.7


def test_internal_damping_does_not_take_a_constant_speed_for_an_acceleration():
    scenario = {
        "run": {"duration_h": 2.0, "fidelity": "channel"},
        "method": [{"damping": "internal", "network": {"id": "complementary"}}],
    }
    legs = [{"duration_s": 3600.0, "speed_mps": 10.0}, {"duration_s": 3600.0, "speed_mps": 5.0}]
    steady = simulate(Scenario.parse({**scenario, "motion": {"kind": "legs", "leg": legs[:1]}}))
    manoeuvre = simulate(Scenario.parse({**scenario, "motion": {"kind": "legs", "leg": legs}}))
    assert steady.methods[0].errors["phi_e_rad"]["max_abs"] < 1e-12
    assert manoeuvre.methods[0].errors["phi_e_rad"]["max_abs"] > 1e-5


def test_the_law_in_force_is_told_and_the_loop_is_that_of_its_mean():
    """`adaptive` re-tunes its network: the figures of the loop are those of the mean coefficient in force."""
    given = {
        "run": {"duration_h": 2.0},
        "reference": {"kind": "log", "outage": [{"t_h": 1.0, "duration_s": 1800.0}]},
        "initial_error": {"velocity_mps": [0.5, 0.0]},
        "method": [
            {"name": "adaptive", "damping": "external", "policy": {"id": "adaptive"}},
            {"name": "constant", "damping": "external", "network": {"id": "classic2"}},
            {"name": "free"},
        ],
    }
    adaptive, constant, free = simulate(Scenario.parse(given)).methods
    for method in (adaptive, constant):
        assert method.law_in_force.damped_share == pytest.approx(0.75, abs=0.01)
    law = adaptive.law_in_force
    assert law.xi_min is not None and law.xi_mean is not None and law.xi_max is not None
    assert law.xi_min < law.xi_mean < law.xi_max
    # the exact damping of unity2 is the coefficient itself
    assert adaptive.loop.damping_ratio == pytest.approx(law.xi_mean, rel=1e-9)
    assert constant.law_in_force.xi_min == constant.law_in_force.xi_max
    assert (free.law_in_force.damped_share, free.law_in_force.xi_mean) == (0.0, None)


# ---------------------------------------------------------------- rates of a strapdown scenario


FAST = {"amplitude_deg": 2.0, "frequency_hz": 5.0}


def parse(**blocks) -> Scenario:
    run = {"fidelity": "strapdown", "duration_h": 1.0} | blocks.pop("run", {})
    return Scenario.parse({"run": run, **blocks})


@pytest.mark.parametrize(
    ("run", "log_hz", "law_every", "record_every"),
    [
        ({"rate_hz": 100.0}, 1.0, 100, 100),
        ({"rate_hz": 200.0}, 200.0, 1, 200),
        ({"rate_hz": 200.0}, 1000.0, 1, 200),
        ({"rate_hz": 100.0}, 3.0, 25, 100),
        ({"rate_hz": 100.0}, 0.2, 100, 100),
        ({"rate_hz": 100.0, "step_s": 0.1}, 1.0, 10, 10),
        ({"rate_hz": 100.0, "step_s": 10.0}, 1.0, 100, 1000),
        ({"rate_hz": 33.3}, 1.0, 33, 33),
    ],
)
def test_the_law_is_asked_every_step_or_as_often_as_a_faster_log(run, log_hz, law_every, record_every):
    rates = parse(run=run, reference={"kind": "log", "rate_hz": log_hz}).sampling
    assert (rates.law_every, rates.record_every) == (law_every, record_every)
    assert rates.samples == rates.records * record_every
    assert 0.0 <= 3600.0 - rates.duration_s < rates.record_step_s


def test_without_a_log_the_law_runs_at_the_step():
    assert parse(run={"step_s": 0.5}).sampling.law_every == 50


@pytest.mark.parametrize(
    ("blocks", "line"),
    [
        (
            {"site": {"lat_deg": -86.0}, "alignment": {"kind": "compass"}},
            "site.lat_deg = -86.0: compass alignment needs |latitude| <= 85°",
        ),
        (
            {"run": {"rate_hz": 50.0}, "motion": {"kind": "swing", "roll": FAST}},
            "run.rate_hz = 50.0: is too low for the motion: must be >= 80 (Hz), 16 samples a period of "
            "motion.roll.frequency_hz, which is 5 Hz",
        ),
        (
            {
                "run": {"rate_hz": 10.0},
                "motion": {
                    "kind": "legs",
                    "leg": [{"speed_mps": 1.0}, {"speed_mps": 2.0, "accel_mps2": 2.0}],
                },
            },
            "run.rate_hz = 10.0: is too low for the motion: must be >= 32 (Hz), 16 samples a period of "
            "motion.leg.1, which is 2 Hz",
        ),
        (
            {"run": {"rate_hz": 20.0}, "motion": {"kind": "waves", "peak_period_s": 2.0}},
            "run.rate_hz = 20.0: is too low for the motion: must be >= ",
        ),
        ({"run": {"rate_hz": 5.0}}, "run.rate_hz = 5.0: must be >= 10 and <= 1000 (Hz)"),
        ({"run": {"duration_h": 300.0}}, "run.duration_h = 300.0: is 1.08e+08 samples at 100 Hz; at most"),
        (
            {"run": {"duration_h": 100.0}, "reference": {"kind": "log", "rate_hz": 100.0}},
            "reference.rate_hz = 100.0: gives 3.6e+07 log samples in 100 h; at most 10000000",
        ),
        (
            {"alignment": {"kind": "compass", "duration_s": 20000.0}},
            "alignment.duration_s = 20000.0: must be <= 15000 (s) at 100 Hz",
        ),
        (
            {"alignment": {"kind": "compass", "sigma": 9.0, "xi": 0.7}},
            "alignment.sigma = 9.0: must be <= 7 (1/s) at 100 Hz: the loop is too fast",
        ),
        (
            {"imu": {"file": "x.imu"}, "motion": {"kind": "swing"}},
            'motion.kind = \'swing\': must be "static" or "track" with a recorded IMU (imu.file)',
        ),
        ({"imu": {"begin_s": 3.0}}, "imu.begin_s = 3.0: needs a recorded IMU: imu.file"),
        ({"imu": {"axes": "ned"}}, "imu.axes = 'ned': must be one of 'rfu', 'frd', 'flu', "),
        ({"run": {"vertical": "free"}}, "run.vertical = 'free': must be one of 'locked' or 'altimeter'"),
    ],
)
def test_each_fault_names_field_value_and_range(blocks, line):
    with pytest.raises(InputError) as caught:
        parse(**blocks)
    (fault,) = caught.value.faults
    assert str(fault).startswith(line)


@pytest.mark.parametrize("fidelity", ["channel", "error_model"])
@pytest.mark.parametrize(
    ("blocks", "field"),
    [
        ({"alignment": {"kind": "compass"}}, "alignment.kind"),
        ({"imu": {"file": "x.imu"}}, "imu.file"),
        ({"run": {"vertical": "altimeter"}}, "run.vertical"),
        ({"run": {"compensation": False}}, "run.compensation"),
    ],
)
def test_what_only_a_strapdown_run_can_do_is_refused_elsewhere(fidelity, blocks, field):
    with pytest.raises(InputError) as caught:
        parse(**blocks | {"run": blocks.get("run", {}) | {"fidelity": fidelity}})
    (fault,) = caught.value.faults
    assert fault.field == field
    assert fault.allowed == f'needs run.fidelity = "strapdown", which is "{fidelity}"'


def test_every_preset_may_be_run_as_strapdown():
    for name in presets():
        assert load(name, ["run.fidelity=strapdown"]).sampling.records > 0


def test_the_path_of_a_recorded_imu_is_relative_to_the_scenario(tmp_path):
    path = tmp_path / "s.toml"
    path.write_text('schema = 1\n[run]\nfidelity = "strapdown"\n[imu]\nfile = "ship.imu"\n')
    assert load(str(path)).imu.file == str(tmp_path / "ship.imu")
