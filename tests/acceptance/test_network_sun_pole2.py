"""Sun 12-18 and Table 1: the two-pole network, exact and as printed (theory.md 3.3)."""

from __future__ import annotations

import numpy as np
import pytest

from navcore.analysis import analyse
from navcore.analysis.loop import Loop
from navcore.foundation.earth import SPHERE
from navcore.networks import parse_network
from navcore.networks.base import LinearNetwork

OMEGA_S = SPHERE.schuler_frequency(0.0)
SUN_TABLE_1 = [0.04, 0.05, 0.08, 0.10, 0.12, 0.22, 0.44, 0.64, 0.82, 0.99]


def network_of(xi: float, variant: str, **more: float) -> LinearNetwork:
    return parse_network({"id": "pole2", "xi": xi, "variant": variant, **more}).transfer(OMEGA_S)


def loop_of(xi: float, variant: str) -> Loop:
    return analyse(network_of(xi, variant))


@pytest.mark.parametrize("xi", SUN_TABLE_1)
def test_exact_poles_are_where_they_were_asked(xi: float) -> None:
    network = network_of(xi, "exact")
    quadratic = np.polymul([1.0, 2.0 * xi, 1.0], np.polymul([1.0, 14.0 * xi], [1.0, 5.0 * xi]))
    closed = np.polyadd(np.append(network.den_p, [0.0, 0.0]), network.num_p)
    np.testing.assert_allclose(closed, quadratic, rtol=1e-12)
    loop = analyse(network)
    assert loop.damping_ratio == pytest.approx(xi, rel=1e-12)
    assert loop.natural_frequency == pytest.approx(OMEGA_S, rel=1e-12)
    assert loop.h0 == pytest.approx(0.648, abs=5e-4)


@pytest.mark.parametrize("xi", SUN_TABLE_1)
def test_partial_fractions_are_suns(xi: float) -> None:
    """H = 1 + A/(s+w1) + B/(s+w2) with A, B, w1, w2 as theory.md 3.3 gives them."""
    n1, n2 = 14.0, 5.0
    a, b = (n1 + n2 + 2) * xi * OMEGA_S, (n1 * n2 + 2 * (n1 + n2)) * (xi * OMEGA_S) ** 2
    c, d = (2 * n1 * n2 * xi**3 + (n1 + n2) * xi) * OMEGA_S, n1 * n2 * (xi * OMEGA_S) ** 2
    w1 = 2 * b / (a + np.sqrt(a * a - 4 * b))
    w2 = b / w1
    residue_1 = ((c - a) * w1 - (d - b)) / (w1 - w2)
    omega = OMEGA_S * np.logspace(-2, 2, 9)
    s = 1j * omega
    for variant, residue_2 in (("exact", (c - a) - residue_1), ("as_printed", -residue_1 * w2 / w1)):
        network = network_of(xi, variant)
        expected = 1.0 + residue_1 / (s + w1) + residue_2 / (s + w2)
        np.testing.assert_allclose(network.response(omega), expected, rtol=1e-10)


def test_as_printed_has_unit_dc_gain_but_less_damping() -> None:
    half = loop_of(0.5, "as_printed")
    assert half.h0 == 1.0
    assert half.damping_ratio == pytest.approx(0.34, abs=0.005)
    assert loop_of(0.3, "as_printed").damping_ratio == pytest.approx(0.16, abs=0.005)


def test_as_printed_is_unstable_up_to_0_104() -> None:
    assert not loop_of(0.104, "as_printed").stable
    assert loop_of(0.105, "as_printed").stable
    assert not loop_of(0.08, "as_printed").stable
    assert loop_of(0.08, "as_printed").warnings[0].startswith("unstable")
    assert loop_of(0.08, "exact").stable


def test_four_of_the_ten_entries_of_suns_table_are_unstable_as_printed() -> None:
    assert [loop_of(xi, "as_printed").stable for xi in SUN_TABLE_1] == [False] * 4 + [True] * 6


def test_double_pole_at_the_edge_of_the_refusal() -> None:
    network = network_of(0.5, "exact", n1=4.5, n2=0.5)
    assert network.poles[0] == pytest.approx(network.poles[1], rel=1e-9)
    assert analyse(network).damping_ratio == pytest.approx(0.5, rel=1e-9)
