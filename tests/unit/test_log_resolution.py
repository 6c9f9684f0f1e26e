"""The budget of a log that rounds its readings: against runs, in the steady state, its terms."""

import math
from typing import Any

import numpy as np
import pytest

from navcore.design.budget import budget
from navcore.design.seeds import seed_variance
from navcore.quantities import COMPONENTS, TILT, VELOCITY, components
from navcore.scenario.model import Scenario
from navcore.scenario.stochastic import stochastic_model
from navcore.sensors.rounding import deviations, rounded

PARTS = (components(TILT), components(VELOCITY))
LEGS = {
    "kind": "legs",
    "repeat": 4,
    "leg": [
        {"duration_s": 2700.0, "speed_mps": 5.03, "heading_deg": 20.0},
        {"duration_s": 2700.0, "heading_deg": 200.0},
        {"duration_s": 1800.0, "speed_mps": 3.3, "heading_deg": 77.0},
    ],
}


def _scenario(network: str = "complementary", motion: Any = LEGS, **log: Any) -> Scenario:
    return Scenario.parse(
        {
            "run": {"duration_h": 6.0, "output_step_s": 60.0},
            "site": {"lat_deg": 40.0},
            "motion": motion,
            "reference": {"kind": "log", "lsb_mps": 0.1, **log},
            "method": [{"damping": "external", "network": {"id": network}}],
        }
    )


@pytest.mark.parametrize(
    ("network", "log", "seeds", "within"),
    [
        ("complementary", {}, 1, 0.01),
        ("unity2", {"frame": "body"}, 1, 0.01),
        ("complementary", {"noise_mps": 0.02}, 8, 0.02),
        ("complementary", {"noise_mps": 0.02, "rate_hz": 10.0}, 2, 0.01),
        ("complementary", {"drift_mps": 0.02}, 40, 0.12),
    ],
)
def test_the_budget_is_that_of_runs(network: str, log: dict[str, Any], seeds: int, within: float) -> None:
    """Counted as white noise, rounding without noise is 35 times too small on these legs."""
    scenario = _scenario(network, **log)
    _, squares = seed_variance(scenario, scenario.method[0], seeds)
    run = np.sqrt(np.mean(squares, axis=0))
    entry = budget(scenario).methods[0]
    tilt, velocity = (
        math.sqrt(np.mean(run[[COMPONENTS.index(name) for name in names]] ** 2)) for names in PARTS
    )
    assert entry.total.rms.tilt_rad == pytest.approx(tilt, rel=within)
    assert entry.total.rms.velocity_mps == pytest.approx(velocity, rel=within)


def test_a_ship_at_rest_is_read_without_error() -> None:
    """Its speed of 0 is a whole number of steps; and the steady state counts a constant of lsb / sqrt(12)."""
    scenario = _scenario(motion={"kind": "static"})
    assert budget(scenario).methods[0].total.rms.tilt_rad == 0.0
    assert stochastic_model(scenario).log_sample() == 0.0
    assert stochastic_model(scenario).log_held() == pytest.approx(0.1 / math.sqrt(12.0), rel=1e-12)
    steady = budget(_scenario("unity2", motion={"kind": "static"}), steady=True).methods[0]
    assert steady.sources["log_white"].rms.tilt_rad == 0.0 and "log_resolution" in steady.sources
    assert any("lsb_mps = 0.1" in warning for warning in steady.warnings)


def test_noise_of_half_a_step_makes_white_noise_of_rounding() -> None:
    """Nothing of a known shape is left, and the budget has the figure of a filter's."""
    scenario = _scenario(noise_mps=0.05)
    assert "log_resolution" not in budget(scenario).methods[0].sources
    assert stochastic_model(scenario).log_sample() == math.hypot(0.05, 0.1 / math.sqrt(12.0))


@pytest.mark.parametrize("noise", [0.01, 0.03, 0.049])
def test_mean_and_variance_of_a_rounded_reading(noise: float) -> None:
    """`rounded` is the mean of many, and over all speeds its deviation is the first of `deviations`."""
    rng = np.random.default_rng(3)
    speeds = 0.1 * (np.arange(200) + 0.5) / 200.0
    many = np.round((speeds + noise * rng.standard_normal((20_000, 200))) / 0.1) * 0.1
    mean = rounded(speeds, 0.1, noise)
    assert mean == pytest.approx(many.mean(axis=0), abs=5.0 * 0.05 / math.sqrt(20_000))
    assert np.sqrt(np.mean((mean - speeds) ** 2)) == pytest.approx(deviations(0.1, noise)[0], rel=1e-4)
