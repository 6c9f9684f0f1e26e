"""Deng 2019: whether the Foucault oscillation disappears, which his 1.5 h are too short to show."""

import numpy as np

from navcore.averaging.lines import line_amplitudes, line_phases
from navcore.engine.simulation import simulate
from navcore.foundation.earth import EARTH_RATE
from navcore.foundation.units import DEG, HOUR
from navcore.mechanization.recorder import DV_N, POSITION
from tools.papers.claim import Claim, at_most
from tools.papers.deng_errors import DAMPED, SEEDS
from tools.papers.runs import Runs, scenario_of

PRESET, LONG_H = "deng-static", 48.0
LINEAR = (
    "run.fidelity=error_model",
    "run.vertical=locked",
    f"run.duration_h={LONG_H}",
    "run.step_s=0.2",
    "run.output_step_s=60",
    "reference.rate_hz=5",
    f"reference.noise_mps={0.2 * (5.0 / 200.0) ** 0.5}",
)
"""The preset in the error model for two days; the log's noise has the same density at 5 Hz."""
START = {"attitude_arcmin": [0.17, -0.2, 4.5]}
"""Errors that the alignment leaves on the average, in place of the simulated alignment."""

_COMPARED = ("free", DAMPED)
"""Names of the methods whose lines are compared."""


def both_lines(runs: Runs) -> np.ndarray:
    """Both Schuler lines of dV_N, whose beat is the Foucault oscillation, damped over free: (seeds, 2)."""

    def one(seed: int) -> list[float]:
        methods = scenario_of(PRESET).canonical()["method"]
        chosen = [method for method in methods if method["name"] in _COMPARED]
        run = simulate(
            scenario_of(
                PRESET, (*LINEAR, f"run.seed={seed}"), method=chosen, alignment={}, initial_error=START
            )
        )
        phases = line_phases(run.t_s, run.truth, run.scenario.earth)
        free, damped = (
            line_amplitudes(each.t_s, each.rows[:, :POSITION], phases).amplitude[DV_N, :2]
            for each in run.methods
        )
        return list(damped / free)

    return runs.keep("deng foucault", lambda: np.array([one(seed) for seed in SEEDS]))


def period_h(runs: Runs) -> float:
    """Foucault period at the site, h."""
    del runs
    latitude = scenario_of(PRESET).site.lat_deg * DEG
    return 2.0 * np.pi / (EARTH_RATE * np.sin(latitude)) / HOUR


FOUCAULT = Claim(
    "the Foucault oscillation has disappeared: the larger of the two Schuler lines of V_N whose beat it is, "
    "damped "
    f"over free, in {LONG_H:g} h",
    "none",
    at_most(0.01),
    lambda runs: both_lines(runs).max(axis=1),
    note="The paper shows 1.5 h, {share} % of the Foucault period of {period} h at this latitude, and a beat "
    "of {period} h cannot be seen in it; ours is the linear model over two days.",
    facts={"period": period_h, "share": lambda runs: 100.0 * 1.5 / period_h(runs)},
    quote="it can be found that Schuler oscillation and Foucault oscillation disappeared",
)
