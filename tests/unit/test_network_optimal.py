"""The optimal network: whose sensors it is designed for, what it warns of, that it runs everywhere."""

import json
import math
from typing import Any

import numpy as np
import pytest

from navcore.analysis import analyse
from navcore.analysis.held_log import held_log
from navcore.analysis.locus import root_locus
from navcore.analysis.whole_system import whole_system
from navcore.design.budget import budget
from navcore.engine.simulation import simulate
from navcore.foundation.earth import SPHERE
from navcore.foundation.errors import InputError
from navcore.networks import MAX_ORDER, optimal, parse_network
from navcore.networks.lqg import Compensator, compensator, plant
from navcore.networks.optimal import EXAMPLE_SHIP, modulus_margin
from navcore.networks.seen_at import seen_at
from navcore.scenario.file import load, parse_toml, scenario_hash, to_toml
from navcore.scenario.model import Scenario
from schuler_bench.cli import main
from schuler_bench.editing.edits import with_design

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
    """Another log gives another network; the field itself stays empty."""
    one, other = scenario({}), scenario({}, reference={**LOG, "noise_mps": 1.0})
    assert not np.allclose(poles(one), poles(other))
    assert "log_noise_mps" not in one.canonical()["method"][0]["network"]


FREEZABLE = [
    {},
    {"site": {"lat_deg": 71.3}},
    {"imu": {}, "reference": {"kind": "log"}},
    {"imu": {"gyro_arw_dpsh": 0.0037, "accel_instability_ug": 7.3, "accel_tau_s": 411.0}},
]


def assert_same_h(one: Any, other: Any) -> None:
    """H(s), and the velocity feedback, to the last digit."""
    for name in ("num", "den", "zeros", "poles"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), strict=True)
    assert one.gain == other.gain


@pytest.mark.parametrize("blocks", FREEZABLE)
@pytest.mark.parametrize(
    "network", [{"rho": 0.01, "q": 1.0}, {"realisation": "feedback", "log_noise_mps": 0.3}]
)
def test_a_written_result_has_the_same_h_everywhere(
    network: dict[str, Any], blocks: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    """In the replay of its file, in a scenario with other sensors elsewhere, and by `schuler network`."""
    here = scenario(network, **blocks)
    designed = here.method[0].network.transfer(here.omega_s)
    written = parse_toml(to_toml(here), "text")
    replay = Scenario.parse(written)
    assert_same_h(replay.method[0].network.transfer(here.omega_s), designed)
    elsewhere = Scenario.parse(
        written | {"imu": IMU, "reference": {**LOG, "noise_mps": 0.7}, "site": {"lat_deg": 5}}
    )
    assert_same_h(elsewhere.method[0].network.transfer(elsewhere.omega_s), designed)
    block = ", ".join(f"{k} = {json.dumps(v)}" for k, v in written["method"][0]["network"].items())
    assert main(["network", block, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["num"] == designed.num.tolist()
    assert told["den"] == designed.den.tolist()
    assert told["settling_s"] == analyse(designed).settling_s


def test_a_written_result_is_the_same_scenario() -> None:
    """The hash of a scenario is that of its file, which is complete; writing it again changes nothing."""
    one = scenario({})
    again = Scenario.parse(parse_toml(to_toml(one), "text"))
    assert scenario_hash(again) == scenario_hash(one)
    assert to_toml(again) == to_toml(one)


def test_a_network_is_seen_the_same_at_another_schuler_frequency() -> None:
    """H(s) and the velocity feedback at any frequency do not depend on the unit of p."""
    parameters = scenario({"realisation": "feedback"}).method[0].network
    network = parameters.transfer(OMEGA_S)
    other = seen_at(network, 1.1 * OMEGA_S)
    omega = np.geomspace(1e-5, 1.0, 30)
    np.testing.assert_allclose(other.response(omega), network.response(omega), rtol=1e-12)

    def pushed(n: Any) -> np.ndarray:
        p = 1j * omega / n.omega_s
        return n.omega_s * np.polyval(n.feedback_p, p) / np.polyval(n.den_p, p)

    np.testing.assert_allclose(pushed(other), pushed(network), rtol=1e-12)


def test_a_design_that_is_taken_keeps_its_network() -> None:
    """Taken into a scenario with other sensors it is what was designed."""
    designed = scenario({})
    changed, at = with_design(
        scenario({"rho": 1.0}, reference={**LOG, "noise_mps": 2.0}), 0, designed.method[0]
    )
    omega_s = changed.omega_s
    assert_same_h(changed.method[at].network.transfer(omega_s), designed.method[0].network.transfer(omega_s))


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
    network = parse_network({"id": "optimal", "rho": rho, "q": 0.0}).transfer(OMEGA_S)
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
    networks = [
        parse_network({"id": "optimal", "rho": rho, "q": 0.0}).transfer(OMEGA_S) for rho in (1.0, 1e-2, 1e-4)
    ]
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


FEEDBACK = {"id": "optimal", "rho": 1e-3, "q": 1.0, "realisation": "feedback"}


@pytest.mark.parametrize(
    ("damping", "network", "policy", "switchings"),
    [
        ("external", {"id": "optimal"}, "threshold", ("hard", "keep", "bumpless")),
        ("external", FEEDBACK, "variation", ("hard", "keep")),
        ("internal", {"id": "optimal"}, "constant", ("hard",)),
    ],
)
def test_it_goes_with_internal_damping_and_what_re_tunes_nothing(
    damping: str, network: dict[str, Any], policy: str, switchings: tuple[str, ...]
) -> None:
    methods = [
        {
            "name": switching,
            "damping": damping,
            "network": network,
            "policy": {"id": policy},
            "switching": {"id": switching},
        }
        for switching in switchings
    ]
    run = simulate(scenario({}, method=methods))
    assert [method.status for method in run.methods] == ["ok"] * len(switchings)


@pytest.mark.parametrize("fidelity", ["channel", "error_model", "strapdown"])
def test_velocity_feedback_runs_in_every_fidelity_and_halves_the_velocity_error(fidelity: str) -> None:
    """Of an initial tilt and velocity error, with sensors that have none."""
    errors = {"attitude_arcmin": [3.0, 0.0, 0.0], "velocity_mps": [0.0, 1.0]}
    methods = [{"name": form, "damping": "external", "network": FEEDBACK | {"realisation": form}}
               for form in ("feedback", "network")]  # fmt: skip
    run = {"duration_h": 2.0, "fidelity": fidelity, "output_step_s": 60.0, "rate_hz": 50.0}
    quiet = {"imu": {}, "reference": {"kind": "log"}}
    both, alone = simulate(scenario({}, run=run, initial_error=errors, method=methods, **quiet)).methods
    for found in (both, alone):
        assert found.status == "ok"
        assert abs(found.rows[-1, 0]) < 0.15 * found.rows[0, 0]
    assert both.errors["dvn_mps"]["rms"] < 0.5 * alone.errors["dvn_mps"]["rms"]


def test_velocity_feedback_is_damped_in_the_whole_system_and_as_sampled() -> None:
    """In continuous time, and with a difference that is held for a second but not for 400."""
    network = parse_network(FEEDBACK).transfer(OMEGA_S)
    whole = whole_system(network, 0.8)
    assert whole.stable and whole.earth_growth < 0.0
    assert held_log(network, 1.0, 1.0, 0.8).stable
    assert not held_log(network, 400.0, 1.0, 0.8).stable


def test_the_budget_along_a_run_knows_the_second_output() -> None:
    """The covariance of the moving error model holds over seeds of the run itself."""
    ship = scenario(FEEDBACK, run={"duration_h": 2.0, "step_s": 2.0})
    shown = budget(ship).methods[0]
    seeds = [
        simulate(ship.model_copy(update={"run": ship.run.model_copy(update={"seed": seed})})).methods[0]
        for seed in range(1, 41)
    ]
    measured = np.sqrt(np.mean([method.errors["phi_e_rad"]["rms"] ** 2 for method in seeds]))
    assert measured == pytest.approx(shown.total.rms.tilt_rad, rel=0.25)
    speed = np.sqrt(np.mean([method.errors["dve_mps"]["rms"] ** 2 for method in seeds]))
    assert speed == pytest.approx(shown.total.rms.velocity_mps, rel=0.25)


@pytest.mark.parametrize(
    ("method", "line"),
    [
        (
            {"damping": "internal"},
            'network.realisation = \'feedback\': must be "network" with damping = "internal": velocity '
            "feedback needs a reference",
        ),
        (
            {"switching": {"id": "bumpless"}},
            "switching.id = 'bumpless': needs a network that comes to rest with a standing difference: "
            'network.realisation must be "network" with optimal',
        ),
        (
            {"switching": {"id": "bridge"}},
            "switching.id = 'bridge': works by the network alone: network.realisation must be \"network\" "
            "with optimal",
        ),
    ],
)
def test_velocity_feedback_is_refused_where_it_cannot_stand(method: dict[str, Any], line: str) -> None:
    with pytest.raises(InputError) as caught:
        scenario({}, method=[{"damping": "external", "network": FEEDBACK, **method}])
    assert str(caught.value) == f"method.0.{line}"


def test_figures_that_make_no_network_are_refused_with_the_field() -> None:
    """A huge random walk: poles too far apart for double precision."""
    with pytest.raises(InputError, match="rho = "):
        parse_network(
            {"id": "optimal", "rho": 7.5e-4, "q": 1.0, "accel_vrw_ugpshz": 24117.0, "log_drift_mps": 0.0}
        ).transfer(OMEGA_S)


def test_an_unstable_compensator_is_refused_before_its_order_is_reduced() -> None:
    """The balanced truncation of an unstable system would divide by zero."""
    figures = {"log_noise_mps": 4e-8, "log_drift_tau_s": 10.0, "accel_tau_s": 10.0}
    with pytest.raises(InputError, match="rho = 1.0: makes an unstable network"):
        parse_network({"id": "optimal", "rho": 1.0, **figures}).transfer(OMEGA_S)


def test_command_shows_the_second_output(capsys: pytest.CaptureFixture[str]) -> None:
    """G(s) over the same denominator, 1/s: at rest and at the Schuler frequency as the network has it."""
    text = 'id = "optimal", rho = 1e-3, q = 1, realisation = "feedback"'
    assert main(["network", text, "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    network = parse_network(text).transfer(SPHERE.schuler_frequency(0.0))
    assert network.feedback_p is not None
    for omega in (0.0, 1.24e-3):
        found = np.polyval(document["feedback_num"], 1j * omega) / np.polyval(document["den"], 1j * omega)
        p = 1j * omega / network.omega_s
        exact = network.omega_s * np.polyval(network.feedback_p, p) / np.polyval(network.den_p, p)
        assert found == pytest.approx(exact, rel=1e-9)
    assert main(["network", text]) == 0
    assert "velocity feedback" in capsys.readouterr().out


def test_states_that_nothing_reaches_are_left_out():
    decays = -np.arange(1.0, 6.0)
    reached = np.array([1.0, 0.0, 0.0, 0.0, 0.0])
    law = Compensator(np.diag(decays), reached, np.ones(5), np.ones(5))
    small = law.reduced(4)
    assert len(small.B) == 1
    for p in (0.1j, 1.0j, 10.0j):
        gain = small.C @ np.linalg.solve(p * np.eye(1) - small.A, small.B)
        assert gain == pytest.approx(np.sum(reached / (p - decays)), rel=1e-9)


@pytest.mark.parametrize(
    "A",
    [
        np.diag([-1.0, -2.0, -3.0, -4.0, 0.0]),
        [[-1.0, 0.0, -0.02], [0.0, -100.0, 9e-13], [0.0, -4e12, -100.0]],
    ],
    ids=["a mode of zero", "only after rounding"],
)
def test_a_compensator_that_does_not_decay_is_refused(A: Any) -> None:
    """scipy warned of both, and random networks in a contract test died of the warning."""
    ones = np.ones(len(A))
    law = Compensator(np.array(A), ones, ones, ones)
    with pytest.raises(np.linalg.LinAlgError, match="does not decay"):
        law.reduced(len(A) - 1)


def test_the_page_shows_the_figures_that_it_takes_from_the_scenario() -> None:
    """Its boxes were at 0 and said nothing."""
    scenario = load("sikuliaq-like").canonical()
    scenario["method"][2]["network"] = {"id": "optimal", "log_noise_mps": 0.4}
    network = Scenario.parse(scenario).method[2].network
    imu, log = Scenario.parse(scenario).imu, Scenario.parse(scenario).reference
    taken = network.taken()
    assert taken["gyro_arw_dpsh"] == pytest.approx(imu.gyro_arw_dpsh)
    assert taken["log_drift_mps"] == pytest.approx(log.drift_mps) and "log_noise_mps" not in taken


@pytest.mark.parametrize("realisation", ["network", "feedback"])
@pytest.mark.parametrize("noise", [1e-150, 1e-155, 1e-158, 1e-160, 1e-162])
def test_almost_no_noise_gives_a_network_or_is_refused(noise: float, realisation: str) -> None:
    """The squares of such densities are no numbers: an overflow went on, and NaN > accuracy is false."""
    text = {"id": "optimal", "rho": 1e-3, "q": 1.0, "realisation": realisation, "log_noise_mps": noise}
    try:
        network = parse_network(text).transfer(OMEGA_S)
    except InputError as refused:
        assert "rho = 0.001" in str(refused)
    else:
        assert np.all(np.isfinite(network.poles)) and math.isfinite(network.h0)


def test_a_numerator_that_is_no_number_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """0/0 in the check of the accuracy passed it."""
    parameters = parse_network({"id": "optimal", "rho": 1e-3})
    real = optimal._responses
    monkeypatch.setattr(optimal, "_responses", lambda p, A, B: real(p, A, B) * math.nan)
    with pytest.raises(InputError, match="too fast for these figures"):
        parameters.transfer(OMEGA_S)
