"""Placement: the loop of the parameters found has the pair that was asked for, or a word why not."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from navcore.analysis.loop import closed_loop_poles
from navcore.analysis.placement import place
from navcore.foundation.errors import InputError
from navcore.networks.classic import Classic2Network
from navcore.networks.compass import CompassNetwork
from navcore.networks.complementary import ComplementaryNetwork
from navcore.networks.pole2 import Pole2Network
from navcore.networks.unity2 import Unity2Network

OMEGA_S = 1.24e-3
ALL = (CompassNetwork(), Unity2Network(), Pole2Network(), ComplementaryNetwork())


@given(
    xi=st.floats(0.01, 0.999),
    ratio=st.floats(0.9, 12.0),
    network=st.sampled_from(ALL),
)
def test_the_pair_is_where_it_is_said_to_be(xi, ratio, network):
    placed = place(network, xi, ratio * OMEGA_S, OMEGA_S)
    p = complex(-placed.damping_ratio, np.sqrt(1.0 - placed.damping_ratio**2)) * placed.frequency
    poles = closed_loop_poles(placed.parameters.transfer(OMEGA_S)) * OMEGA_S
    assert np.abs(poles - p).min() < 1e-9 * abs(p)
    assert placed.damping_ratio == xi
    met = placed.frequency == pytest.approx(ratio * OMEGA_S, rel=1e-6)
    assert met == (placed.note == "")


@pytest.mark.parametrize(
    ("network", "xi", "omega", "said"),
    [
        (CompassNetwork(), 1.2, OMEGA_S, "damping ratio = 1.2"),
        (CompassNetwork(), 0.5, -1.0, "frequency = -1"),
        (CompassNetwork(), 0.5, 40.0, "sigma = 20"),
        (Classic2Network(), 0.5, OMEGA_S, "cannot be placed"),
        (Pole2Network(variant="as_printed"), 0.5, OMEGA_S, "pole2 (exact)"),
    ],
)
def test_what_cannot_be_is_said(network, xi, omega, said):
    with pytest.raises(InputError) as refused:
        place(network, xi, omega, OMEGA_S)
    assert said in str(refused.value)


@given(
    xi=st.floats(0.01, 1.0),
    ratio=st.floats(0.1, 100.0),
    network=st.sampled_from(ALL),
)
def test_parameters_to_pair_to_parameters(xi, ratio, network):
    nearest = network.main_pair(OMEGA_S).nearest(xi, ratio * OMEGA_S)
    before = place(network, nearest[0], nearest[1], OMEGA_S).parameters
    pair = before.main_pair(OMEGA_S)
    after = place(before, pair.damping_ratio, pair.frequency, OMEGA_S).parameters
    for name, value in before:
        assert getattr(after, name) == (pytest.approx(value, rel=1e-12) if name in ("sigma", "r") else value)
    poles = closed_loop_poles(before.transfer(OMEGA_S)) * OMEGA_S
    p = complex(-pair.damping_ratio, np.sqrt(1.0 - pair.damping_ratio**2)) * pair.frequency
    assert np.abs(poles - p).min() < 1e-9 * abs(p)


@given(xi=st.floats(1e-6, 50.0), ratio=st.floats(1e-6, 1e6), network=st.sampled_from(ALL))
def test_the_nearest_possible_pair_is_placed_without_a_note(xi, ratio, network):
    pair = network.main_pair(OMEGA_S)
    nearest = pair.nearest(xi, ratio * OMEGA_S)
    placed = place(network, nearest[0], nearest[1], OMEGA_S)
    assert placed.note == ""
    assert (placed.damping_ratio, placed.frequency) == pytest.approx(nearest, rel=1e-12)
    assert pair.nearest(*nearest) == pytest.approx(nearest, rel=1e-9)


def test_the_nearest_pair_keeps_to_the_ranges_of_the_parameters():
    unity, compass = (n.main_pair(OMEGA_S) for n in (Unity2Network(), CompassNetwork(sigma=0.002, xi=0.5)))
    assert unity.nearest(0.5, 1.004 * OMEGA_S) == (0.5, pytest.approx(1.01 * OMEGA_S))
    assert unity.nearest(0.5, 0.996 * OMEGA_S) == (0.5, pytest.approx(0.99 * OMEGA_S))
    assert unity.nearest(3.0, 20.0 * OMEGA_S) == (1.0, pytest.approx(10.0 * OMEGA_S))
    assert (compass.damping_ratio, compass.frequency) == (0.5, 0.004)
    assert compass.nearest(0.5, 40.0) == (0.5, pytest.approx(2.0))
    assert compass.nearest(0.001, 0.01) == (0.01, 0.01)
    assert ComplementaryNetwork().main_pair(OMEGA_S).nearest(0.3, 5.0) == (0.3, OMEGA_S)


@given(sigma=st.floats(3e-4, 0.1), xi=st.floats(0.05, 0.95))
def test_gains_have_the_pair_of_the_sigma_and_xi_that_give_them(sigma, xi):
    k1, k2, k3 = CompassNetwork(sigma=sigma, xi=xi).gains(OMEGA_S)
    pair = CompassNetwork(k1=k1, k2=k2, k3=k3).main_pair(OMEGA_S)
    assert (pair.damping_ratio, pair.frequency) == pytest.approx((xi, sigma / xi), rel=1e-6)


def test_what_has_no_pair_to_be_placed_has_a_reason():
    assert CompassNetwork(k1=0.1, k2=0.01, k3=1e-9).main_pair(OMEGA_S) is None
    assert Pole2Network(variant="as_printed").main_pair(OMEGA_S) is None
    assert Classic2Network().main_pair(OMEGA_S) is None
    for network in (CompassNetwork, Pole2Network, Classic2Network):
        assert network.no_handle
