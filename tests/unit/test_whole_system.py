"""Both channels on the rotating Earth: modes, growth, and the effect of holding the difference to the log."""

import math

import numpy as np
import pytest

from navcore.analysis.held_log import held_log, period_map
from navcore.analysis.whole_matrix import feedback_gains, inputs_of_law, system_matrix
from navcore.analysis.whole_system import (
    CANCELLED_MODE,
    EARTH_MODE,
    SCHULER_MODE,
    _nearest,
    duration,
    growth_over_latitude,
    whole_system,
)
from navcore.damping import KINDS
from navcore.engine.simulation import simulate
from navcore.foundation.earth import EARTH_RATE, SEMI_MAJOR_AXIS, SPHERE, WGS84
from navcore.foundation.units import DEG
from navcore.mechanization.error_model import system_matrix as error_model_matrix
from navcore.networks import NETWORKS, parse_network
from navcore.networks.compass import CompassNetwork
from navcore.scenario.model import Scenario

pytestmark = pytest.mark.contract

OMEGA_S = SPHERE.schuler_frequency(0.0)
FEEDBACK = 'id = "optimal", rho = 1e-3, q = 1.0, realisation = "feedback"'


def network(text):
    return parse_network(text).transfer(OMEGA_S)


@pytest.mark.parametrize("lat_deg", [-60.0, 0.0, 32.06, 85.0])
def test_the_free_system_is_that_of_the_error_model(lat_deg):
    lat = lat_deg * DEG
    seven = error_model_matrix(lat, SEMI_MAJOR_AXIS, SPHERE.gravity(lat), EARTH_RATE)
    six = np.delete(np.delete(seven, 3, axis=0), 3, axis=1)
    unit = np.array([SPHERE.gravity(lat) / OMEGA_S] * 2 + [1.0] * 4)
    normalised = six * unit / unit[:, None] / OMEGA_S
    np.testing.assert_allclose(system_matrix(network('id = "none"'), lat), normalised, atol=1e-15)


@pytest.mark.parametrize("lat_deg", [-75.0, 32.06, 60.0])
def test_the_free_modes_have_the_known_frequencies(lat_deg):
    """+-j Omega and +-j(omega_s' -+ Omega sin L) (theory.md 2)."""
    whole = whole_system(network('id = "none"'), lat_deg * DEG)
    wz = abs(EARTH_RATE * math.sin(lat_deg * DEG))
    split = math.hypot(OMEGA_S, wz)
    found = [mode.eigenvalue.imag for mode in whole.modes]
    assert found == pytest.approx([EARTH_RATE, split - wz, split + wz], rel=1e-9)
    assert [mode.name for mode in whole.modes] == [EARTH_MODE, SCHULER_MODE, SCHULER_MODE]
    assert whole.stable
    assert whole.warnings == ()


@pytest.mark.parametrize("name", NETWORKS)
@pytest.mark.parametrize("damping", ["external", "internal"])
def test_every_network_has_its_modes_named(name, damping):
    whole = whole_system(KINDS[damping].acting(network(f'id = "{name}"')), 45.0 * DEG)
    assert whole.modes[0].name == EARTH_MODE
    # one pair, or two real eigenvalues
    assert len(whole.named(EARTH_MODE)) in (1, 2)
    assert len(whole.named(SCHULER_MODE)) == 2
    growing = [mode for mode in whole.modes if mode.growth > 1e-9]
    assert whole.stable == (not growing)
    assert len(whole.warnings) == len(growing)


def test_internal_and_external_damping_have_the_same_eigenvalues():
    h = network('id = "classic3"')
    external, internal = (whole_system(KINDS[d].acting(h), 0.7, WGS84) for d in ("external", "internal"))
    assert external.modes == internal.modes


def test_feedback_counts_under_external_damping_only():
    h = network('id = "compass", sigma = 0.0015')
    assert whole_system(h, 0.7).earth_growth == 0.0
    assert whole_system(KINDS["internal"].acting(h), 0.7).earth_growth > 0.0
    assert (
        whole_system(KINDS["averaging"].acting(h), 0.7).modes
        == whole_system(network('id = "none"'), 0.7).modes
    )


def test_the_gains_are_read_back_from_the_network():
    parameters = CompassNetwork(sigma=0.003, xi=0.6)
    k1, k2, k3 = parameters.gains(OMEGA_S)
    found = feedback_gains(parameters.transfer(OMEGA_S))
    assert found == pytest.approx((k1 / OMEGA_S, k2, k3 / OMEGA_S), rel=1e-12)
    alone = parse_network('id = "compass", k1 = 0.0, k2 = 0.5, k3 = 0.0').transfer(OMEGA_S)
    assert feedback_gains(alone) == pytest.approx((0.0, 0.5, 0.0))
    assert feedback_gains(parse_network('id = "compass", k1 = 0.1, k2 = -1.0, k3 = 1.0').transfer(OMEGA_S))[
        1
    ] == pytest.approx(-1.0)


@pytest.mark.parametrize("pole", [0.5, -0.3])
def test_a_pole_on_a_zero_is_named_as_cancelled(pole):
    plain = network('id = "custom", zeros = [-0.0008], poles = [-0.02]')
    at = pole * OMEGA_S
    hidden = network(f'id = "custom", zeros = [{at!r}, -0.0008], poles = [{at!r}, -0.02]')
    without, found = whole_system(plain, 0.7), whole_system(hidden, 0.7)
    assert [mode.eigenvalue.real for mode in found.named(CANCELLED_MODE)] == pytest.approx([at, at], rel=1e-6)
    rest = [mode for mode in found.modes if mode.name != CANCELLED_MODE]
    assert [mode.name for mode in rest] == [mode.name for mode in without.modes]
    told = [text for text in found.warnings if "cancelled network mode grows" in text]
    assert bool(told) == (pole > 0.0) and not any("Foucault" in text for text in found.warnings)
    assert without.named(CANCELLED_MODE) == ()


def test_north_and_south_are_the_same():
    h = network('id = "classic2"')
    lats = np.array([-75.0, -45.0, 0.0, 45.0, 75.0]) * DEG
    rates = growth_over_latitude(h, lats)
    np.testing.assert_allclose(rates, rates[::-1], rtol=1e-9)
    assert np.all(np.diff(rates[2:]) > 0.0)


@pytest.mark.parametrize("name", NETWORKS)
def test_the_slope_is_the_derivative_of_h(name):
    h = network(f'id = "{name}"')
    s = 1e-4 * OMEGA_S
    difference = (
        np.polyval(h.num, s) / np.polyval(h.den, s) - np.polyval(h.num, -s) / np.polyval(h.den, -s)
    ) / (2.0 * s)
    assert h.h_slope == pytest.approx(difference, rel=1e-5, abs=1e-6)


def test_a_pole_at_zero_has_no_slope():
    h = network('id = "custom", zeros = [-1], poles = [0]')
    assert math.isnan(whole_system(h, 0.7).h_slope)


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(3.09 * 86400, "3.1 days"), (-40 * 86400, "40 days"), (9000, "2.5 h"), (3180, "53 min"), (12, "12 s")],
)
def test_a_duration_is_written_in_its_unit(seconds, text):
    assert duration(seconds) == text


def test_stiffness_falls_with_height_by_gravity_and_radius() -> None:
    """c_N turns the platform by c_N/(M + h), c_E by c_E/(N + h), in units where omega_s is 1."""
    lat, height = 0.8, 10_000.0
    b = inputs_of_law(lat, OMEGA_S, WGS84, height)
    m, n = WGS84.radii(lat)
    g = WGS84.gravity(lat, height)
    assert b[4, 0] == pytest.approx(g / (n + height) / OMEGA_S**2, rel=1e-12)
    assert b[3, 1] == pytest.approx(-g / (m + height) / OMEGA_S**2, rel=1e-12)


def test_only_the_24_h_mode_is_explained_by_the_slope() -> None:
    grows = whole_system(network('id = "classic2"'), 0.8)
    assert "H'(0) = +" in grows.warnings[0]
    unstable = whole_system(network('id = "pole2", xi = 0.05, variant = "as_printed"'), 0.8)
    others = [text for text in unstable.warnings if "24 h mode" not in text]
    assert others and all("H'(0)" not in text for text in others)


def test_values_join_the_targets_that_are_closest_for_their_size() -> None:
    """Of 1 % off at 100 and 10 % off at 1 the first is closer, though ten times further in value."""
    assert _nearest(np.array([1.0 + 0j, 100.0]), np.array([90.0 + 0j, 1.2, 99.2])) == [1, 2]
    assert _nearest(np.array([1.0 + 0j, 1.1]), np.array([1.08 + 0j, 20.0])) == [1, 0]
    # apart by 30 of 130 and by 2 of 4: the large value has the target, though the small one is nearer to it
    assert _nearest(np.array([1.0 + 0j, 50.0]), np.array([20.0 + 0j, 1000.0])) == [1, 0]


def test_the_main_mode_is_the_pair_that_swings_beside_a_slow_real_pole() -> None:
    """Of the optimal network's poles, -0.93 +- 1.06j swing; -0.10 only fades."""
    whole = whole_system(network('id = "optimal", q = 0.0'), 45.0 * DEG)
    found = [mode.eigenvalue / OMEGA_S for mode in whole.modes if mode.name == SCHULER_MODE]
    assert len(found) == 2
    assert np.array(found) == pytest.approx([-0.926 + 1.062j] * 2, abs=0.12)


def test_heights_count_from_the_ellipsoid() -> None:
    assert np.array_equal(inputs_of_law(0.6, OMEGA_S), inputs_of_law(0.6, OMEGA_S, SPHERE, 0.0))
    assert not np.array_equal(inputs_of_law(0.6, OMEGA_S), inputs_of_law(0.6, OMEGA_S, SPHERE, 0.1))


# ---------------------------------------------------------------- as sampled


@pytest.mark.parametrize("text", ['id = "classic2"', 'id = "complementary"', 'id = "compass"', FEEDBACK])
@pytest.mark.parametrize("calls", [1, 4])
def test_a_fast_law_has_the_eigenvalues_of_continuous_time(text, calls):
    h, lat, step = network(text), 0.8, 0.01
    factors = np.linalg.eigvals(period_map(h, step, calls, lat))
    rates = np.log(factors[np.abs(factors) > 1e-6].astype(complex)) / (calls * step)
    for mode in whole_system(h, lat).modes:
        # rounding moves an eigenvalue near 1 by 1e-16 / step
        assert np.min(np.abs(rates - mode.eigenvalue)) < 2e-3 * abs(mode.eigenvalue) + 2e-8


def test_the_limits_of_physics_10():
    compass = network('id = "compass", sigma = 0.0088, xi = 0.7')
    assert held_log(compass, 1.0, 1.0, 0.8).stable
    slow = held_log(compass, 100.0, 1.0, 0.8)
    assert not slow.stable
    assert slow.stable_up_to_s is not None and 60.0 < slow.stable_up_to_s < 100.0
    assert "the log's difference is held for 100 s" in slow.warnings[0]
    fast = held_log(network('id = "compass", sigma = 1.0'), 1.0, 1.0, 0.8)
    assert not fast.stable
    assert "the law runs every 1 s" in fast.warnings[0]
    assert fast.stable_up_to_s == pytest.approx(2.0 / 3.0, rel=1e-3)  # K1 T = 3 sigma T < 2


@pytest.mark.parametrize("text", ['id = "compass", sigma = 0.0088', 'id = "compass", sigma = 0.05'])
def test_the_limit_found_divides_stable_from_unstable(text):
    h = network(text)
    limit = held_log(h, 200.0, 1.0, 0.8).stable_up_to_s
    assert limit is not None
    assert held_log(h, limit, 1.0, 0.8).stable
    assert not held_log(h, limit + 1.0, 1.0, 0.8).stable


@pytest.mark.parametrize(
    ("text", "stable"),
    [('id = "classic2"', True), ('id = "pole2", variant = "as_printed", xi = 0.05', False)],
)
def test_what_continuous_time_does_is_not_blamed_on_the_hold(text, stable):
    """The 24 h mode of classic2 grows, the loop of the printed pole2 is unstable."""
    found = held_log(network(text), 1.0, 1.0, 0.8)
    assert (found.stable, found.warnings) == (stable, ())


def test_internal_damping_has_no_log():
    h = network('id = "compass"')
    assert held_log(KINDS["internal"].acting(h), 1.0, 1.0, 0.8).stable
    slow_log = {"kind": "log", "rate_hz": 0.01}
    for damping, warned in (("internal", False), ("external", True)):
        method = {"damping": damping, "network": {"id": "compass"}}
        run = simulate(Scenario.parse({"reference": slow_log, "method": [method]}))
        assert any("unstable as sampled" in text for text in run.methods[0].warnings) is warned


def diverging(network_text: str, log_hz: float, duration_h: float) -> dict:
    return {
        "run": {"duration_h": duration_h, "output_step_s": 1.0},
        "site": {"lat_deg": 45.0},
        "reference": {"kind": "log", "rate_hz": log_hz},
        "initial_error": {"attitude_arcmin": [0.01, 0.0, 0.0]},
        "method": [
            {"damping": "external", "network": parse_network(network_text).model_dump(exclude_none=True)}
        ],
    }


def test_a_run_grows_at_the_rate_of_the_map():
    given = diverging('id = "compass", sigma = 0.0088', 0.01, 0.5)
    [method] = simulate(Scenario.parse(given)).methods
    h = parse_network('id = "compass", sigma = 0.0088').transfer(WGS84.schuler_frequency(45.0 * DEG))
    expected = held_log(h, 100.0, 1.0, 45.0 * DEG, WGS84)
    assert any("unstable as sampled" in text for text in method.warnings)
    size = np.hypot(method.rows[::100, 0], method.rows[::100, 1])  # tilt at the log's epochs
    growth = math.log(size[17] / size[9]) / 800.0
    assert growth == pytest.approx(expected.growth, rel=0.05)


def test_a_law_too_slow_for_its_gains_is_reported_before_it_diverges():
    given = diverging('id = "compass", sigma = 1.0', 1.0, 1.0)
    [method] = simulate(Scenario.parse(given)).methods
    assert method.status == "diverged"
    assert any("the law runs every 1 s" in text for text in method.warnings)


def test_the_warning_tells_the_e_folding_time() -> None:
    found = held_log(network('id = "compass", sigma = 0.0088, xi = 0.7'), 100.0, 1.0, 0.8)
    radius = np.abs(np.linalg.eigvals(period_map(network('id = "compass"'), 1.0, 100, 0.8))).max()
    assert f"grow by e every {duration(100.0 / math.log(radius))}" in found.warnings[0]
