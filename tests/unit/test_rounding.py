"""Rounding of the log's readings: the error that stands, by draws; budget against runs."""

from typing import Any

import numpy as np
import pytest

from navcore.design.budget import budget
from navcore.engine.simulation import simulate
from navcore.scenario.model import Scenario
from navcore.sensors.rounding import mean_rounding, standing_rounding


@pytest.mark.parametrize("sigma", [0.0, 0.003, 0.01, 0.03, 0.06])
def test_mean_and_standing_error_are_those_of_many_draws(sigma: float) -> None:
    q, x = 0.1, np.linspace(-0.17, 0.23, 41)
    noise = np.random.default_rng(1).normal(0.0, sigma, (40_000, 1))
    drawn = np.mean(np.round((x + noise) / q) * q - x - noise, axis=0)
    assert mean_rounding(x, q, sigma) == pytest.approx(drawn, abs=1.5e-3)
    over = np.linspace(0.0, q, 2000, endpoint=False)
    assert standing_rounding(q, sigma) == pytest.approx(
        float(np.sqrt(np.mean(mean_rounding(over, q, sigma) ** 2))), rel=0.01, abs=1e-9
    )


def scenario(seed: int = 1, **reference: Any) -> Scenario:
    """Three legs whose speeds are no multiples of the resolution."""
    legs = [
        {"duration_s": 14_400.0, "speed_mps": 5.03, "heading_deg": 30.0},
        {"duration_s": 14_400.0, "heading_deg": 120.0, "turn_dps": 0.5},
        {"duration_s": 40_000.0, "heading_deg": 75.0, "turn_dps": 0.5},
    ]
    return Scenario.parse(
        {
            "run": {"duration_h": 12.0, "output_step_s": 60.0, "seed": seed},
            "motion": {"kind": "legs", "leg": legs},
            "reference": {"kind": "log", "lsb_mps": 0.1, **reference},
            "method": [{"damping": "external", "network": {"id": "classic2"}}],
        }
    )


@pytest.mark.parametrize(
    ("reference", "seeds", "within"),
    [
        ({}, 1, 0.02),
        ({"frame": "body"}, 1, 0.02),
        ({"rate_hz": 0.1, "lsb_mps": 0.5}, 1, 0.02),
        ({"noise_mps": 0.02}, 60, 0.12),
        ({"noise_mps": 0.1}, 60, 0.12),
        ({"noise_mps": 0.05, "rate_hz": 10.0}, 60, 0.12),  # counted as if it had no noise, 40 times too large
        ({"drift_mps": 0.02}, 60, 0.12),  # its rounding is no noise
    ],
    ids=str,
)
def test_the_budget_of_a_rounded_log_is_that_of_its_runs(reference, seeds, within) -> None:
    """Without noise it was 3 to 9 times too small."""
    runs = [simulate(scenario(seed, **reference)).methods[0].rows[:, :7] ** 2 for seed in range(seeds)]
    series = budget(scenario(**reference)).methods[0].series
    assert series is not None and (seeds > 1 or "log_resolution" in series.sources)
    ratio = np.sqrt(np.mean(runs, axis=(0, 1)) / series.total.mean(axis=0))
    assert ratio[[0, 1, 3, 4]] == pytest.approx(1.0, abs=within)


def test_a_filter_is_not_told_of_rounding_that_stands() -> None:
    """It takes it for noise, and its own covariance has nothing of what a steady speed makes of it."""
    imu = {"gyro_arw_dpsh": 0.001}
    data = scenario().canonical() | {"imu": imu, "method": [{"damping": "kalman"}]}
    runs = [
        simulate(Scenario.parse({**data, "run": {**data["run"], "seed": seed}})).methods[0].rows[:, :7] ** 2
        for seed in range(20)
    ]
    found = budget(Scenario.parse(data)).methods[0].series
    assert found is not None and "log_resolution" in found.sources
    ratio = np.sqrt(np.mean(runs, axis=(0, 1)) / found.total.mean(axis=0))
    assert ratio[[3, 4]] == pytest.approx(1.0, abs=0.1)


def test_in_the_steady_state_it_is_a_constant_beside_the_noise() -> None:
    """Velocity feedback pulls the velocity onto the log, and so onto its standing error."""
    compass = {"damping": "external", "network": {"id": "compass", "sigma": 0.0088, "xi": 0.7}}

    def left(noise_mps: float) -> float | None:
        data = scenario(noise_mps=noise_mps).canonical() | {"method": [compass]}
        found = budget(Scenario.parse(data), steady=True).methods[0].sources
        return found["log_resolution"].rms.velocity_mps if "log_resolution" in found else None

    assert left(0.0) == pytest.approx(0.1 / 12.0**0.5, rel=1e-6)
    assert left(0.02) == pytest.approx(standing_rounding(0.1, 0.02), rel=1e-6)
    assert left(0.1) == pytest.approx(0.0, abs=1e-6)
