"""Time a sample of the strapdown engine: free, damped, law at the IMU's rate, in a batch; and of its IMU."""

import importlib.util
import os
import statistics
import sys
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from navcore.foundation.earth import WGS84
from navcore.foundation.units import DEG
from navcore.law.law import Law, prepare_law
from navcore.law.policy.constant import Constant
from navcore.law.records import LawKind
from navcore.law.switching.hard import Hard
from navcore.mechanization.recorder import spans_from
from navcore.mechanization.strapdown import Settings, VelocityReference, start_from, start_run
from navcore.mechanization.strapdown.batch import WIDTH, BatchRun
from navcore.motion.static import StaticMotion
from navcore.motion.swing import Oscillation, SwingMotion
from navcore.motion.truth import Site
from navcore.networks.base import NetworkParameters
from navcore.networks.compass import CompassNetwork
from navcore.networks.complementary import ComplementaryNetwork
from navcore.networks.undamped import UndampedNetwork
from navcore.sensors.imu import Imu
from navcore.sensors.imu_simulation import ImuSimulation, side_by_side
from schuler_bench.bench.rounds import Timed, median_ratio, seconds_of, timed_rounds

ROUNDS = 7
RATE_HZ = 200.0
SECONDS = 1800
BATCH_BLOCKS, BATCH_SECONDS = 4, 60
SITE = Site(32.06 * DEG, 118.8 * DEG, 0.0)
YARDSTICK = "SCHULER_YARDSTICK"
"""Environment variable: a Python file whose ``quick(samples, repeats)`` gives a reference's ns a sample."""
_ALL_ERRORS = Imu(
    gyro_bias_dph=(0.02, 0.02, 0.02),
    gyro_arw_dpsh=0.006,
    accel_bias_ug=(50.0, 50.0, 50.0),
    accel_vrw_ugpshz=10.0,
    gyro_instability_dph=0.003,
    accel_instability_ug=10.0,
    gyro_scale_ppm=(5.0, 5.0, 5.0),
    accel_scale_ppm=(10.0, 10.0, 10.0),
)


class StaticRecord:
    """Perfect increments of an IMU at rest, and runs on them.

    Parameters
    ----------
    seconds : int
        Length.
    """

    def __init__(self, seconds: int) -> None:
        self.samples, self.second = seconds * int(RATE_HZ), int(RATE_HZ)
        imu = ImuSimulation(StaticMotion(), SITE, WGS84, Imu(), RATE_HZ, self.second, 0)
        self.before, self.truth = imu.before(), imu.truth_rows(1, 1.0)
        self.increments = np.tile(self.before, (self.samples, 1))

    def _started(self, law_every: int) -> tuple[Settings, VelocityReference]:
        """States and output every second; a sample of the log at each call of the law."""
        times = np.arange(self.samples // law_every + 1) * (law_every / RATE_HZ)
        still, valid = np.zeros((len(times), 2)), np.ones(len(times), bool)
        log = VelocityReference(times, still, valid, body_frame=False, hold_s=5.0)
        return Settings(RATE_HZ, self.samples, law_every, self.second, 1.0), log

    def run(self, damping: LawKind, network: NetworkParameters, law_every: int) -> Timed:
        """Time one method, always damped, over the whole length."""
        settings, log = self._started(law_every)

        def once() -> float:
            law, start = _law(damping, network, law_every), start_from(self.truth[0])
            run = start_run(start, settings, WGS84, law, self.truth, log, self.before)
            return seconds_of(lambda: run.advance(self.increments))

        return once

    def batch(self, blocks: int) -> Timed:
        """Time compass damping of blocks of runs, each with its own biases."""
        biases = np.random.default_rng(1).normal(size=(blocks, WIDTH, 3)) * 0.2
        imus = [[Imu(gyro_bias_dph=tuple(bias)) for bias in block.tolist()] for block in biases]
        lanes = [[*self._lanes(block)] for block in imus]
        return lambda: self._batch_seconds(lanes)

    def batch_with_noise(self, blocks: int) -> Timed:
        """Time the same with the simulation of each run's IMU, which has noise."""
        imus = [Imu(gyro_arw_dpsh=0.006, accel_vrw_ugpshz=10.0)] * WIDTH
        return lambda: self._batch_seconds([self._lanes(imus, WIDTH * block) for block in range(blocks)])

    def _lanes(self, imus: Sequence[Imu], seed: int = 0) -> Iterator[np.ndarray]:
        """Increments of IMUs at rest, each with a seed of its own."""
        still = [
            ImuSimulation(StaticMotion(), SITE, WGS84, imu, RATE_HZ, self.samples, seed + lane)
            for lane, imu in enumerate(imus)
        ]
        return side_by_side(still, WIDTH)

    def _batch_seconds(self, lanes: Sequence[Iterable[np.ndarray]]) -> float:
        settings, log = self._started(self.second)

        def started() -> BatchRun:
            laws = [_law("external", CompassNetwork(), self.second) for _ in range(WIDTH)]
            starts, logs = [start_from(self.truth[0])] * WIDTH, [log] * WIDTH
            return BatchRun(starts, laws, logs, settings, WGS84, self.truth, spans_from(()), self.before)

        def one(batch: BatchRun, increments: Iterable[np.ndarray]) -> None:
            for chunk in increments:
                batch.advance(chunk)

        batches = [started() for _ in lanes]
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            return seconds_of(lambda: [*pool.map(one, batches, lanes)])


def _law(damping: LawKind, network: NetworkParameters, law_every: int) -> Law:
    transfer = network.transfer(WGS84.schuler_frequency(SITE.lat))
    return prepare_law(damping, network, transfer, Constant(), Hard(), law_every / RATE_HZ)


def swinging_imu(samples: int) -> Timed:
    """An IMU with all its errors on a swing about three axes."""
    swing = Oscillation(amplitude_deg=10.0, frequency_hz=0.2)
    motion = SwingMotion(pitch=swing, roll=swing, heading=swing)

    def once() -> float:
        imu = ImuSimulation(motion, SITE, WGS84, _ALL_ERRORS, RATE_HZ, samples, 1)
        return seconds_of(lambda: [None for _ in imu.chunks()])

    return once


def _yardstick(samples: int) -> Timed | None:
    file = os.environ.get(YARDSTICK)
    if not file:
        return None
    spec = importlib.util.spec_from_file_location(f"yardstick_{Path(file).stem}", file)
    if spec is None or spec.loader is None or not Path(file).is_file():
        raise FileNotFoundError(f"{YARDSTICK}: no Python file: {file}")
    # numba finds what it kept of a module by the module's name.
    module = sys.modules[spec.name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return lambda: 1e-9 * samples * module.quick(samples, 1)


def measure_strapdown(rounds: int = ROUNDS, seconds: int = SECONDS) -> dict[str, float]:
    """Median ns a sample (and run), all pieces timed in turn.

    With a yardstick (`YARDSTICK`) its own time, and the ratio of each to it in the same round, come along.
    """
    record, short = StaticRecord(seconds), StaticRecord(min(seconds, BATCH_SECONDS))
    samples, many = record.samples, short.samples * BATCH_BLOCKS * WIDTH
    pieces: dict[str, tuple[Timed, int]] = {
        "strapdown_free_ns_per_sample": (record.run("free", UndampedNetwork(), record.second), samples),
        "strapdown_damped_ns_per_sample": (record.run("external", CompassNetwork(), record.second), samples),
        "strapdown_imu_rate_ns_per_sample": (record.run("external", ComplementaryNetwork(), 1), samples),
        "strapdown_batch_ns_per_sample_run": (short.batch(BATCH_BLOCKS), many),
        "strapdown_seeds_ns_per_sample_run": (short.batch_with_noise(BATCH_BLOCKS), many),
        "imu_simulation_ns_per_sample": (swinging_imu(samples), samples),
    }
    works = {name: work for name, (work, _) in pieces.items()}
    if (yardstick := _yardstick(samples)) is not None:
        works["yardstick"] = yardstick
    times = timed_rounds(works, rounds)
    numbers = {name: 1e9 * statistics.median(times[name]) / count for name, (_, count) in pieces.items()}
    if yardstick is None:
        return numbers
    reference = times["yardstick"]
    ratios = {
        f"{name.split('_ns_')[0]}_to_yardstick": median_ratio(times[name], reference) * samples / count
        for name, (_, count) in pieces.items()
    }
    return numbers | {"yardstick_ns_per_sample": 1e9 * statistics.median(reference) / samples} | ratios
