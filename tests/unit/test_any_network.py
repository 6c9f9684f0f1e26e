"""Any network the models allow: refused in words, or its statements about stability and settling hold."""

import json
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from navcore.analysis import analyse, initial_tilt_response
from navcore.analysis.loop import closed_loop_polynomial
from navcore.analysis.report import network_report
from navcore.foundation.earth import SPHERE
from navcore.foundation.errors import InputError
from navcore.networks import NETWORKS, LinearNetwork, NetworkParameters, parse_network
from navcore.networks.discrete import discretise
from tests.random_models import raw_blocks

pytestmark = pytest.mark.contract

OMEGA_S = SPHERE.schuler_frequency(0.0)


def made_of(block: dict[str, Any]) -> tuple[NetworkParameters, LinearNetwork] | None:
    """Parameters and H(s), or None when refused; then every fault must name a field of the block."""
    try:
        parameters = parse_network(block)
        return parameters, parameters.transfer(OMEGA_S)
    except InputError as error:
        for fault in error.faults:
            assert fault.allowed and "\n" not in str(fault)
            assert fault.field.split(".")[0] in type_of(block).model_fields
        return None


def type_of(block: dict[str, Any]) -> type[NetworkParameters]:
    return NETWORKS[block["id"]]


networks = st.one_of(*(raw_blocks(model) for model in NETWORKS.values())).map(made_of).filter(bool)


@given(made=networks)
@settings(max_examples=400)
def test_printed_and_parsed_again_it_is_the_same(made):
    parameters, network = made
    fields = parameters.model_dump(mode="json", exclude_none=True)
    assert parse_network(fields) == parameters == parse_network(parameters.model_dump(mode="json"))
    text = ", ".join(f"{name} = {json.dumps(value)}" for name, value in fields.items())
    again = parse_network(text)
    assert again == parameters
    np.testing.assert_array_equal(again.transfer(OMEGA_S).num, network.num)
    np.testing.assert_array_equal(again.transfer(OMEGA_S).den, network.den)


@given(made=networks)
@settings(max_examples=400)
def test_stable_means_no_pole_on_the_right(made):
    parameters, network = made
    loop = analyse(network)
    assert len(loop.poles) == network.order + 2
    # the polynomial is that of the poles, whichever way they were found
    polynomial = closed_loop_polynomial(network)
    p = 1.3 * np.exp(1j * np.linspace(0.1, 3.0, 7))
    factors = np.prod(p[:, None] - loop.poles[None, :] / OMEGA_S, axis=1)
    size = np.polyval(np.abs(polynomial), np.abs(p))
    assert np.max(np.abs(factors - np.polyval(polynomial, p)) / size) < 1e-8
    rightmost = float(np.max(np.real(loop.poles) / np.maximum(np.abs(loop.poles), 1e-300)))
    if loop.stable:
        assert rightmost <= 1e-8
        assert loop.damping_ratio >= 0.0
    else:
        # two poles that no run can tell from zero are a double integrator
        at_zero = np.abs(loop.poles) <= 1e-9 * np.max(np.abs(loop.poles))
        assert rightmost >= -1e-8 or np.count_nonzero(at_zero) > 1
        assert loop.settling_s is None
        assert any("unstable" in warning for warning in loop.warnings)
    assert loop.damping_ratio <= 1.0 + 1e-12
    assert (loop.damping_ratio > 0.0) or not loop.stable or "undamped" in loop.warnings


@given(made=networks)
@settings(max_examples=150)
def test_after_settling_the_tilt_stays_below_two_percent(made):
    parameters, network = made
    loop = analyse(network)
    assume(loop.settling_s is not None and loop.settling_s > 0.0)
    assert loop.settling_s is not None
    later = loop.settling_s * np.linspace(1.0001, 6.0, 4001)
    assert np.max(np.abs(initial_tilt_response(network, later))) <= 0.02 * (1.0 + 1e-3)
    just_before = loop.settling_s * np.array([1.0 - 1e-6])
    assert np.abs(initial_tilt_response(network, just_before))[0] == pytest.approx(0.02, rel=0.02)


@given(made=networks, step_s=st.sampled_from([10.0, 1.0, 0.1, 0.005]))
@settings(max_examples=300)
def test_discrete_form_is_stable_when_the_network_is_and_has_its_response(made, step_s):
    parameters, network = made
    try:
        discrete = discretise(network, step_s)
    except InputError:
        assert np.any(np.real(network.poles) > 0.0), "only an unstable pole has no discrete counterpart"
        return
    omega = np.geomspace(1e-2, 1e2, 60) * OMEGA_S
    omega = omega[omega * step_s < 3.0]
    warped = OMEGA_S * np.tan(0.5 * omega * step_s) / np.tan(0.5 * OMEGA_S * step_s)
    exact = network.response(warped)
    # relative to what the network lets through around it: at a zero on the axis nothing is left to compare
    scale = np.maximum(np.abs(exact), 1e-6 * np.max(np.abs(exact)))
    assert np.max(np.abs(discrete.response(omega) - exact) / scale) < 1e-6
    if np.all(np.real(network.poles) < 0.0):
        multipliers = np.linalg.eigvals(discrete.dA)
        # |1 + m| < 1 without adding 1
        assert np.all(2.0 * multipliers.real + np.abs(multipliers) ** 2 < 0.0)


@given(made=networks)
@settings(max_examples=200)
def test_the_report_is_json(made):
    parameters, network = made
    document = json.loads(json.dumps(network_report(parameters), allow_nan=False))
    assert document["id"] == parameters.id
    assert document["stable"] in (True, False)
    assert len(document["closed_loop_poles"]) == len(document["poles"]) + 2
