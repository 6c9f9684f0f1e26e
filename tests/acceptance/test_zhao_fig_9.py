"""Zhao 2015, figure 9: the same with sensor errors. The claim for the tilt needs quiet sensors."""

from __future__ import annotations

import pytest

from tests.acceptance.zhao import LEVEL, SLOW, amplitudes, run_preset, schuler


@pytest.fixture(scope="module")
def printed():
    return amplitudes(run_preset("zhao-sensors"))


@pytest.fixture(scope="module")
def quiet():
    return amplitudes(run_preset("zhao-sensors", "imu.gyro_arw_dpsh=0", "imu.accel_vrw_ugpshz=0"))


@pytest.mark.parametrize("quantity", SLOW)
def test_24_h_oscillation_of_heading_and_latitude_falls(printed, quantity):
    assert printed["Zhao"][quantity][2] < 0.35 * printed["free"][quantity][2]


@pytest.mark.parametrize("quantity", LEVEL)
def test_schuler_oscillation_from_biases_falls_like_that_from_initial_errors(quiet, quantity):
    assert schuler(quiet["Zhao"][quantity]) < 0.08 * schuler(quiet["free"][quantity])
    assert schuler(quiet["four copies"][quantity]) < 0.025 * schuler(quiet["free"][quantity])


@pytest.mark.parametrize("quantity", LEVEL)
def test_noise_after_the_start_passes_through_every_average(printed, quiet, quantity):
    # sixty arc-seconds of tilt, in four and eight copies as in two: averaging changes the state at t = 0 only
    for method in ("Zhao", "four copies", "eight copies"):
        assert schuler(printed[method][quantity]) > 10.0 * schuler(quiet[method][quantity])
        assert schuler(printed[method][quantity]) == pytest.approx(
            schuler(printed["eight copies"][quantity]), rel=0.05
        )
