"""simulate() of the linear model: statistics, plot curves, outages, the body log, the law in force."""

import numpy as np
import pytest

from navcore.engine.simulation import simulate
from navcore.mechanization.recorder import NAMES
from navcore.scenario.model import Scenario

COMPASS = {"damping": "external", "network": {"id": "compass"}}
NOISY = {
    "run": {"duration_h": 2.0, "seed": 5},
    "imu": {"gyro_bias_dph": [0.01, 0.02, 0.0], "gyro_arw_dpsh": 0.01, "accel_vrw_ugpshz": 20.0},
    "reference": {"kind": "log", "noise_mps": 0.2, "bias_mps": [0.1, -0.2]},
}


def _run(**changes):
    return simulate(Scenario.parse({**NOISY, **changes}))


def test_statistics_are_those_of_every_step():
    """With a row each step the metrics must be recomputable from the rows."""
    run = _run(run={"duration_h": 1.2, "output_step_s": 1.0}, method=[COMPASS])
    method = run.methods[0]
    for i, name in enumerate(NAMES):
        column = method.rows[:, i]
        found = method.errors[name]
        assert found["mean"] == pytest.approx(column.mean(), rel=1e-9, abs=1e-15)
        assert found["std"] == pytest.approx(column.std(), rel=1e-6, abs=1e-12)
        assert found["rms"] == pytest.approx(np.sqrt(np.mean(column**2)), rel=1e-9)
        assert found["max_abs"] == np.abs(column).max()
        assert found["final"] == column[-1]


def test_plot_curves_keep_every_extreme_in_order():
    run = _run(run={"duration_h": 4.0, "output_step_s": 1.0}, method=[COMPASS])
    plot, rows = run.methods[0].plot, run.methods[0].rows
    assert len(plot.t_s) <= 2000 and np.all(np.diff(plot.t_s) > 0)
    assert np.array_equal(plot.values.max(axis=0), rows[:, :8].max(axis=0))
    assert np.array_equal(plot.values.min(axis=0), rows[:, :8].min(axis=0))
    smooth = np.interp(plot.t_s, run.t_s, rows[:, 7])
    assert np.abs(plot.values[:, 7] - smooth).max() < 0.02 * rows[:, 7].max()


def test_an_outage_leaves_the_loop_undamped_until_the_log_returns():
    run = _run(
        run={"duration_h": 1.0, "output_step_s": 1.0},
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
