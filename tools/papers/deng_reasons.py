"""Deng 2019: why rows of its tables differ, and the effect of what each reason names."""

from collections.abc import Callable

import numpy as np

from navcore.engine.simulation import simulate
from navcore.foundation.units import DEG
from tools.papers.deng_errors import (
    DAMPED,
    SEEDS,
    errors,
    errors_of,
    of_seed,
    seed_overrides,
    statistics,
)
from tools.papers.runs import Runs, scenario_of

_HEADING = (
    "0.02 deg/h and 0.006 deg/sqrt(h) turn the heading by {drift} deg within a run (mean over the seeds), "
    "and the heading is not damped (nor is the paper's): the sensors that the paper states cannot cause the "
    "spread of its heading."
)
_CAR = (
    "the reference of the drive, good to 0.01 deg (divided by cos L in heading), explains little of it: "
    "added in squares to ours it leaves {referenced} deg. What else the real car adds is not printed."
)
WHY_1 = {"heading": _HEADING}
"""Why a row of table 1 differs in every reading, by its name; so do the rows of table 2."""
_TURNED = (
    "the log measures in the axes of the vehicle and is turned by the computed heading, so that the heading "
    "error of the alignment times the speed appears in the velocity and adds up in the position. It differs "
    "from seed to seed; the paper shows one drive after one alignment. With a log in east and north the "
    "spread is {north_up} m."
)
WHY_4 = {
    **dict.fromkeys(("roll", "heading"), _CAR),
    **dict.fromkeys(("longitude", "latitude"), _TURNED),
}
NOTES_1 = {
    "V_U": "the damping of the vertical channel is not printed. Here an ideal altimeter damps it, and the "
    "bias of the accelerometers, printed as less than 50 ug, moves the vertical velocity until that loop has "
    "found it: with 50 ug the spread is {all} m/s, with 20 ug {less} m/s, without a bias {unbiased} m/s."
}
"""What should be known of a row of tables 1 and 2 that agrees in a reading."""


def heading_drift(runs: Runs, preset: str) -> float:
    """Range of the heading error within a run, deg, mean over the seeds."""
    return float(np.mean([np.ptp(errors(runs, preset, DAMPED, seed)[:, 2]) for seed in SEEDS]))


UNBIASED, BIASED_20 = "imu.accel_bias_ug=[0,0,0]", "imu.accel_bias_ug=[20,20,20]"
NORTH_UP = 'reference.frame="enu"'


def spread_with(runs: Runs, preset: str, row: int, *overrides: str) -> np.ndarray:
    """Standard deviation of a row with other settings, with each of the seeds, in the table's units."""

    def make() -> np.ndarray:
        damped = [one for one in scenario_of(preset).canonical()["method"] if one["name"] == DAMPED]
        found = []
        for seed in SEEDS:
            run = simulate(scenario_of(preset, seed_overrides(preset, seed, *overrides), method=damped))
            found.append(errors_of(run, run.methods[0]).std(axis=0))
        return np.array(found)

    return runs.keep(("deng spreads", preset, overrides), make)[:, row]


REFERENCE_DEG = 0.01
"""What Deng's table 3 states for the reference of the drive: pitch and roll; heading divided by cos L."""


def referenced(runs: Runs, preset: str, row: int) -> np.ndarray:
    """Spread of an angle (row 0 to 2), deg, by seed, with the reference's error added in squares."""
    latitude = of_seed(runs, preset, 1).scenario.site.lat_deg * DEG
    own = REFERENCE_DEG / (float(np.cos(latitude)) if row == 2 else 1.0)
    return np.hypot(statistics(runs, preset, DAMPED)[:, row, 1], own)


def effects(preset: str, row: int) -> dict[str, Callable[[Runs], float]]:
    """The numbers that the reasons and notes of a row name."""
    return {
        "drift": lambda runs: heading_drift(runs, preset),
        "referenced": lambda runs: float(np.mean(referenced(runs, preset, row))),
        "all": lambda runs: float(np.mean(spread_with(runs, preset, row))),
        "less": lambda runs: float(np.mean(spread_with(runs, preset, row, BIASED_20))),
        "north_up": lambda runs: float(np.mean(spread_with(runs, preset, row, NORTH_UP))),
        "unbiased": lambda runs: float(np.mean(spread_with(runs, preset, row, UNBIASED))),
    }
