"""Liu 2021, figures 11 and 12: the scenario of five days."""

from typing import Any

from navcore.scenario.model import Scenario
from tools.papers.liu_switching import PRESET
from tools.papers.runs import scenario_of

METHODS = ("free", "classic2", "classic3", "complementary")


def scenario_of_days(seed: int, imu: dict[str, Any] | None = None) -> Scenario:
    """Five days with the networks of figure 3 and free, log of liu-networks.

    Sensors of liu-switching but for what ``imu`` gives.
    """
    sensors = scenario_of(PRESET).canonical()
    methods = [{"name": "free", "damping": "free"}, *scenario_of("liu-networks").canonical()["method"]]
    overrides = ("run.duration_h=120", "run.output_step_s=120", f"run.seed={seed}")
    blocks = {"imu": sensors["imu"] | (imu or {}), "initial_error": sensors["initial_error"]}
    return scenario_of("liu-networks", overrides, method=methods, **blocks)
