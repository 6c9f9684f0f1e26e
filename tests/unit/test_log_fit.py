"""The fit that the tab Log offers: the recorded log against the recorded track, and a log that errs alike."""

import pytest

from app.session.log_fit import can_fit, fit_of, told, with_fitted_log
from navcore.foundation.errors import InputError
from navcore.motion.track import TrackMotion
from navcore.scenario.file import load
from navcore.sensors.fit import log_along_track
from navcore.sensors.recorded import recorded_window


def test_the_recorded_ships_log_errs_as_the_preset_that_was_fitted_to_it() -> None:
    recorded = load("sikuliaq-recorded")
    assert can_fit(recorded)
    fit = fit_of(recorded)
    like = load("sikuliaq-like").reference
    assert fit.delay_s == pytest.approx(like.delay_s, abs=0.5)
    assert tuple(fit.bias) == pytest.approx(like.bias_mps, abs=0.005)
    assert f"Delay {fit.delay_s:.1f} s." in told(fit)
    made = with_fitted_log(recorded, fit)
    assert made.reference.kind == "log" and made.reference.bias_mps == fit.reference().bias_mps
    assert made.motion == recorded.motion and not can_fit(made)


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
