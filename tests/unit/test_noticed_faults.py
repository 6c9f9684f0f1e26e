"""Faults that no test noticed when they were planted: each is held by a number or a refusal of its own."""

import math
from typing import Any

import numpy as np
import pytest

from navcore.design.budget import budget
from navcore.design.measures import Setting
from navcore.design.shares import share_of
from navcore.design.ship import Ship
from navcore.engine.ensemble import Outcome
from navcore.foundation.errors import InputError
from navcore.scenario.model import Scenario

LOG: dict[str, Any] = {"kind": "log", "noise_mps": 0.3}
UNITY: dict[str, Any] = {"id": "unity2"}


def ship(**blocks: Any) -> Scenario:
    data = {"run": {"duration_h": 1.0}, "site": {"lat_deg": 45.0}, "reference": LOG}
    return Scenario.parse(data | blocks)


@pytest.mark.parametrize(("damping", "refused"), [("internal", True), ("external", False)])
def test_an_internal_azimuth_network_must_let_the_earths_rate_pass(damping: str, refused: bool) -> None:
    """Y(0) of this network is 0.5: half of the Earth's rate would be left out."""
    half = {"id": "custom", "num": [0.5], "den": [1.0, 1.0]}
    method = [{"damping": damping, "network": UNITY, "azimuth": half}]
    if not refused:
        assert ship(method=method).method[0].azimuth.id == "custom"
        return
    with pytest.raises(InputError, match=r"must have Y\(0\) = 1 within 0.001") as error:
        ship(method=method)
    assert error.value.faults[0].field == "method.0.azimuth.id"


@pytest.mark.parametrize(("step_s", "fastest"), [(1.0, 0.1), (10.0, 0.01)])
def test_a_gyrocompass_is_no_faster_than_a_slow_law_samples_it(step_s: float, fastest: float) -> None:
    def of(sigma: float) -> Scenario:
        method = [{"damping": "external", "network": UNITY, "gyrocompass": {"sigma": sigma}}]
        return ship(run={"duration_h": 1.0, "step_s": step_s}, method=method)

    assert of(0.99 * fastest).method[0].gyrocompass is not None
    with pytest.raises(InputError, match=rf"must be <= {fastest:g} 1/s at a law step of {step_s:g} s"):
        of(1.01 * fastest)


def test_a_seed_that_diverges_meets_no_limit_not_even_one_of_the_setting() -> None:
    """Settling belongs to the setting, which keeps it on every seed; a diverged run meets nothing."""
    limit = [{"quantity": "settling_s", "at_most": 1e6}]
    scenario = ship(method=[{"damping": "external", "network": UNITY}], requirement=limit)
    setting = Setting(Ship(scenario, True, 96, drawn=True), scenario.method[0])
    outcomes = [Outcome(k != 2, (), 0.0) for k in range(4)]
    found = share_of(setting, outcomes)
    assert found.met == 0.75 and found.diverged == 1


def test_what_a_filter_is_not_told_of_adds_with_its_sign() -> None:
    """At 10 m/s north a scale of 2 % and a current of 0.2 m/s cancel, or double, in the filter's budget."""

    def velocity(current: float) -> float:
        scenario = ship(
            run={"duration_h": 3.0, "step_s": 10.0},
            motion={"kind": "legs", "leg": [{"duration_s": 10800.0, "speed_mps": 10.0, "heading_deg": 0.0}]},
            imu={"gyro_arw_dpsh": 0.001, "accel_vrw_ugpshz": 5.0},
            reference={
                "kind": "log",
                "noise_mps": 0.05,
                "scale_ppm": 20_000.0,
                "current_mps": [0.0, current],
            },
            method=[{"damping": "kalman"}],
        )
        value = budget(scenario).methods[0].total.rms.velocity_mps
        assert value is not None
        return value

    cancelling, doubling = velocity(0.2), velocity(-0.2)
    assert doubling > 4.0 * cancelling


def test_a_fast_log_is_averaged_over_a_step_of_the_law() -> None:
    """Ten samples a step leave the noise of one sample over the root of ten."""

    def log_white(rate_hz: float, noise: float) -> float:
        method = [{"damping": "external", "network": UNITY}]
        reference = {"kind": "log", "noise_mps": noise, "rate_hz": rate_hz}
        found = budget(ship(run={"duration_h": 1.0, "step_s": 1.0}, reference=reference, method=method), True)
        value = found.methods[0].sources["log_white"].rms.velocity_mps
        assert value is not None
        return value

    fast, alike = log_white(10.0, 0.3), log_white(1.0, 0.3 / math.sqrt(10.0))
    assert fast == pytest.approx(alike, rel=1e-6)
    assert log_white(0.1, 0.3) > 2.0 * log_white(1.0, 0.3)
    assert np.isfinite(fast)
