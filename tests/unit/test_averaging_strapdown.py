"""Averaging with the strapdown algorithm: against the linear model, and no faults at 0 and 180 deg."""

import math
from dataclasses import replace

import numpy as np
import pytest

from navcore.averaging import Averaging
from navcore.averaging.strapdown import start_strapdown
from navcore.foundation.earth import WGS84
from navcore.foundation.units import ARCSEC, DEG
from navcore.mechanization.strapdown import Settings, start_from
from navcore.mechanization.strapdown.records import NAVIGATION
from navcore.motion.static import StaticMotion
from navcore.sensors.imu import Imu
from navcore.sensors.imu_simulation import ImuSimulation
from tests.averaging import INITIAL, SITE, averaged, free_law, made

LEVEL_NORTH = StaticMotion()
SMALL = INITIAL * 0.05
"""So small that the linear model errs by less than is asserted."""


def navigate(plan, hours, initial, motion=LEVEL_NORTH, site=SITE, imu=None, chunk=None, rate=10.0):
    samples, second = round(hours * 3600 * rate), round(rate)
    source = ImuSimulation(motion, site, WGS84, imu or Imu(), rate, samples, 1)
    truth = source.truth_rows(samples // second + 1, 1.0)
    run = start_strapdown(
        plan, start_from(truth[0], initial), Settings(rate, samples, second, second, 600.0), WGS84, free_law,
        truth, source.before(),
    )  # fmt: skip
    for increments, _ in source.chunks():
        step = chunk or len(increments)
        if any(run.advance(increments[i : i + step]) for i in range(0, len(increments), step)):
            break
    return run


@pytest.mark.parametrize(
    "averaging", [Averaging(), Averaging(variant="cascade", earth=False)], ids=["schuler", "cascade"]
)
def test_it_agrees_with_the_linear_model(averaging):
    imu = Imu(gyro_bias_dph=(0.002, -0.001, 0.001), accel_bias_ug=(2.0, -3.0, 0.0))
    plan = made(averaging, earth=WGS84, imu=imu)
    run = navigate(plan, 4.0, SMALL, imu=imu)
    linear = averaged(plan, 14_400, earth=WGS84, imu=imu, initial=SMALL).recorder.rows[::10]
    found = run.recorder.rows
    assert run.position == 144_000
    scale = np.abs(linear[:, :8]).max(axis=0)
    np.testing.assert_allclose(found[:, :8] / scale, linear[:, :8] / scale, atol=2e-3)


def test_navigation_is_the_truth_and_the_averaged_errors():
    site = replace(SITE, lon=math.pi - 1e-5)
    plan = made(Averaging(), earth=WGS84)
    run = navigate(plan, 1.0, INITIAL, site=site)
    rows = run.recorder.rows
    solution = dict(zip(NAVIGATION, run.navigation.T, strict=True))
    meridian, prime = WGS84.radii(SITE.lat)
    np.testing.assert_allclose((solution["lat_rad"] - SITE.lat) * meridian, rows[:, 5], atol=1e-6)
    np.testing.assert_allclose(
        (solution["lon_rad"] - site.lon) * prime * math.cos(SITE.lat), rows[:, 6], atol=1e-6
    )
    np.testing.assert_allclose(solution["ve_mps"], rows[:, 3], atol=1e-12)
    # level and north: dpitch = -phi_E, droll = -phi_N, dpsi = phi_U (theory.md section 2)
    np.testing.assert_allclose(solution["pitch_rad"], -rows[:, 0], atol=1e-2 * ARCSEC)
    np.testing.assert_allclose(solution["roll_rad"], -rows[:, 1], atol=2e-1 * ARCSEC)
    heading = np.remainder(solution["heading_rad"] + math.pi, 2 * math.pi) - math.pi
    np.testing.assert_allclose(heading, rows[:, 2], atol=1e-2 * ARCSEC)


def test_copies_on_either_side_of_north_average_to_north():
    plan = made(Averaging(earth=False), earth=WGS84)
    # half a Schuler period changes the sign of what a heading error does to the level channels, not of itself
    for heading_deg in (359.9999, 0.0001):
        run = navigate(plan, 0.2, np.zeros(7), motion=StaticMotion(heading_deg=heading_deg))
        heading = run.navigation[:, NAVIGATION.index("heading_rad")]
        off = np.remainder(heading - heading_deg * DEG + math.pi, 2 * math.pi) - math.pi
        assert np.abs(off).max() < 1e-2 * ARCSEC


def test_chunks_do_not_change_the_result():
    plan = made(Averaging(variant="cascade", earth=False), earth=WGS84)
    whole, pieces = navigate(plan, 0.5, INITIAL), navigate(plan, 0.5, INITIAL, chunk=73)
    np.testing.assert_array_equal(whole.recorder.rows, pieces.recorder.rows)
    np.testing.assert_array_equal(whole.navigation, pieces.navigation)
    assert whole.recorder.cursor["count"] == pieces.recorder.cursor["count"] == 1801


def test_a_copy_that_fails_stops_the_method():
    plan = made(Averaging(), earth=WGS84)
    run = navigate(plan, 0.5, np.array([9.99e3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.9]))
    assert run.diverged
    assert run.reason
