"""What the tests of the strapdown engine share: motions, laws, and a run from simulated increments."""

from typing import Any

import numpy as np

from navcore.foundation.earth import WGS84
from navcore.foundation.units import DEG
from navcore.law.law import Law, prepare_law
from navcore.law.policy.constant import Constant
from navcore.law.switching.hard import Hard
from navcore.mechanization.strapdown import Settings, StrapdownRun, start_from, start_run
from navcore.mechanization.strapdown.run import VelocityReference
from navcore.motion.base import MotionParameters
from navcore.motion.legs import Leg, LegsMotion
from navcore.motion.swing import Oscillation, SwingMotion
from navcore.motion.truth import Site
from navcore.networks.base import NetworkParameters
from navcore.networks.undamped import UndampedNetwork
from navcore.sensors.imu import Imu
from navcore.sensors.imu_simulation import ImuSimulation

SITE = Site(32.06 * DEG, 118.8 * DEG, 0.0)

DENG_SWING = SwingMotion(
    pitch_deg=8.0,
    roll_deg=6.0,
    heading_deg=75.0,
    pitch=Oscillation(amplitude_deg=10.0, frequency_hz=0.2),
    roll=Oscillation(amplitude_deg=12.0, frequency_hz=0.125),
    heading=Oscillation(amplitude_deg=6.0, frequency_hz=0.15),
)
"""Three-axis swing of Deng 2019, section 3."""

DRIVE = LegsMotion(
    heading_deg=30.0,
    leg=(
        Leg(duration_s=600.0, speed_mps=0.0),
        Leg(duration_s=600.0, speed_mps=8.0),
        Leg(duration_s=600.0, heading_deg=120.0),
        Leg(duration_s=600.0, speed_mps=3.0, heading_deg=350.0),
        Leg(duration_s=1200.0, speed_mps=12.0, turn_dps=-0.5, heading_deg=90.0),
        Leg(duration_s=600.0, heading_deg=180.0, turn_dps=3.0),
    ),
)
"""Legs with turns up to a mean of 3 deg/s and changes of speed at a mean of 0.1 m/s^2."""


def law(damping: str, network: NetworkParameters, step_s: float) -> Law:
    """Law with policy `constant` and switching `hard` at the test site."""
    transfer = network.transfer(WGS84.schuler_frequency(SITE.lat))
    return prepare_law(damping, network, transfer, Constant(), Hard(), step_s)


def reference(velocity: Any, duration_s: float, step_s: float = 1.0) -> VelocityReference:
    """Constant reference velocity E, N at 1 / step_s."""
    count = round(duration_s / step_s) + 1
    rows = np.tile(np.asarray(velocity, dtype=float), (count, 1))
    return VelocityReference(np.arange(count) * step_s, rows, np.ones(count, bool), False, 5.0)


def navigate(
    motion: MotionParameters,
    rate_hz: float,
    duration_s: float,
    imu: Imu | None = None,
    errors: Any = None,
    damping: str = "free",
    network: NetworkParameters | None = None,
    log: VelocityReference | None = None,
    law_step_s: float = 1.0,
    seed: int = 1,
    **settings: Any,
) -> StrapdownRun:
    """Run one method on a simulated IMU; states are recorded every second."""
    network = UndampedNetwork() if network is None else network
    samples, second = round(duration_s * rate_hz), round(rate_hz)
    imu_run = ImuSimulation(motion, SITE, WGS84, imu or Imu(), rate_hz, samples, seed)
    truth = imu_run.truth_rows(round(duration_s) + 1, 1.0)
    run = start_run(
        start_from(truth[0], errors),
        Settings(rate_hz, samples, round(law_step_s * rate_hz), second, 1.0, **settings),
        WGS84,
        law(damping, network, law_step_s),
        truth,
        log,
        imu_run.before(),
    )
    for increments, _ in imu_run.chunks():
        if run.advance(increments):
            break
    return run
