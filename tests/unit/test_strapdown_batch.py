"""A batch gives each run what the single run gives."""

from __future__ import annotations

import numpy as np
import pytest

from navcore.earth import WGS84
from navcore.mechanization.strapdown import Settings, start_from, start_run
from navcore.mechanization.strapdown.batch import WIDTH, BatchRun
from navcore.network.classic import Classic2Network
from navcore.network.compass import CompassNetwork
from navcore.sensors.imu import Imu
from navcore.sensors.imu_simulation import ImuSimulation
from tests.strapdown import DENG_SWING, DRIVE, SITE, law, reference

RATE, SECONDS, RUNS = 50.0, 400, WIDTH + 3


def _make(motion, network):
    rng = np.random.default_rng(4)
    biases = rng.normal(size=(RUNS, 6)) * np.repeat([1e-7, 1e-3], 3)
    samples = int(RATE * SECONDS)
    sim = ImuSimulation(motion, SITE, WGS84, Imu(), RATE, samples, 1)
    increments = np.concatenate([chunk.copy() for chunk, _ in sim.chunks()])
    truth = sim.truth_rows(SECONDS + 1, 1.0)
    errors = rng.normal(size=(RUNS, 7)) * np.array([0.1, 0.1, 1e-6, 1e-6, 1e-4, 1e-4, 1e-3])
    starts = [start_from(truth[0], e) for e in errors]
    settings = Settings(RATE, samples, int(RATE), int(RATE), 1.0)
    return biases, sim, increments, truth, starts, settings, reference((0.1, -0.2), SECONDS)


@pytest.mark.parametrize("motion", [DENG_SWING, DRIVE], ids=["swing", "legs"])
@pytest.mark.parametrize(
    "network", [CompassNetwork(sigma=0.05, xi=0.7), Classic2Network()], ids=["compass", "network"]
)
def test_each_run_is_the_single_run(motion, network):
    biases, sim, increments, truth, starts, settings, log = _make(motion, network)
    laws = [law("external", network, 1.0) for _ in range(RUNS)]
    batch = BatchRun(starts, laws, biases, settings, WGS84, truth, log, sim.before())
    ended = [batch.advance(increments[i : i + 777]) for i in range(0, len(increments), 777)]
    assert ended[-1] and not any(ended[:-1])
    for run in (0, 7, WIDTH - 1, WIDTH, RUNS - 1):
        single = start_run(
            starts[run], settings, WGS84, law("external", network, 1.0), truth, log,
            sim.before() + biases[run] / RATE,
        )  # fmt: skip
        single.advance(increments + biases[run] / RATE)
        rows = single.recorder.rows
        np.testing.assert_allclose(batch.errors[:, run, :2], rows[:, 3:5], rtol=0, atol=2e-9)
        np.testing.assert_allclose(batch.errors[:, run, 4:], rows[:, :3], rtol=0, atol=1e-11)


def test_noise_is_held_and_added():
    biases, sim, increments, truth, starts, settings, log = _make(DENG_SWING, CompassNetwork())
    laws = [law("free", CompassNetwork(), 1.0) for _ in range(RUNS)]
    noise = np.random.default_rng(2).normal(size=(len(increments) // 5, RUNS, 6)) * 1e-6
    batch = BatchRun(starts, laws, biases, settings, WGS84, truth, log, sim.before())
    assert batch.advance(increments, noise, 5)
    single = start_run(
        starts[3],
        settings,
        WGS84,
        law("free", CompassNetwork(), 1.0),
        truth,
        log,
        sim.before() + biases[3] / RATE,
    )
    single.advance(increments + biases[3] / RATE + np.repeat(noise[:, 3], 5, axis=0))
    # The previous increment of the batch carries the present noise: a coning term of 1e-9 rad.
    np.testing.assert_allclose(batch.errors[:, 3, 4:], single.recorder.rows[:, :3], rtol=0, atol=1e-6)
    assert np.abs(single.recorder.rows[-1, :3]).max() > 1e-5


def test_what_a_batch_cannot_do_is_refused():
    truth = np.zeros((1, 15))
    with pytest.raises(ValueError, match="locked"):
        BatchRun([start_from(truth[0])], [law("free", CompassNetwork(), 1.0)], np.zeros((1, 6)),
                 Settings(50.0, 50, 50, 50, 1.0, "altimeter"), WGS84, truth)  # fmt: skip
    with pytest.raises(ValueError, match="multiple"):
        BatchRun([start_from(truth[0])], [law("free", CompassNetwork(), 1.0)], np.zeros((1, 6)),
                 Settings(50.0, 150, 50, 75, 1.0), WGS84, truth)  # fmt: skip
