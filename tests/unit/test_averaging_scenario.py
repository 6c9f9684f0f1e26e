"""Averaging as a method of a scenario; the alignment record and the forecast from it."""

from typing import Any

import numpy as np
import pytest

from navcore.averaging import AlignmentMotion, Averaging
from navcore.averaging.forecast import Forecast, base_motion, forecast_from, still_segments
from navcore.averaging.record import alignment_record, sensed_at_rest, standing_row, standing_signals
from navcore.engine.simulation import simulate
from navcore.foundation.earth import EARTH_RATE, WGS84, attitude_matrix
from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG, DEG_PER_HOUR, MICRO_G
from navcore.mechanization.strapdown.records import NAVIGATION
from navcore.motion.static import StaticMotion
from navcore.motion.truth import HEADING, PITCH, ROLL, VE
from navcore.scenario.model import Scenario
from navcore.sensors.imu import Imu, imu_errors
from navcore.sensors.noise import unit_noise
from tests.averaging import SITE, made, truth_row

METHODS = [
    {"damping": "averaging"},
    {"damping": "averaging", "averaging": {"variant": "cascade", "earth": False}},
    {"damping": "free"},
]


def scenario(**blocks: Any) -> Scenario:
    data: dict[str, Any] = {
        "run": {"duration_h": 0.5, "rate_hz": 10.0},
        "site": {"lat_deg": 45.78},
        "initial_error": {"attitude_arcmin": [0.06, 0.06, 0.7], "velocity_mps": [0.01, 0.0]},
        "method": METHODS,
    }
    for name, block in blocks.items():
        data[name] = {**data[name], **block} if isinstance(block, dict) and name in data else block
    return Scenario.parse(data)


def test_both_fidelities_carry_it_out():
    linear, full = simulate(scenario()), simulate(scenario(run={"fidelity": "strapdown"}))
    # of what the free method has: where the copies leave next to nothing, the second order shows
    scale = np.abs(linear.methods[2].rows[:, :7]).max(axis=0)
    for a, b in zip(linear.methods, full.methods, strict=True):
        assert (a.status, b.status) == ("ok", "ok")
        np.testing.assert_allclose(b.rows[:, :7] / scale, a.rows[:, :7] / scale, atol=1e-3)
        assert b.navigation is not None
        assert b.navigation.shape == (len(b.rows), len(NAVIGATION))
    # the cascade is far below the free method at once
    assert linear.methods[1].errors["phi_e_rad"]["rms"] < 0.1 * linear.methods[2].errors["phi_e_rad"]["rms"]


@pytest.mark.parametrize("fidelity", ["error_model", "strapdown"])
def test_a_stopped_run_keeps_what_was_computed(fidelity):
    run = simulate(scenario(run={"fidelity": fidelity, "duration_h": 30.0}), cancelled=lambda: True)
    averaged = run.methods[0]
    assert averaged.status == "stopped"
    assert 1 < len(averaged.rows) < len(run.t_s)
    assert np.isfinite(averaged.rows[:, :8]).all()


def test_progress_reaches_the_end():
    seen: list[float] = []
    simulate(scenario(run={"duration_h": 30.0}), progress=seen.append)
    assert seen[-1] == pytest.approx(1.0)
    assert len(seen) > 3


def test_what_the_forecast_costs_is_told():
    run = simulate(scenario(imu={"gyro_arw_dpsh": 0.005}))
    assert any("0.012 °/h" in text for text in run.methods[0].warnings)
    assert not any("forecast" in text for text in run.methods[2].warnings)
    unused = scenario(method=[{"damping": "averaging", "network": {"id": "classic2"}}])
    assert 'damping = "averaging": the network is not used' in simulate(unused).methods[0].warnings


@pytest.mark.parametrize(
    ("blocks", "field", "reason"),
    [
        ({"run": {"fidelity": "channel"}}, "method.0.damping", "error_model"),
        ({"alignment": {"motion": [{"t_s": -700.0}]}}, "alignment.motion.0.t_s", "begins there"),
        ({"alignment": {"motion": [{"t_s": -3.0}]}}, "alignment.motion.0.duration_s", "starts at 0"),
        ({"alignment": {"motion": [{"t_s": 1.0}]}}, "alignment.motion.0.t_s", "< 0"),
        (
            {"motion": {"kind": "legs", "leg": [{"duration_s": 100.0, "speed_mps": 5.0}]}},
            "motion",
            "must start from rest",
        ),
        ({"method": [{"damping": "averaging", "averaging": {"earth": 1}}]}, "method.0.averaging.earth", ""),
        (
            {"method": [{"damping": "averaging", "averaging": {"variant": "x"}}]},
            "averaging.variant",
            "cascade",
        ),
    ],
)
def test_what_is_refused(blocks, field, reason):
    with pytest.raises(InputError) as caught:
        scenario(**blocks)
    assert any(field in fault.field and reason in fault.allowed for fault in caught.value.faults)


def test_a_policy_asks_for_no_reference_when_nothing_is_damped():
    assert scenario(method=[{"damping": "averaging", "policy": {"id": "threshold"}}]).method[0].undamped


# ---------------------------------------------------------------- the alignment record and the forecast


TILTED = StaticMotion(pitch_deg=3.0, roll_deg=-2.0, heading_deg=70.0)
STANDING = standing_row(truth_row(TILTED, WGS84))
NOISY = Imu(gyro_bias_dph=(0.01, 0.02, -0.01), gyro_arw_dpsh=0.005, accel_bias_ug=(100.0, -50.0, 20.0),
            accel_vrw_ugpshz=50.0)  # fmt: skip
ZHAO_FIG_4 = (
    AlignmentMotion(t_s=-500.0, duration_s=5.0, turn_deg=(0.2, 0.0, 0.05)),
    AlignmentMotion(t_s=-402.0, duration_s=5.0, turn_deg=(-0.1, 0.1, 0.0)),
)


def record(imu=None, motions=(), seconds=600.0, seed=1):
    return alignment_record(imu or Imu(), STANDING, seconds, motions, WGS84, seed)


def test_perfect_record_is_earth_rate_and_gravity():
    increments = record()
    assert increments.shape == (600, 6)
    signals = standing_signals(STANDING, WGS84)
    assert np.linalg.norm(signals[:3]) == pytest.approx(EARTH_RATE, rel=1e-12)
    assert np.linalg.norm(signals[3:]) == pytest.approx(WGS84.gravity(SITE.lat), rel=1e-12)
    np.testing.assert_allclose(increments, np.tile(signals, (600, 1)), rtol=1e-12)


def test_motion_of_the_base_ends_in_the_attitude_of_the_start_of_navigation():
    still, moved = record(), record(motions=ZHAO_FIG_4)
    np.testing.assert_allclose(moved[205:], still[205:], atol=1e-12)
    assert np.abs(moved[:95] - still[:95])[:, 3:].max() > 1e-3
    # about one axis the angles add up to the turn
    single = record(motions=(AlignmentMotion(t_s=-300.5, duration_s=7.0, turn_deg=(0.0, 0.0, 0.3)),))
    turned = (single - still)[290:320, 2].sum()
    assert turned == pytest.approx(0.3 * DEG, rel=1e-4)


def test_base_motion_is_found_with_its_guard_in_noise():
    angles = record(NOISY, ZHAO_FIG_4)[:, :3]
    found = base_motion(angles)
    assert still_segments(found) == ((0, 98), (107, 196), (205, 600))


def test_no_motion_is_seen_in_noise_alone():
    false = sum(base_motion(1e-6 * unit_noise(seed, "test", 600, 3)).any() for seed in range(20))
    assert false <= 1


def test_turned_earth_rate_of_a_perfect_record_is_no_motion():
    found = base_motion(record(motions=ZHAO_FIG_4)[:, :3])
    assert found.sum() < 25


@pytest.mark.parametrize("imu", [Imu(), NOISY], ids=["perfect", "noisy"])
def test_motions_leave_the_forecast_as_it_was(imu):
    calm, moved = forecast_from(record(imu)), forecast_from(record(imu, ZHAO_FIG_4))
    assert calm.segments == ((0, 600),)
    # 1 sigma of the means of 600 s: 0.012 deg/h and 2 ug
    assert np.abs(moved.gyro - calm.gyro).max() < 0.02 * DEG_PER_HOUR
    assert np.abs(moved.accel - calm.accel).max() < 6 * MICRO_G
    # what a fit that takes no notice of the motions would give
    plain = record(imu, ZHAO_FIG_4).mean(axis=0)
    assert np.abs(plain[:3] - calm.gyro).max() > 0.5 * DEG_PER_HOUR
    assert np.abs(plain[3:] - calm.accel).max() > 400 * MICRO_G


def test_forecast_noise_is_that_of_the_mean():
    # theory.md 5: 0.012 deg/h for 0.005 deg/sqrt(h) and 600 s
    noise = Imu(gyro_arw_dpsh=0.005)
    signals = standing_signals(STANDING, WGS84)[:3]
    errors = [forecast_from(record(noise, seed=seed)).gyro - signals for seed in range(60)]
    assert np.std(errors) / DEG_PER_HOUR == pytest.approx(0.0122, rel=0.15)
    assert "0.012 °/h" in made(Averaging(), imu=noise).notices[0]


def test_biases_and_drifts_of_the_run_are_in_the_forecast():
    imu = Imu(gyro_bias_dph=(0.01, 0.02, -0.03), accel_bias_ug=(30.0, 0.0, 0.0))
    forecast, signals = forecast_from(record(imu)), standing_signals(STANDING, WGS84)
    np.testing.assert_allclose((forecast.gyro - signals[:3]) / DEG_PER_HOUR, imu.gyro_bias_dph, atol=1e-9)
    np.testing.assert_allclose((forecast.accel - signals[3:]) / MICRO_G, imu.accel_bias_ug, atol=1e-6)
    # the drift goes back in time from its value at t = 0
    slow = Imu(gyro_instability_dph=0.02, gyro_tau_s=1e6)
    drift = forecast_from(record(slow)).gyro - signals[:3]
    first = 0.02 * unit_noise(1, "gyro.instability", 1, 3)[0]
    np.testing.assert_allclose(drift / DEG_PER_HOUR, first, atol=0.002)


def test_counts_lose_nothing():
    fine = forecast_from(record(Imu(gyro_lsb=(1e-6, 1e-6, 1e-6)))).gyro
    np.testing.assert_allclose(fine, standing_signals(STANDING, WGS84)[:3], atol=1e-6 / 600)
    steps = record(Imu(gyro_lsb=(1e-6, 0.0, 0.0)))[:, 0] / 1e-6
    np.testing.assert_allclose(steps, np.rint(steps), atol=1e-9)


@pytest.mark.parametrize(("seconds", "swing", "still"), [(600.0, 0.01, 0), (8.0, 0.0, 8)])
def test_too_few_seconds_at_rest_are_refused(seconds, swing, still):
    increments = record(seconds=seconds)
    increments[:, 0] += swing * np.sin(0.3 * np.arange(seconds))
    with pytest.raises(InputError, match=f"stands still for {still} s"):
        forecast_from(increments)


def test_a_vehicle_under_way_is_refused():
    row = truth_row()
    row[VE] = 5.0
    with pytest.raises(InputError, match="must start from rest"):
        standing_row(row)


def test_a_base_that_moves_at_the_end_is_forecast_in_the_attitude_in_which_it_ends():
    """The record ends while the base turns: the means are turned by what came after the last still part."""
    at_the_end = (AlignmentMotion(t_s=-4.0, duration_s=4.0, turn_deg=(0.4, -0.3, 0.5)),)
    forecast = forecast_from(record(motions=at_the_end))
    assert forecast.segments[-1][1] < 600
    # the attitude of t = 0 is that of the scenario, so the forecast is what the sensors feel there
    wanted = standing_signals(STANDING, WGS84)
    np.testing.assert_allclose(forecast.accel, wanted[3:], atol=2e-4)
    np.testing.assert_allclose(forecast.gyro, wanted[:3], atol=2e-9)
    # without the turn it would be off by gravity times half a degree
    still = record()[:590].mean(axis=0)
    before = record(motions=at_the_end)[:590].mean(axis=0)
    assert np.abs(before - still)[3:].max() > 0.05


# ---------------------------------------------------------------- other fits, and (26) as printed


def test_a_drift_is_forecast_by_a_line_and_not_by_a_mean():
    drift = np.array([0.02, -0.01, 0.03]) * DEG_PER_HOUR / 3600.0
    increments = record()
    increments[:, :3] += drift * (np.arange(600) - 599.5)[:, None]
    line, mean = forecast_from(increments, order=1), forecast_from(increments)
    later = standing_signals(STANDING, WGS84)[:3] + drift * 43200.0
    np.testing.assert_allclose(line.at(np.array([43200.0]))[0, :3], later, atol=1e-6 * DEG_PER_HOUR)
    np.testing.assert_allclose(mean.at(np.array([43200.0]))[0, :3] - later, -drift * 43500.0, rtol=1e-3)


def test_means_over_steps_are_those_of_the_polynomial():
    forecast = Forecast(np.ones(3), np.ones(3), (), np.array([[1e-3] * 6, [-2e-6] * 6, [1e-9] * 6]))
    fine = forecast.at(np.linspace(100.0, 140.0, 400_001)[:-1] + 5e-5)
    means = forecast.means(100.0, 20.0, 2)
    np.testing.assert_allclose(means, fine.reshape(2, 200_000, 6).mean(axis=1), rtol=1e-9)


def test_a_line_carries_the_noise_of_600_s_to_three_degrees_an_hour():
    """sqrt(12) N / T^1.5 of slope: 0.255 deg/h an hour for 0.005 deg/sqrt(h) (theory.md 5)."""
    noise = Imu(gyro_arw_dpsh=0.005)
    found = [forecast_from(record(noise, seed=seed), order=1) for seed in range(60)]
    after = [one.at(np.array([43200.0]))[0, :3] - standing_signals(STANDING, WGS84)[:3] for one in found]
    assert np.std(after) / DEG_PER_HOUR == pytest.approx(3.1, rel=0.15)
    words = made(Averaging(order=1), imu=noise).notices
    assert len(words) == 1 and "fit of order 1 moves the forecast" in words[0]


@pytest.mark.parametrize("order", [0, 1, 2])
def test_shifted_as_printed_only_the_last_part_counts(order):
    increments = record(NOISY, ZHAO_FIG_4)
    printed = forecast_from(increments, order=order, shifted=True)
    last = forecast_from(increments[printed.segments[-1][0] :], order=order)
    np.testing.assert_allclose(printed.factors, last.factors, rtol=1e-6, atol=1e-16)
    turned = forecast_from(increments, order=order)
    assert np.abs(turned.gyro - printed.gyro).max() > 1e-3 * DEG_PER_HOUR


def test_the_method_runs_with_the_fit_that_it_is_given():
    imu = Imu(gyro_bias_dph=(0.01, 0.0, 0.0), gyro_arw_dpsh=0.002)
    fits = [made(Averaging(**given), imu=imu, motions=ZHAO_FIG_4).forecast for given in (
        {}, {"order": 2}, {"segments": "shifted"}, {"order": 1, "segments": "shifted"},
    )]  # fmt: skip
    assert [len(fit.growth) for fit in fits] == [0, 2, 0, 1]
    assert len({fit.gyro.tobytes() for fit in fits}) == 4


def test_what_came_is_what_the_sensors_of_the_run_feel_at_rest():
    """Turned to the navigation frame it is the errors that the error model's run has, number by number."""
    imu = Imu(**NOISY.model_dump() | {"gyro_instability_dph": 0.02, "gyro_tau_s": 600.0})
    came = sensed_at_rest(imu, STANDING, 500, 2.0, WGS84, 7) - standing_signals(STANDING, WGS84)
    truth = TILTED.truth(1, 1.0, SITE, WGS84)
    errors = imu_errors(imu.all_parts(), truth, 500, 2.0, WGS84, 7)
    turn = attitude_matrix(*STANDING[[PITCH, ROLL, HEADING]])
    np.testing.assert_allclose(came[:, :3] @ turn.T, errors.gyro, rtol=1e-6, atol=1e-13)
    np.testing.assert_allclose(came[:, 3:] @ turn.T, errors.accel, rtol=1e-6, atol=1e-9)
