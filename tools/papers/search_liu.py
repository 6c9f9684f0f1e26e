"""Searches over what Liu 2021 does not print: networks, switching, gyros, the log's error and its changes."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np

from navcore.analysis import frequency_response
from navcore.engine.simulation import simulate
from navcore.foundation.earth import SPHERE
from navcore.foundation.units import HOUR
from navcore.mechanization.recorder import POSITION
from navcore.networks import parse_network
from navcore.scenario.model import Scenario
from tools.papers.liu_days import scenario_of_days
from tools.papers.liu_switching import (
    NOVEL,
    PRESET,
    errors,
    fig_7,
    lasting,
    overshoot,
    sea,
    turns,
    with_events,
)
from tools.papers.measure import rms
from tools.papers.runs import Runs, scenario_of
from tools.papers.search import Search

Numbers = dict[str, tuple[float, ...]]

# ---------------------------------------------------------------- figures 3 and 5

ZETAS, GAIN_ETAS = (0.1, 0.3, 0.5, 0.7, 0.9, 1.3), (0.1, 0.3, 0.5, 1.0, 2.0)


def _gains(runs: Runs) -> Numbers:
    """Numbers of the six claims: of figure 3 with a zeta and an eta, of figure 5 with the same eta."""
    del runs
    found: Numbers = {}
    grid = np.logspace(-2.0, 2.0, 201)
    classic = transfer_gain('id = "classic3"', np.array([10.0, 0.1]))
    for zeta, eta in product(ZETAS, GAIN_ETAS):
        high, low, least, most = transfer_gain(_complementary(zeta, eta), np.array([10.0, 0.1, 0.01, 100.0]))
        wide, narrow = (
            transfer_gain(_complementary(value, eta), np.append(grid, 10.0)) for value in (0.9, 0.1)
        )
        better = 20.0 * np.log10(classic / np.array([high, low]))
        slopes = 20.0 * np.log10([low / least, high / most])
        peaks, tail = wide[:-1].max() / narrow[:-1].max(), wide[-1] / narrow[-1]
        found[f"zeta = {zeta}, eta = {eta}"] = (*better, *slopes, peaks, tail)
    return found


def _complementary(zeta: float, eta: float) -> str:
    return f'id = "complementary", zeta = {zeta}, eta = {eta}'


def transfer_gain(text: str, frequency: np.ndarray) -> np.ndarray:
    """|phi / dV_r| at frequencies in Schuler frequencies, s/m."""
    omega_s = SPHERE.schuler_frequency(0.0)
    transfer = parse_network(text).transfer(omega_s)
    return np.abs(frequency_response(transfer, "dv_r", "phi", frequency * omega_s))


GAINS_SEARCH = Search(
    "zeta 0.1 to 1.3 and eta 0.1 to 2, though figure 3 has 0.7 and 0.5.", (1, 2, 3, 4, 5, 6), _gains
)

# ---------------------------------------------------------------- figure 7

FORMS: dict[str, dict[str, Any]] = {
    "hard": {"id": "hard"},
    "keep": {"id": "keep"},
    "ramp of 50 s": {"id": "ramp"},
    "ramp of 200 s": {"id": "ramp", "duration_s": 200.0},
    "Liu 19 with the ramp": {"id": "ramp", "form": "as_printed"},
}
ETAS = (0.3, 0.5, 1.0)


def _figure_7(runs: Runs) -> Numbers:
    """Overshoot of the switch over that of a step of 0.25 m/s."""

    def make() -> Numbers:
        base = fig_7(runs).scenario.canonical()
        step = base["method"][0]
        found: Numbers = {}
        for eta, (form, switching) in product(ETAS, FORMS.items()):
            network = {"id": "complementary", "zeta": 0.5, "eta": eta}
            log = {**base["reference"], "outage": [{"t_h": 10.0, "duration_s": 200.0}]}
            switched = {**step, "name": "switch", "event": [], "network": network, "switching": switching}
            run = simulate(Scenario.parse({**base, "reference": log, "method": [switched]}))
            stepped = simulate(Scenario.parse({**base, "method": [{**step, "network": network}]}))
            ratio = overshoot(run) / overshoot(stepped)
            found[f"eta = {eta}, {form}"] = (ratio,)
        return found

    return runs.keep("search: liu fig 7", make)


FIG_7_SEARCH = Search(
    "eta 0.3 to 1 and the switching (at once with a cleared or a kept network, a ramp of 50 or 200 s, Liu "
    "19); the standing 0.5 m/s, zeta = 0.5 and the 200 s are printed.",
    (1,),
    _figure_7,
)

# ---------------------------------------------------------------- figures 11 and 12

DAYS_SEEDS = range(1, 4)
BIASES_DPH = (0.0001, 0.0003, 0.0005, 0.001, 0.002)
ARWS_DPSH = (0.0005, 0.002, 0.005)
DAY_S = 24.0 * HOUR


def days(seed: int, bias_dph: float, arw_dpsh: float) -> list[float]:
    """Numbers of the four claims with other gyros."""
    gyros = {"gyro_bias_dph": [bias_dph] * 3, "gyro_arw_dpsh": arw_dpsh}
    run = simulate(scenario_of_days(seed, gyros))
    first, last = (
        {one.method.name: rms(one.rows[(one.t_s >= a) & (one.t_s <= b), POSITION]) for one in run.methods}
        for a, b in ((0.0, DAY_S), (4.0 * DAY_S, 5.0 * DAY_S))
    )
    ours = last["complementary"]
    growths = [last[name] / first[name] for name in ("free", "complementary")]
    return [*growths, ours / last["classic2"], ours / last["classic3"]]


def _five_days(runs: Runs) -> Numbers:
    def make() -> Numbers:
        return {
            f"gyros of {bias} deg/h and {arw} deg/sqrt(h)": tuple(
                np.mean([days(seed, bias, arw) for seed in DAYS_SEEDS], axis=0)
            )
            for bias, arw in product(BIASES_DPH, ARWS_DPSH)
        }

    return runs.keep("search: liu days", make)


DAYS_SEARCH = Search(
    f"bias of the gyros ({BIASES_DPH[0]} to {BIASES_DPH[-1]} deg/h) and their random walk ({ARWS_DPSH[0]} to "
    f"{ARWS_DPSH[-1]} deg/sqrt(h)), {len(DAYS_SEEDS)} seeds each.",
    (1, 2, 3, 4),
    _five_days,
)

# ---------------------------------------------------------------- tables 1 to 3

SEA_SEEDS = range(1, 4)
STANDING_MPS = (0.0, 0.25, 0.5)
SIZES = (0.5, 1.0, 2.0)
"""Size of the log's changes over those of the preset."""
GYROS_DPH = (0.0001, 0.001, 0.003)
BASELINES = {"hard": {"id": "hard"}, "Liu 19": {"id": "ramp", "form": "as_printed"}}
"""How constant and traditional damping switch; "hard" as in the preset."""


def at_sea(seed: int, standing: float, size: float, gyro_dph: float) -> dict[str, np.ndarray]:
    """RMS of position and velocity of each method, the traditional one with both switchings."""
    scenario = sea(seed)
    data = scenario_of(PRESET, [f"run.seed={seed}", "run.output_step_s=120"]).canonical()
    listed = {one["name"]: one for one in scenario.canonical()["method"]}
    chosen = [listed[name] for name in ("free", "constant", NOVEL)]
    chosen += [{**listed["yaw_rate"], "name": name, "switching": how} for name, how in BASELINES.items()]
    data["method"] = chosen
    data["imu"]["gyro_bias_dph"] = [gyro_dph] * 3
    scale = standing / 0.5
    data["reference"]["bias_mps"] = [scale * value for value in data["reference"]["bias_mps"]]
    events = [
        {**event, "accel_mps2": [size * value for value in event["accel_mps2"]]}
        for event in lasting(seed, turns(scenario))
    ]
    run = simulate(with_events(Scenario.parse(data), events))
    return dict(zip((one.method.name for one in run.methods), errors(run), strict=True))


def _tables(runs: Runs) -> Numbers:
    """Numbers of claims 1, 2, 3, 6 and 7."""

    def make() -> Numbers:
        found: Numbers = {}
        for standing, size, gyro in product(STANDING_MPS, SIZES, GYROS_DPH):
            by_seed = [at_sea(seed, standing, size, gyro) for seed in SEA_SEEDS]
            for name in BASELINES:
                rows = [
                    (
                        e[NOVEL][0] / e["constant"][0],
                        e[NOVEL][0] / e[name][0],
                        e[name][0] / e["constant"][0],
                        e[NOVEL][1] / e["constant"][1],
                    )
                    for e in by_seed
                ]
                pairs = [(e["constant"][0], e["free"][0]) for e in by_seed]
                better = 20.0 * np.mean([constant < undamped for constant, undamped in pairs])
                setting = (
                    f"{standing} m/s standing, changes {size} times as large, gyros of {gyro} deg/h, "
                    f"traditional switched {'at once' if name == 'hard' else 'by Liu 19'}"
                )
                found[setting] = (*np.mean(rows, axis=0), float(better))
        return found

    return runs.keep("search: liu tables", make)


TABLES_SEARCH = Search(
    "standing error of the log (0 to 0.5 m/s), size of its changes (0.5 to 2 times), bias of the gyros "
    "(1e-4 to 0.003 deg/h), and whether the traditional method switches at once or by Liu 19, "
    f"{len(SEA_SEEDS)} seeds each.",
    (1, 2, 3, 6, 7),
    _tables,
)
