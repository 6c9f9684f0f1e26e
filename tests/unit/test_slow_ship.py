"""A log that gives nothing below a speed: an outage, as one of the file is."""

from typing import Any

import numpy as np
import pytest

from navcore.design.course import course
from navcore.design.seeds import no_covariance
from navcore.design.ship import Ship
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.mechanization.recorder import DAMPED_COLUMN
from navcore.motion.truth import VN
from navcore.scenario.model import Scenario
from navcore.sensors.log import reference_errors

LEGS = [
    {"duration_s": 1500.0, "speed_mps": 8.0},
    {"duration_s": 800.0, "speed_mps": 0.0, "accel_mps2": 0.05},
]


def scenario(fidelity: str = "error_model", switching: str = "hard", **reference: Any) -> Scenario:
    method = {"damping": "external", "network": {"id": "classic2"}, "switching": {"id": switching}}
    return Scenario.parse(
        {
            "run": {"duration_h": 1.5, "rate_hz": 50.0, "fidelity": fidelity, "output_step_s": 1.0},
            "motion": {"kind": "legs", "leg": LEGS, "repeat": 3},
            "imu": {"gyro_bias_dph": [0.01, -0.02, 0.01]},
            "reference": {"kind": "log", "bias_mps": [0.2, 0.1], **reference},
            "method": [method],
        }
    )


def outages(slow: Scenario) -> list[dict[str, float]]:
    """Outages at the times at which the ship is slow."""
    truth = slow.motion.truth(5401, 1.0, slow.site.site(), slow.earth)
    log = reference_errors(slow.reference, truth, 5400.0, 1, step_s=1.0)
    edges = np.flatnonzero(np.diff(np.append(log.valid, True).astype(int)))
    begins, ends = log.time_s[edges[::2] + 1], log.time_s[edges[1::2]] + 1.0
    return [{"t_h": b / 3600.0, "duration_s": e - b} for b, e in zip(begins, ends, strict=True)]


def test_the_log_fails_below_its_speed_through_the_water():
    slow = scenario(min_speed_mps=1.0)
    truth = slow.motion.truth(5401, 1.0, slow.site.site(), slow.earth)
    speed = truth.values[:, VN]
    found = reference_errors(slow.reference, truth, 5400.0, 1, step_s=1.0)
    assert np.array_equal(found.valid, speed >= 1.0)
    drifting = scenario(min_speed_mps=1.0, current_mps=[0.0, 7.5])
    found = reference_errors(drifting.reference, truth, 5400.0, 1, step_s=1.0)
    assert np.array_equal(found.valid, np.abs(speed - 7.5) >= 1.0)


@pytest.mark.parametrize("fidelity", ["error_model", "strapdown"])
def test_it_is_an_outage_in_a_run(fidelity: str):
    slow = scenario(fidelity, min_speed_mps=1.0)
    written = scenario(fidelity, outage=outages(slow))
    by_speed, by_time = (simulate(s).methods[0].rows for s in (slow, written))
    assert np.ptp(by_speed[:, DAMPED_COLUMN]) == 1.0
    assert np.array_equal(by_speed, by_time)


def test_both_fidelities_agree():
    linear, full = (
        simulate(scenario(fidelity, min_speed_mps=1.0)).methods[0].rows
        for fidelity in ("error_model", "strapdown")
    )
    assert np.array_equal(linear[:, DAMPED_COLUMN], full[:, DAMPED_COLUMN])
    scale = np.abs(linear[:, :7]).max(axis=0)
    assert (np.abs(full[:, :7] - linear[:, :7]).max(axis=0) < 0.02 * scale).all()


def test_it_is_an_outage_in_the_budget():
    slow = scenario(min_speed_mps=1.0, noise_mps=0.1)
    written = scenario(outage=outages(slow), noise_mps=0.1)
    found = [Ship(s).along(s.method[0]) for s in (slow, written, scenario(noise_mps=0.1))]
    assert np.array_equal(found[0].total, found[1].total)
    assert course(slow).served.min() < course(slow).served.max()
    assert found[2].total[-1, 3] != pytest.approx(found[0].total[-1, 3], rel=1e-3)
    keeping = scenario(switching="keep", min_speed_mps=1.0)
    assert "keep" in no_covariance(keeping, keeping.method[0])


def test_a_negative_speed_is_named():
    with pytest.raises(InputError) as refused:
        scenario(min_speed_mps=-1.0)
    (fault,) = refused.value.faults
    assert (fault.field, fault.value) == ("reference.min_speed_mps", -1.0)
    assert "must be >= 0 and <= 50 (m/s)" in str(fault.allowed)
