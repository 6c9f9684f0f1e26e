"""Liu 5, 6, 11 and figure 3: the complementary-filter network (theory.md 3.2)."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from navcore.analysis import RADIUS, analyse, frequency_response, transfer
from navcore.foundation.earth import SPHERE
from navcore.networks import parse_network

OMEGA_S = SPHERE.schuler_frequency(0.0)


@given(zeta=st.floats(0.01, 10.0), eta=st.floats(0.01, 10.0))
def test_closed_loop_identity(zeta: float, eta: float) -> None:
    network = parse_network({"id": "complementary", "zeta": zeta, "eta": eta}).transfer(OMEGA_S)
    w = OMEGA_S
    product = np.polymul([1, w, w**2], np.polymul([1, 2 * eta * w, w**2], [1, 2 * zeta * w, w**2]))
    closed = np.polyadd(np.polymul([1.0, 0.0, 0.0], network.den), w**2 * network.num)
    np.testing.assert_allclose(closed, product, rtol=1e-12)
    assert network.h0 == 1.0
    assert np.all(network.poles.real < 0.0)


@pytest.mark.parametrize("zeta", [0.1, 0.5, 0.7, 1.3])
def test_liu_6_reference_error_to_tilt_at_eta_one_half(zeta: float) -> None:
    """R phi/dV_r has the numerator 2 zeta omega_s^3 s^2 and Liu's coefficients (for zeta = 0.7) below."""
    network = parse_network({"id": "complementary", "zeta": zeta}).transfer(OMEGA_S)
    num, den = transfer(network, "dv_r", "phi")
    np.testing.assert_allclose(-RADIUS * num, [2 * zeta * OMEGA_S**3, 0.0, 0.0], rtol=1e-12)
    if zeta == 0.7:
        powers = OMEGA_S ** np.arange(7)
        np.testing.assert_allclose(den, np.array([1, 3.4, 6.8, 8.2, 6.8, 3.4, 1]) * powers, rtol=1e-12)


def test_liu_figure_3_lowest_at_high_frequency() -> None:
    high = OMEGA_S * np.logspace(1, 3, 20)
    size = {
        name: np.abs(frequency_response(parse_network({"id": name}).transfer(OMEGA_S), "dv_r", "phi", high))
        for name in ("complementary", "classic2", "classic3")
    }
    assert np.all(size["complementary"] < size["classic2"])
    assert np.all(size["complementary"] < size["classic3"])


def test_default_has_a_triple_pair_of_damping_one_half() -> None:
    loop = analyse(parse_network({"id": "complementary"}).transfer(OMEGA_S))
    assert loop.damping_ratio == pytest.approx(0.5, rel=1e-14)
    assert loop.natural_frequency == pytest.approx(OMEGA_S, rel=1e-14)
