"""The compiled law inside the error model against its slow twin: every policy with every switching method."""

import math

import numpy as np
import pytest

from navcore.foundation.earth import WGS84
from navcore.law.combination import combination_faults
from navcore.law.law import prepare_law
from navcore.law.policy import POLICIES
from navcore.law.switching import SWITCHINGS
from navcore.mechanization.error_model import ErrorModelRun
from navcore.mechanization.recorder import make_recorder
from navcore.mechanization.trajectory import coefficients
from navcore.motion.truth import AE, AN, COLUMNS, HEADING, LAT, VE, VN, Truth
from navcore.networks import parse_network
from navcore.sensors.base import ReferenceErrors, SensorErrors
from tests.error_model_twin import run_twin
from tests.law_twin import TwinLaw

STEPS = 1000
LAT0 = math.radians(45.7796)
OMEGA_S = WGS84.schuler_frequency(LAT0)
# short windows, so that all of it happens within the run
POLICY = {
    "yaw_rate": {"window_s": 30.0},
    "variation": {"n_s": 10.0, "t0_s": 40.0, "count": 10},
    "adaptive": {"lowpass_s": 20.0},
}
SWITCHING = {
    "step": {"every_s": 30.0, "size": 0.2},
    "bumpless": {"memory_s": 60.0, "n_s": 10.0},
    "bridge": {"memory_s": 60.0},
}
NETWORK = {"adaptive": {"id": "none"}, "schedule": {"id": "compass"}}


def truth() -> np.ndarray:
    """A ship that turns and speeds up between 300 and 500 s."""
    t = np.arange(2 * STEPS + 1) * 0.5
    rows = np.zeros((len(t), COLUMNS))
    event = (t > 300.0) & (t < 500.0)
    rows[:, LAT] = LAT0 + 1e-6 * t
    rows[:, AE], rows[:, AN] = np.where(event, 0.05, 0.001), 0.002 * np.cos(0.02 * t)
    rows[:, VE] = 8.0 + 0.001 * t + 0.049 * np.clip(t - 300.0, 0.0, 200.0)
    rows[:, VN] = -4.0 + 0.1 * np.sin(0.02 * t)
    rows[:, HEADING] = (6.0 + np.where(event, 0.01 * (t - 300.0), 0.0) + 2.0 * (t >= 500.0)) % (2.0 * math.pi)
    return rows


def inputs():
    """Sensor errors, log errors with a step of 1 m/s and a gap."""
    rng = np.random.default_rng(7)
    dv_r = rng.normal(0.1, 0.05, (STEPS + 1, 2))
    dv_r[350:600, 0] += 1.0
    dv_r[800:, 1] -= 0.7
    valid = np.ones(STEPS + 1, bool)
    valid[:2] = valid[650:680] = False
    eps, nabla = rng.normal(0.0, 5e-8, (STEPS, 3)), rng.normal(0.0, 5e-4, (STEPS, 3))
    return eps, nabla, dv_r, valid, np.array([0.05, -0.1, 1e-5, 2e-5, 3e-5, -2e-5, 2e-4])


CASES = [
    (damping, policy, switching)
    for damping in ("external", "internal")
    for policy in POLICIES
    for switching in SWITCHINGS
    if damping == "external" or (policy, switching) in (("yaw_rate", "bumpless"), ("adaptive", "step"))
]


@pytest.mark.parametrize(("damping", "policy_id", "switching_id"), CASES)
def test_kernel_equals_twin_sample_by_sample(damping, policy_id, switching_id):
    policy = POLICIES[policy_id].model_validate({"id": policy_id, **POLICY.get(policy_id, {})})
    switching = SWITCHINGS[switching_id].model_validate(
        {"id": switching_id, **SWITCHING.get(switching_id, {})}
    )
    network = parse_network(NETWORK.get(policy_id, {"id": "complementary"}))
    if list(combination_faults(damping, network, policy, switching, 1.0)):
        assert policy_id == "schedule", "only the schedule does not go with every switching method"
        return
    damped = hold_against_the_twin(damping, network, policy, switching)
    changes = np.count_nonzero(np.diff(damped[:, 0]))
    moved = len(np.unique(damped[:, 1]))
    assert changes >= 2 or moved >= 3 or damping == "internal", "nothing has happened"


@pytest.mark.parametrize(
    ("policy_id", "switching_id"),
    [("constant", "hard"), ("threshold", "hard"), ("threshold", "keep"), ("variation", "hard")],
)
def test_a_network_with_two_outputs_equals_the_twin(policy_id, switching_id):
    """Velocity feedback from the network's own states, while damped and after each gap."""
    network = parse_network({"id": "optimal", "rho": 1e-4, "q": 1.0, "realisation": "feedback"})
    policy = POLICIES[policy_id].model_validate({"id": policy_id, **POLICY.get(policy_id, {})})
    switching = SWITCHINGS[switching_id].model_validate({"id": switching_id})
    assert not list(combination_faults("external", network, policy, switching, 1.0))
    damped = hold_against_the_twin("external", network, policy, switching)
    assert np.count_nonzero(np.diff(damped[:, 0])) >= 2


def hold_against_the_twin(damping, network, policy, switching):
    """Run kernel and twin side by side; return damped and xi at each step, shape (STEPS, 2)."""
    law = prepare_law(damping, network, network.transfer(OMEGA_S), policy, switching, 1.0)
    eps, nabla, dv_r, valid, x0 = inputs()
    run = ErrorModelRun(
        1.0, STEPS, coefficients(Truth(0.5, truth()), WGS84, True), SensorErrors(eps, nabla),
        ReferenceErrors(np.arange(STEPS + 1.0), dv_r, valid, False, 0.5), law, x0.copy(),
        make_recorder(STEPS, 1.0, 1.0),
    )  # fmt: skip
    states, damped = [x0.copy()], []
    while run.position < STEPS:
        run.advance(1)
        states.append(run.x.copy())
        damped.append([float(law.s["damped"]), float(law.s["xi"])])
    twin_law = TwinLaw(damping, network, policy, switching, OMEGA_S, 1.0)
    twin = run_twin(truth(), eps, nabla, dv_r, valid, x0, twin_law, WGS84, 1.0)
    assert np.all(np.abs(np.array(states) - twin) <= 1e-10 * np.abs(twin).max(axis=0))
    assert law.s["damped"] == float(twin_law.damped)
    assert law.s["xi"] == pytest.approx(twin_law.xi, rel=1e-9)
    return np.array(damped)
