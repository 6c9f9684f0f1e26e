"""Inputs of each kind of damping: budget, floor and search count an error source where a run sees it."""

import math
from typing import Any

import numpy as np
import pytest

from navcore.damping import KINDS
from navcore.design.budget import budget
from navcore.design.figures import Entry
from navcore.design.pareto import pareto
from navcore.design.seeds import alone
from navcore.design.tune import tune
from navcore.engine.simulation import simulate
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario

pytestmark = pytest.mark.contract

SOURCES: dict[str, tuple[str, dict[str, Any]]] = {
    "gyro_white": ("imu", {"gyro_arw_dpsh": 0.002}),
    "gyro_drift": ("imu", {"gyro_instability_dph": 0.005}),
    "gyro_bias": ("imu", {"gyro_bias_dph": [0.01, 0.01, 0.01]}),
    "accel_white": ("imu", {"accel_vrw_ugpshz": 20.0}),
    "accel_drift": ("imu", {"accel_instability_ug": 20.0}),
    "accel_bias": ("imu", {"accel_bias_ug": [50.0, 50.0, 0.0]}),
    "log_white": ("reference", {"noise_mps": 0.2}),
    "log_drift": ("reference", {"drift_mps": 0.3}),
    "log_bias": ("reference", {"bias_mps": [0.4, 0.4]}),
    "log_tide": ("reference", {"tide_mps": [0.5, 0.5]}),
    "initial_tilt": ("initial_error", {"attitude_arcmin": [1.0, 1.0, 0.0]}),
    "initial_velocity": ("initial_error", {"velocity_mps": [0.1, 0.1]}),
}
"""Each source of a budget: the block that switches it on, and with what."""
LEGS = {"kind": "legs", "leg": [{"duration_s": 1200.0}, {"duration_s": 600.0, "speed_mps": 5.0}]}
EXTERNAL, INTERNAL = ({"damping": kind, "network": {"id": "unity2"}} for kind in ("external", "internal"))
each_kind = pytest.mark.parametrize("name", KINDS)


def scenario(method: dict[str, Any], without: str = "", **blocks: Any) -> Scenario:
    """Two hours at rest and under way, with every source but one."""
    whole: dict[str, Any] = {"imu": {}, "initial_error": {}, "reference": {"kind": "log"}}
    for source, (block, fields) in SOURCES.items():
        whole[block] |= {} if source == without else fields
    whole |= {"run": {"duration_h": 2.0, "output_step_s": 60.0}, "motion": LEGS, "method": [method]}
    return Scenario.parse({block: fields | blocks.get(block, {}) if isinstance(fields, dict) else fields
                           for block, fields in whole.items()})  # fmt: skip


def size(entry: Entry | None) -> float:
    """Largest figure of a source, its growth too; infinite where it drives a mode without decay."""
    if entry is None:
        return 0.0
    parts = [entry.rms] if entry.growth is None else [entry.rms, entry.growth]
    return max((v for part in parts for v in vars(part).values() if v is not None), default=math.inf)


@each_kind
def test_a_budget_counts_a_source_exactly_where_a_run_sees_it(name: str) -> None:
    method = {"damping": name, "network": {"id": "unity2" if KINDS[name].uses_network else "none"}}
    whole = scenario(method)
    along, steady = budget(whole, seeds=1).methods[0], budget(whole, steady=True).methods[0]
    run = simulate(alone(whole, whole.method[0])).methods[0]
    seen = set()
    for source in SOURCES:
        quiet = scenario(method, source)
        same = np.array_equal(run.rows, simulate(alone(quiet, quiet.method[0])).methods[0].rows)
        seen |= set() if same else {source}
        totals = [list(vars(each.total.rms).values()) for each in (along, budget(quiet, seeds=1).methods[0])]
        assert np.allclose(*totals, rtol=1e-9, atol=0.0) == same, source
        if along.sources and name != "kalman":  # which has one share, of all that it is told
            assert (size(along.sources.get(source)) == 0.0) == same, source
        if source in steady.sources and name != "kalman":
            assert (size(steady.sources[source]) == 0.0) == same, source
    assert seen == {source for source in SOURCES if KINDS[name].uses_log or not source.startswith("log")}


def test_without_the_log_its_rate_changes_nothing() -> None:
    """The law takes its own velocity at every call, however seldom the log comes."""
    totals = [
        budget(scenario(INTERNAL, reference={"rate_hz": rate})).methods[0].total for rate in (1.0, 1.0 / 60.0)
    ]
    assert totals[0].rms.tilt_rad == pytest.approx(totals[1].rms.tilt_rad, rel=1e-9)


def test_a_schedule_without_the_log_is_shown_by_seeds() -> None:
    """The covariance follows velocity feedback in advance; internal damping has the network form."""
    method = {"damping": "internal", "network": {"id": "compass"}, "policy": {"id": "schedule"}}
    found = budget(scenario(method), seeds=1).methods[0]
    assert found.shown == "seeds"


@pytest.mark.parametrize("steady", [True, False])
def test_the_floor_stands_beside_methods_that_read_the_log(steady: bool) -> None:
    methods = [EXTERNAL, INTERNAL, {"damping": "free"}, INTERNAL | {"policy": {"id": "threshold"}}]
    names = [{"name": str(k)} for k in range(len(methods))]
    whole = scenario({}).model_copy(
        update={"method": tuple(Method.model_validate(m | n) for m, n in zip(methods, names, strict=True))}
    )
    found = budget(whole, steady, seeds=1)
    assert found.floor.rms.tilt_rad and not found.floor_reason
    compared = [any(found.times_floor(method).values()) for method in found.methods]
    assert compared == [True, False, False, True]
    own = budget(scenario(INTERNAL), steady)
    assert own.floor.rms.tilt_rad is None and "no method uses the log" in own.floor_note


@pytest.mark.slow
def test_a_search_without_the_log_has_no_floor_of_it() -> None:
    quiet = {"bias_mps": [0.0, 0.0], "tide_mps": [0.0, 0.0]}
    results = []
    for noise in (0.2, 0.4):
        whole = scenario(INTERNAL, reference=quiet | {"noise_mps": noise})
        found = tune(whole, "tilt_rms", ["method.0.network.zeta=0.3:1"])
        fronts = pareto(whole, networks=["compass"])
        assert found.floor is None and fronts.floor == (None, None)
        results.append((found.best, fronts.fronts))
    assert results[0] == results[1]
    against = scenario(EXTERNAL, reference=quiet)
    assert tune(against, "tilt_rms", ["method.0.network.zeta=0.3:1"]).floor


def test_the_optimal_network_without_the_log_does_not_depend_on_it() -> None:
    def zeros(damping: str, noise: float) -> list[complex]:
        whole = scenario({"damping": damping, "network": {"id": "optimal"}}, reference={"noise_mps": noise})
        return whole.method[0].network.transfer(whole.omega_s).zeros.tolist()

    assert zeros("internal", 0.1) == zeros("internal", 0.4)
    assert zeros("external", 0.1) != zeros("external", 0.4)
