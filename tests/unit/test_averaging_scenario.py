"""Averaging as a method of a scenario: what is refused, and that both fidelities carry it out."""

from typing import Any

import numpy as np
import pytest

from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.mechanization.strapdown.records import NAVIGATION
from navcore.scenario.model import Scenario

METHODS = [
    {"damping": "averaging"},
    {"damping": "averaging", "averaging": {"variant": "cascade", "earth": False}},
    {"damping": "free"},
]


def scenario(**blocks: Any) -> Scenario:
    data: dict[str, Any] = {
        "run": {"duration_h": 0.5, "rate_hz": 10.0},
        "site": {"lat_deg": 45.78},
        "initial_error": {"attitude_arcmin": [0.06, 0.06, 0.7], "velocity_mps": [0.01, 0.0]},
        "method": METHODS,
    }
    for name, block in blocks.items():
        data[name] = {**data[name], **block} if isinstance(block, dict) and name in data else block
    return Scenario.parse(data)


def test_both_fidelities_carry_it_out():
    linear, full = simulate(scenario()), simulate(scenario(run={"fidelity": "strapdown"}))
    # of what the free method has: where the copies leave next to nothing, the second order shows
    scale = np.abs(linear.methods[2].rows[:, :7]).max(axis=0)
    for a, b in zip(linear.methods, full.methods, strict=True):
        assert (a.status, b.status) == ("ok", "ok")
        np.testing.assert_allclose(b.rows[:, :7] / scale, a.rows[:, :7] / scale, atol=1e-3)
        assert b.navigation is not None
        assert b.navigation.shape == (len(b.rows), len(NAVIGATION))
    # the cascade is far below the free method at once
    assert linear.methods[1].errors["phi_e_rad"]["rms"] < 0.1 * linear.methods[2].errors["phi_e_rad"]["rms"]


@pytest.mark.parametrize("fidelity", ["error_model", "strapdown"])
def test_a_stopped_run_keeps_what_was_computed(fidelity):
    run = simulate(scenario(run={"fidelity": fidelity, "duration_h": 30.0}), cancelled=lambda: True)
    averaged = run.methods[0]
    assert averaged.status == "stopped"
    assert 1 < len(averaged.rows) < len(run.t_s)
    assert np.isfinite(averaged.rows[:, :8]).all()


def test_progress_reaches_the_end():
    seen: list[float] = []
    simulate(scenario(run={"duration_h": 30.0}), progress=seen.append)
    assert seen[-1] == pytest.approx(1.0)
    assert len(seen) > 3


def test_what_the_forecast_costs_is_told():
    run = simulate(scenario(imu={"gyro_arw_dpsh": 0.005}))
    assert any("0.012 °/h" in text for text in run.methods[0].warnings)
    assert not any("forecast" in text for text in run.methods[2].warnings)
    unused = scenario(method=[{"damping": "averaging", "network": {"id": "classic2"}}])
    assert 'damping = "averaging": the network is not used' in simulate(unused).methods[0].warnings


@pytest.mark.parametrize(
    ("blocks", "field", "reason"),
    [
        ({"run": {"fidelity": "channel"}}, "method.0.damping", "error_model"),
        ({"alignment": {"motion": [{"t_s": -700.0}]}}, "alignment.motion.0.t_s", "begins there"),
        ({"alignment": {"motion": [{"t_s": -3.0}]}}, "alignment.motion.0.duration_s", "starts at 0"),
        ({"alignment": {"motion": [{"t_s": 1.0}]}}, "alignment.motion.0.t_s", "< 0"),
        (
            {"motion": {"kind": "legs", "leg": [{"duration_s": 100.0, "speed_mps": 5.0}]}},
            "motion",
            "must start from rest",
        ),
        ({"method": [{"damping": "averaging", "averaging": {"earth": 1}}]}, "method.0.averaging.earth", ""),
        (
            {"method": [{"damping": "averaging", "averaging": {"variant": "x"}}]},
            "averaging.variant",
            "cascade",
        ),
    ],
)
def test_what_is_refused(blocks, field, reason):
    with pytest.raises(InputError) as caught:
        scenario(**blocks)
    assert any(field in fault.field and reason in fault.allowed for fault in caught.value.faults)


def test_a_policy_asks_for_no_reference_when_nothing_is_damped():
    assert scenario(method=[{"damping": "averaging", "policy": {"id": "threshold"}}]).method[0].undamped
