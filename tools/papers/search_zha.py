"""Searches over what Zha 2019 does not print: the end of a transient, tilts, and the drives."""

from __future__ import annotations

from itertools import product

import numpy as np

from navcore.analysis import initial_tilt_response
from navcore.engine.simulation import simulate
from navcore.foundation.earth import SPHERE
from navcore.foundation.units import MINUTE
from navcore.mechanization.recorder import DV_E, DV_N, PHI_E
from navcore.networks import parse_network
from tools.papers.measure import last_above
from tools.papers.runs import Runs, method, scenario_of
from tools.papers.search import Search

Numbers = dict[str, tuple[float, ...]]
OMEGA_S = SPHERE.schuler_frequency(0.0)

# ---------------------------------------------------------------- figure 1 and section 3

FRACTIONS = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05)
FAST, CLASSIC = 'id = "compass", sigma = 0.0088, xi = 0.7', 'id = "classic2"'


def _settling(runs: Runs) -> Numbers:
    """Minutes of claims 1 to 4, by where the transient ends and what causes it."""

    def make() -> Numbers:
        time_s = np.arange(0.0, 36000.0)
        tilts = {
            name: initial_tilt_response(parse_network(text).transfer(OMEGA_S), time_s)
            for name, text in (("fast", FAST), ("classic2", CLASSIC))
        }
        run = runs("zha-fast", "run.output_step_s=1")
        drifts = {name: method(run, name) for name in tilts}

        def drift(name: str, fraction: float) -> float:
            one = drifts[name]
            return last_above(one.t_s, one.rows[:, PHI_E], fraction, float(one.rows[-1, PHI_E])) / MINUTE

        def tilt(name: str, fraction: float) -> float:
            return last_above(time_s, tilts[name], fraction) / MINUTE

        found: Numbers = {}
        for fraction, (cause, ended) in product(
            FRACTIONS, (("the gyro drift", drift), ("an initial tilt", tilt))
        ):
            classic = ended("classic2", fraction)
            name = f"the transient of {cause}, ended at {100.0 * fraction:g} % of its peak"
            found[name] = (ended("fast", fraction), tilt("fast", fraction), classic, classic)
        return found

    return runs.keep("search: zha settling", make)


SETTLING_SEARCH = Search(
    "where a transient is called ended (0.1 to 5 % of its peak), and whether a gyro drift or an initial "
    "tilt causes it. Claims 5 and 6 leave nothing to search: they are formulas.",
    (1, 2, 3, 4),
    _settling,
)

# ---------------------------------------------------------------- tables 1 and 2

DRIVE_SEEDS = (1, 2)
BIASES_UG = (50.0, 150.0, 500.0)
SIGNS = ((1, 1), (1, -1), (-1, 1))
TILTS_ARCMIN = ((0.0, 0.0), (-1.7, 1.7), (5.0, 0.0), (0.0, 5.0))
NOISES_MPS = (0.05, 0.2)


def _drives(runs: Runs) -> Numbers:
    """Ratios of claims 1 to 4."""

    def make() -> Numbers:
        found: Numbers = {}
        for bias, signs, tilt, noise in product(BIASES_UG, SIGNS, TILTS_ARCMIN, NOISES_MPS):
            rows = []
            for seed in DRIVE_SEEDS:
                given = (
                    f"run.seed={seed}",
                    f"imu.accel_bias_ug=[{bias * signs[0]},{bias * signs[1]},0]",
                    f"initial_error.attitude_arcmin=[{tilt[0]},{tilt[1]},0]",
                    f"reference.noise_mps={noise}",
                )
                run = simulate(scenario_of("zha-drive", given))
                free, classic, fast = (
                    np.std(method(run, name).rows[:, [DV_E, DV_N]], axis=0)
                    for name in ("free", "classic2", "fast")
                )
                rows.append([*(classic / free), *(fast / classic)])
            name = (
                f"accelerometers of {bias * signs[0]:g} and {bias * signs[1]:g} ug, {tilt[0]:g} and "
                f"{tilt[1]:g} arcmin at the start, GPS velocity with {noise} m/s"
            )
            found[name] = tuple(np.mean(rows, axis=0))
        return found

    return runs.keep("search: zha drives", make)


DRIVE_SEARCH = Search(
    "accelerometer biases (50 to 500 ug, though 5e-4 g is printed; three patterns of signs), initial tilt "
    f"(four), noise of the GPS velocity (0.05 and 0.2 m/s), {len(DRIVE_SEEDS)} seeds each; the drive is "
    "ours.",
    (1, 2, 3, 4),
    _drives,
)
