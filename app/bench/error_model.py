"""Time of 24 h of the error model: 1 s steps, a moving ship, damped, all noises."""

from __future__ import annotations

import statistics
from typing import Any

from app.bench.rounds import seconds_of
from navcore.engine.simulation import simulate
from navcore.scenario.model import Scenario

REPEATS = 7
_NETWORKS: tuple[dict[str, Any], ...] = (
    {"id": "classic2"},
    {"id": "complementary", "zeta": 0.7},
    {"id": "compass", "sigma": 0.0088, "xi": 0.7},
)


def day(seed: int, lat_deg: float = 32.0, methods: int = 3, duration_h: float = 24.0) -> Scenario:
    """Scenario of the measurement: courses and speeds change every hour, every noise is on."""
    courses = [(8.0 + k % 4, 55.0 * k % 360.0) for k in range(24)]
    legs = [{"duration_s": 3600.0, "speed_kn": speed, "heading_deg": to} for speed, to in courses]
    return Scenario.parse(
        {
            "run": {"duration_h": duration_h, "step_s": 1.0, "output_step_s": 10.0, "seed": seed},
            "site": {"lat_deg": lat_deg},
            "motion": {"kind": "legs", "leg": legs},
            "imu": {
                "gyro_bias_dph": [0.01, 0.01, 0.01],
                "gyro_arw_dpsh": 0.003,
                "accel_bias_ug": [50.0, 50.0, 50.0],
                "accel_vrw_ugpshz": 10.0,
            },
            "reference": {"kind": "log", "bias_mps": [0.1, 0.1], "noise_mps": 0.2, "rate_hz": 1.0},
            "method": [{"damping": "external", "network": network} for network in _NETWORKS[:methods]],
        }
    )


def measure_error_model() -> dict[str, float]:
    """Wall times: a method's share of a run of three with fresh noise; one method with nothing kept."""
    simulate(day(seed=1))
    noisy = [_seconds(day(seed=2 + k)) / 3.0 for k in range(REPEATS)]
    cold = [_seconds(day(seed=20 + k, lat_deg=33.0 + k, methods=1)) for k in range(REPEATS)]
    return {
        "error_model_24h_ms_per_method": 1e3 * statistics.median(noisy),
        "error_model_24h_cold_ms": 1e3 * statistics.median(cold),
    }


def _seconds(scenario: Scenario) -> float:
    return seconds_of(lambda: simulate(scenario))
