"""The simulated log: closed forms of every error, epochs, averaging, independence of the streams."""

import math

import numpy as np
import pytest
from pydantic import ValidationError

from navcore.foundation.units import DEG, HOUR, KNOT
from navcore.motion.truth import AE, AN, COLUMNS, HEADING, HEADING_RATE, VE, VN, Truth
from navcore.sensors.base import ReferenceErrors
from navcore.sensors.log import reference_errors
from navcore.sensors.log_errors.events import LogEvent, event_velocity
from navcore.sensors.reference import Outage, Reference
from navcore.sensors.true_state import horizontal_state, to_navigation, to_ship


def truth(duration_s: float = 600.0, accel: float = 0.01, turn: float = 0.02, step_s: float = 0.5) -> Truth:
    """Forward speed 5 m/s + accel t on a heading that turns by ``turn`` rad/s."""
    t = np.arange(int(duration_s / step_s) + 1) * step_s
    values = np.zeros((t.size, COLUMNS))
    speed, heading = 5.0 + accel * t, 0.3 + turn * t
    values[:, VE], values[:, VN] = speed * np.sin(heading), speed * np.cos(heading)
    values[:, AE] = accel * np.sin(heading) + speed * turn * np.cos(heading)
    values[:, AN] = accel * np.cos(heading) - speed * turn * np.sin(heading)
    values[:, HEADING], values[:, HEADING_RATE] = heading, turn
    return Truth(step_s, values)


AT_REST = Truth(0.5, np.zeros((1, COLUMNS)))


def errors(motion: Truth = AT_REST, duration_s: float = 600.0, seed: int = 1, **fields) -> ReferenceErrors:
    return reference_errors(Reference(kind="log", **fields), motion, duration_s, seed)


def test_no_reference_has_no_epochs():
    found = reference_errors(Reference(), AT_REST, 600.0, 1)
    assert found.time_s.shape == (0,)
    assert found.error.shape == (0, 2)


@pytest.mark.parametrize(("rate", "count", "last"), [(1.0, 11, 10.0), (0.3, 4, 10.0), (0.911, 10, 9.879)])
def test_epochs_are_those_of_the_rate(rate, count, last):
    found = errors(duration_s=10.0, rate_hz=rate)
    assert found.time_s.size == count
    assert found.time_s[0] == 0.0
    assert found.time_s[-1] == pytest.approx(last, abs=1e-3)


def test_a_faster_log_than_the_mechanization_is_read_once_a_step():
    found = errors(duration_s=100.0, rate_hz=200.0)
    assert found.time_s == pytest.approx(np.arange(101.0))
    explicit = reference_errors(Reference(kind="log", rate_hz=200.0), AT_REST, 100.0, 1, step_s=0.1)
    assert explicit.time_s.size == 1001


def test_averaging_divides_the_noise_by_the_root_of_the_number_of_samples():
    slow, fast = (errors(duration_s=20_000.0, noise_mps=0.2, rate_hz=rate).error for rate in (1.0, 100.0))
    assert slow.std() == pytest.approx(0.2, rel=0.02)
    assert fast.std() == pytest.approx(0.02, rel=0.02)


def test_bias_in_the_navigation_frame_is_the_error():
    assert errors(truth(), bias_mps=(0.3, -0.2)).error == pytest.approx(np.tile([0.3, -0.2], (601, 1)))


def test_bias_along_the_axes_turns_with_the_heading():
    found = errors(truth(), bias_mps=(0.3, -0.2), frame="body")
    heading = 0.3 + 0.02 * found.time_s
    assert found.body_frame
    assert found.error[:, 0] == pytest.approx(0.3 * np.cos(heading) - 0.2 * np.sin(heading))
    assert found.error[:, 1] == pytest.approx(-0.3 * np.sin(heading) - 0.2 * np.cos(heading))


def test_current_and_tide_are_missed_by_the_log():
    found = errors(
        current_mps=(0.5, -0.4), tide_mps=(0.2, 0.1), tide_period_h=1.0, tide_phase_deg=90.0, duration_s=HOUR
    )
    tide = np.cos(2.0 * math.pi * found.time_s / HOUR)
    assert found.error[:, 0] == pytest.approx(-0.5 - 0.2 * tide)
    assert found.error[:, 1] == pytest.approx(0.4 - 0.1 * tide)


@pytest.mark.parametrize("frame", ["enu", "body"])
def test_scale_error_is_a_share_of_the_velocity_through_the_water(frame):
    motion, current = truth(), np.array([0.5, -0.4])
    found = errors(motion, scale_ppm=2000.0, frame=frame, current_mps=tuple(current))
    expected = 0.002 * motion.values[::2, [VE, VN]] - 1.002 * current
    np.testing.assert_allclose(found.error, expected, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("frame", ["enu", "body"])
@pytest.mark.parametrize("reading", [{}, {"lsb_mps": 1e-9, "delay_s": 0.0}], ids=["plain", "rounded"])
def test_the_error_by_acceleration_is_in_proportion_to_it(frame, reading):
    motion = truth()
    found = errors(motion, acceleration_s=0.3, frame=frame, **reading)
    np.testing.assert_allclose(found.error, 0.3 * motion.values[::2, [AE, AN]], rtol=0.0, atol=1e-8)


def test_delay_is_the_velocity_earlier():
    motion = truth(turn=0.0)
    found = errors(motion, delay_s=10.0)
    forward = found.error @ [math.sin(0.3), math.cos(0.3)]
    assert forward[10:] == pytest.approx(-0.1)
    assert forward[:11] == pytest.approx(-0.01 * found.time_s[:11])


def test_delayed_readings_along_the_axes_are_turned_by_the_present_heading():
    # A turn at a constant speed leaves the speed along the axes as it was: only a log in E, N lags.
    motion = truth(accel=0.0)
    assert np.abs(errors(motion, delay_s=10.0, frame="body").error).max() < 1e-9
    lag = errors(motion, delay_s=10.0).error[10:]
    assert np.hypot(*lag.T) == pytest.approx(2.0 * 5.0 * math.sin(0.1))


@pytest.mark.parametrize("frame", ["enu", "body"])
def test_resolution_rounds_the_reading(frame):
    motion = truth()
    found = errors(motion, lsb_mps=0.1 * KNOT, frame=frame)
    reading = motion.values[::2, [VE, VN]] + found.error
    if frame == "body":
        reading = to_ship(reading, motion.values[::2, HEADING])
    steps = reading / (0.1 * KNOT)
    assert steps == pytest.approx(np.rint(steps), abs=1e-9)
    assert 0.9 * 0.05 * KNOT < np.abs(found.error).max() < 0.05 * KNOT * math.sqrt(2.0) * 1.001


def test_rounding_of_noisy_fast_samples_averages_out():
    found = errors(truth(20_000.0, accel=0.0, turn=0.0), 20_000.0, noise_mps=0.1, lsb_mps=0.1, rate_hz=100.0)
    assert np.abs(found.error.mean(axis=0)).max() < 5e-4
    assert found.error.std() == pytest.approx(0.01 * math.sqrt(1.0 + 1.0 / 12.0), rel=0.02)


def test_drift_is_gauss_markov():
    found = errors(duration_s=200_000.0, drift_mps=0.3, drift_tau_s=50.0).error
    assert found.std(axis=0) == pytest.approx([0.3, 0.3], rel=0.05)
    for lag in (10, 50, 100):
        covariance = np.mean(found[:-lag] * found[lag:])
        assert covariance == pytest.approx(0.09 * math.exp(-lag / 50.0), abs=0.09 * 0.06)


def test_errors_add_up_and_each_keeps_its_own_random_numbers():
    noise, drift = {"noise_mps": 0.1}, {"drift_mps": 0.2}
    both = errors(bias_mps=(1.0, 2.0), **noise, **drift).error
    assert both == pytest.approx(errors(**noise).error + errors(**drift).error + [1.0, 2.0], abs=1e-6)
    assert errors(noise_mps=0.2).error == pytest.approx(2.0 * errors(**noise).error)
    assert not np.allclose(errors(seed=2, **noise).error, errors(**noise).error)


def test_a_constant_event_stays_after_its_end():
    event = LogEvent(t_h=0.1, duration_s=100.0, accel_mps2=(0.01, -0.02))
    t = np.array([0.0, 360.0, 400.0, 460.0, 5000.0])
    expected = np.array([0.0, 0.0, 40.0, 100.0, 100.0])[:, None] * [0.01, -0.02]
    assert event_velocity([event], t) == pytest.approx(expected)
    assert errors(event=(event,)).error[400] == pytest.approx([0.4, -0.8])


def test_a_sine_event_is_the_integral_of_its_acceleration():
    event = LogEvent(t_h=0.0, duration_s=95.0, accel_mps2=(0.02, 0.0), sine_hz=0.01)
    t = np.linspace(0.0, 200.0, 200_001)
    acceleration = np.where(t <= 95.0, 0.02 * np.sin(2.0 * math.pi * 0.01 * t), 0.0)
    integral = np.concatenate([[0.0], np.cumsum(0.5 * (acceleration[1:] + acceleration[:-1]) * 1e-3)])
    np.testing.assert_allclose(event_velocity([event], t)[:, 0], integral, rtol=0.0, atol=1e-5)


def test_events_add_up():
    events = [
        LogEvent(t_h=0.0, duration_s=10.0, accel_mps2=(0.1, 0.0)),
        LogEvent(t_h=0.0, accel_mps2=(0.0, 0.2)),
    ]
    assert event_velocity(events, np.array([5.0])) == pytest.approx(np.array([[0.5, 1.0]]))


def test_events_are_east_and_north_also_for_a_log_along_the_axes():
    event = LogEvent(t_h=0.0, duration_s=10.0, accel_mps2=(0.1, 0.0))
    assert errors(truth(), event=(event,), frame="body").error[20:] == pytest.approx(
        np.tile([1.0, 0.0], (581, 1))
    )


def test_outages_take_the_log_away():
    found = errors(outage=(Outage(t_h=0.1, duration_s=60.0),), rate_hz=1.0)
    assert np.flatnonzero(~found.valid).tolist() == list(range(360, 420))


@pytest.mark.parametrize(("rate", "hold"), [(1.0, 5.0), (0.1, 30.0), (10.0, 5.0)])
def test_a_sample_is_held_for_three_intervals_and_at_least_5_s(rate, hold):
    assert errors(rate_hz=rate).hold_s == pytest.approx(hold)


def test_the_state_between_grid_points_is_a_cubic():
    motion = truth(turn=0.0)
    t = np.array([0.0, 0.13, 10.77, 600.0, 601.0])
    velocity, heading = horizontal_state(motion, t)
    speed = 5.0 + 0.01 * np.minimum(t, 600.0)
    assert velocity == pytest.approx(speed[:, None] * [math.sin(0.3), math.cos(0.3)])
    assert heading == pytest.approx(0.3)
    turning, heading = horizontal_state(truth(accel=0.0), t[1:3])
    assert turning == pytest.approx(5.0 * np.column_stack([np.sin(heading), np.cos(heading)]), abs=1e-9)


def test_ship_axes_are_starboard_and_forward():
    heading = np.array([90.0 * DEG])
    assert to_navigation(np.array([[1.0, 0.0]]), heading) == pytest.approx(np.array([[0.0, -1.0]]))
    assert to_navigation(np.array([[0.0, 1.0]]), heading) == pytest.approx(np.array([[1.0, 0.0]]))
    values = np.array([[0.3, -0.7]])
    assert to_ship(to_navigation(values, heading), heading) == pytest.approx(values)


@pytest.mark.parametrize(
    "fields",
    [
        {"noise_mps": -0.1},
        {"rate_hz": 0.0},
        {"bias_mps": (51.0, 0.0)},
        {"bias_mps": (0.0,)},
        {"kind": "g"},
        {"frame": "ned"},
        {"drift_tau_s": 0.0},
        {"delay_s": -1.0},
        {"lsb_mps": -1.0},
        {"scale_ppm": 1e6},
        {"tide_period_h": 0.0},
        {"event": ({"duration_s": 0.0},)},
        {"outage": ({"t_h": -1.0},)},
        {"speed": "air"},
        {"event": ({"accel_mps2": (math.nan, 0.0)},)},
        {"unknown": 1},
    ],
)
def test_fields_out_of_range_are_refused(fields):
    with pytest.raises(ValidationError):
        Reference(**fields)


@pytest.mark.parametrize("frame", ["enu", "body"])
@pytest.mark.parametrize("reading", [{}, {"lsb_mps": 1e-9, "delay_s": 0.0}], ids=["plain", "rounded"])
def test_the_error_in_turns_is_that_by_acceleration_at_a_constant_speed(frame, reading):
    # At a constant speed the acceleration is yaw rate times speed, across the course.
    motion = truth(accel=0.0)
    found = errors(motion, turn_s=0.3, frame=frame, **reading).error
    by_acceleration = errors(motion, acceleration_s=0.3, frame=frame).error
    assert np.hypot(*found.T) == pytest.approx(0.3 * 0.02 * 5.0)
    np.testing.assert_allclose(found, by_acceleration, rtol=0.0, atol=1e-8)


def test_the_error_in_turns_goes_by_the_speed_through_the_water():
    motion, current = truth(accel=0.0), np.array([0.5, -0.4])
    found = errors(motion, turn_s=0.3, current_mps=tuple(current)).error + current
    through = motion.values[::2, [VE, VN]] - current
    np.testing.assert_allclose(found, 0.3 * 0.02 * np.column_stack([through[:, 1], -through[:, 0]]))


@pytest.mark.parametrize("frame", ["enu", "body"])
@pytest.mark.parametrize("rate", [1.0, 0.1])
def test_a_smoothed_reading_lags_by_the_time_constant(frame, rate):
    found = errors(truth(turn=0.0), smoothing_s=40.0, frame=frame, rate_hz=rate)
    forward = found.error @ [math.sin(0.3), math.cos(0.3)]
    assert forward == pytest.approx(-0.01 * 40.0 * -np.expm1(-found.time_s / 40.0))


def test_smoothing_makes_a_drift_of_the_noise_and_lets_a_bias_pass():
    found = errors(
        duration_s=400_000.0, noise_mps=0.3, smoothing_s=20.0, rate_hz=0.5, bias_mps=(0.5, 0.0)
    ).error
    assert found.mean(axis=0) == pytest.approx([0.5, 0.0], abs=0.01)
    white = 0.3 * np.random.default_rng(1).standard_normal(200_000)
    decay = math.exp(-2.0 / 20.0)
    smoothed = np.zeros_like(white)
    for k in range(1, len(white)):
        smoothed[k] = decay * smoothed[k - 1] + (1.0 - decay) * white[k]
    assert found.std(axis=0) == pytest.approx([smoothed.std()] * 2, rel=0.03)
    lagged = found - [0.5, 0.0]
    assert np.mean(lagged[:-10] * lagged[10:]) == pytest.approx(math.exp(-1.0) * lagged.var(), rel=0.06)


@pytest.mark.parametrize(("field", "value"), [("turn_s", 101.0), ("smoothing_s", -1.0)])
def test_errors_in_turns_and_smoothing_have_their_ranges(field, value):
    with pytest.raises(ValueError, match=field):
        Reference(kind="log", **{field: value})
