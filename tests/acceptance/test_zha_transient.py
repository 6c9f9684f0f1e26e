"""Zha 15: response of the compass loop to an initial tilt, for pairs of complex, repeated and real poles."""

from __future__ import annotations

import numpy as np
import pytest

from navcore.analysis import analyse, initial_tilt_response
from navcore.foundation.earth import SPHERE
from navcore.networks import parse_network

OMEGA_S = SPHERE.schuler_frequency(0.0)


def zha_15(sigma: float, xi: float, time_s: np.ndarray) -> np.ndarray:
    """The printed formula, continued to xi > 1 by complex square roots; the limit at xi = 1."""
    decay = np.exp(-sigma * time_s)
    if xi == 1.0:
        return decay * (1.0 + sigma * time_s - (sigma * time_s) ** 2)
    root = np.sqrt(complex(1.0 - xi**2))
    wd = sigma * root / xi
    bracket = (1 + xi**2) / root**2 * np.cos(wd * time_s) + xi / root * np.sin(wd * time_s)
    return np.real(decay * (bracket - 2 * xi**2 / root**2))


@pytest.mark.parametrize("sigma", [0.002, 0.0088, 0.13])
@pytest.mark.parametrize("xi", [0.1, 0.5, 0.7, 0.99, 1.0, 1.01, 1.5, 3.0])
def test_transient_formula(sigma: float, xi: float) -> None:
    time = np.linspace(0.0, 12.0 / sigma, 1201)
    network = parse_network({"id": "compass", "sigma": sigma, "xi": xi}).transfer(OMEGA_S)
    found = initial_tilt_response(network, time)
    # 0.1 % is asked; near xi = 1 the printed formula itself loses digits
    np.testing.assert_allclose(found, zha_15(sigma, xi, time), atol=1e-10)
    assert found[0] == pytest.approx(1.0)


def test_xi_next_to_one_joins_the_limit() -> None:
    time = np.linspace(0.0, 1500.0, 301)
    at = [
        initial_tilt_response(parse_network({"id": "compass", "xi": xi}).transfer(OMEGA_S), time)
        for xi in (1.0 - 1e-9, 1.0, 1.0 + 1e-9)
    ]
    np.testing.assert_allclose(at[0], at[1], atol=1e-7)
    np.testing.assert_allclose(at[2], at[1], atol=1e-7)


def test_zhas_design_example_is_settled_in_ten_minutes() -> None:
    """sigma t = 5.25 leaves 0.5 % of the envelope (Zha prints 99.995 % and 525; theory.md section 8)."""
    network = parse_network('id = "compass", sigma = 0.0088, xi = 0.7').transfer(OMEGA_S)
    assert abs(initial_tilt_response(network, np.array([5.25 / 0.0088]))[0]) < 0.02
    settling = analyse(network).settling_s
    assert settling is not None
    assert settling < 600.0
    # theory.md 9.6 finds 541 and 545 s with the full strapdown
    assert settling == pytest.approx(543.0, abs=3.0)


def test_repeated_poles_settle_where_the_formula_does() -> None:
    settling = analyse(parse_network('id = "compass", xi = 1.0').transfer(OMEGA_S)).settling_s
    time = np.linspace(0.0, 2000.0, 2_000_001)
    last = time[np.flatnonzero(np.abs(zha_15(0.0088, 1.0, time)) > 0.02)[-1]]
    assert settling == pytest.approx(last, abs=2e-3)
