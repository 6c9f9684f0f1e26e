"""Averaging: the copies and their lines; means of copies really run, in both fidelities."""

import math
from dataclasses import replace

import numpy as np
import pytest

from navcore.averaging import Averaging
from navcore.averaging.combine import averaged_rows
from navcore.averaging.copies import HALF_SIDEREAL_DAY, Copies, copies_of, split_schuler_lines
from navcore.averaging.error_model import states_ahead
from navcore.averaging.lines import LINES, line_amplitudes, line_phases
from navcore.averaging.strapdown import start_strapdown
from navcore.engine.run import plot_series, statistics
from navcore.foundation.earth import EARTH_RATE, SPHERE, WGS84
from navcore.foundation.units import ARCSEC, DEG
from navcore.mechanization.error_model import ErrorModelRun, system_matrix
from navcore.mechanization.recorder import D_LAT, D_LON, DV_E, PHI_U, POSITION, ROW_COLUMNS, make_recorder
from navcore.mechanization.strapdown import Settings, start_from
from navcore.mechanization.strapdown.records import NAVIGATION
from navcore.mechanization.trajectory import coefficients
from navcore.motion.legs import Leg, LegsMotion
from navcore.motion.static import StaticMotion
from navcore.motion.truth import VE
from navcore.sensors.base import ReferenceErrors
from navcore.sensors.imu import Imu, imu_errors
from navcore.sensors.imu_simulation import ImuSimulation
from tests.averaging import INITIAL, SITE, averaged, free_law, made, truth_row

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
    states = states_ahead(INITIAL, plan.copies.ahead_s, plan.forecast, plan.standing, WGS84, free_law())
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
    ask = (0.0, 3000.0, 1000.0)
    states = states_ahead(INITIAL, ask, plan.forecast, plan.standing, SPHERE, free_law())
    np.testing.assert_array_equal(states[0], INITIAL)
    on_from = states_ahead(states[2], (2000.0,), plan.forecast, plan.standing, SPHERE, free_law())
    np.testing.assert_allclose(on_from[0], states[1], rtol=1e-9)
    perfect = made(Averaging()).forecast
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


# ---------------------------------------------------------------- with the strapdown algorithm


LEVEL_NORTH = StaticMotion()
SMALL = INITIAL * 0.05
"""So small that the linear model errs by less than is asserted."""


def navigate(plan, hours, initial, motion=LEVEL_NORTH, site=SITE, imu=None, chunk=None, rate=10.0):
    samples, second = round(hours * 3600 * rate), round(rate)
    source = ImuSimulation(motion, site, WGS84, imu or Imu(), rate, samples, 1)
    truth = source.truth_rows(samples // second + 1, 1.0)
    run = start_strapdown(
        plan, start_from(truth[0], initial), Settings(rate, samples, second, second, 600.0), WGS84, free_law,
        truth, source.before(),
    )  # fmt: skip
    for increments, _ in source.chunks():
        step = chunk or len(increments)
        if any(run.advance(increments[i : i + step]) for i in range(0, len(increments), step)):
            break
    return run


@pytest.mark.parametrize(
    "averaging",
    [
        Averaging(),
        Averaging(variant="cascade", earth=False),
        Averaging(order=1),
        Averaging(order=2, earth=False),
    ],
    ids=["schuler", "cascade", "line", "parabola"],
)
def test_it_agrees_with_the_linear_model(averaging):
    imu = Imu(gyro_bias_dph=(0.002, -0.001, 0.001), accel_bias_ug=(2.0, -3.0, 0.0))
    # Noise of the record gives a fit something to extrapolate: 0.006 deg/h in 12 h for a line.
    recorded = Imu(gyro_bias_dph=imu.gyro_bias_dph, accel_bias_ug=imu.accel_bias_ug, gyro_arw_dpsh=1e-5)
    plan = made(averaging, earth=WGS84, imu=recorded)
    run = navigate(plan, 4.0, SMALL, imu=imu)
    linear = averaged(plan, 14_400, earth=WGS84, imu=imu, initial=SMALL).recorder.rows[::10]
    found = run.recorder.rows
    assert run.position == 144_000
    scale = np.abs(linear[:, :8]).max(axis=0)
    np.testing.assert_allclose(found[:, :8] / scale, linear[:, :8] / scale, atol=2e-3)


def test_navigation_is_the_truth_and_the_averaged_errors():
    site = replace(SITE, lon=math.pi - 1e-5)
    plan = made(Averaging(), earth=WGS84)
    run = navigate(plan, 1.0, INITIAL, site=site)
    rows = run.recorder.rows
    solution = dict(zip(NAVIGATION, run.navigation.T, strict=True))
    meridian, prime = WGS84.radii(SITE.lat)
    np.testing.assert_allclose((solution["lat_rad"] - SITE.lat) * meridian, rows[:, 5], atol=1e-6)
    np.testing.assert_allclose(
        (solution["lon_rad"] - site.lon) * prime * math.cos(SITE.lat), rows[:, 6], atol=1e-6
    )
    np.testing.assert_allclose(solution["ve_mps"], rows[:, 3], atol=1e-12)
    # level and north: dpitch = -phi_E, droll = -phi_N, dpsi = phi_U (theory.md section 2)
    np.testing.assert_allclose(solution["pitch_rad"], -rows[:, 0], atol=1e-2 * ARCSEC)
    np.testing.assert_allclose(solution["roll_rad"], -rows[:, 1], atol=2e-1 * ARCSEC)
    heading = np.remainder(solution["heading_rad"] + math.pi, 2 * math.pi) - math.pi
    np.testing.assert_allclose(heading, rows[:, 2], atol=1e-2 * ARCSEC)


def test_copies_on_either_side_of_north_average_to_north():
    plan = made(Averaging(earth=False), earth=WGS84)
    # half a Schuler period changes the sign of what a heading error does to the level channels, not of itself
    for heading_deg in (359.9999, 0.0001):
        run = navigate(plan, 0.2, np.zeros(7), motion=StaticMotion(heading_deg=heading_deg))
        heading = run.navigation[:, NAVIGATION.index("heading_rad")]
        off = np.remainder(heading - heading_deg * DEG + math.pi, 2 * math.pi) - math.pi
        assert np.abs(off).max() < 1e-2 * ARCSEC


def test_chunks_do_not_change_the_strapdown_result():
    plan = made(Averaging(variant="cascade", earth=False), earth=WGS84)
    whole, pieces = navigate(plan, 0.5, INITIAL), navigate(plan, 0.5, INITIAL, chunk=73)
    np.testing.assert_array_equal(whole.recorder.rows, pieces.recorder.rows)
    np.testing.assert_array_equal(whole.navigation, pieces.navigation)
    assert whole.recorder.cursor["count"] == pieces.recorder.cursor["count"] == 1801


def test_a_copy_that_fails_stops_the_method():
    plan = made(Averaging(), earth=WGS84)
    run = navigate(plan, 0.5, np.array([9.99e3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.9]))
    assert run.diverged
    assert run.reason


# ---------------------------------------------------------------- copies and lines


LAT = 45.78 * DEG
OMEGA_S = SPHERE.schuler_frequency(LAT)


@pytest.mark.parametrize("lat_deg", [-60.0, 0.0, 45.78, 85.0])
def test_split_lines_are_the_eigenvalues_of_the_model_at_rest(lat_deg):
    lat = lat_deg * DEG
    radius, gravity = 6378137.0, SPHERE.gravity(lat)
    lines = np.sort(np.abs(np.linalg.eigvals(system_matrix(lat, radius, gravity, EARTH_RATE)).imag))
    fast, slow = split_schuler_lines(lat, 0.0, SPHERE)
    np.testing.assert_allclose(lines[-4:], [slow, slow, fast, fast], rtol=1e-9)


def test_both_radii_of_the_ellipsoid_count():
    meridian, prime = WGS84.radii(LAT)
    gravity = WGS84.gravity(LAT)
    fast, slow = split_schuler_lines(LAT, 0.0, WGS84)
    assert fast * slow == pytest.approx(gravity / math.sqrt(meridian * prime), rel=1e-12)
    assert fast > slow + 1.9 * EARTH_RATE * math.sin(LAT)


def test_schuler_copies():
    with_earth = copies_of(Averaging(), OMEGA_S, LAT, 0.0, SPHERE)
    assert with_earth.ahead_s == pytest.approx((0.0, math.pi / OMEGA_S, math.pi / EARTH_RATE))
    assert (with_earth.level, with_earth.slow) == ((0, 1), (0, 2))
    without = copies_of(Averaging(earth=False), OMEGA_S, LAT, 0.0, SPHERE)
    assert without == Copies(with_earth.ahead_s[:2], (0, 1), (0, 1))


def test_cascade_copies():
    four = copies_of(Averaging(variant="cascade", earth=False), OMEGA_S, LAT, 0.0, SPHERE)
    fast, slow = (math.pi / line for line in split_schuler_lines(LAT, 0.0, SPHERE))
    assert four.ahead_s == pytest.approx((0.0, fast, slow, fast + slow))
    eight = copies_of(Averaging(variant="cascade"), OMEGA_S, LAT, 0.0, SPHERE)
    assert eight.ahead_s == pytest.approx(four.ahead_s + tuple(HALF_SIDEREAL_DAY + s for s in four.ahead_s))
    assert eight.level == eight.slow == tuple(range(8))


def test_each_output_is_the_mean_of_its_group():
    rows = [np.full((4, ROW_COLUMNS), value) for value in (1.0, 3.0, 9.0)]
    out = averaged_rows([rows[0], rows[1][:3], rows[2]], Copies((0.0, 1.0, 2.0), (0, 1), (0, 2)))
    assert out.shape == (3, ROW_COLUMNS)
    assert (out[:, DV_E] == 2.0).all()
    assert (out[:, [PHI_U, D_LAT, D_LON]] == 5.0).all()
    np.testing.assert_allclose(out[:, POSITION], 5.0 * math.sqrt(2.0))


# ---------------------------------------------------------------- amplitudes by least squares on known lines


TIME_S = np.arange(0.0, 86_401.0, 60.0)


def test_phases_at_rest_are_the_lines_times_time():
    phases = line_phases(TIME_S, truth_row(earth=WGS84)[None, :], WGS84)
    assert phases.shape == (len(TIME_S), len(LINES))
    fast, slow = split_schuler_lines(SITE.lat, 0.0, WGS84)
    np.testing.assert_allclose(phases, TIME_S[:, None] * [fast, slow, EARTH_RATE], rtol=1e-9)


def test_a_vehicle_going_east_meets_the_day_sooner():
    row = np.tile(truth_row(earth=WGS84), (len(TIME_S), 1))
    row[:, VE] = 100.0
    phases = line_phases(TIME_S, row, WGS84)
    rate = 100.0 / (WGS84.radii(SITE.lat)[1] * np.cos(SITE.lat))
    np.testing.assert_allclose(phases[-1, 2], TIME_S[-1] * (EARTH_RATE + rate), rtol=1e-9)
    assert phases[-1, 0] - phases[-1, 1] == pytest.approx(
        2.0 * TIME_S[-1] * (EARTH_RATE + rate) * np.sin(SITE.lat), rel=1e-3
    )


def test_amplitudes_offset_trend_and_rest_are_found():
    phases = line_phases(TIME_S, truth_row(earth=WGS84)[None, :], WGS84)
    noise = 0.1 * np.where(np.arange(len(TIME_S)) % 2, 1.0, -1.0)
    curve = 3.0 * np.sin(phases[:, 0] + 0.4) + 2.0 * np.cos(phases[:, 1]) + 7.0 * np.sin(phases[:, 2] - 1.0)
    curves = np.column_stack([curve + 5.0 + 2e-5 * TIME_S + noise, 0.0 * TIME_S])
    found = line_amplitudes(TIME_S, curves, phases)
    np.testing.assert_allclose(found.amplitude[0], [3.0, 2.0, 7.0], atol=2e-3)
    assert found.offset[0] == pytest.approx(5.0, abs=5e-3)
    assert found.slope[0] == pytest.approx(2e-5, rel=1e-2)
    assert found.residual_rms[0] == pytest.approx(0.1, rel=1e-2)
    np.testing.assert_array_equal(found.amplitude[1], 0.0)


def test_a_short_record_gives_no_absurd_amplitudes():
    time_s = np.arange(0.0, 6000.0, 10.0)
    phases = line_phases(time_s, truth_row(earth=WGS84)[None, :], WGS84)
    found = line_amplitudes(time_s, np.sin(phases[:, :1]), phases)
    assert found.amplitude.max() < 10.0
