"""Whether the Kalman filter's own covariance holds: its errors over many seeds against what it says of them.

The normalised error e^T P^-1 e of n states has the mean n when P is right (Bar-Shalom, Li and Kirubarajan
2001, 5.4). ``python -m tools.filter_consistency --seeds 500`` prints it at the end of a run.
"""

import argparse
import sys
from dataclasses import dataclass
from typing import Any

import numpy as np

from navcore.engine.drivers.kalman import filtered_linear, filtered_strapdown
from navcore.engine.drivers.strapdown import settings_of
from navcore.engine.environment import environment
from navcore.engine.strapdown_environment import strapdown_environment
from navcore.mechanization.error_model import STATES
from navcore.mechanization.recorder import D_LAT, D_LON, DV_E, DV_N, PHI_E, PHI_N, PHI_U
from navcore.motion.truth import HEIGHT, LAT
from navcore.scenario.model import Scenario

SHIP: dict[str, Any] = {
    "run": {"duration_h": 3.0, "step_s": 2.0, "rate_hz": 10.0, "output_step_s": 600.0},
    "site": {"lat_deg": 32.06},
    "motion": {
        "kind": "legs",
        "leg": [
            {"duration_s": 3000.0, "speed_mps": 6.0},
            {"duration_s": 90.0, "turn_dps": 1.0},
            {"duration_s": 20000.0},
        ],
    },
    "imu": {
        "gyro_arw_dpsh": 0.003, "gyro_instability_dph": 0.003, "accel_vrw_ugpshz": 10.0,
        "accel_instability_ug": 10.0, "gyro_bias_std_dph": 0.005, "accel_bias_std_ug": 20.0,
    },
    "initial_error": {
        "level_std_arcmin": 1.0, "heading_std_arcmin": 3.0, "velocity_std_mps": 0.2,
        "position_std_arcsec": 1.0,
    },
    "reference": {"kind": "log", "frame": "body", "noise_mps": 0.2, "drift_mps": 0.1, "bias_std_mps": 0.1},
    "method": [{"damping": "kalman"}],
}  # fmt: skip
"""A ship with a turn, and a spread of everything that the filter is told of."""


@dataclass(frozen=True)
class Consistency:
    """Normalised error of the seven navigation states over seeds.

    Attributes
    ----------
    seeds : int
    mean : float
        Mean of e^T P^-1 e / 7; 1 when the covariance is right.
    low, high : float
        Band that holds the mean with 95 %.
    """

    seeds: int
    mean: float
    low: float
    high: float

    @property
    def holds(self) -> bool:
        """Whether the mean lies within the band."""
        return self.low <= self.mean <= self.high


def drawn(data: dict[str, Any], seed: int) -> Scenario:
    """Scenario of one seed: biases and initial errors are drawn from their standard deviations."""
    rng = np.random.default_rng([seed, 7])
    imu, start, log = data["imu"], data["initial_error"], data["reference"]
    level, heading = start["level_std_arcmin"], start["heading_std_arcmin"]
    return Scenario.parse(
        data
        | {
            "run": data["run"] | {"seed": seed},
            "imu": imu
            | {
                "gyro_bias_dph": (imu["gyro_bias_std_dph"] * rng.standard_normal(3)).tolist(),
                "accel_bias_ug": (imu["accel_bias_std_ug"] * rng.standard_normal(3)).tolist(),
            },
            "initial_error": start
            | {
                "attitude_arcmin": (np.array([level, level, heading]) * rng.standard_normal(3)).tolist(),
                "velocity_mps": (start["velocity_std_mps"] * rng.standard_normal(2)).tolist(),
                "position_arcsec": (start["position_std_arcsec"] * rng.standard_normal(2)).tolist(),
            },
            "reference": log | {"bias_mps": (log["bias_std_mps"] * rng.standard_normal(2)).tolist()},
        }
    )


def final_error(scenario: Scenario) -> tuple[np.ndarray, np.ndarray]:
    """Errors of the first method at the end, shape (7,), SI, and the filter's covariance of them."""
    if scenario.strapdown:
        return _final_error_of_strapdown(scenario)
    state = np.array(scenario.initial_error.state())
    run, _ = filtered_linear(scenario, scenario.method[0], environment(scenario), state)
    while not run.advance(run.steps + 1):
        pass
    return run.x, run.filter.P[:STATES, :STATES]


def _final_error_of_strapdown(scenario: Scenario) -> tuple[np.ndarray, np.ndarray]:
    env = strapdown_environment(scenario)
    run, _ = filtered_strapdown(scenario, scenario.method[0], env, settings_of(scenario, env.sampling))
    for increments, _ in env.imu.chunks():
        if run.advance(increments):
            break
    row, true = run.recorder.rows[-1], env.truth.values[-1]
    error = row[[DV_E, DV_N, D_LAT, D_LON, PHI_E, PHI_N, PHI_U]]
    meridian, prime_vertical = scenario.earth.radii(true[LAT])
    error[2] /= meridian + true[HEIGHT]
    error[3] /= (prime_vertical + true[HEIGHT]) * np.cos(true[LAT])
    return error, run.filter.P[:STATES, :STATES]


def consistency(
    seeds: int, fidelity: str = "error_model", duration_h: float = SHIP["run"]["duration_h"]
) -> Consistency:
    """Run the seeds 1 to ``seeds`` and compare.

    Parameters
    ----------
    seeds : int
        Runs.
    fidelity : {"error_model", "strapdown"}
        Of the runs of `SHIP`.
    duration_h : float
        Length of a run, h; the turn ends at 0.86 h.
    """
    from scipy.stats import chi2

    total, data = 0.0, SHIP | {"run": SHIP["run"] | {"fidelity": fidelity, "duration_h": duration_h}}
    for seed in range(1, seeds + 1):
        error, P = final_error(drawn(data, seed))
        unit = np.sqrt(np.diag(P))
        scaled = error / unit
        total += float(scaled @ np.linalg.solve(P / np.outer(unit, unit), scaled))
    freedom = STATES * seeds
    low, high = chi2.ppf([0.025, 0.975], freedom) / freedom
    return Consistency(seeds, total / freedom, float(low), float(high))


def main(arguments: list[str] | None = None) -> int:
    """Print the normalised error and its band; 1 when it lies outside."""
    parser = argparse.ArgumentParser(description="Kalman filter: own covariance against seeds")
    parser.add_argument("--seeds", type=int, default=500)
    seeds, holds = parser.parse_args(arguments).seeds, True
    for fidelity in ("error_model", "strapdown"):
        found = consistency(seeds, fidelity)
        band = f"95 % band {found.low:.4f} to {found.high:.4f}"
        print(f"{fidelity}: normalised error {found.mean:.4f} of {seeds} seeds, {band}")
        holds = holds and found.holds
    return 0 if holds else 1


if __name__ == "__main__":
    sys.exit(main())
