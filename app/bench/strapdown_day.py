"""A day of the full strapdown, in a process of its own: ``python -m app.bench.strapdown_day``."""

from __future__ import annotations

import json
import statistics
from typing import Any

from app.bench.memory import peak_mb
from app.bench.rounds import in_own_process, seconds_of
from navcore.engine.simulation import simulate
from navcore.scenario.model import Scenario

REPEATS = 5
_SWING = {"amplitude_deg": 5.0, "frequency_hz": 0.125}


_NETWORKS: tuple[dict[str, Any], ...] = (
    {"damping": "external", "network": {"id": "complementary", "zeta": 0.7}},
    {"damping": "external", "network": {"id": "compass", "sigma": 0.0088, "xi": 0.7}},
)
KALMAN: tuple[dict[str, Any], ...] = ({"damping": "kalman"},)


def strapdown_day(
    seed: int, duration_h: float = 24.0, methods: tuple[dict[str, Any], ...] = _NETWORKS
) -> Scenario:
    """Scenario of the measurement: 100 Hz, a swinging ship, all noises, two methods on a log at 1 Hz."""
    return Scenario.parse(
        {
            "run": {"fidelity": "strapdown", "duration_h": duration_h, "rate_hz": 100.0, "seed": seed},
            "motion": {"kind": "swing", "pitch": _SWING, "roll": _SWING, "heading": _SWING},
            "imu": {
                "gyro_bias_dph": [0.01, 0.01, 0.01],
                "gyro_arw_dpsh": 0.003,
                "gyro_instability_dph": 0.003,
                "accel_bias_ug": [50.0, 50.0, 50.0],
                "accel_vrw_ugpshz": 10.0,
                "accel_instability_ug": 10.0,
            },
            "reference": {"kind": "log", "bias_mps": [0.1, 0.1], "noise_mps": 0.2, "rate_hz": 1.0},
            "method": list(methods),
        }
    )


def measure_strapdown_day() -> dict[str, float]:
    """Median wall times of a run of 24 h at 100 Hz, s, and the highest memory of its process, MiB.

    With two networks, and with the Kalman filter as the only method.
    """
    return in_own_process("app.bench.strapdown_day")


def _measured() -> dict[str, float]:
    numbers = {}
    for name, methods in (("strapdown_24h_100hz", _NETWORKS), ("strapdown_24h_100hz_kalman", KALMAN)):
        simulate(strapdown_day(1, 0.1, methods))
        days = [strapdown_day(2 + k, 24.0, methods) for k in range(REPEATS)]
        numbers[f"{name}_s"] = statistics.median(seconds_of(lambda day=day: simulate(day)) for day in days)
        numbers.setdefault("strapdown_24h_100hz_mb", peak_mb())
    return numbers


if __name__ == "__main__":
    print(json.dumps(_measured()))
