"""Networks of up to eight states run, are judged and are exported as those of four are."""

import json
from pathlib import Path
from typing import Any

import control
import numpy as np
import pytest
from scipy.linalg import expm
from scipy.signal import cont2discrete, tf2ss

from navcore import budget, from_control, simulate
from navcore.analysis import analyse
from navcore.design.worst.bounded import worst
from navcore.exporting import target_c, target_python, target_table
from navcore.exporting.exported import exported
from navcore.exporting.law_form import law_form
from navcore.foundation.earth import EARTH_RATE, WGS84
from navcore.foundation.errors import InputError
from navcore.foundation.units import ARCMIN
from navcore.networks import parse_network
from navcore.networks.base import LinearNetwork, NetworkParameters, linear_network
from navcore.networks.pasted import pasted
from navcore.scenario.model import Scenario
from navcore.sensors.base import ReferenceErrors, SensorErrors
from schuler_bench.cli import main
from tests.eight import FOUR, OMEGA_S, cancelling, polynomials, product
from tests.exported import busy_inputs, called, compiler, library
from tests.law_run import OMEGA_S as OF_THE_SPHERE
from tests.law_run import LawRun
from tests.law_twin import TwinLaw
from tests.unit.test_control_twin import hold_beside_the_twin
from tests.unit.test_export_laws import deviation, subject

LEGS = {
    "kind": "legs",
    "leg": [
        {"duration_s": 1200.0, "speed_mps": 6.0, "heading_deg": 30.0},
        {"duration_s": 120.0, "turn_dps": 1.0},
        {"duration_s": 5880.0},
    ],
}


def scenario(method: dict[str, Any], **blocks: Any) -> Scenario:
    """Two hours of a moving ship with one method of external damping, noises and outages."""
    whole: dict[str, Any] = {
        "run": {"duration_h": 2.0, "output_step_s": 60.0, "seed": 5},
        "site": {"lat_deg": 45.0},
        "motion": LEGS,
        "imu": {"gyro_bias_dph": [0.01, -0.02, 0.03], "gyro_arw_dpsh": 0.002, "accel_instability_ug": 10.0},
        "initial_error": {"attitude_arcmin": [1.0, -1.0, 4.0], "velocity_mps": [0.2, -0.1]},
        "reference": {"kind": "log", "noise_mps": 0.1, "outage": [{"t_h": 0.7, "duration_s": 300.0}]},
        "method": [{"name": "mine", "damping": "external", **method}],
    }
    return Scenario.parse({**whole, **blocks})


# ---------------------------------------------------------------- against mathematics of another kind


def test_error_model_against_an_exact_integration_by_scipy() -> None:
    """At rest: matrix exponential of the seven states, network made discrete by scipy in controller form."""
    block, step_s, steps, lat = product(), 1.0, 3600, np.radians(45.0)
    eps, dv_r = np.array([2e-8, -1e-8, 3e-8]), np.array([0.1, -0.2])
    x0 = np.array([0.2, -0.1, 0.0, 0.0, ARCMIN, -ARCMIN, 4.0 * ARCMIN])
    run = _at_rest(block, step_s, steps, lat, eps, dv_r, x0)

    m, n = (radius for radius in WGS84.radii(lat))
    g, wz, wy = WGS84.gravity(lat, 0.0), EARTH_RATE * np.sin(lat), EARTH_RATE * np.cos(lat)
    F, G = np.zeros((7, 7)), np.zeros((7, 5))  # inputs: c_E, c_N, drifts of the gyros
    F[0, 5], F[0, 1] = -g, 2.0 * wz
    F[1, 4], F[1, 0] = g, -2.0 * wz
    F[2, 1], F[3, 0] = 1.0 / m, 1.0 / (n * np.cos(lat))
    F[4, [5, 6, 1]] = wz, -wy, -1.0 / m
    F[5, [4, 0, 2]] = -wz, 1.0 / n, -wz
    F[6, [4, 0, 2]] = wy, np.tan(lat) / n, wy
    G[4, 1], G[5, 0] = -1.0 / m, 1.0 / n
    G[4, 2] = G[5, 3] = G[6, 4] = -1.0
    whole = expm(step_s * np.block([[F, G], [np.zeros((5, 12))]]))
    network = parse_network(block).transfer(OMEGA_S)
    same_at_omega_s = 2.0 * np.tan(0.5 * OMEGA_S * step_s)
    discrete: Any = cont2discrete(tf2ss(network.num_p, network.den_p), same_at_omega_s, "bilinear")
    A, B, C, D, _ = discrete
    x, z = x0.copy(), np.zeros((8, 2))
    expected = [x]
    for _ in range(steps):
        d = dv_r - x[:2]
        c = d - (C @ z + D * d)[0]  # Q = 1 - H
        z = A @ z + B * d
        x = whole[:7, :7] @ x + whole[:7, 7:] @ np.concatenate([c, eps])
        expected.append(x)
    expected = np.array(expected)
    off = np.abs(run - expected).max(axis=0) / np.abs(expected).max(axis=0)
    assert np.all(off < 1e-9), off


def _at_rest(
    block: dict[str, Any],
    step_s: float,
    steps: int,
    lat: float,
    eps: np.ndarray,
    dv_r: np.ndarray,
    x0: np.ndarray,
) -> np.ndarray:
    """States of the compiled error model with constant errors, shape (steps + 1, 7)."""
    from navcore.law.law import prepare_law
    from navcore.law.policy.constant import Constant
    from navcore.law.switching.hard import Hard
    from navcore.mechanization.error_model import ErrorModelRun
    from navcore.mechanization.recorder import make_recorder
    from navcore.mechanization.trajectory import coefficients
    from navcore.motion.truth import COLUMNS, LAT, Truth

    truth = np.zeros((1, COLUMNS))
    truth[0, LAT] = lat
    network = parse_network(block)
    law = prepare_law("external", network, network.transfer(OMEGA_S), Constant(), Hard(), step_s)
    log = ReferenceErrors(
        np.arange(steps + 1) * step_s, np.tile(dv_r, (steps + 1, 1)), np.ones(steps + 1, bool), False, step_s
    )
    run = ErrorModelRun(
        step_s, steps, coefficients(Truth(0.5 * step_s, truth), WGS84, True),
        SensorErrors(eps[None, :], np.zeros((1, 3))), log, law, x0.copy(),
        make_recorder(steps, step_s, step_s),
    )  # fmt: skip
    states = [x0.copy()]
    while run.position < steps:
        run.advance(1)
        states.append(run.x.copy())
    return np.array(states)


LAWS = [("external", "threshold", switching) for switching in ("hard", "keep", "bumpless", "bridge")]
LAWS += [("internal", "yaw_rate", switching) for switching in ("hard", "keep", "bumpless")]


@pytest.mark.parametrize(("damping", "policy", "switching"), LAWS)
def test_law_against_its_twin_call_by_call(damping: str, policy: str, switching: str) -> None:
    run = LawRun(product(OF_THE_SPHERE), {"id": policy}, {"id": switching}, damping)
    twin = TwinLaw(damping, run.network, run.policy, run.switching, OF_THE_SPHERE, 1.0)
    hold_beside_the_twin(np.random.default_rng(8), run, twin)


# ---------------------------------------------------------------- eight states that are a network of four


SAME: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "error model": ({}, {}),
    "strapdown": ({}, {"run": {"duration_h": 0.3, "fidelity": "strapdown", "rate_hz": 10.0}}),
    "at the IMU's rate": (
        {},
        {"run": {"duration_h": 0.1, "fidelity": "strapdown", "rate_hz": 10.0, "step_s": 0.1}},
    ),
    "threshold": ({"policy": {"id": "threshold", "limit_mps": 0.3}}, {}),
    "bumpless": ({"policy": {"id": "variation"}, "switching": {"id": "bumpless"}}, {}),
    "internal": ({"damping": "internal"}, {}),
}


@pytest.mark.parametrize("name", SAME)
def test_a_run_is_that_of_the_network_of_four(name: str) -> None:
    method, blocks = SAME[name]
    runs = [simulate(scenario({**method, "network": one}, **blocks)) for one in (FOUR, cancelling())]
    four, eight = (run.methods[0].rows[:, :8] for run in runs)
    scale = np.abs(four).max(axis=0)
    assert np.all(np.abs(eight - four).max(axis=0) <= 1e-8 * scale + 1e-12)


def test_the_azimuth_channel_holds_eight_states_too() -> None:
    azimuth = cancelling(EARTH_RATE)
    runs = [simulate(scenario({"network": {"id": "unity2"}, "azimuth": one})) for one in (FOUR, azimuth)]
    four, eight = (run.methods[0].rows[:, :8] for run in runs)
    assert np.all(np.abs(eight - four).max(axis=0) <= 1e-8 * np.abs(four).max(axis=0) + 1e-12)


@pytest.mark.parametrize("steady", [True, False])
def test_a_budget_is_that_of_the_network_of_four(steady: bool) -> None:
    """By covariance along the run, and in the steady state of the sampled law."""
    found = [
        json.loads(json.dumps(budget(scenario({"network": one}), steady).document()))
        for one in (FOUR, cancelling())
    ]
    _near(*found)


def test_the_worst_log_is_that_of_the_network_of_four() -> None:
    four, eight = (worst(scenario({"network": one}), 0.5).methods[0].largest for one in (FOUR, cancelling()))
    np.testing.assert_allclose(eight, four, rtol=1e-6)


def test_an_ensemble_of_seeds_is_that_of_the_network_of_four() -> None:
    """Seeds side by side: the policy looks at the data, so that no covariance is known."""
    method = {"policy": {"id": "threshold", "limit_mps": 0.3}}
    found = [
        json.loads(json.dumps(budget(scenario({**method, "network": one}), seeds=8).document()))
        for one in (FOUR, cancelling())
    ]
    _near(*found)


def _near(four: Any, eight: Any) -> None:
    """Numbers of two documents agree to 1e-6, but for what names the network."""
    if isinstance(four, dict):
        for name in four.keys() - {"network", "scenario", "hash"}:
            _near(four[name], eight[name])
    elif isinstance(four, list):
        for one, other in zip(four, eight, strict=True):
            _near(one, other)
    elif isinstance(four, float):
        assert eight == pytest.approx(four, rel=1e-6, abs=1e-12)


# ---------------------------------------------------------------- from text, from control, from a class


def test_it_is_read_from_every_text() -> None:
    num, den = polynomials(product())
    roots = parse_network(product()).transfer(OMEGA_S)
    listed = [" ".join(f"{z.real:.17g}{z.imag:+.17g}i" for z in one) for one in (roots.zeros, roots.poles)]
    powers = [" + ".join(f"{c!r} s^{len(one) - 1 - i}" for i, c in enumerate(one)) for one in (num, den)]
    for text in (
        f"tf({num}, {den})",
        f"zpk([{listed[0]}], [{listed[1]}], {roots.gain!r})",
        rf"H(s) = \frac{{{powers[0]}}}{{{powers[1]}}}",
    ):
        found = parse_network(pasted(text)).transfer(OMEGA_S)
        assert found.order == 8
        np.testing.assert_allclose(found.num, num, rtol=1e-9)
        np.testing.assert_allclose(found.den, den, rtol=1e-9)


def test_it_comes_from_python_control_and_goes_back() -> None:
    num, den = polynomials(product())
    network = from_control(control.tf(num, den)).transfer(OMEGA_S)
    assert (network.num.tolist(), network.den.tolist()) == (num, den)
    assert network.to_control().poles().shape == (8,)


def test_the_command_judges_it(capsys: pytest.CaptureFixture[str]) -> None:
    num, den = polynomials(product())
    assert main(["network", f"tf({num}, {den})", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert len(document["poles"]) == 8 and len(document["closed_loop_poles"]) == 10 and document["stable"]
    loop = np.roots(np.polyadd(np.append(den, [0.0, 0.0]) / OMEGA_S**2, num))
    network = parse_network(product()).transfer(OMEGA_S)
    assert analyse(network).damping_ratio == pytest.approx(np.min(-loop.real / np.abs(loop)), rel=1e-6)


def test_nine_poles_are_refused_and_the_limit_is_named() -> None:
    with pytest.raises(InputError, match="at most 8 poles, here 9"):
        parse_network({"id": "custom", "poles": [-1e-3 * (k + 1) for k in range(9)]})


def test_a_class_of_a_users_own_has_eight_poles_and_a_second_output() -> None:
    """Velocity feedback beside Q: as the network of four states that it is."""

    class Eight(NetworkParameters):
        id: Any = "eight_of_a_test"

        def transfer(self, omega_s: float) -> LinearNetwork:
            more = np.poly([-3.0, -4.0, -5.0, -6.0]) if self.id.startswith("eight") else np.ones(1)
            base = parse_network(FOUR).transfer(omega_s)
            parts = (base.num_p, base.den_p, np.array([0.02, 0.01]))
            num, den, fed = (np.polymul(more, one) for one in parts)
            return linear_network(self.id, omega_s, num, den, feedback_p=fed)

    policy, switching = {"id": "constant"}, {"id": "hard"}
    laws = [LawRun(FOUR, policy, switching) for _ in range(2)]
    from navcore.law.law import prepare_law

    for law, name in zip(laws, ("four", "eight_of_a_test"), strict=True):
        network = Eight(id=name)
        transfer = network.transfer(OMEGA_S)
        law.law = prepare_law("external", network, transfer, law.policy, law.switching, 1.0)
        law.s = law.law.s
    rows = [[law.step(np.sin(0.01 * k), 0.3) for k in range(500)] for law in laws]
    assert np.abs(rows[0])[:, 2].max() > 1e-7
    np.testing.assert_allclose(rows[1], rows[0], rtol=0.0, atol=1e-14)


# ---------------------------------------------------------------- exported


METHODS: list[dict[str, Any]] = [
    {"damping": "external", "network": product()},
    {
        "damping": "external",
        "network": product(),
        "policy": {"id": "variation"},
        "switching": {"id": "bumpless"},
    },
    {
        "damping": "external",
        "network": product(),
        "policy": {"id": "threshold"},
        "switching": {"id": "bridge"},
    },
    {"damping": "internal", "network": {"id": "unity2"}, "azimuth": product(EARTH_RATE)},
]


@pytest.mark.skipif(not compiler(), reason="no C compiler")
def test_it_is_exported_to_c_as_it_runs(tmp_path: Path) -> None:
    inputs = busy_inputs()
    forms = [(f"law{i}", law_form(subject(one), inputs)) for i, one in enumerate(METHODS)]
    laws = library(forms, tmp_path)
    for prefix, form in forms:
        assert deviation(form, called(laws, prefix, form, inputs)) <= 1e-12, form.subject.method


def test_it_is_exported_to_python_and_as_a_table(tmp_path: Path) -> None:
    form = law_form(subject(METHODS[0]), busy_inputs(500))
    bounds = target_c.double_bounds(form)
    for name, text in target_python.files(form, "law", False, bounds).items():
        (tmp_path / name).write_text(text)
    names: dict[str, Any] = {"__name__": "law"}
    exec(compile((tmp_path / "law.py").read_text(), "law.py", "exec"), names)
    assert names["replay"](tmp_path / "vectors.csv")
    (tmp_path / "law.toml").write_text(target_table.files(form, "law", False, bounds)["law.toml"])
    again = parse_network(pasted(str(tmp_path / "law.toml"))).transfer(OMEGA_S)
    assert again.den.tolist() == form.subject.network.den.tolist()


@pytest.mark.parametrize("target", ["c", "matlab", "python", "table", "fmu"])
def test_every_target_takes_it(target: str) -> None:
    found = exported(scenario({"network": product()}, run={"duration_h": 0.2}), "mine", target=target)
    assert found.files


def test_an_exported_law_keeps_no_more_than_its_network_has() -> None:
    """Arrays are as large as what is read and written of them, not as the largest network's."""
    four = law_form(subject({"damping": "external", "network": FOUR}), busy_inputs(50))
    two = {"damping": "external", "network": {"id": "unity2"}}
    policy = {"policy": {"id": "variation"}, "switching": {"id": "bumpless"}}
    other = law_form(subject({**two, **policy}), busy_inputs(50))
    assert four.program.state["x"].shape == (2, 4)
    assert other.program.state["ring_x"].shape[1:] == (2, 2)
    assert law_form(subject(METHODS[0]), busy_inputs(50)).program.state["x"].shape == (2, 8)
