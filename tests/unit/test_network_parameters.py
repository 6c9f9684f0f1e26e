"""The parameter blocks of the networks: defaults, ranges, refusals, round trips."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from navcore.foundation.errors import InputError
from navcore.networks import NETWORKS, parse_network
from navcore.networks.base import NetworkParameters
from navcore.networks.compass import CompassNetwork, gains_from_sigma_xi, sigma_xi_from_gains

pytestmark = pytest.mark.contract

PAPERS = "none classic2 classic3 compass complementary pole2 unity2 optimal custom".split()
"""The networks that come with the program, in the order in which the page offers them."""
OMEGA_S = float(np.sqrt(9.80665 / 6378137.0))


def faults_of(text: str) -> list[tuple[str, str]]:
    with pytest.raises(InputError) as caught:
        parse_network(text)
    return [(fault.field, str(fault)) for fault in caught.value.faults]


def test_out_of_range_names_field_value_and_whole_range() -> None:
    assert faults_of('id = "compass", sigma = -1.0, xi = 99') == [
        ("sigma", "network: sigma = -1.0: must be >= 1e-05 and <= 1 (1/s)"),
        ("xi", "network: xi = 99: must be >= 0.01 and <= 10"),
    ]


@pytest.mark.parametrize(
    ("text", "field", "part"),
    [
        ('id = "compas"', "id", "did you mean compass"),
        ("sigma = 1.0", "id", "is required: one of none, classic2"),
        ("", "id", "is required"),
        ("id = 3", "id", "must be one of none"),
        ('id = "complementary", zetta = 1.0', "zetta", "did you mean zeta? known: id, zeta, eta"),
        (
            'id = "complementary", zeta = "0.7"',
            "zeta",
            "must be a number (write 0.7 without quotation marks), > 0 and <= 10",
        ),
        ('id = "complementary", zeta = true', "zeta", "must be a number"),
        ('id = "complementary", zeta = nan', "zeta", "must be a finite number"),
        ('id = "pole2", variant = "both"', "variant", "'exact' or 'as_printed'"),
        ('id = "pole2", n1 = 10, n2 = 5', "n1", "are complex"),
        ('id = "pole2", n1 = 16, n2 = 7', "n1", "(n₁-n₂)² + 4 - 4(n₁+n₂) >= 0"),
        ('id = "pole2", n1 = 4.5, n2 = 0.5, variant = "as_printed"', "n1", "w₁ = w₂"),
        ('id = "compass", sigma = 0.01, k1 = 0.03', "k1", "together with sigma"),
        ('id = "compass", k1 = 0.03', "k1", "needs k2, k3 too"),
        ('id = "unity2", zeta2 = 0.7, alpha = 0.001', "alpha", "together with zeta2"),
        ('id = "unity2", r = 1.0', "r", "must be <= 0.99 or >= 1.01"),
        ('id = "custom", poles = [[-1, 2]]', "poles", "[-1, 2] must come with its conjugate [-1, -2]"),
        ('id = "custom", poles = [[-1, -2]]', "poles", "[-1, -2] must come with its conjugate [-1, 2]"),
        ('id = "custom", poles = [-1], zeros = [-1, -2]', "zeros", "H(infinity) would be infinite"),
        ('id = "custom", num = [1, 2, 3], den = [1, 2]', "num", "H(infinity) would be infinite"),
        ('id = "custom", poles = [-1, -2, -3, -4, -5, -6, -7, -8, -9]', "poles", "at most 8 poles, here 9"),
        ('id = "custom", num = [1], den = [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]', "den", "at most 8 poles, here 9"),
        ('id = "custom", num = [1.0]', "num", "needs den too"),
        ('id = "custom", num = [0.0], den = [1.0]', "num", "not 0"),
        ('id = "custom", num = [1.0], den = []', "den", "not 0"),
        ('id = "custom", num = [1.0], den = [1.0], gain = 2.0', "num", "together with gain"),
        ('id = "custom", gain = 0.0', "gain", "must not be 0"),
        ('id = "custom", poles = [1e9]', "poles.0.0", "must be >= -10000 and <= 10000 (rad/s)"),
        ('id = "custom", poles = [[1, 2, 3]]', "poles.0", "must be a list of 2 numbers"),
        ('id = "custom", poles = [[-1, "a"]]', "poles.0.1", "must be a number"),
        ('id = "custom", poles = "x"', "poles", "must be a list"),
        ("hello", "", "must be fields such as"),
        ('id = "none"} [x', "", "must be fields such as"),
    ],
)
def test_refusals(text: str, field: str, part: str) -> None:
    ((found, line),) = faults_of(text)
    assert found == field
    assert part in line
    assert "\n" not in line


def test_text_may_be_braced_and_span_lines() -> None:
    spread = '{\n id = "unity2",\n zeta = 0.4,\n}'
    assert parse_network(spread) == parse_network({"id": "unity2", "zeta": 0.4})


@pytest.mark.parametrize(
    ("text", "omega_s", "field"),
    [
        ('id = "compass", k1 = 0.01, k2 = -1.0, k3 = 0.0', OMEGA_S, "k2"),
        ('id = "custom", num = [1e30], den = [1e-30, 0, 0, 0, 1e30]', OMEGA_S, "overflows|at most"),
        ('id = "none"', 0.0, "omega_s"),
    ],
    ids=["dead gains", "coefficients far apart", "no Schuler frequency"],
)
def test_what_makes_no_network_is_refused_when_made(text: str, omega_s: float, field: str) -> None:
    with pytest.raises(InputError, match=field):
        parse_network(text).transfer(omega_s)


def test_damping_coefficients() -> None:
    assert [name for name in NETWORKS if name in PAPERS] == PAPERS
    values = {name: parse_network({"id": name}).damping_coefficient() for name in PAPERS}
    assert values == {
        "none": None,
        "classic2": None,
        "classic3": None,
        "compass": 0.7,
        "complementary": 0.5,
        "pole2": 0.5,
        "unity2": 0.5,
        "optimal": None,
        "custom": None,
    }
    with pytest.raises(NotImplementedError):
        NetworkParameters(id="x").transfer(OMEGA_S)


def test_compass_defaults_only_fill_what_belongs_together() -> None:
    by_gains = parse_network({"id": "compass", "k1": 0.0264, "k2": 202.52, "k3": 0.904534})
    assert isinstance(by_gains, CompassNetwork)
    assert (by_gains.sigma, by_gains.xi) == (None, None)
    assert by_gains.gains(OMEGA_S) == (0.0264, 202.52, 0.904534)
    assert by_gains.damping_coefficient() is None
    half = parse_network({"id": "compass", "sigma": 0.01, "k1": None})
    assert isinstance(half, CompassNetwork)
    assert (half.sigma, half.xi, half.k1) == (0.01, 0.7, None)


@given(sigma=st.floats(1e-5, 1.0), xi=st.floats(0.01, 10.0))
def test_gains_lead_back_to_sigma_and_xi(sigma: float, xi: float) -> None:
    found = sigma_xi_from_gains(*gains_from_sigma_xi(sigma, xi, OMEGA_S), OMEGA_S)
    assert found == pytest.approx((sigma, xi), rel=1e-9)


@given(
    sigma=st.floats(1e-3, 0.2),
    xi=st.floats(0.1, 2.0),
    which=st.integers(0, 2),
    factor=st.sampled_from([0.98, 1.02]),
)
def test_gains_off_by_two_percent_have_no_sigma_xi_or_another_one(
    sigma: float, xi: float, which: int, factor: float
) -> None:
    gains = list(gains_from_sigma_xi(sigma, xi, OMEGA_S))
    gains[which] *= factor
    found = sigma_xi_from_gains(gains[0], gains[1], gains[2], OMEGA_S)
    if found is not None:
        # K2 hardly matters when -2 sigma^3 and K3 balance: then the answer must reproduce what was given
        again = gains_from_sigma_xi(found[0], found[1], OMEGA_S)
        assert again[0] == pytest.approx(gains[0], rel=1e-12)
        assert again[2] == pytest.approx(gains[2], rel=1e-12)
        terms = max(gains[2], found[0] * (1.0 + gains[1]), 2.0 * found[0] ** 3 / OMEGA_S**2)
        assert abs(found[0] * (again[1] - gains[1])) <= 1e-3 * terms * 1.001


@pytest.mark.parametrize("gains", [(-0.01, 5.0, 1.0), (0.0, 5.0, 1.0), (0.01, 5.0, 0.0), (0.01, 5.0, -1.0)])
def test_gains_without_decay_or_integral_have_no_sigma_xi(gains: tuple[float, float, float]) -> None:
    assert sigma_xi_from_gains(*gains, OMEGA_S) is None


_root = st.floats(-0.05, 0.02).map(lambda v: [v, 0.0])
_pair = st.tuples(st.floats(-0.05, 0.02), st.floats(1e-4, 0.05)).map(lambda p: [[p[0], p[1]], [p[0], -p[1]]])
_roots = st.tuples(st.lists(_root, max_size=2), st.lists(_pair, max_size=1)).map(
    lambda t: t[0] + [root for pair in t[1] for root in pair]
)


@settings(max_examples=60, deadline=None)
@given(zeros=_roots, poles=_roots, gain=st.floats(0.1, 10.0))
def test_custom_from_roots_equals_custom_from_polynomials(
    zeros: list[list[float]], poles: list[list[float]], gain: float
) -> None:
    zeros = zeros if len(zeros) <= len(poles) else []
    from_roots = parse_network({"id": "custom", "zeros": zeros, "poles": poles, "gain": gain})
    network = from_roots.transfer(OMEGA_S)
    omega = OMEGA_S * np.logspace(-2, 2, 9)
    direct = gain * np.ones(9, dtype=complex)
    for root in zeros:
        direct = direct * (1j * omega - complex(*root))
    for root in poles:
        direct = direct / (1j * omega - complex(*root))
    np.testing.assert_allclose(network.response(omega), direct, rtol=1e-8)
    again = parse_network({"id": "custom", "num": network.num.tolist(), "den": network.den.tolist()})
    np.testing.assert_allclose(again.transfer(OMEGA_S).response(omega), direct, rtol=1e-8)


def test_custom_cancels_a_common_root_at_zero() -> None:
    network = parse_network('id = "custom", zeros = [0, -0.01], poles = [0, -0.02]').transfer(OMEGA_S)
    assert network.order == 1
    assert network.h0 == pytest.approx(0.5)


def test_custom_says_when_the_network_itself_is_unstable() -> None:
    unstable = parse_network('id = "custom", zeros = [-0.1], poles = [0.001]').transfer(OMEGA_S)
    assert unstable.warnings == ("the network itself is unstable",)
    integrating = parse_network('id = "custom", zeros = [-0.1], poles = [0]').transfer(OMEGA_S)
    assert "pole at zero" in integrating.warnings[0]
    assert integrating.h0 == np.inf


def test_unity2_warns_of_a_worse_damped_second_pair() -> None:
    assert parse_network('id = "unity2", alpha = 0.0005').transfer(OMEGA_S).warnings
    assert parse_network('id = "unity2", zeta2 = 0.3').transfer(OMEGA_S).warnings
    assert not parse_network('id = "unity2"').transfer(OMEGA_S).warnings
    assert not parse_network('id = "unity2", zeta = 1.4').transfer(OMEGA_S).warnings
