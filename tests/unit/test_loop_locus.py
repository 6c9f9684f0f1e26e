"""Root locus: branches that follow a pole; values that make no network are left out."""

import numpy as np

from navcore.analysis.locus import root_locus
from navcore.networks.compass import CompassNetwork
from navcore.networks.pole2 import Pole2Network
from navcore.networks.unity2 import Unity2Network

OMEGA_S = 1.24e-3


def test_compass_poles_move_along_a_ray_with_sigma():
    sigma = np.geomspace(1e-3, 0.1, 30)
    locus = root_locus(CompassNetwork(sigma=0.01, xi=0.6), "sigma", sigma, OMEGA_S)
    np.testing.assert_array_equal(locus.values, sigma)
    real = np.abs(locus.poles.imag).max(axis=0).argmin()
    np.testing.assert_allclose(locus.poles[:, real], -sigma, rtol=1e-9)
    for branch in np.delete(np.arange(3), real):
        np.testing.assert_allclose(-locus.poles[:, branch].real / np.abs(locus.poles[:, branch]), 0.6)


def test_branches_do_not_jump():
    locus = root_locus(Unity2Network(), "zeta", np.linspace(0.05, 0.9, 200), OMEGA_S)
    steps = np.abs(np.diff(locus.poles, axis=0))
    assert steps.max() < 0.1 * np.abs(locus.poles).max()


def test_refused_values_are_left_out():
    locus = root_locus(Pole2Network(), "n1", np.linspace(5.0, 20.0, 31), OMEGA_S)
    assert 5.0 not in locus.values
    assert locus.values[0] > 5.0
    assert locus.values[-1] == 20.0
    assert locus.poles.shape == (len(locus.values), 4)
    nothing = root_locus(Pole2Network(), "n1", np.array([-1.0]), OMEGA_S)
    assert nothing.poles.shape == (0, 0)
