"""Searches over what Zha 2019 does not print: the end of a transient, tilts, and the drives."""

from __future__ import annotations

import numpy as np

from navcore.analysis import initial_tilt_response
from navcore.engine.simulation import simulate
from navcore.foundation.earth import SPHERE
from navcore.foundation.units import DEG, MINUTE
from navcore.mechanization.recorder import DV_E, DV_N, PHI_E
from navcore.networks import parse_network
from tools.papers.measure import last_above
from tools.papers.runs import Runs, method, scenario_of
from tools.papers.search import Axis, Search, Setting

OMEGA_S = SPHERE.schuler_frequency(0.0)

# ---------------------------------------------------------------- figure 1 and section 3

FAST, CLASSIC = 'id = "compass", sigma = 0.0088, xi = 0.7', 'id = "classic2"'
END, CAUSE = "ended at", "the transient of"
DRIFT, TILT = "the gyro drift", "an initial tilt"
SETTLING_AXES = (
    Axis(
        END, {f"{100.0 * share:g} % of its peak": share for share in (0.001, 0.002, 0.005, 0.01, 0.02, 0.05)}
    ),
    Axis(CAUSE, {DRIFT: DRIFT, TILT: TILT}),
)


def _settling(runs: Runs, setting: Setting) -> tuple[float, ...]:
    """Minutes of claims 1 to 4, by where the transient ends and what causes it."""
    time_s = np.arange(0.0, 36000.0)
    fraction = setting[END]

    def tilt(text: str) -> float:
        response = initial_tilt_response(parse_network(text).transfer(OMEGA_S), time_s)
        return last_above(time_s, response, fraction) / MINUTE

    def drift(name: str) -> float:
        one = method(runs("zha-fast", "run.output_step_s=1"), name)
        return last_above(one.t_s, one.rows[:, PHI_E], fraction, float(one.rows[-1, PHI_E])) / MINUTE

    by_drift = setting[CAUSE] == DRIFT
    fast, classic = (drift("fast"), drift("classic2")) if by_drift else (tilt(FAST), tilt(CLASSIC))
    return fast, tilt(FAST), classic, classic


SETTLING_SEARCH = Search(
    SETTLING_AXES,
    (1, 2, 3, 4),
    _settling,
    remark="Claims 5 and 6 leave nothing to search: they are formulas.",
)

# ---------------------------------------------------------------- tables 1 and 2

BIAS, SIGNS, START, NOISE = (
    "accelerometers of",
    "signs of their biases x, y",
    "initial tilt",
    "noise of the GPS velocity",
)
LEVELLED = "that levelling leaves"
DRIVE_AXES = (
    Axis(BIAS, {"50 ug": 50.0, "150 ug": 150.0, "500 ug": 500.0}),
    Axis(SIGNS, {"++": (1, 1), "+-": (1, -1)}),
    Axis(START, {LEVELLED: None, "5 arcmin about east": (5.0, 0.0), "5 arcmin about north": (0.0, 5.0)}),
    Axis(NOISE, {"0.05 m/s": 0.05, "0.2 m/s": 0.2}),
)
DRIVES, SEEDS_A_DRIVE = ("zha-drive", *(f"zha-drive-{drive}" for drive in range(2, 7))), 4


def zha_drive_overrides(preset: str, setting: Setting) -> tuple[str, ...]:
    """Overrides of a drive for a setting."""
    x, y = (setting[BIAS] * sign for sign in setting[SIGNS])
    tilt = setting[START]
    if tilt is None:
        heading = scenario_of(preset).canonical()["motion"]["leg"][0]["heading_deg"] * DEG
        east, north = (
            x * np.cos(heading) + y * np.sin(heading),
            y * np.cos(heading) - x * np.sin(heading),
        )
        arcmin = 1e-6 / DEG * 60.0
        tilt = (-north * arcmin, east * arcmin)
    return (
        f"imu.accel_bias_ug=[{x},{y},0]",
        f"initial_error.attitude_arcmin=[{tilt[0]:.4f},{tilt[1]:.4f},0]",
        f"reference.noise_mps={setting[NOISE]}",
    )


def _drives(runs: Runs, setting: Setting) -> tuple[np.ndarray, ...]:
    """Ratios of claims 1 to 4, over all drives and seeds."""

    def make() -> tuple[np.ndarray, ...]:
        rows = []
        for drive, preset in enumerate(DRIVES, 1):
            given = zha_drive_overrides(preset, setting)
            for k in range(SEEDS_A_DRIVE):
                run = simulate(scenario_of(preset, (f"run.seed={drive + 6 * k}", *given)))
                free, classic, fast = (
                    np.std(method(run, name).rows[:, [DV_E, DV_N]], axis=0)
                    for name in ("free", "classic2", "fast")
                )
                rows.append([*(classic / free), *(fast / classic)])
        return tuple(np.array(rows).T)

    return runs.keep(("search: zha drives", *setting.values()), make)


DRIVE_SEARCH = Search(
    DRIVE_AXES,
    (1, 2, 3, 4),
    _drives,
    len(DRIVES) * SEEDS_A_DRIVE,
    "5e-4 g is printed as the bias of the accelerometers. The seeds are those of six drives, which are ours.",
)
