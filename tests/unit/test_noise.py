"""Random numbers of the sensors: statistics, independence, what a cache must not change."""

import math

import numpy as np
import pytest

from navcore.sensors import noise
from navcore.sensors.noise import CACHE_BYTES, gauss_markov, stream_generator, unit_noise

COUNT = 200_000


def test_unit_noise_is_standard_normal() -> None:
    n = unit_noise(1, "gyro.white", COUNT, 3).astype(float)
    assert np.abs(n.mean(axis=0)).max() < 4.0 / math.sqrt(COUNT)
    assert np.abs(n.std(axis=0) - 1.0).max() < 4.0 / math.sqrt(2.0 * COUNT)
    assert np.abs((n**4).mean(axis=0) - 3.0).max() < 4.0 * math.sqrt(96.0 / COUNT)
    assert np.mean(np.abs(n) > 3.0) == pytest.approx(0.0027, rel=0.1)
    along = [np.mean(n[1:, j] * n[:-1, j]) for j in range(3)]
    across = [np.mean(n[:, 0] * n[:, 1]), np.mean(n[:, 0] * n[:, 2]), np.mean(n[:, 1] * n[:, 2])]
    assert np.abs(along + across).max() < 4.5 / math.sqrt(COUNT)


@pytest.mark.parametrize("other", [(1, "accel.white"), (2, "gyro.white"), (1, "gyro.instability")])
def test_streams_are_independent(other: tuple[int, str]) -> None:
    one, two = unit_noise(1, "gyro.white", COUNT, 3), unit_noise(*other, COUNT, 3)
    for j in range(3):
        for k in range(3):
            assert abs(np.mean(one[:, j].astype(float) * two[:, k])) < 4.5 / math.sqrt(COUNT)


def test_numbers_depend_on_seed_and_name_only() -> None:
    first = unit_noise(7, "log", 100, 2).copy()
    unit_noise(7, "another", 100, 2)
    noise._DRAWN._held.clear()
    unit_noise(8, "log", 50, 2)
    assert np.array_equal(unit_noise(7, "log", 100, 2), first)
    assert np.array_equal(stream_generator(7, "log").standard_normal((100, 2), dtype=np.float32), first)


def test_a_longer_draw_begins_with_a_shorter_one() -> None:
    noise._DRAWN._held.clear()
    short = unit_noise(3, "gyro.white", 1000, 3).copy()
    long = unit_noise(3, "gyro.white", 5000, 3)
    assert np.array_equal(long[:1000], short)
    assert np.array_equal(unit_noise(3, "gyro.white", 1000, 3), short)


def test_drawn_numbers_are_kept_and_cannot_be_changed() -> None:
    one = unit_noise(4, "gyro.white", 1000, 3)
    assert np.shares_memory(one, unit_noise(4, "gyro.white", 500, 3))
    assert one.dtype == np.float32
    with pytest.raises(ValueError, match="read-only"):
        one[0, 0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        unit_noise(4, "gyro.white", 500, 3)[0, 0] = 1.0


def test_memory_of_kept_numbers_is_bounded() -> None:
    rows = CACHE_BYTES // (12 * 5)
    kept = unit_noise(0, "kept", rows, 3)
    for seed in range(4):
        unit_noise(seed, "many", rows, 3)
        unit_noise(0, "kept", rows, 3)
        assert noise._DRAWN.nbytes() <= CACHE_BYTES
    assert np.shares_memory(kept, unit_noise(0, "kept", 10, 3)), "the most recently used are kept"
    unit_noise(0, "huge", CACHE_BYTES // 12 + 1, 3)
    assert ("huge" in {key[1] for key in noise._DRAWN._held}) is False
    noise._DRAWN._held.clear()


def test_threads_see_the_same_numbers() -> None:
    from concurrent.futures import ThreadPoolExecutor

    noise._DRAWN._held.clear()
    with ThreadPoolExecutor(4) as pool:
        drawn = list(pool.map(lambda i: unit_noise(5, f"stream {i % 3}", 2000 + i, 2)[:2000], range(24)))
    for i, numbers in enumerate(drawn):
        assert np.array_equal(numbers, drawn[i % 3])


def test_gauss_markov_against_its_recursion() -> None:
    unit = unit_noise(13, "x", 50, 2)
    decay = 0.9
    expected = [unit[0].astype(float)]
    for row in unit[1:]:
        expected.append(decay * expected[-1] + math.sqrt(1.0 - decay**2) * row)
    assert gauss_markov(unit, decay) == pytest.approx(np.array(expected), abs=1e-6)


def test_gauss_markov_of_nothing_is_nothing() -> None:
    assert gauss_markov(unit_noise(1, "x", 0, 3), 0.5).shape == (0, 3)
