"""Placement: the loop of the parameters found has the pair that was asked for, or a word why not."""

from __future__ import annotations

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
