"""A batch gives each run what the single run gives."""

from dataclasses import replace

import numpy as np
import pytest

from navcore.foundation.earth import WGS84
from navcore.mechanization.strapdown import Settings, StrapdownRun, start_from, start_run
from navcore.mechanization.strapdown.batch import WIDTH, BatchNoise, BatchRun
from navcore.networks.classic import Classic2Network
from navcore.networks.compass import CompassNetwork
from navcore.sensors.imu import Imu
from navcore.sensors.imu_simulation import ImuSimulation
from navcore.sensors.imu_simulation.normal import fill_normals, stream_key
from navcore.sensors.imu_simulation.work import HALF_NORMALS, NORMAL, WORK, W
from tests.strapdown import DENG_SWING, DRIVE, SITE, law, reference

RATE, SECONDS, RUNS = 50.0, 400, WIDTH + 3


def _make(motion, network, seconds=SECONDS):
    rng = np.random.default_rng(4)
    biases = rng.normal(size=(RUNS, 6)) * np.repeat([1e-7, 1e-3], 3)
    samples = int(RATE * seconds)
    sim = ImuSimulation(motion, SITE, WGS84, Imu(), RATE, samples, 1)
    increments = np.concatenate([chunk.copy() for chunk, _ in sim.chunks()])
    truth = sim.truth_rows(seconds + 1, 1.0)
    errors = rng.normal(size=(RUNS, 7)) * np.array([0.1, 0.1, 1e-6, 1e-6, 1e-4, 1e-4, 1e-3])
    starts = [start_from(truth[0], e) for e in errors]
    settings = Settings(RATE, samples, int(RATE), int(RATE), 1.0)
    return biases, sim, increments, truth, starts, settings, reference((0.1, -0.2), seconds)


@pytest.mark.parametrize("motion", [DENG_SWING, DRIVE], ids=["swing", "legs"])
@pytest.mark.parametrize(
    "network", [CompassNetwork(sigma=0.05, xi=0.7), Classic2Network()], ids=["compass", "network"]
)
# the mutation run makes the short ones as Python
@pytest.mark.parametrize(("seconds", "law_s"), [(1, 1.0), (3, 0.5), (SECONDS, 1.0)])
def test_each_run_is_the_single_run(motion, network, seconds, law_s):
    biases, sim, increments, truth, starts, settings, log = _make(motion, network, seconds)
    settings = replace(settings, law_every=int(RATE * law_s))
    laws = [law("external", network, law_s) for _ in range(RUNS)]
    batch = BatchRun(starts, laws, biases, settings, WGS84, truth, log, sim.before())
    piece = min(777, len(increments) * 2 // 5)
    ended = [batch.advance(increments[i : i + piece]) for i in range(0, len(increments), piece)]
    assert ended[-1] and not any(ended[:-1])
    for run in (0, 7, WIDTH - 1, WIDTH, RUNS - 1):
        bias = biases[run] / RATE
        single_law = law("external", network, law_s)
        single = start_run(starts[run], settings, WGS84, single_law, truth, log, sim.before() + bias)
        single.advance(increments + bias)
        assert_same(batch, run, single)


def assert_same(batch: BatchRun, run: int, single: StrapdownRun) -> None:
    rows = single.recorder.rows
    np.testing.assert_allclose(batch.errors[:, run, :2], rows[:, 3:5], rtol=0, atol=2e-9)
    np.testing.assert_allclose(batch.errors[:, run, 4:], rows[:, :3], rtol=0, atol=1e-11)


def _unit_normals(run: int, draws: int, seed: int) -> np.ndarray:
    """Unit normal numbers of a run, one row a draw, as the batch takes them from the counter."""
    block, lane = divmod(run, WIDTH)
    each, w, rows = 2 * HALF_NORMALS // (6 * WIDTH), np.zeros(WORK), []
    key = np.uint64(stream_key(seed, "batch.white"))
    for group in range(-(-draws // each)):
        fill_normals((block << 32) + group, key, HALF_NORMALS, w)
        rows.append(w[NORMAL * W : NORMAL * W + 2 * HALF_NORMALS].reshape(each, 6, WIDTH)[:, :, lane].copy())
    return np.concatenate(rows)[:draws]


@pytest.mark.parametrize("every", [1, 5])
def test_noise_of_a_run_is_that_of_a_single_run(every):
    biases, sim, increments, truth, starts, settings, log = _make(DENG_SWING, CompassNetwork())
    laws = [law("external", CompassNetwork(), 1.0) for _ in range(RUNS)]
    walk = np.repeat([1e-6, 1e-4], 3)
    noise = BatchNoise(walk, 11, every)
    batch = BatchRun(starts, laws, biases, settings, WGS84, truth, log, sim.before(), noise)
    # Pieces of no round length: what is drawn must not depend on them.
    assert any([batch.advance(increments[i : i + 773]) for i in range(0, len(increments), 773)])
    for run in (3, WIDTH + 1):
        unit = _unit_normals(run, len(increments) // every, 11)
        bias, single_law = biases[run] / RATE, law("external", CompassNetwork(), 1.0)
        single = start_run(starts[run], settings, WGS84, single_law, truth, log, sim.before() + bias)
        single.advance(increments + bias + np.repeat(unit * walk / np.sqrt(RATE * every), every, axis=0))
        assert_same(batch, run, single)


def test_what_a_batch_cannot_do_is_refused():
    truth = np.zeros((1, 15))
    with pytest.raises(ValueError, match="locked"):
        BatchRun(
            [start_from(truth[0])],
            [law("free", CompassNetwork(), 1.0)],
            np.zeros((1, 6)),
            Settings(50.0, 50, 50, 50, 1.0, "altimeter"),
            WGS84,
            truth,
        )
    with pytest.raises(ValueError, match="multiple"):
        BatchRun(
            [start_from(truth[0])],
            [law("free", CompassNetwork(), 1.0)],
            np.zeros((1, 6)),
            Settings(50.0, 150, 50, 75, 1.0),
            WGS84,
            truth,
        )
