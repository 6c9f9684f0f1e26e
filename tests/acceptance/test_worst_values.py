"""The worst that a log can do, against design tables that were computed apart from this program."""

import numpy as np
import pytest

from navcore import parse_network
from navcore.analysis import analyse
from navcore.analysis.judged import JudgedLoop, loop_value
from navcore.analysis.transfers import time_response
from navcore.analysis.worst_step import worst_step
from navcore.design.worst.bounded import worst
from navcore.design.worst.rate import worst_within_rate
from navcore.foundation.earth import SPHERE
from navcore.foundation.units import ARCMIN, ARCSEC
from navcore.scenario.model import Scenario

OMEGA_S = SPHERE.schuler_frequency(0.0)
CHANNEL = {
    'id = "classic2"': (68.6, 1.394),
    'id = "classic3"': (66.6, 1.539),
    'id = "complementary", zeta = 0.5, eta = 0.5': (35.0, 1.514),
    'id = "unity2", zeta = 0.5': (62.4, 1.399),
}
"""Worst tilt (arcsec) and velocity error (m/s) of one channel for a log within 1 m/s."""
STEPS = dict(zip(CHANNEL, ((23.10, 0.668), (17.01, 0.616), (7.32, 0.458), (19.10, 0.585)), strict=True))
"""Largest tilt (arcsec) and velocity error (m/s) after a step of the log by 1 m/s, of the same table."""
UNITY2 = {"id": "unity2", "zeta": 0.5}
COMPLEMENTARY = {"id": "complementary", "zeta": 0.5, "eta": 0.5}
WHOLE = {
    "classic2": ({"network": {"id": "classic2"}}, (73.7, 74.2, 6.25, 1.896, 2.041, 8531, 6266)),
    "complementary": ({"network": COMPLEMENTARY}, (42.9, 43.1, 4.44, 2.030, 2.108, 6296, 4947)),
    "unity2": ({"network": UNITY2}, (68.0, 68.4, 4.63, 1.812, 1.916, 6361, 4753)),
    "compass": (
        {"network": {"id": "compass", "sigma": 0.0015, "xi": 0.7}},
        (75.9, 71.6, 147.3, 1.546, 1.592, 85027, 87123),
    ),
    "azimuth": (
        {"network": COMPLEMENTARY, "azimuth": UNITY2},
        (53.7, 45.3, 25.6, 2.580, 4.050, 23062, 32294),
    ),
}
"""Tilt E, N (arcsec), heading (arcmin), velocity E, N (m/s), latitude, longitude (m) after 24 h."""


@pytest.mark.known(
    "oracle",
    ["worst_tilt", "worst_velocity"],
    kinds=["external"],
    fidelities=["loop"],
    source="table that was computed apart from this program",
)
@pytest.mark.parametrize("network", CHANNEL)
def test_one_channel_within_half_a_percent(network: str) -> None:
    found = worst_step(parse_network(network).transfer(OMEGA_S))
    tilt, velocity = CHANNEL[network]
    assert found.tilt_rad is not None and found.velocity_mps is not None
    assert found.tilt_rad / ARCSEC == pytest.approx(tilt, rel=5e-3)
    assert found.velocity_mps == pytest.approx(velocity, rel=5e-3)


@pytest.mark.known(
    "oracle",
    ["log_tilt", "overshoot"],
    kinds=["external"],
    fidelities=["loop"],
    source="table that was computed apart from this program",
)
@pytest.mark.parametrize("network", STEPS)
def test_a_step_of_the_log_within_half_a_percent(network: str) -> None:
    transfer = parse_network(network).transfer(OMEGA_S)
    judged = JudgedLoop(transfer, analyse(transfer), True)
    tilt, velocity = STEPS[network]
    assert loop_value("log_tilt", judged) / ARCSEC == pytest.approx(tilt, rel=5e-3)
    assert loop_value("overshoot", judged) == pytest.approx(velocity, rel=5e-3)


@pytest.mark.parametrize(
    ("network", "tilts"),
    [
        ('id = "complementary", zeta = 0.5, eta = 0.5', (34.7, 27.8, 9.51)),
        ('id = "unity2", zeta = 0.5', (61.6, 28.9, 8.83)),
    ],
)
def test_one_channel_whose_log_has_a_rate_within_half_a_percent(
    network: str, tilts: tuple[float, ...]
) -> None:
    time_s = np.arange(0.0, 24.0 * 3600.0 + 1.0, 5.0)
    response = time_response(parse_network(network).transfer(OMEGA_S), "dv_r", "phi", time_s)
    weights = np.diff(response)[::-1] / ARCSEC
    for rate, tilt in zip((0.01, 0.001, 0.0003), tilts, strict=True):
        error = np.interp(time_s[:-1], *worst_within_rate(weights, time_s[:-1], rate))
        assert float(weights @ error) == pytest.approx(tilt, rel=5e-3)


def test_whole_system_within_one_percent() -> None:
    scenario = Scenario.parse(
        {
            "schema": 1,
            "run": {"fidelity": "error_model", "duration_h": 24.0, "earth": "sphere"},
            "site": {"lat_deg": 45.0},
            "reference": {"kind": "log"},
            "method": [{"name": name, "damping": "external", **own} for name, (own, _) in WHOLE.items()],
        }
    )
    units = np.array([ARCSEC, ARCSEC, ARCMIN, 1.0, 1.0, 1.0, 1.0])
    for found in worst(scenario, 1.0).methods:
        assert found.bound == "exact"
        np.testing.assert_allclose(found.largest / units, WHOLE[found.name][1], rtol=1e-2)
