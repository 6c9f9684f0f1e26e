"""The covariance of the budget beside 200 seeds at steps of 2 s; `make covariance`: 2,000 at steps of 1 s."""

import numpy as np
import pytest

from tools.covariance import MOTIONS, ratios

SEEDS = 200


@pytest.mark.known(
    "twin",
    ["tilt_rms", "velocity_rms", "heading_rms", "position_rms"],
    kinds=["external"],
    fidelities=["covariance"],
    source="an ensemble of runs",
)
@pytest.mark.slow
@pytest.mark.parametrize("motion", MOTIONS)
def test_covariance_holds_against_seeds(motion: str) -> None:
    """Eight methods, five times, seven quantities: no bias, and no ratio beyond what 200 seeds leave."""
    found = np.sqrt(ratios(motion, SEEDS, step_s=2.0))
    assert np.all(np.abs(found - 1.0) < 4.5 / np.sqrt(2.0 * SEEDS))
    assert abs(float(np.mean(found)) - 1.0) < 0.05
