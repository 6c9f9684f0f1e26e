"""Margins by roots, and the gain of the running filter, against python-control and the exact response."""

import math

import numpy as np
import pytest
from control import TransferFunction, stability_margins

from navcore.analysis import Margins, disk_margin, margins
from navcore.analysis.measured import measured_response
from navcore.networks import NETWORKS, parse_network
from navcore.networks.base import LinearNetwork
from navcore.networks.discrete import DiscreteNetwork, discretise

OMEGA_S = float(np.sqrt(9.80665 / 6378137.0))
DAMPED = [{"id": name} for name in NETWORKS if name not in ("none", "custom")]
RESONANT = {"id": "compass", "sigma": 1e-4, "xi": 0.05}
CLASSIC = parse_network({"id": "classic2"}).transfer(OMEGA_S)
LIFTED = {
    "id": "custom",
    "num": np.polymul(CLASSIC.num, [1.0, 1.8 * OMEGA_S, 9.0 * OMEGA_S**2]).tolist(),
    "den": np.polymul(CLASSIC.den, [1.0, 0.6 * OMEGA_S, 9.0 * OMEGA_S**2]).tolist(),
}
"""Its resonance at three times the Schuler frequency lifts |L| through 1 again: three crossovers."""


def control_margins(network: LinearNetwork) -> Margins:
    """The same from python-control; of several crossovers the least phase and the least delay."""
    own = network.to_control(normalised=True)
    open_loop = own * TransferFunction([1.0], [1.0, 0.0, 0.0])
    gains, phases, _, _, crossings, _ = stability_margins(open_loop, returnall=True)
    gains = np.asarray(gains)[np.isfinite(gains)]
    up, down = gains[gains > 1.0], gains[(gains > 0.0) & (gains < 1.0)]
    least = int(np.argmin(np.abs(phases)))
    lag = np.mod(np.deg2rad(phases), 2.0 * math.pi)
    return Margins(
        gain_up=float(np.min(up)) if len(up) else None,
        gain_down=float(np.max(down)) if len(down) else None,
        phase_rad=float(np.deg2rad(phases[least])),
        crossover_rad_s=float(crossings[least]) * network.omega_s,
        delay_s=float(np.min(lag / crossings)) / network.omega_s,
    )


@pytest.mark.parametrize("block", [*DAMPED, RESONANT, LIFTED], ids=lambda b: b["id"])
def test_margins_are_those_of_python_control(block: dict) -> None:
    network = parse_network(block).transfer(OMEGA_S)
    mine, theirs = margins(network), control_margins(network)
    assert mine is not None
    for name in ("gain_up", "gain_down", "phase_rad", "crossover_rad_s", "delay_s"):
        ours, reference = getattr(mine, name), getattr(theirs, name)
        assert (ours is None) == (reference is None), name
        if ours is not None:
            assert ours == pytest.approx(reference, rel=1e-5), name


@pytest.mark.parametrize("block", [*DAMPED, RESONANT], ids=lambda b: b["id"])
def test_the_disk_margin_is_one_over_the_largest_difference_of_the_sensitivities(block: dict) -> None:
    network = parse_network(block).transfer(OMEGA_S)
    found, classical = disk_margin(network), margins(network)
    assert found is not None and classical is not None and classical.phase_rad is not None
    omega = np.logspace(-3, 4, 400_001) * OMEGA_S
    loop = -network.response(omega) * (OMEGA_S / omega) ** 2
    alpha = float(np.min(2.0 / np.abs((1.0 - loop) / (1.0 + loop))))
    assert found.size == pytest.approx(alpha, rel=1e-4)
    assert found.gain == pytest.approx((2.0 + alpha) / (2.0 - alpha), rel=1e-3)
    assert found.phase_rad == pytest.approx(2.0 * math.atan(0.5 * alpha), rel=1e-3)
    assert found.phase_rad <= classical.phase_rad * (1.0 + 1e-4)
    assert classical.gain_up is None or found.gain <= classical.gain_up
    assert classical.gain_down is None or 1.0 / found.gain >= classical.gain_down


def test_margins_of_a_loop_worked_out_by_hand() -> None:
    """H = 1 + 2 z p: L = -(1 + 2 z j x)/x^2 up to a far pole; |L| = 1 at x^4 = 1 + 4 z^2 x^2."""
    z, far = 0.5, 1e5
    block = {"id": "custom", "zeros": [-OMEGA_S / (2 * z)], "poles": [-far * OMEGA_S], "gain": 2 * z * far}
    found = margins(parse_network(block).transfer(OMEGA_S))
    assert found is not None and found.phase_rad is not None and found.crossover_rad_s is not None
    x = math.sqrt(2 * z * z + math.sqrt(4 * z**4 + 1))
    assert found.crossover_rad_s / OMEGA_S == pytest.approx(x, rel=1e-4)
    assert found.phase_rad == pytest.approx(math.atan(2 * z * x), rel=1e-3)


def test_undamped_and_unstable_loops_have_none() -> None:
    assert margins(parse_network('id = "none"').transfer(OMEGA_S)) is None
    assert disk_margin(parse_network('id = "none"').transfer(OMEGA_S)) is None
    unstable = parse_network('id = "pole2", xi = 0.08, variant = "as_printed"').transfer(OMEGA_S)
    assert margins(unstable) is None


@pytest.mark.parametrize("id", ["classic2", "classic3", "complementary", "unity2", "pole2"])
@pytest.mark.parametrize("step_s", [1.0, 10.0])
def test_driven_filter_has_the_gain_of_its_coefficients(id: str, step_s: float) -> None:
    discrete = discretise(parse_network({"id": id}).transfer(OMEGA_S), step_s)
    omega = np.geomspace(2e-4, 0.1, 7)
    gain = measured_response(discrete, omega)
    assert gain is not None
    np.testing.assert_allclose(gain, discrete.response(omega), rtol=2e-5)


def test_driving_is_the_plain_recursion() -> None:
    """The same sine through x += dA x + B u, one step at a time."""
    discrete = discretise(parse_network({"id": "unity2"}).transfer(OMEGA_S), 20.0)
    omega = 3e-3
    x, rows, n = np.zeros(discrete.order), [], 4000
    for k in range(n):
        u = math.sin(omega * k * 20.0)
        rows.append(float(discrete.C @ x + discrete.D * u))
        x = x + discrete.dA @ x + discrete.B * u
    t = np.arange(n // 2, n) * 20.0
    table = np.stack([np.sin(omega * t), np.cos(omega * t)], axis=1)
    a, b = np.linalg.lstsq(table, np.array(rows[n // 2 :]), rcond=None)[0]
    gain = measured_response(discrete, np.array([omega]))
    assert gain is not None
    assert complex(gain[0]) == pytest.approx(complex(a, b), rel=1e-6)


def test_a_wrong_coefficient_is_seen() -> None:
    good = discretise(parse_network({"id": "classic2"}).transfer(OMEGA_S), 1.0)
    wrong = DiscreteNetwork(good.dA, 1.01 * good.B, good.C, good.D, 1.0)
    omega = np.array([1e-3])
    found, measured = measured_response(good, omega), measured_response(wrong, omega)
    assert found is not None and measured is not None
    assert abs(measured[0] / found[0] - 1.0) > 1e-3


def test_a_filter_that_never_rests_is_not_measured() -> None:
    integrator = DiscreteNetwork(np.zeros((1, 1)), np.ones(1), np.ones(1), 1.0, 1.0)
    assert measured_response(integrator, np.array([0.01])) is None
