"""Deng 2019: the rows of tables 1, 2 and 4 as printed, and ours with each seed."""

import numpy as np

from navcore.engine.run import MethodRun, Run
from navcore.foundation.units import DEG
from navcore.mechanization.recorder import D_LAT, D_LON, DV_E, DV_N
from navcore.mechanization.strapdown.records import NAVIGATION
from tools.papers.measure import attitude_error
from tools.papers.runs import Runs, method

DAMPED, SLOW, PRINTED = "damped (Deng)", "damped, sigma = 0.0088", "sigma = 0.0088, as printed"
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
SEEDS = range(1, 9)


def errors(runs: Runs, preset: str, name: str, seed: int = 1, *overrides: str) -> np.ndarray:
    """Errors in the order and the units of the tables at the output rows, shape (m, 8)."""
    run = runs(preset, f"run.seed={seed}", *overrides)
    return errors_of(run, method(run, name))


def errors_of(run: Run, found: MethodRun) -> np.ndarray:
    """Errors of a method of a run in the order and the units of the tables, shape (m, 8)."""
    rows = found.rows
    upward = np.zeros(len(rows))
    if found.navigation is not None:
        upward = found.navigation[:, NAVIGATION.index("dvu_mps")]
    velocity = np.column_stack([rows[:, DV_E], rows[:, DV_N], upward])
    return np.column_stack([attitude_error(run, found) / DEG, velocity, rows[:, D_LON], rows[:, D_LAT]])


def statistics(runs: Runs, preset: str, name: str) -> np.ndarray:
    """Mean and standard deviation of each row of the tables, shape (seeds, 8, 2)."""

    def make() -> np.ndarray:
        found = []
        for seed in SEEDS:
            values = errors(runs, preset, name, seed)
            found.append(np.column_stack([values.mean(axis=0), values.std(axis=0)]))
        return np.array(found)

    return runs.keep(("deng statistics", preset, name), make)


def log_spreads(runs: Runs, rate_hz: float, seeds: range = range(1, 4)) -> np.ndarray:
    """Mean standard deviation of each row of table 1 with the log at a rate, in the table's units."""
    found = [errors(runs, "deng-static", DAMPED, seed, f"reference.rate_hz={rate_hz}") for seed in seeds]
    return np.mean([values.std(axis=0) for values in found], axis=0)
