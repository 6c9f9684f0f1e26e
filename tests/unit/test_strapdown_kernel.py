"""The strapdown kernel against its slow twin; its loop for the law at every sample."""

from typing import Any

import numpy as np
import pytest

from navcore.damping import KINDS
from navcore.foundation.earth import WGS84, attitude_matrix
from navcore.law.law import prepare_law
from navcore.law.policy.base import PolicyParameters
from navcore.law.policy.constant import Constant
from navcore.law.policy.threshold import Threshold
from navcore.law.switching.hard import Hard
from navcore.mechanization.recorder import XI_COLUMN
from navcore.mechanization.strapdown import Settings, StrapdownRun, start_from, start_run
from navcore.mechanization.strapdown import records as at
from navcore.mechanization.strapdown.attitude import angles_of, misalignment, quaternion_of
from navcore.mechanization.strapdown.run import VelocityReference, turned_by
from navcore.mechanization.strapdown.samples import is_steady
from navcore.motion.base import MotionParameters
from navcore.networks import parse_network
from navcore.networks.base import NetworkParameters
from navcore.networks.classic import Classic2Network
from navcore.networks.compass import CompassNetwork
from navcore.networks.complementary import ComplementaryNetwork
from navcore.networks.optimal import OptimalNetwork
from navcore.networks.undamped import UndampedNetwork
from navcore.sensors.imu import Imu
from navcore.sensors.imu_simulation import ImuSimulation
from tests.eight import product
from tests.law_twin import TwinLaw
from tests.strapdown import DENG_SWING, DRIVE, SITE, law, navigate, reference
from tests.strapdown_twin import run_twin

RATE = 50.0
NOISY = Imu(
    gyro_bias_dph=(5.0, -3.0, 2.0),
    gyro_arw_dpsh=0.5,
    accel_bias_ug=(900.0, -500.0, 300.0),
    accel_vrw_ugpshz=100.0,
)
START_ERRORS = np.array([0.3, -0.2, 1e-5, 2e-5, 2e-3, -1e-3, 5e-3])


def _damping(damping: str, network: NetworkParameters, v_r: np.ndarray):
    twin = TwinLaw(damping, network, Constant(), Hard(), WGS84.schuler_frequency(SITE.lat), 1.0)
    return lambda k, v: twin.step(v_r - v[:2], True, v[:2])


@pytest.mark.known(
    "twin",
    [
        "tilt_max_arcsec",
        "tilt_rms_arcsec",
        "velocity_max_mps",
        "velocity_rms_mps",
        "heading_max_arcmin",
        "heading_rms_arcmin",
        "position_max_m",
        "position_rms_m",
        "position_final_m",
    ],
    kinds=["free", "external", "internal"],
    fidelities=["strapdown"],
    source="a slow program in plain Python",
)
@pytest.mark.parametrize("motion", [DENG_SWING, DRIVE], ids=["swing", "legs"])
@pytest.mark.parametrize(
    ("kind", "network"),
    [
        ("free", UndampedNetwork()),
        ("external", ComplementaryNetwork()),
        ("internal", Classic2Network()),
        ("feedback", CompassNetwork(sigma=0.05, xi=0.7)),
        ("feedback", OptimalNetwork(rho=1e-4, q=1.0, realisation="feedback")),
    ],
)
@pytest.mark.parametrize("seconds", [1, 20])  # the mutation run makes the short one as Python
def test_kernel_equals_twin_sample_by_sample(motion, kind, network, seconds):
    samples = int(RATE * seconds)
    sim = ImuSimulation(motion, SITE, WGS84, NOISY, RATE, samples, 3)
    increments = next(iter(sim.chunks()))[0].copy()
    truth = sim.truth_rows(1, 1.0)[:1]
    start = start_from(truth[0], START_ERRORS)
    v_r = np.array([0.4, -0.7])
    damping = {"feedback": "external"}.get(kind, kind)
    settings = Settings(RATE, samples, int(RATE), int(RATE), 1.0)
    run = start_run(
        start, settings, WGS84, law(damping, network, 1.0), truth, reference(v_r, seconds), sim.before()
    )
    matrix = np.array([_turn(start.quaternion, axis) for axis in np.eye(3)]).T
    matrices, velocities, positions = run_twin(
        increments, sim.before(), RATE, int(RATE), matrix, start.velocity,
        np.array([start.lat, start.lon, start.height]), WGS84,
        None if kind == "free" else _damping(damping, network, v_r),
    )  # fmt: skip
    for k in range(samples):
        run.advance(increments[k : k + 1])
        x = run.x
        got = np.array([_turn(x["q"], axis) for axis in np.eye(3)]).T
        assert np.abs(got - matrices[k + 1]).max() < 5e-12
        assert np.abs(x["v"] - velocities[k + 1]).max() < 2e-10
        assert abs(start.lat + x["d_lat"] - positions[k + 1, 0]) < 1e-14
        assert abs(start.lon + x["d_lon"] - positions[k + 1, 1]) < 1e-14
    assert run.code == at.COMPLETE


def _turn(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    u = q[1:]
    return v + 2.0 * np.cross(u, np.cross(u, v) + q[0] * v)


@pytest.mark.parametrize("angles", [(0.1, -0.4, 3.0), (-1.2, 2.0, 6.0), (0.0, 0.0, 0.0)])
def test_quaternion_is_the_attitude_matrix(angles):
    q = np.array(quaternion_of(*angles))
    matrix = np.array([_turn(q, axis) for axis in np.eye(3)]).T
    np.testing.assert_allclose(matrix, attitude_matrix(*angles), atol=1e-15)
    np.testing.assert_allclose(angles_of(*q), angles, atol=1e-14)


def test_misalignment_has_the_sign_of_the_contract():
    phi = np.array([1e-5, -2e-5, 3e-5])
    true = np.array(quaternion_of(0.2, -0.3, 1.0))
    computed = turned_by(-phi, true)
    x, y, z = phi
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    matrix = np.array([_turn(computed, axis) for axis in np.eye(3)]).T
    np.testing.assert_allclose(matrix, (np.eye(3) - skew) @ attitude_matrix(0.2, -0.3, 1.0), atol=1e-9)
    np.testing.assert_allclose(misalignment(*computed, *true), phi, rtol=1e-9)
    np.testing.assert_allclose(misalignment(*(-computed), *true), phi, rtol=1e-9)


def test_chunks_of_any_length_give_the_same_run():
    whole = navigate(
        DRIVE, 50.0, 700.0, NOISY, START_ERRORS, "external", Classic2Network(), reference((0, 0), 700)
    )
    sim = ImuSimulation(DRIVE, SITE, WGS84, NOISY, 50.0, 35000, 1)
    increments = np.concatenate([chunk.copy() for chunk, _ in sim.chunks()])
    truth = sim.truth_rows(701, 1.0)
    run = start_run(
        start_from(truth[0], START_ERRORS), Settings(50.0, 35000, 50, 50, 1.0), WGS84,
        law("external", Classic2Network(), 1.0), truth, reference((0, 0), 700), sim.before(),
    )  # fmt: skip
    position, rng = 0, np.random.default_rng(1)
    while not run.advance(increments[position : (position := position + int(rng.integers(1, 900)))]):
        pass
    np.testing.assert_allclose(run.recorder.rows, whole.recorder.rows, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(run.recorder.stats, whole.recorder.stats, rtol=1e-6, atol=1e-9)
    assert run.recorder.cursor["count"] == 701


def test_a_run_ends_at_its_last_sample_whatever_it_is_given():
    sim = ImuSimulation(DRIVE, SITE, WGS84, NOISY, RATE, 110, 1)
    increments = np.concatenate([chunk.copy() for chunk, _ in sim.chunks()])
    truth = sim.truth_rows(3, 1.0)
    run = start_run(
        start_from(truth[0], START_ERRORS), Settings(RATE, 100, 50, 50, 1.0), WGS84,
        law("external", Classic2Network(), 1.0), truth, reference((0, 0), 3), sim.before(),
    )  # fmt: skip
    run.advance(increments[:40])
    assert run.advance(increments[40:])
    assert (run.position, run.code) == (100, at.COMPLETE)


def test_as_printed_lacks_the_transport_rate_of_the_reference():
    """Deng 4: a moving vehicle tilts the platform of the printed form (theory.md 8)."""

    def tilt(realisation: str) -> float:
        network = CompassNetwork(sigma=0.02, xi=0.7, realisation=realisation)
        rows = navigate(DRIVE, 50.0, 1100.0).truth
        log = reference((0, 0), 1100)
        log.velocity[:] = rows[:, 3:5]
        run = navigate(DRIVE, 50.0, 1100.0, damping="external", network=network, log=log)
        return float(np.abs(run.recorder.rows[:, :2]).max())

    assert tilt("feedback") < 1e-6
    assert tilt("as_printed") > 1e-5


def test_lengths_that_do_not_fit_are_refused():
    truth, free = np.zeros((3, 15)), law("free", UndampedNetwork(), 1.0)
    with pytest.raises(ValueError, match="multiple"):
        start_run(start_from(truth[0]), Settings(50.0, 120, 50, 50, 1.0), WGS84, free, truth)
    with pytest.raises(ValueError, match="rows of truth"):
        start_run(start_from(truth[0]), Settings(50.0, 150, 50, 50, 1.0), WGS84, free, truth)


# ---------------------------------------------------------------- the loop for the law at every sample


SECONDS = 12
NETWORKS: dict[str, Any] = {
    "one state": 'id = "compass", sigma = 0.05',
    "as printed": 'id = "compass", sigma = 0.05, realisation = "as_printed"',
    "two states": 'id = "classic2"',
    "three states": 'id = "classic3"',
    "four states": 'id = "complementary"',
    "eight states": product(),
    "two outputs": 'id = "optimal", realisation = "feedback", q = 1.0',
}


def _log(step_s: float, body: bool) -> VelocityReference:
    """Noisy log with an outage, which the fast loop must leave and take up again."""
    count = int(SECONDS / step_s) + 1
    velocity = 0.3 * np.random.default_rng(1).normal(size=(count, 2))
    valid = np.ones(count, bool)
    valid[count // 3 : count // 2] = False
    return VelocityReference(np.arange(count) * step_s, velocity, valid, body, 2.0)


def _run(
    motion: MotionParameters,
    damping: str,
    network: NetworkParameters,
    policy: PolicyParameters,
    log: VelocityReference,
    piece: int = 10_000,
) -> StrapdownRun:
    samples = int(RATE * SECONDS)
    sim = ImuSimulation(motion, SITE, WGS84, NOISY, RATE, samples, 3)
    transfer = network.transfer(WGS84.schuler_frequency(SITE.lat))
    law = prepare_law(damping, network, transfer, policy, Hard(), 1.0 / RATE)
    truth = sim.truth_rows(SECONDS + 1, 1.0)
    run = start_run(
        start_from(truth[0], START_ERRORS), Settings(RATE, samples, 1, int(RATE), 1.0), WGS84, law, truth,
        log, sim.before(),
    )  # fmt: skip
    for chunk, _ in sim.chunks():
        for first in range(0, len(chunk), piece):
            run.advance(chunk[first : first + piece])
    assert run.code == at.COMPLETE
    return run


def _assert_equal(run: StrapdownRun, other: StrapdownRun) -> None:
    assert run.x == other.x
    np.testing.assert_array_equal(
        run.recorder.rows[:, : XI_COLUMN + 1], other.recorder.rows[:, : XI_COLUMN + 1]
    )


@pytest.mark.parametrize("name", NETWORKS)
@pytest.mark.parametrize("damping", ["external", "internal"])
def test_equals_the_general_loop(name: str, damping: str):
    network = parse_network(NETWORKS[name])
    if network.requires_reference and not KINDS[damping].uses_log:
        assert (name, damping) == ("two outputs", "internal")
        return
    # Epochs between the recorded states, which the general loop serves.
    log = _log(0.3, body=False)
    run = _run(DENG_SWING, damping, network, Constant(), log)
    # A threshold that nothing reaches is the same law, and the general loop serves it.
    _assert_equal(run, _run(DENG_SWING, damping, network, Threshold(limit_mps=1000.0), log))
    damped = run.recorder.rows[:, 8].mean()
    assert damped == 1.0 if damping == "internal" else 0.5 < damped < 1.0


@pytest.mark.parametrize(("step_s", "body"), [(0.02, False), (0.013, True), (1.0, True)])
def test_equals_the_general_loop_with_any_log(step_s: float, body: bool):
    network, log = parse_network(NETWORKS["two states"]), _log(step_s, body)
    run = _run(DRIVE, "external", network, Constant(), log, piece=77)
    _assert_equal(run, _run(DRIVE, "external", network, Threshold(limit_mps=1000.0), log))


def test_a_free_run_equals_one_whose_network_has_nothing_to_do():
    """H = 1 corrects nothing."""
    one, log = parse_network('id = "none"'), _log(1.0, body=False)
    free = _run(DENG_SWING, "free", one, Constant(), log)
    other = _run(DENG_SWING, "internal", one, Threshold(), log)
    for name in ("d_lat", "d_lon", "height", "v", "q", "carry", "before", "m", "m_lat"):
        np.testing.assert_array_equal(free.x[name], other.x[name])


def test_only_the_steady_state_is_run_in_one_loop():
    network = parse_network(NETWORKS["two states"])
    transfer = network.transfer(WGS84.schuler_frequency(SITE.lat))
    for policy, steady in ((Constant(), True), (Threshold(), False)):
        run = _run(DENG_SWING, "internal", network, policy, _log(1.0, body=False))
        assert bool(is_steady(run.law)) is steady
    fresh = prepare_law("internal", network, transfer, Constant(), Hard(), 0.02)
    assert not is_steady(fresh)
    assert fresh.p["steady"] and not fresh.s["damped"]
