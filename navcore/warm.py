"""Compile, or load from the cache, every kernel once, so that no user waits for it later."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from navcore.scenario import Scenario
from navcore.simulation import simulate

_IMU: dict[str, Any] = {
    "gyro_bias_dph": [0.01, 0.01, 0.01],
    "gyro_arw_dpsh": 0.001,
    "accel_vrw_ugpshz": 1.0,
    "gyro_instability_dph": 0.001,
    "accel_instability_ug": 1.0,
    "gyro_scale_ppm": [1.0, 1.0, 1.0],
    "gyro_lsb": [1e-7, 1e-7, 1e-7],
    "accel_lsb": [1e-5, 1e-5, 1e-5],
}
_SWING = {"amplitude_deg": 1.0, "frequency_hz": 0.1}
_MOTIONS: tuple[dict[str, Any], ...] = (
    {"kind": "static"},
    {"kind": "swing", "pitch": _SWING, "roll": _SWING, "heading": _SWING},
    {"kind": "legs", "leg": [{"duration_s": 60.0, "speed_mps": 5.0}, {"duration_s": 60.0, "turn_dps": 1.0}]},
)


_NETWORK = {"damping": "external", "network": {"id": "complementary"}}
_COMPASS = {"damping": "external", "network": {"id": "compass"}}
_AVERAGING = {"damping": "averaging"}
_RATE_HZ = 20.0


def warm(progress: Callable[[str], None] = lambda what: None) -> None:
    """Run short scenarios of every kind, with every sensor error, so that each kernel is compiled once.

    Parameters
    ----------
    progress : callable
        Told what comes next.
    """
    for motion in _MOTIONS:
        progress(f"{motion['kind']} motion, sensors, error model")
        method = _NETWORK | {"policy": {"id": "threshold"}}
        simulate(_scenario({"duration_h": 0.02}, motion, 1.0, [method]))
    progress("half-period averaging")
    simulate(_scenario({"duration_h": 0.02}, _MOTIONS[1], 1.0, [_AVERAGING]))
    progress("strapdown mechanization, IMU simulation, compass alignment")
    strapdown = {"fidelity": "strapdown", "duration_h": 0.02, "rate_hz": _RATE_HZ}
    slow_log, fast_log = 1.0, _RATE_HZ
    for log_hz in (slow_log, fast_log):
        scenario = _scenario(strapdown, _MOTIONS[1], log_hz, [_COMPASS, _NETWORK, _AVERAGING])
        alignment = scenario.alignment.model_copy(update={"kind": "compass", "duration_s": 60.0})
        simulate(scenario.model_copy(update={"alignment": alignment}))
    progress("alignment with a recorded IMU")
    _warm_coarse_alignment()
    progress("many strapdown runs at once")
    _warm_batch()


def _scenario(
    run: dict[str, Any], motion: dict[str, Any], log_hz: float, methods: list[dict[str, Any]]
) -> Scenario:
    log = {"kind": "log", "noise_mps": 0.1, "drift_mps": 0.1, "rate_hz": log_hz}
    return Scenario.parse({"run": run, "motion": motion, "imu": _IMU, "reference": log, "method": methods})


def _warm_coarse_alignment() -> None:
    from navcore.alignment import coarse_alignment
    from navcore.earth import WGS84
    from navcore.motion.base import Site
    from navcore.motion.static import StaticMotion
    from navcore.sensors.imu import Imu
    from navcore.sensors.imu_simulation import ImuSimulation

    samples = int(60.0 * _RATE_HZ)
    simulation = ImuSimulation(StaticMotion(), Site(0.5, 0.0, 0.0), WGS84, Imu(), _RATE_HZ, samples, 0)
    coarse_alignment(np.concatenate([chunk for chunk, _ in simulation.chunks()]), _RATE_HZ, 0.5)


def _warm_batch() -> None:
    from navcore.control.law import prepare_law
    from navcore.control.policy.constant import Constant
    from navcore.control.switching.hard import Hard
    from navcore.earth import WGS84
    from navcore.mechanization.strapdown import Settings, start_from
    from navcore.mechanization.strapdown.batch import BatchRun
    from navcore.motion.base import Site
    from navcore.motion.static import StaticMotion
    from navcore.network.undamped import UndampedNetwork

    truth = StaticMotion().rows(1, 1.0, Site(0.5, 0.0, 0.0), WGS84)
    network = UndampedNetwork()
    law = prepare_law("free", network, network.transfer(1e-3), Constant(), Hard(), 1.0)
    second = round(_RATE_HZ)
    settings = Settings(_RATE_HZ, second, second, second, 1.0)
    batch = BatchRun([start_from(truth[0])], [law], np.zeros((1, 6)), settings, WGS84, truth)
    batch.advance(np.zeros((second, 6)))
