"""Searches over what Deng 2019 does not print: loops, rate of the log, signs, axes of the log."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import product
from typing import Any

import numpy as np

from navcore.engine.alignment_start import aligned_start, start_errors
from navcore.engine.environment import truth_of
from navcore.engine.simulation import simulate
from navcore.foundation.units import DEG, HOUR
from navcore.mechanization.recorder import PHI_E, PHI_N
from tools.papers.deng_errors import TABLE_1, TABLE_2, TABLE_4, Printed, errors_of
from tools.papers.measure import as_attitude, rms
from tools.papers.runs import Runs, scenario_of
from tools.papers.search import Search

Numbers = dict[str, tuple[float, ...]]
READINGS = ("as standard deviations", "as variances")

# ---------------------------------------------------------------- alignment

ALIGNMENT_SEEDS = range(1, 9)
SIGMAS = (0.008, 0.012, 0.02, 0.03)
SIGNS = tuple(product((1, -1), repeat=3))


def _aligned(runs: Runs) -> Numbers:
    """RMS of pitch, roll and heading error at the end of the alignment, deg, by loop and signs."""

    def make() -> Numbers:
        found: Numbers = {}
        for sigma, gyro, accel in product(SIGMAS, SIGNS, (1, -1)):
            errors = []
            for seed in ALIGNMENT_SEEDS:
                given = (
                    f"run.seed={seed}",
                    "run.rate_hz=20",
                    f"alignment.sigma={sigma}",
                    f"imu.gyro_bias_dph={[0.02 * sign for sign in gyro]}",
                    f"imu.accel_bias_ug={[50.0 * accel] * 3}",
                )
                scenario = scenario_of("deng-static", given)
                row = truth_of(scenario, 1, 1.0).values[0]
                errors.append(
                    as_attitude(start_errors(aligned_start(scenario, row), row)[None, 4:7], row[None])[0]
                )
            signs = "".join("+" if sign > 0 else "-" for sign in (*gyro, accel))
            name = f"sigma = {sigma} 1/s, signs of gyros x, y, z and accelerometers {signs}"
            found[name] = tuple(np.sqrt(np.mean(np.square(errors), axis=0)) / DEG)
        return found

    return runs.keep("search: deng alignment", make)


ALIGNMENT_SEARCH = Search(
    f"the loop's sigma ({SIGMAS[0]} to {SIGMAS[-1]} 1/s) and the signs of the biases of gyros and "
    f"accelerometers, {len(ALIGNMENT_SEEDS)} seeds each, full simulated alignments at 20 Hz.",
    (1, 2, 3),
    _aligned,
)

# ---------------------------------------------------------------- tables 1 and 2: turntable

LOOPS = tuple(product((0.01, 0.03, 0.06, 0.13, 0.25), (0.707, 1.0)))
LOG_HZ = (1.0, 2.0, 10.0, 200.0)


def _damped(name: str, sigma: float, xi: float = 0.707, **more: Any) -> dict[str, Any]:
    network = {"id": "compass", "sigma": sigma, "xi": xi, **more}
    return {"name": name, "damping": "external", "network": network}


def _turntable(preset: str, printed: Printed) -> Callable[[Runs], Numbers]:
    """Numbers of claims 2 to 10: tilt damped over free, and the spread of each row."""

    def make() -> Numbers:
        found: Numbers = {}
        methods = [{"name": "free", "damping": "free"}]
        methods += [_damped(f"sigma = {sigma} 1/s, xi = {xi}", sigma, xi) for sigma, xi in LOOPS]
        for rate in LOG_HZ:
            given = ("run.seed=1", f"reference.rate_hz={rate}")
            run = simulate(scenario_of(preset, given, method=methods))
            free = rms(run.methods[0].rows[:, [PHI_E, PHI_N]])
            for one in run.methods[1:]:
                tilt = rms(one.rows[:, [PHI_E, PHI_N]]) / free
                spread = errors_of(run, one).std(axis=0)
                for reading in READINGS:
                    name = f"{one.method.name}, log at {rate:g} Hz, spreads read {reading}"
                    found[name] = (tilt, *_as_read(spread, printed, reading))
        return found

    return lambda runs: runs.keep(("search: deng", preset), make)


def _as_read(spread: np.ndarray, printed: Printed, reading: str) -> Iterator[float]:
    """Spreads to be held against the printed numbers: as variances, against their square roots."""
    for value, (_, variance) in zip(spread, printed, strict=True):
        yield float(value) if reading == READINGS[0] else float(value) * variance**0.5


_TURNTABLE = (
    'sigma 0.01 to 0.25 1/s, xi 0.707 and 1, the log at 1 to 200 Hz, and both readings of "variance" for the '
    "whole "
    "table; one seed."
)
TABLE_1_SEARCH = Search(_TURNTABLE, tuple(range(2, 11)), _turntable("deng-static", TABLE_1))
TABLE_2_SEARCH = Search(_TURNTABLE, tuple(range(2, 11)), _turntable("deng-swing", TABLE_2))

# ---------------------------------------------------------------- table 4: the drive

DRIVE_SEEDS = (1, 2)
DRIVE_SIGMAS = (0.03, 0.13)
COARSE = ("run.rate_hz=50", "reference.rate_hz=50", "reference.noise_mps=0.1")
"""IMU and log at 50 Hz, for time: half the noise of a sample is the same density."""
REFERENCE_DEG = 0.01
AXES = {"body": "the axes of the vehicle", "enu": "east and north"}


def _drive(runs: Runs) -> Numbers:
    """Numbers of claims 2 to 13: axes of the log, signs of the gyros, loop and reference."""

    def make() -> Numbers:
        found: Numbers = {}
        methods = [
            {"name": "free", "damping": "free"},
            *(_damped(f"sigma = {sigma} 1/s", sigma) for sigma in DRIVE_SIGMAS),
            _damped("slow", 0.0088),
            _damped("printed", 0.0088, realisation="as_printed"),
        ]
        for frame, sign, seed in product(AXES, (1, -1), DRIVE_SEEDS):
            given = (
                f"run.seed={seed}",
                f'reference.frame="{frame}"',
                f"imu.gyro_bias_dph={[0.02 * sign] * 3}",
                *COARSE,
                "run.output_step_s=5",
            )
            run = simulate(scenario_of("deng-vehicle", given, method=methods))
            late = run.methods[0].t_s > HOUR / 6.0
            errors = {one.method.name: errors_of(run, one) for one in run.methods}
            largest = [np.max(np.abs(errors[name][late, 0])) for name in ("printed", "slow")]
            for sigma, own in product(DRIVE_SIGMAS, (0.0, REFERENCE_DEG)):
                mine = errors[f"sigma = {sigma} 1/s"]
                better = [rms(errors["free"][:, k]) / rms(mine[:, k]) for k in (0, 4, 7)]
                spread = mine.std(axis=0)
                cosine = float(np.cos(run.scenario.site.lat_deg * DEG))
                spread[:3] = np.hypot(spread[:3], own / np.array([1.0, 1.0, cosine]))
                for reading in READINGS:
                    name = (
                        f"log in {AXES[frame]}, gyros {0.02 * sign:+} deg/h, seed {seed}, sigma = {sigma} "
                        f"1/s, reference good to {own} deg, spreads read {reading}"
                    )
                    found[name] = (
                        *better,
                        *_as_read(spread, TABLE_4, reading),
                        float(largest[0] / largest[1]),
                    )
        return found

    return runs.keep("search: deng drive", make)


DRIVE_SEARCH = Search(
    "axes of the log (vehicle, or east and north), signs of the gyros, two drawings of the noise, sigma 0.03 "
    "and 0.13 1/s, a reference that is exact or good to 0.01 deg (table 3), and both readings of what the "
    "paper calls variance.",
    tuple(range(2, 14)),
    _drive,
)
