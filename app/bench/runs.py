"""Time and memory of runs: 24 h of the error model, a day of the strapdown, error budgets.

``python -m schuler_bench.bench.runs memory`` and ``python -m schuler_bench.bench.runs day`` measure in a
process of their own, whose memory is theirs.
"""

import json
import statistics
import sys
from functools import partial
from pathlib import Path
from typing import Any

from navcore.engine.simulation import simulate
from navcore.scenario.model import Scenario
from schuler_bench.bench.rounds import in_own_process, median_s

REPEATS, REPEATS_IN_OWN_PROCESS = 7, 5
_SWING = {"amplitude_deg": 5.0, "frequency_hz": 0.125}
_NOISY_IMU = {
    "gyro_bias_dph": [0.01, 0.01, 0.01],
    "gyro_arw_dpsh": 0.003,
    "accel_bias_ug": [50.0, 50.0, 50.0],
    "accel_vrw_ugpshz": 10.0,
}
_LOG = {"kind": "log", "bias_mps": [0.1, 0.1], "noise_mps": 0.2, "rate_hz": 1.0}
_COMPLEMENTARY = {"id": "complementary", "zeta": 0.7}
_COMPASS = {"id": "compass", "sigma": 0.0088, "xi": 0.7}
_DAY_NETWORKS: tuple[dict[str, Any], ...] = ({"id": "classic2"}, _COMPLEMENTARY, _COMPASS)
_BUDGET_NETWORKS: tuple[dict[str, Any], ...] = (
    {"id": "classic2"},
    {"id": "classic3"},
    {"id": "complementary"},
    {"id": "unity2"},
    _COMPASS,
    _COMPASS | {"sigma": 0.0015},
    {"id": "optimal"},
)
KALMAN: tuple[dict[str, Any], ...] = ({"damping": "kalman"},)


def _external(*networks: dict[str, Any]) -> list[dict[str, Any]]:
    return [
        {"name": f"{place} {network['id']}", "damping": "external", "network": network}
        for place, network in enumerate(networks)
    ]


def day(seed: int, lat_deg: float = 32.0, methods: int = 3, duration_h: float = 24.0) -> Scenario:
    """Scenario for the error model, 1 s steps: course and speed change every hour, every noise is on."""
    courses = [(8.0 + k % 4, 55.0 * k % 360.0) for k in range(24)]
    legs = [{"duration_s": 3600.0, "speed_kn": speed, "heading_deg": to} for speed, to in courses]
    return Scenario.parse(
        {
            "run": {"duration_h": duration_h, "step_s": 1.0, "output_step_s": 10.0, "seed": seed},
            "site": {"lat_deg": lat_deg},
            "motion": {"kind": "legs", "leg": legs},
            "imu": _NOISY_IMU,
            "reference": _LOG,
            "method": _external(*_DAY_NETWORKS[:methods]),
        }
    )


def strapdown_day(
    seed: int, duration_h: float = 24.0, methods: tuple[dict[str, Any], ...] | None = None
) -> Scenario:
    """Scenario for the strapdown: 100 Hz, a swinging ship, all noises, two methods on a log at 1 Hz."""
    return Scenario.parse(
        {
            "run": {"fidelity": "strapdown", "duration_h": duration_h, "rate_hz": 100.0, "seed": seed},
            "motion": {"kind": "swing", "pitch": _SWING, "roll": _SWING, "heading": _SWING},
            "imu": _NOISY_IMU | {"gyro_instability_dph": 0.003, "accel_instability_ug": 10.0},
            "reference": _LOG,
            "method": list(methods or _external(_COMPLEMENTARY, _COMPASS)),
        }
    )


def measure_error_model() -> dict[str, float]:
    """Wall times: a method's share of a run of three with fresh noise; one method with nothing kept."""
    simulate(day(seed=1))
    noisy = [day(seed=2 + k) for k in range(REPEATS)]
    cold = [day(seed=20 + k, lat_deg=33.0 + k, methods=1) for k in range(REPEATS)]
    return {
        "error_model_24h_ms_per_method": 1e3 * median_s(partial(simulate, each) for each in noisy) / 3.0,
        "error_model_24h_cold_ms": 1e3 * median_s(partial(simulate, each) for each in cold),
    }


def measure_memory() -> dict[str, float]:
    """Highest memory after a 24 h run of three methods, above that after a short run of the same, MiB."""
    peaks = [in_own_process("schuler_bench.bench.runs", "memory") for _ in range(REPEATS_IN_OWN_PROCESS)]
    return {"run_24h_memory_mb": statistics.median(peaks)}


def measure_strapdown_day() -> dict[str, float]:
    """Median wall times of a run of 24 h at 100 Hz, s, and the highest memory of its process, MiB.

    With two networks, and with the Kalman filter as the only method.
    """
    return in_own_process("schuler_bench.bench.runs", "day")


def measure_budgets() -> dict[str, float]:
    """Wall times: steady budget and floor of seven methods; transient budget of three along a day."""
    from navcore.design.ship import Ship
    from navcore.design.steady import steady_budget
    from navcore.scenario.stochastic import stochastic_model

    data = day(seed=1).canonical()
    data["imu"] |= {"gyro_instability_dph": 0.003, "accel_instability_ug": 10.0}
    data["reference"] |= {"drift_mps": 0.1}
    data["initial_error"] |= {"attitude_arcmin": [0.1, 0.1, 2.0], "velocity_mps": [0.1, 0.1]}
    three = Scenario.parse(data)
    seven = Scenario.parse(data | {"method": _external(*_BUDGET_NETWORKS)})

    def steady() -> None:
        steady_budget(seven, stochastic_model(seven))

    def transient() -> None:
        ship = Ship(three)
        for method in three.method:
            ship.along(method)

    steady()
    transient()
    return {
        "budget_steady_7_ms": 1e3 * median_s([steady] * REPEATS),
        "budget_24h_3_methods_ms": 1e3 * median_s([transient] * REPEATS),
    }


def _peak_mb() -> float:
    """Highest memory that this process has held so far, MiB."""
    status = Path("/proc/self/status")
    if status.exists():
        # On Linux ru_maxrss starts with the peak of the process that made this one.
        (peak,) = (line.split()[1] for line in status.read_text().splitlines() if line.startswith("VmHWM:"))
        return float(peak) / 1024.0
    import resource

    peak_bytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak_bytes / (1024.0 * 1024.0 if sys.platform == "darwin" else 1024.0)


def _memory_of_a_day() -> float:
    simulate(day(seed=1, duration_h=0.1))
    before = _peak_mb()
    simulate(day(seed=2))
    return round(_peak_mb() - before, 2)


def _strapdown_days() -> dict[str, float]:
    numbers = {}
    for name, methods in (("strapdown_24h_100hz", None), ("strapdown_24h_100hz_kalman", KALMAN)):
        simulate(strapdown_day(1, 0.1, methods))
        days = [strapdown_day(2 + k, 24.0, methods) for k in range(REPEATS_IN_OWN_PROCESS)]
        numbers[f"{name}_s"] = median_s(partial(simulate, each) for each in days)
        numbers.setdefault("strapdown_24h_100hz_mb", _peak_mb())
    return numbers


if __name__ == "__main__":
    print(json.dumps({"memory": _memory_of_a_day, "day": _strapdown_days}[sys.argv[1]]()))
