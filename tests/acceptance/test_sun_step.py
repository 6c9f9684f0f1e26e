"""Sun 6, 7 and figure 3: step response of the third-order network itself, y = L^-1[H(s)/s]."""

from __future__ import annotations

import numpy as np
import pytest

from navcore.analysis import network_step_response
from navcore.foundation.earth import SPHERE
from navcore.networks import parse_network

OMEGA_S = SPHERE.schuler_frequency(0.0)


def sun_7(time_s: np.ndarray) -> np.ndarray:
    return 1.0 - (0.0244 * time_s + 9.7101) * np.exp(-0.0088 * time_s) + 9.7101 * np.exp(-0.0044 * time_s)


def test_printed_form_agrees_with_the_network_to_0_007() -> None:
    time = np.linspace(0.0, 3000.0, 3001)
    network = parse_network('id = "classic3"').transfer(OMEGA_S)
    worst = np.max(np.abs(network_step_response(network, time) - sun_7(time)))
    assert worst == pytest.approx(0.007, abs=0.0005)


def test_peak_is_2_51_at_204_s() -> None:
    time = np.linspace(0.0, 1000.0, 10_001)
    response = network_step_response(parse_network('id = "classic3"').transfer(OMEGA_S), time)
    assert np.max(response) == pytest.approx(2.51, abs=0.005)
    assert time[np.argmax(response)] == pytest.approx(204.0, abs=1.0)


def test_against_partial_fractions_with_unrounded_coefficients() -> None:
    """The same closed form with its coefficients from the residues: agreement to rounding."""
    z, zz, p, pp = 8.8e-4, 1.97e-2, 4.41e-3, 8.8e-3
    single = (z - p) * (zz - p) ** 2 / (-p * (pp - p) ** 2)
    final = z * zz**2 / (p * pp**2)
    # H(s)/s = final/s + single/(s+p) + a/(s+pp) + b/(s+pp)^2
    b = (z - pp) * (zz - pp) ** 2 / (-pp * (p - pp))
    a = 1.0 - final - single
    time = np.linspace(0.0, 3000.0, 301)
    expected = final + single * np.exp(-p * time) + (a + b * time) * np.exp(-pp * time)
    network = parse_network('id = "classic3"').transfer(OMEGA_S)
    np.testing.assert_allclose(network_step_response(network, time), expected, atol=1e-11)
