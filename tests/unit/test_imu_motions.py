"""The simulated IMU on every motion: exact increments, independence of chunks, memory, one kind each."""

import tracemalloc

import numpy as np
import pytest

from navcore.foundation.earth import WGS84
from navcore.motion import MOTIONS, LegsMotion
from navcore.motion.inertial import inertial_signals
from navcore.motion.kinematics import Kinematics
from navcore.motion.truth import Truth
from navcore.sensors.imu import Imu
from navcore.sensors.imu_simulation import ImuSimulation
from navcore.sensors.imu_simulation import simulation as module
from tests.motions import MANOEUVRES, SEA, ZHAO, circle_track
from tests.strapdown import DENG_SWING, DRIVE, SITE

RATE = 100.0
TURN = LegsMotion(leg=[{"duration_s": 60.0, "speed_mps": 20.0, "accel_mps2": 0.1, "turn_dps": 3.0}])
"""Turns and gathers speed from the first sample on; the drive stands still for ten minutes."""
FINE = 24
"""Sub-intervals of an interval: composite Boole's rule."""


@pytest.fixture(params=["swing", "legs", "turn", "profile", "zhao", "waves", "track"])
def motion(request, tmp_path):
    fixed = {
        "swing": DENG_SWING, "legs": DRIVE, "turn": TURN, "profile": MANOEUVRES, "zhao": ZHAO, "waves": SEA,
    }  # fmt: skip
    return fixed[request.param] if request.param in fixed else circle_track(tmp_path)


def simulation(motion, seconds: float, rate: float = RATE) -> ImuSimulation:
    return ImuSimulation(motion, SITE, WGS84, Imu(), rate, int(seconds * rate), 1)


def increments(motion, seconds: float) -> np.ndarray:
    return np.concatenate([chunk.copy() for chunk, _ in simulation(motion, seconds).chunks()])


def integrated(motion, seconds: float) -> np.ndarray:
    """Signals of another module, integrated over each interval."""
    count, step = int(seconds * RATE), 1.0 / RATE / FINE
    rows = motion.rows(count * FINE + 1, step, SITE, WGS84)
    signals = inertial_signals(Truth(step, rows), WGS84)
    weights = np.tile([14.0, 32.0, 12.0, 32.0], FINE // 4) * 2.0 / 45.0
    inner = np.tensordot(weights, signals[:-1].reshape(count, FINE, 6), (0, 1))
    ends = 7.0 * 2.0 / 45.0 * (signals[FINE::FINE] - signals[:-1:FINE])
    return (inner + ends) * step


def test_increments_are_the_integral_of_the_signals(motion):
    """A tile ends after 50 samples, a block after 100: no seam shows. A track's jerk jumps each second."""
    wanted, got = integrated(motion, 3.0), increments(motion, 3.0)
    smooth = np.ones(len(got), bool)
    if motion.kind == "track":
        at = np.arange(len(got)) % int(RATE)
        smooth = (at > 1) & (at < RATE - 1)
    tolerance = 1e-10 if motion.kind == "waves" else 1e-11
    np.testing.assert_allclose(got[smooth], wanted[smooth], rtol=0, atol=tolerance)
    np.testing.assert_allclose(got, wanted, rtol=0, atol=2e-8)


def test_the_interval_before_the_start_is_the_backward_continuation(motion):
    sim, got = simulation(motion, 3.0), increments(motion, 3.0)
    extrapolated = 4.0 * got[0] - 6.0 * got[1] + 4.0 * got[2] - got[3]
    np.testing.assert_allclose(sim.before(), extrapolated, atol=1e-8)


def test_the_numbers_do_not_depend_on_the_chunks(motion, monkeypatch):
    whole = increments(motion, 30.0)
    monkeypatch.setattr(module, "CHUNK_S", 7.0)
    np.testing.assert_array_equal(increments(motion, 30.0), whole)


def test_memory_does_not_grow_with_the_run(motion):
    """20 min at 400 Hz are 58 MB as rows of truth."""
    sim = simulation(motion, 1190.0, 400.0)
    tracemalloc.start()
    try:
        for chunk, _ in sim.chunks():
            assert np.isfinite(chunk[-1]).all()
        assert tracemalloc.get_traced_memory()[1] < 5e6
    finally:
        tracemalloc.stop()


def test_every_motion_has_a_kind_of_its_own(tmp_path):
    shown = {"track": circle_track(tmp_path)}
    motions = [shown.get(name) or model.model_validate({"kind": name}) for name, model in MOTIONS.items()]
    kinds = [motion.kinematics(10.0, SITE, WGS84).kind for motion in motions]
    assert sorted(kinds) == list(range(len(MOTIONS)))


def test_a_motion_seen_from_a_later_start():
    for motion in (DENG_SWING, SEA):
        kin = motion.kinematics(100.0, SITE, WGS84)
        assert isinstance(kin.moved(3.0), Kinematics)
        np.testing.assert_allclose(
            kin.moved(3.0).moved(-3.0).oscillations, kin.oscillations, rtol=0, atol=1e-12
        )
