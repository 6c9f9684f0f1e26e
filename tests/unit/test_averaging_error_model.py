"""Averaging on the error model: the mean of copies really run, chunks, divergence."""

import numpy as np
import pytest

from navcore.averaging import Averaging
from navcore.averaging.combine import averaged_rows
from navcore.averaging.error_model import forecast_errors, states_ahead
from navcore.engine.run import plot_series, statistics
from navcore.foundation.earth import SPHERE, WGS84
from navcore.mechanization.error_model import ErrorModelRun
from navcore.mechanization.recorder import make_recorder
from navcore.mechanization.trajectory import coefficients
from navcore.motion.legs import Leg, LegsMotion
from navcore.sensors.base import ReferenceErrors
from navcore.sensors.imu import Imu, imu_errors
from tests.averaging import INITIAL, SITE, averaged, free_law, made

STEPS = 7200
UNDER_WAY = LegsMotion(
    heading_deg=40.0,
    leg=(
        Leg(duration_s=600.0, speed_mps=0.0),
        Leg(duration_s=3000.0, speed_mps=20.0),
        Leg(duration_s=3600.0, heading_deg=200.0),
    ),
)
IMU = Imu(gyro_bias_dph=(0.01, 0.01, 0.01), gyro_arw_dpsh=0.002, accel_bias_ug=(50.0, -30.0, 0.0))


@pytest.mark.parametrize(
    "averaging", [Averaging(), Averaging(variant="cascade", earth=False)], ids=["schuler", "cascade"]
)
def test_it_is_the_mean_of_copies_really_run(averaging):
    plan = made(averaging, UNDER_WAY, WGS84, IMU)
    truth = UNDER_WAY.truth(2 * STEPS + 1, 0.5, SITE, WGS84)
    sensors = imu_errors(IMU.all_parts(), truth, STEPS, 1.0, WGS84, 1)
    wrong = forecast_errors(plan.forecast, plan.standing, WGS84)
    states = states_ahead(INITIAL, plan.copies.ahead_s, wrong, plan.standing, WGS84, free_law())
    rows = []
    for state in states:
        run = ErrorModelRun(
            1.0, STEPS, coefficients(truth, WGS84, coupled=True), sensors,
            ReferenceErrors(np.zeros(0), np.zeros((0, 2)), np.zeros(0, bool), False, 0.0),
            free_law(), state, make_recorder(STEPS, 1.0, 60.0),
        )  # fmt: skip
        assert run.advance(STEPS + 1)
        rows.append(run.recorder.rows)
    expected = averaged_rows(rows, plan.copies)[:, :8]
    found = averaged(plan, STEPS, UNDER_WAY, WGS84, IMU).recorder.rows[:, :8]
    scale = np.abs(expected).max(axis=0)
    np.testing.assert_allclose(found / scale, expected / scale, atol=1e-11)


def test_copies_ahead_are_the_free_model_with_the_forecast_errors():
    # two steps in a row end where one run ends, in whatever order they are asked for
    plan = made(Averaging(), imu=IMU)
    wrong = forecast_errors(plan.forecast, plan.standing, SPHERE)
    ask = (0.0, 3000.0, 1000.0)
    states = states_ahead(INITIAL, ask, wrong, plan.standing, SPHERE, free_law())
    np.testing.assert_array_equal(states[0], INITIAL)
    on_from = states_ahead(states[2], (2000.0,), wrong, plan.standing, SPHERE, free_law())
    np.testing.assert_allclose(on_from[0], states[1], rtol=1e-9)
    perfect = forecast_errors(made(Averaging()).forecast, plan.standing, SPHERE)
    still = states_ahead(np.zeros(7), (3000.0,), perfect, plan.standing, SPHERE, free_law())
    np.testing.assert_allclose(still, 0.0, atol=1e-9)


def test_chunks_do_not_change_the_result():
    plan = made(Averaging())
    whole, pieces = averaged(plan, STEPS), averaged(plan, STEPS, chunk=977)
    np.testing.assert_array_equal(whole.recorder.rows, pieces.recorder.rows)
    np.testing.assert_array_equal(
        plot_series(whole.recorder, 1.0).values, plot_series(pieces.recorder, 1.0).values
    )
    for name, values in statistics(whole.recorder).items():
        assert statistics(pieces.recorder)[name] == pytest.approx(values, rel=1e-9), name
    assert whole.position == pieces.position == STEPS


def test_statistics_cover_every_step_of_both_groups():
    run = averaged(made(Averaging()), 3600)
    assert run.recorder.cursor["count"] == 3601
    rows = run.recorder.rows
    assert len(rows) == 61
    numbers = statistics(run.recorder)
    assert numbers["phi_u_rad"]["final"] == rows[-1, 2]
    assert numbers["position_m"]["final"] == pytest.approx(np.hypot(rows[-1, 5], rows[-1, 6]))
    assert numbers["dve_mps"]["max_abs"] >= np.abs(rows[:, 3]).max()


@pytest.mark.parametrize("averaging", [Averaging(), Averaging(variant="cascade")], ids=["schuler", "cascade"])
def test_divergence_is_noticed(averaging):
    run = averaged(made(averaging), 3600, initial=np.array([5e4, 5e4, 0.0, 0.0, 0.5, 0.5, 0.9]))
    assert run.diverged
    assert run.position < 3600
    assert np.isfinite(run.recorder.rows[: run.recorder.cursor["row"]]).all()
