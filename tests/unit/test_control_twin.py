"""The compiled law against its slow twin: any law call by call, and some inside the error model."""

import math
from typing import Any

import numpy as np
import pytest

from navcore.foundation.earth import WGS84
from navcore.foundation.errors import InputError
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
from tests.law_run import OMEGA_S, LawRun
from tests.law_twin import TwinLaw

CALLS, LAWS = 200, 5
REALISATIONS = ("network", "feedback", "as_printed")


def drawn_networks(rng: np.random.Generator) -> list[dict[str, Any]]:
    """A random network of each kind, of one to four states and in each realisation, in random order."""
    u, n2 = rng.uniform, rng.uniform(1.0, 6.0)
    compass = {"id": "compass", "k1": u(0.01, 0.05), "k2": u(1.0, 9.0), "k3": u(0.01, 0.05)}
    pole2 = {"id": "pole2", "xi": u(0.02, 1.5), "n1": n2 + u(8.0, 12.0), "n2": n2}
    unity2 = {"id": "unity2", "zeta": u(0.1, 1.5), "r": u(1.1, 8.0)}
    optimal = {"id": "optimal", "rho": 10.0 ** u(-5.0, -1.0), "q": u(0.0, 2.0)}
    networks = [
        *({**compass, "realisation": each} for each in REALISATIONS),
        *({**pole2, "variant": each} for each in ("exact", "as_printed")),
        *({**unity2, **each} for each in ({}, {"zeta2": u(0.2, 2.0)}, {"alpha": u(1e-3, 0.01)})),
        *({**optimal, "realisation": each} for each in REALISATIONS[:2]),
        {"id": "compass", "sigma": u(1e-3, 0.01), "xi": u(0.3, 1.2)},
        {"id": "complementary", "zeta": u(0.1, 1.5), "eta": u(0.2, 2.0)},
        {"id": "classic2"},
        {"id": "classic3"},
        {"id": "none"},
    ]
    return [networks[i] for i in rng.permutation(len(networks))]


def drawn_blocks(rng: np.random.Generator, step_s: float) -> dict[str, dict[str, Any]]:
    """Random parameters of each policy and switching method; their times are a few calls."""
    u, pick = rng.uniform, lambda *each: each[rng.integers(len(each))]
    times = [float(each) for each in step_s * u(0.2, 12.0, 9)]
    a, b, c = np.sort(u(0.05, 0.8, 3)).tolist()
    first, last = u([0.0, 1.0, 1e-3], [0.03, 9.0, 0.05], (2, 3)).tolist()
    table = [[kn, u(0.01, 1.2)] for kn in np.cumsum(u(0.1, 1.0, rng.integers(2, 6))).tolist()]
    adaptive = {"law": "quadratic"}, {"law": "as_printed"}, {"table": table}
    return {
        "threshold": {"limit_mps": u(0.3, 1.0)},
        "yaw_rate": {"window_s": times[0], "limit_deg": u(1.0, 30.0)},
        "acceleration": {"mean_s": times[1], "limit_mps2": u(0.01, 0.06)},
        "variation": {"n_s": times[2], "t0_s": times[3], "a": a, "b": b, "c": c, "count": pick(1, 2, 4)},
        "adaptive": {"lowpass_s": times[4], **pick(*adaptive)},
        "schedule": {"from": first, "to": last, "duration_s": times[5]},
        "mobility": {"mean_s": times[1], "low_mps2": u(0.0, 0.02), "high_mps2": u(0.03, 0.06),
                     "xi": u(0.3, 1.2), "sigma_steady": u(1e-3, 0.01), "sigma_moving": u(1e-3, 0.01)},
        "states": {"mean_s": times[1], "limit_mps2": u(0.01, 0.06), "difference_mps": u(0.5, 2.0),
                   "return_s": times[2], "settled_s": times[3]},
        "ramp": {"duration_s": 1.0 + step_s * pick(0, 2, 5), "form": pick("state", "as_printed")},
        "step": {"every_s": times[6], "size": u(0.05, 0.4)},
        "bumpless": {"n_s": times[7], "memory_s": times[8]},
        "bridge": {"memory_s": times[8], "log_noise_mps": u(0.01, 0.05), "drive_mpsrth": u(0.0, 0.05),
                   "log_walk_mpsrth": u(0.0, 0.05), "output": pick("computed", "corrected")},
    }  # fmt: skip


def drawn_laws(rng: np.random.Generator, policy_id: str, switching_id: str) -> list[tuple[LawRun, TwinLaw]]:
    """Random laws of a policy and a switching method, with their twins."""
    laws = []
    for network in (block for _ in range(4) for block in drawn_networks(rng)):
        step_s, damping = float(rng.choice([0.2, 1.0, 20.0])), str(rng.choice(["external", "internal"]))
        blocks = drawn_blocks(rng, step_s)
        policy, switching = ({"id": id, **blocks.get(id, {})} for id in (policy_id, switching_id))
        try:
            run = LawRun(network, policy, switching, damping, step_s)
        except InputError:
            continue
        run.law.p["plain"] &= rng.integers(2)  # the full step gives what the plain one gives
        laws.append((run, TwinLaw(damping, run.network, run.policy, run.switching, OMEGA_S, step_s)))
    return laws[:LAWS]


def episodes(rng: np.random.Generator, quiet: int, columns: int) -> np.ndarray:
    """0 in quiet times of random length and 1 in the events between them, shape (CALLS, columns)."""
    lengths = rng.integers(1, [quiet, 15], (columns, CALLS, 2)).reshape(columns, -1)
    return np.array([np.repeat(np.arange(len(each)) % 2, each)[:CALLS] for each in lengths], float).T


def hold_beside_the_twin(rng: np.random.Generator, run: LawRun, twin: TwinLaw) -> None:
    """Call both under a log that jumps, comes back and is missing at times, in a motion of turns and legs.

    The velocity errors swing; with `bridge`, which models that, under the corrections given.
    """
    quiet, u = rng.choice([20, 150]), rng.uniform
    cos, sin = math.cos(OMEGA_S * twin.step_s), math.sin(OMEGA_S * twin.step_s)
    swing = u(-0.5, 0.5, (2, 2))
    log = u(-0.3, 0.3, 2) + u(-1.5, 1.5, 2) * episodes(rng, quiet, 2) + rng.normal(0.0, 0.01, (CALLS, 2))
    valid = episodes(rng, quiet, 1)[:, 0] == 0.0
    heading = np.cumsum(u(-0.3, 0.3) * episodes(rng, 30, 1)) + u(0.0, 6.0)
    v_c = u(-5.0, 5.0, 2) + np.cumsum(u(-0.1, 0.1, 2) * twin.step_s * episodes(rng, 30, 2), axis=0)
    calls, watched = [], twin.watched()
    for k in range(CALLS):
        d, v, at = log[k] - swing[0], v_c[k], heading[k] % (2.0 * math.pi)
        given = run.step(*d, valid=bool(valid[k]), v_c=v, heading=at)
        expected = np.ravel(twin.step(d, bool(valid[k]), v, at))
        watched = twin.watched()
        calls.append([(given, expected), *((run.numbers(name), watched[name]) for name in watched)])
        c = np.zeros((2, 2))
        c[0] = given[:2] if twin.switching.id == "bridge" else 0.0
        swing = np.array([[cos, sin], [-sin, cos]]) @ (swing + c) - c
    for name, pairs in zip(("given", *watched), zip(*calls, strict=True), strict=True):
        seen, expected = (np.array(each, float) for each in zip(*pairs, strict=True))
        off = np.abs(seen - expected) > 1e-8 * np.abs(expected).max(axis=0) + 1e-11
        law = (name, run.network, run.policy, run.switching, twin.external, twin.step_s)
        assert not np.any(off), f"call {np.argwhere(off)[0]} of {law}"


@pytest.mark.parametrize("switching_id", [id for id in SWITCHINGS if hasattr(TwinLaw, f"_switch_{id}")])
@pytest.mark.parametrize("policy_id", [id for id in POLICIES if hasattr(TwinLaw, f"_policy_{id}")])
def test_any_law_equals_its_twin_call_by_call(policy_id: str, switching_id: str) -> None:
    rng = np.random.default_rng([list(POLICIES).index(policy_id), list(SWITCHINGS).index(switching_id)])
    laws = drawn_laws(rng, policy_id, switching_id)
    switchings = {"schedule": ("hard", "keep"), "mobility": ("hard", "keep"), "states": ("hard", "step")}
    assert len(laws) == (LAWS if switching_id in switchings.get(policy_id, SWITCHINGS) else 0)
    for run, twin in laws:
        hold_beside_the_twin(rng, run, twin)


STEPS = 1000
LAT0 = math.radians(45.7796)


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


OPTIMAL = {"id": "optimal", "rho": 1e-4, "q": 1.0, "realisation": "feedback"}
VARIATION = {"id": "variation", "n_s": 10.0, "t0_s": 40.0, "count": 10}


@pytest.mark.parametrize(
    ("damping", "network", "policy", "switching"),
    [
        ("external", OPTIMAL, {"id": "threshold"}, {"id": "keep"}),
        ("external", {"id": "compass"}, {"id": "schedule"}, {"id": "hard"}),
        ("external", {"id": "complementary"}, {"id": "yaw_rate", "window_s": 30.0}, {"id": "bridge"}),
        ("external", {"id": "complementary"}, {"id": "acceleration"}, {"id": "ramp"}),
        ("external", {"id": "complementary"}, VARIATION, {"id": "bumpless", "memory_s": 60.0, "n_s": 10.0}),
        ("internal", {"id": "none"}, {"id": "adaptive", "lowpass_s": 20.0}, {"id": "step", "every_s": 30.0}),
    ],
)
def test_the_error_model_calls_the_law_as_its_twin_does(damping, network, policy, switching):
    """Every state at every step; within the run damping comes and goes, or its coefficient moves."""
    network = parse_network(network)
    policy = POLICIES[policy["id"]].model_validate(policy)
    switching = SWITCHINGS[switching["id"]].model_validate(switching)
    omega_s = WGS84.schuler_frequency(LAT0)
    law = prepare_law(damping, network, network.transfer(omega_s), policy, switching, 1.0)
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
    twin_law = TwinLaw(damping, network, policy, switching, omega_s, 1.0)
    twin = run_twin(truth(), eps, nabla, dv_r, valid, x0, twin_law, WGS84, 1.0)
    assert np.all(np.abs(np.array(states) - twin) <= 1e-10 * np.abs(twin).max(axis=0))
    assert np.ptp(damped, axis=0).max() > 0.0, "nothing has happened"
