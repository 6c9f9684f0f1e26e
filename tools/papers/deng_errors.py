"""Deng 2019: the rows of tables 1, 2 and 4 as printed, and ours with each seed."""

import numpy as np

from navcore.engine.run import MethodRun, Run
from navcore.foundation.units import DEG
from navcore.mechanization.recorder import D_LAT, D_LON, DV_E, DV_N
from navcore.mechanization.strapdown.records import NAVIGATION
from tools.papers.measure import attitude_error
from tools.papers.runs import Runs, method

DAMPED, SLOW = "damped (Deng)", "damped, sigma = 0.0088"
DAMPED_PRINTED, SLOW_PRINTED = "damped (Deng), as printed", "sigma = 0.0088, as printed"
"""(3) and (4) to the letter, with the sigma that is fitted to table 1 and with Zha's."""
ROWS = (
    "pitch, deg",
    "roll, deg",
    "heading, deg",
    "V_E, m/s",
    "V_N, m/s",
    "V_U, m/s",
    "longitude, m",
    "latitude, m",
)
Printed = tuple[tuple[float, float], ...]
TABLE_1: Printed = (
    (0.0056, 0.0068), (-0.0073, 0.0069), (0.0468, 0.0899),
    (8.5077e-4, 0.0086), (2.3199e-4, 0.0082), (-0.0032, 5.4e-6), (0.9009, 0.5135), (0.2462, 0.6012),
)  # fmt: skip
TABLE_2: Printed = (
    (0.0035, 0.0114), (0.0149, 0.0092), (-0.0532, 0.0879),
    (1.494e-4, 0.0112), (6.526e-4, 0.0092), (-0.0039, 3.8e-6), (0.6151, 0.3872), (-0.1091, 0.4231),
)  # fmt: skip
TABLE_4: Printed = (
    (-0.0112, 0.0167), (-0.0063, 0.0832), (0.0137, 0.0734),
    (0.0004, 0.0123), (0.000005, 0.0128), (-0.0017, 0.0129), (-2.1172, 1.1474), (-4.2569, 3.8084),
)  # fmt: skip
SEEDS = range(1, 21)
WORDS = (
    "Pitch",
    "Roll",
    "Heading",
    "Eastward Velocity",
    "Northern Velocity",
    "Upward Velocity",
    "Longitude",
    "Latitude",
)
"""Names of the rows in the paper."""
CELLS_1 = (
    "0.0056 0.0068", "-0.0073 0.0069", "0.0468 0.0899",
    "8.5077 × 10^-4 0.0086", "2.3199 × 10^-4 0.0082", "-0.0032 5.4 × 10^-6", "0.9009 0.5135", "0.2462 0.6012",
)  # fmt: skip
CELLS_2 = (
    "0.0035 0.0114", "0.0149 0.0092", "-0.0532 0.0879",
    "1.494 × 10^-4 0.0112", "6.526 × 10^-4 0.0092", "-0.0039 3.8 × 10^-6", "0.6151 0.3872", "-0.1091 0.4231",
)  # fmt: skip
CELLS_4 = (
    "-0.0112 0.0167", "-0.0063 0.0832", "0.0137 0.0734",
    "0.0004 0.0123", "0.000005 0.0128", "-0.0017 0.0129", "-2.1172 1.1474", "-4.2569 3.8084",
)  # fmt: skip
"""Mean value and variance of each row as they stand in tables 1, 2 and 4."""


COARSE_HZ = 50.0
"""Rate of the drive's IMU and log where it is run with many seeds, for time."""


def log_at(rate_hz: float) -> tuple[str, ...]:
    """Overrides for a log at a rate: above 50 Hz at 50 Hz, with noise of the same density."""
    rate = min(rate_hz, COARSE_HZ)
    noise = 0.2 * (rate / rate_hz) ** 0.5
    return f"run.rate_hz={COARSE_HZ}", f"reference.rate_hz={rate}", f"reference.noise_mps={noise}"


def of_seed(runs: Runs, preset: str, seed: int, *overrides: str) -> Run:
    """Run of a preset with a seed; the drive at 50 Hz."""
    return runs(preset, *seed_overrides(preset, seed, *overrides))


def seed_overrides(preset: str, seed: int, *overrides: str) -> tuple[str, ...]:
    """Overrides for a seed."""
    coarse = (*log_at(200.0), "run.output_step_s=2") if preset == "deng-vehicle" else ()
    return f"run.seed={seed}", *coarse, *overrides


def errors(runs: Runs, preset: str, name: str, seed: int = 1, *overrides: str) -> np.ndarray:
    """Errors in the order and the units of the tables at the output rows, shape (m, 8)."""
    run = of_seed(runs, preset, seed, *overrides)
    return errors_of(run, method(run, name))


def errors_of(run: Run, found: MethodRun) -> np.ndarray:
    """Errors of a method of a run in the order and the units of the tables, shape (m, 8)."""
    rows = found.rows
    upward = np.zeros(len(rows))
    if found.navigation is not None:
        upward = found.navigation[:, NAVIGATION.index("dvu_mps")]
    velocity = np.column_stack([rows[:, DV_E], rows[:, DV_N], upward])
    return np.column_stack([attitude_error(run, found) / DEG, velocity, rows[:, D_LON], rows[:, D_LAT]])


def statistics(runs: Runs, preset: str, name: str, *overrides: str) -> np.ndarray:
    """Mean and standard deviation of each row of the tables, shape (seeds, 8, 2)."""

    def make() -> np.ndarray:
        found = []
        for seed in SEEDS:
            values = errors(runs, preset, name, seed, *overrides)
            found.append(np.column_stack([values.mean(axis=0), values.std(axis=0)]))
        return np.array(found)

    return runs.keep(("deng statistics", preset, name, overrides), make)


def log_spreads(runs: Runs, rate_hz: float, seeds: range = range(1, 4)) -> np.ndarray:
    """Mean standard deviation of each row of table 1 with the log at a rate, in the table's units."""
    found = [errors(runs, "deng-static", DAMPED, seed, f"reference.rate_hz={rate_hz}") for seed in seeds]
    return np.mean([values.std(axis=0) for values in found], axis=0)
