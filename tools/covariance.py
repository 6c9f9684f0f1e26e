"""The covariance of the error budget beside many seeds: ``make covariance``.

Six networks against the log, one without it, and none, at rest and along legs with turns; tilt, heading,
velocity and position at five times. Every seed draws its own noise, biases, log bias and initial errors. The
mean square of the seeds over the variance of the budget is chi-squared; counted is how many comparisons lie
within its 99 % interval.
"""

import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from navcore.design.budget import budget
from navcore.engine.simulation import simulate
from navcore.scenario.model import Scenario

SEEDS = 2000
WANTED = 0.98
NETWORKS: tuple[dict[str, Any], ...] = (
    {"id": "classic2"},
    {"id": "classic3"},
    {"id": "complementary", "zeta": 0.5},
    {"id": "unity2", "zeta": 0.5},
    {"id": "compass", "sigma": 0.0088, "xi": 0.7},
    {"id": "optimal", "rho": 1e-2},
)
TURNS = {
    "kind": "legs",
    "leg": [
        {"duration_s": 1800.0, "speed_kn": 10.0, "heading_deg": 30.0},
        {"duration_s": 90.0, "turn_dps": 1.0},
        {"duration_s": 3600.0, "speed_kn": 16.0},
        {"duration_s": 200.0, "turn_dps": -1.0},
        {"duration_s": 3000.0},
        {"duration_s": 60.0, "turn_dps": 2.0},
        {"duration_s": 9000.0},
    ],
}
METHODS = (
    *({"name": str(network["id"]), "damping": "external", "network": network} for network in NETWORKS),
    {"name": "without the log", "damping": "internal", "network": NETWORKS[0]},
    {"name": "free"},
)
MOTIONS: dict[str, dict[str, Any]] = {
    "at rest": {"kind": "static", "heading_deg": 40.0},
    "legs with turns": TURNS,
}
TIMES_H = (0.5, 1.0, 2.0, 3.0, 4.0)
BIASES = {"gyro": 0.004, "accel": 15.0, "log": 0.03}
START = {"level": 0.1, "heading": 2.0, "velocity": 0.05, "position": 2.0}


def drawn(motion: str, seed: int, random: bool = True, step_s: float = 1.0) -> Scenario:
    """Scenario of one seed; without ``random`` its constants are zero, and their deviations remain."""
    rng = np.random.default_rng([seed, 7])

    def constants(deviation: float, count: int) -> list[float]:
        return (deviation * rng.standard_normal(count) * float(random)).tolist()

    return Scenario.parse(
        {
            "run": {"duration_h": 4.0, "seed": seed, "step_s": step_s, "output_step_s": 60.0},
            "motion": MOTIONS[motion],
            "imu": {
                "gyro_arw_dpsh": 0.003,
                "gyro_instability_dph": 0.005,
                "gyro_tau_s": 1800.0,
                "accel_vrw_ugpshz": 20.0,
                "accel_instability_ug": 20.0,
                "accel_tau_s": 1200.0,
                "gyro_bias_dph": constants(BIASES["gyro"], 3),
                "accel_bias_ug": constants(BIASES["accel"], 3),
                "gyro_bias_std_dph": BIASES["gyro"],
                "accel_bias_std_ug": BIASES["accel"],
            },
            "reference": {
                "kind": "log",
                "frame": "body",
                "noise_mps": 0.2,
                "drift_mps": 0.1,
                "bias_mps": constants(BIASES["log"], 2),
                "bias_std_mps": BIASES["log"],
            },
            "initial_error": {
                "attitude_arcmin": constants(START["level"], 2) + constants(START["heading"], 1),
                "velocity_mps": constants(START["velocity"], 2),
                "position_arcsec": constants(START["position"], 2),
                "level_std_arcmin": START["level"],
                "heading_std_arcmin": START["heading"],
                "velocity_std_mps": START["velocity"],
                "position_std_arcsec": START["position"],
            },
            "method": METHODS,
        }
    )


def mean_squares(motion: str, seeds: int, step_s: float) -> np.ndarray:
    """Mean squares of phi E, N, U, dV E, N, dL, dlambda at the times; shape (8, 5, 7)."""
    rows = np.rint(np.array(TIMES_H) * 60.0).astype(int)

    def one(seed: int) -> np.ndarray:
        run = simulate(drawn(motion, seed, step_s=step_s))
        return np.stack([method.rows[rows, :7] ** 2 for method in run.methods])

    total = np.zeros((len(METHODS), len(TIMES_H), 7))
    with ThreadPoolExecutor(2) as pool:
        for squares in pool.map(one, range(seeds)):
            total += squares
    return total / seeds


def ratios(motion: str, seeds: int, step_s: float = 1.0) -> np.ndarray:
    """Mean square of the seeds over the variance of the budget; shape (8, 5, 7)."""
    found = budget(drawn(motion, 0, random=False, step_s=step_s))
    variance = np.empty((len(METHODS), len(TIMES_H), 7))
    for k, method in enumerate(found.methods):
        assert method.shown == "covariance" and method.series is not None
        at = [int(np.argmin(np.abs(method.series.t_s - hours * 3600.0))) for hours in TIMES_H]
        variance[k] = method.series.total[at]
    return mean_squares(motion, seeds, step_s) / variance


def inside(found: np.ndarray, seeds: int) -> np.ndarray:
    """Which ratios lie within the 99 % interval of a chi-squared mean square of so many seeds."""
    from scipy.stats import chi2

    low, high = chi2.ppf([0.005, 0.995], seeds) / seeds
    return (found >= low) & (found <= high)


def lines(seeds: int) -> Iterator[tuple[str, bool]]:
    """Text of each motion, and whether it holds."""
    for motion in MOTIONS:
        began = time.perf_counter()
        found = ratios(motion, seeds)
        held = inside(found, seeds)
        worst = float(np.max(np.abs(np.sqrt(found) - 1.0)))
        yield (
            f"{motion}: {seeds} seeds, {held.size} comparisons, {100.0 * float(np.mean(held)):.1f} % within "
            f"the 99 % interval; largest difference of a standard deviation {100.0 * worst:.1f} %; "
            f"{time.perf_counter() - began:.0f} s",
            bool(np.mean(held) >= WANTED),
        )


def main() -> int:
    """Print; 1 when fewer than 98 % lie within the interval."""
    seeds = int(sys.argv[1]) if len(sys.argv) > 1 else SEEDS
    good = True
    for text, held in lines(seeds):
        print(text, flush=True)
        good &= held
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
