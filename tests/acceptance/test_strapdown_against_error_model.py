"""The linear error model against the full strapdown mechanization, fed with the same sensor errors, 6 h."""

import numpy as np
import pytest

from navcore.foundation.earth import WGS84
from navcore.foundation.units import ARCSEC
from navcore.mechanization.error_model import ErrorModelRun
from navcore.mechanization.recorder import DV_E, PHI_U, make_recorder
from navcore.mechanization.strapdown import Settings, start_from, start_run, velocity_reference
from navcore.mechanization.trajectory import coefficients
from navcore.motion.legs import Leg, LegsMotion
from navcore.motion.static import StaticMotion
from navcore.motion.truth import Truth
from navcore.networks.classic import Classic2Network
from navcore.networks.compass import CompassNetwork
from navcore.networks.undamped import UndampedNetwork
from navcore.sensors.base import ReferenceErrors, SensorErrors
from navcore.sensors.imu import Imu
from navcore.sensors.imu_simulation import ImuSimulation
from tests.strapdown import DENG_SWING, SITE, law

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


@pytest.mark.parametrize("method", list(METHODS))
@pytest.mark.parametrize("motion", [StaticMotion(), VOYAGE, DENG_SWING], ids=["static", "legs", "swing"])
def test_both_fidelities_agree_within_two_percent_of_the_peak(motion, method):
    strapdown, linear = both(motion, method)
    peak = np.abs(linear[:, : DV_E + 4]).max(axis=0)
    difference = np.abs(strapdown[:, : DV_E + 4] - linear[:, : DV_E + 4]).max(axis=0)
    assert PHI_U < DV_E
    assert (difference / peak).max() <= 0.02, (difference / peak).round(4)
