"""The fit that the tab Log offers: the recorded log against the recorded track, and a log that errs alike."""

from __future__ import annotations

import pytest

from app.session.log_fit import can_fit, fit_of, told, with_fitted_log
from navcore.foundation.errors import InputError
from navcore.scenario.file import load


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


def test_without_recordings_there_is_nothing_to_fit() -> None:
    scenario = load("sikuliaq-like")
    assert not can_fit(scenario)
    with pytest.raises(InputError, match="recorded track"):
        fit_of(scenario)
