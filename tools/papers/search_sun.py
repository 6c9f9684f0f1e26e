"""Searches over what Sun 2017 does not print: moments, poles, the setting of equation 8."""

from __future__ import annotations

from typing import Any

import numpy as np

from navcore.analysis import analyse
from navcore.design.sun import TuningSettings, sun_scenario, tune_table
from navcore.engine.simulation import simulate
from navcore.foundation.earth import SPHERE
from navcore.foundation.units import HOUR
from navcore.mechanization.recorder import PHI_N
from navcore.networks import parse_network
from tools.papers.measure import peak
from tools.papers.runs import Runs, method, scenario_of
from tools.papers.search import Axis, Search, Setting

OMEGA_S = SPHERE.schuler_frequency(0.0)
SCHULER_S = 2.0 * np.pi / OMEGA_S

# ---------------------------------------------------------------- figure 4

TILT, SPEED, MOMENT = "initial tilt", "initial velocity error", "switched on after"
MOMENTS = 24
STEP_AXES = (
    Axis(TILT, {"0": 0.0, "1 arcmin": 1.0, "6 arcmin": 6.0}),
    Axis(SPEED, {"0": 0.0, "0.1 m/s": 0.1, "0.5 m/s": 0.5}),
    Axis(
        MOMENT,
        {
            f"{moment / HOUR:.2f} h": moment
            for moment in (6.0 * HOUR + SCHULER_S * np.arange(MOMENTS) / MOMENTS)
        },
    ),
)


def _figure_4(runs: Runs, setting: Setting) -> tuple[float]:
    """Roll error after the switch over the oscillation before it."""
    del runs
    tilt, speed, moment = setting[TILT], setting[SPEED], setting[MOMENT]
    given = (
        f"reference.outage.0.duration_s={round(moment)}",
        f"initial_error.attitude_arcmin=[{tilt},{tilt},0]",
        f"initial_error.velocity_mps=[{speed},{speed}]",
        "run.duration_h=10",
    )
    one = method(simulate(scenario_of("sun-step", given)), "classic3")
    roll = one.rows[:, PHI_N]
    return (peak(one.t_s, roll, moment) / peak(one.t_s, roll, moment - SCHULER_S, moment),)


STEP_SEARCH = Search(STEP_AXES, (3,), _figure_4, remark="The preset has 0.1 deg of tilt (Sun 5.1).")

# ---------------------------------------------------------------- table 1 with (18)

N1, N2 = "n1 =", "n2 ="
POLE_AXES = (
    Axis(N1, {f"{n:g}": n for n in (6.0, 8.0, 10.0, 14.0, 20.0, 30.0)}),
    Axis(N2, {f"{n:g}": n for n in (2.0, 3.0, 5.0, 8.0, 12.0)}),
)
TABLE_XI = (0.04, 0.05, 0.08, 0.10, 0.12, 0.22, 0.44, 0.64, 0.82, 0.99)


def _poles(runs: Runs, setting: Setting) -> tuple[float, float] | None:
    """Numbers of claims 2 and 3 for other n1 and n2."""
    del runs
    n1, n2 = setting[N1], setting[N2]
    if n1 <= n2 or (n1 - n2) ** 2 + 4.0 <= 4.0 * (n1 + n2):  # Sun 19: w1, w2 must be real
        return None

    def damping(xi: float) -> float:
        network = parse_network({"id": "pole2", "xi": xi, "n1": n1, "n2": n2, "variant": "as_printed"})
        return analyse(network.transfer(OMEGA_S)).damping_ratio

    return damping(0.5), float(sum(damping(xi) < 0.0 for xi in TABLE_XI))


LAW_SEARCH = Search(
    POLE_AXES,
    (2, 3),
    _poles,
    remark="Sun recommends 14 and 5. Claim 1 is a formula: it leaves nothing to search.",
)

# ---------------------------------------------------------------- equation 8

NETWORKS: dict[str, dict[str, Any]] = {
    "pole2 as printed": {"id": "pole2", "variant": "as_printed"},
    "complementary": {"id": "complementary"},
}
HOURS, GYROS, START, NOISE = "duration", "gyros of", "initial tilt", "noise of the log"
EQUATION_8_AXES = (
    Axis(HOURS, {"6 h": 6.0, "24 h": 24.0}),
    Axis(
        GYROS,
        {
            "0.006, 0.006, 0.001 deg/h": (0.006, 0.006, 0.001),
            "0": (0.0, 0.0, 0.0),
            "0.06, 0.06, 0.01 deg/h": (0.06, 0.06, 0.01),
        },
    ),
    Axis(START, {"0": 0.0, "6 arcmin": 6.0}),
    Axis(NOISE, {"0": 0.0, "0.1 m/s": 0.1, "0.5 m/s": 0.5}),
)


def _best(network: dict[str, Any], setting: Setting, seed: int) -> float:
    """Best coefficient without a difference."""
    base = sun_scenario().canonical()
    base["run"] |= {"duration_h": setting[HOURS], "seed": seed}
    base["imu"] |= {"gyro_bias_dph": list(setting[GYROS])}
    base["reference"] |= {"noise_mps": setting[NOISE]}
    base["initial_error"] |= {"attitude_arcmin": [setting[START], setting[START], 0.0]}
    settings = TuningSettings.model_validate({"step": 0.1, "differences_kn": [0.0, 3.0], "network": network})
    rows = tune_table(type(sun_scenario()).parse(base), settings).pairs()
    return float(rows[0][1])


def _equation_8(runs: Runs, setting: Setting) -> tuple[np.ndarray, ...] | None:
    """Best coefficient without a difference: with Sun's network, and with the complementary one."""
    if not (any(setting[GYROS]) or setting[NOISE] or setting[START]):
        return None
    seeds = EQUATION_8_SEEDS if setting[NOISE] else range(1, 2)

    def make() -> tuple[np.ndarray, ...]:
        return tuple(
            np.array([_best(network, setting, seed) for seed in seeds]) for network in NETWORKS.values()
        )

    return runs.keep(("search: sun equation 8", *setting.values()), make)


EQUATION_8_SEEDS = range(1, 21)
EQUATION_8_SEARCH = Search(
    EQUATION_8_AXES,
    (1, 2),
    _equation_8,
    len(EQUATION_8_SEEDS),
    "The coefficient in steps of 0.1; without noise nothing is random.",
)
