"""Where `bridge` wins and where it loses, over 60 random cases: table of theory.md 12.

Each case draws noise of the log, sensors, start, latitude and length, and takes a network that `ramp` can
switch too; the policy is `variation`. Of each kind there are 15: lasting changes of the log, passing
episodes, outages, and nothing to switch. Judged is the RMS of velocity over that of the better one of `hard`
and `ramp`.
"""

import math
from typing import Any

import numpy as np
import pytest

from navcore.engine.simulation import simulate
from navcore.scenario.model import Scenario
from tests import theory

CASES = 15
_T = 2.145
"""Quantile of the 95 % interval of 15 cases (Student)."""
NETWORKS: tuple[dict[str, Any], ...] = (
    {"id": "complementary", "zeta": 0.5},
    {"id": "complementary", "zeta": 0.7, "eta": 1.0},
    {"id": "pole2", "xi": 0.5},
    {"id": "unity2", "zeta": 0.5},
)
SENSORS: tuple[dict[str, Any], ...] = (
    {},
    {"gyro_bias_dph": [0.005] * 3, "accel_bias_ug": [20.0, 20.0, 0.0], "gyro_arw_dpsh": 0.001},
    {
        "gyro_bias_dph": [0.01, -0.01, 0.01],
        "accel_bias_ug": [50.0, -50.0, 0.0],
        "gyro_arw_dpsh": 0.003,
        "accel_vrw_ugpshz": 10.0,
        "gyro_instability_dph": 0.003,
    },
)
STARTS: tuple[dict[str, Any], ...] = ({}, {"attitude_arcmin": [0.1, 0.1, 1.0], "velocity_mps": [0.1, 0.1]})


def changed_for_good(rng: np.random.Generator, hours: float) -> list[dict[str, Any]]:
    """Four changes of up to 1.5 m/s on each axis within 30 s."""
    times = np.sort(rng.uniform(1.0, hours - 1.0, 4)).tolist()
    speeds = rng.uniform(-1.5, 1.5, (4, 2)) / 30.0
    return [
        {"t_h": at, "duration_s": 30.0, "accel_mps2": speed.tolist()}
        for at, speed in zip(times, speeds, strict=True)
    ]


def passing(rng: np.random.Generator, hours: float) -> list[dict[str, Any]]:
    """Changes that go back after five minutes, every half to two hours."""
    found = []
    for begin in np.arange(0.7, hours - 0.5, rng.uniform(0.5, 2.0)).tolist():
        change = rng.uniform(-1.5, 1.5, 2) / 10.0
        for at, sign in ((begin, 1.0), (begin + 290.0 / 3600.0, -1.0)):
            found.append({"t_h": at, "duration_s": 10.0, "accel_mps2": (sign * change).tolist()})
    return found


def silences(rng: np.random.Generator, hours: float) -> list[dict[str, Any]]:
    """Outages of 5 to 60 min, every two hours."""
    times = np.arange(1.0, hours - 1.2, 2.0).tolist()
    return [{"t_h": at, "duration_s": rng.uniform(300.0, 3600.0)} for at in times]


KINDS = {
    "lasting": ("event", changed_for_good),
    "episodes": ("event", passing),
    "outages": ("outage", silences),
    "nothing": ("event", lambda rng, hours: []),
}
TITLES = {
    "lasting": "lasting changes of the log",
    "episodes": "passing episodes",
    "outages": "outages",
    "nothing": "nothing to switch",
}
"""Rows of the table of theory.md 12."""


def ratios(kind: str) -> np.ndarray:
    """Ratio of each case."""
    place, changes = KINDS[kind]
    found = []
    for number in range(CASES):
        rng = np.random.default_rng([number, [*KINDS].index(kind)])
        hours = float(rng.choice([12.0, 24.0]))
        noise, drift = rng.uniform(0.05, 0.15), float(rng.choice([0.0, 0.05]))
        log = {"kind": "log", "noise_mps": noise, "drift_mps": drift}
        methods = [
            {
                "name": switching,
                "damping": "external",
                "network": NETWORKS[number % len(NETWORKS)],
                "policy": {"id": "variation"},
                "switching": {"id": switching},
            }
            for switching in ("hard", "ramp", "bridge")
        ]
        run = simulate(
            Scenario.parse(
                {
                    "run": {"duration_h": hours, "seed": number, "output_step_s": 3600.0},
                    "site": {"lat_deg": rng.uniform(0.0, 65.0)},
                    "imu": SENSORS[int(rng.integers(len(SENSORS)))],
                    "initial_error": STARTS[int(rng.integers(len(STARTS)))],
                    "reference": log | {place: changes(rng, hours)},
                    "method": methods,
                }
            )
        )
        errors = (method.errors for method in run.methods)
        hard, ramp, bridge = (math.hypot(one["dve_mps"]["rms"], one["dvn_mps"]["rms"]) for one in errors)
        found.append(max(bridge, 1e-3) / max(min(hard, ramp), 1e-3))
    return np.array(found)


def interval(found: np.ndarray) -> tuple[float, float, float]:
    """Geometric mean of the ratios and its 95 % interval."""
    logs = np.log(found)
    mean, half = float(logs.mean()), _T * float(logs.std(ddof=1)) / math.sqrt(CASES)
    return math.exp(mean), math.exp(mean - half), math.exp(mean + half)


@pytest.mark.parametrize("kind", KINDS)
def test_bridge_wins_where_the_log_changes_and_only_there(kind: str) -> None:
    """The interval lies below 1 where the log changes; it holds 1 with outages or nothing to switch."""
    found = ratios(kind)
    mean, low, high = interval(found)
    assert (high < 1.0) is (kind in ("lasting", "episodes"))
    assert low < 1.0 and mean < 1.05
    stated = theory.table("s-12", 1)[TITLES[kind]]
    numbers = theory.numbers(" ".join(stated))
    assert numbers == pytest.approx([mean, low, high, np.count_nonzero(found > 1.0)], abs=0.006)
