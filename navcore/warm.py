"""Compile, or load from the cache, every kernel once, so that no user waits for it later."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

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


def warm(progress: Callable[[str], None] = lambda what: None) -> None:
    """Run one short scenario of each motion, with every sensor error and a damped method.

    Parameters
    ----------
    progress : callable
        Told what comes next.
    """
    for motion in _MOTIONS:
        progress(f"{motion['kind']} motion, sensors, error model")
        data = {
            "run": {"duration_h": 0.02},
            "motion": motion,
            "imu": _IMU,
            "reference": {"kind": "log", "noise_mps": 0.1, "drift_mps": 0.1},
            "method": [
                {"damping": "external", "network": {"id": "complementary"}, "policy": {"id": "threshold"}}
            ],
        }
        simulate(Scenario.parse(data))
