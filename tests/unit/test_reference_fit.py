"""The fit of a log's error gives back what simulated logs were made with."""

import math
import re

import numpy as np
import pytest

from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG
from navcore.motion.track import TrackMotion
from navcore.motion.truth import AE, AN, COLUMNS, HEADING, VE, VN, Truth
from navcore.scenario.file import load
from navcore.sensors.fit import LogAlongTrack, _autocovariance, fit_delay, fit_log_error, log_along_track
from navcore.sensors.log import reference_errors
from navcore.sensors.recorded import recorded_window
from navcore.sensors.reference import Reference
from navcore.sensors.true_state import horizontal_state, to_ship
from schuler_bench.session.log_fit import can_fit, fit_lines, fit_of, with_fitted_log
from schuler_bench.views.log.picture import log_svg

AT_REST = Truth(0.5, np.zeros((1, COLUMNS)))


def surging(duration_s: float) -> Truth:
    """Heading 040; speed 5 m/s that swings by 1 m/s in 200 s."""
    t = np.arange(int(2 * duration_s) + 1) * 0.5
    swing = 2.0 * math.pi / 200.0
    along = np.array([math.sin(40.0 * DEG), math.cos(40.0 * DEG)])
    values = np.zeros((t.size, COLUMNS))
    values[:, [VE, VN]] = (5.0 + np.sin(swing * t))[:, None] * along
    values[:, [AE, AN]] = (swing * np.cos(swing * t))[:, None] * along
    values[:, HEADING] = 40.0 * DEG
    return Truth(0.5, values)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_bias_noise_and_drift_of_a_long_record_come_back(seed):
    made = Reference(
        kind="log", bias_mps=(0.1, -0.2), noise_mps=0.03, drift_mps=0.05, drift_tau_s=20.0, rate_hz=1.0
    )
    simulated = reference_errors(made, AT_REST, 40_000.0, seed)
    fit = fit_log_error(simulated.time_s, simulated.error, delay_s=12.6)
    assert np.all(np.abs(fit.bias - made.bias_mps) < 4.0 * fit.bias_std)
    # Independent formula: the variance of the mean of a Gauss-Markov process is 2 tau / T of its own.
    assert fit.bias_std == pytest.approx(0.05 * math.sqrt(40.0 / 40_000.0), rel=0.15)
    assert fit.noise == pytest.approx(0.03, rel=0.05)
    assert fit.drift == pytest.approx(0.05, rel=0.05)
    assert fit.drift_tau_s == pytest.approx(20.0, rel=0.15)
    assert (fit.rate_hz, fit.span_s) == pytest.approx((1.0, 40_000.0))
    again = fit.reference()
    assert (again.frame, again.delay_s, again.rate_hz) == ("body", 12.6, 1.0)
    assert (again.noise_mps, again.drift_mps) == pytest.approx((0.03, 0.05), rel=0.06)


def test_a_short_record_gives_a_wide_but_honest_bias():
    deviations = []
    for seed in range(40):
        made = Reference(kind="log", bias_mps=(0.1, -0.2), noise_mps=0.01, drift_mps=0.05, drift_tau_s=20.0)
        simulated = reference_errors(made, AT_REST, 714.0, seed)
        fit = fit_log_error(simulated.time_s, simulated.error)
        deviations += [*((fit.bias - made.bias_mps) / fit.bias_std)]
    # The drift of a short record is underestimated, so the uncertainty is too small, but not by half.
    assert 0.7 < np.std(deviations) < 1.6


def test_white_noise_alone_has_no_drift():
    simulated = reference_errors(Reference(kind="log", noise_mps=0.1), AT_REST, 20_000.0, 1)
    fit = fit_log_error(simulated.time_s, simulated.error)
    assert fit.noise == pytest.approx(0.1, rel=0.03)
    assert fit.drift < 0.02


def test_stamps_that_jitter_do_not_change_the_rate_of_the_fit():
    even = np.arange(2000.0)
    late = 0.05 * (even % 20)  # the logger's loop takes 5 % too long, and catches up
    fit = fit_log_error(even + late, np.random.default_rng(1).normal(0.0, 0.05, (2000, 2)))
    assert fit.rate_hz == pytest.approx(1.0, rel=0.001)


def test_a_perfect_log_fits_to_nothing():
    fit = fit_log_error(np.arange(100.0), np.zeros((100, 2)))
    assert (fit.noise, fit.drift) == (0.0, 0.0)
    assert fit.reference().drift_mps == 0.0


def test_the_delay_of_a_log_is_found_and_taken_out():
    motion = surging(1200.0)
    made = Reference(kind="log", frame="body", bias_mps=(0.1, -0.2), noise_mps=0.02, delay_s=12.6)
    simulated = reference_errors(made, motion, 1200.0, 1)
    velocity, heading = horizontal_state(motion, simulated.time_s)
    log = LogAlongTrack(simulated.time_s, to_ship(velocity + simulated.error, heading), motion)
    assert np.std(log.error()[1][:, 1]) > 0.2
    delay = fit_delay(log)
    assert delay == pytest.approx(12.6, abs=0.3)
    fit = fit_log_error(*log.error(delay), delay_s=delay)
    assert fit.bias == pytest.approx([0.1, -0.2], abs=0.005)
    assert fit.noise == pytest.approx(0.02, rel=0.1)
    assert fit.drift < 0.006


def test_too_short_records_are_refused():
    with pytest.raises(InputError, match="a fit needs 50"):
        fit_log_error(np.arange(49.0), np.zeros((49, 2)))
    with pytest.raises(InputError, match="a fit needs 50"):
        fit_delay(LogAlongTrack(np.arange(80.0), np.zeros((80, 2)), AT_REST))


def test_the_autocovariance_is_the_mean_of_products():
    values = np.random.default_rng(1).standard_normal((200, 2))
    found = _autocovariance(values, 20)
    for lag in (0, 1, 19):
        assert found[lag] == pytest.approx(np.mean(values[: 200 - lag] * values[lag:], axis=0))


# ---------------------------------------------------------------- the fit that the tab Log offers


def test_the_recorded_ships_log_errs_as_the_preset_that_was_fitted_to_it() -> None:
    recorded = load("sikuliaq-recorded")
    assert can_fit(recorded)
    fitted = fit_of(recorded)
    fit = fitted.fit
    like = load("sikuliaq-like").reference
    assert fit.delay_s == pytest.approx(like.delay_s, abs=0.5)
    assert tuple(fit.bias) == pytest.approx(like.bias_mps, abs=0.005)
    assert f"Delay {fit.delay_s:.1f} s." in fit_lines(fitted)
    made = with_fitted_log(recorded, fit)
    assert made.reference.kind == "log" and made.reference.bias_mps == fit.reference().bias_mps
    assert made.motion == recorded.motion and not can_fit(made)


def test_both_speeds_of_the_log_are_fitted_and_the_stream_is_named() -> None:
    """Through the water the tidal stream looks like a drift of the log."""
    recorded = load("sikuliaq-recorded")
    through = recorded.reference.model_copy(update={"speed": "water"})
    fitted = fit_of(recorded.model_copy(update={"reference": through}))
    assert fitted.other is not None and fitted.other_speed == "ground"
    assert fitted.fit.drift == pytest.approx(0.388, abs=0.002)
    assert fitted.other.drift == pytest.approx(0.020, abs=0.002)
    told = "\n".join(fit_lines(fitted))
    assert 'its drift is 0.020 m/s; choose it by speed = "ground"' in told and "stream" in told


def test_the_picture_shows_log_and_ship_and_what_lies_between_them() -> None:
    fitted = fit_of(load("sikuliaq-recorded"))
    svg = log_svg(fitted.log, fitted.fit.delay_s)
    ship, log, difference = (
        np.array([point.split(",") for point in points.split()], float)
        for points in re.findall(r'polyline points="([^"]+)"', svg)
    )
    assert ship.shape == log.shape == difference.shape and len(ship) == 240
    assert np.all(np.diff(ship[:, 0]) > 0.0)
    # in pixels of one scale, the two curves lie as far apart as the fit says
    assert np.corrcoef(log[:, 1] - ship[:, 1], difference[:, 1])[0, 1] > 0.999
    late = re.findall(r'polyline points="([^"]+)"', log_svg(fitted.log, 0.0))[2]
    assert np.ptp([float(point.split(",")[1]) for point in late.split()]) > 0.0


def test_the_true_motion_ends_with_the_time_that_log_and_track_share() -> None:
    scenario = load("sikuliaq-recorded")
    assert isinstance(scenario.motion, TrackMotion)
    window = recorded_window(scenario.motion, scenario.reference)
    assert window is not None
    log = log_along_track(scenario.reference, scenario.motion)
    end_s = (len(log.truth.values) - 1) * log.truth.step_s
    assert window.span_s - log.truth.step_s < end_s <= window.span_s
    assert 0.0 <= log.time_s[0] < log.time_s[-1] <= end_s


def test_without_recordings_there_is_nothing_to_fit() -> None:
    scenario = load("sikuliaq-like")
    assert not can_fit(scenario)
    with pytest.raises(InputError, match="recorded track"):
        fit_of(scenario)
