"""Sensors that suffice: what the inverse promises, forward runs on other seeds keep."""

from typing import Any

import numpy as np
import pytest

from navcore.design.run_shares import run_shares
from navcore.design.suffice import Sufficing, suffice, with_biases
from navcore.foundation.errors import InputError, StoppedError
from navcore.scenario.model import Scenario


def scenario_of(**blocks: Any) -> Scenario:
    limits = [
        {"quantity": "tilt_max_arcsec", "at_most": 20.0},
        {"quantity": "velocity_max_mps", "at_most": 0.6},
    ]
    data: dict[str, Any] = {
        "schema": 1,
        "run": {"fidelity": "error_model", "duration_h": 2.0, "step_s": 10.0},
        "imu": {"gyro_arw_dpsh": 0.002},
        "reference": {"kind": "log", "rate_hz": 0.1, "noise_mps": 0.1},
        "method": [
            {"name": "free"},
            {"name": "classic2", "damping": "external", "network": {"id": "classic2"}},
        ],
        "requirement": limits,
    }
    return Scenario.parse(data | blocks)


@pytest.mark.slow
def test_other_seeds_keep_within_five_percent_what_is_promised() -> None:
    scenario = scenario_of()
    found = suffice(scenario, 1, 0.9, 200)
    gyro, log = np.array(found.family).T
    assert gyro[0] == log[-1] == 0.0 and (np.diff(gyro) > 0.0).all() and (np.diff(log) <= 0.0).all()
    (one,) = (method for method in scenario.method if method.name == found.method)
    fresh = scenario.run.model_copy(update={"seed": 5000})
    forward = scenario.model_copy(update={"method": (one,), "run": fresh})
    for pair in found.family:
        (share,) = run_shares(with_biases(forward, *pair), 500)
        assert share.met == pytest.approx(found.share, abs=0.05), pair


def test_parts_fall_in_the_family_or_not() -> None:
    found = Sufficing("m", 0.9, 100, 1.0, ((0.0, 0.4), (0.01, 0.2), (0.02, 0.0)))
    parts = {name: (gyro, left, logs) for name, gyro, left, logs in found.parts()}
    gyro, left, logs = parts["Honeywell HG9900"]
    assert gyro == 0.0035 and left == pytest.approx(0.33) and "IMO MSC.96(72) log" in logs
    assert parts["Honeywell HG1700 AG58"][1:] == (None, [])
    assert found.log_bias(0.015) == pytest.approx(0.1) and found.log_bias(0.03) is None


def test_nothing_suffices_where_the_other_errors_are_too_large() -> None:
    scenario = scenario_of(imu={"gyro_arw_dpsh": 0.5})
    found = suffice(scenario, 1, 0.9, 20)
    assert found.family == () and found.without < 0.9
    assert any("none: without gyro bias" in line for line in found.lines())
    assert all(part[2] is None for part in found.parts())


def test_what_cannot_be_asked_is_refused() -> None:
    with pytest.raises(InputError) as error:
        suffice(scenario_of(), 2, 0.9, 20)
    assert (error.value.faults[0].where, error.value.faults[0].value) == ("--method", 2)
    with pytest.raises(InputError) as error:
        suffice(scenario_of(requirement=[]), 1, 0.9, 20)
    assert error.value.faults[0].field == "requirement"
    with pytest.raises(StoppedError):
        suffice(scenario_of(), 1, 0.9, 20, cancelled=lambda: True)
