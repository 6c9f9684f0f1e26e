"""Perfect sensors on every motion return to the truth, and the error falls with the rate (theory.md 6).

Largest errors over the run at 200 Hz (rad, m/s, m) as measured, and the order of the fall from 50 to 400 Hz:

    swing (Deng), 1.5 h      6.1e-10  1.8e-6   4.5e-3   3
    legs, 1.5 h              6.1e-12  9.8e-10  2.7e-6   attitude 3, velocity 2 (see below)
    profile, 1.5 h           7.1e-10  7.2e-9   1.4e-5   3
    profile (Zhao), 6 h      9.1e-14  5.1e-11  1.0e-6   rounding
    profile (Sun), 1.5 h     4.9e-14  4.7e-10  5.7e-8   2
    waves, altimeter, 1.5 h  1.6e-10  1.0e-7   2.8e-4   4, attitude and velocity
    track, 20 min            5.6e-13  7.5e-9   3.2e-6   2: a cubic spline's jerk jumps

Coning, sculling and the turn of the velocity increment are of order 3; the Coriolis and transport terms,
taken at the middle of the interval with the velocity extrapolated from the last one, are of order 2. On
`legs` the body turns and accelerates so little that the second kind decides the velocity: a change of speed
alone is of order 2.
"""

from typing import Any

import numpy as np
import pytest

from navcore.foundation.earth import EARTH_RATE
from navcore.mechanization.recorder import DV_E, DV_N, MAX_ABS, PHI_E, PHI_N, PHI_U, POSITION
from navcore.motion.base import MotionParameters
from navcore.motion.legs import Leg, LegsMotion
from navcore.motion.profile import ProfileMotion
from navcore.motion.truth import HEIGHT
from tests.motions import MANOEUVRES, SEA, ZHAO, circle_track
from tests.strapdown import DENG_SWING, DRIVE, SITE, WGS84, navigate

SUN_STEP = ProfileMotion.model_validate(
    {
        "shape": "triangle",
        "point": [
            {"speed_kn": 2.0, "course_deg": 45.0},
            {"t_s": 600.0},
            {"t_s": 840.0, "speed_kn": 10.0},
        ],
    }
)
CHANGE_OF_SPEED = LegsMotion(
    heading_deg=30.0, leg=(Leg(duration_s=100.0, speed_mps=0.0), Leg(duration_s=600.0, speed_mps=8.0))
)
ATTITUDE, VELOCITY = [PHI_E, PHI_N, PHI_U], [DV_E, DV_N]


def worst(motion: MotionParameters, rate_hz: float, duration_s: float, **settings: Any) -> np.ndarray:
    """Largest error of attitude (rad), velocity (m/s), position (m)."""
    stats = navigate(motion, rate_hz, duration_s, **settings).recorder.stats[:, MAX_ABS]
    return np.array([stats[ATTITUDE].max(), stats[VELOCITY].max(), stats[POSITION]])


@pytest.mark.parametrize(
    ("motion", "duration_s", "vertical", "limits"),
    [
        (DENG_SWING, 5400.0, "locked", (1.5e-9, 4e-6, 0.01)),
        (DRIVE, 5400.0, "locked", (1.5e-11, 2e-9, 1e-5)),
        (MANOEUVRES, 5400.0, "locked", (1.5e-9, 1.5e-8, 5e-5)),
        (ZHAO, 21600.0, "locked", (1e-12, 2e-10, 1e-5)),
        (SUN_STEP, 5400.0, "locked", (1e-12, 1e-9, 5e-6)),
        (SEA, 5400.0, "altimeter", (5e-10, 3e-7, 1e-3)),
    ],
    ids=["deng-swing", "legs", "profile", "zhao", "sun", "waves"],
)
def test_perfect_sensors_at_200_hz(motion, duration_s, vertical, limits):
    errors = worst(motion, 200.0, duration_s, vertical=vertical)
    assert (errors <= limits).all(), errors
    assert (errors <= (1e-8, 1e-5, 0.05)).all(), errors


def test_perfect_sensors_on_a_recorded_track(tmp_path):
    errors = worst(circle_track(tmp_path), 200.0, 1190.0)
    assert (errors <= (2e-12, 2e-8, 1e-5)).all(), errors


ORDERS: dict[str, tuple[MotionParameters, str, tuple[float, float]]] = {
    "swing (Deng)": (DENG_SWING, "locked", (3.0, 3.0)),
    "legs": (DRIVE, "locked", (3.0, 2.0)),
    "a change of speed": (CHANGE_OF_SPEED, "locked", (2.0, 2.0)),
    "profile": (MANOEUVRES, "locked", (3.0, 3.0)),
    "profile (Sun)": (SUN_STEP, "locked", (2.0, 2.0)),
    "waves, altimeter": (SEA, "altimeter", (3.9, 3.8)),
}
"""Order of the fall of attitude and velocity error."""


@pytest.mark.parametrize(("motion", "vertical", "orders"), ORDERS.values(), ids=ORDERS)
def test_order_of_convergence_from_50_to_400_hz(motion, vertical, orders):
    rates = np.array([50.0, 100.0, 200.0, 400.0])
    errors = np.array([worst(motion, rate, 3600.0, vertical=vertical)[:2] for rate in rates])
    slopes = -np.polyfit(np.log(rates), np.log(errors), 1)[0]
    assert slopes == pytest.approx(orders, abs=0.35)


def test_heave_with_a_locked_vertical_is_the_coriolis_acceleration_left_out():
    """2 Omega cos L V_U integrates to 2 Omega cos L times the heave: nothing worse, and no drift."""
    stats = navigate(SEA, 100.0, 3600.0).recorder.stats[:, MAX_ABS]
    heave = np.abs(SEA.rows(3601, 1.0, SITE, WGS84)[:, HEIGHT]).max()
    left_out = 2.0 * EARTH_RATE * np.cos(SITE.lat) * heave
    assert stats[DV_E] == pytest.approx(left_out, rel=0.3)
    assert stats[DV_N] < 0.3 * left_out
    assert stats[ATTITUDE].max() < 1e-7
