"""The optimal network: whose sensors it is designed for, what it warns of, that it runs everywhere."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from app.cli import main
from navcore.analysis import analyse
from navcore.analysis.locus import root_locus
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.networks import MAX_ORDER, parse_network
from navcore.networks.lqg import compensator, plant
from navcore.networks.optimal import EXAMPLE_SHIP, modulus_margin
from navcore.scenario.file import parse_toml, to_toml
from navcore.scenario.model import Scenario

OMEGA_S = 1.24e-3
IMU = {"gyro_arw_dpsh": 0.01, "accel_vrw_ugpshz": 20.0, "gyro_instability_dph": 0.01, "gyro_tau_s": 900.0}
LOG = {"kind": "log", "noise_mps": 0.1, "drift_mps": 0.05}


def scenario(network: dict[str, Any], **blocks: Any) -> Scenario:
    """One externally damped method with this network."""
    data: dict[str, Any] = {
        "run": {"duration_h": 1.0, "output_step_s": 60.0},
        "imu": IMU,
        "reference": LOG,
        "method": [{"damping": "external", "network": {"id": "optimal", **network}}],
    }
    return Scenario.parse({**data, **blocks})


def poles(found: Scenario) -> np.ndarray:
    """Poles of its network, rad/s."""
    return found.method[0].network.transfer(OMEGA_S).poles


def test_it_follows_the_sensors_of_the_scenario() -> None:
    """Another log gives another network; the field itself stays empty, also when written and read."""
    one, other = scenario({}), scenario({}, reference={**LOG, "noise_mps": 1.0})
    assert not np.allclose(poles(one), poles(other))
    assert "log_noise_mps" not in one.canonical()["method"][0]["network"]
    again = Scenario.parse(parse_toml(to_toml(one), "text"))
    assert again == one
    assert np.array_equal(poles(again), poles(one))


def test_a_figure_given_goes_before_that_of_the_scenario() -> None:
    """A log noise stated in the network is that of a scenario with such a log."""
    stated, meant = scenario({"log_noise_mps": 1.0}), scenario({}, reference={**LOG, "noise_mps": 1.0})
    np.testing.assert_allclose(poles(stated), poles(meant), rtol=1e-12)


def test_without_any_sensors_it_is_designed_for_the_example_ship_and_says_so() -> None:
    """`schuler network` has no scenario; a scenario without random errors has no figures either."""
    alone = parse_network('id = "optimal", rho = 1e-3').transfer(OMEGA_S)
    assert len(alone.warnings) == 2
    assert "example ship" in alone.warnings[0]
    silent = scenario({"rho": 1e-3}, imu={}, reference={"kind": "log"}).method[0].network
    np.testing.assert_allclose(silent.transfer(OMEGA_S).poles, alone.poles)
    own = scenario({}).method[0].network.transfer(OMEGA_S)
    assert not any("example ship" in text for text in own.warnings)


@pytest.mark.parametrize("rho", [1.0, 1e-2, 1e-4])
def test_closed_loop_poles_are_those_of_filter_and_feedback(rho: float) -> None:
    """Separation principle, on the network that runs."""
    system = plant(EXAMPLE_SHIP, OMEGA_S)
    full = compensator(system, rho, 0.0, feedback=False)
    network = parse_network({"id": "optimal", "rho": rho}).transfer(OMEGA_S)
    assert network.order <= MAX_ORDER
    loop = analyse(network)
    assert loop.stable
    # feedback on (dV, phi), filter on everything
    weights = full.C[:2]
    feedback = np.linalg.eigvals(np.array([[0.0, 1.0], [-1.0 + weights[0], weights[1]]]))
    for pole in feedback:
        assert np.min(np.abs(loop.poles / OMEGA_S - pole)) < 1e-4 * abs(pole)


def test_a_smaller_rho_is_a_faster_and_no_less_robust_loop() -> None:
    """Modulus margin and H(0) over rho."""
    networks = [parse_network({"id": "optimal", "rho": rho}).transfer(OMEGA_S) for rho in (1.0, 1e-2, 1e-4)]
    margins = [modulus_margin(network) for network in networks]
    assert margins == sorted(margins)
    gains = [network.h0 for network in networks]
    assert gains == sorted(gains, reverse=True)
    assert gains[0] < 1.0


def test_a_fragile_loop_is_told() -> None:
    """A weight that asks for little control leaves a small margin."""
    slow = parse_network({"id": "optimal", "rho": 300.0}).transfer(OMEGA_S)
    assert modulus_margin(slow) < 0.5
    assert any(text.startswith("fragile: modulus margin") for text in slow.warnings)


def test_the_root_locus_keeps_the_sensors() -> None:
    """One field changed, the rest for the same ship."""
    parameters = scenario({}).method[0].network
    locus = root_locus(parameters, "rho", np.array([1e-2]), OMEGA_S)
    np.testing.assert_allclose(
        np.sort_complex(locus.poles[0]),
        np.sort_complex(analyse(parameters.transfer(OMEGA_S)).poles),
        rtol=1e-9,
    )


@pytest.mark.parametrize("fidelity", ["channel", "error_model", "strapdown"])
def test_it_runs_in_every_fidelity_and_damps(fidelity: str) -> None:
    """An initial tilt is worked off."""
    data = {"run": {"duration_h": 2.0, "fidelity": fidelity, "output_step_s": 60.0, "rate_hz": 50.0}}
    (run,) = simulate(
        scenario({"rho": 1e-2}, **data, initial_error={"attitude_arcmin": [3.0, 0.0, 0.0]})
    ).methods
    assert run.status == "ok"
    assert abs(run.rows[-1, 0]) < 0.15 * run.rows[0, 0]


def test_it_goes_with_switching_policies_and_internal_damping() -> None:
    """Every switching method that re-tunes nothing."""
    for switching in ("hard", "keep", "bumpless"):
        method = {
            "damping": "external",
            "network": {"id": "optimal"},
            "policy": {"id": "threshold"},
            "switching": {"id": switching},
        }
        assert simulate(scenario({}, method=[method])).methods[0].status == "ok"
    internal = {"damping": "internal", "network": {"id": "optimal"}}
    assert simulate(scenario({}, method=[internal])).methods[0].status == "ok"


def test_figures_that_make_no_network_are_refused_with_the_field() -> None:
    """A huge random walk: poles too far apart for double precision."""
    with pytest.raises(InputError, match="rho = "):
        parse_network(
            {"id": "optimal", "rho": 7.5e-4, "q": 1.0, "accel_vrw_ugpshz": 24117.0, "log_drift_mps": 0.0}
        ).transfer(OMEGA_S)


def test_command_shows_it(capsys: pytest.CaptureFixture[str]) -> None:
    """`schuler network` without a scenario."""
    assert main(["network", 'id = "optimal", rho = 1e-4', "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["stable"] and 0.0 < document["h0"] < 0.1
    assert any("example ship" in text for text in document["warnings"])
