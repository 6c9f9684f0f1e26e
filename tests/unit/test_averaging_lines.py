"""Amplitudes by least squares on known lines."""

import numpy as np
import pytest

from navcore.averaging.copies import split_schuler_lines
from navcore.averaging.lines import LINES, line_amplitudes, line_phases
from navcore.foundation.earth import EARTH_RATE, WGS84
from navcore.motion.base import VE
from tests.averaging import SITE, truth_row

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
