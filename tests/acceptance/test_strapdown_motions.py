"""The strapdown mechanization: perfect sensors, the linear model, values of theory.md 9.5 and 9.6.

Perfect sensors return to the truth on every motion, and the error falls with the rate (theory.md 6).

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

from navcore.foundation.earth import EARTH_RATE, WGS84
from navcore.foundation.units import ARCSEC, DEG
from navcore.mechanization.error_model import ErrorModelRun
from navcore.mechanization.recorder import DV_E, DV_N, MAX_ABS, PHI_E, PHI_N, PHI_U, POSITION, make_recorder
from navcore.mechanization.strapdown import Settings, start_from, start_run, velocity_reference
from navcore.mechanization.trajectory import coefficients
from navcore.motion.base import MotionParameters
from navcore.motion.legs import Leg, LegsMotion
from navcore.motion.profile import ProfileMotion
from navcore.motion.static import StaticMotion
from navcore.motion.truth import HEIGHT, Truth
from navcore.networks.classic import Classic2Network
from navcore.networks.compass import CompassNetwork
from navcore.networks.undamped import UndampedNetwork
from navcore.sensors.base import ReferenceErrors, SensorErrors
from navcore.sensors.imu import Imu
from navcore.sensors.imu_simulation import ImuSimulation
from tests.motions import MANOEUVRES, SEA, ZHAO, circle_track
from tests.strapdown import DENG_SWING, DRIVE, SITE, law, navigate, reference

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


# ---------------------------------------------------------------- against the linear model


HOURS, RATE = 6, 50.0
SECONDS = HOURS * 3600
IMU = Imu(
    gyro_bias_dph=(0.005, -0.008, 0.01),
    gyro_arw_dpsh=0.001,
    accel_bias_ug=(20.0, -30.0, 10.0),
    accel_vrw_ugpshz=5.0,
    gyro_scale_ppm=(5.0, 5.0, 5.0),
)
START = np.array([0.05, -0.05, 0.0, 0.0, 5 * ARCSEC, -8 * ARCSEC, 60 * ARCSEC])
VOYAGE = LegsMotion(
    heading_deg=40.0,
    leg=(
        Leg(duration_s=1800.0, speed_mps=6.0),
        Leg(duration_s=3600.0, heading_deg=130.0),
        Leg(duration_s=3600.0, speed_mps=9.0),
        Leg(duration_s=5400.0, heading_deg=300.0, turn_dps=-0.5),
        Leg(duration_s=7200.0, speed_mps=4.0, heading_deg=200.0),
    ),
)
METHODS = {
    "free": ("free", UndampedNetwork()),
    "network": ("external", Classic2Network()),
    "compass": ("external", CompassNetwork(sigma=0.0088, xi=0.7)),
}


def both(motion, method) -> tuple[np.ndarray, np.ndarray]:
    """Rows of the strapdown run and of the linear model, every 10 s."""
    damping, network = METHODS[method]
    samples = int(SECONDS * RATE)
    sim = ImuSimulation(motion, SITE, WGS84, IMU, RATE, samples, 5)
    half = sim.truth_rows(2 * SECONDS + 1, 0.5)
    truth_half = Truth(0.5, half)
    truth = half if len(half) == 1 else np.ascontiguousarray(half[::2])
    times = np.arange(SECONDS + 1.0)
    rng = np.random.default_rng(11)
    log = ReferenceErrors(
        times,
        np.array([0.1, -0.05]) + 0.05 * rng.normal(size=(SECONDS + 1, 2)),
        np.ones(SECONDS + 1, bool),
        False,
        5.0,
    )
    settings = Settings(RATE, samples, int(RATE), int(RATE), 10.0)
    run = start_run(
        start_from(truth[0], START),
        settings,
        WGS84,
        law(damping, network, 1.0),
        truth,
        velocity_reference(log, Truth(1.0, truth)),
        sim.before(),
    )
    sums = []
    for increments, errors in sim.chunks(with_sums=True):
        sums.append(errors.copy())
        run.advance(increments)
    errors = np.concatenate(sums)
    recorder = make_recorder(SECONDS, 1.0, 10.0)
    linear = ErrorModelRun(
        1.0,
        SECONDS,
        coefficients(truth_half, WGS84, True),
        SensorErrors(np.ascontiguousarray(errors[:, :3]), np.ascontiguousarray(errors[:, 3:])),
        log,
        law(damping, network, 1.0),
        START.copy(),
        recorder,
    )
    linear.advance(SECONDS + 1)
    return run.recorder.rows, recorder.rows


@pytest.mark.known(
    "twin",
    [
        "tilt_max_arcsec",
        "tilt_rms_arcsec",
        "velocity_max_mps",
        "velocity_rms_mps",
        "heading_max_arcmin",
        "heading_rms_arcmin",
        "position_max_m",
        "position_rms_m",
        "position_final_m",
    ],
    kinds=["free", "internal", "external", "averaging"],
    fidelities=["strapdown", "error_model"],
    source="the other fidelity",
)
@pytest.mark.parametrize("method", list(METHODS))
@pytest.mark.parametrize("motion", [StaticMotion(), VOYAGE, DENG_SWING], ids=["static", "legs", "swing"])
def test_both_fidelities_agree_within_two_percent_of_the_peak(motion, method):
    strapdown, linear = both(motion, method)
    peak = np.abs(linear[:, : DV_E + 4]).max(axis=0)
    difference = np.abs(strapdown[:, : DV_E + 4] - linear[:, : DV_E + 4]).max(axis=0)
    assert PHI_U < DV_E
    assert (difference / peak).max() <= 0.02, (difference / peak).round(4)


# ---------------------------------------------------------------- reference values


VE_COLUMN = 3


@pytest.mark.known(
    "oracle",
    ["velocity_max_mps", "velocity_rms_mps"],
    kinds=["free"],
    fidelities=["strapdown"],
    source="closed form, theory.md 9.5",
)
def test_free_velocity_under_a_gyro_bias_9_5():
    run = navigate(StaticMotion(), 100.0, 3600.0, Imu(gyro_bias_dph=(0.0, 0.02, 0.0)))
    v_e = run.navigation[:, VE_COLUMN]
    peak = np.abs(v_e).max()
    for t, wanted in ((1800, 0.9951), (2533, 1.2309), (3600, 0.7646)):
        assert v_e[t] == pytest.approx(wanted, abs=1e-3 * peak)


@pytest.mark.known(
    "oracle",
    ["tilt_max_arcsec", "tilt_rms_arcsec"],
    kinds=["external"],
    fidelities=["strapdown"],
    source="theory.md 9.6, of an independent program",
)
@pytest.mark.parametrize("law_step_s", [1.0, 0.01], ids=["law_1_hz", "law_100_hz"])
def test_compass_settles_9_6(law_step_s):
    imu = Imu(gyro_bias_dph=(0.0, 0.02, 0.0), accel_bias_ug=(50.0, 50.0, 0.0))
    run = navigate(
        StaticMotion(),
        100.0,
        3600.0,
        imu,
        [0, 0, 0, 0, 0.1 * DEG, 0.1 * DEG, 0],
        "external",
        CompassNetwork(sigma=0.0088, xi=0.7),
        reference((0, 0), 3600.0, law_step_s),
        law_step_s,
    )
    for column, final, settled in ((PHI_E, -0.002868, 541), (PHI_N, 0.002868, 545)):
        phi = run.recorder.rows[:, column] / DEG
        assert phi[-1] == pytest.approx(final, abs=1e-3 * 0.1)
        assert np.flatnonzero(np.abs(phi - phi[-1]) > 0.02 * 0.1)[-1] == pytest.approx(settled, abs=2)


@pytest.mark.parametrize("attitude", [(0, 0, 0), (0, 0, 90), (10, 20, 310), (6, 8, 75), (-30, 45, 200)])
def test_perfect_sensors_at_rest_leave_no_velocity(attitude):
    pitch, roll, heading = attitude
    motion = StaticMotion(pitch_deg=pitch, roll_deg=roll, heading_deg=heading)
    stats = navigate(motion, 200.0, 3 * 3600.0).recorder.stats
    assert stats[[DV_E, DV_N], MAX_ABS].max() <= 1e-9
