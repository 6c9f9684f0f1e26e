"""Coarse and fine alignment (theory.md 6.1): residuals, steady state, noise, refusals, in a scenario."""

import numpy as np
import pytest

from navcore.alignment.fine import (
    CompassLoop,
    coarse_alignment,
    fine_alignment,
    steady_misalignment,
)
from navcore.engine.alignment_start import aligned_start, start_errors
from navcore.foundation.earth import EARTH_RATE, WGS84
from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG, DEG_PER_HOUR, MICRO_G
from navcore.mechanization.strapdown.attitude import misalignment, quaternion_of
from navcore.mechanization.strapdown.run import turned_by
from navcore.motion.static import StaticMotion
from navcore.motion.truth import HEADING, PITCH, ROLL
from navcore.networks.azimuth_loop import azimuth_gains
from navcore.scenario.model import Scenario
from navcore.sensors.imu import Imu
from navcore.sensors.imu_simulation import ImuSimulation
from tests.strapdown import DENG_SWING, SITE

TILTED = StaticMotion(pitch_deg=6.0, roll_deg=8.0, heading_deg=75.0)
GRAVITY = WGS84.gravity(SITE.lat)


def _record(motion, imu, seconds, rate_hz, seed=1):
    samples = int(seconds * rate_hz)
    sim = ImuSimulation(motion, SITE, WGS84, imu, rate_hz, samples, seed)
    increments = np.concatenate([chunk.copy() for chunk, _ in sim.chunks()])
    rows = sim.truth_rows(seconds + 1, 1.0)
    first, last = (np.array(quaternion_of(*rows[i][[PITCH, ROLL, HEADING]])) for i in (0, -1))
    return increments, first, last


def _fine(motion, imu, seconds=600, rate_hz=50.0, seed=1, loop=None):
    increments, first, last = _record(motion, imu, seconds, rate_hz, seed)
    start = turned_by(-np.array([0.1, 0.1, 1.0]) * DEG, first)
    aligned = fine_alignment(increments, rate_hz, start, SITE.lat, SITE.height, WGS84, loop)
    return np.array(misalignment(*aligned.quaternion, *last)), aligned


@pytest.mark.parametrize("motion", [TILTED, DENG_SWING], ids=["static", "swing"])
def test_noise_free_residual(motion):
    phi, aligned = _fine(motion, Imu(), rate_hz=200.0 if motion is DENG_SWING else 50.0)
    assert np.abs(phi[:2]).max() <= 1e-5 * DEG
    assert abs(phi[2]) <= 0.003 * DEG
    assert np.abs(aligned.velocity).max() < 1e-4


def test_steady_state_formulas_to_one_percent():
    level = StaticMotion()
    imu = Imu(gyro_bias_dph=(0.02, 0.02, 0.02), accel_bias_ug=(50.0, -80.0, 0.0))
    phi, _ = _fine(level, imu, seconds=1500)
    eps, nabla = np.full(3, 0.02 * DEG_PER_HOUR), np.array([50.0, -80.0, 0.0]) * MICRO_G
    wanted = steady_misalignment(eps, nabla, SITE.lat, GRAVITY, CompassLoop())
    np.testing.assert_allclose(phi, wanted, rtol=0.01)


def test_angular_random_walk_alone_gives_0_14_deg_of_heading():
    imu = Imu(gyro_arw_dpsh=0.006)
    heading = [_fine(StaticMotion(), imu, rate_hz=20.0, seed=seed)[0][2] / DEG for seed in range(80)]
    assert np.std(heading) == pytest.approx(0.14, rel=0.25)


def test_azimuth_poles_are_those_of_the_design():
    sigma, xi, omega_s = 0.02, 0.707, 1.24e-3
    k1, k2, k3, k4 = azimuth_gains(sigma, xi, omega_s, GRAVITY)
    # (s + k4) [s (s + k1) + (1 + k2) ws^2] + g k3, from the north channel with the azimuth loop closed
    got = np.polyadd(np.polymul([1, k4], [1, k1, (1 + k2) * omega_s**2, 0]), [GRAVITY * k3])
    design = np.polymul([1, 2 * sigma, sigma**2 / xi**2], [1, 2 * sigma, sigma**2 / xi**2])
    np.testing.assert_allclose(got, design, rtol=1e-9)


@pytest.mark.parametrize(
    ("motion", "seconds", "rate_hz", "most"),
    [
        (DENG_SWING, 120, 100.0, 0.01 * DEG),
        *(
            (StaticMotion(pitch_deg=6.0, roll_deg=-8.0, heading_deg=heading), 600, 20.0, 1e-5)
            for heading in (0.0, 75.0, 200.0)
        ),
    ],
    ids=["swing", "north", "east", "south"],
)
def test_the_coarse_attitude_of_perfect_sensors_is_the_true_one(motion, seconds, rate_hz, most):
    """At rest what is left is that a mean of gravity lies inside the cone on which it turns."""
    increments, _, last = _record(motion, Imu(), seconds, rate_hz)
    found = coarse_alignment(increments, rate_hz, SITE.lat)
    np.testing.assert_allclose(misalignment(*found, *last), 0.0, atol=most)


def test_high_latitudes_are_refused_with_the_reason():
    increments = np.tile([0.0, 0, 0, 0, 0, 0.098], (100, 1))
    for call in (
        lambda: coarse_alignment(increments, 100.0, 85.5 * DEG),
        lambda: fine_alignment(increments, 100.0, np.array([1.0, 0, 0, 0]), -86.0 * DEG, 0.0, WGS84),
    ):
        with pytest.raises(InputError, match="85°.*horizontal Earth rate"):
            call()


def test_a_record_without_earth_rate_or_gravity_is_refused():
    still = np.tile([0.0, 0, 0, 0, 0, 0.098], (6000, 1))
    with pytest.raises(InputError, match="does not turn"):
        coarse_alignment(still, 100.0, SITE.lat)
    with pytest.raises(InputError, match="no specific force"):
        coarse_alignment(np.zeros((6000, 6)), 100.0, SITE.lat)


def test_a_loop_too_fast_for_the_imu_is_refused():
    with pytest.raises(InputError, match="alignment.sigma"):
        fine_alignment(
            np.zeros((10, 6)), 1.0, np.array([1.0, 0, 0, 0]), 0.5, 0.0, WGS84, CompassLoop(sigma=1.0)
        )


# ---------------------------------------------------------------- coarse alignment in a scenario

SWING = {
    "kind": "swing",
    **{axis: {"amplitude_deg": 6.0, "frequency_hz": 0.1} for axis in ("roll", "heading")},
}
QUICK = {"kind": "compass", "duration_s": 121.0, "coarse_s": 120.0}
"""The compass loop has a second: what the coarse alignment found is left."""


def _started(alignment, motion=None, **blocks):
    scenario = Scenario.parse(
        {
            "run": {"fidelity": "strapdown", "rate_hz": 50.0},
            "alignment": alignment,
            "motion": motion or {"kind": "static", "heading_deg": 75.0},
            **blocks,
        }
    )
    row = scenario.motion.truth(1, 1.0, scenario.site.site(), scenario.earth).values[0]
    return start_errors(aligned_start(scenario, row), row)[4:7]


@pytest.mark.parametrize("motion", [None, SWING], ids=["static", "swing"])
def test_a_coarse_alignment_finds_the_attitude_that_nobody_told(motion):
    """At rest the cone's share is left. Without it the compass loop starts from the true attitude."""
    found, told = (_started(alignment, motion) for alignment in (QUICK, QUICK | {"coarse_s": 0.0}))
    assert np.abs(found).max() < (0.02 if motion else 0.001) * DEG
    assert not np.array_equal(found, told)


def test_an_east_gyro_bias_turns_the_coarse_north():
    """The compass error of 6.1, -eps_E / (Omega cos L), is the coarse part's; without it there is none."""
    imu = {"gyro_bias_dph": [0.5, 0.0, 0.0]}
    level = {"kind": "static"}
    found = _started(QUICK, level, imu=imu)[2]
    lat = 32.06 * DEG
    wanted = -0.5 * DEG_PER_HOUR / (EARTH_RATE * np.cos(lat))
    assert found == pytest.approx(wanted, rel=0.02)
    without = _started(QUICK | {"coarse_s": 0.0, "level_s": 119.0, "sigma": 1e-4}, level, imu=imu)[2]
    assert abs(without) < 0.02 * abs(wanted)


def test_the_initial_error_is_added_to_what_the_coarse_alignment_finds():
    error = {"attitude_arcmin": [0.0, 0.0, 60.0]}
    assert _started(QUICK, initial_error=error)[2] == pytest.approx(1.0 * DEG, rel=0.02)


@pytest.mark.parametrize(
    ("alignment", "why"),
    [
        ({"coarse_s": 10.0}, "must be 0 or >= 30"),
        ({"kind": "compass", "duration_s": 100.0, "coarse_s": 100.0}, "must be < 100"),
    ],
)
def test_a_coarse_alignment_that_is_too_short_or_too_long_is_refused(alignment, why):
    with pytest.raises(InputError, match=f"alignment.coarse_s.*{why}"):
        Scenario.parse({"run": {"fidelity": "strapdown"}, "alignment": alignment})
