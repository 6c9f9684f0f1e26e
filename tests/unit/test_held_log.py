"""The sampled law: what holding the log's difference does to the loop."""

import math

import numpy as np
import pytest

from navcore.analysis.held_log import held_log, period_map
from navcore.analysis.whole_system import duration, whole_system
from navcore.damping import KINDS
from navcore.engine.simulation import simulate
from navcore.foundation.earth import SPHERE, WGS84
from navcore.foundation.units import DEG
from navcore.networks import parse_network
from navcore.scenario.model import Scenario

OMEGA_S = SPHERE.schuler_frequency(0.0)


def network(text):
    return parse_network(text).transfer(OMEGA_S)


@pytest.mark.parametrize("text", ['id = "classic2"', 'id = "complementary"', 'id = "compass"'])
@pytest.mark.parametrize("calls", [1, 4])
def test_a_fast_law_has_the_eigenvalues_of_continuous_time(text, calls):
    h, lat, step = network(text), 0.8, 0.02
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
