"""Liu 2021, figures 3 and 5: gain from the log's error to the tilt, R phi / dV_r, of three networks."""

import numpy as np
import pytest

from navcore.analysis import RADIUS, frequency_response
from navcore.engine.simulation import simulate
from navcore.networks import LinearNetwork
from navcore.networks.complementary import ComplementaryNetwork
from navcore.scenario.file import load


def gain(network: LinearNetwork, omega: np.ndarray) -> np.ndarray:
    return np.abs(RADIUS * frequency_response(network, "dv_r", "phi", omega))


@pytest.fixture(scope="module")
def scenario():
    return load("liu-networks")


@pytest.fixture(scope="module")
def networks(scenario) -> dict[str, LinearNetwork]:
    return {m.name: m.network.transfer(scenario.omega_s) for m in scenario.method}


def decibels_a_decade(network: LinearNetwork, omega: float) -> float:
    low, high = gain(network, np.array([omega, 10.0 * omega]))
    return float(20.0 * np.log10(high / low))


def test_the_preset_opens_with_the_bode_plot_of_the_three(scenario, networks):
    assert scenario.view.focus == "bode"
    assert list(networks) == ["classic2", "classic3", "complementary"]


def test_figure_3_complementary_is_lowest_above_the_schuler_frequency(scenario, networks):
    omega = scenario.omega_s * np.logspace(np.log10(2.0), 3.0, 200)
    complementary = gain(networks["complementary"], omega)
    for name in ("classic2", "classic3"):
        assert np.all(complementary < gain(networks[name], omega))


def test_figure_3_slopes(scenario, networks):
    omega_s = scenario.omega_s
    assert decibels_a_decade(networks["complementary"], 30.0 * omega_s) == pytest.approx(-80.0, abs=0.5)
    for name in ("classic2", "classic3"):
        assert decibels_a_decade(networks[name], 1000.0 * omega_s) == pytest.approx(-40.0, abs=0.5)
    # "40 dB/10 dec or higher" on the low side as well
    assert decibels_a_decade(networks["complementary"], 1e-3 * omega_s) == pytest.approx(40.0, abs=0.5)


def test_figure_5_the_damping_coefficient_changes_no_slope(scenario):
    omega = np.logspace(-6.0, 0.0, 601)
    peaks, corners = [], []
    for zeta in (0.1, 0.3, 0.5, 0.7, 0.9):
        network = ComplementaryNetwork(zeta=zeta, eta=0.5).transfer(scenario.omega_s)
        curve = gain(network, omega)
        peaks.append(float(np.max(curve)))
        corners.append(float(omega[np.argmax(curve)]))
        assert decibels_a_decade(network, 30.0 * scenario.omega_s) == pytest.approx(-80.0, abs=0.5)
    # "not much different": within a factor of 1.6 for a ninefold zeta, and always near the Schuler frequency
    assert max(peaks) / min(peaks) < 1.6
    np.testing.assert_allclose(corners, scenario.omega_s, rtol=0.15)


def test_the_run_shows_the_order_of_the_gains(scenario):
    tilt = {m.method.name: m.errors["phi_n_rad"]["rms"] for m in simulate(scenario).methods}
    assert tilt["complementary"] < tilt["classic3"] < tilt["classic2"]
