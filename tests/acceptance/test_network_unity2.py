"""physics.md 3.4: exact damping and H(0) = 1 at once."""

from __future__ import annotations

import numpy as np
import pytest

from navcore.earth import SPHERE
from navcore.loop import analyse
from navcore.network import parse_network

OMEGA_S = SPHERE.schuler_frequency(0.0)


@pytest.mark.parametrize("zeta", [0.04, 0.3, 0.5, 0.7, 1.0, 1.3])
@pytest.mark.parametrize("more", [{}, {"r": 1.05}, {"r": 2.5, "zeta2": 1.5}, {"alpha": 0.02}])
def test_identity_with_the_formulas_in_rad_per_second(zeta: float, more: dict[str, float]) -> None:
    network = parse_network({"id": "unity2", "zeta": zeta, **more}).transfer(OMEGA_S)
    r = more.get("r", 1.2)
    w0 = r * OMEGA_S
    alpha = more.get("alpha")
    if alpha is None:
        zeta2 = more.get("zeta2", max(0.7, zeta))
        cross = 2 * zeta * zeta2 * r
        q = OMEGA_S * (cross + np.sqrt(cross**2 + (r**2 - 1) ** 2)) / (r**2 - 1)
        alpha = 2 * zeta2 * q
    beta = (2 * zeta * w0 * alpha + w0**2 - OMEGA_S**2) / (r**2 - 1)
    delta = np.polymul([1.0, 2 * zeta * w0, w0**2], [1.0, alpha, beta])
    closed = np.polyadd(np.polymul([1.0, 0.0, 0.0], network.den), OMEGA_S**2 * network.num)
    np.testing.assert_allclose(closed, delta, rtol=1e-11)
    assert network.h0 == 1.0


@pytest.mark.parametrize("zeta", [0.04, 0.5, 0.69, 0.9, 1.0])
def test_least_damping_is_the_one_asked(zeta: float) -> None:
    loop = analyse(parse_network({"id": "unity2", "zeta": zeta}).transfer(OMEGA_S))
    assert loop.damping_ratio == pytest.approx(zeta, rel=1e-12)
    assert loop.warnings == ()
    assert loop.stable
