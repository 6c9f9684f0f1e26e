"""theory.md 3.4: exact damping and H(0) = 1 at once."""

import numpy as np
import pytest

from navcore.analysis import analyse, network_table
from navcore.analysis.placement import place
from navcore.analysis.whole_system import whole_system
from navcore.foundation.earth import SPHERE
from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG
from navcore.networks import parse_network
from navcore.networks.retuning import unity2_difference
from navcore.networks.tuning_codes import UNITY2

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


# ---------------------------------------------------------------- r < 1 (theory.md 10)

BELOW = {"id": "unity2", "zeta": 0.5, "r": 0.8, "alpha": 0.36 * 0.7 / 0.8 * OMEGA_S}
"""zeta 0.5, r 0.8, beta = 0.3 omega_s^2."""


def test_below_omega_s_the_24_h_mode_decays() -> None:
    """theory.md 10: zeta2 = 0.29, H'(0) = -2829 s, the mode decays in 0.99 d at 45 N."""
    network = parse_network(BELOW).transfer(OMEGA_S)
    loop = analyse(network)
    assert network.h0 == 1.0
    assert network.h_slope == pytest.approx(-2829.0, rel=1e-3)
    assert loop.damping_ratio == pytest.approx(0.29, abs=0.005)
    assert any("worse damped (0.288)" in text for text in network.warnings)
    whole = whole_system(network, 45.0 * DEG)
    assert whole.e_folding_s / 86400.0 == pytest.approx(-0.99, abs=0.01)


@pytest.mark.known(
    "oracle",
    ["h0", "h0_deviation", "h_slope_s"],
    kinds=["external"],
    fidelities=["loop"],
    source="closed form (theory.md 3)",
)
@pytest.mark.parametrize("r", [0.2, 0.5, 0.8, 0.99])
@pytest.mark.parametrize("zeta2", [0.2, 0.7, 1.5])
def test_below_omega_s_h0_is_one_and_the_slope_negative(r: float, zeta2: float) -> None:
    network = parse_network({"id": "unity2", "zeta": 0.5, "r": r, "zeta2": zeta2}).transfer(OMEGA_S)
    closed = np.polyadd(np.polymul([1.0, 0.0, 0.0], network.den_p), network.num_p)
    delta = np.poly(np.asarray(network.closed_loop_p))
    np.testing.assert_allclose(closed, np.real(delta), rtol=1e-9, atol=1e-12)
    assert network.h0 == 1.0
    assert network.h_slope < 0.0


def test_no_second_pair_is_refused() -> None:
    with pytest.raises(InputError, match="must be <= 0.99 or >= 1.01"):
        parse_network('id = "unity2", r = 1.0')
    with pytest.raises(InputError, match=r"alpha = 0.01: must be < 0.000\d+ \(rad/s\)"):
        parse_network('id = "unity2", r = 0.8, alpha = 0.01').transfer(OMEGA_S)


@pytest.mark.parametrize("more", [{"zeta2": 0.4}, {}, {"alpha": 0.36 * 0.7 / 0.8 * OMEGA_S}])
def test_the_running_law_re_tunes_it_below_omega_s_too(more: dict[str, float]) -> None:
    parameters = parse_network({"id": "unity2", "zeta": 0.5, "r": 0.8, **more})
    network = parameters.transfer(OMEGA_S)
    code, r, zeta2, alpha = parameters.tuning(OMEGA_S) or []
    assert (code, r) == (UNITY2, 0.8)
    a1, a2, b1, b2 = unity2_difference(0.5, r, zeta2, alpha)
    np.testing.assert_allclose([1.0, a1, a2], network.den_p, rtol=1e-9)
    np.testing.assert_allclose([b1, b2], (network.den_p - network.num_p)[1:], rtol=1e-9, atol=1e-12)
    assert unity2_difference(0.99, r, zeta2, alpha)[1] > 0.0


def test_a_pair_can_be_asked_not_to_let_the_24_h_mode_grow() -> None:
    parameters = parse_network('id = "unity2", zeta2 = 0.3')
    below = place(parameters, 0.5, 0.8 * OMEGA_S, OMEGA_S, h_slope_limit_s=0.0)
    assert below.parameters.transfer(OMEGA_S).h_slope < 0.0
    with pytest.raises(InputError, match=r"H'\(0\) = [\d.]+: must be <= 0 .* the 24 h mode grows"):
        place(parameters, 0.5, 1.2 * OMEGA_S, OMEGA_S, h_slope_limit_s=0.0)
    with pytest.raises(InputError, match=r"H\(0\) = [\d.]+: must be 1"):
        place(parse_network('id = "compass"'), 0.5, 1.2 * OMEGA_S, OMEGA_S, h_slope_limit_s=0.0)
    complementary = place(parse_network('id = "complementary"'), 0.7, OMEGA_S, OMEGA_S, h_slope_limit_s=0.0)
    slope = complementary.parameters.transfer(OMEGA_S).h_slope
    place(parse_network('id = "complementary"'), 0.7, OMEGA_S, OMEGA_S, h_slope_limit_s=slope)
    with pytest.raises(InputError, match=r"H'\(0\)"):
        place(parse_network('id = "complementary"'), 0.7, OMEGA_S, OMEGA_S, h_slope_limit_s=slope - 1.0)
    assert complementary.parameters.damping_coefficient() == 0.7


def test_the_page_of_networks_says_what_the_analysis_says() -> None:
    assert network_table.PAGE.read_text("utf-8") == network_table.page(), "make guide"
