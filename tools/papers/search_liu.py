"""Searches over what Liu 2021 does not print: networks, switching, gyros, the log's error and its changes."""

from __future__ import annotations

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
    SEEDS,
    errors,
    fig_7,
    largest,
    lasting,
    overshoot,
    sea,
    turns,
    with_events,
)
from tools.papers.measure import peak_gain, rms
from tools.papers.runs import Runs, scenario_of
from tools.papers.search import Axis, Search, Setting

# ---------------------------------------------------------------- figures 3 and 5

ZETA, ETA = "zeta", "eta"
GAIN_AXES = (
    Axis(ZETA, {f"{zeta}": zeta for zeta in (0.1, 0.3, 0.5, 0.7, 0.9, 1.3)}),
    Axis(ETA, {f"{eta}": eta for eta in (0.1, 0.3, 0.5, 1.0, 2.0)}),
)


def _gains(runs: Runs, setting: Setting) -> tuple[float, ...]:
    """Numbers of the six claims: of figure 3 with a zeta and an eta, of figure 5 with the same eta."""
    del runs
    eta, grid = setting[ETA], np.logspace(-2.0, 2.0, 201)
    classic = transfer_gain('id = "classic3"', np.array([10.0, 0.1]))
    chosen = _complementary(setting[ZETA], eta)
    high, low, least, most = transfer_gain(chosen, np.array([10.0, 0.1, 0.01, 100.0]))
    better = 20.0 * np.log10(classic / np.array([high, low]))
    slopes = 20.0 * np.log10([low / least, high / most])
    texts = (_complementary(0.9, eta), _complementary(0.1, eta))
    wide, narrow = (peak_gain(lambda p, text=text: transfer_gain(text, p), grid) for text in texts)
    tails = [float(transfer_gain(text, np.array([10.0]))[0]) for text in texts]
    return (*better, *slopes, wide / narrow, tails[0] / tails[1])


def _complementary(zeta: float, eta: float) -> str:
    return f'id = "complementary", zeta = {zeta}, eta = {eta}'


def transfer_gain(text: str, frequency: np.ndarray) -> np.ndarray:
    """|phi / dV_r| at frequencies in Schuler frequencies, s/m."""
    omega_s = SPHERE.schuler_frequency(0.0)
    transfer = parse_network(text).transfer(omega_s)
    return np.abs(frequency_response(transfer, "dv_r", "phi", frequency * omega_s))


GAINS_SEARCH = Search(GAIN_AXES, (1, 2, 3, 4, 5, 6), _gains, remark="Figure 3 has 0.7 and 0.5.")

# ---------------------------------------------------------------- figure 7

FORMS: dict[str, dict[str, Any]] = {
    "hard": {"id": "hard"},
    "keep": {"id": "keep"},
    "ramp of 50 s": {"id": "ramp"},
    "ramp of 200 s": {"id": "ramp", "duration_s": 200.0},
    "Liu 19 with the ramp": {"id": "ramp", "form": "as_printed"},
}
FORM = "switching"
FIG_7_AXES = (
    Axis(ETA, {f"{eta}": eta for eta in (0.3, 0.5, 1.0)}),
    Axis(FORM, {name: name for name in FORMS}),
)


def _figure_7(runs: Runs, setting: Setting) -> tuple[float]:
    """Overshoot of the switch over that of a step of 0.25 m/s."""
    base = fig_7(runs).scenario.canonical()
    step = base["method"][0]
    network = {"id": "complementary", "zeta": 0.5, "eta": setting[ETA]}
    log = {**base["reference"], "outage": [{"t_h": 10.0, "duration_s": 200.0}]}
    switched = {**step, "name": "switch", "event": [], "network": network, "switching": FORMS[setting[FORM]]}
    run = simulate(Scenario.parse({**base, "reference": log, "method": [switched]}))
    stepped = simulate(Scenario.parse({**base, "method": [{**step, "network": network}]}))
    return (overshoot(run) / overshoot(stepped),)


FIG_7_SEARCH = Search(
    FIG_7_AXES, (1,), _figure_7, remark="The standing 0.5 m/s, zeta = 0.5 and the 200 s are printed."
)

# ---------------------------------------------------------------- figures 11 and 12

BIAS, ARW = "gyros of", "and"
DAYS_AXES = (
    Axis(BIAS, {f"{bias} deg/h": bias for bias in (0.0001, 0.0005, 0.001)}),
    Axis(ARW, {f"{arw} deg/sqrt(h)": arw for arw in (0.0005, 0.005)}),
)
DAY_S = 24.0 * HOUR


def days(seed: int, bias_dph: float, arw_dpsh: float) -> list[float]:
    """Numbers of the five claims with other gyros."""
    gyros = {"gyro_bias_dph": [bias_dph] * 3, "gyro_arw_dpsh": arw_dpsh}
    run = simulate(scenario_of_days(seed, gyros))
    first, last = (
        {one.method.name: rms(one.rows[(one.t_s >= a) & (one.t_s <= b), POSITION]) for one in run.methods}
        for a, b in ((0.0, DAY_S), (4.0 * DAY_S, 5.0 * DAY_S))
    )
    ours = last["complementary"]
    growths = [last[name] / first[name] for name in ("free", "complementary")]
    return [*growths, *(ours / last[name] for name in ("classic2", "classic3", "free"))]


def _five_days(runs: Runs, setting: Setting) -> tuple[np.ndarray, ...]:
    bias, arw = setting[BIAS], setting[ARW]
    return runs.keep(
        ("search: liu days", bias, arw),
        lambda: tuple(np.array([days(seed, bias, arw) for seed in SEEDS]).T),
    )


DAYS_SEARCH = Search(DAYS_AXES, (1, 2, 3, 4, 5), _five_days, len(SEEDS))

# ---------------------------------------------------------------- tables 1 to 3

STANDING, SIZE, GYRO, BASELINE = (
    "standing error of the log",
    "changes over those of the preset",
    "gyros of",
    "traditional switched",
)
BASELINES = {"at once": {"id": "hard"}, "by Liu 19": {"id": "ramp", "form": "as_printed"}}
"""How traditional damping switches; at once in the preset."""
TABLES_AXES = (
    Axis(STANDING, {"0": 0.0, "0.25 m/s": 0.25, "0.5 m/s": 0.5}),
    Axis(SIZE, {"0.5": 0.5, "1": 1.0, "2": 2.0}),
    Axis(GYRO, {"0.0001 deg/h": 0.0001, "0.001 deg/h": 0.001}),
    Axis(BASELINE, {name: name for name in BASELINES}),
)


def at_sea_scenario(seed: int, standing: float, size: float, gyro_dph: float) -> Scenario:
    """The case at sea with another standing error, other sizes of its changes, and other gyros."""
    scenario = sea(seed)
    data = scenario_of(PRESET, [f"run.seed={seed}", "run.output_step_s=120"]).canonical()
    listed = {one["name"]: one for one in scenario.canonical()["method"]}
    chosen = [listed[name] for name in ("constant", NOVEL)]
    chosen += [{**listed["yaw_rate"], "name": name, "switching": how} for name, how in BASELINES.items()]
    data["method"] = chosen
    data["imu"]["gyro_bias_dph"] = [gyro_dph] * 3
    scale = standing / 0.5
    data["reference"]["bias_mps"] = [scale * value for value in data["reference"]["bias_mps"]]
    events = [
        {**event, "accel_mps2": [size * value for value in event["accel_mps2"]]}
        for event in lasting(seed, turns(scenario))
    ]
    return with_events(Scenario.parse(data), events)


def _at_sea(runs: Runs, standing: float, size: float, gyro_dph: float) -> np.ndarray:
    """RMS of position and velocity and the largest position error, shape (seeds, methods, 3)."""

    def one(seed: int) -> np.ndarray:
        run = simulate(at_sea_scenario(seed, standing, size, gyro_dph))
        return np.column_stack([errors(run)[:, :2], largest(run)])

    return runs.keep(
        ("search: liu tables", standing, size, gyro_dph), lambda: np.array([one(seed) for seed in SEEDS])
    )


def _tables(runs: Runs, setting: Setting) -> tuple[np.ndarray, ...]:
    """Numbers of claims 1 to 6."""
    found = _at_sea(runs, setting[STANDING], setting[SIZE], setting[GYRO])
    constant, novel = found[:, 0], found[:, 1]
    traditional = found[:, 2 + list(BASELINES).index(setting[BASELINE])]
    return (
        novel[:, 0] / constant[:, 0],
        novel[:, 0] / traditional[:, 0],
        traditional[:, 0] / constant[:, 0],
        novel[:, 1] / constant[:, 1],
        novel[:, 2] / constant[:, 2],
        novel[:, 2] / traditional[:, 2],
    )


TABLES_SEARCH = Search(TABLES_AXES, (1, 2, 3, 4, 5, 6), _tables, len(SEEDS))
