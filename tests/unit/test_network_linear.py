"""`LinearNetwork`: polynomials, roots, gains and frequency response belong to one H(s)."""

from dataclasses import replace

import numpy as np
import pytest

from navcore.networks import NETWORKS, parse_network
from navcore.networks.base import linear_network
from navcore.networks.roots import pair, quadratic_roots
from navcore.networks.state_space import state_space

OMEGA_S = float(np.sqrt(9.80665 / 6378137.0))
EXAMPLES = [
    *({"id": name} for name in NETWORKS),
    {"id": "compass", "sigma": 0.13},
    {"id": "compass", "k1": 7.68e-3, "k2": 6.68, "k3": 7.68e-3},
    {"id": "complementary", "zeta": 1.3},
    {"id": "pole2", "xi": 0.05, "variant": "as_printed"},
    {"id": "unity2", "zeta": 1.2, "alpha": 0.01},
    {"id": "custom", "poles": [-1e-3, -1e-3, -1e-3, -1e-3], "gain": 1e-12},
    {"id": "custom", "zeros": [-0.1], "poles": [0, [-1e-3, 2e-3], [-1e-3, -2e-3]], "gain": 1e-4},
]


@pytest.mark.parametrize("block", EXAMPLES, ids=str)
def test_zeros_poles_gain_and_polynomials_agree(block: dict[str, object]) -> None:
    network = parse_network(block).transfer(OMEGA_S)
    assert network.den[0] == 1.0
    assert len(network.poles) == network.order == len(network.den) - 1
    assert len(network.zeros) == len(network.num) - 1
    omega = OMEGA_S * np.logspace(-3, 3, 25)
    s = 1j * omega
    from_roots = np.full(s.shape, complex(network.gain))
    for zero in network.zeros:
        from_roots = from_roots * (s - zero)
    for pole in network.poles:
        from_roots = from_roots / (s - pole)
    from_polynomials = np.polyval(network.num, s) / np.polyval(network.den, s)
    np.testing.assert_allclose(network.response(omega), from_polynomials, rtol=1e-9)
    np.testing.assert_allclose(from_roots, from_polynomials, rtol=1e-9)


@pytest.mark.parametrize("block", EXAMPLES, ids=str)
def test_end_values(block: dict[str, object]) -> None:
    network = parse_network(block).transfer(OMEGA_S)
    far = network.response(1e9)
    if len(network.num) == len(network.den):
        assert far == pytest.approx(network.gain, rel=1e-6)
    else:
        assert abs(far) < 1e-6
    if np.isfinite(network.h0):
        assert complex(network.response(0.0)) == pytest.approx(network.h0, rel=1e-12)


def test_response_keeps_the_shape_and_the_arrays_are_read_only() -> None:
    network = parse_network({"id": "classic3"}).transfer(OMEGA_S)
    assert network.response(1e-3).shape == ()
    assert network.response(np.ones((2, 3))).shape == (2, 3)
    for name in ("num", "den", "zeros", "poles", "num_p", "den_p"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(network, name)[...] = 0.0


def test_repeated_roots_of_classic3_are_exact() -> None:
    network = parse_network({"id": "classic3"}).transfer(OMEGA_S)
    assert network.poles == pytest.approx([-4.41e-3, -8.8e-3, -8.8e-3], rel=1e-15)
    assert network.zeros == pytest.approx([-8.8e-4, -1.97e-2, -1.97e-2], rel=1e-15)


def test_networks_are_equal_only_with_the_same_poles_bit_for_bit() -> None:
    network = parse_network({"id": "classic3"}).transfer(OMEGA_S)
    same = replace(network, poles=network.poles.copy())
    rounded = replace(network, poles=network.poles * (1.0 + 1e-15))
    assert network == same
    assert hash(network) == hash(same)
    assert network != rounded, "a cache would give one the other's state space"


@pytest.mark.parametrize(
    ("num", "den", "part"),
    [
        ([1.0, 0.0], [1.0], "proper"),
        ([1.0], [1.0] * 10, "at most 8"),
        ([0.0], [1.0], "not zero"),
        ([1.0], [0.0], "not zero"),
    ],
)
def test_builder_refuses_what_cannot_run(num: list[float], den: list[float], part: str) -> None:
    with pytest.raises(ValueError, match=part):
        linear_network("custom", OMEGA_S, num, den)


@pytest.mark.parametrize("damping", [0.0, 0.3, 1.0 - 1e-12, 1.0, 1.0 + 1e-12, 50.0])
def test_pair_has_its_damping_and_frequency(damping: float) -> None:
    first, second = pair(damping, 2.0)
    assert complex(first * second) == pytest.approx(4.0, rel=1e-14)
    assert complex(first + second) == pytest.approx(-4.0 * damping, rel=1e-14)


@pytest.mark.parametrize(
    ("b", "c"), [(3.0, 2.0), (-3.0, 2.0), (1e6, 1.0), (0.0, 4.0), (2.0, 1.0), (2.0, 0.0)]
)
def test_quadratic_roots(b: float, c: float) -> None:
    first, second = quadratic_roots(b, c)
    assert complex(first + second) == pytest.approx(-b, rel=1e-14, abs=1e-14)
    assert complex(first * second) == pytest.approx(c, rel=1e-14, abs=1e-14)


@pytest.mark.parametrize(
    ("poles", "num"),
    [
        ([-1.0, -1.0, -1.0], [2.0, 1.0, 3.0, 4.0]),
        ([-0.5 + 2j, -0.5 - 2j, -0.5 + 2j, -0.5 - 2j], [1.0, 0.0, 2.0]),
        ([0.0, -1e-3, -1e3], [1.0, 2.0]),
        ([-2.0 + 1e-9j, -2.0 - 1e-9j], [1.0, 1.0, 1.0]),
        ([], [3.0]),
    ],
)
def test_state_space_has_the_transfer_asked_for(poles: list[complex], num: list[float]) -> None:
    system = state_space(np.array(num), np.array(poles))
    for p in (0.7j, 3j, 0.2 + 40j):
        direct = np.polyval(num, p) / np.prod([p - pole for pole in poles])
        matrix = p * np.eye(len(poles)) - system.A
        found = system.D + (system.C @ np.linalg.solve(matrix, system.B) if poles else 0.0)
        assert complex(found) == pytest.approx(complex(direct), rel=1e-11)
