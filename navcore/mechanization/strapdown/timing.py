"""How fast the strapdown engine runs here: the figures of the bench, each the median of a few repeats."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from navcore.control.law import prepare_law
from navcore.control.policy.constant import Constant
from navcore.control.switching.hard import Hard
from navcore.earth import WGS84
from navcore.mechanization.strapdown.run import Settings, VelocityReference, start_from, start_run
from navcore.motion.base import Site
from navcore.motion.static import StaticMotion
from navcore.motion.swing import Oscillation, SwingMotion
from navcore.network.base import NetworkParameters
from navcore.network.compass import CompassNetwork
from navcore.network.complementary import ComplementaryNetwork
from navcore.network.undamped import UndampedNetwork
from navcore.sensors.imu import Imu
from navcore.sensors.imu_simulation import ImuSimulation
from navcore.units import DEG

RATE_HZ = 200.0
_SITE = Site(32.06 * DEG, 118.8 * DEG, 0.0)
_ALL_ERRORS = Imu(
    gyro_bias_dph=(0.02, 0.02, 0.02), gyro_arw_dpsh=0.006, accel_bias_ug=(50.0, 50.0, 50.0),
    accel_vrw_ugpshz=10.0, gyro_instability_dph=0.003, accel_instability_ug=10.0,
    gyro_scale_ppm=(5.0, 5.0, 5.0), accel_scale_ppm=(10.0, 10.0, 10.0),
)  # fmt: skip


def _median_ns(work: Callable[[], Any], samples: int, repeats: int) -> float:
    work()
    times = []
    for _ in range(repeats):
        began = time.perf_counter()
        work()
        times.append(time.perf_counter() - began)
    return statistics.median(times) / samples * 1e9


def strapdown_timings(seconds: int = 3600, repeats: int = 5) -> dict[str, float]:
    """Median ns a sample at 200 Hz: free, compass with the law at 1 Hz, network at the IMU's rate, IMU.

    Parameters
    ----------
    seconds : int
        Length of each timed run.
    repeats : int
        Repeats of which the median is taken.

    Returns
    -------
    dict
        ``strapdown_free_ns_per_sample``, ``strapdown_damped_ns_per_sample``,
        ``strapdown_network_at_imu_rate_ns_per_sample``, ``imu_simulation_ns_per_sample``.
    """
    samples, each = seconds * int(RATE_HZ), int(RATE_HZ)
    imu = ImuSimulation(StaticMotion(), _SITE, WGS84, Imu(), RATE_HZ, each, 0)
    increments = np.tile(imu.before(), (samples, 1))
    truth = imu.truth_rows(1, 1.0)

    def method(damping: str, network: NetworkParameters, law_every: int) -> Callable[[], None]:
        def work() -> None:
            step = law_every / RATE_HZ
            transfer = network.transfer(WGS84.schuler_frequency(_SITE.lat))
            law = prepare_law(damping, network, transfer, Constant(), Hard(), step)
            times = np.arange(samples // law_every + 1) * step
            log = VelocityReference(times, np.zeros((len(times), 2)), np.ones(len(times), bool), False, 5.0)
            settings = Settings(RATE_HZ, samples, law_every, each, 1.0)
            start_run(start_from(truth[0]), settings, WGS84, law, truth, log).advance(increments)

        return work

    swing = Oscillation(amplitude_deg=10.0, frequency_hz=0.2)
    moving = SwingMotion(pitch=swing, roll=swing, heading=swing)

    def simulate() -> None:
        for _ in ImuSimulation(moving, _SITE, WGS84, _ALL_ERRORS, RATE_HZ, samples, 1).chunks():
            pass

    free = method("free", UndampedNetwork(), each)
    damped = method("external", CompassNetwork(), each)
    network = method("external", ComplementaryNetwork(), 1)
    return {
        "strapdown_free_ns_per_sample": _median_ns(free, samples, repeats),
        "strapdown_damped_ns_per_sample": _median_ns(damped, samples, repeats),
        "strapdown_network_at_imu_rate_ns_per_sample": _median_ns(network, samples, repeats),
        "imu_simulation_ns_per_sample": _median_ns(simulate, samples, repeats),
    }
