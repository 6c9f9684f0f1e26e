"""The preset `sikuliaq-like`: its log error is the one that the fit to the R/V Sikuliaq's log gives."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from navcore.motion.track import TrackMotion
from navcore.sensors.fit import fit_delay, fit_log_error, log_along_track
from navcore.sensors.reference import Reference
from tests.recordings import ship

SHIP = ship()
REFERENCE = Reference(kind="file", file=SHIP.log, speed="ground")


@pytest.fixture(scope="module")
def preset(repo_root: Path) -> dict:
    return tomllib.loads(
        (repo_root / "assets" / "presets" / "sikuliaq-like.toml").read_text(encoding="utf-8")
    )


@pytest.fixture(scope="module")
def log():
    return log_along_track(REFERENCE, TrackMotion(file=SHIP.track))


def test_the_fit_gives_the_numbers_of_the_preset(preset, log):
    delay = fit_delay(log)
    fit = fit_log_error(*log.error(delay), delay_s=delay)
    stated = preset["reference"]
    found = fit.reference().model_dump(include=set(stated), mode="json")
    if SHIP.raw:
        assert stated == found
    assert delay == pytest.approx(12.6, abs=0.1)
    assert fit.bias == pytest.approx([-0.051, -0.027], abs=0.002)
    assert fit.bias_std == pytest.approx([0.0034, 0.0037], abs=0.001)
    assert fit.noise == pytest.approx(0.007, abs=0.002)
    assert fit.drift == pytest.approx(0.020, abs=0.002)
    assert fit.drift_tau_s == pytest.approx(11.5, rel=0.2)
    assert 695.0 < fit.span_s < 714.0


def test_the_delay_is_real_both_axes_err_less_with_it(log):
    plain, delayed = log.error()[1][20:], log.error(12.6)[1]
    assert np.all(delayed.std(axis=0) < 0.7 * plain.std(axis=0))


def test_the_fit_does_not_hang_on_the_smoothing_of_the_track():
    for smoothing in (2.0, 10.0):
        other = log_along_track(REFERENCE, TrackMotion(file=SHIP.track, smoothing_s=smoothing))
        delay = fit_delay(other)
        fit = fit_log_error(*other.error(delay), delay_s=delay)
        assert delay == pytest.approx(12.6, abs=0.4)
        assert fit.bias == pytest.approx([-0.051, -0.027], abs=0.003)
        # What is left beside the bias is 0.02 m/s: how much of it is noise the smoothing decides.
        assert np.hypot(fit.noise, fit.drift) == pytest.approx(0.023, abs=0.006)


def test_the_preset_names_where_its_error_comes_from(preset):
    assert "fitted to the R/V Sikuliaq Doppler speed log of 2018-12-06, 714 s" in preset["source"]
    assert preset["run"]["duration_h"] == 10.0
    assert [method["name"] for method in preset["method"]] == ["free", "classic2", "complementary"]
