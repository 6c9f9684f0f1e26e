"""Zhao 2015, figure 12: turntable, full strapdown mechanization, forecast from a disturbed alignment.

At 20 Hz instead of 100: the table swings with 0.05 Hz, and the noise of a second is the same.
"""

from __future__ import annotations

import pytest

from navcore.engine.run import Run
from navcore.mechanization.strapdown.records import NAVIGATION
from tests.acceptance.zhao import LEVEL, SLOW, amplitudes, run_preset, schuler

SLOWER = "run.rate_hz=20"


@pytest.fixture(scope="module")
def run() -> Run:
    return run_preset("zhao-turntable", SLOWER)


@pytest.fixture(scope="module")
def lines(run):
    return amplitudes(run)


def test_the_setting_is_the_papers(run):
    scenario = run.scenario
    assert scenario.run.duration_h == 25.0
    assert scenario.alignment.duration_s == 600.0
    assert [motion.t_s for motion in scenario.alignment.motion] == [-500.0, -402.0]
    assert scenario.initial_error.attitude_arcmin == (0.15, 0.14, 1.3)


def test_the_disturbed_seconds_are_left_out_of_the_forecast(run):
    zhao = next(m for m in run.methods if m.method.name == "Zhao")
    assert any("18 s of 600 s were left out" in text for text in zhao.warnings)


@pytest.mark.parametrize("quantity", LEVEL)
def test_schuler_oscillation_is_halved(lines, quantity):
    # what stays was raised by noise after t = 0
    assert schuler(lines["Zhao"][quantity]) < 0.6 * schuler(lines["free"][quantity])


@pytest.mark.parametrize("quantity", SLOW)
def test_24_h_oscillation_of_heading_and_latitude_falls_to_a_tenth(lines, quantity):
    assert lines["Zhao"][quantity][2] < 0.1 * lines["free"][quantity][2]


def test_a_disturbed_alignment_is_as_good_as_a_calm_one(lines):
    calm = amplitudes(run_preset("zhao-turntable", SLOWER, "alignment.motion=[]"))
    for quantity in LEVEL:
        assert schuler(lines["Zhao"][quantity]) == pytest.approx(schuler(calm["Zhao"][quantity]), rel=0.1)


def test_navigation_stays_at_the_table(run):
    for method in run.methods:
        assert method.status == "ok"
        assert method.navigation is not None
        longitude = method.navigation[:, NAVIGATION.index("lon_rad")]
        assert abs(longitude - run.truth[0, 1]).max() < 0.005
