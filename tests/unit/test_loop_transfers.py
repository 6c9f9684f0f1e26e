"""Transfers of one channel against the differential equations of theory.md section 3."""

import typing

import numpy as np
import pytest

from navcore.analysis import (
    OUTPUTS,
    RADIUS,
    SOURCES,
    analyse,
    frequency_response,
    initial_tilt_response,
    margins,
    network_step_response,
    steady_state,
    time_response,
    to_control,
    transfer,
)
from navcore.analysis.transfers import Channel, Output, Source
from navcore.foundation.earth import SEMI_MAJOR_AXIS, SPHERE
from navcore.foundation.errors import InputError
from navcore.networks import NETWORKS, parse_network
from navcore.networks.base import LinearNetwork
from navcore.networks.lqg import compensator, plant
from navcore.networks.optimal import EXAMPLE_SHIP

OMEGA_S = float(np.sqrt(9.80665 / 6378137.0))
GRAVITY = 9.80665
BLOCKS = [
    *({"id": name} for name in NETWORKS),
    {"id": "compass", "k1": 7.68e-3, "k2": 6.68, "k3": 7.68e-3},
    {"id": "complementary", "zeta": 1.3},
    {"id": "custom", "poles": [-2e-3, [-1e-3, 2e-3], [-1e-3, -2e-3]], "zeros": [-1e-3], "gain": 4e-6},
]
OMEGA = OMEGA_S * np.array([0.01, 0.3, 0.9, 1.3, 4.0, 70.0])

Equations = tuple[np.ndarray, dict[str, np.ndarray], dict[str, np.ndarray]]


def network_equations(network: LinearNetwork, sign: float) -> Equations:
    """x' = A x + b u of the network form; x = [phi, dV, V, companion states of H]. sign -1: east channel.

    phi' = -(H dV - H dV_r + dV_r) sign/R - eps, and internally V* - V = H (V + dV) - V.
    """
    n = network.order
    num = np.concatenate([np.zeros(n + 1 - len(network.num)), network.num])
    direct = num[0]
    A = np.zeros((3 + n, 3 + n))
    phi, dv, v = 0, 1, 2
    A[dv, phi] = sign * GRAVITY
    A[phi, dv] = -sign * direct / RADIUS
    A[phi, 3:] = -sign * (num[1:] - direct * network.den[1:]) / RADIUS
    if n:
        A[3, 3:] = -network.den[1:]
        A[range(4, 3 + n), range(3, 2 + n)] = 1.0
        A[3, dv] = 1.0
    inputs = {source: np.zeros(3 + n) for source in SOURCES}
    inputs["eps"][phi] = -1.0
    inputs["nabla"][dv] = 1.0
    inputs["dv_r"][phi] = sign * (direct - 1.0) / RADIUS
    inputs["initial_tilt"][phi] = 1.0
    inputs["acceleration"][v] = 1.0
    if n:
        inputs["dv_r"][3] = -1.0
    internal = A.copy()
    internal[phi, v] = -sign * (direct - 1.0) / RADIUS
    if n:
        internal[3, v] = 1.0
    outputs = {"phi": np.eye(3 + n)[phi], "dv": np.eye(3 + n)[dv]}
    return A, inputs, {**outputs, "internal": internal}


def feedback_equations(k: tuple[float, float, float], printed: bool) -> Equations:
    """x = [phi, dV, p, V] of theory.md 3.1, north; as printed without the reference's transport rate."""
    k1, k2, k3 = k
    inverse = 1.0 / RADIUS
    A = np.zeros((4, 4))
    A[0] = [0.0, -(1.0 + k2) * inverse, -1.0, inverse if printed else 0.0]
    A[1] = [GRAVITY, -k1, 0.0, 0.0]
    A[2] = [0.0, k3 * inverse, 0.0, 0.0]
    inputs = {
        "eps": np.array([-1.0, 0.0, 0.0, 0.0]),
        "nabla": np.array([0.0, 1.0, 0.0, 0.0]),
        # as printed the whole reference velocity is missing from the rate, its error included
        "dv_r": np.array([(k2 + (1.0 if printed else 0.0)) * inverse, k1, -k3 * inverse, 0.0]),
        "initial_tilt": np.array([1.0, 0.0, 0.0, 0.0]),
        "acceleration": np.array([0.0, 0.0, 0.0, 1.0]),
    }
    return A, inputs, {"phi": np.eye(4)[0], "dv": np.eye(4)[1]}


def respond(A: np.ndarray, b: np.ndarray, c: np.ndarray, omega: np.ndarray) -> np.ndarray:
    return np.array([c @ np.linalg.solve(1j * w * np.eye(len(A)) - A, b) for w in omega])


@pytest.mark.parametrize("channel", ["north", "east"])
@pytest.mark.parametrize("output", OUTPUTS)
@pytest.mark.parametrize("source", SOURCES)
def test_network_form_against_its_equations(source: Source, output: Output, channel: Channel) -> None:
    for block in BLOCKS:
        network = parse_network(block).transfer(OMEGA_S)
        A, inputs, outputs = network_equations(network, 1.0 if channel == "north" else -1.0)
        if source == "acceleration":
            A = outputs["internal"]
        expected = respond(A, inputs[source], outputs[output], OMEGA)
        found = frequency_response(network, source, output, OMEGA, realisation="network", channel=channel)
        size = np.max(np.abs(expected)) + 1e-30
        np.testing.assert_allclose(found, expected, rtol=1e-7, atol=1e-11 * size, err_msg=str(block))


@pytest.mark.parametrize("output", OUTPUTS)
@pytest.mark.parametrize(
    ("realisation", "source"),
    # internal damping has the network form: vehicle acceleration does not enter the feedback form
    [*(("feedback", s) for s in SOURCES if s != "acceleration"), *(("as_printed", s) for s in SOURCES)],
)
def test_feedback_against_its_equations(source: Source, output: Output, realisation: str) -> None:
    for k in ((0.0264, 202.52, 0.904534), (7.68e-3, 6.68, 7.68e-3)):
        block = {"id": "compass", "k1": k[0], "k2": k[1], "k3": k[2], "realisation": realisation}
        network = parse_network(block).transfer(OMEGA_S)
        A, inputs, outputs = feedback_equations(k, realisation == "as_printed")
        expected = respond(A, inputs[source], outputs[output], OMEGA)
        np.testing.assert_allclose(frequency_response(network, source, output, OMEGA), expected, rtol=1e-8)


def two_output_equations(sign: float) -> tuple[LinearNetwork, Equations]:
    """x = [phi, dV, filter] of theory.md 17: the compensator itself, in SI, as `lqg` makes it."""
    law = compensator(plant(EXAMPLE_SHIP, OMEGA_S).excited(), 1e-2, 1.0, feedback=True).reduced(4)
    n = len(law.B)
    phi, dv, z = 0, 1, slice(2, 2 + n)
    A = np.zeros((2 + n, 2 + n))
    A[phi, dv], A[phi, z] = -sign / RADIUS, -sign * law.C / RADIUS
    A[dv, phi], A[dv, z] = sign * GRAVITY, OMEGA_S * law.E
    A[z, dv], A[z, z] = -OMEGA_S * law.B, OMEGA_S * law.A
    inputs = {source: np.zeros(2 + n) for source in SOURCES}
    inputs["eps"][phi], inputs["nabla"][dv], inputs["initial_tilt"][phi] = -1.0, 1.0, 1.0
    inputs["dv_r"][z] = OMEGA_S * law.B
    network = parse_network({"id": "optimal", "rho": 1e-2, "q": 1.0, "realisation": "feedback"})
    return network.transfer(OMEGA_S), (A, inputs, {"phi": np.eye(2 + n)[phi], "dv": np.eye(2 + n)[dv]})


@pytest.mark.parametrize("channel", ["north", "east"])
@pytest.mark.parametrize("output", OUTPUTS)
@pytest.mark.parametrize("source", [source for source in SOURCES if source != "acceleration"])
def test_two_outputs_against_their_equations(source: Source, output: Output, channel: Channel) -> None:
    network, (A, inputs, outputs) = two_output_equations(1.0 if channel == "north" else -1.0)
    expected = respond(A, inputs[source], outputs[output], OMEGA)
    found = frequency_response(network, source, output, OMEGA, channel=channel)
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-11 * np.max(np.abs(expected)))
    loop = np.sort_complex(analyse(network).poles)
    np.testing.assert_allclose(loop, np.sort_complex(np.linalg.eigvals(A)), rtol=1e-5)


def test_margins_of_two_outputs_are_those_of_the_loop_broken_at_the_velocity() -> None:
    """From V_c into the law back to V_c, both outputs closed: by its state space."""
    network, (A, _, outputs) = two_output_equations(1.0)
    cut = A.copy()
    cut[:, 1] = 0.0
    loop = -respond(cut, A[:, 1], outputs["dv"], OMEGA)
    np.testing.assert_allclose(-network.loop_response(OMEGA) * (OMEGA_S / OMEGA) ** 2, loop, rtol=1e-6)
    found = margins(network)
    assert found is not None and found.crossover_rad_s is not None and found.phase_rad is not None
    at = -network.loop_response(found.crossover_rad_s) * (OMEGA_S / found.crossover_rad_s) ** 2
    assert abs(at) == pytest.approx(1.0, rel=1e-6)
    assert abs(np.angle(-at)) == pytest.approx(abs(found.phase_rad), rel=1e-6)


def test_feedback_pulls_the_velocity_onto_the_reference() -> None:
    network = parse_network('id = "compass"').transfer(OMEGA_S)
    assert steady_state(network, realisation="feedback")["dv_r"]["dv"] == pytest.approx(1.0)
    rejecting = parse_network('id = "complementary"').transfer(OMEGA_S)
    assert steady_state(rejecting)["dv_r"]["dv"] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("output", OUTPUTS)
@pytest.mark.parametrize("source", SOURCES)
def test_polynomials_in_s_belong_to_the_frequency_response(source: Source, output: Output) -> None:
    for block in BLOCKS:
        network = parse_network(block).transfer(OMEGA_S)
        num, den = transfer(network, source, output)
        assert den[0] == 1.0
        found = np.polyval(num, 1j * OMEGA) / np.polyval(den, 1j * OMEGA)
        np.testing.assert_allclose(found, frequency_response(network, source, output, OMEGA), rtol=1e-6)


def test_steady_states_of_a_schuler_tuned_loop() -> None:
    network = parse_network('id = "complementary"').transfer(OMEGA_S)
    steady = steady_state(network)
    assert steady["eps"]["phi"] == 0.0
    assert steady["eps"]["dv"] == pytest.approx(-RADIUS)
    assert steady["nabla"]["phi"] == pytest.approx(-1.0 / GRAVITY)
    assert steady["nabla"]["dv"] == 0.0
    assert steady["dv_r"]["dv"] == 0.0
    assert steady["acceleration"]["phi"] == 0.0
    assert steady["initial_tilt"] == {"phi": 0.0, "dv": 0.0}


def test_steady_states_that_grow_or_never_come() -> None:
    pole2 = steady_state(parse_network('id = "pole2"').transfer(OMEGA_S))
    assert pole2["dv_r"]["dv"] == pytest.approx(-0.54, abs=0.005)
    assert pole2["acceleration"]["dv"] == np.inf
    free = steady_state(parse_network('id = "none"').transfer(OMEGA_S))
    assert free["eps"]["dv"] is None
    assert free["dv_r"] == {"phi": 0.0, "dv": 0.0}
    unstable = parse_network('id = "pole2", xi = 0.08, variant = "as_printed"').transfer(OMEGA_S)
    assert steady_state(unstable)["eps"]["phi"] is None


@pytest.mark.parametrize("rate", [2e-3, 3e-3, 5e-3, 7e-3])
def test_rounding_does_not_turn_unit_dc_gain_into_an_endless_growth(rate: float) -> None:
    """The product of the zeros is that of the poles: H(0) = 1, but for the last digit."""
    zeros, first = [-6.9e-4, -45.0 * rate], -4.0 * rate
    block = {"id": "custom", "zeros": zeros, "poles": [first, zeros[0] * zeros[1] / first]}
    steady = steady_state(parse_network(block).transfer(OMEGA_S))
    growth = steady["acceleration"]["dv"]
    assert growth is not None
    assert np.isfinite(growth)
    assert steady["dv_r"]["dv"] == 0.0


def test_time_responses_end_at_the_steady_state() -> None:
    network = parse_network('id = "unity2"').transfer(OMEGA_S)
    late = np.array([0.0, 1e6])
    for source in ("eps", "nabla", "dv_r", "acceleration", "initial_tilt"):
        for output in typing.get_args(Output):
            final = steady_state(network)[source][output]
            found = time_response(network, source, output, late)[1]
            assert found == pytest.approx(final, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("name", NETWORKS)
def test_time_responses_against_the_equations(name: str) -> None:
    """Fine RK4 of the equations themselves."""
    network = parse_network({"id": name}).transfer(OMEGA_S)
    A, inputs, outputs = network_equations(network, 1.0)
    count, step = 4000, 1.0
    for source in ("eps", "dv_r", "initial_tilt"):
        b = np.zeros(len(A)) if source == "initial_tilt" else inputs[source]
        x = inputs[source].copy() if source == "initial_tilt" else np.zeros(len(A))
        states = [x]
        for _ in range(count):
            k1 = A @ x + b
            k2 = A @ (x + 0.5 * step * k1) + b
            k3 = A @ (x + 0.5 * step * k2) + b
            k4 = A @ (x + step * k3) + b
            x = x + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
            states.append(x)
        time = step * np.arange(count + 1)
        for output in ("phi", "dv"):
            expected = np.array(states) @ outputs[output]
            found = time_response(network, source, output, time, realisation="network")
            size = np.max(np.abs(expected)) + 1e-30
            np.testing.assert_allclose(found, expected, rtol=0, atol=1e-6 * size)
            uneven = time_response(network, source, output, time[[5, 100, 1000]] * 1.0, realisation="network")
            np.testing.assert_allclose(uneven, found[[5, 100, 1000]], rtol=0, atol=1e-11 * size)


def test_undamped_responses_are_the_textbook_ones() -> None:
    network = parse_network('id = "none"').transfer(OMEGA_S)
    time = np.linspace(0.0, 20_000.0, 501)
    np.testing.assert_allclose(initial_tilt_response(network, time), np.cos(OMEGA_S * time), atol=1e-12)
    eps = time_response(network, "eps", "phi", time)
    np.testing.assert_allclose(eps, -np.sin(OMEGA_S * time) / OMEGA_S, atol=1e-9 / OMEGA_S)
    np.testing.assert_array_equal(network_step_response(network, time), 1.0)


def test_names_are_checked_and_constants_agree() -> None:
    network = parse_network('id = "none"').transfer(OMEGA_S)
    with pytest.raises(InputError, match="source"):
        transfer(network, "wind", "phi")
    with pytest.raises(InputError, match="output"):
        transfer(network, "eps", "heading")
    assert RADIUS == SEMI_MAJOR_AXIS
    assert SPHERE.schuler_frequency(0.0) == pytest.approx(OMEGA_S, rel=1e-15)
    assert tuple(SOURCES) == typing.get_args(Source)
    assert tuple(OUTPUTS) == typing.get_args(Output)


def assert_same_roots(found: np.ndarray, expected: np.ndarray, tolerance: float) -> None:
    left = list(expected)
    assert len(found) == len(left)
    for root in found:
        nearest = min(left, key=lambda other: abs(other - root))
        assert abs(nearest - root) <= tolerance * max(1.0, abs(root))
        left.remove(nearest)


@pytest.mark.parametrize("block", BLOCKS[1:], ids=str)
def test_python_control_finds_the_same_poles_and_zeros(block: dict[str, object]) -> None:
    network = parse_network(block).transfer(OMEGA_S)
    own = to_control(network, normalised=True)
    assert_same_roots(own.poles(), network.poles / OMEGA_S, 1e-5)
    assert_same_roots(own.zeros(), network.zeros / OMEGA_S, 1e-5)
    loop = to_control(network, "eps", "dv", normalised=True, realisation="network")
    # a pole repeated three times is found to 1e-5 only by rooting the polynomial
    assert_same_roots(loop.poles(), analyse(network).poles / OMEGA_S, 2e-4)


def test_python_control_in_seconds_and_normalised_agree() -> None:
    network = parse_network('id = "classic2"').transfer(OMEGA_S)
    seconds = to_control(network, "dv_r", "phi")
    normalised = to_control(network, "dv_r", "phi", normalised=True)
    for w in OMEGA:
        assert complex(seconds(1j * w)) == pytest.approx(complex(normalised(1j * w / OMEGA_S)), rel=1e-9)
