"""Reference values of the design mathematics: steady budget by source, floor (theory.md 20)."""

import pytest

from navcore.design.budget import Budget, budget
from navcore.foundation.units import ARCSEC
from navcore.scenario.model import Scenario

SET_A = {
    "run": {"earth": "sphere"},
    "imu": {
        "gyro_arw_dpsh": 0.003,
        "gyro_instability_dph": 0.003,
        "gyro_tau_s": 3600.0,
        "accel_vrw_ugpshz": 10.0,
        "accel_instability_ug": 10.0,
        "accel_tau_s": 3600.0,
    },
    "reference": {
        "kind": "log",
        "noise_mps": 0.2,
        "rate_hz": 1.0,
        "drift_mps": 0.1,
        "drift_tau_s": 600.0,
    },
}
SOURCES = ("gyro_white", "gyro_drift", "accel_white", "accel_drift", "log_white", "log_drift")
TABLE = [
    ({"id": "classic2"}, (3.968, 0.9571, 0.0866, 2.245, 0.3437, 2.627), 5.360, 0.1732),
    ({"id": "classic3"}, (4.897, 1.169, 0.0975, 2.369, 0.2475, 2.392), 6.062, 0.1946),
    (
        {"id": "complementary", "zeta": 0.5, "eta": 0.5},
        (7.668, 2.507, 0.1043, 2.804, 0.0795, 1.123),
        8.615,
        0.3675,
    ),
    (
        {"id": "unity2", "zeta": 0.5, "r": 1.2, "zeta2": 0.7},
        (4.488, 1.131, 0.0884, 2.309, 0.2711, 2.310),
        5.672,
        0.1905,
    ),
    (
        {"id": "compass", "sigma": 0.0088, "xi": 0.7},
        (1.543, 0.0703, 0.2042, 2.101, 6.436, 11.29),
        13.26,
        0.1072,
    ),
    (
        {"id": "compass", "sigma": 0.0015, "xi": 0.7},
        (3.738, 0.893, 0.0843, 2.219, 0.3673, 2.638),
        5.176,
        0.1035,
    ),
]
OPTIMA = [
    ({"id": "compass", "sigma": 0.002945, "xi": 2.790}, 4.850),
    ({"id": "unity2", "zeta": 0.7115, "r": 1.037, "zeta2": 2.0}, 4.882),
    ({"id": "complementary", "zeta": 2.0, "eta": 2.0}, 6.016),
]
"""Networks whose parameters make the tilt least, and that tilt, arcsec."""
OPTIMAL = [
    (1.0, 6.147, 0.251),
    (0.1, 5.217, 0.244),
    (0.01, 4.874, 0.316),
    (1e-3, 4.756, 0.506),
    (1e-4, 4.717, 0.878),
]
"""Network `optimal`: rho, tilt in arcsec, velocity in m/s."""
FLOOR = 4.699, 0.0934
"""Tilt in arcsec and velocity in m/s."""


def set_a(*networks: dict[str, object]) -> Scenario:
    """Scenario of the reference sensors with one externally damped method a network."""
    methods = [
        {"name": str(k), "damping": "external", "network": network} for k, network in enumerate(networks)
    ]
    return Scenario.parse({**SET_A, "method": methods})


@pytest.fixture(scope="module")
def found() -> Budget:
    """Steady budget of the networks of the table."""
    return budget(set_a(*(row[0] for row in TABLE)), steady=True)


@pytest.mark.known(
    "oracle",
    ["tilt_rms", "velocity_rms"],
    kinds=["external"],
    fidelities=["covariance"],
    source="table of an independent Lyapunov equation",
)
@pytest.mark.parametrize("row", range(len(TABLE)))
def test_tilt_by_source_and_total(found: Budget, row: int) -> None:
    """Each number of the table, arcsec and m/s; the law each second lets 0.9 % more of the noise through."""
    _, by_source, tilt, velocity = TABLE[row]
    method = found.methods[row]
    sizes = [(method.sources[source].rms.tilt_rad or 0.0) / ARCSEC for source in SOURCES]
    assert sizes == pytest.approx(by_source, rel=9e-3)
    assert (method.total.rms.tilt_rad or 0.0) / ARCSEC == pytest.approx(tilt, rel=5e-3)
    assert method.total.rms.velocity_mps == pytest.approx(velocity, rel=5e-3)


@pytest.mark.known(
    "oracle",
    ["tilt_rms", "velocity_rms"],
    kinds=["kalman"],
    fidelities=["covariance"],
    source="figures of an independent Riccati equation",
)
def test_floor(found: Budget) -> None:
    """The Kalman filter on the same model; the famous compass setting is 2.8 times as bad."""
    assert (found.floor.rms.tilt_rad or 0.0) / ARCSEC == pytest.approx(FLOOR[0], rel=5e-3)
    assert found.floor.rms.velocity_mps == pytest.approx(FLOOR[1], rel=5e-3)
    assert found.times_floor(found.methods[4])["tilt"] == pytest.approx(2.8, abs=0.05)


@pytest.mark.parametrize(("network", "arcsec"), OPTIMA)
def test_tilt_at_the_known_optima(network: dict[str, object], arcsec: float) -> None:
    """The least tilt of three networks, at the parameters that give it."""
    method = budget(set_a(network), steady=True).methods[0]
    assert (method.total.rms.tilt_rad or 0.0) / ARCSEC == pytest.approx(arcsec, rel=5e-3)


@pytest.mark.parametrize(("rho", "arcsec", "velocity"), OPTIMAL)
def test_optimal_network(rho: float, arcsec: float, velocity: float) -> None:
    """LQG with the cost of the tilt only: the rows of the reference to 1 %, never below the floor."""
    found = budget(set_a({"id": "optimal", "rho": rho, "q": 0.0}), steady=True)
    total = found.methods[0].total.rms
    assert (total.tilt_rad or 0.0) / ARCSEC == pytest.approx(arcsec, rel=0.01)
    assert total.velocity_mps == pytest.approx(velocity, rel=0.01)
    assert (total.tilt_rad or 0.0) > (found.floor.rms.tilt_rad or 0.0)


def test_optimal_with_velocity_feedback_brings_tilt_and_velocity_to_the_floor() -> None:
    """The second input: 4.712" and 0.0937 m/s, where the network form leaves 0.12 m/s at best."""
    network = {"id": "optimal", "rho": 1e-4, "q": 1.0}
    found = budget(set_a(network | {"realisation": "feedback"}, network), steady=True)
    both, alone = (method.total.rms for method in found.methods)
    assert (both.tilt_rad or 0.0) / ARCSEC == pytest.approx(4.712, rel=1e-3)
    assert both.velocity_mps == pytest.approx(0.0937, rel=2e-3)
    times = found.times_floor(found.methods[0])
    assert 1.0 < (times["tilt"] or 0.0) < 1.01
    assert 1.0 < (times["velocity"] or 0.0) < 1.01
    assert (alone.velocity_mps or 0.0) > 1.2 * (both.velocity_mps or 0.0)
