"""Which copies there are, how far each is ahead, and the amplitudes of their lines."""

import math

import numpy as np
import pytest

from navcore.averaging.combine import averaged_rows
from navcore.averaging.copies import HALF_SIDEREAL_DAY, Copies, copies_of, split_schuler_lines
from navcore.averaging.lines import LINES, line_amplitudes, line_phases
from navcore.averaging.parameters import Averaging
from navcore.foundation.earth import EARTH_RATE, SPHERE, WGS84
from navcore.foundation.units import DEG
from navcore.mechanization.error_model import system_matrix
from navcore.mechanization.recorder import D_LAT, D_LON, DV_E, PHI_U, POSITION, ROW_COLUMNS
from navcore.motion.truth import VE
from tests.averaging import SITE, truth_row

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
