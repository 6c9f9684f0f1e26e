"""Driving several runs: progress, cancel, one run that diverges among others."""

import time

import numpy as np

from navcore.foundation.earth import WGS84
from navcore.mechanization.strapdown import Settings, start_from, start_run
from navcore.mechanization.strapdown import records as at
from navcore.mechanization.strapdown.drive import drive
from navcore.motion.static import StaticMotion
from navcore.networks.undamped import UndampedNetwork
from navcore.sensors.imu import Imu
from navcore.sensors.imu_simulation import ImuSimulation
from tests.strapdown import SITE, law

RATE = 100.0


def _runs(hours: float, errors: list[np.ndarray]):
    samples = int(hours * 3600 * RATE)
    sim = ImuSimulation(StaticMotion(), SITE, WGS84, Imu(gyro_arw_dpsh=0.001), RATE, samples, 1)
    truth = sim.truth_rows(1, 1.0)
    settings = Settings(RATE, samples, int(RATE), int(RATE), 10.0)
    runs = [
        start_run(start_from(truth[0], e), settings, WGS84, law("free", UndampedNetwork(), 1.0), truth)
        for e in errors
    ]
    return runs, (increments for increments, _ in sim.chunks())


def test_a_run_that_diverges_leaves_the_others_alone():
    runs, chunks = _runs(0.2, [np.zeros(7), np.array([0, 0, 0, 0, 1.2, 0, 0])])
    seen: list[float] = []
    assert drive(runs, chunks, seen.append)
    assert [run.code for run in runs] == [at.COMPLETE, at.DIVERGED]
    assert seen == sorted(seen) and seen[-1] == 1.0
    assert runs[0].recorder.cursor["count"] == 721


def test_a_cancel_acts_soon_and_keeps_what_was_computed():
    runs, chunks = _runs(2000.0, [np.zeros(7), np.zeros(7)])
    stop_at = time.monotonic() + 0.3
    assert not drive(runs, chunks, cancelled=lambda: time.monotonic() > stop_at)
    # No wall time is asserted: a chunk is 6000 samples of some 70 ns, so the cancel came in after very few.
    assert 0 < runs[0].position < runs[0].settings.samples
    assert runs[0].position == runs[1].position
    assert runs[0].recorder.cursor["count"] == -(-runs[0].position // int(RATE))


def test_a_cancel_is_asked_for_after_every_chunk():
    runs, chunks = _runs(1.0, [np.zeros(7)])
    asked: list[int] = []

    def cancelled() -> bool:
        asked.append(runs[0].position)
        return len(asked) == 3

    assert not drive(runs, chunks, cancelled=cancelled)
    assert asked == [6000, 12000, 18000]
