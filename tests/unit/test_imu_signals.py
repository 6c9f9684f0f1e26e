"""What perfect sensors feel, against numeric differentiation in the inertial and the Earth frame."""

import math

import numpy as np
import pytest

from navcore.foundation.earth import EARTH_RATE, SPHERE, WGS84, Earth, attitude_matrix
from navcore.foundation.units import DEG
from navcore.motion import LegsMotion, StaticMotion, SwingMotion
from navcore.motion.base import MotionParameters
from navcore.motion.inertial import inertial_signals
from navcore.motion.truth import AE, HEADING, LAT, LON, PITCH, ROLL, VE, VU, Site

SITE = Site(60.0 * DEG, 20.0 * DEG, 100.0)
STEP = 0.01
OMEGA = np.array([0.0, 0.0, EARTH_RATE])

SWING = SwingMotion(
    pitch_deg=8.0,
    roll_deg=6.0,
    heading_deg=75.0,
    pitch={"amplitude_deg": 10.0, "frequency_hz": 0.2},
    roll={"amplitude_deg": 12.0, "frequency_hz": 0.125},
    heading={"amplitude_deg": 6.0, "frequency_hz": 0.15},
)
LEGS = LegsMotion(
    pitch_deg=3.0,
    roll_deg=-20.0,
    leg=[{"duration_s": 60.0, "speed_mps": 200.0, "heading_deg": 20.0, "accel_mps2": -0.5, "turn_dps": 3.0}],
)


def _earth_frame(lat: float, lon: float) -> np.ndarray:
    """C_n^e for n = east, north, up."""
    sl, cl, so, co = math.sin(lat), math.cos(lat), math.sin(lon), math.cos(lon)
    return np.array([[-so, -sl * co, cl * co], [co, -sl * so, cl * so], [0.0, cl, sl]])


def _spin(t: float) -> np.ndarray:
    s, c = math.sin(EARTH_RATE * t), math.cos(EARTH_RATE * t)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def _numeric(motion: MotionParameters, count: int, earth: Earth) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rates and forces by fourth-order differences of C_b^i and of the Earth-frame velocity."""
    values = motion.truth(count, STEP, SITE, earth).values
    if len(values) == 1:
        values = np.repeat(values, count, axis=0)
    to_earth = [_earth_frame(row[LAT], row[LON]) for row in values]
    attitude = [attitude_matrix(row[PITCH], row[ROLL], row[HEADING]) for row in values]
    body = np.array([_spin(k * STEP) @ to_earth[k] @ attitude[k] for k in range(count)])
    velocity = np.array([to_earth[k] @ values[k, VE : VU + 1] for k in range(count)])

    def derivative(x: np.ndarray) -> np.ndarray:
        return (8.0 * (x[3:-1] - x[1:-3]) - (x[4:] - x[:-4])) / (12.0 * STEP)

    turning = np.einsum("kji,kjl->kil", body[2:-2], derivative(body))
    rate = np.stack([turning[:, 2, 1], turning[:, 0, 2], turning[:, 1, 0]], axis=1)
    force = np.empty_like(rate)
    for k, acceleration in enumerate(derivative(velocity), start=2):
        gravity = to_earth[k] @ [0.0, 0.0, -earth.gravity(values[k, LAT], SITE.height)]
        felt = acceleration + 2.0 * np.cross(OMEGA, velocity[k]) - gravity
        force[k - 2] = attitude[k].T @ to_earth[k].T @ felt
    return values, rate, force


@pytest.mark.parametrize("earth", [WGS84, SPHERE], ids=lambda earth: earth.name)
@pytest.mark.parametrize(
    "motion", [StaticMotion(pitch_deg=20.0, roll_deg=40.0, heading_deg=310.0), SWING, LEGS]
)
def test_against_numeric_differentiation(motion: MotionParameters, earth: Earth) -> None:
    count = 1001
    signals = inertial_signals(motion.truth(count, STEP, SITE, earth), earth)
    _, rate, force = _numeric(motion, count, earth)
    inner = signals[2:-2] if len(signals) > 1 else np.repeat(signals, count - 4, axis=0)
    assert np.abs(inner[:, :3] - rate).max() < 1e-9
    assert np.abs(inner[:, 3:] - force).max() < 1e-8


def test_the_level_body_feels_only_its_two_channels() -> None:
    truth = LEGS.truth(101, 0.5, SITE, WGS84)
    signals = inertial_signals(truth, WGS84, level_body=True)
    meridian, normal = WGS84.radii(SITE.lat)
    v = truth.values[0, VE : VU + 1]
    assert signals[0, :3] == pytest.approx([-v[1] / (meridian + 100.0), v[0] / (normal + 100.0), 0.0])
    assert signals[:, 3:5] == pytest.approx(truth.values[:, AE : AE + 2])
    assert signals[0, 5] == pytest.approx(WGS84.gravity(SITE.lat, 100.0))
