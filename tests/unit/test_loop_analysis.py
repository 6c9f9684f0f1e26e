"""Stability, damping and settling of the closed loop; root loci; placement of a pair."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from navcore.analysis import analyse, initial_tilt_response
from navcore.analysis.locus import root_locus
from navcore.analysis.loop import closed_loop_poles, closed_loop_polynomial
from navcore.analysis.placement import place
from navcore.analysis.settling import LEVEL, last_exceedance
from navcore.foundation.errors import InputError
from navcore.networks import NETWORKS, LinearNetwork, parse_network
from navcore.networks.classic import Classic2Network
from navcore.networks.compass import CompassNetwork
from navcore.networks.complementary import ComplementaryNetwork
from navcore.networks.pole2 import Pole2Network
from navcore.networks.state_space import StateSpace
from navcore.networks.unity2 import Unity2Network

OMEGA_S = float(np.sqrt(9.80665 / 6378137.0))


def loop_of(text: str):
    return analyse(parse_network(text).transfer(OMEGA_S))


def test_free_loop_counts_as_stable_and_undamped() -> None:
    """H = 1, but with a pole whose rounding the loop must not show; `none` is in test_network_report."""
    for rate in (1e-4, 0.003, 0.01, 0.7):
        loop = loop_of(f'id = "custom", zeros = [-{rate}], poles = [-{rate}]')
        assert loop.stable
        assert loop.damping_ratio == 0.0
        assert loop.settling_s is None
        assert loop.warnings == ("undamped",)


def test_unstable_loops_say_so() -> None:
    loop = loop_of('id = "compass", k1 = -0.01, k2 = 5.0, k3 = 1.0')
    assert not loop.stable
    assert loop.damping_ratio < 0.0
    assert loop.settling_s is None
    assert loop.warnings[0].startswith("unstable")


def test_repeated_poles_on_the_axis_grow_though_none_lies_to_the_right() -> None:
    """p^2 D + N = (p^2 + 1)^2 with D = p^2 + d, N = (2 - d) p^2 + 1; twice p = 0 with D = p + 1, N = p^2."""
    for d in (0.5, 0.7, 0.9, 1.3, 1.7):
        block = {"id": "custom", "num": [2.0 - d, 0.0, OMEGA_S**2], "den": [1.0, 0.0, d * OMEGA_S**2]}
        loop = analyse(parse_network(block).transfer(OMEGA_S))
        assert not loop.stable
        assert loop.settling_s is None
    twice = loop_of('id = "custom", num = [1.0, 0.0, 0.0], den = [1.0, 1.0, 1.0]')
    assert not twice.stable


def test_real_poles_only_have_damping_one_and_the_slowest_rate() -> None:
    loop = loop_of('id = "compass", sigma = 0.0088, xi = 3.0')
    assert np.all(loop.poles.imag == 0.0)
    assert loop.damping_ratio == 1.0
    assert loop.natural_frequency == pytest.approx(np.min(np.abs(loop.poles)))


@pytest.mark.parametrize(
    ("text", "part"),
    [
        (
            'id = "compass"',
            "H(0) = 34.26 differs from 1: the loop is not Schuler-tuned, it needs the reference",
        ),
        ('id = "pole2"', "H(0) = 0.6481 differs"),
        ('id = "compass", k1 = 0.01, k2 = 5.0, k3 = 0.0', "H(0) = 0: a closed-loop pole at zero"),
    ],
)
def test_warnings_about_h0(text: str, part: str) -> None:
    loop = loop_of(text)
    assert loop.stable
    assert any(part in warning for warning in loop.warnings)


@pytest.mark.parametrize("name", ["classic2", "classic3", "complementary", "unity2"])
def test_no_warning_within_a_thousandth_of_unity(name: str) -> None:
    assert loop_of(f'id = "{name}"').warnings == ()


@given(
    block=st.one_of(
        st.builds(
            lambda s, x: {"id": "compass", "sigma": s, "xi": x}, st.floats(1e-5, 1.0), st.floats(0.01, 10.0)
        ),
        st.builds(
            lambda z, e: {"id": "complementary", "zeta": z, "eta": e},
            st.floats(0.01, 10.0),
            st.floats(0.01, 10),
        ),
        st.builds(
            lambda x, a, b: {"id": "pole2", "xi": x, "n1": a, "n2": b},
            st.floats(0.01, 5.0),
            st.floats(20.0, 100.0),
            st.floats(0.1, 5.0),
        ),
        st.builds(
            lambda z, r, z2: {"id": "unity2", "zeta": z, "r": r, "zeta2": z2},
            st.floats(0.01, 5.0),
            st.floats(1.01, 10.0),
            st.floats(0.01, 5.0),
        ),
        st.builds(
            lambda z, r, a: {"id": "unity2", "zeta": z, "r": r, "alpha": a},
            st.floats(0.01, 5.0),
            st.floats(1.01, 10.0),
            st.floats(1e-6, 10.0),
        ),
    )
)
def test_poles_known_by_design_are_those_of_the_polynomial(block: dict[str, object]) -> None:
    network = parse_network(block).transfer(OMEGA_S)
    assert network.closed_loop_p is not None
    designed = np.real(np.poly(network.closed_loop_p))
    actual = closed_loop_polynomial(network)
    np.testing.assert_allclose(designed, actual, rtol=1e-9, atol=1e-9 * np.min(np.abs(actual)))
    assert analyse(network).stable


def unity2(zeta: float) -> LinearNetwork:
    return parse_network({"id": "unity2", "zeta": zeta}).transfer(OMEGA_S)


def peak_of(zeta: float, number: int) -> tuple[float, float]:
    """Time and height of the n-th maximum of |phi/phi_0|."""
    time = np.linspace(0.0, 60_000.0, 60_001)
    size = np.abs(initial_tilt_response(unity2(zeta), time))
    maxima = np.flatnonzero((size[1:-1] > size[:-2]) & (size[1:-1] >= size[2:])) + 1
    return float(time[maxima[number]]), float(size[maxima[number]])


@pytest.mark.parametrize("number", [3, 4, 5, 6, 7, 8])
def test_a_last_peak_just_above_the_level_is_not_missed(number: int) -> None:
    """Choose zeta so that a late peak exceeds 2 % by a ten-thousandth: the loop settles there, not before."""
    low, high = 0.05, 0.5
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if peak_of(middle, number)[1] > 0.02 * 1.0001 else (low, middle)
    time, height = peak_of(low, number)
    assert height == pytest.approx(0.02 * 1.0001, rel=1e-6)
    settling = analyse(unity2(low)).settling_s
    assert settling is not None
    assert time < settling < time + 0.05 / OMEGA_S
    after = analyse(unity2(low * 1.001)).settling_s
    assert after is not None
    assert after < time - 0.5 / OMEGA_S


@pytest.mark.parametrize("name", NETWORKS)
def test_other_schuler_frequencies_work_alike(name: str) -> None:
    for omega_s in (1.23e-3, 1.25e-3):
        loop = analyse(parse_network({"id": name}).transfer(omega_s))
        assert loop.stable


# ---------------------------------------------------------------- settling of a known response


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


# ---------------------------------------------------------------- root locus


ROUNDED_OMEGA_S = 1.24e-3


def test_compass_poles_move_along_a_ray_with_sigma():
    sigma = np.geomspace(1e-3, 0.1, 30)
    locus = root_locus(CompassNetwork(sigma=0.01, xi=0.6), "sigma", sigma, ROUNDED_OMEGA_S)
    np.testing.assert_array_equal(locus.values, sigma)
    real = np.abs(locus.poles.imag).max(axis=0).argmin()
    np.testing.assert_allclose(locus.poles[:, real], -sigma, rtol=1e-9)
    for branch in np.delete(np.arange(3), real):
        np.testing.assert_allclose(-locus.poles[:, branch].real / np.abs(locus.poles[:, branch]), 0.6)


def test_branches_do_not_jump():
    locus = root_locus(Unity2Network(), "zeta", np.linspace(0.05, 0.9, 200), ROUNDED_OMEGA_S)
    steps = np.abs(np.diff(locus.poles, axis=0))
    assert steps.max() < 0.1 * np.abs(locus.poles).max()


def test_refused_values_are_left_out():
    locus = root_locus(Pole2Network(), "n1", np.linspace(5.0, 20.0, 31), ROUNDED_OMEGA_S)
    assert 5.0 not in locus.values
    assert locus.values[0] > 5.0
    assert locus.values[-1] == 20.0
    assert locus.poles.shape == (len(locus.values), 4)
    nothing = root_locus(Pole2Network(), "n1", np.array([-1.0]), ROUNDED_OMEGA_S)
    assert nothing.poles.shape == (0, 0)


# ---------------------------------------------------------------- placement


ALL = (CompassNetwork(), Unity2Network(), Pole2Network(), ComplementaryNetwork())


@given(
    xi=st.floats(0.01, 0.999),
    ratio=st.floats(0.9, 12.0),
    network=st.sampled_from(ALL),
)
def test_the_pair_is_where_it_is_said_to_be(xi, ratio, network):
    placed = place(network, xi, ratio * ROUNDED_OMEGA_S, ROUNDED_OMEGA_S)
    p = complex(-placed.damping_ratio, np.sqrt(1.0 - placed.damping_ratio**2)) * placed.frequency
    poles = closed_loop_poles(placed.parameters.transfer(ROUNDED_OMEGA_S)) * ROUNDED_OMEGA_S
    assert np.abs(poles - p).min() < 1e-9 * abs(p)
    assert placed.damping_ratio == xi
    met = placed.frequency == pytest.approx(ratio * ROUNDED_OMEGA_S, rel=1e-6)
    assert met == (placed.note == "")


@pytest.mark.parametrize(
    ("network", "xi", "omega", "said"),
    [
        (CompassNetwork(), 1.2, ROUNDED_OMEGA_S, "damping ratio = 1.2"),
        (CompassNetwork(), 0.5, -1.0, "frequency = -1"),
        (CompassNetwork(), 0.5, 40.0, "sigma = 20"),
        (Classic2Network(), 0.5, ROUNDED_OMEGA_S, "cannot be placed"),
        (Pole2Network(variant="as_printed"), 0.5, ROUNDED_OMEGA_S, "pole2 (exact)"),
    ],
)
def test_what_cannot_be_is_said(network, xi, omega, said):
    with pytest.raises(InputError) as refused:
        place(network, xi, omega, ROUNDED_OMEGA_S)
    assert said in str(refused.value)


@given(
    xi=st.floats(0.01, 1.0),
    ratio=st.floats(0.1, 100.0),
    network=st.sampled_from(ALL),
)
def test_parameters_to_pair_to_parameters(xi, ratio, network):
    nearest = network.main_pair(ROUNDED_OMEGA_S).nearest(xi, ratio * ROUNDED_OMEGA_S)
    before = place(network, nearest[0], nearest[1], ROUNDED_OMEGA_S).parameters
    pair = before.main_pair(ROUNDED_OMEGA_S)
    after = place(before, pair.damping_ratio, pair.frequency, ROUNDED_OMEGA_S).parameters
    for name, value in before:
        assert getattr(after, name) == (pytest.approx(value, rel=1e-12) if name in ("sigma", "r") else value)


@given(xi=st.floats(1e-6, 50.0), ratio=st.floats(1e-6, 1e6), network=st.sampled_from(ALL))
def test_the_nearest_possible_pair_is_placed_without_a_note(xi, ratio, network):
    pair = network.main_pair(ROUNDED_OMEGA_S)
    nearest = pair.nearest(xi, ratio * ROUNDED_OMEGA_S)
    placed = place(network, nearest[0], nearest[1], ROUNDED_OMEGA_S)
    assert placed.note == ""
    assert (placed.damping_ratio, placed.frequency) == pytest.approx(nearest, rel=1e-12)
    assert pair.nearest(*nearest) == pytest.approx(nearest, rel=1e-9)


def test_the_nearest_pair_keeps_to_the_ranges_of_the_parameters():
    unity, compass = (
        n.main_pair(ROUNDED_OMEGA_S) for n in (Unity2Network(), CompassNetwork(sigma=0.002, xi=0.5))
    )
    assert unity.nearest(0.5, 1.004 * ROUNDED_OMEGA_S) == (0.5, pytest.approx(1.01 * ROUNDED_OMEGA_S))
    assert unity.nearest(0.5, 0.996 * ROUNDED_OMEGA_S) == (0.5, pytest.approx(0.99 * ROUNDED_OMEGA_S))
    assert unity.nearest(3.0, 20.0 * ROUNDED_OMEGA_S) == (1.0, pytest.approx(10.0 * ROUNDED_OMEGA_S))
    assert (compass.damping_ratio, compass.frequency) == (0.5, 0.004)
    assert compass.nearest(0.5, 40.0) == (0.5, pytest.approx(2.0))
    assert compass.nearest(0.001, 0.01) == (0.01, 0.01)
    assert ComplementaryNetwork().main_pair(ROUNDED_OMEGA_S).nearest(0.3, 5.0) == (0.3, ROUNDED_OMEGA_S)


@given(sigma=st.floats(3e-4, 0.1), xi=st.floats(0.05, 0.95))
def test_gains_have_the_pair_of_the_sigma_and_xi_that_give_them(sigma, xi):
    k1, k2, k3 = CompassNetwork(sigma=sigma, xi=xi).gains(ROUNDED_OMEGA_S)
    pair = CompassNetwork(k1=k1, k2=k2, k3=k3).main_pair(ROUNDED_OMEGA_S)
    assert (pair.damping_ratio, pair.frequency) == pytest.approx((xi, sigma / xi), rel=1e-6)


def test_what_has_no_pair_to_be_placed_has_a_reason():
    assert CompassNetwork(k1=0.1, k2=0.01, k3=1e-9).main_pair(ROUNDED_OMEGA_S) is None
    assert Pole2Network(variant="as_printed").main_pair(ROUNDED_OMEGA_S) is None
    assert Classic2Network().main_pair(ROUNDED_OMEGA_S) is None
    for network in (CompassNetwork, Pole2Network, Classic2Network):
        assert network.no_handle
