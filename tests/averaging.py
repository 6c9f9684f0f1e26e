"""What the tests of half-period averaging share: Zhao's place and initial errors, runs without a scenario."""

from typing import Any

import numpy as np

from navcore.averaging import Averaging
from navcore.averaging.error_model import AveragedErrorModel, start_error_model
from navcore.averaging.plan import Plan, prepare_averaging
from navcore.engine.run import statistics
from navcore.foundation.earth import SPHERE, Earth
from navcore.foundation.units import ARCMIN, ARCSEC, DEG
from navcore.law.law import Law, prepare_law
from navcore.law.policy.constant import Constant
from navcore.law.switching.hard import Hard
from navcore.mechanization.trajectory import coefficients
from navcore.motion.base import MotionParameters
from navcore.motion.static import StaticMotion
from navcore.motion.truth import Site
from navcore.networks.undamped import UndampedNetwork
from navcore.sensors.imu import Imu, imu_errors

SITE = Site(45.7796 * DEG, 126.6773 * DEG, 0.0)
INITIAL = np.array([0.1, 0.1, 2 * ARCSEC, 2 * ARCSEC, 0.6 * ARCMIN, 0.6 * ARCMIN, 7 * ARCMIN])
"""dV_E, dV_N, dL, dlambda, phi_E, phi_N, phi_U of Zhao 5.1.1, SI."""
DAY = 86_400


def free_law(step_s: float = 1.0) -> Law:
    """Law of a method without damping."""
    network = UndampedNetwork()
    return prepare_law("free", network, network.transfer(1.24e-3), Constant(), Hard(), step_s)


def truth_row(motion: MotionParameters | None = None, earth: Earth = SPHERE) -> np.ndarray:
    """True state at t = 0."""
    return (motion or StaticMotion()).truth(1, 1.0, SITE, earth).values[0]


def made(
    averaging: Averaging,
    motion: MotionParameters | None = None,
    earth: Earth = SPHERE,
    imu: Imu | None = None,
    **rest: Any,
) -> Plan:
    """Plan of a method after 600 s of alignment."""
    settings = {"imu": imu or Imu(), "duration_s": 600.0, "motions": (), "seed": 1, **rest}
    omega_s = earth.schuler_frequency(SITE.lat)
    return prepare_averaging(averaging, truth_row(motion, earth), omega_s, earth, **settings)


def averaged(
    plan: Plan,
    steps: int = DAY,
    motion: MotionParameters | None = None,
    earth: Earth = SPHERE,
    imu: Imu | None = None,
    initial: np.ndarray = INITIAL,
    chunk: int = 50_000,
) -> AveragedErrorModel:
    """Run a method on the error model, 1 s steps, rows each minute."""
    truth = (motion or StaticMotion()).truth(2 * steps + 1, 0.5, SITE, earth)
    sensors = imu_errors((imu or Imu()).all_parts(), truth, steps, 1.0, earth, 1)
    along = coefficients(truth, earth, coupled=True)
    run = start_error_model(plan, initial, earth, 1.0, steps, 60.0, along, sensors, free_law())
    while not run.advance(chunk):
        pass
    return run


def peaks(run: Any) -> dict[str, float]:
    """Largest magnitude of each quantity: arc-seconds, m/s, m."""
    return {
        name: values["max_abs"] / (ARCSEC if name.startswith("phi") else 1.0)
        for name, values in statistics(run.recorder).items()
    }
