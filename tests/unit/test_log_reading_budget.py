"""Error of the log in turns, and its smoothing: budget against runs, strapdown against the error model."""

from typing import Any

import numpy as np
import pytest

from navcore.design.seeds import seed_variance
from navcore.design.ship import Ship
from navcore.design.unmodelled import unmodelled_warnings
from navcore.engine.simulation import simulate
from navcore.mechanization.recorder import DV_E, DV_N
from navcore.scenario.model import Scenario

TURNS = {
    "kind": "legs",
    "leg": [
        {"duration_s": 600.0, "speed_kn": 10.0, "heading_deg": 30.0},
        {"duration_s": 900.0, "heading_deg": 150.0, "turn_dps": 1.0},
        {"duration_s": 900.0, "heading_deg": 30.0, "turn_dps": 1.0},
    ],
}
TERMS = pytest.mark.parametrize("term", [{"turn_s": 2.0}, {"smoothing_s": 30.0}], ids=["turn", "smoothing"])
COMPASS = {"damping": "external", "network": {"id": "compass", "sigma": 0.02, "xi": 0.7}}


def scenario(log: dict[str, Any], **blocks: Any) -> Scenario:
    run = {"duration_h": 0.6, "output_step_s": 5.0}
    return Scenario.parse(
        {"run": run, "reference": {"kind": "log", **log}, "method": [COMPASS], "motion": TURNS} | blocks
    )


def total(made: Scenario) -> np.ndarray:
    """Variances along the run by all sources, shape (n, 7)."""
    return np.sum(list(Ship(made).along(made.method[0]).variance.values()), axis=0)


def ratio(made: Scenario, seeds: int) -> np.ndarray:
    """RMS along the run by covariance over that by runs, tilts and velocity, shape (4,)."""
    variance = total(made)
    _, squares = seed_variance(made, made.method[0], seeds=seeds)
    return np.sqrt(np.mean(variance, axis=0) / np.mean(squares, axis=0))[[0, 1, 4, 5]]


@TERMS
def test_the_budget_knows_it_by_its_shape(term: dict[str, float]) -> None:
    assert ratio(scenario(term), 1) == pytest.approx(np.ones(4), abs=0.015)


def test_the_covariance_takes_smoothed_noise_for_the_drift_that_it_is() -> None:
    still = {"motion": {"kind": "static"}}
    smoothed = scenario({"noise_mps": 0.5, "smoothing_s": 60.0}, **still)
    assert ratio(smoothed, 60) == pytest.approx(np.ones(4), abs=0.08)
    white = scenario({"noise_mps": 0.5}, **still)
    with_it, without = (np.sqrt(total(made)[-1, 0]) for made in (smoothed, white))
    assert with_it < 0.5 * without


def test_beside_a_drift_the_budget_says_which_of_the_two_it_leaves_out() -> None:
    log = {"noise_mps": 0.1, "smoothing_s": 30.0, "drift_mps": 0.3, "drift_tau_s": 600.0}
    made = scenario(log)
    assert made.reference.markov == (0.3, 600.0)
    assert "reference.noise_mps: log noise is not in the budget" in map(str, unmodelled_warnings(made))


@TERMS
def test_the_strapdown_agrees_with_the_error_model(term: dict[str, float]) -> None:
    blocks = {"run": {"duration_h": 0.6, "output_step_s": 5.0, "rate_hz": 50.0, "fidelity": "strapdown"}}
    found = [
        simulate(made).methods[0].rows[:, [DV_E, DV_N]] for made in (scenario(term), scenario(term, **blocks))
    ]
    assert np.abs(found[1] - found[0]).max() < 0.02 * np.abs(found[0]).max()


@pytest.mark.parametrize("method", [{"damping": "kalman"}, COMPASS | {"network": {"id": "optimal"}}])
def test_filters_are_told_of_smoothed_noise(method: dict[str, Any]) -> None:
    run = simulate(scenario({"noise_mps": 0.5, "smoothing_s": 60.0}, method=[method]))
    assert np.isfinite(run.methods[0].rows).all()
