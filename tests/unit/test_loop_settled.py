"""When a response has come to rest: responses whose last crossing of the level is known in closed form."""

import math

import numpy as np
import pytest

from navcore.analysis.settling import LEVEL, last_exceedance
from navcore.networks.state_space import StateSpace


def settled(rate: float, gain: float) -> float | None:
    """Last crossing of gain e^(-rate tau)."""
    system = StateSpace(np.array([[-rate]]), np.array([1.0]), np.array([gain]), 0.0)
    return last_exceedance(system, np.array([-rate], dtype=complex))


@pytest.mark.parametrize("gain", [0.5, 1.0, 1e3, 1e5, 1e9])
def test_a_large_transient_is_followed_beyond_the_first_horizon(gain: float) -> None:
    assert settled(0.1, gain) == pytest.approx(10.0 * math.log(gain / LEVEL), rel=1e-6)


@pytest.mark.parametrize("rate", [50.0, 500.0])
def test_a_fast_response_settles_soon(rate: float) -> None:
    assert settled(rate, 1.0) == pytest.approx(math.log(1.0 / LEVEL) / rate, rel=1e-6)


def test_what_never_exceeds_the_level_is_settled_at_once() -> None:
    assert settled(0.1, 0.9 * LEVEL) == 0.0
