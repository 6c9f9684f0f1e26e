"""The loop for the law at the IMU's rate gives, to the last bit, what the general loop gives."""

import numpy as np
import pytest

from navcore.damping import KINDS
from navcore.foundation.earth import WGS84
from navcore.law.law import prepare_law
from navcore.law.policy.base import PolicyParameters
from navcore.law.policy.constant import Constant
from navcore.law.policy.threshold import Threshold
from navcore.law.switching.hard import Hard
from navcore.mechanization.recorder import XI_COLUMN
from navcore.mechanization.strapdown import Settings, StrapdownRun, start_from, start_run
from navcore.mechanization.strapdown import records as at
from navcore.mechanization.strapdown.run import VelocityReference
from navcore.mechanization.strapdown.samples import is_steady
from navcore.motion.base import MotionParameters
from navcore.networks import parse_network
from navcore.networks.base import NetworkParameters
from navcore.sensors.imu import Imu
from navcore.sensors.imu_simulation import ImuSimulation
from tests.strapdown import DENG_SWING, DRIVE, SITE

RATE, SECONDS = 50.0, 12
NOISY = Imu(
    gyro_bias_dph=(5.0, -3.0, 2.0),
    gyro_arw_dpsh=0.5,
    accel_bias_ug=(900.0, -500.0, 300.0),
    accel_vrw_ugpshz=100.0,
)
START_ERRORS = np.array([0.3, -0.2, 1e-5, 2e-5, 2e-3, -1e-3, 5e-3])
NETWORKS = {
    "one state": 'id = "compass", sigma = 0.05',
    "as printed": 'id = "compass", sigma = 0.05, realisation = "as_printed"',
    "two states": 'id = "classic2"',
    "three states": 'id = "classic3"',
    "four states": 'id = "complementary"',
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
