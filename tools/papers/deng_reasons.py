"""Deng 2019: why rows of its tables differ, and the effect of what each reason names."""

from collections.abc import Callable

import numpy as np

from navcore.foundation.units import DEG, MINUTE
from tools.papers.deng_errors import DAMPED, ROWS, SEEDS, errors, statistics
from tools.papers.runs import Runs, method

_HEADING = (
    "0.02 deg/h and 0.006 deg/sqrt(h) turn the heading by {drift} deg within a run (mean over the seeds), "
    "and the heading is not damped (nor is the paper's): the sensors that the paper states cannot cause the "
    "spread of its heading."
)
_REFERENCE = (
    "the reference of the drive is itself good to 0.01 deg (table 3): added in squares to ours it leaves "
    "{referenced} deg, which lies in the range."
)
_CAR = (
    "the reference of the drive, good to 0.01 deg (divided by cos L in heading), explains little of it: "
    "added in squares to ours it leaves {referenced} deg. What else the real car adds is not printed."
)
_VERTICAL = (
    "the damping of the vertical channel is not printed. Here an ideal altimeter damps it, and the bias of "
    "the accelerometers moves the vertical velocity until that loop has found it: without the bias the "
    "spread is {unbiased} m/s, and with it {late} m/s after the first {settled} min."
)
_TURNED = (
    "the log measures in the axes of the vehicle and is turned by the computed heading, so that the heading "
    "error of the alignment times the speed appears in the velocity and adds up in the position. It differs "
    "from seed to seed; the paper shows one drive after one alignment. With a log in east and north the "
    "spread is {north_up} m."
)


WHY_1 = {"heading": _HEADING, "V_U": _VERTICAL}
"""Why a row of table 1 differs, by its name; so do the rows of table 2."""
WHY_4 = {
    "pitch": _REFERENCE,
    **dict.fromkeys(("roll", "heading"), _CAR),
    **dict.fromkeys(("longitude", "latitude"), _TURNED),
}


def heading_drift(runs: Runs, preset: str) -> float:
    """Range of the heading error within a run, deg, mean over the seeds."""
    return float(np.mean([np.ptp(errors(runs, preset, DAMPED, seed)[:, 2]) for seed in SEEDS]))


SETTLED_MIN = 20
"""By then the loop of the altimeter, 100 s, is in its steady state."""
UNBIASED = "imu.accel_bias_ug=[0,0,0]"
NORTH_UP = 'reference.frame="enu"'


def vertical_spread(runs: Runs, preset: str, *overrides: str, from_min: float = 0.0) -> float:
    """Spread of the vertical velocity from some minutes on, m/s."""
    values = errors(runs, preset, DAMPED, 1, *overrides)[:, ROWS.index("V_U, m/s")]
    t_min = method(runs(preset, "run.seed=1", *overrides), DAMPED).t_s / MINUTE
    return float(values[t_min >= from_min].std())


def north_up_spread(runs: Runs, preset: str, row: int) -> float:
    """Spread of a row with the log in east and north, mean over three seeds."""
    return float(np.mean([errors(runs, preset, DAMPED, seed, NORTH_UP)[:, row].std() for seed in (1, 2, 3)]))


REFERENCE_DEG = 0.01
"""What Deng's table 3 states for the reference of the drive: pitch and roll; heading divided by cos L."""


def with_reference(runs: Runs, preset: str, row: int) -> float:
    """Spread of an angle (row 0 to 2) with the error of the paper's reference added in squares, deg."""
    latitude = runs(preset, "run.seed=1").scenario.site.lat_deg * DEG
    own = REFERENCE_DEG / (float(np.cos(latitude)) if row == 2 else 1.0)
    return float(np.hypot(np.mean(statistics(runs, preset, DAMPED)[:, row, 1]), own))


def effects(preset: str, row: int) -> dict[str, Callable[[Runs], float]]:
    """The numbers that the reasons of a row name."""
    return {
        "drift": lambda runs: heading_drift(runs, preset),
        "referenced": lambda runs: with_reference(runs, preset, row),
        "unbiased": lambda runs: vertical_spread(runs, preset, UNBIASED),
        "late": lambda runs: vertical_spread(runs, preset, from_min=SETTLED_MIN),
        "settled": lambda runs: SETTLED_MIN,
        "north_up": lambda runs: north_up_spread(runs, preset, row),
    }
