"""Any scenario the models allow gives finite numbers, a marked end or a refusal in words; no traceback."""

import json
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings

from navcore.engine.measures import metrics
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.scenario.model import Scenario
from tests.random_models import raw_scenarios

DURATION_H = 0.1


def run_or_refuse(data: dict[str, Any]) -> Any:
    try:
        return simulate(Scenario.parse(data))
    except InputError as error:
        assert all(fault.allowed and "\n" not in str(fault) for fault in error.faults)
        return None


@given(data=raw_scenarios(duration_h=DURATION_H))
@settings(max_examples=40, suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much])
def test_any_scenario_ends_in_numbers_or_words(data):
    run = run_or_refuse(data)
    assume(run is not None)
    assert [m.method.name for m in run.methods] == [m.name for m in run.scenario.method]
    for method in run.methods:
        assert method.status in ("ok", "diverged")
        assert np.all(np.isfinite(method.rows))
        assert len(method.rows) == len(method.t_s)
        if method.status == "ok":
            assert len(method.t_s) == len(run.t_s)
            assert method.t_s[-1] <= DURATION_H * 3600.0 + 1e-6
            assert not method.reason
        else:
            assert method.reason
        assert all(np.isfinite(value) for item in method.errors.values() for value in item.values())
        damped = method.rows[:, 8]
        assert set(np.unique(damped)) <= {0.0, 1.0}
        if method.method.damping == "free":
            assert not np.any(damped)
    json.dumps(metrics(run), allow_nan=False)


@pytest.mark.slow
@given(data=raw_scenarios(duration_h=DURATION_H))
@settings(max_examples=15, suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much])
def test_a_method_runs_the_same_alone(data):
    """Methods share truth, sensors and log: which others run beside it cannot change one."""
    assume(len(data["method"]) > 1)
    run = run_or_refuse(data)
    assume(run is not None)
    last = run.scenario.method[-1]
    alone = simulate(run.scenario.model_copy(update={"method": (last,)}))
    np.testing.assert_array_equal(alone.methods[0].rows, run.methods[-1].rows)
    assert alone.methods[0].errors == run.methods[-1].errors
